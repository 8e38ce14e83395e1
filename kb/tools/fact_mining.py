"""New facts proposed from programs.

Classes used together, found in a room, near each other, and in which order (thesis 3.4).

Nothing is believed here: proposals carry counts and confidence, and are written as lines to add to a file after review.
"""

from collections import Counter
from collections.abc import Container, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import combinations, pairwise
from typing import NamedTuple

from hearth.kb.knowledge import Knowledge

ProgramSteps = Sequence[tuple[str, Sequence[str]]]
"""A program: actions with the names of their objects."""


class Proposal(NamedTuple):
    """A fact that programs suggest.

    Attributes:
        kind: `together` (objects of one program), `serves` (an object where an action is done), `placed` (ON or IN),
            `near`, `found` (in a room), `order` (of two actions on one object).
        subject: a class, or for `order` the earlier action.
        relation: what is claimed: goes_with, serves, ON, IN, NEARBY, found_in, before.
        other: a class, room or action.
        seen: in how many programs it is so.
        confidence: the share of the programs with `subject` (for `order`: with both) in which it is so.
        lift: how many times more often than chance; 1 where chance does not apply.
        known: whether we hold the fact already.
    """

    kind: str
    subject: str
    relation: str
    other: str
    seen: int
    confidence: float
    lift: float
    known: bool


@dataclass
class _Counts:
    """Observed facts, each at most once a program."""

    programs: int = 0
    names: Counter[str] = field(default_factory=Counter)
    together: Counter[tuple[str, str]] = field(default_factory=Counter)
    placed: Counter[tuple[str, str, str]] = field(default_factory=Counter)
    rooms: Counter[tuple[str, str]] = field(default_factory=Counter)
    near: Counter[tuple[str, str]] = field(default_factory=Counter)
    order: Counter[tuple[str, str]] = field(default_factory=Counter)


def mine(
    programs: Iterable[ProgramSteps], knowledge: Knowledge, least: int = 3, confidence: float = 0.3
) -> tuple[Proposal, ...]:
    """Return the facts that the programs suggest at least `least` times with at least that confidence, most confident
    first.

    Objects and actions that nobody knows are left out. Memory grows with the facts, not with the programs.
    """
    counts = _Counts()
    for program in programs:
        _count(counts, list(_known_steps(program, knowledge)), knowledge)
    found = (p for p in _proposals(counts, knowledge) if p.seen >= least and p.confidence >= confidence)
    return tuple(sorted(found, key=lambda p: (p.kind, -p.confidence, -p.seen, p.subject, p.other)))


def as_lines(proposals: Iterable[Proposal]) -> dict[str, list[str]]:
    """Return the unknown ones as rows to add, by file: a review takes lines out, then pastes the rest.

    Orders and rooms have no rows of their own: they are for the reviewer's eyes.
    """
    lines: dict[str, list[str]] = {}
    for proposal in proposals:
        if proposal.known:
            continue
        weight = 1 + round(4 * proposal.confidence)
        if proposal.kind in ("placed", "near"):
            row = f"{proposal.subject},{proposal.relation},{proposal.other},,{weight},mined"
            lines.setdefault("placements.csv", []).append(row)
        elif proposal.kind in ("together", "serves"):
            row = f"{proposal.subject},{proposal.relation},{proposal.other},{weight},mined"
            lines.setdefault("associations.csv", []).append(row)
    return {file: sorted(rows) for file, rows in sorted(lines.items())}


