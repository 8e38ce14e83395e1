"""Plans of plain lines, joined steps and other marks: each is read as steps, below its own title."""

import pytest
from test_forms_of_text import BOOK, MILK, programs

from hearth.commands.inputs import read_programs
from hearth.kb.language import program_lines
from hearth.kb.language.program_lines import PLAIN, header, lines_of_program

TEXTS = {
    "plain lines": "Walk to the fridge\nOpen the fridge\nGrab the milk\nClose the fridge\n",
    "ordinals": "First, walk to the fridge.\nSecond, open the fridge.\nThird, grab milk.\nLastly, close the fridge.\n",
    "emoji": "👉 Walk to fridge\n👉 Open fridge\n👉 Grab milk\n👉 Close fridge\n",
    "boxes": "☐ Walk to fridge\n☐ Open fridge\n☐ Grab milk\n☐ Close fridge\n",
    "checked": "[x] Walk to fridge\n[x] Open fridge\n[ ] Grab milk\n[ ] Close fridge\n",
    "dashes": "1 - Walk to fridge\n2 - Open fridge\n3 - Grab milk\n4 - Close fridge\n",
    "hashes": "#1 Walk to fridge\n#2 Open fridge\n#3 Grab milk\n#4 Close fridge\n",
    "no blank": "1.walk to fridge\n2.open fridge\n3.grab milk\n4.close fridge\n",
    "number words": "Step One: Walk to fridge\nStep Two: Open fridge\nStep Three: Grab milk\nStep Four: Close fridge\n",
    "times": "08:00 Walk to fridge\n08:05 Open fridge\n08:10 Grab milk\n08:20 Close fridge\n",
    "keys": "step1=Walk to fridge\nstep2=Open fridge\nstep3=Grab milk\nstep4=Close fridge\n",
    "LaTeX": "\\begin{enumerate}\n\\item Walk to fridge\n\\item Open fridge\n\\item Grab milk\n\\item Close fridge\n"
    "\\end{enumerate}\n",
    "HTML": "<ol>\n<li>Walk to fridge</li>\n<li>Open fridge</li>\n<li>Grab milk</li>\n<li>Close fridge</li>\n</ol>\n",
    "semicolons": "walk to fridge;open fridge;grab milk;close fridge\n",
    "commas": "Walk to the fridge, open the fridge, grab the milk, close the fridge\n",
    "then": "Walk to the fridge then open the fridge, and then grab the milk, then close the fridge.\n",
    "angles": "walk to fridge > open fridge >> grab milk > close fridge\n",
    "pairs": "WALK fridge\nOPEN fridge\nGRAB milk\nCLOSE fridge\n",
    "loose": "[walk] fridge\n[open] fridge\n[grab] milk\n[close] fridge\n",
    "numbered calls": "1. walk(fridge)\n2. open(fridge)\n3. grab(milk)\n4. close(fridge)\n",
    "calls on a line": "walk(fridge); open(fridge); grab(milk); close(fridge)\n",
    "prose": "First I walk to the fridge. Then I open the fridge. I grab the milk. Finally I close the fridge.\n",
    "quoted": "- “Walk to fridge”\n- “Open fridge”\n- “Grab milk”\n- “Close fridge”\n",
}


@pytest.mark.parametrize("text", TEXTS.values(), ids=TEXTS)
def test_the_steps_of_plans_without_usual_marks(write, knowledge, text):
    ((title, steps, faults, _),) = programs(write, knowledge, text)
    assert (title, steps, faults) == ("", MILK, [])


LINES = "Walk to fridge\nOpen fridge\nGrab milk\nClose fridge\n"
BULLETS = "Walk to fridge\n  * Open fridge\n  * Grab milk\n  * Close fridge\n"
NUMBERED = "Walk to fridge\n2. Open fridge\n3. Grab milk\n4. Close fridge\n"
JOINED = "walk to fridge; open fridge; grab milk; close fridge"
QUOTED = '"walk to fridge", "open fridge", "grab milk", "close fridge"'
TWO = {
    "paragraphs": f"Cold milk\n\n{LINES}\nA novel\n\nGrab novel\nRead novel\n",
    "lines": "Cold milk: walk to fridge, open fridge, grab milk, close fridge\nA novel: grab novel -> read novel\n",
    "lists": f'Cold milk = [{QUOTED}]\nA novel = ["grab novel", "read novel"]\n',
    "headings": f"# 1. Cold milk\n{JOINED}\n\n# 2. A novel\n1. Grab novel\n2. Read novel\n",
    "bold": f"**Cold milk**\n{LINES}\n**A novel**\n- Grab novel\n- Read novel\n",
    "bullets": f"* Cold milk\n  * {BULLETS}* A novel\n  * Grab novel\n  * Read novel\n",
    "a table": f"| Task | Plan |\n|---|---|\n| Cold milk | {JOINED} |\n| A novel | 1. grab novel<br>2. read novel |\n",
    "labels": f"Task: Cold milk\nPlan: {JOINED}\nTask: A novel\nPlan: grab novel; read novel\n",
    "marks that change": f"Task: Cold milk\n1. {NUMBERED}\nTask: A novel\n- Grab novel\n- Read novel\n",
}


