"""A token before an application of programs: every request shows it, or is refused."""

import hmac

from starlette.requests import Request
from starlette.types import ASGIApp, Receive, Scope, Send

from hearth.schemas.failures import Code
from hearth.web.errors_as_faults import refusal
from hearth.web.limits import usual_rates
from hearth.web.sender_addresses import sender_of
from hearth.web.sessions import digest
from hearth.web.web_errors import WebError


class TokenGate:
    """Lets requests with `Authorization: Bearer TOKEN` through.

    Args:
        app: the application that answers them.
        token: the token.
    """

    def __init__(self, app: ASGIApp, token: str) -> None:
        self._app, self._token = app, digest(token)
        self._tries = usual_rates()["token"]

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request, or refuse it."""
        if scope["type"] == "http" and (fault := self._fault(Request(scope))) is not None:
            await refusal(fault)(scope, receive, send)
        else:
            await self._app(scope, receive, send)

    def _fault(self, request: Request) -> WebError | None:
        kind, _, given = request.headers.get("authorization", "").partition(" ")
        if kind.lower() == "bearer" and hmac.compare_digest(digest(given), self._token):
            return None
        try:
            self._tries.check(sender_of(request), "Authorization")
        except WebError as error:
            return error
        return WebError(Code.NOT_ALLOWED, "Authorization", "`Bearer` and the server's token", "none, or another")
