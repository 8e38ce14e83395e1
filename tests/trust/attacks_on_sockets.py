"""Attacks on the socket of a game: frames that are no messages, and sockets of others."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

from attack import Attack
from attacked_site import attack_on_site, site
from starlette.testclient import TestClient
from starlette.websockets import WebSocketDisconnect

from hearth.kb.loading.load import default
from hearth.web.play import start_trial
from hearth.web.play.play_trials import published, trial
from hearth.web.sessions import find

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


def sockets() -> Iterator[Attack]:
    """Every frame alone, all in turn, and sockets that are another's."""
    for number, frame in enumerate(FRAMES):
        yield attack_on_site(f"socket {number}: {frame!r:.40}", lambda f=frame: _frames([f]))
    yield attack_on_site("socket: all in turn, 2,000 times", lambda: _frames(FRAMES, 2_000))
    yield attack_on_site("socket: of another", lambda: _socket_of(site().person(), site().game))
    yield attack_on_site("socket: of nobody", lambda: _socket_of(site().client(), site().game))
    yield attack_on_site(
        "socket: page of another server",
        lambda: _socket_of(site().owner, site().game, {"origin": "http://evil.example"}),
    )


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
