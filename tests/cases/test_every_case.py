"""Every shared case has three inputs of ours at least, and a folder with a release beside other files is read alone."""

from __future__ import annotations

import json
import os
import re
from collections import Counter
from pathlib import Path

import pytest
from cases.test_own_plans import PLANS
from cases.test_own_runs import RUNS

from hearth.commands.inputs import read_programs
from hearth.storage.rejects import Reject

ROOT = Path(__file__).resolve().parents[2]
CASES = Path(os.environ.get("HEARTH_REAL_DATA", ROOT.parent / "shared/real")).parent / "cases"
FEWEST = 3
ELSEWHERE = {
    "08": "test_own_runs.py: graphs in wrappers",
    "17": "test_own_scores.py: MARKDOWN",
    "20": "test_own_scores.py: NO_INSTANCES",
    "53": "BESIDE, below",
    "73": "test_own_scores.py: codes of failures",
    "79": "test_own_scores.py: goals behind a failure",
    "83": "test_own_runs.py: what replay takes",
}
"""Tests of three inputs or more of ours that are no rows of PLANS and RUNS."""

BESIDE = {
    "words.json": json.dumps({"WALK": 1, "GRAB": 2}),
    "notes.md": "# Notes\n1. Walk to the bed\n2. Lie on the bed\n",
    "plans/domain_plans.json": json.dumps({"8_1": ["walk_towards character bed", "lie_on character bed"]}),
    "prompt.txt": "You are a robot.\n1. Find the book\n2. Read the book\n",
    "goals.jsonl": json.dumps({"task": "Nap", "steps": ["Walk to the bed"]}) + "\n",
}


def test_every_case_has_three_inputs_of_ours():
    numbers = {found[1] for file in CASES.glob("*.expected.txt") if (found := re.match(r"(\d+b?)-", file.name))}
    if not numbers:
        pytest.skip(f"no cases in {CASES} (they lie beside the folder HEARTH_REAL_DATA)")
    counts = Counter(each.case for each in (*PLANS, *RUNS))
    assert sorted(number for number in numbers - ELSEWHERE.keys() if counts[number] < FEWEST) == []


@pytest.mark.parametrize("name", BESIDE)
def test_a_release_is_read_alone_where_files_of_other_kinds_lie_beside_it(tmp_path, knowledge, name):
    program = tmp_path / "data/executable_programs/results/file7_1.txt"
    for file, text in (
        (program, "Read\nA book.\n\n\n[WALK] <book> (1)\n"),
        (tmp_path / "data/pkg" / name, BESIDE[name]),
    ):
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
    read = list(read_programs(tmp_path / "data", knowledge, "data"))
    titles = [each.program.title for each in read if not isinstance(each, Reject)]
    codes = [each.code for each in read if isinstance(each, Reject)]
    assert (titles.count("Read"), len(titles), codes.count("UNSUPPORTED_FILE")) == (1, 1, 1), (titles, codes)
