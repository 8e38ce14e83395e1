"""What a small dataset becomes in each form and on its report's pages stays until somebody means a change.

Rows as JSON lines name the version of Hearth and all actions, so they are left to `test_exports.py`.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
from pathlib import Path

import pytest

import hearth
from hearth.datasets.export.formats import FORMATS, export
from hearth.datasets.report.write import write_report

GOLDEN = Path(__file__).resolve().parents[1] / "golden/exports.json"
REFRESH = "if the new ones are right: HEARTH_REFRESH=1 python -m pytest tests/datasets/test_exports_golden.py"
ACTION = re.compile(r"\(:action (\S+)(.*?)(?=\(:action |\Z)", re.DOTALL)
"""An action of a planning domain: one more action changes nothing here."""


def _known() -> dict[str, dict[str, str]]:
    return json.loads(GOLDEN.read_text("utf-8")) if GOLDEN.is_file() else {}


def _short(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()[:12]


def _files(folder: Path) -> dict[str, str]:
    return {
        path.relative_to(folder).as_posix(): _short(path.read_bytes())
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


def _compare(part: str, found: dict[str, str]) -> None:
    known = _known()
    if os.environ.get("HEARTH_REFRESH"):
        known |= {part: found}
        GOLDEN.write_text(json.dumps(known, indent=1, sort_keys=True) + "\n", "utf-8")
    assert {name: found.get(name) for name in known[part]} == known[part], REFRESH
    assert part == "actions" or found.keys() == known[part].keys(), REFRESH


@pytest.fixture(scope="module")
def ds(made):
    return hearth.load(made.out / "publish")


@pytest.mark.parametrize("form", sorted({*FORMATS} - {"jsonl"}))
def test_what_is_exported(form, ds, tmp_path):
    export(ds, form, tmp_path / form)
    found = _files(tmp_path / form)
    if form == "pddl":
        del found["domain.pddl"]
        text = (tmp_path / form / "domain.pddl").read_text()
        _compare("actions", {action: _short(body.strip(") \n").encode()) for action, body in ACTION.findall(text)})
    _compare(form, found)


def test_the_report_s_data(ds, tmp_path):
    write_report(ds, tmp_path / "report")
    found = _files(tmp_path / "report")
    _compare("report", {name: value for name, value in found.items() if name.startswith("data/")})
