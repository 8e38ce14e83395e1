"""Facts proposed from programs, and the comparison with other knowledge, on tiny inputs."""

from __future__ import annotations

import json

import pytest

from hearth.datasets.published_programs import programs
from hearth.kb.tools.compare import compare
from hearth.kb.tools.fact_mining import as_lines, mine
from hearth.schemas.diagnostics import HearthError

READ = [
    ("Walk", ["bedroom"]),
    ("Find", ["glasses"]),
    ("Grab", ["spectacles"]),
    ("Grab", ["novel"]),
    ("Read", ["novel"]),
]
BED = [("Walk", ["bed"]), ("Lie", ["bed"]), ("SwitchOff", ["tablelamp"]), ("Sleep", [])]
COOK = [("Open", ["oven"]), ("Grab", ["shoes"]), ("PutIn", ["shoes", "oven"]), ("Close", ["oven"])]
WASH = [("Grab", ["cup"]), ("Wash", ["cup"]), ("PutBack", ["cup", "stove"]), ("Fly", ["cup"]), ("Wash", ["ufo"])]


def proposed(steps, knowledge, **options):
    found = mine(steps, knowledge, **{"least": 3, "confidence": 0.3, **options})
    return {(p.kind, p.subject, p.relation, p.other): p for p in found}


def test_what_is_used_together_near_placed_found_and_in_which_order(knowledge):
    found = proposed([READ, BED, COOK, WASH] * 3, knowledge)
    pair = found["together", "novel", "goes_with", "spectacles"]
    assert (pair.seen, pair.confidence, pair.lift, pair.known) == (3, 1.0, 4.0, True)
    assert found["serves", "spectacles", "serves", "Read"].known
    assert found["near", "tablelamp", "NEARBY", "bed"].known is False
    assert found["placed", "shoes", "IN", "oven"].known is False
    assert found["placed", "cup", "ON", "stove"].known
    assert found["found", "spectacles", "found_in", "bedroom"].known
    assert found["order", "Grab", "before", "Wash"].confidence == 1.0


def test_rare_and_doubtful_facts_are_not_proposed(knowledge):
    assert proposed([READ] * 2, knowledge) == {}
    assert ("placed", "cup", "ON", "stove") not in proposed([WASH] * 3 + [COOK] * 3, knowledge, confidence=1.1)


def test_unknown_names_are_left_out(knowledge):
    assert not any("ufo" in key or "Fly" in key for key in proposed([WASH] * 3, knowledge))


def test_only_new_facts_become_lines(knowledge):
    lines = as_lines(mine([READ, BED, COOK, WASH] * 3, knowledge))
    assert lines["placements.csv"] == ["shoes,IN,oven,,5,mined", "tablelamp,NEARBY,bed,,5,mined"]
    assert not any("spectacles" in line for line in lines.get("associations.csv", ()))


def test_programs_of_a_dataset_are_read_augmented_ones_aside(tmp_path):
    import pyarrow as pa
    import pyarrow.parquet as pq

    steps = [[{"action": "Grab", "objects": [{"name": "cup", "instance": 1}]}, {"action": "Sleep", "objects": None}]]
    table = pa.table({"steps": steps * 2, "origin": ["crowd", "augmented"]})
    pq.write_table(table, tmp_path / "programs.parquet")
    expected = [[("Grab", ("cup",)), ("Sleep", ())]]
    assert list(programs(tmp_path)) == expected
    assert list(programs(tmp_path / "programs.parquet")) == expected
    (tmp_path / "publish/programs").mkdir(parents=True)
    (tmp_path / "programs.parquet").rename(tmp_path / "publish/programs/part-00000.parquet")
    assert list(programs(tmp_path)) == expected


def test_a_folder_without_programs_is_bad_input(tmp_path):
    with pytest.raises(HearthError, match="no programs table"):
        list(programs(tmp_path))
    (tmp_path / "programs.parquet").write_bytes(b"PAR1")
    with pytest.raises(HearthError, match="not a table of programs"):
        list(programs(tmp_path))


def test_programs_are_read_where_statistics_of_sizes_are_damaged(tmp_path):
    """A filter of `pyarrow.dataset` over such a file ends the process."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    path = tmp_path / "programs.parquet"
    steps = [[{"action": "Grab", "objects": [{"name": "cup", "instance": 1}]}]]
    pq.write_table(pa.table({"steps": steps, "origin": ["crowd"]}), path)
    texts, truths = b"\x15\x0c\x19", b"\x15\x00\x19"  # the type of a column's part, and its encodings
    assert texts in path.read_bytes()
    path.write_bytes(path.read_bytes().replace(texts, truths))
    assert list(programs(path)) == [[("Grab", ("cup",))]]


def test_the_comparison_tells_held_corrected_and_missing_facts_apart(knowledge, tmp_path):
    write = {
        "properties_data.json": {"cup": ["GRABBABLE", "EATABLE"], "sofa": ["SITTABLE"], "teeth": []},
        "object_states.json": {"food_vegetable": ["eatable", "uncooked"], "computer": ["plugged"]},
        "object_script_placing.json": {
            "hair": [{"destination": "sofa", "relation": "ON", "room": "null"}],
            "milk": [{"destination": "fridge", "relation": "IN", "room": "null"}],
            "mat": [{"destination": "mat", "relation": "ON", "room": "null"}],
        },
        "class_name_equivalence.json": {"couch": ["sofa"], "cup": ["chalice"]},
        "affordances.json": {"affordances": {"Eat": {"object1": ["Cup", "Food_Donut"], "object2": []}}},
    }
    for name, data in write.items():
        (tmp_path / name).write_text(json.dumps(data))
    found = compare(knowledge, tmp_path)
    missing = {(d.table, *d.fact): bool(d.why) for d in found.differences if d.kind == "missing"}
    assert missing == {
        ("properties", "cup", "EATABLE"): False,
        ("states", "food_vegetable", "EATABLE"): True,
        ("placements", "hair", "ON", "couch"): True,
        ("placements", "mat", "ON", "mat"): True,
        ("synonyms", "cup", "chalice"): False,
    }
    assert found.theirs["properties"] == 3 and found.held["properties"] == 2
    assert found.cells == {"0": {"rule": 2, "exception": 0, "refused": 0}}


def test_ours_does_not_differ_from_itself(knowledge):
    from pathlib import Path

    import hearth.kb

    assert compare(knowledge, Path(hearth.kb.__file__).parent / "data").differences == ()


def test_what_is_not_the_release_is_bad_input(knowledge, tmp_path):
    (tmp_path / "properties_data.json").write_text("[1]")
    with pytest.raises(HearthError, match="not the release's file"):
        compare(knowledge, tmp_path)


def test_a_room_that_stands_in_for_another_is_no_place(knowledge):
    served = [("Walk", ["dining_room"]), ("Open", ["dishwasher"]), ("Touch", ["washing_machine"]), ("Grab", ["cup"])]
    found = proposed([served] * 3, knowledge)
    assert [key[1] for key in found if key[0] == "found"] == ["cup"]
    named = [("Walk", ["kitchen"]), ("Grab", ["cup"])]
    found = proposed([served, named] * 3, knowledge)
    assert {key[1:] for key in found if key[0] == "found"} == {
        ("cup", "found_in", "dining_room"), ("cup", "found_in", "kitchen"),
        ("washing_machine", "found_in", "dining_room"),
    }  # fmt: skip
