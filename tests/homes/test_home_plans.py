"""Plans are read whole, and everything wrong with one is said at once, with its line and a remedy."""

import re
from pathlib import Path

import pytest

from hearth.homes.library import graph_of
from hearth.homes.lint import lint
from hearth.homes.plans.layout import read
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

ROOT = Path(__file__).parents[2]
GOLDEN = ROOT / "tests/golden/homes"


def faults_of(text):
    with pytest.raises(HearthError) as caught:
        read(text, "plan.yaml", default())
    return caught.value.diagnostics


def plan(furniture, doors="[]", size="[4, 3]"):
    return (
        f"home: x\nrooms:\n- name: kitchen\n  at: [0, 0]\n  size: {size}\n  furniture:\n"
        + "".join(f"  - {line}\n" for line in furniture)
        + f"doors: {doors}\n"
    )


def test_all_faults_of_a_plan_are_reported_together_with_line_and_remedy():
    text = (GOLDEN / "faulty.yaml").read_text()
    found = "\n".join(map(str, faults_of(text))) + "\n"
    # Refresh after a change that is meant: HEARTH_GOLDEN=1 pytest tests/homes
    assert_golden(GOLDEN / "faulty.txt", found)


def test_the_plan_to_copy_is_a_home_without_a_fault(tmp_path):
    known, page = default(), ROOT / "data_raw/homes/README.md"
    (block,) = re.findall(r"```yaml\n(home: .*?)```", page.read_text("utf-8"), re.DOTALL)
    (tmp_path / "hut.yaml").write_text(block, "utf-8")
    assert not lint(graph_of(tmp_path / "hut.yaml", known), known)


def test_faults_underline_the_words_of_the_plan():
    fault = next(f for f in faults_of((GOLDEN / "faulty.yaml").read_text()) if "frigde" in f.message)
    assert (fault.line, fault.source[fault.column - 1 :]) == (8, "- frigde: {wall: north}")
    assert fault.suggestion == "did you mean `fridge`?"


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("", Code.EMPTY),
        ("- a list", Code.SYNTAX),
        ("home: [", Code.SYNTAX),
        ("home: x\nrooms: {}", Code.SYNTAX),
        ("home: x\nhome: y\nrooms: []", Code.DUPLICATE),
        ("rooms: []", Code.SYNTAX),
        ("home: x\nrooms:\n- name: castle\n  at: [0, 0]\n  size: [2, 2]", Code.UNKNOWN_OBJECT),
        ("home: x\nrooms:\n- name: kitchen\n  at: [0, 0]\n  size: [-2, 2]", Code.SYNTAX),
        (plan(["fridge: {wall: up}"]), Code.SYNTAX),
        (plan(["fridge: {walls: north}"]), Code.SYNTAX),
        (plan(["fridge"]), Code.SYNTAX),
        (plan(["chair*99: {wall: north}"]), Code.SYNTAX),
        (plan(["table: {spot: middle, on: [cup: {wall: north}]}"]), Code.SYNTAX),
        (plan(["fridge: {beside: stove}"]), Code.UNKNOWN_OBJECT),
        (plan(["fridge: {beside: stove}", "stove: {beside: fridge}"]), Code.UNKNOWN_OBJECT),
        (plan(["bed: {wall: north, width: 5}"]), Code.NO_PLACE),
        (plan(["drawing: {wall: north, up: 2.4}"]), Code.NO_PLACE),
        (plan([], "[{between: [kitchen, kitchen]}]"), Code.SYNTAX),
        (plan([], "[{between: [kitchen, outside]}]"), Code.SYNTAX),
        (plan(["table: {corner: southwest}"], "[{between: [kitchen, outside], wall: south, at: 0.2}]"), Code.NO_PLACE),
    ],
)
def test_each_mistake_has_its_code(text, code):
    assert code in {fault.code for fault in faults_of(text)}


@pytest.mark.parametrize(
    ("text", "named"),
    [
        (plan([], size="[900, 3]"), "over 100 m"),
        (plan([]).replace("- name", "- {name: far, class: bedroom, at: [0, 700], size: [3, 3]}\n- name"), "100 m"),
        (plan([f"bench: {{wall: west, on: [{', '.join(['cup'] * 1_000)}]}}"]), "over 1,000 entries"),
        (plan([]).replace("doors", "- {name: hall, at: [9, 9], size: [3, 3]}\n" * 60 + "doors"), "61 rooms"),
    ],
)
def test_a_plan_of_absurd_size_is_refused_before_it_is_arranged(text, named):
    (fault,) = faults_of(text)
    assert fault.code is Code.FILE_TOO_LARGE and named in fault.message


HALL = "- {name: hall, class: bedroom, at: [4, 0], size: [3, 3]}\n"


@pytest.mark.parametrize(
    ("door", "height", "named"),
    [
        ("between: [kitchen, hall]", 2.0, "do not fit into walls of 2 m"),
        ("between: [kitchen, outside], wall: east", 2.5, "leads into a wall of hall"),
        ("between: [kitchen, hall], into: kitchn", 2.5, "opens into `kitchn`"),
        ("between: [kitchen, outside], wall: west, into: outside", 2.5, "opens into `outside`"),
    ],
)
def test_doors_fit_under_the_ceiling_and_lead_and_open_where_there_is_room(door, height, named):
    text = plan([], f"[{{{door}}}, {{between: [kitchen, hall], at: 0.1}}]").replace("doors", HALL + "doors")
    found = [fault for fault in faults_of(f"height: {height}\n{text}") if named in fault.message]
    assert len(found) == 1 and found[0].line > 1 and found[0].suggestion


def test_furniture_may_not_wall_in_other_furniture():
    walled = ["fridge: {corner: southwest}", "table: {spot: [1.0, 1.45], width: 2.0, depth: 1.0}",
              "bookshelf: {spot: [1.2, 0.5], width: 0.8, facing: west}"]  # fmt: skip
    assert any("nobody can get to the front of `fridge.1`" in fault.message for fault in faults_of(plan(walled)))


def test_a_room_without_a_door_is_named():
    text = plan([]) + ""
    text = text.replace("doors: []", "- name: bedroom\n  at: [4, 0]\n  size: [3, 3]\ndoors: []")
    (fault,) = faults_of(text)
    assert (fault.code, fault.line) == (Code.NO_PATH, 7)
    assert "between: [kitchen, bedroom]" in fault.suggestion


def assert_golden(path, found):
    import os

    if os.environ.get("HEARTH_GOLDEN"):
        path.write_text(found)
    assert found == path.read_text()
