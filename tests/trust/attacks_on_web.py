"""Attacks on the server: addresses, tokens, pages of other servers, bodies, others' sessions, texts, sockets.

All go to one server in this process. None may end in a fault of the server, be answered without the policy, show or
change what another person has, or leave markup in a page.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any
from urllib.parse import quote

from attack import Attack
from attacked_site import MINE, attack_on_site, checked, site
from attacks_on_pages import pages
from attacks_on_sockets import sockets
from starlette.testclient import TestClient

from hearth.web.room_registry import ROOMS
from hearth.web.sessions import digest

PARTS = (
    "..",
    "../..",
    "%2e%2e%2f%2e%2e%2fguard",
    "..%5c..%5cguard",
    "%00",
    "x%00.webm",
    "{guard}/secret.csv",
    "%2fetc%2fpasswd",
    "a" * 6_000,
    "%ff%fe",
    "\u202e",
    "'%20OR%20'1'='1",
    "1;DROP%20TABLE%20sessions",
    "<script>",
    "{{7*7}}",
    "-1",
    "9" * 400,
    "%0d%0aSet-Cookie:x=1",
)
TOKENS = ("", "x", "' OR '1'='1", "\u0000", "x" * 90, "x" * 9_000, "%", "null", "../../x")
BODIES: dict[str, tuple[str, bytes]] = {
    "nothing": ("application/json", b""),
    "not JSON": ("application/json", b"{"),
    "a list": ("application/json", b"[]"),
    "deep": ("application/json", b"[" * 100_000),
    "a number": ("application/json", b"1" * 5_000),
    "large": ("application/json", b'{"a": "' + b"x" * 3_000_000 + b'"}'),
    "bytes": ("application/json", bytes(range(256))),
    "surrogate": ("application/json", b'{"type": "\\ud800", "home": "\\ud800", "steps": "\\ud800"}'),
    "numbers": ("application/json", b'{"version": 1e400, "steps": [1e999], "home": -0}'),
    "form of nothing": ("application/x-www-form-urlencoded", b"&" * 3_000),
    "fields": ("application/x-www-form-urlencoded", b"&".join(b"f%d=1" % n for n in range(3_000))),
    "bad text": ("application/x-www-form-urlencoded", b"title=%ff%fe&description=%00&to=%00&token=%ff&person=%00"),
    "repeated": (
        "application/x-www-form-urlencoded",
        b"title=a&title=b&verdict=accept&verdict=x&version=99999999999999999",
    ),
    "numbers in words": (
        "application/x-www-form-urlencoded",
        "version=²&task=²&quantity=٣&room living_room=²".encode(),
    ),
    "multipart": (
        "multipart/form-data; boundary=x",
        b"--x\r\nContent-Disposition: form-data; name=a\r\n\r\n1\r\n--x--",
    ),
}
ORIGINS = (
    "http://evil.example",
    "null",
    "http://127.0.0.1.evil.example",
    "https://127.0.0.1",
    "http://127.0.0.1:81",
    "file://",
    "",
)
HOSTS = (
    "evil.example",
    "127.0.0.1.evil.example",
    "",
    "127.0.0.1@evil.example",
    "localhost:80:80",
    "[::1",
    "127.0.0.1, evil",
)


def addresses() -> Iterator[tuple[str, str]]:
    """Every method and address of every room and of its desk."""
    for room in ROOMS:
        for prefix, some in ((f"/{room.name}", room.addresses), (f"/desk/{room.name}", room.desk)):
            yield from ((each.method, prefix + each.path) for each in some if each.method != "SOCKET")


def web() -> Iterator[Attack]:
    """All attacks on the server."""
    for method, pattern in addresses():
        yield from _parts(method, pattern)
        if method == "POST":
            yield from _posts(pattern)
        yield attack_on_site(f"{method} {pattern} by nobody", lambda m=method, p=pattern: _by_nobody(m, p))
        yield attack_on_site(f"{method} {pattern} of another", lambda m=method, p=pattern: _of_another(m, p))
    for path in ("/static/", "/fetched/", "/", "/come/", "/desk/enter/"):
        for part in PARTS:
            yield attack_on_site(f"GET {path}{part:.30}", lambda p=path + part: checked(_get(site().person(), p)))
    for token in TOKENS:
        yield from _tokens(token)
    yield from pages()
    yield from sockets()


def _get(client: TestClient, path: str) -> Any:
    return client.get(path.replace("{guard}", "/guard"))


def _parts(method: str, pattern: str) -> Iterator[Attack]:
    for part in PARTS if "{" in pattern else ():
        path = re.sub(r"\{[^}]+\}", lambda _, p=part: p, pattern)
        yield attack_on_site(
            f"{method} {pattern} {part:.30}",
            lambda m=method, p=path: checked(
                site()
                .person()
                .request(m, p.replace("{guard}", "/guard"), data={"version": "1"} if m == "POST" else None)
            ),
        )


def _filled(pattern: str) -> str:
    """An address with the owner's things in it."""
    here = site()
    ids = {"game": here.game, "text": here.text, "home": "maple", "challenge": "wah", "number": "0"}
    return re.sub(r"\{(\w+)[^}]*\}", lambda found: ids.get(found[1], "x"), pattern)


