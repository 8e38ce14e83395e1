"""The exports and report pages of a small dataset stay as they are until somebody means a change.

Rows as JSON lines name the version of Hearth and all actions, so they are left to `test_exports.py`;
`coco` needs pictures.
"""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from golden_files import compare, short

import hearth
from hearth.datasets.export.formats import FORMATS, export
from hearth.datasets.report.floor_plan_svg import draw
from hearth.datasets.report.report_writer import write_report
from hearth.homes import library

GOLDEN = "exports.json"
ACTION = re.compile(r"\(:action (\S+)(.*?)(?=\(:action |\Z)", re.DOTALL)
"""An action of a planning domain: one more action changes nothing here."""


def _files(folder: Path) -> dict[str, str]:
    return {
        path.relative_to(folder).as_posix(): short(path.read_bytes())
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


@pytest.fixture(scope="module")
def ds(made):
    return hearth.load(made.out / "publish")


@pytest.mark.parametrize("form", sorted({*FORMATS} - {"jsonl", "csv", "coco"}))
def test_what_is_exported(form, ds, tmp_path):
    export(ds, form, tmp_path / form)
    found = _files(tmp_path / form)
    if form == "pddl":
        del found["domain.pddl"]
        text = (tmp_path / form / "domain.pddl").read_text()
        bodies = {action: short(body.strip(") \n").encode()) for action, body in ACTION.findall(text)}
        compare(GOLDEN, bodies, "actions", others=True)
    compare(GOLDEN, found, form)


def test_floor_plans(knowledge):
    plans = {name: short(draw(library.load_graph(name, knowledge).nodes).encode()) for name in library.names()}
    compare(GOLDEN, plans, "plans")


def test_the_report_s_data(ds, tmp_path):
    write_report(ds, tmp_path / "report")
    found = _files(tmp_path / "report")
    compare(GOLDEN, {name: value for name, value in found.items() if name.startswith("data/")}, "report")
