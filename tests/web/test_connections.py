"""Connections of strangers: half-open ones end, the log stays short, one way to say how long a body is."""

from __future__ import annotations

import contextlib
import errno
import logging
import re
import socket
import time
from urllib.parse import urlsplit

import httpx2 as httpx
import pytest

from hearth.web.log_limits import FewOfAKind

WITHIN = 13.0
"""Seconds after which a connection that asks nothing has ended: ten, and some for a busy machine."""

HOST = b"Host: 127.0.0.1\r\n"


def connected(address: str) -> socket.socket:
    """A connection to a server."""
    return socket.create_connection(("127.0.0.1", urlsplit(address).port), timeout=5)


def ended(connection: socket.socket, before: float, drip: bytes = b"", reads: bool = True) -> bool:
    """Return whether the server ends a connection before a time, though bytes go on to drip in."""
    connection.settimeout(0.5)
    while time.monotonic() < before:
        try:
            if drip:
                connection.sendall(drip)
                time.sleep(0.5)
            if reads and connection.recv(65_536) == b"":
                return True
        except TimeoutError:
            continue
        except OSError:
            return True
    return False


def upgraded(address: str, game: str, token: str) -> socket.socket:
    """A socket of a game that never says hello."""
    made = connected(address)
    made.sendall(
        f"GET /play/game/{game}/live HTTP/1.1\r\nHost: {urlsplit(address).netloc}\r\nConnection: Upgrade\r\n"
        f"Upgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: {'A' * 22}==\r\n"
        f"Cookie: hearth={token}\r\n\r\n".encode()
    )
    return made


FORM = b"Content-Type: application/x-www-form-urlencoded\r\n"

HALF_OPEN = {
    "nothing": (b"", b""),
    "a header that drips": (b"GET / HTTP/1.1\r\n" + HOST, b"x"),
    "a second request that drips": (b"GET /static/style.css HTTP/1.1\r\n" + HOST + b"\r\nGET /", b"x"),
    "a body that drips": (b"POST /begin HTTP/1.1\r\n" + HOST + FORM + b"Content-Length: 9999\r\n\r\n", b"x"),
    "a body that nobody reads": (b"POST /static/style.css HTTP/1.1\r\n" + HOST + b"Content-Length: 9999\r\n\r\n", b"x"),
    "a chunk that drips": (b"POST /begin HTTP/1.1\r\n" + HOST + FORM + b"Transfer-Encoding: chunked\r\n\r\n9\r\n", b""),
}


@pytest.mark.parametrize("first", HALF_OPEN)
def test_a_half_open_connection_ends_in_ten_seconds(served, first):
    begins, drip = HALF_OPEN[first]
    connection = connected(served.address)
    connection.sendall(begins)
    assert ended(connection, time.monotonic() + WITHIN, drip)


def test_a_socket_that_says_nothing_ends_in_ten_seconds(served):
    person = httpx.Client(base_url=served.address)
    person.post("/begin")
    begun = person.post("/play/new", data={"challenge": "wah", "task": "0", "helper": "none"})
    game = begun.headers["location"].rpartition("/")[2]
    connection = upgraded(served.address, game, person.cookies["hearth"])
    assert ended(connection, time.monotonic() + WITHIN)


def test_who_asks_and_does_not_read_is_let_go(served):
    connection = connected(served.address)
    connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    asked = (b"GET /static/style.css HTTP/1.1\r\n" + HOST + b"\r\n") * 20_000
    connection.settimeout(1)
    with contextlib.suppress(TimeoutError):
        connection.sendall(asked)
    until = time.monotonic() + 2 * WITHIN
    while time.monotonic() < until:
        time.sleep(0.5)
        try:
            connection.send(b"\r")
        except TimeoutError:
            continue
        except OSError:
            return
    pytest.fail("it is still there")


def test_the_log_does_not_grow_at_the_limit_of_open_files(serving):
    server = serving(limits="ulimit -n 80")
    held = []
    for _ in range(250):
        with contextlib.suppress(OSError):
            held.append(socket.create_connection(("127.0.0.1", urlsplit(server.address).port), timeout=0.2))
    time.sleep(7)
    assert len(server.log.read_text().splitlines()) < 60 and server.log.read_text().count("out of system resource") < 3
    for each in held:
        each.close()
    assert answers(server.address)


def test_a_text_that_is_no_utf8_and_a_lack_of_files_are_a_line_each():
    shown = []
    handler, logger = logging.Handler(), logging.Logger("strangers")
    handler.emit = lambda record: shown.append(handler.format(record))
    logger.addHandler(handler)
    logger.addFilter(FewOfAKind())
    for error in (UnicodeDecodeError("utf-8", b"\xff", 0, 1, "x"), OSError(errno.EMFILE, "many"), KeyError("ours")):
        try:
            raise error
        except Exception:
            logger.exception("it happened\nmore")
    assert shown[:2] == ["it happened (UnicodeDecodeError)", "it happened (OSError)"]
    assert "Traceback" in shown[2], "a fault of ours says where"


def answers(address: str) -> bool:
    """Return whether a server answers soon."""
    for _ in range(20):
        with contextlib.suppress(httpx.HTTPError):
            return httpx.get(f"{address}/static/style.css", timeout=5).status_code == 200
        time.sleep(0.5)
    return False


