"""Yardsticks: each figure's work in plain Python, timed in the same run; a figure's ratio divides by its yardstick.

A yardstick does the core of the work only (it reads text without checking it, runs a program without binding it, draws
triangles without light), so a ratio may be below 1. Ratios are comparable across machines: if one falls, our code
became slower. Both sides use the least of several times.
"""

from __future__ import annotations

import json
import random
import re
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from heapq import heappop, heappush
from math import inf
from pathlib import Path
from typing import Any

import benchmark_cases
import numpy as np
import yaml
from measurement import Taken, least, passes
from numpy.typing import NDArray
from oracles import engine as reference
from oracles.world import Options
from oracles.world import World as PlainWorld

from hearth.rendering.cameras.camera import Camera
from hearth.schemas.graph import EnvironmentGraph

TIMES = 15


@dataclass
class Yardstick:
    """A number of units of plain work, and the least seconds that they take.

    A shared machine can be slow for minutes: the work is timed when the yardstick is made and again at each comparison,
    so that one of the times is close to the compared one.
    """

    units: float
    again: Callable[[], float]
    seconds: float = inf

    def __post_init__(self) -> None:
        self.seconds = min(self.seconds, self.again())

    def ratio(self, units: float, taken: Taken) -> float:
        """Our rate, for `units` in `taken` seconds, relative to the plain rate."""
        self.seconds = min(self.seconds, self.again())
        return units * self.seconds / self.units / least(taken)


def measured(units: float, work: Callable[[Any], object], items: Sequence[Any], times: int = TIMES) -> Yardstick:
    """A yardstick of plain work on each of some items, timed several times."""
    return Yardstick(units, lambda: passes(work, items, times).least)


def sampled_runs() -> Yardstick:
    """Environments built as dicts of sets, and a program of twelve steps run in each."""
    items = benchmark_cases.own()
    return measured(len(items), lambda item: reference.run(PlainWorld(item[0]), item[1], Options()), items)


def written_home() -> Yardstick:
    """Homes' nodes and edges written to JSON and read back."""
    graphs = [as_dicts(graph) for graph, _ in benchmark_cases.own()[::2]]
    return measured(len(graphs), lambda graph: json.loads(json.dumps(graph)), graphs)


def read_graph(graphs: Sequence[dict[str, Any]]) -> Yardstick:
    """Graphs read from JSON, as releases keep one for each program."""
    texts = [json.dumps(graph) for graph in graphs]
    return measured(len(texts), json.loads, texts)


def counted_relations(graphs: Sequence[dict[str, Any]]) -> Yardstick:
    """Relations counted in graphs read from JSON."""
    texts = [json.dumps(graph) for graph in graphs]
    return measured(
        len(texts), lambda text: Counter(edge["relation_type"] for edge in json.loads(text)["edges"]), texts
    )


def as_dicts(graph: EnvironmentGraph) -> dict[str, Any]:
    """A graph as JSON has it."""
    return {
        "nodes": [{"id": n.id, "class_name": n.class_name, "states": list(n.states)} for n in graph.nodes],
        "edges": [{"from_id": e.source, "relation_type": e.relation, "to_id": e.target} for e in graph.edges],
    }


def textbook_lcs(programs: Sequence[Sequence[Any]], pairs: int = 400) -> Yardstick:
    """Longest common subsequences by the table of the textbooks, of some of all pairs."""
    some = programs[: int(pairs**0.5)]
    return measured(
        len(some) ** 2, lambda pair: lcs_length(programs[pair[0]], programs[pair[1]]),
        [(a, b) for a in range(len(some)) for b in range(len(some))],
    )  # fmt: skip


def lcs_length(one: Sequence[Any], other: Sequence[Any]) -> int:
    """Length of the longest common subsequence."""
    row = [0] * (len(other) + 1)
    for mine in one:
        before = 0
        for place, theirs in enumerate(other, 1):
            before, row[place] = row[place], before + 1 if mine == theirs else max(row[place], row[place - 1])
    return row[-1]


STEP = re.compile(r"\[(\w+)\]((?:\s*<[^>]+>\s*\(\d+\))*)")
OBJECT = re.compile(r"<([^>]+)>\s*\((\d+)\)")


def read_text(texts: Sequence[str], to: Path) -> Yardstick:
    """Programs of text parsed by a regular expression, and written as lines of JSON."""

    def read(text: str) -> None:
        steps = [(action, OBJECT.findall(objects)) for action, objects in STEP.findall(text)]
        with to.open("a") as out:
            out.write(json.dumps({"title": text.partition("\n")[0], "steps": steps}) + "\n")

    return measured(len(texts), read, texts)


