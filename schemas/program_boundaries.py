"""The boundaries between programs in a text."""

import re
from dataclasses import dataclass

STEP = re.compile(r"\s*[\[<(|]")
"""The beginning of a line that is, or tries to be, a step."""

TITLE = re.compile(
    r"\s*(?:(?:task|title|activity|goal|plan|your task is to)(?:\s+name)?(?:\s*[#№]?\d{1,6})?\s*[:=](?!=)"
    r"|task\s+[–—-]\s|(?:task|plan)\s*[#№]?\d{1,6}\s*$|task\s*[#№]?\d{1,6}\s*[.)–—-])\s*",
    re.IGNORECASE,
)
"""The optional beginning of a title's line: `Task:`, `Task 12:`, `Task 12 -`."""

_SENTENCE_ENDS = tuple(".!?:;,\"')…”’")
_SENTENCE_WORDS = 9


@dataclass(slots=True)
class Splitter:
    """Decides, line by line, where a program begins.

    A plain line after a blank one begins the next program once steps were seen. Where none were, a title that nobody
    wrote steps for must not become a part of its neighbor: two blank lines part them, or one where a description
    stood already, unless the line reads like a sentence, which a title does not.
    """

    has_steps: bool = False
    _header: int = 0
    _blanks: int = 0
    _started: bool = False

    def begins(self, line: str, is_step: bool) -> bool:
        """Take the next line that is not blank; whether it begins a program."""
        blanks, self._blanks = self._blanks, 0
        new = not self._started or (not is_step and self._parted(line, blanks))
        if new:
            self._started, self._header, self.has_steps = True, 0, False
        if is_step:
            self.has_steps = True
        elif not self.has_steps:
            self._header += 1
        return new

    def blank(self) -> None:
        """Take a blank line."""
        self._blanks += 1

    def _parted(self, line: str, blanks: int) -> bool:
        if self.has_steps or (self._header and TITLE.match(line)):
            return blanks > 0
        return (blanks > 1 or (blanks == 1 and self._header > 1)) and not is_sentence(line)


def is_sentence(line: str) -> bool:
    """Return whether a line reads like a sentence, which a title does not."""
    return line.rstrip().endswith(_SENTENCE_ENDS) or len(line.split()) >= _SENTENCE_WORDS
