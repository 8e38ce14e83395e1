"""Splits: what is nearly the same stays on one side, and the measure of leakage finds what does not."""

from __future__ import annotations

from unittest import mock

import numpy as np
import orjson
import pytest

import hearth
from hearth.datasets.format.split_columns import PARTS, SplitProgram, SplitPrograms
from hearth.datasets.format.split_runs import Runs
from hearth.datasets.format.split_summary import leakage, summary
from hearth.datasets.format.splits import RULES, SplitRows, by_activity, groups, part_name
from hearth.pipelines.engine import split_assignment
from hearth.pipelines.engine.split_assignment import _steps as steps_read
from hearth.pipelines.engine.split_assignment import assignment
from hearth.storage.partitions import read_rows

LONG = "take the milk out of the fridge and put it on the table"


def program(name, steps="a b c d", text="", part="train", root=None):
    return SplitProgram(name, name, part, root, tuple(steps.split()), text)


def named(programs, places):
    """Return the values of a column by program, with places as ids."""
    found = zip(programs.ids, places.tolist(), programs.known.tolist(), strict=True)
    return {name: programs.ids[place] for name, place, known in found if known}


def test_siblings_and_near_duplicates_are_one_group():
    programs = [
        program("p1", "a b c d e f g h i j"),
        program("p1+1", "z z z", root="p1"),
        program("p2", "a b c d e f g h i k"),
        program("p3", "q r s", LONG),
        program("p4", "t u v", LONG.upper() + " "),
        program("p5", "w x y", "Watch TV."),
        program("p6", "l m n", "Watch TV."),
    ]
    found = named(known := SplitPrograms.of(programs), groups(known))
    assert found == {"p1": "p1", "p1+1": "p1", "p2": "p1", "p3": "p3", "p4": "p3", "p5": "p5", "p6": "p6"}


def test_grandchildren_belong_to_the_original():
    known = SplitPrograms.of([program("c", root="b"), program("a"), program("b", root="a"), program("e", root="0")])
    assert named(known, known.root) == {"a": "a", "b": "a", "c": "a", "e": "0"}
    with pytest.raises(KeyError):
        known.place("d")


def test_nearness_is_that_of_the_longer_program():
    programs = [
        program("p1", "a b c d e f g h i j"),
        program("p2", "a b c d e f g h i"),
        program("p3", "a b c d e f g h"),
    ]
    known = SplitPrograms.of(programs)
    like = [known.steps.among(known.steps.around([place]), [0, 1, 2]).tolist() for place in range(3)]
    assert like == [[True, True, False], [True, True, False], [False, False, True]]
    assert not known.texts.among(known.texts.around([0, 1, 2]), [0, 1, 2]).any()


def test_leakage_is_counted_by_kind():
    train = [program("p1", "a b c", LONG), program("p2", "d e f", "Something of quite another kind.")]
    test = [
        program("p1+1", "x", root="p1"),
        program("p3", "a b c"),
        program("p4", "u v w", LONG + "."),
        program("p5", "r s t"),
    ]
    known = SplitPrograms.of([*train, *test])
    places = [np.array([known.place(each.program_id) for each in part]) for part in (train, test)]
    assert leakage(known, *places) == {"programs": 4, "siblings": 1, "steps": 1, "texts": 1}


def many():
    programs, runs = rows_of_many()
    known = SplitPrograms.of(programs)
    return known, Runs(known, runs)


def rows_of_many():
    programs, runs = [], []
    for number in range(60):
        part = PARTS[2 - number % 3] if number % 10 else "train"
        name = f"p{number:02}"
        steps = f"s{number // 2} t{number // 2} u"
        programs += [program(name, steps, part=part), program(f"{name}+1", f"w{number}", part=part, root=name)]
        runs += [(f"{each}@h{home}", each, f"h{home}") for each in (name, f"{name}+1") for home in range(1, 8)]
    return programs, runs


def test_no_split_leaks_where_random_rows_would():
    programs, runs = many()
    rows = SplitRows(programs, runs, 3)
    assert len(list(rows)) == len(RULES) * len(list(runs))
    found = summary(programs, runs, rows, 3)["splits"]
    for split in found.values():
        assert split["leakage"]["programs"] > 0
        assert {split["leakage"][kind] for kind in ("siblings", "steps", "texts")} == {0}
        assert split["at_random"]["siblings"] > 0


def test_homes_are_where_the_rules_say():
    programs, runs = many()
    home = {execution_id: int(name[1:]) for execution_id, _, name in runs}
    found = {}
    for row in SplitRows(programs, runs, 3):
        found.setdefault((row["split"], row["part"]), set()).add(home[row["execution_id"]])
    assert found["homes_1_4", "train"] == found["homes_1_4", "test_seen"] == {1, 2, 3, 4}
    assert (found["homes_1_4", "validation"], found["homes_1_4", "test_unseen"]) == ({5}, {5, 6})
    assert found["activities", "train"] == found["activities", "test"] == {*range(1, 8)}
    assert (found["homes_1_5", "train"], found["homes_1_5", "test"]) == ({1, 2, 3, 4, 5}, {6, 7})
    (out,) = found["held_out_home", "test_held_out_home"]
    for part in ("train", "validation", "test_seen_home"):
        assert found["held_out_home", part] == {*range(1, 8)} - {out}


