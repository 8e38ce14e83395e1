"""The facts by which a check held are true in the graph of that world."""

from __future__ import annotations

import random
import re
from collections import Counter

from small_worlds import random_graph, random_step

from hearth.kb.loading.load import default
from hearth.schemas.program import Step
from hearth.schemas.vocabulary import STATES
from hearth.simulation.engine import act
from hearth.simulation.rules import DEFAULT
from hearth.simulation.step_explanations import checks
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

NAMED = re.compile(r"[a-z_]+ \((\d+)\)")


class Plain:
    """A world as its graph, to look things up in.

    Attributes:
        edges: as (source, relation, target).
        me: the character's node.
        nodes: by id.
    """

    def __init__(self, world: World, agent: int) -> None:
        graph = world.graph()
        self.edges = {(edge.source, edge.relation, edge.target) for edge in graph.edges}
        self.nodes = {node.id: node for node in graph.nodes}
        self.me = world.home.ids[world.agents[agent].index]

    def kind(self, text: str) -> str:
        """Check one witness; what it is about, "" for what is not looked at here."""
        ids = [int(number) for number in NAMED.findall(text)]
        if text.startswith("character CLOSE") or text.startswith("character FACING"):
            return self._edges(text, ids)
        if text.endswith("hand is free"):
            relation = "HOLDS_RH" if "right" in text else "HOLDS_LH"
            assert not any(edge[:2] == (self.me, relation) for edge in self.edges), text
            return "free"
        if text.endswith("hand"):
            assert (self.me, "HOLDS_RH" if "right" in text else "HOLDS_LH", *ids) in self.edges, text
            return "held"
        if text == "the character stands":
            assert not {"SITTING", "LYING"} & set(self.nodes[self.me].states)
            return "stands"
        words = re.sub(r"^.* is | and | nor |neither ", " ", text).split()
        if " is " in text and words and set(words) <= set(STATES):
            there = set(self.nodes[ids[0]].states)
            assert not set(words) & there if "neither" in text else set(words) <= there, text
            return "neither" if "neither" in text else "state"
        return ""

    def _edges(self, text: str, ids: list[int]) -> str:
        relation = "CLOSE" if "character CLOSE" in text else "FACING"
        assert (self.me, relation, ids[0]) in self.edges, text
        if len(ids) == 1:
            return relation
        hop = (ids[1], "ON", ids[2]) if " ON " in text else (ids[0], relation, ids[1])
        assert hop in self.edges and ids[-1] == (ids[0] if " ON " in text else ids[1]), text
        return f"{relation} by ON" if " ON " in text else f"{relation} by {relation}"


def _explained(world: World, step: Step) -> Counter[str]:
    plain = Plain(world, step.agent)
    return Counter(
        plain.kind(part) for check in checks(world, step, DEFAULT) for part in re.split(", (?=character )", check.by)
    )


def test_every_witness_is_true():
    kinds, known = Counter[str](), default()
    wanted = {"CLOSE", "CLOSE by ON", "CLOSE by CLOSE", "FACING", "FACING by FACING", "free", "held", "state", "stands"}
    for seed in range(600):
        if seed >= 150 and wanted <= set(kinds):
            break
        chooser = random.Random(seed)
        graph = random_graph(chooser)
        world = World.start(Home.from_graph(graph, "", known))
        for _ in range(60):
            step = random_step(chooser, graph)
            after = act(world, step)
            if isinstance(after, World):
                kinds += _explained(world, step)
                world = after
    assert wanted <= set(kinds), wanted - set(kinds)
