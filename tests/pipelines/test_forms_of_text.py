"""The forms that a text's steps are written in: check and score read the same, and no record takes another's."""

import pytest

from hearth.kb.language.forms.form_registry import FORMS, form_of
from hearth.kb.language.numbered_steps import parse_steps
from hearth.pipelines.engine.source_labels import labelled
from hearth.pipelines.ingest import items, read
from hearth.pipelines.validate import checked
from hearth.schemas.syntax import print_lines
from hearth.scoring import line_sequences
from hearth.scoring.line_reader import LineReader

MILK = ["[Walk] <fridge> (1)", "[Open] <fridge> (1)", "[Grab] <milk> (1)", "[Close] <fridge> (1)"]
BOOK = ["[Grab] <novel> (1)", "[Read] <novel> (1)"]


def programs(write, knowledge, text, name="a.txt"):
    """Title, steps, faults and warnings of each program of a file."""
    found = []
    for _, item in items(labelled([str(write(name, text))])):
        for row in read(item):
            check = checked if row["origin"] == "text" else parse_steps
            program, faults, warnings = check(row["text"], row["line"], name, knowledge)
            places = [(fault.code, fault.line) for fault in faults]
            found.append((row["title"], list(print_lines(program)), places, [each.code for each in warnings]))
    return found


MILK_TEXTS = {
    "from zero": "0. Walk to fridge\n1. Open fridge\n2. Grab milk\n3. Close fridge\n",
    "from zero in parentheses": "(0) Walk to fridge\n(1) Open fridge\n(2) Grab milk\n(3) Close fridge\n",
    "step zero": "Task: milk\nStep 0: Walk to fridge\nStep 1: Open fridge\nStep 2: Grab milk\nStep 3: Close fridge\n",
    "steps from zero, bold": "**Step 0:** Walk to fridge\n**Step 1:** Open fridge\n2. Grab milk\n3. Close fridge\n",
    "letters": "a. Walk to fridge\nb. Open fridge\nc. Grab milk\nd. Close fridge\n",
    "letters in parentheses": "a) Walk to fridge\nb) Open fridge\nc) Grab milk\nd) Close fridge\n",
    "roman": "i. Walk to fridge\nii. Open fridge\niii. Grab milk\niv. Close fridge\n",
    "numbers in brackets": "[1] Walk to fridge\n[2] Open fridge\n[3] Grab milk\n[4] Close fridge\n",
    "decimals": "1.1 Walk to fridge\n1.2 Open fridge\n1.3 Grab milk\n1.4 Close fridge\n",
    "checkboxes": "- [ ] Walk to fridge\n- [x] Open fridge\n- [ ] Grab milk\n- [ ] Close fridge\n",
    "keycaps": (
        "1\ufe0f\u20e3 Walk to fridge\n2\ufe0f\u20e3 Open fridge\n3\ufe0f\u20e3 Grab milk\n4\ufe0f\u20e3 Close fridge\n"
    ),
    "Windows, BOM": "\ufeff1. Walk to fridge\r\n2. Open fridge\r\n3. Grab milk\r\n4. Close fridge\r\n",
    "one line": "Plan: 1. walk to fridge  2. open fridge 3. grab milk 4. close fridge 5. Done\n",
    "one line, explained": (
        "Explanation: I need milk.\n\nPlan: 1. walk to fridge 2. open fridge 3. grab milk 4. close fridge\n"
    ),
    "one line from zero": "0. Walk to fridge 1. Open fridge 2. Grab milk 3. Close fridge 4. done task.\n",
    "arrows": "Task: milk\nWalk to fridge -> open fridge → grab milk => close fridge\n",
    "semicolons": "1. Walk to fridge; open fridge\n2. Grab milk; close fridge\n3. END\n",
    "items below a heading step": (
        "1. Walk to the fridge:\n   - Open the fridge\n   - Grab the milk\n2. Close the fridge\n"
    ),
    "letters below": "1. Walk to the fridge\n   a. Open the fridge\n   b. Grab the milk\n2. Close the fridge\n",
    "decimals below": "1. Walk to the fridge\n   1.1 Open the fridge\n   1.2 Grab the milk\n2. Close the fridge\n",
    "a continuation": "1. Walk to the fridge\n   Open the fridge\n2. Grab the milk\n3. Close the fridge\n",
    "a line without a number": "1. Walk to fridge\nOpen fridge\n3. Grab milk\n4. Close fridge\n",
    "two lines without": "1. Walk to fridge\nOpen fridge\nGrab milk\n4. Close fridge\n",
    "the last without": "1. Walk to fridge\n2. Open fridge\n3. Grab milk\nClose fridge\n",
    "a fence": "```\n1. Walk to fridge\n2. Open fridge\n3. Grab milk\n4. Close fridge\n```\n",
    "calls in a fence": "```python\n# Step 1: go\nwalk('fridge')\nopen(\"fridge\")\ngrab(milk)\nclose('fridge')\n```\n",
    "calls of a robot": (
        'robot.walk("fridge")\nrobot.open("fridge")\nrobot.grab("milk")  # cold\nrobot.close("fridge")\n'
    ),
    "a function": (
        "def get_milk():\n\t# 0: go\n\twalk('fridge')\n\topen('fridge')\n"
        "\tgrab('milk')\n\tclose('fridge')\n\t# 1: Done\n"
    ),
    "ReAct": (
        "Thought: go\nAct 1: walk to fridge\nObs 1: ok\nAct 2: open fridge\nAct 3: grab milk\nAct 4: close fridge\n"
    ),
    "Action:": (
        "Thought: x\nAction: Walk to fridge\nAction: open fridge\n"
        "Action: grab milk\nAction: close fridge\nAction: finish\n"
    ),
    "ALFWorld": "> go to fridge 1\nYou see it.\n> open fridge 1\nok\n> take milk 1 from fridge 1\n> close fridge 1\n",
    "ALFWorld, numbered": "1. go to fridge 1\n2. open fridge 1\n3. take milk 1 from fridge 1\n4. close fridge 1\n",
    "PDDL": (
        "(walk_towards character fridge)\n(open character fridge)\n(grab character milk)\n(close character fridge)\n"
    ),
    "PDDL with times": (
        "0: (walk_towards robot fridge) ; far\n1: (open robot fridge)\n2: (grab robot milk)\n3: (close robot fridge)\n"
    ),
    "PDDL without parentheses": (
        "walk_towards character fridge\nopen character fridge\ngrab character milk\nclose character fridge\n"
    ),
    "a table": (
        "| Step | Action |\n|---|---|\n| 1 | Walk to fridge |\n"
        "| 2 | Open fridge |\n| 3 | Grab milk |\n| 4 | Close fridge |\n"
    ),
    "thoughts": (
        "<think>\nI should open the door.\n</think>\n[Walk] <fridge> (1)\n"
        "[Open] <fridge> (1)\n[Grab] <milk> (1)\n[Close] <fridge> (1)\n"
    ),
    "printed": "[WALK] <fridge> (1) [0]\n[OPEN] <fridge> (1) [1]\n[GRAB] <milk> (1) [2]\n[CLOSE] <fridge> (1) [3]\n",
    "comments": (
        "T\n\n\n[WALK] <fridge> (1) # go\n"
        "[OPEN] <fridge> (1)   // may be open\n[GRAB] <milk> (1)\n[CLOSE] <fridge> (1)#\n"
    ),
    "no instances": "T\n\n\n[walk]<fridge>\n[open] <fridge>\n[grab] <milk>\n[close] <fridge> [3]\n",
    "agents": (
        "<char0> [walk] <fridge> (1)\n<char0> [open] <fridge> (1)\n"
        "<char0> [grab] <milk> (1)\n<char0> [close] <fridge>\n"
    ),
}


