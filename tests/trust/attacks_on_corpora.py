"""Attacks by files beside a corpus: annotated sketches and models of them, ratings, keys of faults, ids, grammars."""

from __future__ import annotations

import contextlib
import io
import json
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import Any

import yaml
from attack import DEEP, Attack, Ground
from attacks_on_challenges import _read, _strange
from attacks_on_studies import _at, _other_keys, _places, _with

from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.storage.input_files import LARGEST

SOURCE = (
    "Read a book\nOn the sofa.\n\n\n[Walk] <novel> (1)\n[Grab] <novel> (1)\n[Read] <novel> (1)\n\n"
    "Nap\n\n\n\n[Walk] <sofa> (1)\n[Lie] <sofa> (1)\n[Sleep]\n"
)
SKETCHES = {
    "answer": [[0, 0, 1], [0, 1, 1]],
    "represent": [1, 1],
    "input": [
        {"title": "Read a book", "descr": "On the sofa.", "prog": ["read novel"], "prefix": "a"},
        {"title": "Nap", "descr": "", "prog": ["lie sofa", "sleep"], "prefix": "a"},
    ],
}


BAD: tuple[Any, ...] = (
    None, [], {}, "", -1, 1e300, True, "9" * 5_000, "{guard}/secret.csv", [[[[]]]], {"x": {"x": []}}, "\u202e\x1b[2J",
    DEEP,
)  # fmt: skip
"""Values that somebody could write in the place of any other."""


def corpora() -> Iterator[Attack]:
    """Every file that is read beside a corpus, with something wrong in it."""
    yield from _annotations()
    yield from _models()
    yield from _tables()
    yield from _grammars()


def _files(kind: str, reader: Callable[[Path], Any], *, limited: bool = True) -> Iterator[Attack]:
    """Files that end nowhere, are none, or are too large."""
    for each in _strange("corpora", reader):
        yield Attack("corpora", f"{kind}: {each.name}", each.call)

    def large(ground: Ground) -> None:
        path = ground.folder / "given.json"
        with path.open("wb") as file:
            file.truncate(LARGEST + 1)
        try:
            reader(path)
        except HearthError as error:
            assert {fault.code for fault in error.diagnostics} == {"FILE_TOO_LARGE"}, error
        else:
            raise AssertionError("it was read")

    if limited:
        yield Attack("corpora", f"{kind}: too large", large)


def _true(kind: str, reader: Callable[[Path], Any], text: str) -> Attack:
    """Return an attack that changes nothing: the text must be read."""

    def read(ground: Ground) -> None:
        try:
            assert _read(reader, text, ground), "nothing was read"
        except HearthError as error:
            raise AssertionError(str(error)) from error

    return Attack("corpora", f"{kind}: as it is", read)


@cache
def _programs() -> tuple[list[Any], list[Any]]:
    """The programs that are annotated, and a home."""
    from tempfile import TemporaryDirectory

    from hearth.analysis.programs_in_homes import Script, scripts
    from hearth.homes import library
    from hearth.simulation.world.home import Home

    with TemporaryDirectory() as folder:
        path = Path(folder) / "programs.txt"
        path.write_text(SOURCE)
        found = [each for each in scripts([str(path)], default()) if isinstance(each, Script)]
    return found, [Home.from_graph(library.load_graph("maple", default()), "maple", default())]


def judged(path: Path) -> Any:
    """Return the output about annotations: of programs whose sketches are inferred to be all else, and side by side."""
    from hearth.analysis.sketch_agreement import compare
    from hearth.analysis.sketch_evaluation import SketchEvaluation, annotated

    found = SketchEvaluation(frozenset())
    for one in annotated(path, path.name, _programs()[0], default()):
        if one is not None:
            found.rows.append((one, tuple(not kept for kept in one.answer)))
    said = found.summary(), list(found.disagreements())
    return said, compare(path, path) if path.is_file() and found.rows else None


