"""The server's refusals, as data: a code, the place, the expected and the received value."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from hearth.schemas.failures import Code

STATUS: Mapping[Code, int] = {
    Code.NO_SESSION: 401,
    Code.NOT_ALLOWED: 403,
    Code.UNKNOWN_ID: 404,
    Code.LOCKED: 409,
    Code.CONFLICT: 409,
    Code.OUT_OF_ORDER: 409,
    Code.FILE_TOO_LARGE: 413,
    Code.TOO_FAST: 429,
    Code.INTERNAL_ERROR: 500,
    Code.DAMAGED_FILE: 500,
    Code.MISSING_FILE: 503,
    Code.TIMED_OUT: 503,
    Code.UNWRITABLE: 503,
}
"""The HTTP status of a code; others are 400."""


@dataclass(eq=False)
class WebError(Exception):
    """A request or message that the server refuses; handlers raise it, and it becomes the answer.

    Attributes:
        code: the kind.
        place: the field, address or message at fault.
        expected: the expected value.
        actual: the received value.
        instead: an address of ours to which browsers are sent, where its page says why; "" for the page of a fault.
    """

    code: Code
    place: str = ""
    expected: str = ""
    actual: str = ""
    instead: str = ""

    @property
    def status(self) -> int:
        """Return the HTTP status of its answer."""
        return STATUS.get(self.code, 400)

    def as_json(self) -> dict[str, Any]:
        """Return the answer's body, as documented in web/README.md."""
        facts = {"code": str(self.code), "place": self.place, "expected": self.expected, "actual": self.actual}
        return {"error": facts}

    def __str__(self) -> str:
        found = f", found {self.actual}" if self.actual else ""
        return f"{self.code}: {self.place}: expected {self.expected}{found}"