def split_words(texts: Sequence[str]) -> Yardstick:
    """Natural-language steps split into a verb and the rest."""
    return measured(
        len(texts), lambda text: [line.split(": ")[-1].split(" ", 1) for line in text.splitlines()[1:]], texts
    )


def drawn_steps(count: int = 2_000) -> Yardstick:
    """Random programs of twelve steps, without checks."""
    chance = random.Random(0)
    names = [f"thing{number}" for number in range(100)]
    return measured(
        count, lambda _: [f"[A{chance.randrange(40)}] <{chance.choice(names)}> (1)" for _ in range(12)], range(count)
    )


def found_by_scanning(names: Iterable[str], number: int = 200) -> Yardstick:
    """A name searched among all names in turn, ignoring case."""
    known = list(names)
    wanted = known[:: max(1, len(known) // number)]
    return measured(
        len(wanted), lambda name: next(place for place, other in enumerate(known) if other.lower() == name), wanted
    )


def read_yaml(folder: Path) -> Yardstick:
    """All YAML files of a folder read, once."""
    texts = [path.read_text("utf-8") for path in sorted(folder.glob("*.yaml"))]
    return measured(1, yaml.safe_load, texts, 3)


def lines_of_json(rows: Sequence[Any]) -> Yardstick:
    """Rows turned into lines of JSON, and read back."""
    return measured(1, lambda row: json.loads(json.dumps(row, default=str)), rows)


def strides_by_search(free: NDArray[np.bool_], ways: Sequence[tuple[int, int, int, int]]) -> Yardstick:
    """The cell a metre (ten cells) along the shortest way between two cells, by a search over the grid each time.

    Args:
        free: the grid.
        ways: (column, row) of where it begins and ends.
    """
    cells = {(int(i), int(j)) for i, j in np.argwhere(free)}
    sides = [(i, j, (i * i + j * j) ** 0.5) for i in (-1, 0, 1) for j in (-1, 0, 1) if i or j]

    def stride(way: tuple[int, int, int, int]) -> tuple[int, int]:
        start, end = way[:2], way[2:]
        far, before, queue = {end: 0.0}, {end: end}, [(0.0, end)]
        while queue:
            length, here = heappop(queue)
            if here == start:
                break
            for i, j, more in sides:
                there = here[0] + i, here[1] + j
                if there in cells and length + more < far.get(there, inf):
                    far[there], before[there] = length + more, here
                    heappush(queue, (length + more, there))
        now: tuple[int, int] = start
        while now in before and now != end and far[start] - far[now] < 10:
            now = before[now]
        return now

    return measured(len(ways), stride, ways, 3)


def z_buffer(corners: NDArray[np.floating[Any]], camera: Camera, shares: int = 50) -> Yardstick:
    """A picture of depth and of which triangle is where, one triangle after the other, without light and colour."""
    near = np.full((camera.height, camera.width), np.inf)
    owner = np.full((camera.height, camera.width), -1)
    pixels, depths = camera.project(corners.reshape(-1, 3))
    places, depths = pixels.reshape(-1, 3, 2), depths.reshape(-1, 3)
    seen = np.flatnonzero((depths > 0.05).all(1))

    def draw(numbers: NDArray[np.int64]) -> None:
        for number in numbers:
            _draw(number, places[number], depths[number], near, owner)

    return measured(1, draw, np.array_split(seen, shares), 2)


def _draw(
    number: int, corners: NDArray[np.float64], depths: NDArray[np.float64],
    near: NDArray[np.float64], owner: NDArray[np.int64],
) -> None:  # fmt: skip
    height, width = near.shape
    (left, top), (right, bottom) = np.floor(corners.min(0)).astype(int), np.ceil(corners.max(0)).astype(int)
    left, top, right, bottom = max(left, 0), max(top, 0), min(right, width), min(bottom, height)
    if left >= right or top >= bottom:
        return
    (ax, ay), (bx, by), (cx, cy) = corners
    area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
    if area == 0:
        return
    x, y = np.meshgrid(np.arange(left, right) + 0.5, np.arange(top, bottom) + 0.5)
    b = ((x - ax) * (cy - ay) - (cx - ax) * (y - ay)) / area
    c = ((bx - ax) * (y - ay) - (x - ax) * (by - ay)) / area
    depth = (1 - b - c) * depths[0] + b * depths[1] + c * depths[2]
    window = slice(top, bottom), slice(left, right)
    nearer = (b >= 0) & (c >= 0) & (b + c <= 1) & (depth < near[window])
    near[window][nearer], owner[window][nearer] = depth[nearer], number
