"""The server's log: however much strangers make it say, it grows slowly."""

import errno
import logging
import time
from collections.abc import Callable

LOGGERS = ("uvicorn.error", "asyncio")
"""Loggers whose lines strangers can cause."""

MOST_LINES = 2
"""Lines of one kind in a minute."""

MOST_KINDS = 100
"""Kinds of lines that are counted at once."""


class FewOfAKind(logging.Filter):
    """Passes a few lines of each kind in a minute; the first of the next minute says how many were left out.

    Args:
        now: the clock, in seconds.
    """

    def __init__(self, now: Callable[[], float] = time.monotonic) -> None:
        super().__init__()
        self._now = now
        self._counted: dict[str, tuple[float, int]] = {}

    def filter(self, record: logging.LogRecord) -> bool:
        """Return whether a line is written."""
        now, kind = self._now(), _kind(record)
        _shorten(record)
        since, count = self._counted.get(kind, (now, 0))
        if now - since >= 60:
            if count > MOST_LINES:
                record.msg = f"{record.msg}\n({count - MOST_LINES} like this were left out)"
            since, count = now, 0
        if len(self._counted) >= MOST_KINDS and kind not in self._counted:
            self._counted.clear()
        self._counted[kind] = since, count + 1
        return count < MOST_LINES


def _kind(record: logging.LogRecord) -> str:
    """Return what lines have in common that differ in their values: the message's form, and where an error arose."""
    kind, _, trace = record.exc_info or (None, None, None)
    while trace is not None and trace.tb_next is not None:
        trace = trace.tb_next
    at = f"{kind and kind.__name__} {trace.tb_frame.f_code.co_filename}:{trace.tb_lineno}" if trace else ""
    return f"{record.name} {str(record.msg).partition(chr(10))[0][:80]} {at}"


def _shorten(record: logging.LogRecord) -> None:
    """Leave out the trace of an error that a stranger or the limit of open files causes, not the program."""
    error = record.exc_info[1] if record.exc_info else None
    if isinstance(error, UnicodeDecodeError) or getattr(error, "errno", None) in (errno.EMFILE, errno.ENFILE):
        record.msg = f"{record.getMessage().splitlines()[0]} ({type(error).__name__})"
        record.args, record.exc_info, record.exc_text = (), None, None


def limit_logs() -> None:
    """Put the filter before the loggers of the server, once."""
    for name in LOGGERS:
        logger = logging.getLogger(name)
        if not any(isinstance(each, FewOfAKind) for each in logger.filters):
            logger.addFilter(FewOfAKind())
