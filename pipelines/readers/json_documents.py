"""JSON documents: recognised by their first line, and read whole unless they are too large."""

import json
import re
from contextlib import suppress
from typing import Any

import orjson

from hearth.pipelines.readers.reader_items import LARGEST_FILE, opened
from hearth.pipelines.readers.relaxed_json import strict
from hearth.pipelines.readers.texts_with_positions import Located, Pairs
from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.failures import Code
from hearth.storage.archives import Place, size_of
from hearth.storage.rejects import Reject

_LOOKS_JSON = re.compile(r"""\s*(?:\{\s*(?:["}]|$)|\[\s*(?:["\{\[\]\d-]|$))""")


def looks_like_json(line: str) -> bool:
    """Return whether a text's first line begins a JSON object or list; `[Walk] <bed> (1)` begins neither."""
    return _LOOKS_JSON.match(line) is not None


def document(path: Place, place: str) -> Any | Reject:
    """Return the JSON value of a whole file, or a reject if it can't be read."""
    data = _data(path, place)
    return data if isinstance(data, Reject) else parsed(data, place, 1)


def located_document(path: Place, place: str) -> Located | Reject:
    """Return the JSON value of a whole file with its places, or a reject if it can't be read."""
    data = _data(path, place)
    return data if isinstance(data, Reject) else located(data, place, 1)


def _data(path: Place, place: str) -> bytes | Reject:
    size = size_of(path)
    if size > LARGEST_FILE:
        message = f"a JSON document of {size:,} bytes, at most {LARGEST_FILE:,} are read"
        suggestion = "write it as JSON Lines, one record a line"
        return Reject.of(Code.FILE_TOO_LARGE, message, file=place, suggestion=suggestion)
    with opened(path) as (file, encoding):
        data = file.read(LARGEST_FILE + 1)
    if len(data) > LARGEST_FILE:
        return Reject.of(Code.FILE_TOO_LARGE, f"it unpacks to more than {LARGEST_FILE:,} bytes", file=place)
    return data if encoding == "utf-8" else data.decode(encoding, "replace").encode()


def located(data: bytes | str, place: str, line: int, column: int = 1) -> Located | Reject:
    """Return a JSON value whose texts know their places, with repeated keys; it begins at this line and column."""
    value, data = _loaded(data, place, line, column)
    if isinstance(value, Reject):
        return value
    text = data if isinstance(data, str) else data.decode()
    found = Located(value, text, line, column)
    if found.whole:
        return found
    try:
        return Located(json.loads(text, object_pairs_hook=Pairs), text, line, column)
    except (ValueError, RecursionError) as error:
        message = f"an object with repeated keys that can't be read: {error}"
        return Reject.of(Code.BAD_JSON, message, file=place, line=line, suggestion="give each key once")


def parsed(data: bytes | str, place: str, line: int, column: int = 1) -> Any | Reject:
    """Return a JSON value that begins at this line and column.

    Comments and commas after the last entry mean nothing.
    """
    return _loaded(data, place, line, column)[0]


def _loaded(data: bytes | str, place: str, line: int, column: int) -> tuple[Any | Reject, bytes | str]:
    """Return a JSON value, and the strict JSON in which it was found."""
    try:
        return orjson.loads(data), data
    except (orjson.JSONDecodeError, RecursionError) as error:
        text = data if isinstance(data, str) else data.decode("utf-8", "replace")
        plain = strict(text)
        if plain != text:
            with suppress(orjson.JSONDecodeError, RecursionError):
                return orjson.loads(plain), plain
        return _not_json(error, place, line, column), data


def _not_json(error: Exception, place: str, line: int, column: int) -> Reject:
    down, across = getattr(error, "lineno", 1) - 1, getattr(error, "colno", 1)
    across += column - 1 if not down else 0
    message = f"not JSON: {getattr(error, 'msg', error)}"
    remedy = "save it as JSON in UTF-8"
    return Reject((Diagnostic(Code.BAD_JSON, message, place, line + down, across, suggestion=remedy),))
