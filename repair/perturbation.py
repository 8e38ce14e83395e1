"""Perturbing preconditions: conditions of a program are violated, so that it has to be repaired (thesis 5.5.4).

A perturbation takes conditions away and asks for others. The thesis drops sitting, lying and being at reach and swaps
plugged, on, open and free; the others here are ours.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice
from random import Random

from hearth.grounding.environments.condition_violation import closes
from hearth.grounding.environments.default_state import Base
from hearth.grounding.preconditions.conditions import Condition, Preconditions
from hearth.grounding.preconditions.usual_states import usual_states
from hearth.kb.knowledge import Knowledge
from hearth.kb.knowledge_records import Action
from hearth.schemas.failures import Code
from hearth.schemas.literals import (
    CHARACTER,
    DONE_OF_SET_3,
    LACK_OF_SET_3,
    STATE_OF,
    STATE_OF_SET_3,
    Key,
    Literal,
)
from hearth.schemas.program import Program
from hearth.simulation.world.bits import indices

MOST = 6
"""Perturbations of one draw, by default."""

MAX_STALE = 8
"""Draws in a row that bring nothing new before no more are made."""


@dataclass(frozen=True, slots=True)
class Perturbation:
    """A perturbation: conditions dropped and added.

    Attributes:
        kind: its name in `PERTURBATIONS`.
        dropped: conditions that no longer hold.
        added: conditions that hold instead.
    """

    kind: str
    dropped: tuple[Condition, ...] = ()
    added: tuple[Condition, ...] = ()

    @property
    def about(self) -> Condition:
        """The condition that identifies it: the one dropped, else the one added."""
        return (self.dropped or self.added)[0]

    def claims(self) -> frozenset[tuple[str, Key]]:
        """Return the (matter, object) pairs it determines; two perturbations that share one exclude each other."""
        settled = ((_MATTER.get(c.name, "place"), c.objects[0]) for c in (*self.dropped, *self.added))
        off = (("switch", c.objects[0]) for c in self.added if c.name == "unplugged")
        return frozenset((*settled, *off))

    def __str__(self) -> str:
        if not self.dropped:
            return f"{self.kind}: {', '.join(map(str, self.added))}"
        return f"{self.kind}: {self.about} -> {', '.join(map(str, self.added)) or 'not so'}"


@dataclass(frozen=True, slots=True)
class Case:
    """A program, what it needs, and the home it is to be perturbed in."""

    program: Program
    conditions: Preconditions
    base: Base

    @property
    def knowledge(self) -> Knowledge:
        """The knowledge of the home."""
        return self.base.knowledge


@dataclass(frozen=True, slots=True)
class Perturbed:
    """Perturbed preconditions, with the perturbations."""

    conditions: Preconditions
    perturbations: tuple[Perturbation, ...]


@dataclass(frozen=True, slots=True)
class Chances:
    """Probabilities of perturbations.

    Attributes:
        kinds: the probability of each kind, for every condition it applies to.
        draws: weights of the ways to combine them: `each` with its own probability (thesis 5.5.4), exactly `one`, or
            exactly `two`.
        most: perturbations of one draw.
    """

    kinds: Mapping[str, float]
    draws: Mapping[str, float]
    most: int = MOST


Perturber = Callable[[Case], Iterator[Perturbation]]


def candidates(case: Case) -> tuple[Perturbation, ...]:
    """Every single perturbation of a program's conditions, in the order of `PERTURBATIONS`."""
    return tuple(one for kind in PERTURBATIONS.values() for one in kind(case))


def distinct(case: Case, chances: Chances, rng: Random, count: int) -> Iterator[Perturbed]:
    """Up to `count` perturbed versions of the conditions, no two the same, none the original."""
    every = candidates(case)
    return islice(_drawn(case, every, chances, rng), count)


