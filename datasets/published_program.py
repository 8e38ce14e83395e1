"""A program of a dataset with its runs, repairs and sketches."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from hearth.datasets.damage_faults import reading
from hearth.datasets.stored_homes import StoredHome
from hearth.schemas.graph import EnvironmentGraph, to_release
from hearth.schemas.graph_change import WorkingGraph, in_states
from hearth.schemas.literals import RENAMED
from hearth.schemas.program import Program
from hearth.schemas.published_rows import ProgramRow, RepairedRow, StoredRunRow
from hearth.schemas.row_types import ConditionRow
from hearth.schemas.short_repr import cut
from hearth.schemas.stage_rows import SketchRow

if TYPE_CHECKING:
    import networkx


@dataclass(frozen=True, slots=True)
class Entry:
    """A program of a dataset.

    Attributes:
        row: as in the table `programs`.
        runs: its executions; those in which it fails only if the dataset was opened with `failures`.
        repairs: the repairs that made it from its parent, in order; empty for originals.
        sketches: the steps that people kept as its gist.
    """

    row: ProgramRow
    runs: tuple[Run, ...]
    repairs: tuple[RepairedRow, ...]
    sketches: tuple[SketchRow, ...] = ()

    def __repr__(self) -> str:
        name, title = (cut(repr(self.row[key]), 60) for key in ("program_id", "title"))
        return f"Entry({name}, {title}, {len(self.row['steps'])} steps, {len(self.runs)} runs)"

    @property
    def program(self) -> Program:
        """Return the program, unbound."""
        from hearth.datasets.format.row_conversion import program_of

        with reading(self.row.get("place") or self.row["program_id"]):
            return program_of(self.row)

    @property
    def title(self) -> str:
        """Return the activity as written."""
        return self.row["title"]

    @property
    def description(self) -> str:
        """Return the description as written."""
        return self.row["description"]


@dataclass(frozen=True)
class Run:
    """One execution of a program: its row, and its graphs after each tick.

    Attributes:
        row: as in the table `executions`, with its environment.
        homes: gives a home of its dataset by name.
        folder: of its dataset, for messages.
    """

    row: StoredRunRow
    homes: Callable[[str], StoredHome] = field(repr=False)
    folder: Path = field(repr=False)

    def __repr__(self) -> str:
        ended = "runs" if self.row["executable"] else "fails"
        return f"Run({cut(repr(self.row['execution_id']), 120)}, {ended}, {len(self.row['ticks'])} ticks)"

    @property
    def home(self) -> str:
        """Return the name of the home that its environment was made from."""
        return self.row["home"]

    @property
    def executable(self) -> bool:
        """Return whether it ran to its end."""
        return self.row["executable"]

    @property
    def conditions(self) -> list[ConditionRow]:
        """Return the preconditions of its start, under the names of this version."""
        stored = self.row["environment"]["conditions"]
        return [{**row, "name": RENAMED.get(row["name"], row["name"])} for row in stored]

    def bindings(self) -> dict[tuple[str, int], int]:
        """Return the node id of each object in the program, by (class, instance)."""
        from hearth.datasets.format.row_conversion import bindings_of

        return bindings_of(self.row["bindings"])

    def graph(self, tick: int = 0) -> EnvironmentGraph:
        """Return the graph after `tick` ticks; nodes by id, edges sorted.

        Raises:
            IndexError: the run has fewer ticks.

        Examples:
            >>> run = hearth.load(folder)["text:milk.txt"].runs[0]
            >>> fridge = run.bindings()["fridge", 1]
            >>> [node.states for tick in (0, 3) for node in run.graph(tick).nodes if node.id == fridge]
            [('CLEAN', 'CLOSED', 'OFF', 'PLUGGED_IN'), ('CLEAN', 'OFF', 'OPEN', 'PLUGGED_IN')]
        """
        from hearth.datasets.format.row_conversion import change_of

        ticks = self.row["ticks"]
        if not 0 <= tick <= len(ticks):
            raise IndexError(f"tick {tick} of a run of {len(ticks)}")
        with reading(self.folder):
            return self._start.copy().apply(*map(change_of, ticks[:tick])).graph()

    @property
    def start(self) -> EnvironmentGraph:
        """Return the graph before the first tick."""
        return self.graph(0)

    @property
    def final(self) -> EnvironmentGraph:
        """Return the graph after the last executed tick."""
        return self.graph(len(self.row["ticks"]))

    def release_json(self, tick: int = 0) -> dict[str, Any]:
        """Return the graph as the release writes it."""
        return to_release(self.graph(tick))

    def networkx(self, tick: int = 0) -> networkx.MultiDiGraph:
        """Return the graph for networkx: a node has its class and states, an edge's key is its relation."""
        import networkx

        found: networkx.MultiDiGraph = networkx.MultiDiGraph()
        graph = self.graph(tick)
        for node in graph.nodes:
            attributes = {"class_name": node.class_name, "category": node.category, "states": list(node.states)}
            found.add_node(node.id, **attributes, properties=list(node.properties))
        found.add_edges_from((edge.source, edge.target, edge.relation) for edge in graph.edges)
        return found

    @cached_property
    def _start(self) -> WorkingGraph:
        from hearth.datasets.format.row_conversion import environment_change

        change = environment_change(self.row["environment"])
        added = tuple(in_states(node, node.states) for node in change.added_nodes)
        return self.homes(self.home).working.copy().apply(replace(change, added_nodes=added))
