"""Shared by all readers: items, and text read safely from files and archives."""

import codecs
import io
import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from hashlib import blake2b
from pathlib import Path, PurePath
from typing import Any, BinaryIO

from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.failures import Code
from hearth.schemas.row_types import ConditionRow, QuantityRow, WarningRow
from hearth.schemas.stage_rows import IngestedRow, PartRow, WrittenGroundingRow
from hearth.schemas.text_decoding import LOOKED_AT, encoding_of, western
from hearth.storage.archives import Place, raw
from hearth.storage.rejects import Reject

_HASHED = re.compile(r"[0-9a-f]{16}", re.ASCII)


def worker_hash(worker: str, salt: str) -> str:
    """Return the substitute for a crowd worker's id: 16 hexadecimal digits; an id that is such a hash already stays."""
    if _HASHED.fullmatch(worker):
        return worker
    return blake2b(f"{salt}\0{worker}".encode(), digest_size=8).hexdigest()


LONGEST_LINE = 1_000_000
"""Characters kept of a line while reading; a longer line is refused with its length."""

LARGEST_FILE = 256_000_000
"""Bytes a member of an archive may unpack to."""


@dataclass(frozen=True, slots=True)
class Item:
    """One record as found while scanning, in plain values from which it can be read.

    Attributes:
        record_id: stable, unique within a build.
        reader: the name of its reader.
        place: source and file inside it.
        value: the reader's input, in JSON values.
        version: changes if the content to which `value` refers changes.
        path: the path of the source on this machine, for readers that open it again; not part of any digest.
        line: its first line in the file, from 1; 0 if it is the whole file.
    """

    record_id: str
    reader: str
    place: str
    value: Any
    version: str = ""
    path: str = ""
    line: int = 0


@dataclass(frozen=True, slots=True)
class Source:
    """A file or folder to read: its path, and its label in places, ids and manifests."""

    label: str
    path: Path


def refused(place: str, reject: Reject, record_id: str = "", line: int = 0) -> Item:
    """Return an item that only carries faults; its id is its place unless given."""
    # Rows of rejects, which escape text that is not UTF-8.
    faults = [
        [row[name] for name in ("code", "message", "file", "line", "column", "found", "suggestion")]
        for row in Reject.because(reject.diagnostics, place).rows()
    ]
    return Item(record_id or (f"{place}:{line}" if line else place), "refused", place, faults, line=line)


def record(
    item: Item,
    kind: str,
    title: str,
    description: str,
    *,
    origin: str = "",
    place: str = "",
    description_id: str = "",
    scene: str | None = None,
    worker: str | None = None,
    platform: str | None = None,
    style: str | None = None,
    rooms: list[QuantityRow] | None = None,
    props: list[QuantityRow] | None = None,
    text: str | None = None,
    line: int | None = None,
    groundings: list[WrittenGroundingRow] | None = None,
    conditions: list[ConditionRow] | None = None,
    keep: list[bool] | None = None,
    parts: list[PartRow] | None = None,
    places: list[list[int]] | None = None,
    warnings: list[WarningRow] | None = None,
) -> IngestedRow:
    """Return the row of an item; id and, unless given, origin, place and description id are those of the item."""
    return {
        "kind": kind,
        "program_id": item.record_id,
        "origin": origin or item.reader,
        "source": "",
        "place": place or item.place,
        "description_id": description_id or item.record_id,
        "title": title,
        "description": description,
        "scene": scene,
        "worker": worker,
        "platform": platform,
        "style": style,
        "rooms": rooms,
        "props": props,
        "text": text,
        "line": line,
        "groundings": groundings,
        "conditions": conditions,
        "keep": keep,
        "parts": parts,
        "places": places,
        "warnings": warnings or None,
    }


def read_refused(item: Item) -> Reject:
    """Return the reject of an item made by `refused`."""
    return Reject(
        tuple(
            Diagnostic(Code[code], message, file, line, column, len(found), found, suggestion)
            for code, message, file, line, column, found, suggestion in item.value
        )
    )


@contextmanager
def opened(path: Place) -> Iterator[tuple[BinaryIO, str]]:
    """Yield a file's bytes, unpacked, after its byte-order mark, and its encoding: UTF-8, or UTF-16.

    Raises:
        DamagedError: while reading, if a packed file is broken or unpacks to far too much.
    """
    with raw(path) as file:
        encoding, skip = encoding_of(file.peek(LOOKED_AT)[:LOOKED_AT])  # type: ignore[attr-defined]
        file.read(skip)
        yield file, encoding


def suffixless(name: str) -> str:
    """Return a file's name without its suffixes: `home.json.gz` is `home`."""
    return name.partition(".")[0] or name


def home_of(place: str) -> str:
    """Return the name of the home whose graph a file holds: `TrimmedTestScene1_graph.json` is `TrimmedTestScene1`."""
    return suffixless(PurePath(place).name).removesuffix("_graph")


def lines(path: Place) -> Iterator[tuple[str, int]]:
    """Yield each line of a text without its end, and its length; text beyond `LONGEST_LINE` is dropped.

    A line that is not UTF-8 is read as Windows-1252 if it is that; other bytes that are not text become lone
    surrogates, which `fault_of` finds; other lines are not affected.
    """
    with opened(path) as (file, encoding):
        text = io.TextIOWrapper(file, encoding, errors="surrogateescape" if encoding == "utf-8" else "replace")
        while piece := text.readline(LONGEST_LINE + 1):
            length = len(piece)
            kept, ended = piece, piece.endswith("\n")
            while not ended and (more := text.readline(LONGEST_LINE)):
                length += len(more)
                ended = more.endswith("\n")
            yield western(kept.rstrip("\n")[:LONGEST_LINE]), length - ended


_PIECE = 1 << 18


def pieces(path: Place) -> Iterator[str]:
    """Yield a text as `lines` decodes it, line ends as `\n`, a quarter of a megabyte at a time."""
    with opened(path) as (file, encoding):
        decode = codecs.getincrementaldecoder(encoding)("surrogateescape" if encoding == "utf-8" else "replace")
        decoder = io.IncrementalNewlineDecoder(decode, translate=True)
        while data := file.read1(_PIECE):  # type: ignore[attr-defined]
            yield decoder.decode(data)
        yield decoder.decode(b"", final=True)


_NOT_TEXT = re.compile(r"[\x00\ud800-\udfff]")


def fault_of(text: str, place: str, line: int) -> Diagnostic | None:
    """Return the fault of a piece of a file that is not text, or None; `line` is the number of its first line."""
    if text.isascii() and "\x00" not in text:
        return None
    bad = _NOT_TEXT.search(text)
    if bad is None:
        return None
    at = line + text.count("\n", 0, bad.start())
    column = bad.start() - text.rfind("\n", 0, bad.start())
    message = "a NUL character" if bad[0] == "\x00" else "bytes that are neither UTF-8 nor Windows-1252 (Latin-1) text"
    return Diagnostic(Code.NOT_TEXT, message, place, at, column, 1, suggestion="save the file as UTF-8 text")