@pytest.mark.parametrize("text", TWO.values(), ids=TWO)
def test_each_of_two_plans_has_its_own_title(write, knowledge, text):
    found = [(title, steps, faults) for title, steps, faults, _ in programs(write, knowledge, text)]
    assert found == [("Cold milk", MILK, []), ("A novel", BOOK, [])]


def test_a_title_with_a_description_only_keeps_it_and_takes_no_steps(write, knowledge):
    text = "Cold milk\n\nNobody wrote it down.\n\nA novel\n\nStep 1: Grab novel\nStep 2: Read novel\n"
    (empty, novel) = programs(write, knowledge, text)
    assert (empty[0], empty[1], [code for code, _ in empty[2]]) == ("Cold milk", [], ["EMPTY"])
    assert novel[:2] == ("A novel", BOOK)


def test_where_numbers_begin_again_without_a_title_the_second_plan_has_none(write, knowledge):
    text = "A novel\n1. Grab novel\n2. Read novel\n1. Grab novel\n2. Read novel\n"
    assert [title for title, *_ in programs(write, knowledge, text)] == ["A novel", ""]


def test_prose_of_which_less_than_two_thirds_are_steps_is_a_description(write, knowledge):
    text = "Television\n\nI walk to the sofa. I like it there. My family is tired in the evening.\n"
    ((title, steps, faults, _),) = programs(write, knowledge, text)
    assert (title, steps, [code for code, _ in faults]) == ("Television", [], ["EMPTY"])


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("Walk to the fridge\nPolish the moon\nOpen the fridge\nGrab the milk\n", 2),
        ("1. Walk to fridge\n   - Polish the moon\n2. Open fridge\n", 2),
        ("1. Walk to fridge\nPolish the moon.\n2. Open fridge\n", 2),
        ("A novel: grab novel; polish the moon; read novel\n", 1),
    ],
)
def test_an_order_that_no_action_means_is_a_fault_at_its_line(write, knowledge, text, line):
    ((_, steps, faults, _),) = programs(write, knowledge, text)
    assert len(steps) >= 2 and faults == [("NOT_UNDERSTOOD", line)]


PLAINS = (
    "Task: Milk\nStep 1: Walk to fridge\nStep 2: Open fridge",
    "Milk\n1. Walk to fridge\n2. Walk, then sit\n3. Done\n\n",
)


@pytest.mark.parametrize("text", PLAINS)
def test_the_short_way_for_plain_plans_reads_what_the_long_way_reads(text, monkeypatch):
    assert PLAIN.fullmatch(text)
    short = lines_of_program(text), header(text)
    monkeypatch.setattr(program_lines, "PLAIN", program_lines.re.compile("(?!)"))
    assert (lines_of_program(text), header(text)) == short


@pytest.mark.parametrize(
    ("text", "description", "steps"),
    [
        ("Breakfast\nWalk to the fridge and drink the milk.\n\nWalk to the kitchen\nOpen the fridge\n",
         "Walk to the fridge and drink the milk.", 2),
        ("Breakfast\n\n1. Walk to the fridge\n", "", 1),
    ],
)  # fmt: skip
def test_what_stands_above_a_blank_line_describes_and_one_number_is_a_plan(
    knowledge, tmp_path, text, description, steps
):
    file = tmp_path / "a.txt"
    file.write_text(text)
    (found,) = read_programs(file, knowledge, "a.txt")
    assert (found.program.title, found.program.description) == ("Breakfast", description)
    assert len(found.program.steps) == steps and not found.faults


def test_a_word_that_is_a_verb_continues_no_list_of_other_things(knowledge, tmp_path):
    file = tmp_path / "a.txt"
    file.write_text("T\n\n1. Walk to kitchen, fly\n2. Grab the cup and plate\n")
    (found,) = read_programs(file, knowledge, "a.txt")
    assert [step.objects[0].name for step in found.program.steps] == ["kitchen", "cup", "plate"]
    assert [fault.line for fault in found.faults] == [3]
