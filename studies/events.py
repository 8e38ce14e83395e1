"""The events of a study, one after another: nothing else is kept, and all else follows from them."""

import secrets
from collections.abc import Mapping
from dataclasses import dataclass
from hashlib import blake2b
from pathlib import Path
from typing import Any, Protocol

import orjson

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.files import sync_folder, value_digest, write_bytes
from hearth.storage.input_files import LARGEST_TABLE, read_input

PLACES = "places"
"""The stream of places that people took; every other stream is a person's."""

KINDS = ("joined", "consented", "read", "practised", "did", "answered", "left", "finished")
"""The kinds of events: `joined` in the stream of places, the others in a person's."""


@dataclass(frozen=True, slots=True)
class Event:
    """Something that happened.

    Attributes:
        stream: `PLACES`, or a person's id.
        number: its place in the stream, from 0; one event has it.
        kind: one of `KINDS`.
        at: seconds since 1970; of simulated people, since they joined.
        data: the data of its kind.
    """

    stream: str
    number: int
    kind: str
    at: float
    data: Mapping[str, Any]


class Ledger(Protocol):
    """The storage of events; `study_store` of the server keeps them in a database, `FileLedger` in a file."""

    def streams(self) -> list[str]:
        """Return the streams of people, in the order in which they began."""

    def read(self, stream: str) -> list[Event]:
        """Return the events of a stream, in order."""

    def append(self, event: Event) -> bool:
        """Keep an event, on the disk when it returns; False, and nothing kept, if another has its number."""

    def forget(self, stream: str) -> None:
        """Delete a person's events, and the person's id in the stream of places."""

    def secret(self, name: str) -> str:
        """Return a random text of this study, made when it is first asked for.

        A simulation derives it from its seed.
        """


def redacted(event: Event, stream: str) -> Event:
    """Return an event of the places without a person's id."""
    if event.data.get("person") != stream:
        return event
    return Event(event.stream, event.number, event.kind, event.at, {**event.data, "person": ""})


def salted(salt: str, text: str) -> str:
    """16 hexadecimal digits that stand for a text in tables; nobody without the salt finds out for which."""
    return blake2b(text.encode(), key=salt.encode()[:64], digest_size=8).hexdigest()


class MemoryLedger:
    """Events in memory."""

    def __init__(self, salt: str = "") -> None:
        self.events: dict[str, list[Event]] = {PLACES: []}
        self.salt = salt

    def streams(self) -> list[str]:
        """Return the streams of people."""
        return [each for each in self.events if each != PLACES]

    def read(self, stream: str) -> list[Event]:
        """Return the events of a stream."""
        return list(self.events.get(stream, ()))

    def _next(self, event: Event) -> bool:
        """Return whether an event is the next of its stream."""
        return event.number == len(self.events.get(event.stream, ()))

    def append(self, event: Event) -> bool:
        """Keep an event."""
        if not self._next(event):
            return False
        self.events.setdefault(event.stream, []).append(event)
        return True

    def forget(self, stream: str) -> None:
        """Delete a person's events."""
        self.events.pop(stream, None)
        self.events[PLACES] = [redacted(each, stream) for each in self.events[PLACES]]

    def secret(self, name: str) -> str:
        """Return the salt that it was made with."""
        self.salt = self.salt or secrets.token_hex(16)
        return salted(self.salt, name)


class FileLedger(MemoryLedger):
    """Events in a file of JSON lines, appended one by one; a line that was half written when it stopped is cut off.

    Args:
        path: the file; begun if it is not there.
        header: the contents of its first line; a file with another header is refused.
        salt: of the ids in tables.

    Raises:
        HearthError: BAD_ARGUMENT: the file is of another study; BAD_JSON with the line.
    """

    def __init__(self, path: Path, header: Mapping[str, Any], salt: str = "") -> None:
        super().__init__(salt)
        self.path, self.header = path, header
        first = _line(header)
        if not path.exists():
            path.parent.mkdir(parents=True, exist_ok=True)
            write_bytes(path, first)
        lines = read_input(path, LARGEST_TABLE).splitlines(keepends=True)
        if not lines or lines[0] != first:
            remedy = "name a new folder, or delete this file"
            raise HearthError.of(Code.BAD_ARGUMENT, "these are the events of another study or simulation",
                                 file=str(path), suggestion=remedy)  # fmt: skip
        whole = [each for each in lines[1:] if each.endswith(b"\n")]
        if len(whole) < len(lines) - 1:
            write_bytes(path, b"".join([first, *whole]))
        for number, each in enumerate(whole, 2):
            if not super().append(event_of(each, str(path), number)):
                raise HearthError.of(Code.BAD_JSON, f"line {number} is not the event that comes there", file=str(path))

    def append(self, event: Event) -> bool:
        """Keep an event in the file."""
        if not self._next(event):
            return False
        with self.path.open("ab") as file:  # first, so that memory never has an event that the file lacks
            file.write(_line(event_data(event)))
        return super().append(event)

    def forget(self, stream: str) -> None:
        """Delete a person's events; the file is written anew."""
        lines = [event_of(each, str(self.path), 0) for each in read_input(self.path, LARGEST_TABLE).splitlines()[1:]]
        super().forget(stream)
        kept = [redacted(each, stream) for each in lines if each.stream != stream]
        write_bytes(self.path, b"".join([_line(self.header), *(_line(event_data(each)) for each in kept)]))
        sync_folder(self.path.parent)


def event_data(event: Event) -> dict[str, Any]:
    """Return an event as JSON."""
    return {"stream": event.stream, "number": event.number, "kind": event.kind, "at": event.at, "data": event.data}


def event_of(line: bytes, file: str, number: int) -> Event:
    """Return an event of a line.

    Raises:
        HearthError: BAD_JSON: it is not one.
    """
    try:
        given = orjson.loads(line)
        orjson.dumps(given)  # values from a file may be nested too deep to be written
        return Event(str(given["stream"]), int(given["number"]), str(given["kind"]), float(given["at"]), given["data"])
    except (orjson.JSONDecodeError, KeyError, TypeError, ValueError, OverflowError) as error:
        raise HearthError.of(Code.BAD_JSON, f"line {number} is not an event", file=file) from error


def header_of(path: Path) -> dict[str, Any]:
    """Return the first line of a file of events.

    Raises:
        HearthError: MISSING_FILE; BAD_JSON.
    """
    try:
        found = orjson.loads(read_input(path, LARGEST_TABLE).partition(b"\n")[0])
    except orjson.JSONDecodeError as error:
        raise HearthError.of(Code.BAD_JSON, "not a file of events", file=str(path)) from error
    if not isinstance(found, dict) or found.get("format") != FORMAT:
        raise HearthError.of(Code.BAD_JSON, f"not a file of events ({FORMAT})", file=str(path))
    try:
        value_digest(found)
    except HearthError as error:
        raise HearthError.of(Code.BAD_JSON, error.diagnostics[0].message, file=str(path)) from error
    return found


FORMAT = "hearth-study-events-1"


def _line(data: Mapping[str, Any]) -> bytes:
    return orjson.dumps(data) + b"\n"
