"""The release's stored end graphs, reproduced exactly: by the engine and by the plain reading of the table."""

from __future__ import annotations

import zipfile

import orjson
import pytest
from oracles import engine as reference
from oracles.world import Options
from oracles.world import World as PlainWorld

from hearth.kb import action_grammar
from hearth.schemas.graph import from_release
from hearth.schemas.syntax import parse_program
from hearth.simulation.engine import run
from hearth.simulation.rules import REPLAY
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World


def cases(folder, knowledge, every: int = 1):
    """(name, program, start graph, end graph) of the sample's grounded programs."""
    with zipfile.ZipFile(folder / "activityprograms-sample.zip") as sample:
        names = sorted(n for n in sample.namelist() if "/executable_programs/" in n and n.endswith(".txt"))
        for name in names[::every]:
            graphs = name.replace("executable_programs", "init_and_final_graphs").replace(".txt", ".json")
            data = orjson.loads(sample.read(graphs))
            program, faults = parse_program(sample.read(name).decode(), name)
            checked, more = action_grammar.check(program, knowledge)
            assert not (*faults, *more)
            yield name, checked, data["init_graph"], data["final_graph"]


def facts(data) -> tuple[set, set]:
    edges = {(e["from_id"], e["relation_type"], e["to_id"]) for e in data["edges"]}
    return edges, {(n["id"], state) for n in data["nodes"] for state in n["states"]}


@pytest.mark.parametrize("every", [6, pytest.param(1, marks=pytest.mark.slow)])
def test_the_engine_reproduces_every_stored_end_graph(real_data, knowledge, every):
    """All of them in a hurry: `replay`, which has a test of its own."""
    number = 0
    for name, program, start, end in cases(real_data, knowledge, every):
        execution = run(World.start(Home.from_release(start, "", knowledge)), program, REPLAY)
        assert execution.executable, (name, execution.failure)
        graph = execution.final.graph()
        edges, states = facts(end)
        assert {tuple(e) for e in graph.edges} == edges, name
        assert {(n.id, s) for n in graph.nodes for s in n.states} == states, name
        number += 1
    assert number == -(-267 // every)


@pytest.mark.parametrize("every", [8, pytest.param(1, marks=pytest.mark.slow)])
def test_so_does_the_plain_reading(real_data, knowledge, every):
    for name, program, start, end in cases(real_data, knowledge, every):
        world = PlainWorld(from_release(start), release=True)
        assert (
            reference.run(
                world,
                program,
                Options(doors=False, watch_needs_on=False, made_bed=False, near_hands=False, leaves_seat=False),
            )
            is None
        ), name
        edges, states = facts(end)
        assert world.edges() == edges, name
        assert world.state_pairs() == states, name