def test_what_is_not_http_does_not_fill_the_log(serving):
    server = serving(limits="true")
    for _ in range(300):
        connection = connected(server.address)
        connection.sendall(b"\x00\x01\r\n\r\n")
        connection.recv(100)
        connection.close()
    for _ in range(100):
        httpx.get(server.address, headers={"Connection": "Upgrade", "Upgrade": "nothing"})
    assert len(server.log.read_text().splitlines()) < 60


def asked(address: str, request: bytes) -> int:
    """The status of the answer to bytes."""
    connection = connected(address)
    connection.sendall(request)
    found = re.match(rb"HTTP/1.1 (\d+)", connection.recv(65_536))
    return int(found[1]) if found else 0


BOTH = (
    b"Content-Length: 3\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n",
    b"Transfer-Encoding: chunked\r\nContent-Length: 5\r\n\r\n0\r\n\r\n",
    b"Content-Length: 3\r\nContent-Length: 3\r\n\r\na=1",
    b"Content-Length: 3, 3\r\n\r\na=1",
    b"Content-Length: 3\r\nContent-Length: 4\r\n\r\na=1",
    b"Transfer-Encoding: identity\r\nContent-Length: 3\r\n\r\na=1",
)


@pytest.mark.parametrize("length", BOTH)
def test_there_is_one_way_to_say_how_long_a_body_is(served, length):
    assert asked(served.address, b"POST /begin HTTP/1.1\r\n" + HOST + FORM + length) == 400
    assert asked(served.address, b"POST /begin HTTP/1.1\r\n" + HOST + FORM + b"Content-Length: 3\r\n\r\na=1") == 303


def test_chunks_of_old_http_are_refused(served):
    request = b"POST /begin HTTP/1.0\r\n" + HOST + FORM + b"Transfer-Encoding: chunked\r\n\r\n0\r\n\r\n"
    assert asked(served.address, request) == 400


LOOSE = (
    b"POST /begin HTTP/1.1\r\n" + HOST + FORM + b"Transfer-Encoding:\r\n chunked\r\n\r\n0\r\n\r\n",
    b"POST /begin HTTP/1.1\r\n" + HOST + FORM + b"Content-Length:\r\n\t3\r\n\r\na=1",
    b"GET / HTTP/1.1\r\n" + HOST + b"X: a\r\n b\r\n\r\n",
    b"GET / HTTP/1.1\n" + HOST + b"\r\n",
    b"GET / HTTP/1.1\r\nHost: 127.0.0.1\n\r\n",
    b"GET / HTTP/1.1\r\nHost: 127.0.0.1\n\n",
    b"GET / HTTP/1.1\r\n" + HOST + b"X: a\rY: b\r\n\r\n",
    b"GET /static/style.css HTTP/1.1\r\n" + HOST + b"\r\n" + b"GET / HTTP/1.1\n" + HOST + b"\r\n",
)


@pytest.mark.parametrize("request_", LOOSE)
def test_a_head_that_others_read_otherwise_is_refused(served, request_):
    connection = connected(served.address)
    connection.sendall(request_)
    answer = b""
    while piece := connection.recv(65_536):
        answer += piece
    assert b"HTTP/1.1 400" in answer and b"HTTP/1.1 303" not in answer


def test_a_head_that_comes_in_two_pieces_is_read_as_one(served):
    for last, status in ((b"\r\n\r\n", b"200"), (b"\r\n y\r\n\r\n", b"400")):
        connection = connected(served.address)
        connection.sendall(b"GET /static/style.css HTTP/1.1\r\n" + HOST + b"X: a")
        time.sleep(0.2)
        connection.sendall(last)
        assert connection.recv(65_536).startswith(b"HTTP/1.1 " + status)


FORGED = ("X-Forwarded-For", "X-Real-IP", "Forwarded")


@pytest.mark.parametrize("header", FORGED)
def test_limits_are_by_the_address_of_the_socket(serving, header):
    server = serving()
    found = [httpx.post(f"{server.address}/begin", headers={header: f"10.0.{n}.1"}).status_code for n in range(60)]
    assert 429 in found


def test_limits_are_by_what_a_named_proxy_says(serving):
    server = serving("--proxy", "127.0.0.1")
    found = [httpx.post(f"{server.address}/begin", headers={FORGED[0]: f"10.0.{n}.1"}).status_code for n in range(60)]
    assert set(found) == {303}
    forged = [f"10.0.{n}.1, 10.9.9.9" for n in range(60)]
    found = [httpx.post(f"{server.address}/begin", headers={FORGED[0]: each}).status_code for each in forged]
    assert 429 in found, "what the proxy itself has seen counts, not what came to it"


@pytest.mark.parametrize("header", ["X-Forwarded-Proto", "X-Forwarded-Host"])
def test_a_header_does_not_change_the_link_to_come_back(served, header):
    person = httpx.Client(base_url=served.address)
    person.post("/begin")
    assert f"{served.address}/come" in person.get("/mine", headers={header: "evil.example"}).text


def test_who_goes_in_the_middle_of_a_body_leaves_nothing_in_the_log(serving):
    server = serving(limits="true")
    connection = connected(server.address)
    connection.sendall(b"POST /begin HTTP/1.1\r\n" + HOST + FORM + b"Content-Length: 99\r\n\r\na=")
    time.sleep(0.5)
    connection.close()
    time.sleep(1)
    assert answers(server.address) and "Traceback" not in server.log.read_text()