def test_a_source_s_own_splits_are_those_of_originals_and_their_descendants():
    programs, runs = many()
    own = {"p00": {"pairs": "test"}, "p01": {"pairs": None}}
    rows = SplitRows(programs, runs, 3, own)
    found = {(row["program_id"], row["part"]) for row in rows if row["split"] == "pairs"}
    assert found == {("p00", "test"), ("p00+1", "test"), ("p01", None), ("p01+1", None)}
    about = summary(programs, runs, rows, 3)["splits"]["pairs"]
    assert about["programs"] == {"test": 2} and about["runs_without_part"] == 14 and "its source" in about["rule"]


def test_homes_are_named():
    programs, runs = many()
    found = summary(programs, runs, SplitRows(programs, runs, 3), 3)
    assert found["homes"] == [f"h{number}" for number in range(1, 8)] and found["held_out"] in found["homes"]
    assert "homes 1-5 (h1, h2, h3, h4, h5), tested in 6-7 (h6, h7)" in found["splits"]["homes_1_5"]["rule"]
    assert found["held_out"] in found["splits"]["held_out_home"]["rule"]


def test_a_program_has_one_part_wherever_it_runs_unless_a_split_is_by_execution():
    programs, runs = many()
    found = {}
    for row in SplitRows(programs, runs, 3):
        found.setdefault(row["split"], {}).setdefault(row["program_id"], set()).add(row["part"])
    several = {split for split, of in found.items() if any(len(each - {None}) > 1 for each in of.values())}
    assert several == {"held_out_home"} == {split for split, rule in RULES.items() if rule.startswith("by execution")}


def test_of_near_duplicates_those_in_the_latest_part_stay():
    programs = [
        program("p1", "a b c d e f g h i j", part="train"),
        program("p1+1", "z", part="train", root="p1"),
        program("p2", "a b c d e f g h i k", part="validation"),
        program("p3", "a b c d e f g h i l", part="test"),
        program("p4", "q r s", part="train"),
        program("p5", "t u v", part="validation"),
    ]
    known = SplitPrograms.of(programs)
    found = dict(zip(known.ids, map(part_name, by_activity(known, groups(known))), strict=True))
    assert found == {"p1": None, "p1+1": None, "p2": None, "p3": "test", "p4": "train", "p5": "validation"}


def test_the_deal_does_not_depend_on_order():
    programs, runs = rows_of_many()
    one, other = SplitPrograms.of(programs), SplitPrograms.of(programs[::-1])
    first, second = SplitRows(one, Runs(one, runs), 3), SplitRows(other, Runs(other, runs[::-1]), 3)
    assert list(first) == list(second)


def test_steps_read_by_columns_are_those_of_the_rows(made):
    files = [path for stage in ("augment", "sample") for path in (made.out / stage).glob("part-*.parquet")]
    known, letters = assignment(files, made.settings.seed), {}
    with mock.patch.object(split_assignment, "_steps", lambda steps, _: steps_read(steps, letters)):
        rows = list(split_assignment.programs_of(files, made.settings.seed))
    texts = {letter: text for text, letter in letters.items()}
    found = {each.program_id: [texts[letter] for letter in each.steps] for each in rows}
    assert found.keys() == {*known.programs.ids} and known.programs.known.all()
    for row in hearth.load(made.out).sql("SELECT program_id, split, steps FROM programs").to_arrow_table().to_pylist():
        names = [" ".join((step["action"], *(ref["name"] for ref in step["objects"]))) for step in row["steps"]]
        assert [step.strip() for step in found.pop(row["program_id"])] == names
        assert row["split"] == known.part_of(row["program_id"])
    assert not found


@pytest.fixture(scope="module")
def ds(made):
    return hearth.load(made.out)


def test_every_run_has_its_part_in_every_split(ds):
    _, found = ds.rows("SELECT count(*), count(DISTINCT execution_id), count(DISTINCT split) FROM splits")
    runs = ds.rows("SELECT count(*) FROM executions WHERE executable")[1][0][0]
    assert found == [(len(RULES) * runs, runs, len(RULES))]


def test_programs_split_is_the_part_by_activity_and_that_of_its_file(ds):
    query = """SELECT count(*) FROM splits s JOIN programs p USING (program_id)
        WHERE s.split = 'activities' AND s.part IS DISTINCT FROM p.split"""
    assert ds.rows(query)[1] == [(0,)]
    for path in (ds.folder / "programs").glob("*.parquet"):
        share = path.name.split(".")[1]
        found = {row["split"] for row in read_rows(path, ["split"])}
        assert found <= {None if share == "left_out" else share}


def test_leakage_is_published(ds):
    program = orjson.loads((ds.folder / "splits.json").read_bytes())
    assert set(program["splits"]) == set(RULES)
    assert all(split["leakage"]["siblings"] == 0 for split in program["splits"].values())
