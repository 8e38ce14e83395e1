"""Pictures in messages, as the chat protocol has them, and their tokens where a server does not count them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

PICTURE_TOKENS = 1_000
"""Tokens of a picture where a server does not count them; servers count 85 to 800 for those of an agent's eyes."""

IMAGE = "image_url"
"""The type of a part that is a picture."""


def pictured(text: str, url: str) -> list[dict[str, Any]]:
    """Return the content of a message with a text and a picture, a data URL."""
    return [{"type": "text", "text": text}, {"type": IMAGE, IMAGE: {"url": url, "detail": "low"}}]


def pictures_in(messages: Sequence[Mapping[str, Any]]) -> int:
    """Return how many pictures messages have."""
    return sum(_is_picture(part) for message in messages for part in _parts(message))


def without_pictures(messages: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """Return messages in which pictures are left out, and their texts stay."""
    return [
        {**message, "content": [part for part in _parts(message) if not _is_picture(part)]}
        if _parts(message)
        else dict(message)
        for message in messages
    ]


def _parts(message: Mapping[str, Any]) -> Sequence[Any]:
    content = message.get("content")
    return content if isinstance(content, list) else ()


def _is_picture(part: Any) -> bool:
    return isinstance(part, Mapping) and part.get("type") == IMAGE
