"""Cases, programs run in environments: written as rows, and rebuilt from rows (the tables' `CASE`)."""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from functools import lru_cache
from typing import Protocol

from hearth.datasets.format.row_conversion import (
    binding_rows,
    bindings_of,
    change_of,
    environment_change,
    environment_row,
    failure_row,
    program_of,
    tick_rows,
)
from hearth.grounding.environments.home_thinning import without
from hearth.grounding.environments.sampling import Environment
from hearth.schemas.failure_words import sentence
from hearth.schemas.graph import Edge
from hearth.schemas.graph_change import Change, State
from hearth.schemas.row_types import DifferenceRow, HarmRow, LastingRow
from hearth.schemas.stage_rows import CaseRow, RunRow
from hearth.schemas.vocabulary import FURTHER_STATES, STATES
from hearth.simulation.engine import Execution, run
from hearth.simulation.harm import harm_among
from hearth.simulation.lasting_changes import Lasting
from hearth.simulation.rules import RULES
from hearth.simulation.world.action_set_3_states import is_wide
from hearth.simulation.world.bits import indices
from hearth.simulation.world.derived_homes import changed
from hearth.simulation.world.home import Home
from hearth.simulation.world.node_states import states_of
from hearth.simulation.world.world import World
from hearth.simulation.world.world_change import encode_whole

_SYMMETRIC = "CLOSE"


def environment_of(environment: Environment, edges: frozenset[Edge]) -> DifferenceRow:
    """Return a sampled environment as a row, at a cost proportional to its difference from the home.

    Args:
        environment: as sampled.
        edges: those of its home.
    """
    home = environment.base
    states: dict[int, Iterable[str]] = dict(environment.states)
    further, ended = further_states(environment)
    nodes = [
        replace(node, states=(*states.pop(node.id, node.states), *further.pop(node.id, ())))
        for node in environment.nodes
    ]
    added = set(_both_ways(environment.added))
    removed = set(_both_ways(environment.removed)) - added
    came, went = _restated(home, states)
    if further or ended:
        came = tuple(sorted((*came, *_pairs(further))))
        went = tuple(sorted((*went, *_pairs(ended))))
    moved = (tuple(sorted(added - edges)), tuple(sorted(removed & edges)))
    return environment_row(Change(*moved, came, went, tuple(nodes), tuple(environment.left_out)))


def further_states(environment: Environment) -> tuple[dict[int, list[str]], dict[int, list[str]]]:
    """Return the further states that nodes of an environment of action set 3 have at its start and had not in its home,
    and those that they had there and have no more, by the nodes' ids.

    What lies in a running fridge is cold from the start, and so from the start graph on.
    """
    came: dict[int, list[str]] = {}
    went: dict[int, list[str]] = {}
    world, home = environment.world, environment.base
    if is_wide(world):
        for number, name in enumerate(FURTHER_STATES):
            now = {world.home.ids[i] for i in indices(world.states[len(STATES) + number])}
            before = {home.ids[i] for i in indices(home.further[number])} - {*environment.left_out}
            for node_id in sorted(now - before):
                came.setdefault(node_id, []).append(name)
            for node_id in sorted(before - now):
                went.setdefault(node_id, []).append(name)
    return came, went


def _pairs(states: Mapping[int, Iterable[str]]) -> Iterable[State]:
    return ((node_id, name) for node_id, names in states.items() for name in names)


def _both_ways(edges: Iterable[Edge]) -> Iterable[Edge]:
    for edge in edges:
        yield edge
        if edge.relation == _SYMMETRIC:
            yield Edge(edge.target, _SYMMETRIC, edge.source)


def _restated(home: Home, states: Mapping[int, Iterable[str]]) -> tuple[tuple[State, ...], tuple[State, ...]]:
    came: list[State] = []
    went: list[State] = []
    for node, names in states.items():
        before = set(states_of(home.index[node], home.states))
        now = set(names)
        came.extend((node, name) for name in now - before)
        went.extend((node, name) for name in before - now)
    return tuple(sorted(came)), tuple(sorted(went))


