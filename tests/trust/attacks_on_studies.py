"""Attacks by studies of strangers: their files, their lists of films, what was collected in them."""

from __future__ import annotations

import copy
import json
import os
import shutil
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import orjson
import yaml
from attack import DEEP, Attack, Ground

from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.storage.names import inside
from hearth.studies.films_to_judge import JudgedFilm, read_films
from hearth.studies.judged_film_recording import film_path
from hearth.studies.programs_to_judge import program_of
from hearth.studies.simulated_study import simulated_study
from hearth.studies.study_file import read_study, study_of
from hearth.studies.study_findings import findings
from hearth.studies.study_folder import EVENTS, FILMS, opened
from hearth.studies.study_report import page
from hearth.studies.study_simulation import Crowd
from hearth.studies.study_tables import archive
from hearth.studies.study_trials import record_of

BAD: tuple[Any, ...] = (
    None,
    [],
    {},
    "",
    -1,
    1e300,
    10**30,
    float("inf"),
    float("nan"),
    True,
    "9" * 5_000,
    "../../../guard/x",
    "{guard}/secret.csv",
    "<script>alert(1)</script>",
    "=HYPERLINK(0)",
    [[[[]]]],
    ["x"] * 2_000,
    {"x": {"x": []}},
    "\u202e\x1b[2J",
    DEEP,
)
"""Values that somebody could write in the place of any other."""

HEAD = """
name: attacked
title: A study
room: play
seed: 3
people: 2
consent: You may stop at any time.
tutorial: [{title: The home, text: You act for a person.}]
practice: 1
tasks: {challenge: owah, split: test, number: 2}
interface: symbolic
conditions: [{name: alone, title: Alone}]
repeats: 1
at_least: 1
limits: {minutes: 20, idle_hours: 24}
questions: [{name: helpful, text: How was it, scale: {from: 1, to: 7, labels: {1: bad, 7: good}}, after: trial}]
exit: [{name: age, text: How old, choices: [young, old], required: false}, {name: comments, text: What else}]
"""
JUDGED = """
name: judging
title: Films
room: judge
seed: 3
people: 2
consent: You may stop.
films: {of: programs, each: 1, bands: [{name: a, title: A, from: 0.5, to: 1}]}
conditions: [{name: written, title: Written}]
repeats: 2
questions: [{name: quality, text: How good, scale: {from: 1, to: 5}}]
"""


def studies() -> Iterator[Attack]:
    """Studies' files, films' lists and collected events, each with something wrong in it."""
    yield from _study_files()
    yield from _film_lists()
    yield from _collected()


