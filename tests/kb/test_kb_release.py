"""The knowledge against the release itself, where it is at hand."""

from __future__ import annotations

import json
import re
import zipfile

from oracles.facts import Facts
from oracles.formulas import changes, first_failure

from hearth.kb.tools.compare import compare, rejection
from hearth.kb.tools.graph_and_tables import tables
from hearth.kb.tools.published_knowledge import read_release
from hearth.schemas.graph import edge_set, from_release

STEP = re.compile(r"\[(\w+)\].*")


def test_every_fact_of_the_release_is_held_or_corrected_with_a_reason(knowledge, real_data):
    found = compare(knowledge, real_data / "kb")
    assert [d for d in found.differences if not d.why] == []
    assert found.theirs["affordances"] == found.held["affordances"] == 10_061 + 320
    assert {position: sum(row.values()) for position, row in found.cells.items()} == {"0": 10_061, "1": 320}
    assert all(row["refused"] == 0 and row["rule"] > 40 * row["exception"] for row in found.cells.values())
    assert found.held["properties"] == found.theirs["properties"]


def test_the_evidence_of_every_affordance_is_true(knowledge, real_data):
    matrix = {
        (knowledge.action(action).name, int(position), knowledge.object_class(name).name)
        for action, position, name in read_release(real_data / "kb")["affordances"]
    }
    said = {
        (row["action"], row["position"], row["class"])
        for row in tables(knowledge)["affordances"]
        if row["evidence"] == "release"
    }
    assert said == matrix


def test_the_names_of_the_interface_and_the_homes_are_classes(knowledge, real_data):
    names = json.loads((real_data / "kb/affordances.json").read_bytes())["objects"]
    assert len({knowledge.object_class(name).name for name in names}) == 320
    for home in sorted((real_data / "homes").glob("*.json")):
        for node in json.loads(home.read_bytes())["nodes"]:
            assert node["class_name"] in knowledge.objects, node["class_name"]


def test_the_grammar_accepts_every_pair_of_the_release_and_rejects_most_at_random(knowledge, real_data):
    refused = set()
    for _, text, _ in programs(real_data, 1):
        for step in STEP.finditer(text):
            for position, name in enumerate(re.findall(r"<([^>]*)>", step[0])):
                if not knowledge.affords(step[1], position, name):
                    refused.add((step[1], position, name))
    assert refused == set()
    assert rejection(knowledge) > 0.55


def test_the_literals_alone_reproduce_the_release(knowledge, real_data):
    for name, text, graphs in programs(real_data, 54):
        start, final = from_release(graphs["init_graph"]), from_release(graphs["final_graph"])
        world = run(knowledge, HashOrdered.made(start), text, name)
        assert world.edges() == edge_set(final.edges), name
        assert world.states == {node.id: frozenset(node.states) for node in final.nodes}, name


class HashOrdered(Facts):
    """Remembers the place that comes first in the order of a Python set, as the release did."""

    @classmethod
    def made(cls, graph):
        facts = Facts.of(graph)
        return cls(facts.by_id, facts.forward, facts.backward, facts.states, facts.memories)

    def place(self, node):
        for relation in ("ON", "INSIDE", "CLOSE"):
            places = set()
            for found in sorted(self.targets(relation, node)):
                places.add(found)
            for found in places:
                if not self.is_room(found):
                    return relation, found
        return None


def run(knowledge, world, text, name):
    me = next(node for node, own in world.by_id.items() if own.class_name == "character")
    for step in STEP.finditer(text):
        action = knowledge.action(step[1])
        ids = [int(number.split(".")[-1]) for number in re.findall(r"\(([\d.]+)\)", step[0])]
        binding = {"a": me, **dict(zip("os", ids, strict=False))}
        assert first_failure(knowledge, world, action, binding) is None, (name, step[0])
        world = world.after(changes(knowledge, world, action, binding))
    return world


def programs(real_data, every):
    with zipfile.ZipFile(real_data / "activityprograms-sample.zip") as archive:
        names = [n for n in archive.namelist() if "/executable_programs/" in n and n.endswith(".txt")]
        for name in names[::every]:
            graphs = name.replace("/executable_programs/", "/init_and_final_graphs/").replace(".txt", ".json")
            yield name, archive.read(name).decode(), json.loads(archive.read(graphs)) if every > 1 else None
