"""Acts without a home as people write programs: to the room, to each thing, and the thing taken before it is used."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from hearth.kb.knowledge import Knowledge
from hearth.models.reading.program_writing import GRABS, OPENS, WAITS
from hearth.models.reading.request_table import acts_of
from hearth.models.reading.spoken_things import Act
from hearth.schemas.program import ObjectRef, Step

WALKS = "Walk"
FINDS = "Find"


def narrated(acts: Sequence[Act], known: Knowledge) -> tuple[Step, ...]:
    """Return the steps of some acts, with those before them that people say.

    A walk to the room of the first thing, `Find` before a thing that is taken, a walk to furniture, a grab before a
    thing is put somewhere, and a container that is opened first.
    """
    return tuple(_Narrator(known).steps(acts))


class _Narrator:
    def __init__(self, known: Knowledge) -> None:
        self.known = known
        self.held: set[tuple[str, int]] = set()
        self.opened: set[tuple[str, int]] = set()
        self.last: tuple[str, int] | None = None

    def steps(self, acts: Sequence[Act]) -> Iterator[Step]:
        """Yield the steps of acts."""
        if acts and (room := self._room(acts)):
            yield Step(WALKS, (ObjectRef(room, 1),))
        for act in acts:
            if act.action != WAITS:
                yield from self._act(act)

    def _room(self, acts: Sequence[Act]) -> str:
        """Return the room of the first thing; none where the first act goes to one."""
        first = next((ref.name for act in acts for ref in act.objects), "")
        thing = self.known.objects.get(first)
        return "" if thing is None or self.known.is_room(first) or not thing.rooms else thing.rooms[0]

    def _act(self, act: Act) -> Iterator[Step]:
        for place, ref in enumerate(act.objects):
            is_taken = act.action in acts_of("held") and place == 0 and self.known.has(ref.name, "GRABBABLE")
            if ref.key not in self.held and act.action not in (WALKS, FINDS):
                yield from self._reached(ref)
            if is_taken and ref.key not in self.held:
                self.held.add(ref.key)
                yield Step(GRABS, (ref,))
            if place and act.action == "PutIn" and self.known.has(ref.name, "CAN_OPEN") and ref.key not in self.opened:
                self.opened.add(ref.key)
                yield Step(OPENS, (ref,))
        yield Step(act.action, act.objects)
        first = act.objects[0].key if act.objects else None
        if act.action == GRABS and first:
            self.held.add(first)
        elif act.action in acts_of("released") and first:
            self.held.discard(first)
        elif act.action == OPENS and first:
            self.opened.add(first)

    def _reached(self, ref: ObjectRef) -> Iterator[Step]:
        """Yield the step that brings one to a thing, but for the one at which one is."""
        if ref.key != self.last:
            self.last = ref.key
            yield Step(FINDS if self.known.has(ref.name, "GRABBABLE") else WALKS, (ref,))