def _posts(pattern: str) -> Iterator[Attack]:
    for name, (kind, body) in BODIES.items():
        yield attack_on_site(
            f"POST {pattern} {name}",
            lambda p=pattern, k=kind, b=body: checked(
                site().person().post(_filled(p), content=b, headers={"content-type": k})
            ),
        )
    for origin in ORIGINS:
        yield attack_on_site(f"POST {pattern} from {origin!r}", lambda p=pattern, o=origin: _foreign(p, {"origin": o}))
    for host in HOSTS[:2]:
        yield attack_on_site(f"POST {pattern} to {host!r}", lambda p=pattern, h=host: _foreign(p, {"host": h}))


def _foreign(pattern: str, headers: dict[str, str]) -> None:
    answer = site().owner.post(_filled(pattern), headers=headers, data={"agree": "yes"})
    checked(answer)
    assert answer.status_code == 403, answer.status_code


def _by_nobody(method: str, pattern: str) -> None:
    for client in (site().client(), site().client(headers={"authorization": "Bearer x"})):
        answer = client.request(method, _filled(pattern))
        assert answer.status_code in (401, 403), answer.status_code
        assert MINE not in checked(answer)


def _of_another(method: str, pattern: str) -> None:
    """Another person gets nothing of the owner's game, and nothing of the desk."""
    answer = site().person().request(method, _filled(pattern), data={"version": "1"} if method == "POST" else None)
    checked(answer)
    if pattern.startswith("/desk"):
        assert answer.status_code == 403, answer.status_code
    if "{game}" in pattern:
        assert answer.status_code == 404, answer.status_code


def _tokens(token: str) -> Iterator[Attack]:
    def ask(header: str, value: str, path: str) -> None:
        answer = site().client().get(path, headers={header: value.encode("utf-8", "replace")})
        assert answer.status_code in (400, 401, 403), answer.status_code
        checked(answer)

    for name, path in (("hearth", "/mine"), ("hearth-desk", "/desk")):
        yield attack_on_site(f"cookie {name}={token[:20]!r}", lambda n=name, p=path: ask("cookie", f"{n}={token}", p))
        yield attack_on_site(f"bearer {name} {token[:20]!r}", lambda p=path: ask("authorization", f"Bearer {token}", p))
    yield attack_on_site(
        f"link {token[:20]!r}", lambda: checked(_get(site().client(), f"/desk/enter/{quote(token)}"), True)
    )
    if token == "x":
        stored = digest(site().owner.cookies["hearth"])
        yield attack_on_site("the digest as the token", lambda: ask("cookie", f"hearth={stored}", "/mine"))