@pytest.mark.parametrize("text", MILK_TEXTS.values(), ids=MILK_TEXTS)
def test_the_same_steps_in_every_form_for_check_and_score(write, knowledge, text):
    ((_, steps, faults, _),) = programs(write, knowledge, text)
    assert (steps, faults) == (MILK, [])
    scored = line_sequences.read(text.removeprefix("\ufeff"), LineReader(knowledge))
    assert [step.action.lower() for step in line_sequences.steps_of(scored)] == ["walk", "open", "grab", "close"]


@pytest.mark.parametrize(
    ("text", "titles"),
    [
        ("Task: Tea\nBoil water and wait.\n\nTask: Novel\n1. Grab the novel\n2. Read the novel\n", ["Tea", "Novel"]),
        ("## Task 1: Tea\nBoil it.\n\n## Task 2: Novel\n1. Grab novel\n2. Read novel\n", ["Tea", "Novel"]),
        ("Tea\nBoil water, then wait.\n\n---\n\nNovel\n1. Grab novel\n2. Read novel\n", ["Tea", "Novel"]),
        ("## Tea\n## Novel\n- Grab novel\n- Read novel\n", ["Tea", "Novel"]),
        ("Task 7 - Tea\n\nTask 8 - Novel\n1) Grab novel\n2) Read novel\n", ["Tea", "Novel"]),
        ("Task: Tea\n\nTask: Novel\n[Grab] <novel> (1)\n[Read] <novel> (1)\n", ["Task: Tea", "Task: Novel"]),
        (
            ("[Goal] Tea.\n\n[Goal] Novel.\n[Step 1] grab novel.\n[Step 2] read novel.\n[Step 3] done task.\n"),
            ["Tea", "Novel"],
        ),
        ("Task: Tea\n\nTask: Novel\nThought: go\nAct: grab novel\nAct: read novel\n", ["Tea", "Novel"]),
        ("def tea():\n\t# later\ndef novel():\n\tgrab('novel')\n\tread('novel')\n", ["tea", "novel"]),
    ],
)
def test_a_record_without_steps_gives_nothing_to_its_neighbor(write, knowledge, text, titles):
    (empty, full) = programs(write, knowledge, text)
    assert [empty[0], full[0]] == titles
    assert empty[1] == [] and [code for code, _ in empty[2]] == ["EMPTY"]
    assert full[1:3] == (BOOK, [])


