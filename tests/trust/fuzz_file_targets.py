"""Readers of what strangers give beside corpora, datasets and stores: more targets of `guided_fuzz.py`."""

from __future__ import annotations

import contextlib
import json
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

One = Callable[[bytes], Any]
"""Reads one input."""


class Room(NamedTuple):
    """A reader: what its input may look like, and what reads it in a folder of its own."""

    example: Callable[[], bytes]
    reader: Callable[[Path], One]


def _by_file(name: str, read: Callable[[Path], Any]) -> Callable[[Path], One]:
    def reader(scratch: Path) -> One:
        def one(data: bytes) -> Any:
            path = scratch / name
            path.write_bytes(data)
            return read(path)

        return one

    return reader


def _signed_results(path: Path) -> None:
    """Give a file of results with one episode the digest of what it holds, where that can be worked out."""
    from attacks_on_challenges import _resigned

    with contextlib.suppress(ValueError, RecursionError, TypeError, AttributeError):
        first, second = map(json.loads, path.read_bytes().splitlines())
        path.write_text("".join(f"{json.dumps(each)}\n" for each in _resigned(first, second)), "utf-8")


def _sketches() -> bytes:
    from attacks_on_corpora import SKETCHES

    return json.dumps(SKETCHES).encode()


def _sketch_model() -> bytes:
    from attacks_on_corpora import sketch_model

    return json.dumps(sketch_model()).encode()


def _grammar() -> bytes:
    from attacks_on_corpora import GRAMMAR

    return GRAMMAR.encode()


def _beside_corpora(name: str) -> Callable[[Path], Any]:
    """A reader of `attacks_on_corpora` by its name."""

    def read(path: Path) -> Any:
        import attacks_on_corpora

        return getattr(attacks_on_corpora, name)(path)

    return read


def _beliefs() -> bytes:
    from attacks_on_beliefs import watched

    return "".join(f"{json.dumps(each)}\n" for each in watched()).encode()


def _believed(path: Path) -> Any:
    from attacks_on_beliefs import believed

    _signed_results(path)
    return believed(path)


def _dataset(scratch: Path) -> Path:
    from hearth.pipelines.build import build

    source = scratch / "sleep.txt"
    source.write_text("Sleep\nGo to bed.\n\n\n[Walk] <bed> (1)\n[Lie] <bed> (1)\n[Sleep]\n")
    build([str(source)], str(scratch / "out"), homes=("maple",), pictures=0)
    return scratch / "out/publish"


def _manifest() -> bytes:
    with TemporaryDirectory() as folder:
        return (_dataset(Path(folder)) / "manifest.json").read_bytes()


def _manifests(scratch: Path) -> One:
    """A manifest of a dataset."""
    from attacks_on_datasets import manifested

    folder = _dataset(scratch)

    def one(data: bytes) -> Any:
        (folder / "manifest.json").write_bytes(data)
        return manifested(folder)

    return one


def _events() -> bytes:
    from attacks_on_stores import events

    return events()


def _collected(scratch: Path) -> One:
    from attacks_on_stores import reported

    return lambda data: reported(scratch, data)


def _drafts(scratch: Path) -> One:
    """A program as the server's store has it."""
    from hearth.web.annotate.program_draft import stored

    def one(data: bytes) -> Any:
        draft = stored(data.decode("utf-8", "replace"))
        return draft.lines(), draft.things()

    return one


_DRAFT = b'{"rooms": {"bedroom": 1}, "props": {"bed": 1}, "steps": [{"action": "Lie", "things": [["bed", 1]]}]}'
_RATINGS = b"program_id,rating (1 complete)\na,1\nb,3\n"

FILES: dict[str, Room] = {
    "sketches": Room(_sketches, _by_file("sketches.json", _beside_corpora("judged"))),
    "sketch-model": Room(_sketch_model, _by_file("model.json", _beside_corpora("asked"))),
    "grammar": Room(_grammar, _by_file("grammar.yaml", _beside_corpora("synthesized"))),
    "ratings": Room(lambda: _RATINGS, _by_file("ratings.csv", _beside_corpora("rated"))),
    "key": Room(lambda: b"HITId,stage,fault\na,2,empty\n", _by_file("key.csv", _beside_corpora("keyed"))),
    "ids": Room(lambda: b"id,name\n1,kitchen\n2,kitchen/bench\n", _by_file("ids.csv", _beside_corpora("numbered"))),
    "release-facts": Room(lambda: b'{"cup": ["CLEAN", "DIRTY"]}', _by_file("facts.json", _beside_corpora("released"))),
    "beliefs": Room(_beliefs, _by_file("results.jsonl", _believed)),
    "manifest": Room(_manifest, _manifests),
    "events": Room(_events, _collected),
    "draft": Room(lambda: _DRAFT, _drafts),
}
