"""Messages that agents and people send in a tick instead of acting."""

import re
from dataclasses import dataclass

from hearth.schemas.literals import Literal, Name

ASK, TELL = "Ask", "Tell"

_TOLD = re.compile(rf"{TELL} ([A-Z]+)\((\w+), (\d{{1,9}})\) (\d{{1,3}})", re.ASCII)


@dataclass(frozen=True, slots=True)
class Message:
    """A question, or an answer to it.

    Attributes:
        wanted: what the one who speaks still wants, naming furniture by its id; None asks the other for that.
        count: how many are still wanted.
    """

    wanted: Literal[Name] | None = None
    count: int = 0

    def __str__(self) -> str:
        if self.wanted is None:
            return ASK
        return f"{TELL} {self.wanted.name}({self.wanted.subject}, {self.wanted.target}) {self.count}"


def read(text: str) -> Message | None:
    """Return the inverse of `str`; None of any other text."""
    if text == ASK:
        return Message()
    found = _TOLD.fullmatch(text)
    return Message(Literal(found[1], (found[2], int(found[3]))), int(found[4])) if found else None
