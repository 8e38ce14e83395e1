"""The speed of making worlds and running programs, against the plain reference: `pytest benchmarks --benchmark-only`.

Each benchmark says how many units one run of it is, so that rates are printed by unit (see `conftest`).
"""

from __future__ import annotations

import zipfile
from dataclasses import replace
from itertools import islice
from typing import Any

import benchmark_cases
import orjson
import pytest
from oracles import engine as reference
from oracles.world import Options
from oracles.world import World as PlainWorld

from hearth.analysis.release_replay import replay
from hearth.grounding.binding import Binding, bind
from hearth.kb import action_grammar
from hearth.kb.loading.load import default
from hearth.schemas.graph import Edge, Node, from_release
from hearth.schemas.program import ObjectRef, Step
from hearth.schemas.syntax import parse_program
from hearth.simulation.actions.legal import legal
from hearth.simulation.engine import final, run
from hearth.simulation.observation.views import view
from hearth.simulation.rules import DEFAULT, REPLAY
from hearth.simulation.world.edit import extended
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

ENDS = ("init_graph", "final_graph")
OPTIONS = {
    "release": (
        REPLAY,
        Options(doors=False, watch_needs_on=False, made_bed=False, near_hands=False, leaves_seat=False),
    ),
    "own homes": (DEFAULT, Options()),
}


def started(corpus: str) -> list[tuple[World, Any]]:
    if corpus == "release":
        return [(World.start(Home.from_release(graph, "", default())), program) for graph, program in _release()]
    return [(World.start(Home.from_graph(graph, "", default())), program) for graph, program in benchmark_cases.own()]


def plain(corpus: str) -> list[tuple[PlainWorld, Any]]:
    if corpus == "release":
        return [(PlainWorld(from_release(graph), release=True), program) for graph, program in _release()]
    return [(PlainWorld(graph), program) for graph, program in benchmark_cases.own()]


def _release() -> Any:
    found = benchmark_cases.release()
    if not found:
        pytest.skip(f"no release sample in {benchmark_cases.REAL} (set HEARTH_REAL_DATA)")
    return found


def note(benchmark: Any, unit: str, units: int = 1, against: str = "") -> None:
    benchmark.extra_info.update(unit=unit, units=units, against=against)


@pytest.mark.parametrize("corpus", OPTIONS)
@pytest.mark.benchmark(group="steps, only the end kept")
def test_steps_bare(benchmark, corpus):
    items, rules = started(corpus), OPTIONS[corpus][0]
    assert all(isinstance(final(world, program, rules), World) for world, program in items)
    note(benchmark, "step", sum(len(p.steps) for _, p in items), f"test_steps_bare_reference[{corpus}]")
    benchmark(lambda: [final(world, program, rules) for world, program in items])


@pytest.mark.parametrize("corpus", OPTIONS)
@pytest.mark.benchmark(group="steps, only the end kept")
def test_steps_bare_reference(benchmark, corpus):
    items, options = plain(corpus), OPTIONS[corpus][1]
    note(benchmark, "step", sum(len(p.steps) for _, p in items))

    def fresh() -> Any:
        return ([(world.copy(), program) for world, program in items],), {}

    def go(worlds: Any) -> None:
        for world, program in worlds:
            assert reference.run(world, program, options) is None

    benchmark.pedantic(go, setup=fresh, rounds=5)


@pytest.mark.parametrize("corpus", OPTIONS)
@pytest.mark.benchmark(group="steps, every state kept")
def test_steps_keeping_every_state(benchmark, corpus):
    items, rules = started(corpus), OPTIONS[corpus][0]
    note(benchmark, "step", sum(len(p.steps) for _, p in items), f"test_steps_keeping_every_state_reference[{corpus}]")
    benchmark(lambda: [run(world, program, rules) for world, program in items])


