"""Records that a stage refuses, with codes: the other half of every ledger."""

from __future__ import annotations

import traceback
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import PurePath

from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failure_words import REMEDIES, why
from hearth.schemas.failures import Code, Failure
from hearth.schemas.row_types import Row

INTERNAL_ERROR = str(Code.INTERNAL_ERROR)
"""The code of a record that made a stage's own code fail: a fault of ours, not of the record."""

_LONGEST = 500
_LARGEST = 2**31 - 1


@dataclass(frozen=True, slots=True)
class Reject:
    """A record, or a part of one, that does not go on.

    Attributes:
        diagnostics: every fault, the one it counts under first.
        internal: the fault is ours: an exception that no stage expected.
    """

    diagnostics: tuple[Diagnostic, ...]
    internal: bool = False

    @classmethod
    def of(
        cls, code: Code, message: str, *, file: str = "", line: int = 0, found: str = "", suggestion: str = ""
    ) -> Reject:
        """Return a reject for one fault."""
        return cls((Diagnostic(code, message, file, line, found=found, suggestion=suggestion),))

    @classmethod
    def because(cls, faults: Iterable[Diagnostic], file: str = "") -> Reject:
        """Return a reject for several faults; `file` is put where they name none."""
        return cls(tuple(fault if fault.file or not file else fault.at(file) for fault in faults))

    @classmethod
    def failed(cls, failure: Failure, file: str = "", line: int = 0, where: str = "") -> Reject:
        """Return a reject for a failure of the engine or of grounding; `where` names the home or environment."""
        step = f"[{failure.action}] {', '.join(failure.names)}".rstrip() if failure.action else ""
        message = ", ".join(filter(None, (": ".join(filter(None, (step, why(failure)))), where)))
        remedy = REMEDIES.get(failure.code, "")
        return cls((Diagnostic(failure.code, message, file, line, 0, 0, " ".join(failure.names), remedy),))

    @classmethod
    def caused(cls, error: BaseException, file: str = "") -> Reject:
        """Return a reject for an exception: a `HearthError` keeps its faults, any other is internal."""
        if isinstance(error, HearthError) and error.diagnostics:
            return cls.because(error.diagnostics, file)
        frames = traceback.extract_tb(error.__traceback__)
        where = f"{PurePath(frames[-1].filename).name}:{frames[-1].lineno}" if frames else "?"
        message = f"{type(error).__name__} at {where}: {as_text(error)}"
        fault = Diagnostic(Code.INTERNAL_ERROR, message, file, suggestion="this is a fault of Hearth; please report it")
        return cls((fault,), internal=True)

    @property
    def code(self) -> str:
        """Return the code that it is counted under."""
        return INTERNAL_ERROR if self.internal else str(self.diagnostics[0].code)

    def rows(self) -> list[Row]:
        """Return the row of the rejects table for each fault."""
        return [
            {
                "code": self.code if self.internal else str(fault.code),
                "file": as_text(fault.file),
                "line": _as_number(fault.line),
                "column": _as_number(fault.column),
                "found": as_text(fault.found)[:_LONGEST],
                "message": as_text(fault.message)[:_LONGEST],
                "suggestion": as_text(fault.suggestion),
            }
            for fault in self.diagnostics
        ]


def as_text(value: object) -> str:
    """Text that UTF-8 can hold, of any value: half characters and bytes that are not text as `\\udcff`."""
    try:
        text = value if isinstance(value, str) else "" if value is None else str(value)
        return text if text.isascii() else text.encode("utf-8", "backslashreplace").decode()
    except Exception as error:
        return f"a {type(value).__name__} that cannot be shown: {type(error).__name__}"


def _as_number(value: object) -> int:
    """Return a line or column; 0 where it is not one."""
    return value if isinstance(value, int) and 0 <= value <= _LARGEST else 0
