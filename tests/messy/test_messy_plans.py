"""The 400 messy plans, and 150 more: how much is read rightly, and that nothing is dropped in silence."""

import json
import re
from collections import Counter, defaultdict
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from hearth.commands.inputs import read_programs
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.syntax import print_step
from hearth.storage.rejects import Reject

PLANS = Path(__file__).with_name("plans.jsonl")
UNSEEN = Path(__file__).with_name("unseen_plans.jsonl")
RIGHT = {PLANS: 0.997, UNSEEN: 0.955}
WRONG = {PLANS: 0, UNSEEN: 0.0012}
WITHOUT_FAULT = {
    "CSV": 45, "CSV multi-line cells": 26, "tables": 12, "brackets": 4, "JSON lists and objects": 7, "PDDL": 16,
    "JSON actions and tool calls": 1, "shell script": 5, "questions": 3, "bullets star": 1, "email": 1, "whatsapp": 1,
}  # fmt: skip
"""Steps at most, by form, that are neither read nor refused on their line: tables and JSON refused as a whole."""

NODE = re.compile(r"\(\d+\.(\d+)\)")


class Read(NamedTuple):
    """A step as the reader gave it: the title of its program, its line, its text."""

    title: str
    line: int
    step: str


class Score(NamedTuple):
    """Counts by form, and the faulty outcomes in words."""

    plans: Path
    counts: dict[str, Counter[str]]
    found: list[str]

    def total(self, name: str) -> int:
        return sum(counts[name] for counts in self.counts.values())


def read(file: Path, knowledge) -> tuple[list[Read], set[int]]:
    """Return the steps of a file, and the lines of its faults."""
    steps, faults = [], []
    try:
        for each in read_programs(file, knowledge, file.name):
            if isinstance(each, Reject):
                faults += each.diagnostics
                continue
            faults += each.faults
            program = each.program
            read_steps = zip(program.lines, program.steps, strict=True)
            steps += [Read(program.title or "", line, print_step(step)) for line, step in read_steps]
    except HearthError as error:
        faults += error.diagnostics
    return steps, {fault.line for fault in faults}


def is_meant(step: Read, meant: dict[str, Any]) -> bool:
    return bool(meant["is"]) and (step.step in meant["is"] or NODE.sub(r"(\1)", step.step) in meant["is"])


def plain(title: str | None) -> str:
    return "".join(filter(str.isalnum, (title or "").lower()))


def judged(row: dict[str, Any], steps: list[Read], faults: set[int]) -> list[tuple[str, str]]:
    """Return the outcome of each step that is meant, and of each that is read and not meant."""
    meant = [(record, step) for record in row["records"] for step in record["steps"]]
    open_steps = list(range(len(meant)))
    outcomes: list[tuple[str, str]] = []
    unmatched = []
    for at_line in (True, False):
        for step in steps if at_line else unmatched:
            fits = (n for n in open_steps if is_meant(step, meant[n][1]))
            hit = next((n for n in fits if not at_line or meant[n][1]["line"] == step.line), None)
            if hit is None:
                (unmatched if at_line else outcomes).append(step if at_line else ("wrong", step.step))
                continue
            open_steps.remove(hit)
            others = [plain(each["title"]) for each in row["records"] if each is not meant[hit][0] and each["title"]]
            outcomes.append(("right", step.step))
            if plain(step.title) and plain(step.title) != plain(meant[hit][0]["title"]) and plain(step.title) in others:
                outcomes.append(("other title", step.title))
    for n in open_steps:
        step = meant[n][1]
        if step["line"] not in faults and not step.get("optional"):
            outcomes.append(("without fault", f"line {step['line']}"))
        if step["is"] and not step.get("optional"):
            outcomes.append(("missed", step["is"][0]))
    return outcomes


@pytest.fixture(scope="module", params=[PLANS, UNSEEN], ids=lambda path: path.stem)
def score(request, tmp_path_factory, knowledge) -> Score:
    counts: dict[str, Counter[str]] = defaultdict(Counter)
    found = []
    for row in map(json.loads, request.param.read_text(encoding="utf-8").splitlines()):
        file = tmp_path_factory.mktemp("plan") / row["file"]
        file.write_bytes(row["text"].encode())
        for name, what in judged(row, *read(file, knowledge)):
            counts[row["form"]][name] += 1
            found += [f"{name}: {row['id']}: {what}"] if name != "right" else []
    for form in sorted(counts, key=lambda form: -counts[form]["missed"]):
        print(f"{form:32}", dict(counts[form]))
    return Score(request.param, counts, found)


def test_most_steps_are_read_as_meant_and_hardly_one_as_another(score):
    right, wrong = score.total("right"), score.total("wrong")
    meant = right + score.total("missed")
    assert right >= RIGHT[score.plans] * meant
    assert wrong <= WRONG[score.plans] * meant, [each for each in score.found if each.startswith("wrong")]


def test_no_record_takes_the_title_of_another(score):
    assert [each for each in score.found if each.startswith("other title")] == []


def test_no_step_is_dropped_without_a_fault_on_its_line(score):
    silent = {form: counts["without fault"] for form, counts in score.counts.items()}
    assert {form: count for form, count in silent.items() if count > WITHOUT_FAULT.get(form, 0)} == {}