def _drawn(case: Case, every: Sequence[Perturbation], chances: Chances, rng: Random) -> Iterator[Perturbed]:
    seen: set[frozenset[object]] = {frozenset(c.literal for c in case.conditions)}
    left = MAX_STALE
    while left and every:
        chosen = _chosen(every, chances, rng)
        conditions = applied(case.conditions, chosen)
        facts = frozenset(c.literal for c in conditions)
        if not chosen or facts in seen:
            left -= 1
            continue
        left = MAX_STALE
        seen.add(facts)
        yield Perturbed(conditions, chosen)


def _chosen(every: Sequence[Perturbation], chances: Chances, rng: Random) -> tuple[Perturbation, ...]:
    """Return some of the candidates, no two of which share a claim."""
    (way,) = rng.choices(tuple(chances.draws), tuple(chances.draws.values()))
    weights = [chances.kinds.get(one.kind, 0.0) for one in every]
    if way == "each":
        picked = [one for one, weight in zip(every, weights, strict=True) if rng.random() < weight]
    elif sum(weights):
        picked = rng.choices(every, weights, k=1 if way == "one" else 2)
    else:
        picked = []
    rng.shuffle(picked)
    claimed: set[tuple[str, Key]] = set()
    chosen: list[Perturbation] = []
    for one in picked:
        claims = one.claims()
        if not claims & claimed and len(chosen) < chances.most:
            claimed |= claims
            chosen.append(one)
    return tuple(one for one in every if one in chosen)


def applied(conditions: Preconditions, perturbations: Sequence[Perturbation]) -> Preconditions:
    """Return the conditions after all perturbations.

    First those that move things, since the others depend on their places.
    """
    left = conditions.without(*(c for one in perturbations for c in one.dropped))
    added = [c for one in perturbations for c in one.added]
    moving = Preconditions(tuple(c for c in added if _MATTER.get(c.name, "place") == "place"))
    return moving.plus(*left, *(c for c in added if c not in moving.conditions))


def _swap(kind: str, pairs: Mapping[str, str]) -> Perturber:
    """Every condition of these names becomes its opposite, or is dropped where that is empty."""

    def swap(case: Case) -> Iterator[Perturbation]:
        for condition in case.conditions:
            opposite = pairs.get(condition.name)
            if opposite is not None:
                yield Perturbation(kind, (condition,), (condition.instead(opposite),) if opposite else ())

    return swap


def _plugged(case: Case) -> Iterator[Perturbation]:
    """Yield a device plugged in and off is unplugged, or the reverse, if it has a plug that can be put in."""
    for one in _swap("plugged", {"plugged": "unplugged", "unplugged": "plugged"})(case):
        home = case.base.home
        lacking = (i for i in case.base.instances(one.about.objects[0][0]) if not home.able("PlugIn") >> i & 1)
        runs = one.added[0].name == "unplugged" and case.conditions.has("is_on", *one.about.objects)
        if not runs and next(lacking, -1) < 0 and case.knowledge.has(one.about.objects[0][0], "HAS_PLUG"):
            yield one


def _at_reach(case: Case) -> Iterator[Perturbation]:
    """Yield an object at reach is where it belongs, but not at reach.

    What is used from a seat, if either can be carried.
    """
    seats = _seats(case)
    for condition in case.conditions:
        used = (condition.objects[0][0], seats.get(condition.step, ""))
        if used[1] and not any(case.knowledge.has(name, "GRABBABLE") for name in used):
            continue
        if condition.name == "nearby":
            yield Perturbation("at_reach", (condition,))
        elif condition.name == "atreach" and condition.objects[0] != condition.objects[1]:
            yield _replaced(case, "at_reach", condition, condition.instead("not_near"))


def _seats(case: Case) -> dict[int | None, str]:
    """Return the class of the character's seat or bed, by the numbers of the steps that the program does there."""
    found: dict[int | None, str] = {}
    seat = ""
    for number, step in enumerate(case.program.steps):
        if seat:
            found[number] = seat
        if step.action in case.knowledge.group("rests"):
            seat = step.objects[0].name
        elif step.action in case.knowledge.group("rises"):
            seat = ""
    return found


