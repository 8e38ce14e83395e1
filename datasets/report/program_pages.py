"""The data of a program's page: steps, preconditions, runs tick by tick, repairs, graphs, frames."""

from collections import defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import replace
from difflib import SequenceMatcher
from functools import cache, cached_property, partial
from typing import Any

from hearth.datasets.dataset import Dataset
from hearth.datasets.format.row_conversion import change_of, edges_of, program_of
from hearth.datasets.report.copied_pictures import shown_as
from hearth.schemas.graph import Edge, Node
from hearth.schemas.graph_change import Change, WorkingGraph
from hearth.schemas.published_rows import ProgramRow, RepairedRow
from hearth.schemas.row_types import ConditionRow, DifferenceRow, FailureRow, RepairRow, Row
from hearth.schemas.syntax import print_step

DRAWN = frozenset({"ON", "INSIDE", "FACING", "HOLDS_RH", "HOLDS_LH"})
"""Drawn relations; CLOSE and BETWEEN would hide them."""

_MOST_RELATIONS = 40


class Stories:
    """The data of programs' pages. Homes are read once; the cost of a run is proportional to its changes."""

    def __init__(self, dataset: Dataset) -> None:
        self.dataset = dataset
        self._home = cache(partial(_Home, dataset))

    @cached_property
    def pictures(self) -> dict[str, str]:
        """Return the report's name for each picture and film."""
        return shown_as(self.dataset)

    @cached_property
    def frames(self) -> dict[str, list[Row]]:
        """Pictures by execution, sorted by tick."""
        query = """SELECT execution_id, tick, camera, file FROM frames WHERE modality = 'rgb'
            ORDER BY execution_id, tick, camera = 'top' DESC, camera"""
        found: dict[str, list[Row]] = defaultdict(list)
        for execution_id, tick, camera, file in self.dataset.rows(query)[1]:
            if file in self.pictures:
                found[execution_id].append({"tick": tick, "camera": camera, "file": self.pictures[file]})
        return found

    @cached_property
    def films(self) -> dict[str, Row]:
        """Execution id -> its film's file, and the second at which each tick starts; tick 0 is before all steps."""
        query = "SELECT execution_id, file, list_transform(steps, lambda s: s.start) FROM videos ORDER BY 1, 2"
        found = self.dataset.rows(query)[1]
        return {
            name: {"file": self.pictures[file], "starts": starts or []}
            for name, file, starts in found
            if file in self.pictures
        }

    def story(self, program: ProgramRow, runs: Iterable[Any], repairs: Iterable[RepairedRow]) -> Row:
        """One program as JSON.

        Args:
            program: a row of `programs`.
            runs: its rows of `executions`, each with its `environment`; edges are limited to `DRAWN`, and each tick has
                the numbers of added and removed edges.
            repairs: its rows of `repairs`, in order.
        """
        steps = program_of(program).steps
        several = any(step.agent for step in steps)
        return {
            "id": program["program_id"],
            "parent": program["parent_id"],
            "title": program["title"],
            "description": program["description"],
            "origin": program["origin"],
            "activity": program["activity_id"],
            "split": program["split"],
            "steps": [print_step(step, several) for step in steps],
            "runs": [self._run(run) for run in runs],
            "repairs": [_repair(row) for row in repairs],
        }

    def _run(self, run: Row) -> Row:
        home, environment = self._home(run["home"]), run["environment"]
        names = {**home.names, **{node["id"]: node["class_name"] for node in environment["added_nodes"]}}
        bound = [binding["node"] for binding in run["bindings"]]
        shown = {*bound, *home.characters}
        start = home.around(shown, environment)
        final = start.copy().apply(*(_about(change_of(tick), shown) for tick in run["ticks"]))
        failure = run["failure"]
        return {
            "id": run["execution_id"],
            "home": run["home"],
            "failure": failure and _failure(failure),
            "conditions": [_condition(row) for row in environment["conditions"]],
            "ticks": [_tick(tick, names) for tick in run["ticks"]],
            "start": _graph(start, names, shown, home.characters),
            "final": _graph(final, names, shown, home.characters),
            "frames": self.frames.get(run["execution_id"], []),
            "film": self.films.get(run["execution_id"]),
        }