def _annotations() -> Iterator[Attack]:
    yield _true("sketches", lambda path: judged(path)[1], json.dumps(SKETCHES))
    yield from _files("sketches", judged, limited=False)  # they are read entry by entry
    for place in _places(SKETCHES):
        for bad in (*BAD, [" "], [""]):
            name, document = f"sketches: {'.'.join(map(str, place))} = {bad!r:.16}", _with(SKETCHES, place, bad)
            yield Attack("corpora", name, lambda ground, d=document: _read(judged, json.dumps(_at(d, ground)), ground))
    for name, kept in (("all", (1, 1, 1)), ("none", (0, 0, 0)), ("the last", (0, 0, 1))):
        text = json.dumps(_keeping(kept))
        for folds in (0, 1, 2, 10**9):
            yield Attack("corpora", f"sketches: {name}, in {folds} parts", lambda ground, t=text, f=folds: _read(
                lambda path: _fitted(path, f), t, ground))  # fmt: skip


def _keeping(kept: tuple[int, ...]) -> dict[str, Any]:
    """Annotations that keep the same steps of either program."""
    steps = {"Read a book": ("walk novel", "grab novel", "read novel"), "Nap": ("walk sofa", "lie sofa", "sleep")}
    given = [
        {
            "title": title,
            "descr": "",
            "prog": [line for line, flag in zip(lines, kept, strict=True) if flag],
            "prefix": title,
        }
        for title, lines in steps.items()
    ]
    return {"answer": [kept] * len(given), "input": given}


def _fitted(path: Path, folds: int) -> None:
    """Fit a model, or cross-validate it."""
    from hearth.commands.sketch_fitting import fitted

    out = None if folds else path.with_name("model.json")
    with contextlib.redirect_stdout(io.StringIO()):
        fitted(path, *_programs(), default(), None, out, folds, 0, as_json=True)


@cache
def sketch_model() -> dict[str, Any]:
    """A small model, on top of ours."""
    from hearth.repair.sketch_model import FILE

    shipped: dict[str, Any] = json.loads(FILE.read_text())
    trees = shipped["trees"][:1]
    few = {name: dict([*shipped[name].items()][:2]) for name in ("weights", "counts")}
    grown = [{**tree, "value": [0.5 for _ in tree["value"]]} for tree in trees]
    return {**shipped, **few, "base": True, "trees": trees, "forest": grown}


def asked(path: Path) -> Any:
    """Read a model and ask it: its probabilities are some."""
    from hearth.repair.sketch_features import features
    from hearth.repair.sketch_model import load_model

    model = load_model(path)
    program = _programs()[0][0].program
    steps = features(program, (False, False, True), default())
    found = [model.probability(step) for step in steps]
    assert all(0 <= each <= 1 for each in found), f"probabilities of {found}"
    return model.keep(steps), model.to_json()["fitted_on"]


def _models() -> Iterator[Attack]:
    yield _true("model", asked, json.dumps(sketch_model()))
    yield from _files("model", asked, limited=False)
    whole = sketch_model()
    nodes = {"left": -1, "right": -1, "number": 5_000, "threshold": "nan", "value": "inf"}
    for place in _places(whole):
        for bad in (*BAD, "nan", "-inf", 2**62):
            name, document = f"model: {'.'.join(map(str, place))[:30]} = {bad!r:.16}", _with(whole, place, bad)
            yield Attack("corpora", name, lambda ground, d=document: _read(asked, json.dumps(_at(d, ground)), ground))
    for name, bad in nodes.items():
        document = _with(whole, ("trees", 0, name), [bad] * len(whole["trees"][0]["left"]))
        yield Attack("corpora", f"model: every {name} {bad}", lambda ground, d=document: _read(
            asked, json.dumps(d), ground))  # fmt: skip


def rated(path: Path) -> Any:
    """The medians of a sheet."""
    from hearth.analysis.completeness_ratings import medians, read_sheets

    try:
        return medians(read_sheets([path]))
    except HearthError as error:
        assert len(error.diagnostics) < 1_000, f"{len(error.diagnostics)} faults"
        raise


def keyed(path: Path) -> Any:
    """Return the scores of found faults, by a key."""
    from hearth.analysis.error_detection import Found, read_key, score

    return score(Found({"a": {"EMPTY"}}, 1), read_key(path))


def numbered(path: Path) -> Any:
    """A home by a plan, whose things have the ids of a table."""
    from hearth.homes.library import IDS, _layout, layout_of

    _layout.cache_clear()
    plan = path.with_name("hut.yaml")
    plan.write_text(
        "home: hut\nheight: 2.5\ncharacter: kitchen\nrooms:\n- {name: kitchen, class: kitchen, at: [0, 0], "
        "size: [4, 3], furniture: [{bench: {wall: west}}]}\n"
    )
    path.replace(path.with_name(f"hut{IDS}"))
    return layout_of(plan, default()).plan.ids


