"""Executions to judge may be shown in 3D instead of as a film: the study's file says which, and `prepare` makes it."""

import json
from dataclasses import asdict

import pytest
from web.test_study_room import JUDGE

from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.storage.files import write_json
from hearth.studies.films_to_judge import JudgedFilm
from hearth.studies.study_file import study_of
from hearth.studies.study_preparation import prepared

REPLAYED = JUDGE.replace("each: 1", "each: 1\n  shown: replay")

PROGRAMS = (
    ["[Walk] <television> (1)", "[SwitchOn] <television> (1)"],
    ["[Walk] <couch> (1)", "[Sit] <couch> (1)", "[StandUp]"],
)


def with_replays(out):
    """A folder of a server with a study whose two programs are shown in 3D; its facts."""
    (out / "judging").mkdir(parents=True)
    films = [
        JudgedFilm(n, "written", f"{n:03d}-{b}", b, f"Title: Text {n}", "maple", 1 - n, lines)
        for n, (b, lines) in enumerate(zip("ab", PROGRAMS, strict=True))
    ]
    write_json(out / "judging" / "films.json", [asdict(film) for film in films])
    return prepared(study_of(REPLAYED, "study.yaml"), out, default)


def test_every_program_gets_a_replay_and_no_film(tmp_path):
    assert with_replays(tmp_path)["films"] == 2
    assert not (tmp_path / "judging" / "films").exists()
    for name, lines in zip(("000-a", "001-b"), PROGRAMS, strict=True):
        made = json.loads((tmp_path / "judging" / "replays" / f"{name}.json").read_text())
        assert made.keys() == {"home", "run"}
        assert len(made["run"]["ticks"]) == len(lines) + 1
        assert made["home"]["things"]
    before = {path: path.stat().st_mtime_ns for path in (tmp_path / "judging" / "replays").iterdir()}
    prepared(study_of(REPLAYED, "study.yaml"), tmp_path, default)
    assert {path: path.stat().st_mtime_ns for path in before} == before, "what is there is kept"


def test_other_ways_of_showing_are_refused():
    with pytest.raises(HearthError, match="film, replay"):
        study_of(JUDGE.replace("each: 1", "each: 1\n  shown: theatre"), "study.yaml")
    assert study_of(JUDGE, "study.yaml").films.shown == "film"
