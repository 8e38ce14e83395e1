"""Scene graphs tried out: classes, boxes, faults, things in each other, and programs that run."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import combinations
from typing import Any

from hearth.analysis.programs_in_homes import Script, scripts
from hearth.grounding.grounded_run import attempt
from hearth.homes.from_graph.graph_layout import lay_out
from hearth.homes.from_graph.layout_from_boxes import has_geometry
from hearth.homes.geometry import intrusion
from hearth.homes.lint import lint
from hearth.homes.object_shapes import form
from hearth.kb.knowledge import Knowledge
from hearth.schemas.failures import Failure
from hearth.schemas.graph import EnvironmentGraph, Node
from hearth.schemas.program import Program
from hearth.schemas.rng import rng
from hearth.simulation.world.home import Home

DEEP = 0.05
"""Metres by which pieces of furniture may stand in each other."""


@dataclass(slots=True)
class HomeTrial:
    """A scene graph, tried out.

    Attributes:
        home: its name.
        nodes, bound: nodes, and those of classes that the knowledge has.
        unknown: other class names, each with its number of nodes.
        boxes, used: nodes with a box in the file, and boxes that pictures show as they are in the file.
        laid_out: nodes that got a place by their relations, as the rooms have no boxes.
        in_each_other: pairs of furniture that stand in each other, by label.
        faults: of `home lint`, by code.
        programs, ran: programs of which the home has every thing, and those that ran there.
        failures: why others did not, by code.
    """

    home: str
    nodes: int
    bound: int
    unknown: dict[str, int]
    boxes: int
    used: int
    laid_out: int
    in_each_other: list[str]
    faults: dict[str, int]
    programs: int = 0
    ran: int = 0
    failures: dict[str, int] = field(default_factory=dict)

    def row(self) -> tuple[Any, ...]:
        """Return the figures of a table's row."""
        return (self.home, f"{self.bound} of {self.nodes}", f"{self.used} of {self.boxes}", self.laid_out,
                len(self.in_each_other), sum(self.faults.values()), f"{self.ran} of {self.programs}")  # fmt: skip


def drawn(sources: Sequence[str], knowledge: Knowledge, seed: int) -> list[Program]:
    """Return the programs of sources in an order that the seed decides."""
    read = [script.program for script in scripts(sources, knowledge) if isinstance(script, Script)]
    rng(seed, "home trials", "").shuffle(read)
    return read


def tried(
    graph: EnvironmentGraph, name: str, programs: Sequence[Program], count: int, knowledge: Knowledge, seed: int = 0
) -> HomeTrial:
    """Return what can be done with a graph.

    Args:
        graph: the graph as its file has it.
        name: what to call it.
        programs: in the order in which they are tried, see `drawn`.
        count: number of programs to run, of those whose things the graph has.
        knowledge: of classes.
        seed: of environments.

    Raises:
        HearthError: NO_ROOM, or faults of a graph that is not a home.
    """
    unknown = Counter(node.class_name for node in graph.nodes if knowledge.object_class(node.class_name) is None)
    boxes = sum(node.box is not None for node in graph.nodes)
    measured = has_geometry(graph)
    shown = graph if measured else lay_out(graph, name, knowledge).graph
    trial = HomeTrial(
        name,
        len(graph.nodes),
        len(graph.nodes) - sum(unknown.values()),
        dict(sorted(unknown.items())),
        boxes,
        boxes if measured else 0,
        0 if measured else sum(node.box is not None for node in shown.nodes),
        list(_in_each_other(shown, knowledge)),
        dict(sorted(Counter(str(fault.code) for fault in lint(graph, knowledge)).items())),
    )
    home = Home.from_graph(shown, name, knowledge)
    failures: Counter[str] = Counter()
    for program in _fitting(programs, home):
        if trial.programs == count:
            break
        result = attempt(program, home, seed)
        failure = result if isinstance(result, Failure) else result.execution.failure
        trial.programs += 1
        trial.ran += failure is None
        failures.update([str(failure.code)] if failure is not None else [])
    trial.failures = dict(sorted(failures.items()))
    return trial


def _fitting(programs: Sequence[Program], home: Home) -> Iterator[Program]:
    """Yield the programs of which a home has every thing."""
    for program in programs:
        names = {ref.name for step in program.steps for ref in step.objects}
        if names and all(home.instances(name) for name in names):
            yield program


def _in_each_other(graph: EnvironmentGraph, knowledge: Knowledge) -> Iterator[str]:
    """Yield pairs of furniture on the floor that stand in each other, `table (355) in couch (352)`."""
    standing = [node for node in graph.nodes if _stands(node, knowledge)]
    for one, other in combinations(standing, 2):
        if one.box is not None and other.box is not None and intrusion(one.box, other.box) > DEEP:
            yield f"{one.class_name} ({one.id}) in {other.class_name} ({other.id})"


def _stands(node: Node, knowledge: Knowledge) -> bool:
    shaped = form(node.class_name, knowledge)
    return node.box is not None and node.category == "Furniture" and shaped is not None and shaped.mount == "floor"
