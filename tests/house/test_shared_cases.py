"""Small inputs that failed once, kept beside the real data: each is read as meant, or refused with its reason."""

import os
from pathlib import Path

import pytest

from hearth.commands.inputs import read_programs
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.syntax import print_step
from hearth.scoring.line_sequences import read as read_lines
from hearth.storage.rejects import Reject

ROOT = Path(__file__).resolve().parents[2]
REAL = Path(os.environ.get("HEARTH_REAL_DATA", ROOT.parent / "shared/real"))
CASES = REAL.parent / "cases"

FRIDGE = ["Walk fridge", "Open fridge", "Grab milk"]
KITCHEN = ["Walk kitchen", "Open fridge", "Grab milk"]
WASHING = ["Walk washing_machine", "Open washing_machine"]

STEPS: dict[str, list[list[str]]] = {
    "01": [
        [*WASHING, "PutIn clothes_jacket washing_machine", "PutIn soap washing_machine", "Close washing_machine",
         "SwitchOn washing_machine"]
    ],
    "02": [[*FRIDGE, "Close fridge"]],
    "04": [FRIDGE],
    "09": [["Walk fridge"]],
    "11": [[]],
    "14": [[*KITCHEN, "Close fridge"]],
    "15": [FRIDGE],
    "19": [[*FRIDGE, "Close fridge"]],
    "22": [["Walk kitchen", "Find sink", "Find fork"]],
    "26": [["Walk shower"]],
    "52": [["Walk fridge", "Open fridge", "Walk milk", "Grab milk"], FRIDGE],
    "52b": [["Walk light", "SwitchOn light", "Walk floor_lamp", "SwitchOn floor_lamp"]],
    "61": [
        ["Walk kitchen", "Find garbage_can", "Find lime", "Grab lime", "Find garbage_can", "Open garbage_can",
         "PutIn lime garbage_can", "Close garbage_can"]
    ],
    "62": [KITCHEN],
    "64": [["Walk kitchen", "Find sink", "Grab fork"]],
    "65": [["Walk sofa", "Find sofa", "Sit sofa"], ["Walk novel", "Grab novel", "Read novel"]],
    "67": [["Wipe table", "PutIn food_egg garbage_can", "PutIn clothes_pile washing_machine"]],
    "68": [
        ["Grab mug", "Grab milk", "Grab cup", "SwitchOn light", "Close fridge", "Walk kitchen", "Open fridge",
         "PutBack cup table", "Walk kitchen_counter"]
    ],
    "70": [[*FRIDGE, "PutBack milk table"]],
    "70b": [["Open fridge", "Grab milk"]],
    "77": [["Walk bathroom", "Find washing_machine", "Open washing_machine"]],
}  # fmt: skip
"""The steps of each program of a case; a case without a program is refused."""


def case(number: str) -> Path:
    found = [file for file in CASES.glob(f"{number}-*") if not file.name.endswith(".expected.txt")]
    if not found:
        pytest.skip(f"no case {number} in {CASES} (they lie beside the folder HEARTH_REAL_DATA)")
    return found[0]


def programs(file: Path, knowledge) -> tuple[list[list[str]], list[int], list[str]]:
    """Return the steps of each program without instances, the lines of faults, and the titles."""
    steps, faults, titles = [], [], []
    try:
        for each in read_programs(file, knowledge, file.name):
            faults += [fault.line for fault in (each.diagnostics if isinstance(each, Reject) else each.faults)]
            if not isinstance(each, Reject):
                steps.append(
                    [" ".join([step.action, *(ref.name for ref in step.objects)]) for step in each.program.steps]
                )
                titles.append(each.program.title)
    except HearthError as error:
        faults += [fault.line for fault in error.diagnostics]
    return steps, faults, titles


@pytest.mark.parametrize("number", STEPS)
def test_a_case_is_read_as_meant(number, knowledge):
    steps, faults, _ = programs(case(number), knowledge)
    assert steps == STEPS[number] and (faults or number != "11")


def test_a_plan_of_saycan_on_one_line_has_its_steps_and_an_end(knowledge):
    ((*steps,),), faults, _ = programs(case("12"), knowledge)
    assert (len(steps), steps[0], steps[-1], faults) == (10, "Walk kitchen", "PutBack plate table", [3])


def test_lines_of_real_plans_are_not_read_as_something_else(knowledge):
    steps, faults, _ = programs(case("23"), knowledge)
    assert steps == [["Cut tomato"]] and faults == [1, 2, 3, 5, 6, 7]


def test_a_comment_behind_a_step_is_read_over(knowledge):
    steps, faults, titles = programs(case("71"), knowledge)
    assert (len(steps[0]), faults, titles) == (3, [], ["Get milk"])


def test_words_of_another_benchmark_are_refused_or_known(knowledge):
    steps, faults, _ = programs(case("76"), knowledge)
    assert steps[0] == ["Find book", "Grab book", "Find garbage_can"] and set(faults) == {1, 2}
    assert not any("fan" in step.split() or step.startswith("Touch") for each in steps for step in each)


def test_a_plan_of_a_planner_never_walks_to_its_character(knowledge):
    steps, faults, _ = programs(case("80"), knowledge)
    assert steps == [[*WASHING, "Grab soap"], ["Walk shower", "Walk dish_soap"]] and not faults


def test_score_reads_what_check_reads(knowledge):
    import json

    for row in map(json.loads, case("17").read_text(encoding="utf-8").splitlines()):
        if isinstance(row["predicted"], str):
            assert len(read_lines(row["predicted"])) == 4, row["id"]


def test_a_step_without_an_instance_is_of_instance_one():
    import json

    rows = map(json.loads, case("20").read_text(encoding="utf-8").splitlines())
    written = [[print_step(step) for step in read_lines(row["predicted"])] for row in rows]
    assert written == [["[plugin] <phone> (1)"], ["[plugin] <phone> (1)"], ["[walk] <phone> (1)", "[grab] <phone> (1)"]]
