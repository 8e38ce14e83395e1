"""Action set 3 read plainly: the literals of acts, and processes as a count for each thing, in dicts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from hearth.kb.formula import And
from hearth.kb.knowledge import Knowledge
from hearth.kb.knowledge_records import Action, Process
from hearth.schemas.failures import Code
from hearth.schemas.literals import Literal
from oracles.facts import Facts
from oracles.formulas import Changes, changes, first_failure, holds

Counts = Mapping[tuple[str, int], int]
"""(process, thing) -> the ticks for which it has gone on."""


def own(action: Action) -> Action:
    """An act that only set 3 executes, with its checks and effects where those of set 2 stand."""
    assert action.later is not None
    return replace(action, preconditions=action.later.preconditions, effects=action.later.effects)


def excused(knowledge: Knowledge, facts: Facts, action: Action, binding: Mapping[str, int], code: Code) -> bool:
    """Return whether set 3 lets a check of set 2 pass: each action has one such check at most, its last."""
    assert action.later is not None
    return any(each.code is code and holds(knowledge, facts, each.formula, binding) for each in action.later.unless)


def refused(knowledge: Knowledge, facts: Facts, action: Action, binding: Mapping[str, int], options) -> Code | None:
    """The code of the first check that does not hold."""
    failed = first_failure(knowledge, facts, own(action), binding, options)
    return failed.code if failed else None


def followed(knowledge: Knowledge, before: Facts, after: Facts, action: Action, binding, options) -> Facts:
    """The world after what set 3 adds: conditions are read in the world before."""
    if action.later is None:
        return after
    return after.after(changes(knowledge, before, own(action), binding, options))


def going_on(knowledge: Knowledge, facts: Facts, process: Process, lacking: str = "") -> set[int]:
    """The things for which a process goes on; `lacking` is a state of which it does not ask whether it is there yet."""
    parts = process.condition.parts if isinstance(process.condition, And) else (process.condition,)
    parts = tuple(part for part in parts if str(part) != f"not state(x, {lacking})")
    formula = And(parts)
    device = any(isinstance(part, Literal) and part.name in ("INSIDE", "ON") for part in parts)
    found = set()
    for x in facts.nodes():
        if device and facts.by_id[x].class_name == "character":
            continue
        for d in facts.nodes() if device else (x,):
            if holds(knowledge, facts, formula, {"x": x, "d": d}):
                found.add(x)
    return found


def tick(knowledge: Knowledge, facts: Facts, counts: Counts) -> tuple[Facts, Counts]:
    """The world one tick later, after what the characters did."""
    now: dict[tuple[str, int], int] = {}
    removed, added, gone = set(), set(), set()
    for process in knowledge.processes.values():
        things = going_on(knowledge, facts, process)
        for effect in process.effects:
            if effect.literal.negated:
                state = effect.literal.terms[1].name
                for other in knowledge.processes.values():
                    if any(str(each.literal) == f"state(x, {state})" for each in other.effects):
                        things -= going_on(knowledge, facts, other, state)
        for x in things:
            count = counts.get((process.name, x), 0) + 1
            if count < process.after:
                now[process.name, x] = count
                continue
            for literal in (effect.literal for effect in process.effects):
                if literal.name == "gone":
                    gone.add(x)
                elif literal.negated:
                    removed.add(("state", x, literal.terms[1].name))
                else:
                    added.add(("state", x, literal.terms[1].name))
    # Of states that exclude each other the last to begin, in the order of the processes, holds.
    for process in knowledge.processes.values():
        for effect in process.effects:
            if effect.literal.name == "state" and not effect.literal.negated:
                name = effect.literal.terms[1].name
                removed |= {("state", x, other) for _, x, n in added if n == name for other in knowledge.excludes(name)}
    return facts.after(Changes(frozenset(removed - added), frozenset(added), {}, frozenset(gone))), now
