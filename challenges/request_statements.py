"""The statements of a request so far, and the things of which nothing is said yet."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from hearth.challenges.instruction_object_names import EVERY
from hearth.challenges.paraphrase_things import UNSAID
from hearth.challenges.request_tokens import RefusedError
from hearth.kb.knowledge import Knowledge
from hearth.schemas.goals import Goal, Joined
from hearth.schemas.literals import HOLDS, Literal, Name

SWITCHED = frozenset({"HAS_SWITCH", "LIGHTABLE"})
"""Properties of things that can be on."""

Counted = list[tuple[str, int]]
Relation = Callable[[str, str], str | None]


@dataclass
class Statements:
    """The statements of a request.

    Attributes:
        knowledge: of things.
        doer: the agent.
        relation: of a preposition and a place.
        counts: the literals so far.
        bans: things that are never opened.
        waiting: things that were named, and of which nothing is said yet.
        mode: what is to be done with things that follow.
        at: the place of things that follow, where it was said before them.
        last: the last place, and the last thing.
        said: the kind of the last statement.
        indefinite: things of which one of several was meant, `a lamp`.
        waits: whether the place may wait for things of the next sentence, `Table for two.`
    """

    knowledge: Knowledge
    doer: str
    relation: Relation
    counts: list[tuple[Literal[Name], int]] = field(default_factory=list)
    bans: list[str] = field(default_factory=list)
    waiting: Counted = field(default_factory=list)
    mode: str = ""
    at: tuple[str, str] | None = None
    last: tuple[str, str] | None = None
    named: str = ""
    said: str = ""
    indefinite: set[str] = field(default_factory=set)
    waits: bool = False

    def placed(self, relation: str, place: str) -> None:
        """Say that all that waits is at a place."""
        self.emit("at", [((relation, name, place), number) for name, number in self.taken()])

    def taken(self) -> Counted:
        """Return what waits, which no longer does.

        Raises:
            RefusedError: nothing waits, or a number is not said.
        """
        found, self.waiting = self.waiting, []
        if not found or any(number in (UNSAID, EVERY) for _, number in found):
            raise RefusedError
        return found

    def emit(self, said: str, facts: list[tuple[tuple[str, ...], int]], one: int = 1) -> None:
        """Add facts with their numbers; `one` is a number that can only be one."""
        if one not in (1, UNSAID):
            raise RefusedError
        self.counts += [(Literal.of(*fact), number) for fact, number in facts]
        self.said = said

    def close(self, *, ends: bool = False) -> None:
        """End a clause: what waits goes where the words before it said."""
        if self.mode in ("hold", "take") and self.waiting:
            self.emit("held", [((HOLDS, self.doer, name), number) for name, number in self.taken()])
        elif self.mode == "wear" and self.waiting:
            self.worn(self.taken())
        elif self.mode == "turn_on" and self.waiting:
            self.lit_or_worn(self.taken())
        elif self.mode == "turn_off" and self.waiting:
            self.none_on()
        elif self.at is not None and self.waiting and self.mode in ("", "put"):
            self.placed(*self.at)
            self.at, self.waits = None, False
        elif self.mode in ("put", "turn", "ban", "rest") and self.waiting:
            raise RefusedError
        if ends and self.at is not None and not self.waits:
            raise RefusedError  # a place, and nothing that goes there
        if ends:
            self.mode = ""

    def _need_switches(self, found: Counted) -> None:
        """Refuse things that are neither switched nor lit: `take the plates off`."""
        for name, _ in found:
            kind = self.knowledge.object_class(name)
            if kind is None or not SWITCHED & set(kind.properties):
                raise RefusedError

    def switched(self, found: Counted) -> None:
        """Say that things are on."""
        self._need_switches(found)
        self.emit("on", [(("ON", name), number) for name, number in found])

    def lit_or_worn(self, found: Counted) -> None:
        """Say that things are on, or that the agent wears them: `put on a hat`, `put on the lamp`."""
        is_worn = all(self.knowledge.affords("PutOn", 0, name) for name, _ in found)
        (self.worn if is_worn else self.switched)(found)

    def worn(self, found: Counted) -> None:
        """Say that the agent has things on.

        Raises:
            RefusedError: they are nothing to wear.
        """
        if not all(self.knowledge.affords("PutOn", 0, name) for name, _ in found):
            raise RefusedError
        self.emit("worn", [(("ON", name, self.doer), number) for name, number in found])

    def none_on(self) -> None:
        """Say that none of the waiting things is on.

        Raises:
            RefusedError: a number of things is named, `two lamps`.
        """
        found, self.waiting = self.waiting, []
        if not found or any(number > 1 for _, number in found):
            raise RefusedError
        self._need_switches(found)
        self.counts += [(Literal("ON", (name,), True), 1) for name, _ in found]
        self.said = "off"

    def goal(self) -> Goal | None:
        """Return the goal; None where nothing is asked, something waits, or one thing is asked twice."""
        literals = [literal for literal, _ in self.counts]
        bans = list(dict.fromkeys(self.bans))
        if self.waiting or len(set(literals)) < len(literals) or not (literals or bans):
            return None
        opens = self.knowledge.achiever("OPEN")
        parts = tuple(Joined("not", (Goal.of(Literal.of(opens, name)),)) for name in bans)
        return Goal(tuple(self.counts), parts)
