"""Replies of chat servers, read with distrust: every part may lack, be of another type, or be cut."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

CHARACTERS = 4
"""Characters of a token, about, where a server does not count."""

MOST_TOKENS = 10**9
"""The largest number of tokens that is believed."""


@dataclass(frozen=True, slots=True)
class Reply:
    """The reply of a language model.

    Attributes:
        text: what it wrote.
        tokens_in, tokens_out: of the prompt and of the reply.
        counted: whether the server counted them; they are estimates otherwise.
        cut: whether the reply ended because it was too long.
        seconds: from the request to the reply.
        tries: requests that were needed.
        kept: whether the reply came from the cache.
    """

    text: str
    tokens_in: int = 0
    tokens_out: int = 0
    counted: bool = False
    cut: bool = False
    seconds: float = 0.0
    tries: int = 1
    kept: bool = False


def sums(replies: Sequence[Reply]) -> dict[str, Any]:
    """Return the sums of replies, as results have them."""
    return {
        "cut": sum(reply.cut for reply in replies),
        "tokens_in": sum(reply.tokens_in for reply in replies),
        "tokens_out": sum(reply.tokens_out for reply in replies),
        "seconds": round(sum(reply.seconds for reply in replies), 3),
        "tries": sum(reply.tries for reply in replies),
        "kept": sum(reply.kept for reply in replies),
    }


def read_reply(given: Any, asked: int) -> Reply | None:
    """Return the reply in a server's JSON; None where there is none.

    Args:
        given: the JSON.
        asked: characters of the prompt, for an estimate of its tokens.
    """
    choice = _first(given.get("choices")) if isinstance(given, Mapping) else None
    message = choice.get("message") if choice is not None else None
    if choice is None or not isinstance(message, Mapping):
        return None
    text = _text(message)
    if text is None:
        return None
    usage = given.get("usage")
    asks = (("prompt_tokens", asked), ("completion_tokens", len(text)))
    (one, tokens_in), (other, tokens_out) = (tokens_of(usage, name, size) for name, size in asks)
    if not (one and other):  # of a server that counts one kind alone, neither is believed
        (_, tokens_in), (_, tokens_out) = (tokens_of(None, name, size) for name, size in asks)
    return Reply(text, tokens_in, tokens_out, one and other, cut=choice.get("finish_reason") == "length")


def _first(choices: Any) -> Mapping[str, Any] | None:
    return choices[0] if isinstance(choices, list) and choices and isinstance(choices[0], Mapping) else None


def _text(message: Mapping[str, Any]) -> str | None:
    """Return the text of a message, or its last tool call as JSON; None where it has neither."""
    import orjson

    content = message.get("content")
    if isinstance(content, list):  # parts, as some servers write them
        parts = [part.get("text") for part in content if isinstance(part, Mapping)]
        content = "".join(part for part in parts if isinstance(part, str))
    if isinstance(content, str) and content.strip():
        return well_formed(content)
    calls = message.get("tool_calls")
    if isinstance(calls, list) and calls and isinstance(calls[-1], Mapping):
        return well_formed(orjson.dumps(calls[-1]).decode())
    return content if isinstance(content, str) else None


def well_formed(text: str) -> str:
    """Return a text that can be written as UTF-8: halves of characters are replaced by `?`."""
    return text.encode("utf-8", "replace").decode()


def tokens_of(usage: Any, name: str, characters: int) -> tuple[bool, int]:
    """Return whether a server counted, and its tokens of a kind, or their estimate from characters."""
    found = _count(usage, name)
    return (True, found) if found is not None else (False, -(-characters // CHARACTERS))


def _count(usage: Any, name: str) -> int | None:
    number = usage.get(name) if isinstance(usage, Mapping) else None
    return number if type(number) is int and 0 <= number <= MOST_TOKENS else None
