"""Numbers of things are read, in words, tables and JSON; lines that take back their words are refused."""

import pytest

from hearth.commands.inputs import read_programs
from hearth.schemas.syntax import print_step


def read(tmp_path, name, text, knowledge):
    file = tmp_path / name
    file.write_text(text)
    (one,) = read_programs(file, knowledge, name)
    return [print_step(step) for step in one.program.steps], [(fault.line, fault.code.name) for fault in one.faults]


@pytest.mark.parametrize(
    ("name", "text", "steps"),
    [
        ("a.txt", "1. Walk to chair 3\n2. Sit on chair 3\n", ["[Walk] <chair> (3)", "[Sit] <chair> (3)"]),
        (
            "b.txt",
            "1. grab mug #2\n2. put mug #2 on table #4\n",
            ["[Grab] <mug> (2)", "[PutBack] <mug> (2) <table> (4)"],
        ),
        ("c.txt", "take book #7\nopen book #7\n", ["[Grab] <book> (7)", "[Open] <book> (7)"]),
        (
            "d.txt",
            "1. Open the cupboard no. 2\n2. Walk to the kitchen\n",
            ["[Open] <cupboard> (2)", "[Walk] <kitchen> (1)"],
        ),
        (
            "e.csv",
            "id|action|obj|inst\n1|OPEN|cupboard|2\n2|GRAB|glass|3\n",
            ["[Open] <cupboard> (2)", "[Grab] <glass> (3)"],
        ),
        (
            "f.csv",
            "step,action,object,instance\n1,grab,cup,2\n2,open,fridge,1\n",
            ["[Grab] <cup> (2)", "[Open] <fridge> (1)"],
        ),
        (
            "g.csv",
            "step,action,object1,instance1,object2,instance2\n1,grab,cup,2,,\n2,put,cup,2,table,3\n",
            ["[Grab] <cup> (2)", "[PutBack] <cup> (2) <table> (3)"],
        ),
        (
            "h.json",
            '[{"action": "grab", "object": "cup", "instance": 2}, {"action": "open", "object": "fridge"}]',
            ["[Grab] <cup> (2)", "[Open] <fridge> (1)"],
        ),
        (
            "i.csv",
            "plan_id,plan_name,step_no,instruction\n7,Tea,1,Walk to the stove\n7,Tea,2,Grab the pot\n",
            ["[Walk] <stove> (1)", "[Grab] <pot> (1)"],
        ),
        (
            "j.tsv",
            "task\tsteps\nNap\twalk to bedroom | lie on bed | sleep | wake up\n",
            ["[Walk] <bedroom> (1)", "[Lie] <bed> (1)", "[Sleep]", "[WakeUp]"],
        ),
    ],
)
def test_a_number_behind_a_thing_is_its_instance(tmp_path, knowledge, name, text, steps):
    assert read(tmp_path, name, text, knowledge) == (steps, [])


@pytest.mark.parametrize(
    "line",
    [
        "Walk to the sofa, no wait, to the chair",
        "Grab the cup. No, the mug.",
        "Put the book on the shelf. Scratch that, put it on the desk.",
        "Open the fridge - I mean the freezer",
        "Switch on the lamp, never mind",
        "Take the pen, or rather the pencil",
    ],
)
def test_a_line_that_takes_back_its_words_is_refused_whole(tmp_path, knowledge, line):
    text = f"1. Walk to the kitchen\n2. {line}\n3. Sit on the chair\n"
    assert read(tmp_path, "a.txt", text, knowledge) == (
        ["[Walk] <kitchen> (1)", "[Sit] <chair> (1)"],
        [(2, "AMBIGUOUS")],
    )


@pytest.mark.parametrize("line", ["Grab the cup. No need to wash it.", "Wait"])
def test_other_words_with_no_take_nothing_back(tmp_path, knowledge, line):
    steps, faults = read(tmp_path, "a.txt", f"1. Walk to the kitchen\n2. {line}\n", knowledge)
    assert len(steps) == 2 and faults == []
