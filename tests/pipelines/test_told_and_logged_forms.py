"""Plans as people tell them and programs log them: prose, talks, logs, calls, cells and comments."""

import pytest

from hearth.kb.language.numbered_steps import parse_steps
from hearth.kb.language.program_names import action_of, words_of
from hearth.kb.loading.load import default
from hearth.pipelines.engine.source_labels import labelled
from hearth.pipelines.ingest import items, read
from hearth.pipelines.validate import checked
from hearth.schemas.syntax import print_lines


def programs(write, knowledge, text, name):
    """Return title, steps, lines of faults, and codes of warnings of each program of a file."""
    found = []
    for _, item in items(labelled([str(write(name, text))])):
        for row in read(item):
            check = checked if row["origin"] == "text" else parse_steps
            program, faults, warnings = check(row["text"], row["line"], name, knowledge)
            lines = [fault.line for fault in faults]
            found.append((row["title"], list(print_lines(program)), lines, [each.code for each in warnings]))
    return found


LAMP = ["[Walk] <desk> (1)", "[Find] <lamp> (1)", "[SwitchOn] <lamp> (1)"]
TEXTS = {
    "first person": ("a.txt", "First I walk to the desk. Then I find the lamp.\nAfter that I switch on the lamp.\n"),
    "a robot, then it": ("a.txt", "The robot walks to the desk. It finds the lamp.\nThen it switches the lamp on.\n"),
    "a diary": ("a.txt", "Dear diary,\nI walked to the desk. I found the lamp.\nThen I switched on the lamp.\n"),
    "a letter that is wrapped": (
        "a.txt",
        "Hi Bo,\n\nI walk to the desk, and then I find the\nlamp. I switch on the lamp.\n\nRegards,\nAl\n",
    ),
    "a robot in a talk": (
        "a.txt",
        "Human: Give me light.\nRobot: 1. walk to the desk\nRobot: 2. find lamp\nRobot: 3. switch on the lamp\n",
    ),
    "a log": (
        "a.log",
        "2023-02-03 11:00:01 INFO exec: walk to desk\n2023-02-03 11:00:02 INFO exec: find lamp\n"
        "2023-02-03 11:00:04 WARN  wheel is hot\n2023-02-03 11:00:05 INFO exec: switch on lamp\n",
    ),
    "a chat": ("a.txt", "[10:01] al: a plan for light?\n[10:02] bot: walk to desk > find lamp > switch on lamp\n"),
    "questions": (
        "a.md",
        "**Q: How is light made?**\nA: It walks to the desk, finds the lamp and switches on the lamp.\n",
    ),
    "to a robot": ("a.txt", "hey robot, walk to the desk\nhey robot, find the lamp\nhey robot, switch on the lamp\n"),
    "Org mode": ("a.org", "* Light\n** TODO walk to desk\n** DONE find lamp\n** TODO switch on the lamp\n"),
    "todo.txt": (
        "todo.txt",
        "x 2023-02-03 2023-02-01 walk to desk +light\n(A) 2023-02-01 find lamp @home due:2023-02-04\n"
        "switch on the lamp pri:B\n",
    ),
    "tasks that are done": ("a.txt", "Light\n\nx walk to desk\nx find lamp\nx (B) switch on the lamp\n"),
    "checked boxes with days": (
        "a.md",
        "- [x] 2023-02-03 walk to desk +light\n- [ ] 2023-02-03 find lamp\n- [ ] switch on the lamp due:2023-02-04\n",
    ),
    "a game": ("a.log", ">go to desk\nYou are at the desk.\n>find lamp\nYou see a lamp.\n>switch on lamp\n"),
    "times": ("a.md", "9:00–9:10 – Walk to the desk\n9:10–9:20 – Find the lamp\n1pm: Switch on the lamp\n"),
    "pairs with colons": ("a.txt", "WALK: desk\nFIND: lamp\nTURN_ON: lamp\n"),
    "pairs with pipes": ("a.txt", "GOTO|desk\nFIND|lamp\nTOGGLE|lamp\n"),
    "calls in words": ("a.txt", "Walk(desk)\nFind(lamp)\nSwitchOn(lamp)\n"),
    "a function for each step": ("a.py", "walk_to_desk()\nfind_lamp()\nswitch_on_lamp()\n"),
    "arguments with names": ("a.py", 'bot.goto(target="desk")\nbot.find(obj="lamp")\nbot.turnOn(obj="lamp")\n'),
    "tuples": ("a.py", 'plan = [\n  ("walk", "desk"),\n  ("find", "lamp"),\n  ("switchon", "lamp"),\n]\n'),
    "texts in a dict": (
        "a.py",
        'PLANS = {\n  "light": [\n    "walk to desk",\n    "find lamp",\n    "switch on lamp",\n  ],\n}\n',
    ),
    "pipes": ("a.txt", "make light | walk to desk | find lamp | switch on lamp\n"),
    "a cell": (
        "a.md",
        "| who | task | plan |\n|---|---|---|\n| m1 | Light | 1. walk to desk 2. find lamp 3. switch on lamp |\n",
    ),
    "a cell of HTML": (
        "a.html",
        "<table>\n<tr><td>Light</td><td>walk to desk<br>find lamp<br>switch on lamp</td></tr>\n</table>\n",
    ),
    "elements": (
        "a.xml",
        '<plan task="light">\n<step>walk to desk</step>\n'
        '<step>find lamp</step>\n<step>switch on lamp</step>\n</plan>\n',
    ),
    "a log of levels": ("a.log", "[INFO] walk to desk\n[INFO] find lamp\n[WARN] slow\n[INFO] switch on lamp\n"),
    "tuples on a line": ("a.py", "actions = [('GoTo', 'desk'), ('Find', 'lamp'), ('TurnOn', 'lamp')]\n"),
    "names with humps": ("a.txt", "GotoLocation desk\nSearchFor lamp\nTurnOn lamp\n"),
    "arrows of pairs": ("a.txt", "walk -> desk\nfind -> lamp\nturn_on -> lamp\n"),
    "actions and objects in columns": (
        "a.md",
        "| n | Action | Object |\n|---|---|---|\n| 1 | Walk | desk |\n| 2 | Find | lamp |\n| 3 | SwitchOn | lamp |\n",
    ),
    "YAML": ("a.yaml", "- task: Light\n  steps:\n    - walk to desk\n    - find lamp\n    - switch on lamp\n"),
    "YAML of actions": (
        "a.yml",
        "name: Light\nplan:\n  - action: goto\n    target: desk\n  - action: find\n    object: lamp\n"
        "  - action: turn_on\n    object: lamp\n",
    ),
    "comments": ("a.txt", "walk to desk   # by the door\nfind lamp   # the old one\n# careful\nswitch on lamp\n"),
    "an outline": ("a.txt", "1) Light\n    walk to desk\n    find lamp\n    switch on lamp\n"),
    "owners": ("a.md", "Light\n- [ ] @bo Walk to the desk\n- [x] @al Find the lamp\n- [ ] @bo Switch on the lamp\n"),
}  # fmt: skip


