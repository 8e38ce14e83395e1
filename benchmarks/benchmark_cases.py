"""Inputs of the benchmarks: the release's sample if present, and our own homes and programs."""

from __future__ import annotations

import csv
import os
import random
import sys
import zipfile
from contextlib import suppress
from functools import lru_cache
from pathlib import Path
from typing import Any

import orjson

from hearth.grounding.binding import Binding, bind
from hearth.homes import library
from hearth.kb import action_grammar
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.graph import Edge, EnvironmentGraph, Node
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.schemas.syntax import parse_program
from hearth.simulation.actions.legal import legal
from hearth.simulation.engine import act
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

sys.path.append(str(Path(__file__).resolve().parents[1] / "tests"))  # for `oracles`

REAL = Path(os.environ.get("HEARTH_REAL_DATA", Path(__file__).resolve().parents[2] / "shared/real"))
SAMPLE = REAL / "activityprograms-sample.zip"
CROWD = Path(__file__).resolve().parents[1] / "data_raw/crowd/programs.csv"
TITLE = "Title\n\n\n"
PROGRAMS = 40


@lru_cache(maxsize=1)
def release() -> tuple[tuple[dict[str, Any], Program], ...]:
    """Start graphs and grounded programs of the release's sample, at most `PROGRAMS`; empty if it is absent."""
    if not SAMPLE.exists():
        return ()
    found = []
    with zipfile.ZipFile(SAMPLE) as sample:
        names = sorted(n for n in sample.namelist() if "/executable_programs/" in n and n.endswith(".txt"))
        for name in names[:: max(1, len(names) // PROGRAMS)]:
            graphs = name.replace("executable_programs", "init_and_final_graphs").replace(".txt", ".json")
            program, _ = action_grammar.check(parse_program(sample.read(name).decode(), name)[0], default())
            found.append((orjson.loads(sample.read(graphs))["init_graph"], program))
    return tuple(found)


@lru_cache(maxsize=1)
def own() -> tuple[tuple[EnvironmentGraph, Program], ...]:
    """Our homes, each with executable programs of 12 steps."""
    found = []
    for name in library.names():
        graph = library.load_graph(name, default())
        start = World.start(Home.from_graph(graph, name, default()))
        found += [(graph, _wander(start, random.Random(seed))) for seed in range(2)]
    return tuple(found)


@lru_cache(maxsize=1)
def unbound(length: int = 12) -> tuple[tuple[World, Program], ...]:
    """Unbound programs of the embedded corpus of `length` steps, with each home in which they are executable."""
    rows = csv.DictReader(CROWD.read_text("utf-8").splitlines(keepends=True))
    worlds = [
        World.start(Home.from_graph(library.load_graph(name, default()), name, default())) for name in library.names()
    ]
    found: list[tuple[World, Program]] = []
    for row in rows:
        with suppress(HearthError):
            program, faults = action_grammar.check(parse_program(TITLE + row["Answer.program"])[0], default())
            if len(program.steps) == length and not faults:
                found += [(world, program) for world in worlds if isinstance(bind(program, world), Binding)]
    return tuple(found)


def _wander(world: World, rng: random.Random, length: int = 12) -> Program:
    """Random legal steps; the action is drawn first, so that not all of them are walks."""
    steps = []
    for _ in range(length):
        possible = legal(world)
        action = rng.choice(sorted(possible.masks))
        ids = [rng.choice(possible.objects(action, k)) for k in range(len(possible.masks[action]))]
        node = world.home.node
        step = Step(action, tuple(ObjectRef(node(world.home.index[i]).class_name, 1, i) for i in ids))
        after = act(world, step)
        assert isinstance(after, World)
        world = after
        steps.append(step)
    return Program("", "", tuple(steps))


ROOM_SIZE = 75


def large(things: int) -> EnvironmentGraph:
    """A home of about `things` nodes: rooms of 75 each, with tables, fridges, lamps, and cups on and in them."""
    nodes = [Node(1, "character", "Characters")]
    edges = []
    rooms = max(2, things // ROOM_SIZE)
    for r in range(rooms):
        room = len(nodes) + 1
        nodes.append(Node(room, ("kitchen", "bedroom", "bathroom", "home_office")[r % 4], "Rooms"))
        place = room
        for k in range(ROOM_SIZE - 1):
            node_id = len(nodes) + 1
            edges.append(Edge(node_id, "INSIDE", room))
            if k % 10 == 0:
                place = node_id
                nodes.append(_place(node_id, k))
                continue
            nodes.append(Node(node_id, "cup", "Props", ("GRABBABLE", "RECIPIENT"), ("CLEAN",)))
            edges.append(Edge(node_id, "ON" if k < 40 else "INSIDE", place))
            edges.append(Edge(node_id, "CLOSE", place))
    edges.append(Edge(1, "INSIDE", 2))
    return EnvironmentGraph(tuple(nodes), tuple(edges))


def _place(node_id: int, k: int) -> Node:
    if k < 40:
        return Node(node_id, "table", "Furniture", ("SURFACES",), ("CLEAN",))
    switch = ("CAN_OPEN", "CONTAINERS", "HAS_SWITCH", "HAS_PLUG")
    return Node(node_id, "fridge", "Appliances", switch, ("CLOSED", "OFF", "PLUGGED_IN"))


def errands(graph: EnvironmentGraph, steps: int = 120) -> Program:
    """Carrying cups from table to fridge between rooms all over a large home, opening, closing and switching."""
    by_name: dict[str, list[Node]] = {}
    for node in graph.nodes:
        by_name.setdefault(node.class_name, []).append(node)
    on = {e.source for e in graph.edges if e.relation == "ON"}
    cups = [n for n in by_name["cup"] if n.id in on]
    rng = random.Random(0)
    found: list[Step] = []
    for cup in rng.sample(cups, min(len(cups), steps // 8 + 1)):
        fridge = rng.choice(by_name["fridge"])
        table = rng.choice(by_name["table"])
        for action, *things in (
            ("Walk", cup), ("Grab", cup), ("Walk", fridge), ("Open", fridge), ("PutIn", cup, fridge),
            ("Close", fridge), ("SwitchOn", fridge), ("SwitchOff", fridge), ("Walk", table), ("Wash", table),
        ):  # fmt: skip
            found.append(Step(action, tuple(ObjectRef(n.class_name, 1, n.id) for n in things)))
    return Program("", "", tuple(found))
