"""Steps in words through validate: mapped, kept with their score, or refused with candidates."""

import json
import re
from unittest.mock import patch

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hearth.kb.language import plan_lines
from hearth.kb.language.numbered_steps import parse_steps
from hearth.pipelines.engine.source_labels import labelled
from hearth.pipelines.ingest import items, read
from hearth.schemas.syntax import print_lines


def parsed(knowledge, *steps):
    text = "Task: T\n" + "".join(f"Step {number}: {step}\n" for number, step in enumerate(steps, 1))
    found = parse_steps(text, 0, "a.txt", knowledge)
    return list(print_lines(found.program)), found


def test_clauses_and_pronouns(knowledge):
    lines, found = parsed(knowledge, "Walk to the fridge", "Open it and grab the milk", "Drink it")
    assert lines == ["[Walk] <fridge> (1)", "[Open] <fridge> (1)", "[Grab] <milk> (1)", "[Drink] <milk> (1)"]
    assert found.program.lines == (2, 3, 3, 4)
    assert not found.faults and not found.warnings


def test_what_is_nearly_understood_is_a_warning_with_its_score(knowledge):
    lines, found = parsed(knowledge, "Wlak to kitchen")
    assert lines == ["[Walk] <kitchen> (1)"]
    (warning,) = found.warnings
    assert (warning.code, warning.line, warning.column) == ("FUZZY_MATCH", 2, 9)
    assert "0.85" in warning.message


def test_what_is_not_understood_names_candidates_and_costs_no_neighbour(knowledge):
    lines, found = parsed(knowledge, "Walk to bed", "Put the plat on the tabel", "Ponder quietly about zen", "Sleep")
    assert lines == ["[Walk] <bed> (1)", "[Sleep]"]
    assert [(fault.code, fault.line) for fault in found.faults] == [("AMBIGUOUS", 3), ("NOT_UNDERSTOOD", 4)]
    assert "`Put plate on table`" in found.faults[0].suggestion and found.faults[0].found == "Put the plat on the tabel"


def test_no_steps_is_a_fault(knowledge):
    assert [fault.code for fault in parse_steps("Task: T\n", 0, "a", knowledge).faults] == ["EMPTY"]


def test_all_examples_of_planning_papers_parse(real_data, knowledge):
    texts = set(json.loads((real_data / "language_planner_examples.json").read_text()))
    assert len(texts) == 574
    for text in sorted(texts):
        found = parse_steps(text, 0, "a", knowledge)
        assert not found.faults and not found.warnings
        assert len(found.program.steps) == text.count("\nStep ")


@pytest.mark.parametrize("text", ["Task: T\nStep 1: Walk to bed\nStep 2: Sleep\n"])
def test_through_the_stages(write, built, text):
    build = built(write("model.txt", text))
    build.run("ingest", "validate")
    (row,) = build.rows("validate")
    assert [step["action"] for step in row["steps"]] == ["Walk", "Sleep"]


CHAT = """Sure! Here's a step-by-step plan for making coffee in the morning:

# Make coffee

*A quick routine.*

**You need:**
- a cup

### Steps

1. **Walk to the kitchen**
2. **Find the coffee maker**: it is on the counter.
   - Make sure it is plugged in.

   It may be behind the toaster.
3. [ ] Open the cupboard and grab a cup.
4. Preheat the flux capacitor to 350°F.
5. At the coffee maker:
   - Switch on the `coffee maker`

---
Enjoy your coffee!

## Watch TV

> 1. [Walk] <television> (1)
> 2. Turn on the TV

Let me know if you would like me to adjust anything!
"""


def test_a_language_model_s_markdown(write, knowledge):
    """Details explain steps, remarks are in no program, and one bad step costs no other."""
    (_, coffee), (_, tv) = items(labelled([str(write("chat.md", CHAT))]))
    first, second = read(coffee)[0], read(tv)[0]
    assert (first["title"], first["description"]) == ("Make coffee", "A quick routine.\nYou need:\na cup")
    found = parse_steps(first["text"], first["line"], "chat.md", knowledge)
    assert list(print_lines(found.program)) == [
        "[Walk] <kitchen> (1)", "[Find] <coffe_maker> (1)", "[Open] <cupboard> (1)", "[Grab] <cup> (1)",
        "[SwitchOn] <coffe_maker> (1)",
    ]  # fmt: skip
    assert found.program.lines == (12, 13, 17, 17, 20)
    assert [(fault.code, fault.line, fault.column) for fault in found.faults] == [("NOT_UNDERSTOOD", 18, 4)]
    assert [(warning.code, warning.line) for warning in found.warnings] == [("FUZZY_MATCH", 13), ("NO_STEP", 14)]
    assert (second["title"], second["program_id"]) == ("Watch TV", "spoken:chat.md:23")
    found = parse_steps(second["text"], second["line"], "chat.md", knowledge)
    assert found.program.lines == (27, 28) and not found.faults


