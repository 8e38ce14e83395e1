"""Attacks on the server: addresses, tokens, pages of other servers, bodies, others' sessions, texts, sockets.

All go to one server in this process. None may end in a fault of the server, be answered without the policy, show or
change what another person has, or leave markup in a page.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple
from urllib.parse import quote

from attack import Attack, Ground
from starlette.testclient import TestClient
from starlette.websockets import WebSocketDisconnect

from hearth.kb.loading.load import default
from hearth.web.application import application
from hearth.web.limits import RATES, Rate
from hearth.web.play import start_trial
from hearth.web.play.trials import published, trial
from hearth.web.room_registry import ROOMS
from hearth.web.sessions import digest, find
from hearth.web.store import Store, default_url

DESK, BASE = "the-token-of-the-desk", "http://127.0.0.1"
MINE = "a private title"
STUDY = "people-alone"

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
TEXTS = (
    "<script>alert(1)</script>",
    '"><img src=x onerror=alert(1)>',
    "</title><svg onload=alert(1)>",
    "{{7*7}}",
    "${7*7}",
    "=cmd|' /C calc'!A0",
    "javascript:alert(1)",
)
FRAMES: tuple[Any, ...] = (
    "",
    "{",
    "[]",
    "7",
    "null",
    '"x"',
    "\x00",
    "[" * 50_000,
    "{" * 50_000,
    '{"type": 1, "n": 2}',
    '{"type": "act"}',
    "x" * 70_000,
    '{"type": "hello", "tab": {}, "n": 2}',
    '{"type": "act", "n": 2, "tick": -1, "act": null}',
    b"\xff\xfe\x00",
    b"",
    '{"type": "act", "n": 2, "tick": 0, "act": "[Grab] <../../x> (1)"}',
    '{"type": "act", "n": 2, "tick": 0, "act": {"a": []}}',
    '{"type": "act", "n": 2, "tick": 1e400, "act": null}',
    '{"type": "act", "n": 2, "tick": 0, "act": "[Grab] <x> (' + "9" * 300 + ')"}',
    '{"type": "act", "n": 2, "tick": 0, "act": "[Grab] <x> (\u00b2)"}',
    '{"type": "picture", "n": 2}',
    '{"type": "pick", "n": 2, "x": -1, "y": 0}',
    '{"type": "\ud800", "n": 2}',
    '{"n": 99999999999999999999999, "type": "act"}',
    '{"type": "finish", "n": 2.0}',
    '{"type": "finish", "n": true}',
)


class Site(NamedTuple):
    """The server that is attacked, and a person with something of its own in every room."""

    made: TemporaryDirectory[str]
    store: Store
    app: Any
    owner: TestClient
    text: str
    game: str

    def client(self, **options: Any) -> TestClient:
        return TestClient(self.app, base_url=BASE, follow_redirects=False, **options)

    def person(self) -> TestClient:
        client = self.client()
        assert client.post("/begin").status_code == 303
        return client


@cache
def site() -> Site:
    """The server."""
    made = TemporaryDirectory()
    out = Path(made.name)
    store = Store(default_url(out))
    rates = dict.fromkeys(RATES, Rate(10_000, 10_000))
    app = application(store, default(), out, DESK, study=Path(STUDY), rates=rates)
    owner = TestClient(app, base_url=BASE, follow_redirects=False)
    owner.post("/begin")
    session = find(store, owner.cookies["hearth"])
    assert session is not None
    owner.post(
        "/annotate/describe",
        data={"title": MINE, "description": "Sit down on the sofa. Then watch a film on television."},
    )
    (text,) = re.findall(r'href="/annotate/task/([^"]+)"', owner.get("/annotate/tasks").text)
    chosen = trial(published("wah", "test-1", 0), default())
    game = store.write(lambda connection: start_trial(connection, session.id, chosen))
    owner.post("/study/agree", data={"agree": "yes"})
    return Site(made, store, app, owner, text, game)


def checked(answer: Any, refused: bool = False) -> str:
    """The text of an answer that is not a fault of the server, and has the policy; `refused` ones have no success."""
    assert answer.status_code < 500 or answer.status_code == 503, answer.status_code
    assert "script-src 'self'" in answer.headers["content-security-policy"]
    assert "set-cookie" not in answer.headers or "\n" not in answer.headers["set-cookie"]
    assert not refused or answer.status_code in (303, 307, 400, 401, 403, 404, 405, 409, 413, 415, 422), (
        answer.status_code
    )
    text: str = answer.text
    assert "Traceback" not in text
    return text


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
        yield _attack(f"{method} {pattern} by nobody", lambda m=method, p=pattern: _by_nobody(m, p))
        yield _attack(f"{method} {pattern} of another", lambda m=method, p=pattern: _of_another(m, p))
    for path in ("/static/", "/fetched/", "/", "/come/", "/desk/enter/"):
        for part in PARTS:
            yield _attack(f"GET {path}{part:.30}", lambda p=path + part: checked(_get(site().person(), p)))
    for token in TOKENS:
        yield from _tokens(token)
    for text in TEXTS:
        for name, write in WRITERS.items():
            yield _attack(f"{name}: {text}", lambda w=write, t=text: w(t))
    for number, frame in enumerate(FRAMES):
        yield _attack(f"socket {number}: {frame!r:.40}", lambda f=frame: _frames([f]))
    yield _attack("socket: all in turn, 2,000 times", lambda: _frames(FRAMES, 2_000))
    yield _attack("socket: of another", lambda: _socket_of(site().person(), site().game))
    yield _attack("socket: of nobody", lambda: _socket_of(site().client(), site().game))
    yield _attack(
        "socket: page of another server",
        lambda: _socket_of(site().owner, site().game, {"origin": "http://evil.example"}),
    )


def _attack(name: str, call: Callable[[], Any]) -> Attack:
    def run(ground: Ground) -> Any:
        found = call()
        _untouched()
        return found

    return Attack("web", name[:120], run)


def _untouched() -> None:
    """What the owner has is as it was."""
    here = site()
    assert here.owner.get("/mine").status_code == 200
    assert MINE in here.owner.get("/annotate/tasks").text


def _get(client: TestClient, path: str) -> Any:
    return client.get(path.replace("{guard}", "/guard"))


def _parts(method: str, pattern: str) -> Iterator[Attack]:
    for part in PARTS if "{" in pattern else ():
        path = re.sub(r"\{[^}]+\}", lambda _, p=part: p, pattern)
        yield _attack(
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
        yield _attack(
            f"POST {pattern} {name}",
            lambda p=pattern, k=kind, b=body: checked(
                site().person().post(_filled(p), content=b, headers={"content-type": k})
            ),
        )
    for origin in ORIGINS:
        yield _attack(f"POST {pattern} from {origin!r}", lambda p=pattern, o=origin: _foreign(p, {"origin": o}))
    for host in HOSTS[:2]:
        yield _attack(f"POST {pattern} to {host!r}", lambda p=pattern, h=host: _foreign(p, {"host": h}))


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
        yield _attack(f"cookie {name}={token[:20]!r}", lambda n=name, p=path: ask("cookie", f"{n}={token}", p))
        yield _attack(f"bearer {name} {token[:20]!r}", lambda p=path: ask("authorization", f"Bearer {token}", p))
    yield _attack(f"link {token[:20]!r}", lambda: checked(_get(site().client(), f"/desk/enter/{quote(token)}"), True))
    if token == "x":
        stored = digest(site().owner.cookies["hearth"])
        yield _attack("the digest as the token", lambda: ask("cookie", f"hearth={stored}", "/mine"))


def _described(text: str) -> None:
    person = site().person()
    person.post(
        "/annotate/describe", data={"title": text[:80], "description": f"{text} Sit down. Then {text} watch a film."}
    )
    _nowhere(text, person, "/annotate/tasks", "/annotate/")


def _refused_field(text: str) -> None:
    """Texts that come back in what is refused."""
    person = site().person()
    for path, data in (
        ("/annotate/describe", {"title": text}),
        ("/play/new", {"challenge": text, "task": text}),
        ("/begin", {"to": text}),
    ):
        answer = person.post(path, data=data, headers={"accept": "text/html"})
        checked(answer)
        assert answer.headers.get("location", "/").startswith("/")
        _no_markup(text, answer)


def _special(text: str) -> None:
    """A program with a hostile special block, on the pages of its writer and of the desk."""
    here, person = site(), site().person()
    person.post(f"/annotate/task/{here.text}/scene", data={"room living_room": "1", "version": "1"})
    version = person.get(f"/annotate/task/{here.text}/work").json()["version"]
    checked(person.post(f"/annotate/task/{here.text}/save", json={"version": version, "steps": [{"special": text}]}))
    _nowhere(text, person, f"/annotate/task/{here.text}/compose", f"/annotate/task/{here.text}")
    desk = here.client(headers={"authorization": f"Bearer {DESK}"})
    _nowhere(text, desk, "/desk/annotate/")


def _left_study(text: str) -> None:
    person = site().person()
    person.post("/study/agree", data={"agree": "yes"})
    for path in ("understood", "answer", "begin", "leave"):
        checked(person.post(f"/study/{path}", data={"answer-comments": text, "person": text}))
    _nowhere(text, person, "/study/")
    desk = site().client(headers={"authorization": f"Bearer {DESK}"})
    checked(desk.post("/desk/study/forget", data={"person": text}))
    _nowhere(text, desk, "/desk/study/")


WRITERS = {"description": _described, "refused": _refused_field, "special block": _special, "study": _left_study}


def _nowhere(text: str, client: TestClient, *paths: str) -> None:
    for path in paths:
        answer = client.get(path)
        checked(answer)
        _no_markup(text, answer)


def _no_markup(text: str, answer: Any) -> None:
    page = "text/html" in answer.headers.get("content-type", "")
    assert not page or "<" not in text or text not in answer.text
    assert not page or text not in ("{{7*7}}", "${7*7}") or ">49<" not in answer.text


def _frames(frames: Any, times: int = 1) -> None:
    """Frames that are no messages are refused one by one, and the next that is one is taken."""
    here = site()
    person = here.person()
    session = find(here.store, person.cookies["hearth"])
    assert session is not None
    chosen = trial(published("wah", "test-1", 1), default())
    game = here.store.write(lambda connection: start_trial(connection, session.id, chosen))
    with _socket(person, game) as socket:
        socket.send_text('{"type": "hello", "tab": "a", "n": 1}')
        assert json.loads(socket.receive_text())["tick"] == 0
        for number in range(max(times, len(frames))):
            frame = frames[number % len(frames)]
            socket.send_bytes(frame) if isinstance(frame, bytes) else socket.send_text(
                frame.encode("utf-8", "replace").decode()
            )
            assert json.loads(socket.receive_text())["type"] == "error"
    with _socket(person, game) as socket:
        socket.send_text('{"type": "hello", "tab": "b", "n": 1}')
        assert json.loads(socket.receive_text())["tick"] == 0


def _socket(client: TestClient, game: str, headers: dict[str, str] | None = None) -> Any:
    cookie = {"cookie": f"hearth={client.cookies.get('hearth', '')}"}
    return client.websocket_connect(f"ws://127.0.0.1/play/game/{game}/live", headers={**cookie, **(headers or {})})


def _socket_of(client: TestClient, game: str, headers: dict[str, str] | None = None) -> None:
    try:
        with _socket(client, game, headers) as socket:
            assert json.loads(socket.receive_text())["type"] == "error"
    except WebSocketDisconnect:
        return
