"""Goals of the families of `household`: one function a family. To add one: a function, a row, a line in the file."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Sequence
from random import Random
from typing import NamedTuple

from hearth.challenges.household_definition import settings
from hearth.grounding.environments.default_state import Base
from hearth.schemas.goals import Goal, Joined
from hearth.schemas.literals import AGENT, HOLDS, Literal, Name
from hearth.simulation.world.bits import indices

Wanted = tuple[Literal[Name], int]


class Places(NamedTuple):
    """The classes of a home, and where they belong.

    Attributes:
        of_thing: class of things -> (ON or INSIDE, class of furniture), each once, sorted.
        at: (ON or INSIDE, class of furniture) -> the classes of things that belong there, sorted.
        fixed: classes of furniture and devices of the home.
    """

    of_thing: dict[str, tuple[tuple[str, str], ...]]
    at: dict[tuple[str, str], tuple[str, ...]]
    fixed: frozenset[str]


def places_of(base: Base) -> Places:
    """Return where things belong in a home; made once for each home."""
    found: Places | None = base.home.worked_out.get("household places")
    if found is None:
        found = base.home.worked_out["household places"] = _places(base)
    return found


def _places(base: Base) -> Places:
    home, data = base.home, settings()
    never = base.seats | home.properties["GRABBABLE"]
    of_thing, at = {}, defaultdict(list)
    for kind in base.knowledge.objects.values():
        if "GRABBABLE" not in kind.properties or kind.same_as or kind.name in data["never"]:
            continue
        spots = {(relation, home.classes[i]) for _, i, relation in base.spots(kind.name).choices if not never >> i & 1}
        allowed = tuple(sorted(spot for spot in spots if spot[1] not in data["never_at"]))
        if allowed:
            of_thing[kind.name] = allowed
            for spot in allowed:
                at[spot].append(kind.name)
    fixed = {home.classes[i] for i in indices(home.everything & ~(home.properties["GRABBABLE"] | home.rooms))}
    return Places(of_thing, {spot: tuple(sorted(names)) for spot, names in sorted(at.items())}, frozenset(fixed))


def _put_away(base: Base, chooser: Random) -> Goal | None:
    """Return one or two classes of things that are to go where they are kept."""
    kept = {spot: names for spot, names in places_of(base).at.items() if spot[0] == "INSIDE"}
    return _brought(kept, chooser, chooser.randint(1, 2))


def _gather(base: Base, chooser: Random) -> Goal | None:
    """Return two to four classes of things that are to lie on one piece of furniture."""
    on = {spot: names for spot, names in places_of(base).at.items() if spot[0] == "ON" and len(names) > 3}
    return _brought(on, chooser, chooser.randint(2, 4))


def _brought(at: dict[tuple[str, str], tuple[str, ...]], chooser: Random, kinds: int) -> Goal | None:
    if not at:
        return None
    relation, place = chooser.choice(list(at))
    names = at[relation, place]
    some = chooser.sample(names, min(kinds, len(names)))
    return Goal(tuple((Literal.of(relation, name, place), chooser.choice((1, 1, 2))) for name in some))


def _lay_table(base: Base, chooser: Random) -> Goal | None:
    """Return what some people eat with, on a table."""
    table = settings()["table"]
    tables = [name for name in table["at"] if name in places_of(base).fixed]
    if not tables:
        return None
    place, people = chooser.choice(tables), chooser.randint(1, table["people"])
    choices: Sequence[Sequence[str]] = chooser.sample(table["each"], chooser.randint(2, 4 if people < 3 else 3))
    return Goal(tuple((Literal.of("ON", chooser.choice(names), place), people) for names in choices))


def _tidy_room(base: Base, chooser: Random) -> Goal | None:
    """Return two or three things, each with a place of its own kind."""
    places = places_of(base)
    found: dict[tuple[str, str], str] = {}
    kinds = chooser.randint(2, 3)
    while len(found) < kinds:
        spot = chooser.choice(list(places.at))
        name = chooser.choice(places.at[spot])
        if name not in found.values():
            found[spot] = name
    return Goal.of(*(Literal.of(relation, name, place) for (relation, place), name in found.items()))


def _look_in_light(base: Base, chooser: Random) -> Goal | None:
    """Return a thing in the hand, and a lamp that is on."""
    places = places_of(base)
    lamps = [name for name in settings()["lamps"] if name in places.fixed]
    if not lamps:
        return None
    held = Literal.of(HOLDS, AGENT, chooser.choice(list(places.of_thing)))
    return Goal.of(held, Literal.of("ON", chooser.choice(lamps)))


def _find(base: Base, chooser: Random) -> Goal | None:
    """Return one or two things in the hands."""
    names = chooser.sample(list(places_of(base).of_thing), chooser.randint(1, 2))
    return Goal.of(*(Literal.of(HOLDS, AGENT, name) for name in names))


def _turn_off(base: Base, chooser: Random) -> Goal | None:
    """Return kinds of lamps or devices, or both, of which none is to be on."""
    data = settings()
    kinds = chooser.choice((data["lights"], data["devices"], [*data["lights"], *data["devices"]]))
    known = [name for name in kinds if name in places_of(base).fixed]
    if not known:
        return None
    some = chooser.sample(known, min(len(known), chooser.randint(1, 3)))
    return Goal.of(*(Literal("ON", (name,), True) for name in some))


def _two(base: Base, chooser: Random) -> Goal | None:
    """Return the goals of two families at once, about different things."""
    first, second = chooser.sample((_put_away, _gather, _find, _turn_off, _look_in_light, _lay_table), 2)
    goals = first(base, chooser), second(base, chooser)
    if goals[0] is None or goals[1] is None or _names(goals[0]) & _names(goals[1]):
        return None
    goal = goals[0] & goals[1]
    # What is to be held at the end fills the hands with which the rest is done, so it is said last.
    return Goal(tuple(sorted(goal, key=lambda pair: pair[0].name == HOLDS)))


def _without(base: Base, chooser: Random) -> Goal | None:
    """Return a goal, and a kind of furniture that is never to be opened."""
    goal = chooser.choice((_gather, _find, _put_away))(base, chooser)
    if goal is None:
        return None
    home = base.home
    closed = {home.classes[i] for i in indices(home.properties["CAN_OPEN"] & home.furniture & ~home.doors)}
    free = sorted(closed - _names(goal) - {*settings()["never_at"]})
    if not free:
        return None
    opening = Literal.of(base.knowledge.achiever("OPEN"), chooser.choice(free))
    return goal & Goal(parts=(Joined("not", (Goal.of(opening),)),))


def _names(goal: Goal) -> set[Name]:
    return {term for literal, _ in goal for term in literal.terms if term != AGENT}


FAMILIES: dict[str, Callable[[Base, Random], Goal | None]] = {
    "put_away": _put_away,
    "gather": _gather,
    "lay_table": _lay_table,
    "tidy_room": _tidy_room,
    "look_in_light": _look_in_light,
    "find": _find,
    "turn_off": _turn_off,
    "two": _two,
    "without": _without,
}
"""The families whose goals are drawn for a home; `activity` is of the corpus (`household_activities.py`)."""