@pytest.mark.parametrize(("name", "text"), TEXTS.values(), ids=TEXTS)
def test_the_same_steps_in_every_form(write, knowledge, name, text):
    ((_, steps, faults, _),) = programs(write, knowledge, text, name)
    assert (steps, faults) == (LAMP, [])


def test_a_sentence_of_prose_that_asks_for_nothing_is_a_fault(write, knowledge):
    text = "I walk to the desk. I find the lamp.\nI dream of summer.\nThen I switch on the lamp.\n"
    ((_, steps, faults, _),) = programs(write, knowledge, text, "a.txt")
    assert (steps, faults) == (LAMP, [2])


def test_each_row_of_a_table_is_a_record(write, knowledge):
    top = "| who | task | plan |\n|---|---|---|\n"
    text = f"{top}| m1 | Nap | 1. walk to bed 2. lie on bed |\n| m2 | Nap | I am not able to. |\n"
    first, second = programs(write, knowledge, text, "a.md")
    assert first[1] == ["[Walk] <bed> (1)", "[Lie] <bed> (1)"]
    assert second[1] == [] and second[2] == [4]


def test_the_steps_of_several_robots_are_not_those_of_one(write, knowledge):
    text = "robot1: walk to desk\nrobot2: walk to bed\nrobot1: find lamp\n"
    assert [steps for _, steps, _, _ in programs(write, knowledge, text, "a.txt") if steps] == []


def test_a_numbered_step_with_steps_below_it_is_not_a_title(write, knowledge):
    text = "1. Walk to the desk\n   find lamp\n   switch on lamp\n2. Walk to bed\n   lie on bed\n   sleep\n"
    ((_, steps, _, _),) = programs(write, knowledge, text, "a.txt")
    assert steps[:3] == LAMP and len(steps) == 6


def test_what_a_game_answers_is_counted(write, knowledge):
    text = ">open drawer\nYou see a pen.\n>grab pen\nTaken.\n"
    ((_, steps, _, warnings),) = programs(write, knowledge, text, "a.log")
    assert "[LookAt] <pen> (1)" not in steps and "NO_STEP" in warnings