def released(path: Path) -> Any:
    """The facts of a knowledge file of the release."""
    from hearth.kb.tools.published_knowledge import read_release

    path.replace(path.with_name("object_states.json"))
    return read_release(path.parent)


CELLS = (
    "", "\n", "x", "\x00", "\xff", '"', '"x', "a,b\n1,2\n", "{head}\n", "{head}\nx\n", "{head}\nx,,,,\n",
    "{head}\n" + "x" * 200_000 + ",1\n", '{head}\n"' + "x\n" * 200_000, "{head}\n" + ("," * 50_000 + "\n") * 9,
    "{head},{head}\na,1,b,2\n", "{head}\na,9\n" * 2, "{head}\n" + "a,9\n" * 50_000,
    "{head}\na," + "1" * 5_000 + "\n", "{head}\n\u202e\x1b[2J,<script>alert(1)</script>\n", "{head}\n=HYPERLINK(0),1\n",
    "\ufeff{head}\na,1\n", "{head}\n../../guard/x,1\n", "x" * 300_000 + "\n", "{head}\na,\u00b2\n",
)  # fmt: skip
"""Tables that nobody wrote with a spreadsheet."""

TABLES: dict[str, tuple[Callable[[Path], Any], str]] = {
    "ratings": (rated, "program_id,rating"),
    "key": (keyed, "HITId,fault"),
    "ids": (numbered, "name,id"),
}


def _tables() -> Iterator[Attack]:
    for kind, (reader, head) in TABLES.items():
        if kind != "ids":
            yield from _files(kind, reader)
        for cells in CELLS:
            for encoding in ("utf-8", "utf-16", "latin-1") if len(cells) < 100 else ("utf-8",):
                data = cells.replace("{head}", head).encode(encoding, "replace")
                yield Attack("corpora", f"{kind}: {cells[:24]!a} {encoding}", lambda ground, r=reader, d=data: _read(
                    r, d, ground))  # fmt: skip
    for bad in (7, *BAD, {"x": 7}, {"x": [7]}, {"x": [[]]}, "[" * 90_000):
        text = bad if isinstance(bad, str) else json.dumps(bad)
        yield Attack("corpora", f"release: {bad!r:.24}", lambda ground, t=text: _read(released, t, ground))


GRAMMAR = """
plan: {1: 1}
join: 0.5
first: 0.5
described: 0.5
tasks:
  sit:
    weight: 1
    titles: [Sit]
    choose: {seat: {bed: 1, sofa: 2}}
    aims: [to rest]
    parts:
    - {steps: [Walk seat, Sit seat], say: ["sit on the {seat}"], chance: 1, described: 1}
    - {steps: [Grab novel], say: [take a book], chance: 0.5}
"""


def synthesized(path: Path) -> Any:
    """Two programs of a grammar."""
    from itertools import islice

    from hearth.analysis.synthesis import load, record, synthesize

    found = islice(synthesize(2, 1, load(path, default())), 2)
    return [record(one, number, 1, {}) for number, one in enumerate(found)]


def _grammars() -> Iterator[Attack]:
    yield _true("grammar", synthesized, GRAMMAR)
    yield from _files("grammar", synthesized)
    whole = yaml.safe_load(GRAMMAR)
    for place in _places(whole):
        for bad in (
            *BAD,
            ["Walk", "Walk x y"],
            ["{x}", "{0.__class__}", "{seat!r}", "<x>"],
            {"bed": -1},
            {1: float("nan")},
        ):
            name, document = f"grammar: {'.'.join(map(str, place))[:30]} = {bad!r:.16}", _with(whole, place, bad)
            yield Attack("corpora", name, lambda ground, d=document: _read(synthesized, yaml.safe_dump(d), ground))
    for place, document in _other_keys(whole):
        yield Attack("corpora", f"grammar: a key in {'.'.join(map(str, place))[:40]}", lambda ground, d=document: _read(
            synthesized, yaml.safe_dump(d), ground))  # fmt: skip
    for like in ("sit", "none", []):
        document = _with(whole, ("tasks", "sit", "like"), like)
        yield Attack("corpora", f"grammar: like {like}", lambda ground, d=document: _read(
            synthesized, yaml.safe_dump(d), ground))  # fmt: skip