@pytest.mark.parametrize(
    ("text", "title", "steps"),
    [
        ("Here is a plan for watching TV:\n\n1. Walk to the TV\n2. Turn on the TV\n", "watching TV", 2),
        ("Here is my plan:\n\n1. Walk to bed\n2. Lie on bed\n", "", 2),
        ("Sure thing!\n1. Walk to bed\n2. Lie on bed\n", "", 2),
        ("Sunday plan: nap\n1. Walk to bed\n2. Lie on bed\n", "Sunday plan: nap", 2),
        ("**Task:** Nap\n```\n[Walk] <bed> (1)\n[Lie] <bed> (1)\n```\nHope this helps!\n", "Nap", 2),
        ("Nap\n- [Walk] <bed> (1)\n- [Lie] <bed> (1)\n", "Nap", 2),
        ("Nap\n## Phase 1\n1. Walk to bed\n## Phase 2\n2. Lie on bed\n", "Phase 1", 2),
        ("**Nap**\r\n- Step 1: Walk to bed\r\n* **Step 2:** Lie on bed\r\n", "Nap", 2),
        (
            "## 🧺 Plan: Nap\n### ✅ Step 1: Prepare\n- Walk to bed\n### ✅ Step 2: Rest\n1. Lie on bed\n2. Sleep\n",
            "Nap",
            3,
        ),
        ("Nap\n1\ufe0f\u20e3 Walk to bed\n2\ufe0f\u20e3 Sleep\n", "Nap", 2),
        ("# Nap\n1. Walk to bed\n1. Lie on bed\n1. Sleep\n", "Nap", 3),
        ("# Nap\n### Step 1: Go upstairs and so on\n- Walk to bed\n### Step 2: Rest\n- Lie on bed\n", "Nap", 2),
    ],
)
def test_other_ways_of_writing_a_plan(write, knowledge, text, title, steps):
    ((_, item),) = items(labelled([str(write("plan.txt", text))]))
    (row,) = read(item)
    found = parse_steps(row["text"], 0, "plan.txt", knowledge)
    assert (row["title"], len(found.program.steps), found.faults) == (title, steps, ())


def test_bullets_below_a_heading_are_checked_like_steps(knowledge):
    found = parse_steps("1. In the kitchen:\n- Walk to bed\n- Ponder zen\n- Sleep\n- Ponder\n", 0, "a.txt", knowledge)
    assert list(print_lines(found.program)) == ["[Walk] <bed> (1)", "[Sleep]"]
    assert [(fault.code, fault.line) for fault in found.faults] == [("NOT_UNDERSTOOD", 3), ("NOT_UNDERSTOOD", 5)]


def test_programs_of_bullets_and_bullets_that_are_remarks(write):
    text = "Nap\n- Walk to bed\n- Sleep\n\nTea\n- Find cup\n\nRest\n1. Walk to bed\n2. Sleep\n\nTips:\n- Enjoy it.\n"
    titles = [read(item)[0]["title"] for _, item in items(labelled([str(write("a.txt", text))]))]
    assert titles == ["Nap", "Tea", "Rest"]


def test_a_step_in_brackets_is_checked_by_the_grammar(knowledge):
    found = parse_steps("1. [Walk] <bed> (2)\n2. [Fly] <bed> (1)\n3. [Walk] <bed> x\n", 4, "a.txt", knowledge)
    assert list(print_lines(found.program)) == ["[Walk] <bed> (2)"]
    assert [(f.code, f.line, f.column) for f in found.faults] == [("UNKNOWN_ACTION", 6, 5), ("SYNTAX", 7, 11)]


@given(st.sampled_from(("1. ", "Step 2: ", "\t12)  ", "step 3. ")), st.text("ab C1.:)(-,;'", max_size=12))
def test_a_plain_line_is_read_as_one_with_markdown_would_be(start, words):
    plain = plan_lines.plan_line(start + words)
    with patch.object(plan_lines, "_PLAIN", re.compile("(?!)")):
        assert plan_lines.plan_line(start + words) == plain


def test_a_row_is_counted_once_for_each_fuzzy_step():
    from hearth.pipelines.validate import FUZZY, STAGE

    warnings = [{"code": code} for code in ("FUZZY_MATCH", "NO_STEP", "FUZZY_MATCH")]
    assert STAGE.labels({"warnings": warnings}) == [FUZZY, FUZZY]