def _container(case: Case) -> Iterator[Perturbation]:
    """Yield an object on or in something is in another container, which is closed."""
    for condition in case.conditions:
        if condition.name in ("in", "inside") and _fits_closed_container(case, *condition.objects):
            yield _replaced(case, "container", condition, condition.instead("in_closed_container"))


def _fits_closed_container(case: Case, key: Key, now: Key) -> bool:
    """Return whether it belongs in a container other than its present place that can be closed."""
    same = case.knowledge.same_class(now[0])
    classes = case.base.home.classes
    spots = case.base.spots(key[0]).choices
    return _is_portable(case, key) and any(
        classes[i] not in same and closes(case.base, (i, relation)) for _, i, relation in spots
    )


def _location(case: Case) -> Iterator[Perturbation]:
    """Yield an object in one room is in another."""
    for condition in case.conditions:
        if condition.name == "location" and _is_portable(case, condition.objects[0]):
            yield _replaced(case, "location", condition, condition.instead("other_room"))


def _replaced(case: Case, kind: str, old: Condition, new: Condition) -> Perturbation:
    others = (c for c in _placing(case, old.objects[0]) if c != old)
    return Perturbation(kind, (old, *others), (new,))


def _placing(case: Case, key: Key) -> list[Condition]:
    """Return the conditions by which an object is placed."""
    return [c for c in case.conditions if c.name in _BY_OTHERS and c.objects[0] == key and CHARACTER not in c.objects]


def _is_portable(case: Case, key: Key) -> bool:
    """Return whether things of its class can be carried, and no other object of the program is placed by this one."""
    leads = any(c.name in _BY_OTHERS and c.name != "location" and c.objects[1] == key for c in case.conditions)
    return case.knowledge.has(key[0], "GRABBABLE") and not leads


def _full_hands(case: Case) -> Iterator[Perturbation]:
    """Yield the character comes with both hands full."""
    for number, step in enumerate(case.program.steps):
        action = case.knowledge.actions.get(step.action)
        if action is not None and any(check.code == "NO_FREE_HAND" for check in action.preconditions):
            yield Perturbation("full_hands", (), (Condition(Literal("full_hands", (CHARACTER,)), number),))
            return


def _door(case: Case) -> Iterator[Perturbation]:
    """Yield the doors of the room in which the program begins are closed; the character is in another."""
    resting = any(c.name in ("sitting", "lying", "nearby", "holds") for c in case.conditions)
    number, first = next(((n, s) for n, s in enumerate(case.program.steps) if s.objects), (0, None))
    walks = case.knowledge.group("walks")
    if first is not None and not resting and first.action in walks and _has_door(case, first.objects[0].name):
        yield Perturbation("door", (), (Condition(Literal("doors_closed", (first.objects[0].key,)), number),))


def _has_door(case: Case, room: str) -> bool:
    """Return whether the name is a room's, and each room that may serve as it has a door that closes."""
    home = case.base.home
    doors = list(indices(home.doors & home.able("Close")))
    return case.knowledge.is_room(room) and all(
        any(home.between[door] >> i & 1 for door in doors) for i in case.base.rooms(room)
    )


def _pet(case: Case) -> Iterator[Perturbation]:
    """Yield a cat or a dog is on the seat, and enough other things to leave no room."""
    for condition in case.conditions:
        if condition.name == "free":
            added = tuple(condition.instead(name) for name in ("pet", "occupied"))
            yield Perturbation("pet", (condition,), added)


def _dirty(case: Case) -> Iterator[Perturbation]:
    """Yield an object that the program cleans is dirty."""
    seen: set[Key] = set()
    cleaning = case.knowledge.achieving("CLEAN")
    for number, step in enumerate(case.program.steps):
        if step.action in cleaning and step.objects[0].key not in seen:
            seen.add(step.objects[0].key)
            known = tuple(c for c in case.conditions.about(step.objects[0].key) if c.name in ("clean", "dirty"))
            if not any(c.name == "dirty" for c in known):
                yield Perturbation("dirty", known, (Condition(Literal("dirty", (step.objects[0].key,)), number),))