def _known_steps(program: ProgramSteps, knowledge: Knowledge) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Yield the steps in our words, second names resolved to first ones."""
    for action_name, object_names in program:
        action = knowledge.action(action_name)
        things = [knowledge.object_class(name) for name in object_names]
        if action is not None and all(things):
            yield action.name, tuple(thing.same_as or thing.name for thing in things if thing)


def _moves(knowledge: Knowledge) -> frozenset[str]:
    """Actions after which the character is at, or in, their object."""
    return knowledge.group("goes") | {"Enter"}


def _handling(knowledge: Knowledge) -> frozenset[str]:
    """Actions that are done on the way to a purpose; no object serves them."""
    means = frozenset().union(*map(knowledge.group, ("handling", "operates", "takes", "frees_hand")))
    return _moves(knowledge) | means - knowledge.group("dresses")


def _count(counts: _Counts, steps: list[tuple[str, tuple[str, ...]]], knowledge: Knowledge) -> None:
    def a_thing(name: str) -> bool:
        return not knowledge.is_room(name) and knowledge.objects[name].hypernym != "body_part"

    counts.programs += 1
    handling = _handling(knowledge)
    things = sorted({name for _, names in steps for name in names if a_thing(name)})
    actions = sorted({action for action, names in steps if names and action not in handling})
    counts.names.update([*things, *actions])
    counts.together.update(combinations(things, 2))
    counts.together.update((thing, action) for thing in things for action in actions)
    counts.placed.update(set(_placings(steps, knowledge)))
    counts.rooms.update(set(_findings(steps, knowledge)))
    counts.near.update({pair for pair in _neighbours(steps, knowledge) if all(map(a_thing, pair))})
    counts.order.update(set(_orders(steps, knowledge)))


def _placings(steps: list[tuple[str, tuple[str, ...]]], knowledge: Knowledge) -> Iterator[tuple[str, str, str]]:
    """Yield the things put on or in others, and the things taken from a container just opened."""
    opened = ""
    for action, names in steps:
        if action in knowledge.group("puts") and names[0] != names[1]:
            yield names[0], "ON" if action == "PutBack" else "IN", names[1]
        elif action == "Open":
            opened = names[0] if "CONTAINERS" in knowledge.objects[names[0]].properties else ""
        elif action == "Close" or action in knowledge.group("walks"):
            opened = ""
        elif action == "Grab" and opened and names[0] != opened:
            yield names[0], "IN", opened


def _findings(steps: list[tuple[str, tuple[str, ...]]], knowledge: Knowledge) -> Iterator[tuple[str, str]]:
    """Yield the room in which each thing is first used."""
    room, carried = "", set[str]()
    moves = _moves(knowledge)
    for action, names in steps:
        if action in moves and names and knowledge.is_room(names[0]):
            room = names[0]
            continue
        for name in names:
            if room and name not in carried and "BODY_PART" not in knowledge.objects[name].properties:
                yield name, room
            carried.add(name)


def _neighbours(steps: list[tuple[str, tuple[str, ...]]], knowledge: Knowledge) -> Iterator[tuple[str, str]]:
    """Yield the things within reach of a seat or bed: used while on it, not carried there, not carried at all."""
    seat, held = "", set[str]()
    leaving = _moves(knowledge) | knowledge.group("rises")
    idle = knowledge.group("looks") | {"Greet"}
    for action, names in steps:
        if action in knowledge.group("rests"):
            seat = names[0]
        elif action in leaving:
            seat = seat if action == "Find" else ""
        elif action == "Grab":
            held.update(names)
        elif seat and names and names[0] not in held and names[0] != seat:
            fixed = "GRABBABLE" not in knowledge.objects[names[0]].properties
            if fixed and action not in idle:
                yield names[0], seat


def _orders(steps: list[tuple[str, tuple[str, ...]]], knowledge: Knowledge) -> Iterator[tuple[str, str]]:
    """Successive actions on one object, looks and moves aside."""
    on: dict[str, list[str]] = {}
    aside = _moves(knowledge) | knowledge.group("idle")
    for action, names in steps:
        if names and action not in aside:
            on.setdefault(names[0], []).append(action)
    for actions in on.values():
        yield from ((first, then) for first, then in pairwise(actions) if first != then)


def _proposals(counts: _Counts, knowledge: Knowledge) -> Iterator[Proposal]:
    known = {(p.object, p.relation, p.destination) for name in knowledge.objects for p in knowledge.placements(name)}
    held = {(a.name, a.other) for a in knowledge.associations}
    for (subject, other), count in counts.together.items():
        kind = "serves" if other in knowledge.actions else "together"
        relation = "serves" if kind == "serves" else "goes_with"
        share = count / counts.names[subject]
        lift = share * counts.programs / counts.names[other]
        if lift >= 2:
            pair = (subject, other) in held or (other, subject) in held
            yield Proposal(kind, subject, relation, other, count, share, lift, pair)
    for (subject, relation, other), count in counts.placed.items():
        share = count / sum(n for (name, _, _), n in counts.placed.items() if name == subject)
        yield Proposal("placed", subject, relation, other, count, share, 1.0, (subject, relation, other) in known)
    for (subject, other), count in counts.near.items():
        share = count / counts.names[subject]
        yield Proposal("near", subject, "NEARBY", other, count, share, 1.0, (subject, "NEARBY", other) in known)
    named = {room for _, room in counts.rooms}
    serving = {room for subject, room in counts.rooms if _serves(subject, room, knowledge, named)}
    for (subject, room), count in counts.rooms.items():
        share = count / sum(n for (name, _), n in counts.rooms.items() if name == subject)
        listed = room in knowledge.objects[subject].rooms
        if listed or not (room in serving or _serves(subject, room, knowledge)):
            yield Proposal("found", subject, "found_in", room, count, share, 1.0, listed)
    for (first, then), count in counts.order.items():
        share = count / (count + counts.order.get((then, first), 0))
        yield Proposal("order", first, "before", then, count, share, 1.0, False)


def _serves(subject: str, room: str, knowledge: Knowledge, named: Container[str] = ()) -> bool:
    """Return whether a room stands in for an unnamed one where a thing belongs: the release's homes have no
    kitchen, so what it finds in the dining room belongs in a kitchen.
    """
    usual = knowledge.objects[subject].rooms
    return room not in usual and any(room in knowledge.stand_ins(name) for name in usual if name not in named)
