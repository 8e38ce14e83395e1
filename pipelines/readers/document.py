"""JSON documents: recognised by their first line, and read whole unless they are too large."""

import re
from typing import Any

import orjson

from hearth.pipelines.readers.item import LARGEST_FILE, opened
from hearth.schemas.failures import Code
from hearth.storage.archives import Place, size_of
from hearth.storage.rejects import Reject

_LOOKS_JSON = re.compile(r"""\s*(?:\{\s*["}]|\[\s*(?:["\{\[\]\d-]|$))""")


def looks_like_json(line: str) -> bool:
    """Whether a text's first line begins a JSON object or list; `[Walk] <bed> (1)` begins neither."""
    return _LOOKS_JSON.match(line) is not None


def document(path: Place, place: str) -> Any | Reject:
    """The JSON value of a whole file, or a reject if it can't be read."""
    size = size_of(path)
    if size > LARGEST_FILE:
        message = f"a JSON document of {size:,} bytes, at most {LARGEST_FILE:,} are read"
        suggestion = "write it as JSON Lines, one record a line"
        return Reject.of(Code.FILE_TOO_LARGE, message, file=place, suggestion=suggestion)
    with opened(path) as (file, encoding):
        data = file.read(LARGEST_FILE + 1)
    if len(data) > LARGEST_FILE:
        return Reject.of(Code.FILE_TOO_LARGE, f"it unpacks to more than {LARGEST_FILE:,} bytes", file=place)
    return parsed(data if encoding == "utf-8" else data.decode(encoding, "replace").encode(), place, 1)


def parsed(data: bytes | str, place: str, line: int) -> Any | Reject:
    """A JSON value; `line` is the number of its first line."""
    try:
        return orjson.loads(data)
    except (orjson.JSONDecodeError, RecursionError) as error:
        at = line + getattr(error, "lineno", 1) - 1
        message = f"not JSON: {error}"
        return Reject.of(Code.BAD_JSON, message, file=place, line=at, suggestion="save it as JSON in UTF-8")