def _seated(case: Case) -> Iterator[Perturbation]:
    """Yield the character sits somewhere."""
    if not any(c.name in ("sitting", "lying", "nearby", "holds") for c in case.conditions) and case.program.steps:
        yield Perturbation("seated", (), (Condition(Literal("sitting", (CHARACTER,))),))


def _done(case: Case) -> Iterator[Perturbation]:
    """Yield a thing that a step would fold, cover or write on is so already; checks of action set 3 say which step."""
    seen: set[Key] = set()
    for number, step in enumerate(case.program.steps):
        action = case.knowledge.actions.get(step.action)
        if action is not None and step.objects and step.objects[0].key not in seen:
            key = step.objects[0].key
            for name in _made(action):
                yield Perturbation("done", (), (Condition(Literal(name, (key,)), number),))
                seen.add(key)


def _made(action: Action) -> Iterator[str]:
    """Yield the conditions that an action refuses and makes: of Fold that its object is folded."""
    made = {str(effect.literal) for effect in action.effects}
    for check in action.preconditions:
        literal = check.formula
        if check.code is Code.WRONG_STATE and isinstance(literal, Literal) and literal.negated:
            name = literal.terms[-1].name.lower()
            if str(literal.atom) in made and name in DONE_OF_SET_3:
                yield name


def _unusual(kind: str) -> Perturber:
    """Things of which something else is so than people take for granted, by the rows of `usual_states.yaml`."""

    def unusual(case: Case) -> Iterator[Perturbation]:
        for condition in case.conditions:
            row = usual_states().get(condition.name)
            if row is not None and row.violated is not None and row.violated[0] == kind and not condition.hard:
                yield Perturbation(kind, (condition,), (condition.instead(row.violated[1]),))

    return unusual


PERTURBATIONS: dict[str, Perturber] = {
    "sitting": _swap("sitting", {"sitting": ""}),
    "lying": _swap("lying", {"lying": ""}),
    "at_reach": _at_reach,
    "plugged": _plugged,
    "on": _swap("on", {"is_on": "is_off", "is_off": "is_on"}),
    "open": _swap("open", {"open": "closed", "closed": "open"}),
    "free": _swap("free", {"free": "occupied", "occupied": "free"}),
    "facing": _swap("facing", {"facing": "facing_away"}),
    "holding": _swap("holding", {"holds": ""}),
    "container": _container,
    "location": _location,
    "full_hands": _full_hands,
    "dirty": _dirty,
    "door": _door,
    "pet": _pet,
    "seated": _seated,
    "done": _done,
    **{row.violated[0]: _unusual(row.violated[0]) for row in usual_states().values() if row.violated},
}
"""Every kind of perturbation. To add one: a function, a row here, its probability in perturbations.yaml, a test."""

_BY_OTHERS = frozenset({"in", "inside", "atreach", "together", "location"})
"""Conditions that say where their first object is by their second."""

_MATTER: dict[str, str] = {
    **{name: pair for pair, names in {
        "door": ("open", "closed"), "switch": ("is_on", "is_off"), "dirt": ("clean", "dirty"),
        "plug": ("plugged", "unplugged"),
    }.items() for name in names},
    **dict.fromkeys(("sitting", "lying"), "posture"),
    **dict.fromkeys(("free", "occupied", "pet"), "seat"),
    **{name: pair for pair, names in {
        "temperature": ("cold", "hot"), "content": ("empty", "full"), "cut": ("cut", "uncut"),
        "wear": ("broken", "intact"),
    }.items() for name in names},
    **{name: name for name in DONE_OF_SET_3},
    "full_hands": "hands", "holds": "hands", "doors_closed": "way", "facing": "view", "facing_away": "view",
}  # fmt: skip
"""The matter of each condition; others are about the place of their first object."""

assert set(_MATTER) >= {*STATE_OF, *STATE_OF_SET_3, *LACK_OF_SET_3, "sitting", "lying", "free", "occupied"}
