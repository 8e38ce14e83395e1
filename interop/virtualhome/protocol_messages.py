"""Requests and replies of VirtualHome's Unity simulator: `{id, action, intParams, stringParams}` and back."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import orjson

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

MOST_REQUEST = 16 << 20
"""Bytes of a request: a graph of 20,000 nodes."""

MOST_PARAMETERS = 2_000
"""Numbers or texts of a request: lines of a script."""

MOST_ID = 200
"""Characters of a request's id that are repeated in its reply."""


@dataclass(frozen=True, slots=True)
class Request:
    """One request of a client.

    Attributes:
        id: repeated in the reply.
        action: the name of the action.
        numbers: `intParams`.
        texts: `stringParams`.
    """

    id: str
    action: str
    numbers: tuple[int, ...] = ()
    texts: tuple[str, ...] = ()

    def settings(self) -> dict[str, Any]:
        """Return the JSON object in the first text; empty where there is none.

        Raises:
            HearthError: BAD_JSON: it is no JSON object.
        """
        return json_of(self.texts[0], "stringParams[0]") if self.texts else {}


@dataclass(frozen=True, slots=True)
class Reply:
    """One reply.

    Attributes:
        success: whether the action was done.
        message: text, often JSON.
        value: a number, where the action has one.
        pictures: base64 PNG files, where the action has some.
    """

    success: bool
    message: str = ""
    value: int = 0
    pictures: tuple[str, ...] | None = None

    def as_json(self, request_id: str) -> dict[str, Any]:
        """Return the reply as the protocol writes it."""
        found: dict[str, Any] = {"id": request_id, "success": self.success, "message": self.message}
        found["value"] = self.value
        found["message_list"] = list(self.pictures or ())
        return found


def refusal(error: HearthError) -> Reply:
    """Return the reply to a request that is refused: why, the remedy, and the code at the end."""
    return Reply(False, in_words(error))


def in_words(error: HearthError) -> str:
    """Return the first faults of an error as one line."""
    said = [
        f"{fault.message}{'; ' + fault.suggestion if fault.suggestion else ''} ({fault.code})"
        for fault in error.diagnostics[:3]
    ]
    more = len(error.diagnostics) - len(said)
    return ". ".join(said) + (f". {more} more faults" if more else "")


def read_request(body: bytes) -> Request:
    """Return the request that a body holds.

    Raises:
        HearthError: BAD_JSON: it is no JSON object; BAD_ARGUMENT: one of its fields is of another kind.
    """
    data = json_of(body, "the request")
    number, action = data.get("id", ""), data.get("action")
    if not isinstance(number, (str, int, float)) or isinstance(number, bool):
        raise wrong("id", "a text or a number", number)
    if not isinstance(action, str) or not action:
        raise wrong("action", "the name of an action", action)
    numbers = _listed(data.get("intParams"), "intParams")
    texts = _listed(data.get("stringParams"), "stringParams")
    for value in numbers:
        if type(value) is not int or abs(value) > 1 << 53:
            raise wrong("intParams", "whole numbers", value)
    for value in texts:
        if not isinstance(value, str):
            raise wrong("stringParams", "texts", value)
    return Request(str(number)[:MOST_ID], action[:100], tuple(numbers), tuple(texts))


def json_of(text: str | bytes, place: str) -> dict[str, Any]:
    """Return the JSON object that a text holds.

    Raises:
        HearthError: BAD_JSON.
    """
    try:
        found = orjson.loads(text)
    except (orjson.JSONDecodeError, UnicodeEncodeError, RecursionError):
        found = None
    if not isinstance(found, dict):
        raise HearthError.of(Code.BAD_JSON, f"{place} is not a JSON object")
    return found


def wrong(field: str, expected: str, found: object) -> HearthError:
    """Return the refusal of a field of a wrong kind; the value is repeated in part."""
    value = "nothing" if found is None else f"{found!r:.60}"
    return HearthError.of(Code.BAD_ARGUMENT, f"`{field}` takes {expected}, not {value}")


def number(settings: Mapping[str, Any], name: str, default: float, low: float, high: float) -> float:
    """Return a number of some settings, within limits.

    Raises:
        HearthError: BAD_ARGUMENT.
    """
    value = settings.get(name, default)
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not low <= value <= high:
        raise wrong(name, f"a number from {low:g} to {high:g}", value)
    return value


def flag(settings: Mapping[str, Any], name: str, default: bool = False) -> bool:
    """Return a switch of some settings.

    Raises:
        HearthError: BAD_ARGUMENT.
    """
    value = settings.get(name, default)
    if not isinstance(value, bool):
        raise wrong(name, "true or false", value)
    return value


def words(settings: Mapping[str, Any], name: str, default: Sequence[str]) -> tuple[str, ...]:
    """Return a list of words of some settings.

    Raises:
        HearthError: BAD_ARGUMENT.
    """
    value = settings.get(name, default)
    if not isinstance(value, (list, tuple)) or len(value) > 20 or not all(isinstance(each, str) for each in value):
        raise wrong(name, "a list of at most 20 words", value)
    return tuple(value)


def point(settings: Mapping[str, Any], name: str) -> tuple[float, float, float]:
    """Return a place or an angle of some settings: `{x, y, z}` within 10,000.

    Raises:
        HearthError: BAD_ARGUMENT.
    """
    value = settings.get(name)
    if not isinstance(value, dict):
        raise wrong(name, "{x, y, z}", value)
    x, y, z = (float(number(value, axis, 0.0, -10_000, 10_000)) for axis in "xyz")
    return x, y, z


def _listed(value: object, name: str) -> list[Any]:
    if value is None:
        return []
    if not isinstance(value, list) or len(value) > MOST_PARAMETERS:
        raise wrong(name, f"a list of at most {MOST_PARAMETERS:,}", value)
    return value
