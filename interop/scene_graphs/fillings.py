"""A home that was read from a file of another project, and the parts that the file left out."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.graph import EnvironmentGraph


class Filling(NamedTuple):
    """A kind of thing that was understood, filled in or left out: how often, and some of the cases."""

    what: str
    number: int
    examples: tuple[str, ...] = ()


CLASSES_BY = {
    "name": "classes by their names",
    "other name": "classes by other names",
    "table": "classes by the table of classes",
    "number left out": "classes without a number behind them",
    "adjective left out": "classes without the adjectives before them",
    "things in it": "rooms that the file only numbers, by the things in them",
    "building": "left out, as the table of classes says",
    "": "things of no class of ours, left out",
}
"""Words for the ways in which a class was found; see `ClassOf`."""


class ReadGraph(NamedTuple):
    """A home that was read from a file of another project.

    Attributes:
        graph: as ours are.
        fillings: what was understood, filled in and changed.
        left_out: entries and relations that are not in the graph, each with its place in the file.
        ids: the file's own id of each node that has one.
    """

    graph: EnvironmentGraph
    fillings: tuple[Filling, ...]
    left_out: tuple[Diagnostic, ...]
    ids: Mapping[int, str]
