"""The input of a room's handler: one request with its checked parts, and ways to answer."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import jinja2
import orjson
from starlette.requests import Request
from starlette.responses import HTMLResponse, RedirectResponse, Response

from hearth.kb.knowledge import Knowledge
from hearth.schemas.failures import Code
from hearth.schemas.terminal import without_controls
from hearth.web.limits import Rate
from hearth.web.messages import json_object
from hearth.web.sender_addresses import Network
from hearth.web.sessions import Keeps, Session
from hearth.web.store import Store
from hearth.web.web_errors import WebError


@dataclass(frozen=True, slots=True)
class Web:
    """The common state of all handlers; no session depends on it, so that any process can answer.

    Attributes:
        store: the database.
        known: the knowledge that programs are checked against.
        out: the server's folder; `build` reads the files that rooms write there, but for hidden folders.
        templates: the pages.
        study: the file of the study, or None.
        desk: the digest of the desk's token.
        secure: whether people come by https.
        rates: limits on the rate of requests, by the names of `RATES`.
        films: a dataset whose films people describe, or None.
        follows: write the files of rooms, which follow from the store.
        keeps: give to nobody what others built on, when a person withdraws.
        lab: the network behind which many participants sit, whom limits by address do not count; None for none.
        studied: say whether a person takes part in a study.
    """

    store: Store
    known: Knowledge
    out: Path
    templates: jinja2.Environment
    desk: str
    rates: Mapping[str, Rate]
    study: Path | None = None
    secure: bool = False
    films: Path | None = None
    follows: tuple[Callable[[Web], None], ...] = ()
    keeps: tuple[Keeps, ...] = ()
    studied: tuple[Callable[[Web, str], bool], ...] = ()
    lab: Network | None = None

    def written(self) -> None:
        """Write the rooms' files anew, once data that they follow from was deleted."""
        for write in self.follows:
            write(self)


@dataclass(frozen=True, slots=True)
class Visit:
    """A request.

    Attributes:
        web: the common state of all handlers.
        request: the request as it came; its body is read already.
        session: the sender's session, on addresses of persons; on others maybe None.
        body: at most as many bytes as the address allows.
        fields: a form's, or the address's query.
    """

    web: Web
    request: Request
    session: Session | None
    body: bytes
    fields: Mapping[str, str]

    @property
    def person(self) -> str:
        """Return the id of the session, on addresses of persons."""
        assert self.session is not None
        return self.session.id

    def part(self, name: str) -> str:
        """Return a part of the address that its route names: `/annotate/{task}`.

        Raises:
            WebError: BAD_ARGUMENT, if it has a NUL character, which databases refuse.
        """
        value = str(self.request.path_params[name])
        if "\0" in value:
            raise WebError(Code.BAD_ARGUMENT, name, "a text", "a NUL character")
        return value

    def json(self) -> dict[str, Any]:
        """Return the body as a JSON object.

        Raises:
            WebError: BAD_JSON.
        """
        return json_object(self.body, "body")

    def field(self, name: str, most: int = 5_000) -> str:
        """Return a field of the form; "" if it did not come.

        Raises:
            WebError: BAD_ARGUMENT, if it is longer than `most`.
        """
        value = self.fields.get(name, "")
        if len(value) > most:
            raise WebError(Code.BAD_ARGUMENT, name, f"at most {most} characters", f"{len(value)} characters")
        if "\0" in value:
            raise WebError(Code.BAD_ARGUMENT, name, "a text", "a NUL character")
        return value

    def page(self, template: str, status: int = 200, **values: Any) -> Response:
        """Return a page from a template of `web/templates/`; all values are escaped."""
        return HTMLResponse(render(self.web, template, self.session, **values), status)

    def answer(self, value: Any, status: int = 200) -> Response:
        """Return a JSON document; dataclasses are converted."""
        return json_answer(value, status)

    def go(self, address: str) -> Response:
        """Send the browser to an address of ours, by GET."""
        return RedirectResponse(address, 303)


def by_browser(asked: Request) -> bool:
    """Return whether who asks takes a page; programs, which do not, get JSON."""
    return "text/html" in asked.headers.get("accept", "")


Handler = Callable[[Visit], Response]
"""A plain function; it runs in a thread, so that it may wait for the store."""


def render(web: Web, template: str, session: Session | None, **values: Any) -> str:
    """Return the HTML of a template."""
    return without_controls(web.templates.get_template(template).render(session=session, **values))


def json_answer(value: Any, status: int = 200) -> Response:
    """Return a JSON document as an answer."""
    options = orjson.OPT_NON_STR_KEYS | orjson.OPT_SERIALIZE_NUMPY
    return Response(orjson.dumps(value, option=options), status, media_type="application/json")