@pytest.mark.parametrize("corpus", OPTIONS)
@pytest.mark.benchmark(group="steps, every state kept")
def test_steps_keeping_every_state_reference(benchmark, corpus):
    items, options = plain(corpus)[:6], OPTIONS[corpus][1]
    note(benchmark, "step", sum(len(p.steps) for _, p in items))
    benchmark.pedantic(
        lambda: [reference.run_keeping_every_state(world, program, options) for world, program in items], rounds=3
    )


@pytest.mark.benchmark(group="making worlds")
def test_world_from_known_home(benchmark):
    home = Home.from_graph(benchmark_cases.own()[0][0], "", default())
    note(benchmark, "world", against="test_world_reference")
    benchmark(World.start, home)


@pytest.mark.benchmark(group="making worlds")
def test_world_reference(benchmark):
    graph = benchmark_cases.own()[0][0]
    note(benchmark, "world")
    benchmark(PlainWorld, graph)


@pytest.mark.benchmark(group="making worlds")
def test_environment_of_twenty_more_things(benchmark):
    home = Home.from_graph(benchmark_cases.own()[0][0], "", default())
    room, place = (home.ids[mask.bit_length() - 1] for mask in (home.rooms, home.properties["SURFACES"]))
    nodes = [Node(2000 + i, "cup", "Props", ("GRABBABLE", "RECIPIENT"), ("CLEAN",)) for i in range(20)]
    edges = [Edge(n.id, r, t) for n in nodes for r, t in (("INSIDE", room), ("ON", place), ("CLOSE", place))]
    states = {home.ids[i]: ("CLEAN",) for i in range(10, 20)}
    note(benchmark, "environment", against="test_world_reference")
    benchmark(lambda: World.start(extended(home, nodes, edges, (), states)))


@pytest.mark.benchmark(group="making worlds")
def test_parse_and_build_release_graph(benchmark):
    graph = max((graph for graph, _ in _release()), key=lambda g: len(g["edges"]))
    data = orjson.dumps(graph)
    benchmark.extra_info["size"] = f"{len(graph['nodes'])} nodes, {len(graph['edges'])} edges, {len(data)} bytes"
    note(benchmark, "home", against="test_parse_and_build_reference")
    benchmark(lambda: World.start(Home.from_release(orjson.loads(data), "", default())))


@pytest.mark.benchmark(group="making worlds")
def test_parse_and_build_reference(benchmark):
    graph = max((graph for graph, _ in _release()), key=lambda g: len(g["edges"]))
    data = orjson.dumps(graph)
    note(benchmark, "home")
    benchmark(lambda: PlainWorld(from_release(orjson.loads(data))))


@pytest.mark.benchmark(group="replaying a release")
def test_replay(benchmark):
    programs = len(_release())
    note(benchmark, "program", programs, "test_replay_reference")
    found = benchmark(lambda: list(islice(replay(benchmark_cases.SAMPLE, default()), programs)))
    assert all(one.exact for one in found)


@pytest.mark.benchmark(group="replaying a release")
def test_replay_reference(benchmark):
    """As many programs read, run, and compared with their stored ends, with dicts of sets."""
    programs = len(_release())
    note(benchmark, "program", programs)

    def go() -> None:
        with zipfile.ZipFile(benchmark_cases.SAMPLE) as sample:
            names = [name for name in sorted(sample.namelist()) if "/executable_programs/" in name]
            for name in [name for name in names if name.endswith(".txt")][:programs]:
                file = name.replace("executable_programs", "init_and_final_graphs").replace(".txt", ".json")
                graphs = orjson.loads(sample.read(file))
                world, end = (PlainWorld(from_release(graphs[key]), release=True) for key in ENDS)
                program, _ = action_grammar.check(parse_program(sample.read(name).decode(), name)[0], default())
                assert reference.run(world, program, OPTIONS["release"][1]) is None
                assert (world.edges(), world.state_pairs()) == (end.edges(), end.state_pairs())

    benchmark.pedantic(go, rounds=3)


