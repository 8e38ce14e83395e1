"""Many small pieces of a request or a socket: refused, before they keep others waiting."""

from __future__ import annotations

import contextlib
import json
import socket
import threading
import time

import httpx2 as httpx
import pytest
from web.test_connections import FORM, HOST, connected, upgraded

WAITS = 1.0
"""Seconds that others may wait, at most."""

CHUNKED = b"Transfer-Encoding: chunked\r\n\r\n"
CHUNKS = {
    "an address that is none": (b"POST /nosuch HTTP/1.1\r\n" + HOST + CHUNKED, b"1\r\na\r\n"),
    "an address of everybody": (b"POST /begin HTTP/1.1\r\n" + HOST + FORM + CHUNKED, b"1\r\na\r\n"),
    "a file": (b"POST /static/style.css HTTP/1.1\r\n" + HOST + CHUNKED, b"1\r\na\r\n"),
    "chunks with extensions": (b"POST /begin HTTP/1.1\r\n" + HOST + FORM + CHUNKED, b"1;a=b\r\na\r\n"),
    "two bytes each": (b"POST /begin HTTP/1.1\r\n" + HOST + FORM + CHUNKED, b"2\r\nab\r\n"),
}


def frame(kind: int, data: bytes, end: bool = True) -> bytes:
    """A frame of a socket, of fewer than 126 bytes."""
    return bytes([end << 7 | kind, 0x80 | len(data)]) + bytes(4) + data


HELLO = json.dumps({"n": 1, "type": "hello", "tab": "1", "again": True}).encode()
FRAMES = {
    "empty pings": frame(9, b"") * 100_000,
    "pings with a text": frame(9, b"x" * 100) * 20_000,
    "empty parts": frame(1, b"", end=False) + frame(0, b"", end=False) * 100_000,
    "messages of a byte": frame(1, b"x") * 60_000,
    "hellos": frame(1, HELLO) * 5_000,
    "answers to no ping": frame(10, b"") * 100_000,
}


def wait(address: str, begin, data: bytes) -> float:
    """The longest time that a file takes somebody in a flood; the better of two, as the machine may be busy itself."""
    worst = flooded(address, begin, data)
    return worst if worst < WAITS else flooded(address, begin, data)


def flooded(address: str, begin, data: bytes, seconds: float = 3) -> float:
    """The longest time that a file takes somebody while three send data over and over."""
    until, waits = time.monotonic() + seconds, []

    def send() -> None:
        while time.monotonic() < until:
            with contextlib.suppress(OSError), begin() as connection:
                connection.sendall(data)
                connection.recv(100)

    threads = [threading.Thread(target=send) for _ in range(3)]
    for each in threads:
        each.start()
    while time.monotonic() < until:
        began = time.monotonic()
        with connected(address) as asking:
            asking.settimeout(30)
            asking.sendall(b"GET /static/style.css HTTP/1.1\r\n" + HOST + b"\r\n")
            assert asking.recv(15) == b"HTTP/1.1 200 OK"
        waits.append(time.monotonic() - began)
        time.sleep(0.05)
    for each in threads:
        each.join()
    return max(waits)


@pytest.mark.parametrize("name", CHUNKS)
def test_a_body_of_tiny_chunks_is_refused_and_keeps_nobody_waiting(served, name):
    head, chunk = CHUNKS[name]
    with connected(served.address) as connection, contextlib.suppress(OSError):
        connection.sendall(head + chunk * 3_000)
        assert connection.recv(20).startswith((b"HTTP/1.1 400", b"HTTP/1.1 404", b"HTTP/1.1 405"))
    assert wait(served.address, lambda: connected(served.address), head + chunk * 250_000) < WAITS


def test_a_body_in_sensible_chunks_is_taken(served):
    person = httpx.Client(base_url=served.address)
    person.post("/begin")
    parts = (b"x" * 300 for _ in range(800))
    answer = person.post("/annotate/describe", content=parts, headers={"content-type": "application/octet-stream"})
    assert answer.status_code == 400 and "piece" not in answer.text


@pytest.fixture(scope="module")
def game(served):
    person = httpx.Client(base_url=served.address)
    person.post("/begin")
    begun = person.post("/play/new", data={"challenge": "wah", "task": "0", "helper": "none"})
    return begun.headers["location"].rpartition("/")[2], person.cookies["hearth"]


def in_game(served, game) -> socket.socket:
    """A socket of a game, open."""
    made = upgraded(served.address, *game)
    made.recv(500)
    return made


@pytest.mark.parametrize("name", FRAMES)
def test_a_flood_of_frames_ends_the_socket_and_keeps_nobody_waiting(served, game, name):
    with in_game(served, game) as connection, contextlib.suppress(ConnectionError):
        connection.sendall(FRAMES[name])
        while connection.recv(65_536):  # until the server ends it
            pass
    assert wait(served.address, lambda: in_game(served, game), FRAMES[name]) < WAITS


def test_a_page_that_sends_as_fast_as_it_may_is_heard(served, game):
    time.sleep(6)  # the session may ask again
    with in_game(served, game) as connection:
        for _ in range(100):
            connection.sendall(frame(9, b"x"))
            time.sleep(0.005)
        connection.settimeout(5)
        came = b""
        while came.count(b"\x8a\x01x") < 100:
            more = connection.recv(65_536)
            assert more, "the server ended it"
            came += more
