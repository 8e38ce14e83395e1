"""Requests to a chat server: repeated where that may help, with limits of time and size that a server cannot evade."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from email.utils import parsedate_to_datetime
from math import isfinite
from typing import Any

from hearth.envs.text_layout import printable
from hearth.llm.timed_connections import within
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.optional_libraries import library

PASSING = frozenset({408, 409, 425, 429})
"""Statuses after which a request is made again, besides 500 and above."""

FIRST_WAIT, LONGEST_WAIT = 0.5, 60.0
"""Seconds before the second try, and at most; each wait is twice the one before."""

LARGEST = 4 << 20
"""Bytes of a reply."""

MOST_SHOWN = 200
"""Characters of a server's own words in a message."""


_KEY = "set HEARTH_LLM_KEY to a key that the server takes"

REMEDIES = {
    "ConnectError": "start the server (`hearth llm serve` for one on this machine), or correct its address",
    "401": _KEY,
    "403": _KEY,
}
"""Remedies by the reason of a last try; other reasons have one by whether another try may help."""


class Failed(Exception):  # noqa: N818 - a try, not the request
    """A try that brought no reply.

    Attributes:
        reason: short and without numbers that change: `429`, `ReadTimeout`.
        said: the server's own words.
        again: whether another try may help.
        wait: seconds that the server asks to wait; None where it does not say.
    """

    def __init__(self, reason: str, said: str = "", *, again: bool = True, wait: float | None = None) -> None:
        super().__init__(reason)
        self.reason, self.said, self.again, self.wait = reason, said, again, wait


@dataclass(frozen=True)
class Answered:
    """The result of a request: the JSON, and the number of tries."""

    data: Any
    tries: int


def with_retries(
    once: Callable[[], Any], tries: int, where: str, failed: Callable[[str], None], sleep: Callable[[float], None]
) -> Answered:
    """Return what a request brings, and repeat it where it fails and may succeed later.

    Args:
        once: makes the request; raises `Failed`.
        tries: how often, at most.
        where: the server, for messages; without a key.
        failed: gets the reason of each try that failed.
        sleep: waits for seconds.

    Raises:
        HearthError: NO_ANSWER: no try helped, or none can help.
    """
    wait = FIRST_WAIT
    for number in range(1, tries + 1):
        try:
            return Answered(once(), number)
        except Failed as error:
            failed(error.reason)
            pause = wait if error.wait is None else error.wait
            if not error.again or number == tries or pause > LONGEST_WAIT:
                raise _gave_up(error, number, where, pause) from None
            sleep(pause)
            wait = min(2 * wait, LONGEST_WAIT)
    raise AssertionError


def _gave_up(error: Failed, tries: int, where: str, pause: float) -> HearthError:
    said = f": {printable(error.said)[:MOST_SHOWN]}" if error.said else ""
    times = f" after {tries} tries" if tries > 1 else ""
    long = f"; it asks to wait {pause:.0f} s" if error.again and pause > LONGEST_WAIT else ""
    usual = "the same command goes on from here" if error.again else "see what the server says"
    remedy = REMEDIES.get(error.reason, usual)
    return HearthError.of(
        Code.NO_ANSWER, f"{where} gave no reply{times} ({error.reason}){said}{long}", suggestion=remedy
    )


def post(client: Any, url: str, body: bytes, headers: Mapping[str, str], seconds: float) -> bytes:
    """Return the bytes of a reply.

    Raises:
        Failed: of a status, a connection, or a limit of time or size; no redirection is followed, which could take the
            key elsewhere.
    """
    httpx2 = library("httpx2")
    until, parts, size = time.monotonic() + seconds, [], 0
    try:
        with within(seconds), client.stream("POST", url, content=body, headers=headers, timeout=seconds) as reply:
            for part in reply.iter_bytes():
                size += len(part)
                parts.append(part)
                if size > LARGEST:
                    raise Failed("too long", f"more than {LARGEST:,} bytes")
                if time.monotonic() > until:
                    raise Failed("too slow", f"not whole within {seconds:g} s")
            _need_good(reply, b"".join(parts))
    except httpx2.TransportError as error:
        raise Failed(type(error).__name__, str(error)) from None
    except httpx2.InvalidURL as error:
        raise Failed("InvalidURL", str(error), again=False) from None
    except httpx2.HTTPError as error:  # a body that is not as its head says
        raise Failed(type(error).__name__, str(error)) from None
    return b"".join(parts)


def _need_good(reply: Any, data: bytes) -> None:
    status = reply.status_code
    if status == 200:
        return
    again = status in PASSING or status >= 500
    wait = _asked_to_wait(reply.headers.get("retry-after")) if again else None
    raise Failed(str(status), data[: 4 * MOST_SHOWN].decode("utf-8", "replace"), again=again, wait=wait)


def _asked_to_wait(text: str | None) -> float | None:
    """Return the seconds of a Retry-After, which may be a number or a date; None where it is neither."""
    if text is None:
        return None
    try:
        seconds = float(text)
    except ValueError:
        try:
            seconds = parsedate_to_datetime(text).timestamp() - time.time()
        except (ValueError, TypeError, OverflowError):
            return None
    return max(0.0, seconds) if isfinite(seconds) else None
