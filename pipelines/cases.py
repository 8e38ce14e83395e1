"""Cases: a program in an environment, run; as rows, and rebuilt from rows (the tables' `CASE`)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from functools import lru_cache
from typing import Any, Protocol

from hearth.grounding.sampling import Environment
from hearth.grounding.thinning import without
from hearth.pipelines.rows import (
    binding_rows,
    bindings_of,
    change_of,
    change_row,
    edges_of,
    failure_row,
    node_of,
    node_row,
    program_of,
    tick_rows,
)
from hearth.schemas.graph import Edge, Node
from hearth.schemas.vocabulary import STATE_ID
from hearth.simulation.change import Change
from hearth.simulation.edit import extended
from hearth.simulation.engine import Execution, run
from hearth.simulation.home import Home
from hearth.simulation.nodes import states_of
from hearth.simulation.rules import RULES
from hearth.simulation.world import World

Row = dict[str, Any]

_SYMMETRIC = "CLOSE"


def environment_of(environment: Environment, edges: frozenset[Edge]) -> Row:
    """A sampled environment as `tables.ENVIRONMENT`, at a cost that follows what differs.

    Args:
        environment: as sampled.
        edges: those of its home.
    """
    home = environment.base
    states: dict[int, Iterable[str]] = dict(environment.states)
    nodes = [replace(node, states=tuple(states.pop(node.id, node.states))) for node in environment.nodes]
    added = set(_both_ways(environment.added))
    removed = set(_both_ways(environment.removed)) - added
    came, went = _restated(home, states)
    change = Change(tuple(sorted(added - edges)), tuple(sorted(removed & edges)), came, went)
    gone = list(environment.gone)
    return {"added_nodes": [node_row(node) for node in nodes], "removed_nodes": gone, **change_row(change)}


def _both_ways(edges: Iterable[Edge]) -> Iterable[Edge]:
    for edge in edges:
        yield edge
        if edge.relation == _SYMMETRIC:
            yield Edge(edge.target, _SYMMETRIC, edge.source)


def _restated(home: Home, states: Mapping[int, Iterable[str]]) -> tuple[tuple[Any, ...], tuple[Any, ...]]:
    came: list[tuple[int, str]] = []
    went: list[tuple[int, str]] = []
    for node, names in states.items():
        before = set(states_of(home.index[node], home.states))
        now = set(names)
        came.extend((node, name) for name in now - before)
        went.extend((node, name) for name in before - now)
    return tuple(sorted(came)), tuple(sorted(went))


def difference_of(world: World, home: Home, edges: frozenset[Edge]) -> Row:
    """A world of any home, at its start, as what differs from another home, as `tables.ENVIRONMENT`.

    Args:
        world: a start.
        home: what to tell it from.
        edges: those of `home`.
    """
    known = {node_id: home.node(i) for i, node_id in enumerate(home.ids)}
    nodes = {node_id: world.home.node(i) for i, node_id in enumerate(world.home.ids)}
    removed = {node_id for node_id, node in known.items() if not _same(node, nodes.get(node_id))}
    new = [node for node_id, node in nodes.items() if node_id not in known or node_id in removed]
    kept = edges
    if removed:
        kept = frozenset(edge for edge in edges if edge.source not in removed and edge.target not in removed)
    now = frozenset(world.edges())
    states = {node_id: states_of(world.home.index[node_id], world.states) for node_id in known.keys() - removed}
    came, went = _restated(home, states)
    change = Change(tuple(sorted(now - kept)), tuple(sorted(kept - now)), came, went)
    return {"added_nodes": [node_row(node) for node in new], "removed_nodes": sorted(removed), **change_row(change)}


def _same(one: Node, other: Node | None) -> bool:
    """Whether two nodes are equal, simulated states aside."""
    return other is not None and (one == other or _still(one) == _still(other))


def _still(node: Node) -> Node:
    return replace(node, states=tuple(name for name in node.states if name not in STATE_ID))


_without = lru_cache(maxsize=32)(without)
"""Many environments of one home go without the same."""


def home_of(environment: Mapping[str, Any], base: Home) -> Home:
    """The home that a row of `tables.ENVIRONMENT` describes."""
    nodes = [node_of(row) for row in environment["added_nodes"]]
    added = list(edges_of(environment["added"]))
    removed = list(edges_of(environment["removed"]))
    states: dict[int, set[str]] = {}
    for name, came in (("cleared_states", False), ("set_states", True)):
        for row in environment[name]:
            node = row["node"]
            found = states.setdefault(node, set(states_of(base.index[node], base.states)))
            (found.add if came else found.discard)(row["state"])
    if environment["removed_nodes"]:
        base = _without(base, tuple(environment["removed_nodes"]))
    return extended(base, nodes, added, removed, {node: sorted(found) for node, found in states.items()})


class Source(Protocol):
    """Where homes come from: a build's, or a dataset's own."""

    def home(self, name: str) -> Home:
        """The home that environments of that name differ from."""


def start_of(case: Mapping[str, Any], homes: Source) -> World:
    """The world that a case starts in."""
    return World.start(home_of(case["environment"], homes.home(case["home"])))


def run_row(execution: Execution, rules: str) -> Row:
    """What a run says, as columns of `tables.CASE`."""
    return {
        "rules": rules,
        "bindings": binding_rows(execution.program),
        "ticks": tick_rows(execution),
        "executable": execution.executable,
        "failure": failure_row(execution.failure),
    }


def rerun(case: Mapping[str, Any], homes: Source) -> Execution:
    """Run a case again, from nothing but its row and its home."""
    program = program_of(case, bindings_of(case["bindings"]))
    return run(start_of(case, homes), program, RULES[case["rules"]])


def difference_on_replay(case: Mapping[str, Any], homes: Source) -> str:
    """How running a case again differs from what its row says; empty when it does not."""
    execution = rerun(case, homes)
    if failure_row(execution.failure) != case["failure"]:
        said = case["failure"]["code"] if case["failure"] else "no failure"
        found = execution.failure.message() if execution.failure else "it runs to its end"
        return f"the row says {said}, but {found}"
    changes = execution.changes()
    if len(changes) != len(case["ticks"]):
        return f"the row has {len(case['ticks'])} ticks, the run {len(changes)}"
    for number, (tick, change) in enumerate(zip(case["ticks"], changes, strict=True)):
        if change_of(tick) != change:
            return f"tick {number + 1} changes something else than the row says"
    return ""
