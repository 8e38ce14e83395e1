"""Attacks by checkpoints of strangers, who can compute every digest: loading and asking one may only fail cleanly."""

from __future__ import annotations

import contextlib
import json
import os
import pickle
import shutil
import struct
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from attack import DEEP, Attack, Ground
from small_checkpoints import KINDS, ask, folder_of

from hearth.models.checkpoint import NAME, WEIGHTS
from hearth.schemas.diagnostics import HearthError
from hearth.storage.files import value_digest

BASES = ("mle-composed", "retrieve-edit")
"""Checkpoints whose copies are changed in every place; those of the other kinds, in the first of each list."""

BAD: tuple[Any, ...] = (None, [], {}, "../../guard/x", -1, 10**9, 1e308, [[[]]], "x" * 100_000, DEEP)

FEW: tuple[Any, ...] = (None, [], {}, "x", -1, 10**9, 0.5, [[[]]])
"""For places within the content of the other kinds."""

DEPTH = 4
"""The depth in the content to which something is changed."""

Change = Callable[[dict[str, Any]], Any]


def checkpoints() -> Iterator[Attack]:
    """Checkpoints with files, settings, contents and weights that no training gives."""
    for base in BASES:
        document = _document_of(base)
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


def kinds() -> Iterator[Attack]:
    """Checkpoints of every kind of model, with something else in a place of their settings, content and weights."""
    for base in KINDS:
        if base not in BASES:
            document = _document_of(base)
            for place in (*_places(document, "settings", 1), *_places(document, "content", DEPTH), ("trained",)):
                for bad in FEW:
                    title = f"{base}: {'.'.join(map(str, place))[:40]} = {_short(bad)}"
                    yield _changed(base, title, _put(place, bad), "models")
        for name, change in WEIGHT_CHANGES.items():
            yield Attack("models", f"{base}: weights: {name}", lambda ground, b=base, c=change: _altered(ground, b, c))
    for other in KINDS:
        yield _changed("demo2sketch", f"demo2sketch as {other}", _put(["model"], other), "models")
        yield _changed(other, f"{other} as demo2sketch", _put(["model"], "demo2sketch"), "models")


def _document_of(base: str) -> dict[str, Any]:
    found: dict[str, Any] = json.loads((folder_of(base) / NAME).read_text())
    return found


def _places(document: dict[str, Any], part: str, depth: int) -> Iterator[tuple[Any, ...]]:
    """Yield the places of values in a part: each of a mapping, the first of a list."""
    waiting: list[tuple[tuple[Any, ...], Any]] = [((part,), document[part])]
    while waiting:
        place, value = waiting.pop()
        yield place
        inner = (
            list(value)[:12]
            if isinstance(value, dict)
            else list(range(min(len(value), 1)))
            if isinstance(value, list)
            else []
        )
        waiting += [((*place, key), value[key]) for key in inner if len(place) <= depth]


def _short(bad: Any) -> str:
    return repr(bad)[:16]


def _put(place: Sequence[Any], bad: Any) -> Change:
    def change(document: dict[str, Any]) -> None:
        inner = document
        for name in place[:-1]:
            inner = inner[name]
        inner[place[-1]] = bad

    return change


def _copy(ground: Ground, base: str = BASES[0]) -> Path:
    return shutil.copytree(folder_of(base), ground.folder / "model")


def _changed(base: str, title: str, change: Change, group: str = "checkpoint") -> Attack:
    def load(ground: Ground) -> Any:
        folder = _copy(ground, base)
        document = json.loads((folder / NAME).read_text())
        digest = document["digest"]
        change(document)
        if document.get("digest") == digest:
            with contextlib.suppress(HearthError):  # it is too deep
                document["digest"] = value_digest(document["content"])
        (folder / NAME).write_text(json.dumps(document))
        return ask(folder, base)

    return Attack(group, title if group == "models" else f"{base}: {title}", load)


def _altered(ground: Ground, base: str, change: Callable[[dict[str, Any]], dict[str, Any]]) -> Any:
    """Ask a model whose weights were changed."""
    import safetensors.numpy

    folder = _copy(ground, base)
    _store(folder, safetensors.numpy.save(change(safetensors.numpy.load((folder / WEIGHTS).read_bytes()))))
    return ask(folder, base)


def _of_all(made: Callable[[Any], Any]) -> Callable[[dict[str, Any]], dict[str, Any]]:
    return lambda weights: {name: np.ascontiguousarray(made(array)) for name, array in weights.items()}


WEIGHT_CHANGES: dict[str, Callable[[dict[str, Any]], dict[str, Any]]] = {
    "no number": _of_all(lambda array: np.full_like(array, np.nan)),
    "infinite": _of_all(lambda array: np.full_like(array, np.inf)),
    "huge": _of_all(lambda array: np.full_like(array, 6e4)),
    "largest": _of_all(lambda array: np.full_like(array, np.finfo(array.dtype).max if array.dtype.kind == "f" else 1)),
    "whole": _of_all(lambda array: np.full(array.shape, -1, np.int64)),
    "true": _of_all(lambda array: np.ones(array.shape, np.bool_)),
    "double": _of_all(lambda array: array.astype(np.float64)),
    "flat": _of_all(lambda array: array.ravel()),
    "empty": _of_all(lambda array: array[:0]),
    "none": lambda weights: {},
    "one more": lambda weights: {**weights, "../../guard/x": np.zeros(3, np.float32)},
}
"""Changes to the weights of each kind."""


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
    folder = _copy(ground)
    _store(folder, data)
    return ask(folder, BASES[0])


def _store(folder: Path, data: bytes) -> None:
    """Put weights into a checkpoint, with their digest."""
    from hashlib import sha256

    (folder / WEIGHTS).write_bytes(data)
    document = json.loads((folder / NAME).read_text())
    document["weights"] = sha256(data).hexdigest()
    (folder / NAME).write_text(json.dumps(document))


def _linked(ground: Ground, file: str, target: str) -> Any:
    folder = _copy(ground)
    (folder / file).unlink()
    (folder / file).symlink_to(target.replace("{guard}", str(ground.guard)))
    return ask(folder, BASES[0])


def _pipe(ground: Ground, file: str) -> Any:
    folder = _copy(ground)
    (folder / file).unlink()
    os.mkfifo(folder / file)
    return ask(folder, BASES[0])


def _document(ground: Ground, text: str) -> Any:
    folder = _copy(ground)
    (folder / NAME).write_text(text, "utf-8", "surrogateescape")
    return ask(folder, BASES[0])