def _places(value: Any, before: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """The place of every value in a document."""
    if before:
        yield before
    if isinstance(value, dict | list):
        for key, inner in value.items() if isinstance(value, dict) else enumerate(value[:2]):
            yield from _places(inner, (*before, key))


def _with(document: Any, place: tuple[Any, ...], bad: Any) -> Any:
    changed = copy.deepcopy(document)
    inner = changed
    for key in place[:-1]:
        inner = inner[key]
    inner[place[-1]] = bad
    return changed


KEYS = ("\u00b2", "9" * 5_000, "", "__class__", "\x1b[2J", "-1")
"""Keys that no mapping has."""


def _other_keys(document: Any) -> Iterator[tuple[tuple[Any, ...], Any]]:
    """The document with another first key in each of its mappings."""
    for place in ((), *_places(document)):
        inner = document
        for key in place:
            inner = inner[key]
        if isinstance(inner, dict) and inner:
            (_, value), *others = inner.items()
            for key in KEYS:
                changed = {key: value, **dict(others)}
                yield place, _with(document, place, changed) if place else changed


def _at(value: Any, ground: Ground) -> Any:
    return json.loads(json.dumps(value).replace("{guard}", str(ground.guard)))


def _study_files() -> Iterator[Attack]:
    def read(document: Any, ground: Ground) -> Any:
        found = study_of(yaml.safe_dump(_at(document, ground)), "study.yaml")
        inside(ground.folder, found.name)
        return found

    for text in (HEAD, JUDGED):
        whole = yaml.safe_load(text)
        for place in _places(whole):
            for bad in BAD:
                name, document = f"study: {'.'.join(map(str, place))} = {bad!r:.16}", _with(whole, place, bad)
                yield Attack("studies", name, lambda ground, d=document: read(d, ground))
        for place, document in _other_keys(whole):
            name = f"study: a key in {'.'.join(map(str, place))}: {len(str(document))}"
            yield Attack("studies", name, lambda ground, d=document: read(d, ground))
    large = {"people": 5_000, "repeats": 1_000, "practice": 10, "at_least": 1_000}
    for name, value in large.items():
        document = {**yaml.safe_load(HEAD), name: value}
        yield Attack("studies", f"study: {name} = {value}", lambda ground, d=document: read(d, ground))
    largest = {**yaml.safe_load(HEAD), "people": 5_000, "repeats": 1_000, "at_least": 0}
    largest["tasks"] = {"challenge": "owah", "split": "test", "number": 100}
    yield Attack("studies", "study: 100,000 trials", lambda ground: read(largest, ground))
    for target in ("/dev/zero", "pipe", "loop", "{guard}", "none", "x\0y"):
        yield Attack(
            "studies", f"study: file {target!a}", lambda ground, t=target: read_study(_hostile_file(ground, t))
        )


def _hostile_file(ground: Ground, target: str) -> Path:
    if target == "pipe":
        os.mkfifo(ground.folder / "pipe")
    if target == "loop":
        (ground.folder / "loop").symlink_to("loop")
    return ground.folder / target.replace("{guard}", str(ground.guard))


def _film_lists() -> Iterator[Attack]:
    film = JudgedFilm(0, "written", "000-a", "a", "Title: text", "rowan", 0.5, ["[Walk] <kitchen> (1)"]).as_json()

    def read(document: Any, ground: Ground) -> Any:
        path = ground.folder / FILMS
        path.write_text(document if isinstance(document, str) else json.dumps(_at(document, ground)))
        found = read_films(path)
        for each in found:
            assert film_path(ground.folder, each).resolve().is_relative_to(ground.folder.resolve())
            if isinstance(each.content, list):
                program_of(each)
            else:
                record_of(each.content)
        return [each.about for each in found]

    for place in _places([film]):
        for bad in BAD:
            name, document = f"films: {'.'.join(map(str, place))} = {bad!r:.16}", _with([film], place, bad)
            yield Attack("studies", name, lambda ground, d=document: read(d, ground))
    more: dict[str, Any] = {
        "more keys": [{**film, "shell": "x"}],
        "fewer keys": [{"item": 0}],
        "twice": [film, film],
        "no list": {"0": film},
        "deep": "[" * 100_000,
        "not JSON": "{",
        "episode": [{**film, "content": {"task": "x"}}],
        "lines": [{**film, "content": ["[Walk] <kitchen> (1)"] * 20_000}],
        "long line": [{**film, "content": ["x" * 10**6]}],
    }
    for name, document in more.items():
        yield Attack("studies", f"films: {name}", lambda ground, d=document: read(d, ground))


@cache
def _simulated() -> tuple[TemporaryDirectory[str], Path]:
    """A small study that was simulated."""
    made = TemporaryDirectory()
    simulated_study(study_of(HEAD, "study.yaml"), Crowd(0, 1), Path(made.name), default)
    return made, Path(made.name) / "attacked"


Events = list[dict[str, Any]]


def _collected() -> Iterator[Attack]:
    """Every kind of event with another value in each of its places."""
    kinds = ("joined", "consented", "read", "practised", "did", "answered", "left", "finished")
    shapes: dict[str, dict[str, Any]] = {
        "joined": {"person": "", "place": 0},
        "did": {"item": 0, "condition": "", "repeat": 0, "seconds": 0.0, "record": {}},
        "answered": {"item": 0, "condition": "", "repeat": 0, "answers": {}},
        "left": {"why": ""},
        "finished": {"answers": {}},
    }
    for kind in kinds:
        for place in (
            ("stream",),
            ("number",),
            ("kind",),
            ("at",),
            ("data",),
            *(("data", name) for name in shapes.get(kind, {})),
        ):
            for bad in BAD:
                name = f"events: {kind}.{'.'.join(place)} = {bad!r:.16}"
                yield Attack("studies", name, lambda ground, k=kind, p=place, b=bad: _opened(ground, _first(k, p, b)))
    for name in ("task", "seed", "helped", "helper_goal", "actions", "final", "metrics", "end"):
        for bad in BAD:
            change = _first("did", ("data", "record", name), bad)
            yield Attack("studies", f"events: record.{name} = {bad!r:.16}", lambda ground, c=change: _opened(ground, c))
    for name in ("format", "study", "simulated"):
        for bad in BAD:
            change = _header(name, bad)
            yield Attack("studies", f"events: header {name} = {bad!r:.16}", lambda ground, c=change: _opened(ground, c))
    for text in (
        "<script>alert(1)</script>",
        '"><img src=x onerror=alert(1)>',
        '=HYPERLINK("http://x","y")',
        "\x1b]0;a\x07",
    ):
        yield Attack("studies", f"events: answer {text!a}", lambda ground, t=text: _answered(ground, t))


def _first(kind: str, place: tuple[str, ...], bad: Any) -> Callable[[Events], None]:
    def change(lines: Events) -> None:
        line = next(each for each in lines[1:] if each["kind"] == kind)
        line.update(_with(line, place, bad))

    return change


def _header(name: str, bad: Any) -> Callable[[Events], None]:
    def change(lines: Events) -> None:
        lines[0][name] = bad

    return change


def _line(value: Any) -> bytes:
    try:
        return orjson.dumps(value) + b"\n"
    except orjson.JSONEncodeError:  # numbers that it refuses
        return json.dumps(value).encode() + b"\n"


def _opened(ground: Ground, change: Callable[[Events], None]) -> str:
    folder = ground.folder / "attacked"
    shutil.copytree(_simulated()[1], folder)
    lines = [json.loads(line) for line in (folder / EVENTS).read_text().splitlines()]
    change(lines)
    (folder / EVENTS).write_bytes(b"".join(_line(_at(line, ground)) for line in lines))
    collected = opened(folder, default)
    archive(collected)
    return page(findings(collected), [])


def _answered(ground: Ground, text: str) -> None:
    """Whatever somebody wrote stands in no page as markup."""

    def change(lines: Events) -> None:
        for line in lines[1:]:
            if line["kind"] == "finished":
                line["data"]["answers"]["comments"] = text

    try:
        assert text not in _opened(ground, change)
    except HearthError as error:
        raise AssertionError(str(error)) from error
