"""A chat server for tests of adapters: it answers with commands in turn, one for each message of the user."""

from __future__ import annotations

import json
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

MILK = ("Walk kitchen", "Walk fridge", "Open fridge", "Grab milk 142")
"""Commands that reach `HOLDS(agent, milk)` in maple from the start of seed 4."""


def whole(text: str) -> bytes:
    """Return an answer in one piece."""
    choice = {"index": 0, "message": {"role": "assistant", "content": text}, "finish_reason": "stop"}
    usage = {"prompt_tokens": 1, "completion_tokens": 1, "total_tokens": 2}
    facts = {"id": "answer", "object": "chat.completion", "created": 0, "model": "tiny"}
    return json.dumps({**facts, "choices": [choice], "usage": usage}).encode()


def streamed(text: str) -> bytes:
    """Return an answer as events, for clients that ask for a stream."""
    facts = {"id": "answer", "object": "chat.completion.chunk", "created": 0, "model": "tiny"}
    usage = {"prompt_tokens": 1, "completion_tokens": 1, "total_tokens": 2}
    parts = [
        {**facts, "choices": [{"index": 0, "delta": {"role": "assistant", "content": text}, "finish_reason": None}]},
        {**facts, "choices": [{"index": 0, "delta": {}, "finish_reason": "stop"}]},
        {**facts, "choices": [], "usage": usage},
    ]
    return "".join(f"data: {json.dumps(part)}\n\n" for part in parts).encode() + b"data: [DONE]\n\n"


@contextmanager
def endpoint(commands: Sequence[str] = MILK) -> Iterator[str]:
    """Give the address of a server that speaks the chat protocol; the last command is repeated."""

    class Handler(BaseHTTPRequestHandler):
        def do_POST(self) -> None:
            asked = json.loads(self.rfile.read(int(self.headers["content-length"])))
            turn = sum(message["role"] == "assistant" for message in asked["messages"])
            text = commands[min(turn, len(commands) - 1)]
            kind, body = (
                ("text/event-stream", streamed(text)) if asked.get("stream") else ("application/json", whole(text))
            )
            self.send_response(200)
            self.send_header("Content-Type", kind)
            self.send_header("Content-Length", str(len(body)))
            self.end_headers()
            self.wfile.write(body)

        def log_message(self, *given: object) -> None:
            """Write nothing."""

    server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    try:
        yield f"http://127.0.0.1:{server.server_port}/v1"
    finally:
        server.shutdown()
