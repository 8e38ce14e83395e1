"""Rows of ours that are scored, of the kinds of shared cases."""

from __future__ import annotations

import json

import pytest
from typer.testing import CliRunner

from hearth.cli import app

TV = ["[Walk] <television> (1)", "[SwitchOn] <television> (1)", "[Sit] <sofa> (1)"]
MARKDOWN = (
    "1. **Walk to the television**\n2. **Switch on the television**\n3. **Sit on the sofa**",
    "- [x] Walk to television\n- [ ] Switch on television\n- [ ] Sit on sofa",
    "```\nWalk to television\nSwitch on television\nSit on sofa\n```",
    "0. Walk to television\n1. Switch on television\n2. Sit on sofa",
    "1. *Walk to television* - it is there.\n2. *Switch on television* - to watch.\n3. *Sit on sofa* - to rest.",
    "| step | action |\n|---|---|\n| 1 | Walk to television |\n| 2 | Switch on television |\n| 3 | Sit on sofa |",
    '["Walk to television", "Switch on television", "Sit on sofa"]',
)
NO_INSTANCES = (
    (["[open] <fridge>"], ["[close] <fridge>"], (0, 0, 1)),
    (["[WALK] <bed>", "[LIE] <bed>"], ["[Walk] <bed> (1)", "[Lie] <bed> (1)"], (1, 1, 1)),
    (["[putback] <cup> <table>"], ["[PutBack] <cup> (1) <table> (2)"], (1, 1, 1)),
    ("[Walk] <sofa>\n[Sit] <sofa>", "[Walk] <sofa> (1)\n[StandUp]", (0.5, 0.5, 0.5)),
)
REFERENCE = "TV\n\n\n\n" + "\n".join(TV[:2])


def scored(tmp_path, door, row, *options):
    (tmp_path / "rows.jsonl").write_text(json.dumps({"id": "a", **row}) + "\n")
    done = CliRunner().invoke(app, ["score", door, str(tmp_path / "rows.jsonl"), "--json", *options])
    assert done.stdout.startswith("{"), done.output
    return json.loads(done.stdout), done


@pytest.mark.parametrize("text", MARKDOWN)
def test_a_text_that_check_reads_is_scored_as_the_same_steps(tmp_path, text):
    found, done = scored(tmp_path, "lcs", {"predicted": text, "reference": TV})
    (row,) = found["scores"]
    assert (row["step"], done.exit_code) == (1, 0), done.output
    (tmp_path / "plan.md").write_text(text)
    assert CliRunner().invoke(app, ["check", str(tmp_path / "plan.md")]).exit_code == 0


@pytest.mark.parametrize(("predicted", "reference", "values"), NO_INSTANCES)
def test_steps_without_instances_are_scored_by_class(tmp_path, predicted, reference, values):
    found, done = scored(tmp_path, "lcs", {"predicted": predicted, "reference": reference})
    (row,) = found["scores"]
    assert (row["step"], row["action"], row["object"]) == values and done.exit_code == 0, done.output


@pytest.mark.parametrize(
    ("predicted", "code"),
    [
        (["[WALK] <cup> (1)", "[PUTIN] <cup> (1) <cup> (1)"], "WRONG_ARITY"),
        (["[walk] <cup> (1)", "[putback] <cup> (1) <cup> (1)"], "WRONG_ARITY"),
        (["[WALK] <bed> (1) <sofa> (1)"], "WRONG_ARITY"),
        (["[FLY] <bed> (1)"], "UNKNOWN_ACTION"),
        ([], None),
        ("  \n", None),
        ("\n\n\n", None),
    ],
)
def test_the_code_of_a_failure_is_that_of_check_and_an_empty_answer_is_not_executable(tmp_path, predicted, code):
    found, done = scored(tmp_path, "program", {"predicted": predicted, "reference": REFERENCE, "home": "maple"})
    (row,) = found["scores"]
    assert (row["code"], row["empty"], row["executable"]) == (code, code is None, 0), done.output


@pytest.mark.parametrize(
    "wrong",
    [["[Walk] <fridge> (1)", "[Sit] <fridge> (1)"], ["[Grab] <bed> (1)"],
     ["[Walk] <cup> (1)", "[Grab] <cup> (1)", "[Walk] <kitchen> (1)", "[PutBack] <cup> (1) <kitchen> (1)"]],
)  # fmt: skip
def test_a_goal_is_not_reached_by_steps_behind_a_failure(tmp_path, wrong):
    row = {"predicted": [*wrong, *TV[:2]], "reference": REFERENCE, "home": "maple"}
    found, done = scored(tmp_path, "program", row, "--rules", "replay")
    (score,) = found["scores"]
    assert (score["executable"], score["goal"]) == (0, 0), done.output
