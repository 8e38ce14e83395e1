"""The share of augmented programs that do each step as their originals do, and that it falls when they do not."""

from __future__ import annotations

from itertools import combinations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from typer.testing import CliRunner

from hearth import cli
from hearth.analysis.context_preservation import _longest, _seats, measure
from hearth.grounding.binding import bind
from hearth.repair import augmentation
from hearth.repair.handlers.common import RepairContext
from hearth.schemas.syntax import parse_program
from hearth.simulation.engine import run
from hearth.simulation.world.world import World

EAT = """Eat an apple


[Walk] <couch> (1)
[Sit] <couch> (1)
[Find] <food_apple> (1)
[Grab] <food_apple> (1)
[Eat] <food_apple> (1)
"""
WATCH = """Watch TV


[Walk] <television> (1)
[SwitchOn] <television> (1)
[Walk] <couch> (1)
[Sit] <couch> (1)
[Watch] <television> (1)
"""


def dataset(build_folder, folder, strength="thesis"):
    (folder / "watch.txt").write_text(WATCH)
    (folder / "eat.txt").write_text(EAT)
    sources = [folder / "watch.txt", folder / "eat.txt"]
    options = {"homes_folder": None, "homes": ("maple", "birch"), "variants": 20, "strength": strength}
    return build_folder(folder / "out", sources, **options).run_all().out / "publish"


def test_every_program_keeps_the_circumstances(build_folder, tmp_path):
    folder = dataset(build_folder, tmp_path)
    found = measure(folder)
    assert found["programs"]["all"] > 30 and found["steps"]["all"] > 4 * found["programs"]["all"]
    assert found["programs"]["share"] == found["steps"]["share"] == 1 and found["odd"] == []
    assert {counts["otherwise"] for counts in found["seats"].values()} == {0}
    assert found["seats"]["Eat"]["seated"] > 10 < found["seats"]["Watch"]["seated"]
    assert measure(folder, workers=2) == found
    shown = CliRunner().invoke(cli.app, ["augmented", str(folder), "--circumstances", "-j", "1"]).output
    count = found["programs"]["all"]
    assert f"\n  programs {count} of {count}, 100.0%\n" in shown
    assert ["Watch", str(found["seats"]["Watch"]["seated"]), "0"] in [line.split() for line in shown.splitlines()]


def test_repairs_that_ignore_circumstances_are_found_out(build_folder, tmp_path, monkeypatch):
    monkeypatch.setattr(augmentation, "circumstances", lambda execution, conditions=(): ())
    monkeypatch.setattr(RepairContext, "seat_taken", lambda context: None)  # so that nothing is brought to the seat
    found = measure(dataset(build_folder, tmp_path))
    assert 0 < found["programs"]["share"] < 0.9 and found["steps"]["share"] < 1
    assert found["odd"] and found["programs"]["all"] - found["programs"]["as_original"] == len(found["odd"])
    assert found["seats"]["Eat"]["otherwise"] > 0


def test_a_dataset_without_augmented_programs_has_no_share(build_folder, tmp_path):
    (tmp_path / "watch.txt").write_text(WATCH)
    options = {"homes_folder": None, "homes": ("maple",), "variants": 0}
    made = build_folder(tmp_path / "out", [tmp_path / "watch.txt"], **options).run_all()
    assert measure(made.out / "publish")["programs"] == {"all": 0, "as_original": 0, "share": None}


SEATED = "Walk television, SwitchOn television, Walk couch, Sit couch, Watch television"
STANDING = "Walk television, SwitchOn television, TurnTo television, Watch television, Walk couch, Sit couch"


@pytest.mark.parametrize(
    ("steps", "seats"),
    [
        (SEATED, ["seated"]),
        (STANDING, ["seated", "otherwise"]),
        (f"{STANDING}, Watch television", ["seated"]),
        (
            f"{SEATED.removesuffix(', Watch television')}, StandUp, TurnTo television, Watch television, Sit couch",
            ["seated", "otherwise"],
        ),
        ("Walk couch, Sit couch", []),
    ],
)
def test_watching_before_sitting_down_is_not_watching_seated(steps, seats, maple):
    assert [what for _, what in _seats(executed(SEATED, maple), executed(steps, maple))] == seats
    assert list(_seats(executed(STANDING, maple), executed(steps, maple))) == [], "nor is the original seated"


def executed(steps: str, home):
    words = (step.split() for step in steps.split(","))
    lines = [f"[{action}]" + "".join(f" <{name}> (1)" for name in names) for action, *names in words]
    program, start = parse_program("\n".join(["Title\n\n", *lines]))[0], World.start(home)
    execution = run(start, bind(program, start).apply(program))
    assert execution.failure is None
    return execution


@given(st.integers(0, 4), st.integers(0, 4), st.data())
def test_the_longest_common_part_is_that_of_all_selections(height, width, data):
    matches = [[data.draw(st.booleans()) for _ in range(width)] for _ in range(height)]
    fits = [
        size
        for size in range(min(height, width) + 1)
        for rows in combinations(range(height), size)
        for columns in combinations(range(width), size)
        if all(matches[row][column] for row, column in zip(rows, columns, strict=True))
    ]
    assert _longest(matches) == max(fits)
