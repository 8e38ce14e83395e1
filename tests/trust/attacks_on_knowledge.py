"""Attacks by knowledge of strangers: every file of a layer laid over ours, whole directories, facts of the release."""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import yaml
from attack import DEEP, Attack, Ground
from attacks_on_corpora import CELLS
from attacks_on_studies import _at, _other_keys, _places, _with

from hearth.kb.knowledge import Knowledge
from hearth.kb.loading.load import FILES, OURS, default, load

PROGRAM = "Cook\nIn words.\n\n\n[Walk] <fridge> (1)\n[Open] <fridge> (1)\n[Grab] <milk> (1)\n[Special] <a nap>\n"

BAD: tuple[Any, ...] = (
    None, [], {}, "", -1, 1e300, 10**30, float("nan"), True, "9" * 5_000, "{guard}/secret.csv", [[[[]]]],
    {"x": {"x": []}}, "{0.__class__}", "{0:>3000000000}", "{9}", "(" * 500, "not " * 500, "\u202e\x1b[2J",
)  # fmt: skip
"""Values that somebody could write in the place of any other."""

LAID = tuple(name for name in FILES if name != "corrections.yaml" and (
    "objects_" not in name or name == "objects_things.csv"))  # fmt: skip
"""Files of a layer; those of objects are read alike, and corrections are ours alone."""

TWICE = "".join(
    f"Aa{n}: {{id: {900 + n}, roles: [x], needs: [object], effects: [{{like: Aa{max(n - 1, 0)}}}, "
    f"{{like: Aa{max(n - 1, 0)}}}], say: 'Do {{0}}'}}\n"
    for n in range(40)
)
"""Actions that are each like another twice."""

ANEW = "".join(f"d{n}(a, x): d{n - 1}(a, x) & d{n - 1}(a, x)\n" if n else "d0(a, x): ON(a, x)\n" for n in range(40))
"""Definitions that each use another twice."""

FACTS = {
    "properties_data.json": {"cup": ["GRABBABLE"]},
    "object_states.json": {"cup": ["CLEAN"]},
    "object_script_placing.json": {"cup": [{"relation": "ON", "destination": "table"}]},
    "class_name_equivalence.json": {"cup": ["mug"]},
    "affordances.json": {"affordances": {"GRAB": {"object1": ["cup"], "object2": []}}},
}
"""Small files of the release."""


def layer(name: str) -> bytes:
    """The first entries of one of our files, as a layer may have them."""
    lines = (OURS / name).read_text("utf-8").splitlines(keepends=True)
    if name.endswith(".csv"):
        return "".join([line for line in lines if not line.startswith("#")][:4]).encode()
    starts = [number for number, line in enumerate(lines) if line[:1] not in (" ", "#", "-", "\n")]
    return "".join(lines[starts[0] : (*starts, None)[min(3, len(starts))]]).encode()


def used(known: Knowledge, folder: Path) -> Any:
    """Return the output of commands that use some knowledge."""
    from hearth.commands.inputs import read_programs
    from hearth.datasets.export.pddl_domain import planning_domain
    from hearth.kb.consistency import lint
    from hearth.kb.language.step_phrases import parses, say
    from hearth.kb.tools.pddl import domain

    file = folder.parent / f"{folder.name}.txt"
    file.write_text(PROGRAM)
    said = [say(action, ["a cup"] * action.arity) for action in known.actions.values()]
    programs = list(read_programs(file, known, "cook.txt"))
    return lint(known), len(domain(known)), len(planning_domain(known)), said, parses(known, "walk to bed"), programs


def laid(folder: Path) -> Any:
    """A layer over ours: what is wrong with it, or what is made of it."""
    return used(load(overlay=folder), folder)


def compared(folder: Path) -> Any:
    """The differences between ours and a directory of files of ours or of the release."""
    from hearth.kb.tools.compare import compare

    return compare(default(), folder).differences


def _written(ground: Ground, name: str, data: bytes) -> Path:
    folder = ground.folder / "layer"
    folder.mkdir()
    (folder / name).write_bytes(data)
    return folder


def knowledge() -> Iterator[Attack]:
    """Every file of knowledge, with something wrong in it."""
    for name in LAID:
        data = layer(name)
        yield Attack("knowledge", f"{name}: as it is", lambda ground, n=name, d=data: laid(_written(ground, n, d)))
        yield from _yaml(name, data) if name.endswith(".yaml") else _csv(name, data)
        for target in ("/dev/zero", "pipe", "loop", "."):
            yield Attack("knowledge", f"{name} -> {target}", lambda ground, n=name, t=target: laid(
                _linked(ground.folder / "layer", n, t)))  # fmt: skip
    for name, text in (("actions.yaml", TWICE), ("derived.yaml", ANEW)):
        yield Attack("knowledge", f"{name}: twice", lambda ground, n=name, t=text: laid(
            _written(ground, n, t.encode())))  # fmt: skip
    yield from _directories()
    yield from _facts()