@pytest.mark.benchmark(group="binding and running programs of 12 steps")
def test_bind_and_run(benchmark):
    items = benchmark_cases.unbound()
    assert len(items) > 50
    note(benchmark, "program", len(items), "test_bind_and_run_reference")

    def go() -> None:
        for world, program in items:
            found = bind(program, world)
            assert isinstance(found, Binding)
            assert run(world, found.apply(program)).executable

    benchmark(go)


@pytest.mark.benchmark(group="binding and running programs of 12 steps")
def test_bind_and_run_reference(benchmark):
    """The first instance of each class, without a search, and a copy of the world for each run."""
    items = [(PlainWorld(graph), graph, program) for graph, program in benchmark_cases.own()]
    note(benchmark, "program", len(items))

    def go() -> None:
        for world, graph, program in items:
            nodes = {node.class_name: node.id for node in reversed(graph.nodes)}
            steps = tuple(replace(s, objects=tuple(replace(o, node=nodes[o.name]) for o in s.objects))
                          for s in program.steps)  # fmt: skip
            reference.run(world.copy(), replace(program, steps=steps), OPTIONS["own homes"][1])

    benchmark(go)


@pytest.mark.parametrize("limits", [{}, {"only_visible": True}, {"only_reachable": True}], ids=str)
@pytest.mark.benchmark(group="what an agent may do and sees")
def test_legal(benchmark, limits):
    worlds = [world for start, program in started("own homes") for world in run(start, program).worlds[::6]]
    note(benchmark, "world", len(worlds), "test_legal_reference")
    benchmark(lambda: [dict(legal(world, **limits).masks) for world in worlds])


@pytest.mark.benchmark(group="what an agent may do and sees")
def test_legal_reference(benchmark):
    """Every action with one object is tried on every object, in one copy of the world."""
    worlds = [
        (world, graph)
        for (world, _), (graph, _) in zip(plain("own homes")[::4], benchmark_cases.own()[::4], strict=True)
    ]
    single = [name for name, action in default().actions.items() if action.arity == 1 and name in reference.ACTIONS]
    note(benchmark, "world", len(worlds))

    def go() -> None:
        for start, graph in worlds:
            world = start.copy()
            for name in single:
                for node in graph.nodes:
                    tried = Step(name, (ObjectRef(node.class_name, 1, node.id),))
                    reference.step(world, tried, OPTIONS["own homes"][1])

    benchmark.pedantic(go, rounds=5)


@pytest.mark.benchmark(group="what an agent may do and sees")
def test_partial_view_as_ids(benchmark):
    worlds = [world for start, program in started("own homes") for world in run(start, program).worlds[::6]]
    note(benchmark, "world", len(worlds), "test_partial_view_reference")
    benchmark(lambda: [view(world).ids for world in worlds])


@pytest.mark.benchmark(group="what an agent may do and sees")
def test_partial_view_reference(benchmark):
    worlds = [(world, graph) for (world, _), (graph, _) in zip(plain("own homes"), benchmark_cases.own(), strict=True)]
    note(benchmark, "world", len(worlds))

    def seen(world: PlainWorld, ids: list[int]) -> list[int]:
        room = world.room(world.me)
        return [one for one in ids if world.room(one) == room and not world.hidden(one)]

    benchmark(lambda: [seen(world, [node.id for node in graph.nodes]) for world, graph in worlds])


SIZES = [300, 3_000, 30_000]


@pytest.mark.parametrize("things", SIZES)
@pytest.mark.benchmark(group="steps in homes of any size")
def test_steps_in_large_homes(benchmark, things):
    graph = benchmark_cases.large(things)
    world, program = World.start(Home.from_graph(graph, "", default())), benchmark_cases.errands(graph)
    assert isinstance(final(world, program), World)
    note(benchmark, "step", len(program.steps), "test_steps_in_large_homes[300]" if things > 300 else "")
    benchmark.pedantic(lambda: final(world, program), rounds=20, iterations=3, warmup_rounds=1)
