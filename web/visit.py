"""What a handler of a room gets: one request with all that was checked about it, and ways to answer."""

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
from hearth.web.limits import Rate
from hearth.web.messages import json_object
from hearth.web.sessions import Session
from hearth.web.store import Store
from hearth.web.web_errors import WebError


@dataclass(frozen=True, slots=True)
class Web:
    """What all handlers share; it holds nothing that a session depends on, so that any process can answer.

    Attributes:
        store: the database.
        known: the knowledge that programs are checked against.
        out: the server's folder: what rooms write there is what `build` reads, but for hidden folders.
        templates: the pages.
        study: the file of the study, or None.
        desk: the digest of the desk's token.
        secure: whether people come by https.
        rates: how fast one may ask, by the names of `RATES`.
        films: a dataset whose films people describe, or None.
        follows: write the files of rooms, which follow from the store.
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

    def written(self) -> None:
        """Write anew what rooms keep in files, once something that these follow from was deleted."""
        for write in self.follows:
            write(self)


@dataclass(frozen=True, slots=True)
class Visit:
    """A request.

    Attributes:
        web: what all handlers share.
        request: the request as it came; its body is read already.
        session: who asks, on addresses of persons; on others maybe None.
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
        """The id of the session, on addresses of persons."""
        assert self.session is not None
        return self.session.id

    def part(self, name: str) -> str:
        """A part of the address that its route names: `/annotate/{task}`.

        Raises:
            WebError: BAD_ARGUMENT, if it has a NUL character, which databases refuse.
        """
        value = str(self.request.path_params[name])
        if "\0" in value:
            raise WebError(Code.BAD_ARGUMENT, name, "a text", "a NUL character")
        return value

    def json(self) -> dict[str, Any]:
        """The body as a JSON object.

        Raises:
            WebError: BAD_JSON.
        """
        return json_object(self.body, "body")

    def field(self, name: str, most: int = 5_000) -> str:
        """A field of the form; "" if it did not come.

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
        """A page from a template of `web/templates/`; all values are escaped."""
        return HTMLResponse(render(self.web, template, self.session, **values), status)

    def answer(self, value: Any, status: int = 200) -> Response:
        """A JSON document; dataclasses are converted."""
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
    """The HTML of a template."""
    return web.templates.get_template(template).render(session=session, **values)


def json_answer(value: Any, status: int = 200) -> Response:
    """A JSON document as an answer."""
    options = orjson.OPT_NON_STR_KEYS | orjson.OPT_SERIALIZE_NUMPY
    return Response(orjson.dumps(value, option=options), status, media_type="application/json")
