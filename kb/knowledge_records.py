"""Records of the knowledge: actions, requirements, object classes, placements, repairs."""

from dataclasses import dataclass
from typing import NamedTuple

from hearth.kb.formula import Effect, Formula
from hearth.schemas.failures import Code
from hearth.schemas.short_repr import brief


@dataclass(frozen=True, slots=True)
class Requirement:
    """A requirement of an action's argument: any of the alternatives suffices.

    Attributes:
        any_of: one of these properties.
        all_of: all of these properties together (no alternative when empty).
        classes: one of these classes.
        contains: a class whose name contains one of these.
        anything: every object, and every room unless `no_rooms`.
        no_rooms: rooms are refused.
        also: classes taken although they meet nothing of the above (exceptions).
        never: classes refused although they do.
    """

    any_of: frozenset[str] = frozenset()
    all_of: frozenset[str] = frozenset()
    classes: frozenset[str] = frozenset()
    contains: tuple[str, ...] = ()
    anything: bool = False
    no_rooms: bool = False
    also: frozenset[str] = frozenset()
    never: frozenset[str] = frozenset()

    __repr__ = brief

    def accepts(self, properties: frozenset[str], class_name: str, is_room: bool = False) -> bool:
        """Return whether a thing of that class with those properties may be the argument."""
        if class_name in self.also:
            return True
        if class_name in self.never or (is_room and self.no_rooms):
            return False
        return (
            self.anything
            or not self.any_of.isdisjoint(properties)
            or (bool(self.all_of) and self.all_of <= properties)
            or class_name in self.classes
            or any(part in class_name for part in self.contains)
        )

    def __str__(self) -> str:
        if self.anything:
            return "any object that is not a room" if self.no_rooms else "anything"
        parts = sorted(self.any_of)
        if self.all_of:
            parts.append(" and ".join(sorted(self.all_of)))
        parts += [f"`{name}`" for name in sorted(self.classes | self.also)]
        parts += [f"a class named *{part}*" for part in self.contains]
        text = " or ".join(parts) or "nothing"
        return f"{text}, not {', '.join(f'`{name}`' for name in sorted(self.never))}" if self.never else text


class Condition(NamedTuple):
    """A check before an action: what must hold, the failure when it does not, the option it depends on (or '')."""

    formula: Formula
    code: Code
    option: str = ""

    def __repr__(self) -> str:
        return brief(self)


@dataclass(frozen=True, slots=True)
class Consequence:
    """The part of an action that action set 3 adds: all there is to an act that sets 1 and 2 do not execute.

    Attributes:
        preconditions: the checks, of an act that only set 3 executes; those that it makes besides, of another.
        effects: its changes, after those of the action itself; conditions are read in the world before.
        like: the action whose rule it shares, or ''.
        ticks: how long it takes.
        notice: what others see or hear of it, in words.
        unless: what lets checks of sets 1 and 2 pass: the check of the same code holds, too, where the formula does.
    """

    preconditions: tuple[Condition, ...] = ()
    effects: tuple[Effect, ...] = ()
    like: str = ""
    ticks: int = 1
    notice: str = ""
    unless: tuple[Condition, ...] = ()

    __repr__ = brief


@dataclass(frozen=True, slots=True)
class Hazard:
    """A danger, harm or waste in a home (`hazards.yaml`).

    Attributes:
        name: of its row.
        condition: a formula of a thing `x`, and of a second thing `y` where it names one.
        alone: whether it is one only while no grown person is in the room of x.
        asleep: whether it is one only while every character lies down.
        unused: whether its ticks are counted anew whenever a thing comes into x or out of it.
        after: the ticks for which it has to last; 0 for at once.
        severity: 3 fire or injury, 2 damage, 1 mess or waste.
        say: a sentence with `{x}` and `{y}` for the things.
        source: the reason why it is a hazard.
    """

    name: str
    condition: Formula
    alone: bool
    asleep: bool
    unused: bool
    after: int
    severity: int
    say: str
    source: str

    __repr__ = brief


@dataclass(frozen=True, slots=True)
class Process:
    """A change that comes by itself (`processes.yaml`), action set 3.

    Attributes:
        name: of its row.
        id: its place among the processes.
        condition: literals about a thing `x`, and a device `d` on or in which it is, all of which hold meanwhile.
        after: the number of ticks after which it is done.
        effects: what becomes true of x then.
        seen: what is seen meanwhile, in words.
        at_start: whether it is done at the start for the things that take part then: it has gone on for long.
    """

    name: str
    id: int
    condition: Formula
    after: int
    effects: tuple[Effect, ...]
    seen: str = ""
    at_start: bool = False

    __repr__ = brief


