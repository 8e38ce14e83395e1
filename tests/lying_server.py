"""A chat server of our own that answers as a test says, and lies in every way that servers do."""

from __future__ import annotations

import json
import threading
import time
from contextlib import contextmanager, suppress
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer


def reply(text, tokens=(10, 2), **more):
    """The JSON of an honest reply."""
    usage = {"prompt_tokens": tokens[0], "completion_tokens": tokens[1]}
    return {
        "choices": [{"message": {"role": "assistant", "content": text}, "finish_reason": "stop", **more}],
        "usage": usage,
    }


class Lying:
    """Script of the server: each request takes the next deed; the last deed answers all later requests.

    A deed is a text (an honest reply), a mapping (JSON), bytes (a body), a number (a status), a pair of a status and
    headers, or a function of the request's JSON that returns one of these, or writes by itself (`raw`).
    """

    def __init__(self, *deeds):
        self.deeds, self.asked, self.heads = list(deeds), [], []
        self.lock = threading.Lock()

    def next(self, body, heads):
        with self.lock:
            self.asked.append(body)
            self.heads.append(heads)
            return self.deeds.pop(0) if len(self.deeds) > 1 else self.deeds[0]


class raw:
    """A deed that writes to the connection itself."""

    def __init__(self, write):
        self.write = write


def half(handler):
    """A reply that ends in the middle: its head promises more."""
    handler.send_response(200)
    handler.send_header("content-length", "5000")
    handler.end_headers()
    handler.wfile.write(json.dumps(reply("Walk fridge 1")).encode()[:40])
    handler.close_connection = True


def dripping(handler):
    """A reply that comes a byte at a time and never ends."""
    handler.send_response(200)
    handler.end_headers()
    for _ in range(600):
        handler.wfile.write(b" ")
        handler.wfile.flush()
        time.sleep(0.02)


def silent(handler):
    """No reply for a while."""
    time.sleep(1.0)


def gone(handler):
    """The connection is closed without a word."""
    handler.close_connection = True
    handler.connection.close()


def endless(handler):
    """A reply that repeats itself until the client has enough."""
    handler.send_response(200)
    handler.end_headers()
    for _ in range(200):
        handler.wfile.write(b"again and again " * 4096)


@contextmanager
def serving(*deeds):
    """Yield the address of a server and what it was asked."""
    lying = Lying(*deeds)

    class Handler(BaseHTTPRequestHandler):
        protocol_version = "HTTP/1.1"

        def do_POST(self):
            body = json.loads(self.rfile.read(int(self.headers["content-length"])))
            deed = lying.next(body, dict(self.headers))
            deed = deed(body) if callable(deed) and not isinstance(deed, raw) else deed
            with suppress(OSError):
                self.do(deed)

        def do(self, deed):
            if isinstance(deed, raw):
                self.close_connection = True
                deed.write(self)
                return
            status, heads, data = 200, {}, deed
            if isinstance(deed, int):
                status, data = deed, {"error": {"message": "no"}}
            elif isinstance(deed, tuple):
                status, heads = deed[:2]
                data = deed[2] if len(deed) > 2 else {"error": {"message": "no"}}
            if isinstance(data, str):
                data = reply(data)
            data = data if isinstance(data, bytes) else json.dumps(data).encode()
            self.send_response(status)
            for name, value in {"content-type": "application/json", **heads, "content-length": len(data)}.items():
                self.send_header(name, str(value))
            self.end_headers()
            self.wfile.write(data)

        do_GET = do_POST

        def log_message(self, *arguments):
            pass

    server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    server.daemon_threads = True
    thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.01}, daemon=True)
    thread.start()
    try:
        yield f"http://127.0.0.1:{server.server_address[1]}/v1", lying
    finally:
        server.shutdown()
        server.server_close()
