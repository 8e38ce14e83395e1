"""Mentions: the things that the steps of a program have named, of which its later lines may speak."""

from collections.abc import Iterable

from hearth.kb.knowledge import Knowledge
from hearth.kb.language.missing_objects import may_lack_seat
from hearth.kb.language.pronouns import EARLIER, REMEMBERED, UNREAD, Mentioned, has_pronoun
from hearth.kb.language.things_in_refused_lines import unread

_EARLIER = Mentioned(EARLIER, ())


class SaidBefore:
    """The mentions of a program, in the order of its lines.

    Attributes:
        mentions: those of the steps, whose lines are those of the steps, and of other lines, which have their own.
        counted: the classes of which several things were said.
    """

    def __init__(self, known: Knowledge, lines: list[int]) -> None:
        self._known = known
        self._lines = lines
        self.mentions: list[Mentioned] = []
        self.counted: set[str] = set()
        self._names = {""}
        self._seen = 0
        self._things: dict[object, Mentioned] = {}
        self._kept = 0

    def add(self, mentioned: Mentioned) -> None:
        """Add what a step names."""
        self.mentions.append(mentioned)
        if mentioned.instance > 1 or mentioned.second > 1:
            self.counted.update(mentioned.names)

    def add_unread(self, words: str, line: int) -> None:
        """Add a line that is not understood; its things are looked for when a pronoun may mean them."""
        self.mentions.append(Mentioned(UNREAD, (), 1, line, 1, words))

    def cut(self, size: int) -> None:
        """Forget the mentions from one on."""
        del self.mentions[size:]
        self._seen, self._kept = min(size, self._seen), min(size, self._kept)

    def take_back(self) -> None:
        """Forget the last step, and the lines that were not understood after it."""
        size = len(self.mentions)
        while size and self.mentions[size - 1].action in (UNREAD, ""):
            size -= 1
        self.cut(max(size - 1, 0))

    def swap_last(self) -> None:
        """Let the thing before the last one be spoken of last."""
        self.mentions[-2:] = reversed(self.mentions[-2:])

    def carry(self, name: str) -> None:
        """Let a thing that was carried along be spoken of last, with all of its kind that were counted."""
        numbers = {each.instance for each in self.mentions if each.names[:1] == (name,)} or {1}
        self.mentions += [Mentioned("", (name,), number, self._lines[-1]) for number in sorted(numbers)]

    def changes(self, names: tuple[str, ...], depends: frozenset[str]) -> bool:
        """Return whether a step of some classes may mean something else after the lines before it.

        Args:
            names: the classes of the step.
            depends: the classes that change its line where they were said before.
        """
        for each in self.mentions[self._seen :]:
            self._names.update(each.names)
        self._seen = len(self.mentions)
        return not depends.isdisjoint(self._names) or not self.counted.isdisjoint(names)

    def last_first(self, line: str) -> tuple[Mentioned, ...]:
        """Return the mentions, the last first: those of which a pronoun may speak, and one of each thing before.

        Lines that were not understood are among them only if the given line has a pronoun, or may lack a seat.
        """
        is_about_unread = has_pronoun(line) or may_lack_seat(line)
        recent: list[Mentioned] = []
        lines = reversed(self._lines)
        acts, last = 0, ("", 0)
        for mentioned in reversed(self.mentions):
            action, names, instance, at, second, words = placed = mentioned
            if action == UNREAD:
                other = unread(self._known, words) if is_about_unread else None
                if other is None:
                    continue
                placed = other
            elif action:
                at_line = next(lines)
                placed = mentioned if at else Mentioned(action, names, instance, at_line, second, words)
            if (placed.action, placed.line) != last:
                acts, last = acts + 1, (placed.action, placed.line)
            if acts > REMEMBERED:
                return (*recent, _EARLIER, *self._before(len(self.mentions) - len(recent)))
            recent.append(placed)
        return tuple(recent)

    def _before(self, size: int) -> Iterable[Mentioned]:
        """Return the first mentions, those in the same words once."""
        for each in self.mentions[self._kept : size]:
            if each.names:
                self._things.setdefault((each.names, each.instance, each.second, each.words), each)
        self._kept = max(size, self._kept)
        return self._things.values()