class _Home:
    def __init__(self, dataset: Dataset, name: str) -> None:
        graph = dataset.home(name)
        self.names = {node.id: node.class_name for node in graph.nodes}
        self.nodes = {node.id: node for node in graph.nodes}
        self.characters = {node.id for node in graph.nodes if node.class_name == "character"}
        self.edges: dict[int, set[Edge]] = defaultdict(set)
        for edge in graph.edges:
            if edge.relation in DRAWN:
                self.edges[edge.source].add(edge)
                self.edges[edge.target].add(edge)

    def around(self, shown: set[int], environment: DifferenceRow) -> WorkingGraph:
        """Return the nodes in `shown` at the start, and their edges."""
        edges = (edge for node in shown for edge in self.edges.get(node, ()))
        graph = WorkingGraph((self.nodes[node] for node in shown & self.nodes.keys()), edges)
        change = replace(
            change_of(environment),
            added_nodes=tuple(
                Node(node["id"], node["class_name"], states=tuple(node["states"]))
                for node in environment["added_nodes"]
            ),
            removed_nodes=tuple(environment["removed_nodes"]),
        )
        return graph.apply(_about(change, shown))


def _about(change: Change, shown: set[int]) -> Change:
    return change.where(lambda edge: edge.source in shown or edge.target in shown, shown.__contains__)


def _graph(graph: WorkingGraph, names: dict[int, str], shown: set[int], people: set[int]) -> Row:
    # Rooms contain everything, and pictures face everything. Only locations of named things, and nodes that characters
    # face, are shown.
    kept = sorted(e for e in graph.edges if e.source in shown and (e.relation != "FACING" or e.source in people))
    kept = kept[:_MOST_RELATIONS]
    nodes = sorted({*(end for edge in kept for end in (edge.source, edge.target)), *(shown & graph.nodes.keys())})
    states = {node: sorted(known.states) for node, known in graph.nodes.items()}
    return {
        "nodes": [[node, names.get(node, "?"), states.get(node, [])] for node in nodes],
        "edges": [list(edge) for edge in kept],
    }


def _tick(tick: Row, names: dict[int, str]) -> Row:
    return {"steps": tick["steps"], "changes": list(_changes(tick, names))}


def _changes(tick: Row, names: dict[int, str]) -> Iterator[str]:
    def name(node: int) -> str:
        return f"{names.get(node, '?')} ({node})"

    yield from (f"{name(row['node'])} is {row['state']}" for row in tick["set_states"])
    edges = list(edges_of(tick["added"]))[:6]
    yield from (f"{name(edge.source)} {edge.relation} {name(edge.target)}" for edge in edges)
    more, fewer = tick["came"] - len(edges), tick["went"]
    if more or fewer:
        yield f"{more} more edges, {fewer} fewer"


def _condition(row: ConditionRow) -> str:
    objects = ", ".join(f"{each['name']} {each['instance']}" for each in row["objects"])
    return f"{row['name']}({objects})"


def _failure(row: FailureRow) -> Row:
    return {name: row[name] for name in ("code", "tick", "action", "expected", "actual", "names")}


def _repair(row: RepairRow) -> Row:
    removed, added = _differing(row["before"], row["after"])
    shown = {"handler": row["handler"], "removed": removed, "added": added}
    return {**shown, "attempt": row["attempt"], "step": row["step"], "failure": _failure(row["failure"])}


def _differing(before: list[str], after: list[str]) -> tuple[list[str], list[str]]:
    """Return the lines that a repair removes and adds."""
    pairs = [
        (before[i:j], after[k:n])
        for tag, i, j, k, n in SequenceMatcher(None, before, after, autojunk=False).get_opcodes()
        if tag != "equal"
    ]
    return [line for lines, _ in pairs for line in lines], [line for _, lines in pairs for line in lines]
