"""The rules for every answer and every request, before any room sees it: headers, hosts, origins."""

import re
from collections.abc import Collection, Mapping
from types import MappingProxyType
from urllib.parse import urlsplit

from starlette.datastructures import Headers, MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from hearth.schemas.failures import Code
from hearth.web.room_request import json_answer
from hearth.web.web_errors import WebError

HEADERS = {
    "Content-Security-Policy": "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; "
    "media-src 'self' blob:; font-src 'self'; connect-src 'self'; worker-src 'self'; form-action 'self'; "
    "base-uri 'none'; frame-ancestors 'none'",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Permissions-Policy": "camera=(), microphone=(), geolocation=()",
}
"""Headers of every answer: only scripts and files of this server run or load, and nothing inline."""

SECURE = {"Strict-Transport-Security": "max-age=31536000"}
"""Of answers to people who come by https."""

OWN = ("127.0.0.1", "localhost", "[::1]")
"""Names by which a browser of this machine asks."""


class Security:
    """Adds the headers to every answer; refuses requests for other hosts and from pages of other servers.

    Args:
        app: the application that answers otherwise.
        hosts: names, besides this machine's own, by which people may ask (a public address), with their port if it is
            not the usual one.
    """

    def __init__(self, app: ASGIApp, hosts: Collection[str] = ()) -> None:
        self.app = app
        self._hosts = frozenset(hosts)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request or a connection."""
        if scope["type"] not in ("http", "websocket"):
            await self.app(scope, receive, send)
            return
        fault = self._fault(scope)
        if fault is None:
            await self.app(scope, receive, _with_headers(send, self._more(scope)))
        elif scope["type"] == "websocket":
            await receive()
            await send({"type": "websocket.close", "code": 4403, "reason": str(fault.code)})
        else:
            await json_answer(fault.as_json(), fault.status)(scope, receive, _with_headers(send))

    def _more(self, scope: Scope) -> Mapping[str, str]:
        """Return the headers of answers by the public name: browsers ask for it by https alone from then on."""
        return SECURE if scheme_of(Headers(scope=scope).get("host", "")) == "https" else {}

    def _fault(self, scope: Scope) -> WebError | None:
        """Return a page of another server may not use this server's cookies, under whatever name it asks for it."""
        headers = Headers(scope=scope)
        host = headers.get("host", "")
        if not (known_host(host) or host.removesuffix(":443") in self._hosts):
            return WebError(Code.NOT_ALLOWED, "Host", "this server's name", "another")
        origin = headers.get("origin")
        changes = scope["type"] == "websocket" or scope["method"] not in ("GET", "HEAD", "OPTIONS")
        if changes and origin is not None and origin != f"{scheme_of(host)}://{host}":
            return WebError(Code.NOT_ALLOWED, "Origin", "a page of this server", "another page")
        site = headers.get("sec-fetch-site", "none")
        if changes and site not in ("same-origin", "none"):
            return WebError(Code.NOT_ALLOWED, "Sec-Fetch-Site", "a page of this server", "another page")
        return None


def known_host(host: str) -> bool:
    """Return whether a `Host` is this machine itself, at any port: a tunnel may have another than the server."""
    name, colon, port = host.rpartition(":") if _PORT.search(host) else (host, "", "")
    return name in OWN and (not colon or 0 < int(port) < 65_536)


_PORT = re.compile(r":[0-9]{1,5}\Z")


def scheme_of(host: str) -> str:
    """Return the scheme by which people ask for a host: https where it is not this machine's own name."""
    return "http" if _name(f"//{host}") in OWN else "https"


def _name(address: str) -> str:
    """Return the host of an address, without its port; "" where it is not one."""
    try:
        netloc = urlsplit(address).netloc
    except ValueError:
        return ""
    return netloc.rpartition(":")[0] if netloc.rpartition(":")[2].isdecimal() and ":" in netloc else netloc


def own_address(wanted: str) -> str:
    """Return an address of this server, without its name; another server's becomes the start page."""
    plain = wanted.isascii() and wanted.isprintable() and "\\" not in wanted
    return wanted if plain and wanted.startswith("/") and not wanted.startswith("//") else "/"


def _with_headers(send: Send, more: Mapping[str, str] = MappingProxyType({})) -> Send:
    async def sent(message: Message) -> None:
        if message["type"] in ("http.response.start", "websocket.accept"):
            headers = MutableHeaders(scope=message)
            for name, value in (*HEADERS.items(), *more.items()):
                headers[name] = value
            if "Location" in headers:
                headers["Location"] = own_address(headers["Location"])
            headers.setdefault("Cache-Control", "no-store")
        await send(message)

    return sent
