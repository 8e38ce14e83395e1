"""Changes that come by themselves, read from `processes.yaml`: rows that never end or undo each other are refused."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import permutations

from hearth.kb.formula import GONE, TRUE, And, Effect, Formula, Term, free, parse_effect, parse_formula
from hearth.kb.knowledge_records import Process, StateGroup
from hearth.kb.loading.entry_shapes import LIST, TEXT, parts
from hearth.kb.loading.formula_checks import Derived, check_effect, check_formula
from hearth.kb.loading.layers import Layers, parsed, yaml_entries
from hearth.kb.loading.source_files import Entry, Faults, strings
from hearth.schemas.literals import Literal

_KEYS = ("while", "after", "becomes", "seen", "at_start")
_SHAPES = {"while": TEXT, "becomes": LIST, "seen": TEXT}

MOST_TICKS = 1_000
"""Of a process: a row that takes longer never ends for anybody who watches."""

BESIDE = ("INSIDE", "ON")
"""The relations by which a process may join a thing to its device."""

ABOUT = ("state", "property", "class", "class_contains")
"""The predicates of one thing that a process may ask for."""


def load_processes(layers: Layers, derived: Derived, groups: Groups, faults: Faults) -> dict[str, Process]:
    """Return the processes by name, in the order of the file."""
    found: dict[str, Process] = {}
    entries = yaml_entries(layers, "processes.yaml", faults)
    for number, (name, entry) in enumerate(entries.items()):
        process = _process(name, number, entry, derived, groups, faults)
        if process is not None:
            found[name] = process
    for one, other in permutations(found.values(), 2):
        if _leads(one, other) and _leads(other, one) and one.id < other.id:
            faults.at(entries[other.name], f"`{one.name}` and `{other.name}` lead to each other for ever", _REMEDY)
        elif one.id < other.id and _contrary(one, other, groups) and not _exclusive(one, other):
            faults.at(entries[other.name], f"`{one.name}` and `{other.name}` undo each other for ever", _REMEDY)
    return found


_REMEDY = "let one of them ask for a state that excludes the other"


def _process(name: str, number: int, entry: Entry, derived: Derived, groups: Groups, faults: Faults) -> Process | None:
    fields = parts(entry.value, _SHAPES, name, entry, faults)
    for key in sorted(fields.keys() - {*_KEYS}):
        faults.at(entry, f"`{key}` is not part of a process", f"parts are {', '.join(_KEYS)}")
    missing = [key for key in ("while", "after", "becomes") if fields.get(key) in (None, "", [])]
    if missing:
        faults.at(entry, f"the process `{name}` lacks `{missing[0]}`", "while, after and becomes")
        return None
    after = fields["after"]
    if type(after) is not int or not 0 < after <= MOST_TICKS:
        faults.at(entry, f"`after` of {name} is {after!r:.40}: it never ends", f"a number of ticks to {MOST_TICKS}")
        return None
    condition = parsed(parse_formula, fields["while"], entry, faults)
    effects = tuple(e for text in strings(fields["becomes"]) if (e := parsed(parse_effect, text, entry, faults)))
    if condition is None or not effects:
        return None
    _check(name, condition, effects, derived, entry, faults)
    if not ended_by(condition, effects, groups):
        remedy = "ask that it is not so yet"
        faults.at(entry, f"`{name}` never ends: what it makes true leaves what it waits for", remedy)
    if type(at_start := fields.get("at_start", False)) is not bool:
        faults.at(entry, f"`at_start` of {name} is {at_start!r:.40}", "true or false")
    return Process(name, number, condition, after, effects, str(fields.get("seen") or ""), at_start is True)


def _check(
    name: str, condition: Formula, effects: tuple[Effect, ...], derived: Derived, entry: Entry, faults: Faults
) -> None:
    check_formula(condition, {"x", "d"}, name, derived, entry, faults)
    asked = list(literals(condition))
    joins = [each for each in asked if each.name in BESIDE]
    for each in asked:
        if each.name not in (*ABOUT, *BESIDE) or (each.name in BESIDE and each.negated):
            faults.at(entry, f"`{each}` is nothing that a process asks for", f"of one thing: {', '.join(ABOUT)}")
    if any(not isinstance(part, Literal) for part in _parts(condition)):
        faults.at(entry, f"`{condition}` is more than literals joined by `&`", "one row for each case")
    if "x" not in free(condition) or len(joins) != ("d" in free(condition)):
        faults.at(entry, f"`{condition}` does not say which x", "with a device d, one `INSIDE(x, d)` or `ON(x, d)`")
    if not any(each.name == "state" and not each.negated for each in asked):
        faults.at(entry, f"nothing starts `{name}`", "ask for a state that x or d has to be in, such as `state(d, ON)`")
    for effect in effects:
        check_effect(effect, {"x"}, name, derived, entry, faults)
        if effect.condition != TRUE or effect.variables or effect.literal.name not in ("state", GONE):
            faults.at(entry, f"`{effect}` is not a state that x enters", "`state(x, HOT)`, `gone(x)`")


def literals(condition: Formula) -> Iterator[Literal[Term]]:
    """Return the literals of a condition."""
    return (part for part in _parts(condition) if isinstance(part, Literal))


def _parts(condition: Formula) -> tuple[Formula, ...]:
    return condition.parts if isinstance(condition, And) else (condition,)


Groups = Mapping[str, StateGroup]


def ended_by(condition: Formula, effects: tuple[Effect, ...], groups: Groups) -> frozenset[str]:
    """Return the states by which the effects deny a part of the condition, so that the process ends."""
    asked = {each.terms[1].name: each.negated for each in literals(condition) if str(each.atom).startswith("state(x,")}
    found = set()
    for literal in (effect.literal for effect in effects):
        if literal.name == GONE:
            return frozenset({GONE})
        state = literal.terms[1].name
        left = {state} if literal.negated else excluded(state, groups)
        found |= {name for name in left if asked.get(name) is False}
        if not literal.negated and asked.get(state) is True:
            found.add(state)
    return frozenset(found)


def excluded(state: str, groups: Groups) -> set[str]:
    """Return the states that cannot hold together with one."""
    return {other for each in groups.values() if each.exclusive and state in each.states for other in each.states} - {
        state
    }


def _leads(one: Process, other: Process) -> bool:
    """Return whether one makes a state for which the other waits."""
    asked = {str(each) for each in literals(other.condition) if each.name == "state" and not each.negated}
    return any(str(effect.literal) in asked for effect in one.effects)


def _contrary(one: Process, other: Process, groups: Groups) -> bool:
    """Return whether they make states of a thing that exclude each other, and nothing else ends them."""
    made = [_made(process) for process in (one, other)]
    clash = {(a, b) for a in made[0] for b in made[1] if b in excluded(a, groups)}
    states = {name for pair in clash for name in pair}
    return bool(clash) and all(ended_by(p.condition, p.effects, groups) <= states for p in (one, other))


def _made(process: Process) -> set[str]:
    return {e.literal.terms[1].name for e in process.effects if e.literal.name == "state" and not e.literal.negated}


def _exclusive(one: Process, other: Process) -> bool:
    """Return whether no thing can be in both at once: by opposite states, other devices, or other classes."""
    first = {(str(each.atom), each.negated) for each in literals(one.condition)}
    if any((str(each.atom), not each.negated) in first for each in literals(other.condition)):
        return True
    for thing in ("d", "x"):
        mine, theirs = (_kind(process, thing) for process in (one, other))
        if mine and theirs and mine != theirs:
            return True
    return False


def _kind(process: Process, thing: str) -> frozenset[str]:
    """Return the class of a thing that a process asks for, else what it is used for."""
    asked = [each for each in literals(process.condition) if each.terms[0].name == thing and not each.negated]
    classes = frozenset(each.terms[1].name for each in asked if each.name == "class")
    of_device = (each.terms[1].name for each in asked if each.name == "property" and thing == "d")
    return classes or frozenset(of_device)