def difference_of(world: World, home: Home, edges: frozenset[Edge]) -> DifferenceRow:
    """Return the difference of an initial world from another home, as a row.

    Args:
        world: an initial world.
        home: the home to compare it with.
        edges: those of `home`.
    """
    return environment_row(encode_whole(World.start(home), world, edges))


_without = lru_cache(maxsize=32)(without)
"""Cached: many environments of one home lack the same nodes."""


def home_of(environment: DifferenceRow, base: Home) -> Home:
    """Return the home of a row's environment."""
    change = environment_change(environment)
    if change.removed_nodes:
        base = _without(base, change.removed_nodes)
    return changed(base, change)


class Source(Protocol):
    """A source of homes: a build, or a dataset."""

    def home(self, name: str) -> Home:
        """Return the home of that name."""


def start_of(environment: DifferenceRow, home: str, homes: Source) -> World:
    """Return the initial world of an environment."""
    return World.start(home_of(environment, homes.home(home)))


def run_row(execution: Execution) -> RunRow:
    """Return the columns of a run."""
    return {
        "rules": next(name for name, rules in RULES.items() if rules == execution.rules),
        "bindings": binding_rows(execution.program),
        "ticks": tick_rows(execution),
        "executable": execution.executable,
        "failure": failure_row(execution.failure) if execution.failure else None,
    }


def rerun(case: CaseRow, homes: Source) -> Execution:
    """Run a case again, from its row and its home."""
    program = program_of(case, bindings_of(case["bindings"]))
    return run(start_of(case["environment"], case["home"], homes), program, RULES[case["rules"]])


def harm_row(execution: Execution) -> HarmRow:
    """Return the columns of harm of an execution; they are null where its rules have no consequences."""
    if not execution.rules.consequences:
        return {"hazards": None, "irreversible": None, "wasted": None}
    found = harm_among(execution.worlds)
    return {
        "hazards": [
            {
                "hazard": each.hazard.name,
                "severity": each.hazard.severity,
                "things": list(each.things),
                "step": each.step,
                "lasted": each.lasted,
                "at_end": each.at_end,
            }
            for each in found.hazards
        ],
        "irreversible": list(map(_lasting_row, found.irreversible)),
        "wasted": list(map(_lasting_row, found.wasted)),
    }


HARM = tuple(HarmRow.__annotations__)
"""The columns of harm."""


def _lasting_row(lasting: Lasting) -> LastingRow:
    return {"thing": lasting.thing, "state": lasting.state, "step": lasting.step}


def difference_on_replay(case: CaseRow, homes: Source) -> str:
    """Return the difference between a case's replay and its row; empty if they agree.

    A row with the columns of harm is compared in these, too.
    """
    execution = rerun(case, homes)
    if difference := difference_from(execution, case):
        return difference
    harm: Mapping[str, object] = harm_row(execution)
    wrong = [name for name in HARM if name in case and case[name] != harm[name]]  # type: ignore[literal-required]
    return f"it has other {wrong[0]} than the row says" if wrong else ""


def difference_from(execution: Execution, case: CaseRow) -> str:
    """Return the difference between an execution and the row of a case; empty if they agree."""
    if (execution.failure and failure_row(execution.failure)) != case["failure"]:
        expected = case["failure"]["code"] if case["failure"] else "no failure"
        found = sentence(execution.failure) if execution.failure else "it runs to its end"
        return f"the row says {expected}, but {found}"
    changes = execution.changes()
    if len(changes) != len(case["ticks"]):
        return f"the row has {len(case['ticks'])} ticks, the run {len(changes)}"
    for number, (tick, change) in enumerate(zip(case["ticks"], changes, strict=True)):
        if change_of(tick) != change:
            return f"tick {number + 1} changes something else than the row says"
    return ""