@pytest.mark.parametrize(
    "line",
    ["Take the cat out", "Take out the dog", "You see a cup", "Point the remote", "Hang the coat over the chair"],
)
def test_no_step_is_read_where_none_is_meant(write, knowledge, line):
    ((_, steps, faults, _),) = programs(write, knowledge, f"1. Walk to desk\n2. {line}\n", "a.txt")
    assert (steps, faults) in ((LAMP[:1], [2]), ([*LAMP[:1], "[PointAt] <remote_control> (1)"], []))


STEPS = {
    "Pour 50 ml of milk into the cup": "[Pour] <milk> (1) <cup> (1)",
    "Point the pen at the computer": "[PointAt] <computer> (1)",
    "Wring the towel out": "[Squeeze] <towel> (1)",
    "Wipe the desk down": "[Wipe] <desk> (1)",
    "Would you mind opening the door?": "[Open] <door> (1)",
    "Take the cup with you": "[Grab] <cup> (1)",
    "Take the tea instead": "[Grab] <tea> (1)",
    "Grab the yoghurt": "[Grab] <yogurt> (1)",
    "Wake up at seven": "[WakeUp]",
}


@pytest.mark.parametrize(("line", "step"), STEPS.items())
def test_more_ways_of_asking(write, knowledge, line, step):
    ((_, steps, faults, _),) = programs(write, knowledge, f"1. {line}\n2. Walk to desk\n", "a.txt")
    assert (steps, faults) == ([step, "[Walk] <desk> (1)"], [])


def test_it_goes_into_what_was_opened_and_along_to_where_one_walks(write, knowledge):
    text = "1. Grab the cup\n2. Walk to the sink with it\n3. Rinse it\n4. Open the cupboard and put it inside\n"
    ((_, steps, _, _),) = programs(write, knowledge, text, "a.txt")
    assert steps[2:] == ["[Rinse] <cup> (1)", "[Open] <cupboard> (1)", "[PutIn] <cup> (1) <cupboard> (1)"]


def test_a_task_that_is_not_understood_is_a_fault(write, knowledge):
    text = "x 2023-02-03 walk to desk\nx 2023-02-03 juggle lamp\nfrobnicate lamp\n"
    ((_, steps, faults, _),) = programs(write, knowledge, text, "todo.txt")
    assert (steps, faults) == (["[Walk] <desk> (1)"], [2, 3])


@pytest.mark.parametrize(
    ("line", "step"),
    [("I swich on the lamp.", "[SwitchOn] <lamp> (1)"), ("I swithc off the lamp.", "[SwitchOff] <lamp> (1)")],
)
def test_a_misspelled_verb_of_two_words_begins_a_step(write, knowledge, line, step):
    text = f"Light\nI walk to the desk.\nI find the lamp.\n{line}\n"
    ((_, steps, faults, _),) = programs(write, knowledge, text, "a.txt")
    assert (steps[2:], faults) == ([step], [])


def test_a_verb_that_no_lexicon_has_begins_a_step(write, knowledge):
    text = "Calls\nShe walks to the desk.\nShe finds the cellphone.\nShe texts on her cellphone.\n"
    ((_, steps, faults, _),) = programs(write, knowledge, text, "a.txt")
    assert len(steps) + len(faults) == 3


def test_steps_of_two_agents_on_a_line_keep_their_agents(write, knowledge):
    text = "<char0> [walk] <kitchen> (1) | <char1> [walk] <bathroom> (1)\n<char0> [open] <fridge> (1)\n"
    ((_, steps, faults, _),) = programs(write, knowledge, text, "a.txt")
    assert faults == []
    assert "<char1> [Walk] <bathroom> (1)" in " ".join(steps)


@pytest.mark.parametrize(
    ("name", "objects", "relation", "action"),
    [
        ("go_to", ["desk"], "", "Walk"),
        ("pickUp", ["cup"], "", "Grab"),
        ("put", ["cup", "desk"], "", "PutBack"),
        ("put", ["cup", "fridge"], "", "PutIn"),
        ("place", ["cup", "sink"], "on", "PutBack"),
        ("toggle_off", ["lamp"], "", "SwitchOff"),
        ("put", ["cup"], "", ""),
        ("juggle", ["cup"], "", ""),
    ],
)
def test_names_of_programs(name, objects, relation, action):
    assert action_of(default(), name, objects, relation) == action


def test_names_of_programs_in_words():
    assert [words_of(name).lower() for name in ("closeEyes", "walk_to_desk")] == ["close eyes", "walk to desk"]