def _yaml(name: str, data: bytes) -> Iterator[Attack]:
    whole = yaml.load(data, yaml.BaseLoader)
    for number, place in enumerate(_places(whole)):
        for bad in BAD[number % 3 :: 3]:

            def changed(ground: Ground, p: tuple[Any, ...] = place, b: Any = bad) -> Any:
                text = yaml.safe_dump(_at(_with(whole, p, b), ground))
                return laid(_written(ground, name, text.encode()))

            yield Attack("knowledge", f"{name}: {'.'.join(map(str, place))[:30]} = {bad!r:.16}", changed)
    for place, document in _other_keys(whole):
        yield Attack("knowledge", f"{name}: a key in {'.'.join(map(str, place))[:30]}", lambda
                     ground, d=document: laid(_written(ground, name, yaml.safe_dump(d).encode())))  # fmt: skip
    for text in (b'a: "\x07"\n', b"\x00", b"\xff\xfe", b"[]", b"x", b"? [a]\n: b", b"a: !!python/object:os.system {}",
                 b"a: &a [*a]", b"a: 2020-13-45", b"{" * 9_000):  # fmt: skip
        yield Attack("knowledge", f"{name}: {text[:30]!r}", lambda ground, t=text: laid(_written(ground, name, t)))


def _csv(name: str, data: bytes) -> Iterator[Attack]:
    head, first = data.decode().splitlines()[:2]
    cells = first.split(",")
    for cell in CELLS:
        text = cell.replace("{head}", head)
        yield Attack("knowledge", f"{name}: {cell[:24]!a}", lambda ground, t=text: laid(
            _written(ground, name, t.encode("utf-8", "replace"))))  # fmt: skip
    for number in range(len(cells)):
        for bad in ("", "-1", "9" * 5_000, "nan", "inf 1 1", "x" * 1_000, "\u202e\x1b[2J", "{0.__class__}", "cup", "²"):
            row = ",".join([*cells[:number], bad, *cells[number + 1 :]])
            yield Attack("knowledge", f"{name}: cell {number} = {bad!a:.16}", lambda ground, r=row: laid(
                _written(ground, name, f"{head}\n{r}\n".encode())))  # fmt: skip


def _linked(folder: Path, name: str, target: str) -> Path:
    folder.mkdir(exist_ok=True)
    (folder / name).unlink(missing_ok=True)
    if target == "pipe":
        os.mkfifo(folder / name)
    elif target == ".":
        (folder / name).mkdir()
    else:
        (folder / name).symlink_to(folder / name if target == "loop" else target)
    return folder


def _directories() -> Iterator[Attack]:
    bomb = "a0: &a0 [x, x]\n" + "".join(f"a{n}: &a{n} [*a{n - 1}, *a{n - 1}]\n" for n in range(1, 60))

    def theirs(ground: Ground, change: Callable[[Path], Any]) -> Any:
        folder = Path(shutil.copytree(OURS, ground.folder / "theirs"))
        change(folder)
        return compared(folder)

    for name in FILES:
        if name.endswith(".yaml"):
            yield Attack("knowledge", f"another's {name}: aliases", lambda ground, n=name: theirs(
                ground, lambda folder: (folder / n).write_text(bomb)))  # fmt: skip
        for target in ("/dev/zero", "pipe", "loop", "."):
            yield Attack("knowledge", f"another's {name} -> {target}", lambda ground, n=name, t=target: theirs(
                ground, lambda folder: _linked(folder, n, t)))  # fmt: skip


def _facts() -> Iterator[Attack]:
    for name, facts in FACTS.items():
        for place in _places(facts):
            for bad in (None, [], {}, "", -1, True, "9" * 5_000, [[[]]], {"x": {"x": []}}, "\u202e\x1b[2J", DEEP):
                text = json.dumps(_with(facts, place, bad))
                yield Attack("knowledge", f"{name}: {'.'.join(map(str, place))[:30]} = {bad!r:.16}", lambda
                             ground, n=name, t=text: compared(_written(ground, n, t.encode())))  # fmt: skip
        for data in (b"[" * 100_000, b"", b"null", b"[]", b"\xff\xfe", b"9" * 100_000):
            yield Attack("knowledge", f"{name}: {data[:20]!r}", lambda ground, n=name, d=data: compared(
                _written(ground, n, d)))  # fmt: skip
        yield Attack("knowledge", f"{name}: no end", lambda ground, n=name: compared(_endless(ground, n)))
        for target in ("/dev/zero", "pipe", "loop", "."):
            yield Attack("knowledge", f"{name} -> {target}", lambda ground, n=name, t=target: compared(
                _linked(ground.folder / "layer", n, t)))  # fmt: skip


def _endless(ground: Ground, name: str) -> Path:
    folder = _written(ground, name, b"")
    with (folder / name).open("wb") as file:
        file.truncate(1 << 33)
    return folder
