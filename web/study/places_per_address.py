"""Places that one address holds: somebody with many free sessions does not take all those of a study."""

import threading
from collections.abc import Callable
from ipaddress import ip_network

from hearth.schemas.failures import Code
from hearth.web.web_errors import WebError

SHARE = 2
"""An address may hold the number of a study's places divided by this at once, for people who are under way."""

FEWEST = 2
"""Places that it may hold in any study."""

MOST_ADDRESSES = 10_000
"""Addresses that are remembered; they are in memory alone."""


class PlacesHeld:
    """Places taken from each address since this process started."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._by_address: dict[tuple[str, str], set[str]] = {}

    def check(self, study: str, address: str, places: int, under_way: Callable[[str], bool]) -> None:
        """Refuse another place to an address that holds its share.

        Args:
            study: its name.
            address: of the sender.
            places: of the study, in all.
            under_way: whether a session takes part and is neither done nor gone.

        Raises:
            WebError: TOO_FAST.
        """
        with self._lock:
            held = [each for each in self._by_address.get((study, address), ()) if under_way(each)]
            most = max(FEWEST, places // SHARE)
            if len(held) >= most:
                found = f"{len(held)} that are not done"
                raise WebError(Code.TOO_FAST, "place", f"at most {most} people of one address at once", found)

    def add(self, study: str, address: str, session: str) -> None:
        """Keep that a session took a place."""
        with self._lock:
            if len(self._by_address) >= MOST_ADDRESSES:
                self._by_address.pop(next(iter(self._by_address)))
            self._by_address.setdefault((study, address), set()).add(session)


HELD = PlacesHeld()
"""The places of this process's studies."""


def is_stranger(address: str, public: bool) -> bool:
    """Return whether strangers differ by their address; without a public name all come from this machine.

    Args:
        address: as `sender_of` has it.
        public: whether the server has a public name.
    """
    return public or (bool(address) and not ip_network(address).is_loopback)
