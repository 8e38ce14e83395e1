"""Attacks by checkpoints of strangers, who can compute every digest: loading and asking one may only fail cleanly."""

from __future__ import annotations

import json
import os
import pickle
import shutil
import struct
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from attack import Attack, Ground

from hearth.models.checkpoint import NAME, WEIGHTS
from hearth.models.model_registry import TRAINED, restore
from hearth.storage.files import value_digest

BASES = ("mle-composed", "retrieve-edit")
"""Checkpoints whose copies are changed."""

BAD: tuple[Any, ...] = (None, [], {}, "../../guard/x", -1, 10**9, 1e308, [[[]]], "x" * 100_000)

Change = Callable[[dict[str, Any]], Any]


def ask(folder: Path) -> Any:
    """Load a checkpoint and let it write a program."""
    from hearth.models.interface import Request

    return restore(folder)[1].predict([Request("x", "Watch TV", "Turn on the TV and sit down on the sofa.")])


def checkpoints() -> Iterator[Attack]:
    """Checkpoints with files, settings, contents and weights that no training gives."""
    for base in BASES:
        document = json.loads((TRAINED / base / NAME).read_text())
        for part in ("settings", "content", "trained", "model", "format", "weights", "digest"):
            for bad in BAD:
                yield _changed(base, f"{part} = {_short(bad)}", _put([part], bad))
        for part in ("settings", "content"):
            for name, value in document[part].items():
                inner = (
                    [[part, name], *([part, name, key] for key in value)] if isinstance(value, dict) else [[part, name]]
                )
                for place in inner:
                    for bad in BAD:
                        yield _changed(base, f"{'.'.join(place[1:])} = {_short(bad)}", _put(place, bad))
    for name, data in WEIGHT_FILES.items():
        yield Attack("checkpoint", f"weights: {name}", lambda ground, d=data: _weights(ground, d))
    for name, target in (("zero", "/dev/zero"), ("guard", "{guard}/secret.csv"), ("loop", NAME)):
        for file in (NAME, WEIGHTS):
            yield Attack("checkpoint", f"{file} is a link to {name}",
                         lambda ground, f=file, t=target: _linked(ground, f, t))  # fmt: skip
    for file in (NAME, WEIGHTS):
        yield Attack("checkpoint", f"{file} is a pipe", lambda ground, f=file: _pipe(ground, f))
    for name, text in (("deep", "[" * 100_000), ("not text", "\udcff"), ("number", "9" * 100_000)):
        yield Attack("checkpoint", f"{NAME}: {name}", lambda ground, t=text: _document(ground, t))


def _short(bad: Any) -> str:
    return repr(bad)[:16]


def _put(place: list[str], bad: Any) -> Change:
    def change(document: dict[str, Any]) -> None:
        inner = document
        for name in place[:-1]:
            inner = inner[name]
        inner[place[-1]] = bad

    return change


def _copy(ground: Ground, base: str = BASES[0]) -> Path:
    return shutil.copytree(TRAINED / base, ground.folder / "model")


def _changed(base: str, title: str, change: Change) -> Attack:
    def load(ground: Ground) -> Any:
        folder = _copy(ground, base)
        document = json.loads((folder / NAME).read_text())
        digest = document["digest"]
        change(document)
        if document.get("digest") == digest:
            document["digest"] = value_digest(document["content"])
        (folder / NAME).write_text(json.dumps(document))
        return ask(folder)

    return Attack("checkpoint", f"{base}: {title}", load)


class _Calls:
    def __reduce__(self) -> Any:
        return os.system, ("touch pickled",)


def _header(text: str, data: bytes = b"") -> bytes:
    return struct.pack("<Q", len(text)) + text.encode() + data


WEIGHT_FILES = {
    "pickle": pickle.dumps(_Calls()),
    "empty": b"",
    "length": struct.pack("<Q", 2**63),
    "long header": struct.pack("<Q", 1 << 40) + b"{",
    "shape": _header('{"a": {"dtype": "F32", "shape": [1000000000000], "data_offsets": [0, 4]}}', b"0000"),
    "offsets": _header('{"a": {"dtype": "F32", "shape": [1], "data_offsets": [-4, 0]}}', b"0000"),
    "names": _header('{"../../guard/x": {"dtype": "F32", "shape": [1], "data_offsets": [0, 4]}}', b"0000"),
    "deep": _header("[" * 50_000),
}
"""Files of weights that are none."""


def _weights(ground: Ground, data: bytes) -> Any:
    from hashlib import sha256

    folder = _copy(ground)
    (folder / WEIGHTS).write_bytes(data)
    document = json.loads((folder / NAME).read_text())
    document["weights"] = sha256(data).hexdigest()
    (folder / NAME).write_text(json.dumps(document))
    return ask(folder)


def _linked(ground: Ground, file: str, target: str) -> Any:
    folder = _copy(ground)
    (folder / file).unlink()
    (folder / file).symlink_to(target.replace("{guard}", str(ground.guard)))
    return ask(folder)


def _pipe(ground: Ground, file: str) -> Any:
    folder = _copy(ground)
    (folder / file).unlink()
    os.mkfifo(folder / file)
    return ask(folder)


def _document(ground: Ground, text: str) -> Any:
    folder = _copy(ground)
    (folder / NAME).write_text(text, "utf-8", "surrogateescape")
    return ask(folder)
