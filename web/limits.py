"""Limits on the size and the rate of one sender's requests."""

import time
from collections import OrderedDict
from collections.abc import Callable

from hearth.schemas.failures import Code
from hearth.web.web_errors import WebError

MOST_BODY = 256 * 1024
"""Bytes of a request's body, such as an upload, unless its address says otherwise."""

MOST_FIELDS = 2_000
"""Fields of a form."""

MOST_MESSAGE = 64 * 1024
"""Bytes of a message over a socket."""

FREE_CHUNKS = 256
"""Pieces of a request's body, whatever their size."""

LEAST_OF_A_CHUNK = 256
"""Bytes of a body for each further piece, on average."""

FRAMES_EACH_SECOND, BURST_OF_FRAMES = 120, 300
"""Frames of a socket, pings and parts of messages too: twice as many as the messages that a page may send."""

QUIET_SECONDS = 9.0
"""Seconds for which a connection may ask nothing, read nothing, or be in the middle of a request's body.

It is looked at every second, so that it ends within ten.
"""

MOST_CONNECTIONS = 4_000
"""Connections of a process at once, where the limit of open files allows as many."""

RATES = {
    "request": (40, 200),
    "begin": (1, 30),
    "token": (0.5, 10),
    "run": (1, 5),
    "create": (50, 400),
    "world": (2_000, 4_000),
}
"""Requests a second and at once: all of a session; new sessions and tokens that are tried, of an address; runs of a
program, of a session; of `serve --text` and `mcp`, new worlds of an address, and requests of a world."""

MOST_SENDERS = 10_000
"""Senders that are remembered; the one that was silent longest is forgotten first."""


class Rate:
    """A limit of each sender: at most `burst` requests at once and `each_second` in the long run.

    Args:
        each_second: requests a second.
        burst: requests at once after a pause.
        now: the clock, in seconds.
    """

    def __init__(self, each_second: float, burst: float, now: Callable[[], float] = time.monotonic) -> None:
        self.each_second, self.burst, self._now = each_second, burst, now
        self._left: OrderedDict[str, tuple[float, float]] = OrderedDict()

    def allows(self, sender: str) -> bool:
        """Count a request of a sender; whether it is within the limits."""
        now = self._now()
        left, since = self._left.pop(sender, (self.burst, now))
        left = min(self.burst, left + (now - since) * self.each_second)
        self._left[sender] = (max(0.0, left - 1), now)
        if len(self._left) > MOST_SENDERS:
            self._left.popitem(last=False)
        return left >= 1

    def check(self, sender: str, place: str = "") -> None:
        """Count a request of a sender.

        Raises:
            WebError: TOO_FAST.
        """
        if not self.allows(sender):
            raise WebError(Code.TOO_FAST, place, f"at most {self.each_second:g} a second", "more")


def usual_rates() -> dict[str, Rate]:
    """Return the limits of `RATES`, with nothing counted yet."""
    return {name: Rate(each_second, burst) for name, (each_second, burst) in RATES.items()}