def test_a_record_without_steps_below_one_with_steps(write, knowledge):
    text = "# Nap\n1. Walk to bed\n2. Sleep\n\n# Tea\nBoil it.\n\n# Novel\n1. Grab novel\n2. Read novel\n"
    found = programs(write, knowledge, text)
    assert [(title, len(steps)) for title, steps, _, _ in found] == [("Nap", 2), ("Tea", 0), ("Novel", 2)]


def test_blocks_of_say_can_pay(write, knowledge):
    text = (
        "[Scene] 7\n[Goal] sit.\n[Description] go, sit.\n[Step 1] walk sofa.\n"
        "[Step 2] sit sofa.\n[Step 3] done task.\n\n"
        "[Scene] 2\n[Goal] read.\n[Step 1] grab novel.\n[Step 2] read novel.\n"
    )
    first, second = programs(write, knowledge, text)
    assert first[:3] == ("sit", ["[Walk] <sofa> (1)", "[Sit] <sofa> (1)"], [])
    assert second[:3] == ("read", BOOK, [])


def test_asserts_of_prog_prompt_are_counted_and_what_they_bring_about_is_a_step(write, knowledge):
    text = (
        "def drop_lime():\n\tgrab('lime')\n\tassert('close' to 'garbagecan')\n\t\telse: find('garbagecan')\n"
        "\tassert('garbagecan' is 'opened')\n\t\telse: open('garbagecan')\n\tputin('lime', 'garbagecan')\n"
    )
    ((title, steps, faults, warnings),) = programs(write, knowledge, text, "plan.py")
    assert (title, faults, warnings) == ("drop lime", [], ["NO_STEP"])
    assert steps == ["[Grab] <lime> (1)", "[Open] <garbage_can> (1)", "[PutIn] <lime> (1) <garbage_can> (1)"]


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("walk('bed')\nfly('bed')\n", ("UNKNOWN_ACTION", 2)),
        ("(walk_towards character bed)\n(teleport character bed)\n", ("UNKNOWN_ACTION", 2)),
        ("> go to bed 1\nok\n> heat egg 1 with stoveburner 1\n", ("UNKNOWN_ACTION", 3)),
        ("Act: walk to bed\nAct: ponder zen\nObs: hm\n", ("NOT_UNDERSTOOD", 2)),
        ("1. Walk to bed\nPonder zen\n2. Sleep\n", ("NOT_UNDERSTOOD", 2)),
        ("Plan: 1. walk to bed 2. ponder zen 3. sleep\n", ("NOT_UNDERSTOOD", 1)),
        ("walk(1 + 2)\nsleep()\n", ("NOT_UNDERSTOOD", 1)),
    ],
)
def test_what_no_form_means_is_a_fault_at_its_line(write, knowledge, text, place):
    assert programs(write, knowledge, text)[0][2] == [place]


def test_explanations_are_counted_and_metadata_is_no_step(write, knowledge):
    text = (
        "Scene: 3\nAuthor: me\nTask: Nap\n1. Walk to bed\n"
        "   It is in the bedroom.\n   - Mind the cat.\n2. Sleep\nDifficulty: easy\n"
    )
    assert programs(write, knowledge, text) == [("Nap", ["[Walk] <bed> (1)", "[Sleep]"], [], ["NO_STEP"])]


@pytest.mark.parametrize("name", FORMS)
@pytest.mark.parametrize(
    "unit", ["(", "a(", "[Step 1] ", "| ", "|--", "1. ", "> ", "Act: ", "x character ", "-> ", "; ", "['"]
)
def test_no_form_is_slow_or_raises_on_hostile_lines(name, unit):
    text = [unit * (9_000 // len(unit))] * 3
    FORMS[name].fits(text)
    FORMS[name].lines(text)


def test_plain_numbered_steps_are_of_no_form():
    assert form_of(["1. Walk to bed", "2. Sleep"]) is None


@pytest.mark.parametrize(
    "text",
    [
        "> go to fridge 1\nYou arrive.\n> open fridge 1\nNothing happens.\n> close fridge 1\nOK.\n",
        "Act 1: go to fridge 1\nObs 1: OK.\nAct 2: open fridge 1\nObs 2: Nothing happens.\nAct 3: close fridge 1\n",
    ],
)
def test_a_command_without_effect_is_a_step_with_a_warning(knowledge, text):
    found = parse_steps(text, 0, "a log", knowledge)
    assert len(found.program.steps) == 3 and not found.faults
    (warning,) = found.warnings
    assert warning.line == 3 and "nothing happens" in warning.message
