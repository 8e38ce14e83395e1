"""Files with scenes of AI2-THOR: one house, a house a line, or the objects of all rooms of iTHOR."""

from __future__ import annotations

import gzip
import json
import re
import zlib
from collections.abc import Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

import orjson

from hearth.interop.procthor.house import is_house
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.input_files import LARGEST, read_input, read_lines, read_start

MOST_HOUSES = 100_000
"""Houses of a file with one a line."""

FIRST_NUMBERS = {"kitchens": 1, "living_rooms": 201, "bedrooms": 301, "bathrooms": 401}
"""Number of the first floor plan of each kind of room in `ai2thor-object-metadata.json`."""


def has_houses(path: Path) -> bool:
    """Return whether a file is a house, or has one a line."""
    if path.name.endswith((".jsonl", ".jsonl.gz")):
        return True
    start = read_start(path, 1 << 22)
    return b'"floorPolygon"' in start and b'"rooms"' in start


def scene_of(path: Path, name: str = "") -> Any:
    """Return the JSON value of a file, or of one of its scenes: `FloorPlan1`, or a number from 1.

    Raises:
        HearthError: BAD_JSON; UNKNOWN_ID: it has no scene of that name; FILE_TOO_LARGE.
    """
    if path.name.endswith((".jsonl", ".jsonl.gz")):
        return _of_line(path, name or "1")
    data = _json(read_input(path), path)
    scenes = floor_plans(data)
    if not scenes:
        if name:
            raise HearthError.of(Code.UNKNOWN_ID, f"no scene `{name}`: the file has one scene", file=str(path),
                                 suggestion="leave `--scene` out")  # fmt: skip
        return data
    if name not in scenes:
        message = f"there is no scene `{name}`" if name else f"the file has {len(scenes)} scenes"
        raise HearthError.of(Code.UNKNOWN_ID, message, file=str(path),
                             suggestion=f"`--scene`: {', '.join(list(scenes)[:3])}, ...")  # fmt: skip
    return {"objects": scenes[name]}


def floor_plans(data: Any) -> dict[str, Any]:
    """Return the objects of each room of iTHOR by the name of its floor plan; {} for another value."""
    if not isinstance(data, Mapping) or not FIRST_NUMBERS.keys() <= data.keys():
        return {}
    found: dict[str, Any] = {}
    for kind, first in FIRST_NUMBERS.items():
        rooms = data[kind] if isinstance(data[kind], list) else []
        found |= {f"FloorPlan{first + index}": objects for index, objects in enumerate(rooms)}
    return found


def houses(path: Path) -> Iterator[Any]:
    """Yield the houses of a file with one a line, packed or not, with one in memory at a time.

    Raises:
        HearthError: BAD_JSON or BAD_ARCHIVE with the line; FILE_TOO_LARGE.
    """
    for number, line in enumerate(_lines(path), 1):
        if number > MOST_HOUSES:
            raise HearthError.of(Code.FILE_TOO_LARGE, f"more than {MOST_HOUSES:,} houses", file=str(path))
        if line.strip():
            yield _json(line, path)


def _of_line(path: Path, name: str) -> Any:
    if not re.fullmatch(r"[1-9][0-9]{0,5}", name):
        raise HearthError.of(Code.UNKNOWN_ID, f"`{name}` is no number of a house", file=str(path),
                             suggestion="`--scene 1` is the first one")  # fmt: skip
    count = 0
    for count, house in enumerate(houses(path), 1):
        if count == int(name):
            if not is_house(house):
                raise HearthError.of(Code.BAD_GRAPH, f"line {count} is no house", file=str(path),
                                     suggestion="a mapping with `rooms` that have a `floorPolygon`")  # fmt: skip
            return house
    raise HearthError.of(Code.UNKNOWN_ID, f"there is no house {name}: the file has {count}", file=str(path))


def _lines(path: Path) -> Iterator[bytes]:
    if not path.name.endswith(".gz"):
        yield from read_lines(path)
        return
    read_start(path, 1)  # missing files and devices are refused alike
    try:
        with gzip.open(path) as file:
            while line := file.readline(LARGEST + 1):
                if len(line) > LARGEST:
                    raise HearthError.of(Code.FILE_TOO_LARGE, f"a line of more than {LARGEST:,} bytes", file=str(path))
                yield line
    except (OSError, EOFError, zlib.error) as error:
        raise HearthError.of(Code.BAD_ARCHIVE, f"not packed by gzip: {error}", file=str(path)) from error


def _json(text: bytes, path: Path) -> Any:
    try:
        return orjson.loads(text)
    except orjson.JSONDecodeError as error:
        if b"NaN" in text or b"Infinity" in text:  # as Python writes numbers that are none: readers name the entry
            with suppress(ValueError, RecursionError):
                return json.loads(text)
        raise HearthError.of(Code.BAD_JSON, f"not JSON: {error}", file=str(path)) from error
