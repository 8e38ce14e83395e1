"""Messages over a socket: their size, rate, form and order are checked before a room sees them."""

import re
from typing import Any

import orjson

from hearth.schemas.failures import Code
from hearth.web.limits import MOST_MESSAGE, Rate
from hearth.web.web_errors import WebError


class Inbox:
    """Checks the messages of one connection: JSON objects with a `type`, numbered 1, 2, 3, ... in `n`.

    A refused message does not count: the next one has the number that the refused one should have had.

    Args:
        rate: the limit that this connection has.
    """

    def __init__(self, rate: Rate | None = None) -> None:
        self.last = 0
        self._rate = rate or Rate(each_second=60, burst=120)

    def take(self, raw: str | bytes) -> dict[str, Any]:
        """Return the message in the received data.

        Raises:
            WebError: FILE_TOO_LARGE, TOO_FAST, BAD_JSON, BAD_ARGUMENT or OUT_OF_ORDER.
        """
        size = len(raw) if isinstance(raw, bytes) else len(raw.encode("utf-8", "surrogatepass"))
        if size > MOST_MESSAGE:
            raise WebError(Code.FILE_TOO_LARGE, "message", f"at most {MOST_MESSAGE} bytes", f"{size} bytes")
        self._rate.check("", "message")
        message = json_object(raw, "message")
        if not isinstance(message.get("type"), str):
            raise WebError(Code.BAD_ARGUMENT, "type", "the name of a kind of message", _kind(message.get("type")))
        if type(message.get("n")) is not int or message["n"] != self.last + 1:
            raise WebError(Code.OUT_OF_ORDER, "n", str(self.last + 1), repr(message.get("n"))[:40])
        self.last += 1
        return message


_NUL = re.compile(rb"(?<!\\)(?:\\\\)*\\u0000")
"""A NUL character as JSON writes it; databases refuse it."""


def json_object(raw: str | bytes, place: str) -> dict[str, Any]:
    """Return a JSON object of a stranger.

    Raises:
        WebError: BAD_JSON.
    """
    try:
        value = orjson.loads(raw)
    except (orjson.JSONDecodeError, UnicodeError) as error:
        raise WebError(Code.BAD_JSON, place, "a JSON object", str(error)[:80]) from None
    if not isinstance(value, dict):
        raise WebError(Code.BAD_JSON, place, "a JSON object", _kind(value))
    if _NUL.search(raw if isinstance(raw, bytes) else raw.encode()):
        raise WebError(Code.BAD_JSON, place, "texts", "a NUL character")
    return value


def _kind(value: object) -> str:
    return {type(None): "nothing", list: "a list", str: "a text", bool: "a truth value"}.get(type(value), "a number")


def text_field(message: dict[str, Any], name: str, most: int = 1_000) -> str:
    """Return a field that is a text of at most `most` characters.

    Raises:
        WebError: BAD_ARGUMENT.
    """
    value = message.get(name)
    if not isinstance(value, str) or len(value) > most:
        found = f"{len(value)} characters" if isinstance(value, str) else _kind(value)
        raise WebError(Code.BAD_ARGUMENT, name, f"a text of at most {most} characters", found)
    return value


def int_field(message: dict[str, Any], name: str, least: int, most: int) -> int:
    """Return a field that is a whole number from `least` to `most`.

    Raises:
        WebError: BAD_ARGUMENT.
    """
    value = message.get(name)
    if isinstance(value, bool) or not isinstance(value, int) or not least <= value <= most:
        found = repr(value)[:40] if isinstance(value, int | float) else _kind(value)
        raise WebError(Code.BAD_ARGUMENT, name, f"a whole number from {least} to {most}", found)
    return value