@dataclass(frozen=True, slots=True)
class Action:
    """An action of the grammar (thesis 2.3.3, table 2.2, and the release's 78).

    Attributes:
        name: `PutBack`.
        id: published, stable.
        executed: whether the simulation runs it; the others are valid to write and fail as NOT_SIMULATED.
        roles: what each argument is to the action; their number is the arity.
        needs: what execution asks of each argument itself.
        grammar: what the grammar (the published affordances) asks of each argument.
        preconditions: the checks in the order they are made.
        effects: what changes.
        template: the step in words, `Put {0} on {1}`.
        words: other ways to begin the step.
        aliases: other spellings of the name.
        calls: names by which programs, planners and robots call it.
        groups: those of `groups.DECLARED` that it belongs to; others follow from its literals.
        source: release, thesis or ours.
        later: what action set 3 adds; None where it adds nothing.
    """

    name: str
    id: int
    executed: bool
    roles: tuple[str, ...]
    needs: tuple[Requirement, ...]
    grammar: tuple[Requirement, ...]
    preconditions: tuple[Condition, ...] = ()
    effects: tuple[Effect, ...] = ()
    template: str = ""
    words: tuple[str, ...] = ()
    aliases: tuple[str, ...] = ()
    groups: frozenset[str] = frozenset()
    source: str = ""
    calls: tuple[str, ...] = ()
    later: Consequence | None = None

    __repr__ = brief

    @property
    def arity(self) -> int:
        """Return how many objects it takes."""
        return len(self.roles)


@dataclass(frozen=True, slots=True)
class ObjectClass:
    """A kind of thing, or a room.

    Attributes:
        name: `coffee_table`.
        id: published, stable.
        category: as in scene graphs: Furniture, Food, Rooms, ...
        hypernym: the class or kind it is one of (`fridge` -> `appliance`).
        properties: names of `vocabulary.PROPERTIES`.
        states: states it may be in, simulated ones and others, sorted.
        rooms: where it is usually found.
        size: typical width, height and depth in metres.
        gloss: one line saying what it is.
        same_as: the class of which this is another name, or ''.
        synonyms: other names for it, in scripts and in scenes.
        source: release, homes, thesis or ours.
    """

    name: str
    id: int
    category: str
    hypernym: str = ""
    properties: frozenset[str] = frozenset()
    states: tuple[str, ...] = ()
    rooms: tuple[str, ...] = ()
    size: tuple[float, float, float] = (0.0, 0.0, 0.0)
    gloss: str = ""
    same_as: str = ""
    synonyms: tuple[str, ...] = ()
    source: str = ""

    __repr__ = brief


class Placement(NamedTuple):
    """An allowed place of a thing: `object` ON, IN or NEARBY `destination`, in `room` or anywhere ('').

    `weight` says how usual it is, from 1 (it happens) to 5 (its place); `evidence` who says so.
    """

    object: str
    relation: str
    destination: str
    room: str
    weight: int
    evidence: str

    def __repr__(self) -> str:
        return brief(self)

    @property
    def edge(self) -> str:
        """The relation as scene graphs name it: ON, INSIDE, CLOSE."""
        return EDGES[self.relation]


class Association(NamedTuple):
    """Things that belong together in use: `spectacles` serves `Read`, `pen` goes_with `paper`.

    `weight` says how strongly, from 1 to 5; `evidence` who says so.
    """

    name: str
    relation: str
    other: str
    weight: int
    evidence: str

    def __repr__(self) -> str:
        return brief(self)


EDGES = {"ON": "ON", "IN": "INSIDE", "NEARBY": "CLOSE"}
"""Relation of a placement -> relation of a scene graph."""


@dataclass(frozen=True, slots=True)
class StateGroup:
    """States about one matter (thesis table A.2).

    Attributes:
        name: `cleanliness`.
        states: its states.
        exclusive: at most one holds at a time.
        simulated: whether the simulator keeps them.
        table: those that stand in table A.2.
        needs: a thing must have one of these properties to be in them.
        given_by: a thing with one of these properties may be in them without saying so.
        harm: those that ruin a thing, or use it up, where nothing undoes them.
    """

    name: str
    states: tuple[str, ...]
    exclusive: bool = False
    simulated: bool = False
    table: tuple[str, ...] = ()
    needs: frozenset[str] = frozenset()
    given_by: frozenset[str] = frozenset()
    harm: tuple[str, ...] = ()

    __repr__ = brief


class Kind(NamedTuple):
    """A kind above the classes: `appliance`, a kind of `device`; the topmost has no parent."""

    name: str
    parent: str
    gloss: str

    def __repr__(self) -> str:
        return brief(self)


@dataclass(frozen=True, slots=True)
class Repair:
    """A row of thesis table A.4, or one of ours: what to do about a failure.

    Attributes:
        name: of the repair; its handler gives it to the edit.
        code: the failure.
        actions: the actions it is for; all when empty.
        when: the case in which the failure is raised.
        say: the repair in words.
        source: `A.4` or `ours`.
    """

    name: str
    code: Code
    actions: tuple[str, ...] = ()
    when: str = ""
    say: str = ""
    source: str = ""

    __repr__ = brief
