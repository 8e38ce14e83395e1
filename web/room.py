"""A room of the server: its addresses and its line on the start page; how a room is declared.

    ROOM = Room("annotate", "Annotate", "Write down an activity, step by step.",
                addresses=(get("/", tasks), post("/{task}", submit), socket("/live", live)),
                desk=(get("/", overview),))

puts `tasks` at `/annotate/` for persons and `overview` at `/desk/annotate/` for researchers.
"""

from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from enum import Enum
from typing import Any

import sqlalchemy as sql

from hearth.web.limits import MOST_BODY
from hearth.web.room_request import Handler, Web
from hearth.web.sessions import Keeps


class Who(Enum):
    """The people who may ask for an address."""

    ANYONE = "anyone"
    PERSON = "a person with a session"
    RESEARCHER = "a researcher with the desk's token"


@dataclass(frozen=True, slots=True)
class Address:
    """One address of a room.

    Attributes:
        method: `GET` (HEAD too), `POST`, or `SOCKET`.
        path: within the room, as Starlette writes it: `/{task}/review`.
        handler: a function of a `Visit`; of a socket, a coroutine function of a `Link`.
        who: may ask; addresses of a room's desk are the researcher's anyway.
        most: bytes of a body.
    """

    method: str
    path: str
    handler: Callable[..., Any]
    who: Who = Who.PERSON
    most: int = MOST_BODY


def get(path: str, handler: Handler, who: Who = Who.PERSON) -> Address:
    """Return an address that is read."""
    return Address("GET", path, handler, who)


def post(path: str, handler: Handler, who: Who = Who.PERSON, most: int = MOST_BODY) -> Address:
    """Return an address that changes something."""
    return Address("POST", path, handler, who, most)


def socket(path: str, handler: Callable[[Any], Awaitable[None]]) -> Address:
    """Return the address of a socket; its handler gets a `Link` of `web/person_socket.py`."""
    return Address("SOCKET", path, handler)


def _nothing(web: Web) -> None:
    """Do nothing, as most rooms do when a server starts."""


def _keeps_nothing(connection: sql.Connection, person: str, nobody: str) -> int:
    """Keep the rows of a person who withdraws, as most rooms do."""
    return 0


def _has_no_study(web: Web, person: str) -> bool:
    """Return that nobody takes part in a study of a room, as most rooms have none."""
    return False


@dataclass(frozen=True, slots=True)
class Room:
    """A room.

    Attributes:
        name: the first part of its addresses, and the folder of its templates and static files.
        title: as the navigation has it.
        line: the purpose, for the start page.
        addresses: the addresses for people.
        desk: the addresses for researchers, under `/desk/NAME`.
        needs: names of `THIRD_PARTY` of `web/third_party_scripts.py` without which something of it does not work.
        listed: whether the start page and the navigation list it.
        own: the address of the page on which people see what they did here; "" where there is none.
        opens: writes the files that follow from the store, when a server starts and after a deletion.
        keeps: gives what others built on to nobody when its person withdraws; the rest goes with the session.
        studied: whether a person takes part in a study, which the page of the session is to say.
    """

    name: str
    title: str
    line: str
    addresses: tuple[Address, ...]
    desk: tuple[Address, ...] = ()
    needs: tuple[str, ...] = ()
    listed: bool = True
    own: str = ""
    opens: Callable[[Web], None] = _nothing
    keeps: Keeps = _keeps_nothing
    studied: Callable[[Web, str], bool] = _has_no_study
