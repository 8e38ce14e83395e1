"""Each input of ours of a shared case's kind is read as meant by `check`, or refused at its line with its code."""

from __future__ import annotations

import json

import pytest
from cases.code_plans import CODE
from cases.json_plans import JSON
from cases.numbered_plans import NUMBERED
from cases.phrases import PHRASES
from cases.plans import Plan
from cases.printed_plans import PRINTED
from typer.testing import CliRunner

from hearth.cli import app
from hearth.commands.inputs import read_programs
from hearth.storage.rejects import Reject

PLANS = (*NUMBERED, *PHRASES, *PRINTED, *JSON, *CODE)


def parameter(plan: Plan):
    marks = [pytest.mark.xfail(reason=plan.broken, strict=True)] if plan.broken else []
    return pytest.param(plan, id=f"{plan.case}-{plan.file}", marks=marks)


@pytest.mark.parametrize("plan", list(map(parameter, PLANS)))
def test_a_plan_of_the_kind_of_a_case_is_read_as_meant(tmp_path, knowledge, plan):
    file = tmp_path / plan.file
    file.write_bytes(plan.text.encode())
    done = CliRunner().invoke(app, ["check", str(file), "--json"])
    found = json.loads(done.stdout)["files"][0]
    faults = ", ".join(f"{fault['line']} {fault['code']}" for fault in found["faults"])
    read = [each for each in read_programs(file, knowledge, file.name) if not isinstance(each, Reject)]
    steps = [
        "; ".join(" ".join([step.action, *(ref.name for ref in step.objects)]) for step in each.program.steps)
        for each in read
    ]
    assert (steps, faults) == (list(plan.steps), plan.faults), done.output
    assert (found["fuzzy"], done.exit_code) == (plan.fuzzy, 1 if plan.faults else 0), done.output
    if plan.titles is not None:
        assert tuple(each.program.title for each in read) == plan.titles
