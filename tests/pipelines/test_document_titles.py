"""Titles of documents above plans are no records, and rows without a plan are said."""

import pytest
from test_forms_of_text import programs

from hearth.commands.inputs import read_programs
from hearth.storage.rejects import Reject

TEA, READ = "1. Walk to the kitchen\n2. Grab the cup\n", "1. Grab the book\n2. Read the book\n"
TOP = "# My household plans\n\n"


@pytest.mark.parametrize(
    "text",
    [
        f"{TOP}## Tea\n{TEA}\n## Book\n{READ}",
        f"{TOP}Some words on them.\n\n## Tea\n{TEA}\n## Book\n{READ}",
        f"{TOP}# Tea\n{TEA}\n# Book\n{READ}",
        f"{TOP}Some words on them.\n\n# Tea\n{TEA}\n# Book\n{READ}",
        f"{TOP}Task: Tea\n{TEA}\nTask: Book\n{READ}",
        f"{TOP}**Tea**\n{TEA}\n**Book**\n{READ}",
        f"{TOP}## Kitchen\n\n### Tea\n{TEA}\n### Book\n{READ}",
        f"My plans\n========\n\nTea\n---\n{TEA}\nBook\n----\n{READ}",
    ],
)
def test_the_title_of_a_document_is_no_record(write, knowledge, text):
    found = programs(write, knowledge, text, "plans.md")
    assert [(title, len(steps), faults) for title, steps, faults, _ in found] == [("Tea", 2, []), ("Book", 2, [])]


def test_a_section_without_steps_is_a_record_that_is_refused(write, knowledge):
    found = programs(write, knowledge, f"# Tea\n\n# Book\n{READ}", "plans.md")
    assert [(title, [code for code, _ in faults]) for title, _, faults, _ in found] == [
        ("Tea", ["EMPTY"]),
        ("Book", []),
    ]


@pytest.mark.parametrize(("goal", "title"), [("Make tea", "Make tea"), ("ON(cup table): 1", ""), ("cup=OPEN", "")])
@pytest.mark.parametrize("name", ["a.csv", "a.jsonl"])
def test_a_goal_next_to_a_prediction_is_a_title_only_in_words(write, knowledge, name, goal, title):
    rows = {
        "a.csv": f'goal,prediction\n{goal},"1. Sleep"\n',
        "a.jsonl": f'{{"goal":"{goal}","prediction":"1. Sleep"}}\n',
    }
    (found,) = read_programs(write(name, rows[name]), knowledge, name)
    assert found.program.title in (title, "Untitled"[: 8 * (not title)])


@pytest.mark.parametrize("cell", ["", "   ", '""'])
def test_a_row_with_an_empty_plan_is_refused_with_its_columns(write, knowledge, cell):
    file = write("a.csv", f'task,plan\nTea,"1. Sleep\n2. Wake up"\nNap,{cell}\n')
    _, reject = read_programs(file, knowledge, "a.csv")
    assert isinstance(reject, Reject) and (reject.diagnostics[0].line, reject.code) == (4, "EMPTY")
    assert "`plan` is empty" in reject.diagnostics[0].message and "keys are task, plan" in reject.diagnostics[0].message


def test_a_row_with_a_description_and_no_plan_is_said(write, knowledge, capsys):
    file = write("a.csv", 'title,description,plan\nTea,I drink,"1. Sleep\n2. Wake up"\nNap,I sleep,\n')
    assert len(list(read_programs(file, knowledge, "a.csv"))) == 1
    assert "1 description without a plan: a.csv:4." in capsys.readouterr().err
