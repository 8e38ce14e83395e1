"""Forms of text with an action of one's own: what is read of ours is read of it."""

from __future__ import annotations

import json
import re
from itertools import pairwise
from pathlib import Path

import pytest
from test_forms_of_text import MILK_TEXTS
from typer.testing import CliRunner

from hearth.cli import app
from hearth.kb.language.numbered_steps import parse_steps
from hearth.kb.language.recognition_knowledge import recognition, recognizing
from hearth.kb.loading.load import default, overlaid
from hearth.pipelines.engine.source_labels import labelled
from hearth.pipelines.ingest import items, read
from hearth.schemas.syntax import print_lines

ZAP = """Zap:
  id: 9001
  roles: [thing]
  needs: [anything]
  before:
  - NOT_CLOSE: close(a, o)
  effects: []
  say: Zap {0}
  words: [blast]
"""


@pytest.fixture(scope="module")
def overlay(tmp_path_factory):
    folder = tmp_path_factory.mktemp("kb")
    (folder / "actions.yaml").write_text(ZAP)
    return folder


def steps_of(file: Path, known) -> list[str]:
    found = []
    with recognizing(known):
        for _, item in items(labelled([str(file)])):
            for row in read(item):
                found += print_lines(parse_steps(row["text"], row["line"], "", known).program)
    return found


def zapped(text: str) -> str:
    """The text with `zap` wherever it says `open`, in capitals as there."""
    return re.sub(
        "open",
        lambda found: "".join(z.upper() if o.isupper() else z for z, o in zip("zap", found[0], strict=False)),
        text,
        flags=re.IGNORECASE,
    )


OTHERWISE = frozenset({"ALFWorld", "ALFWorld, numbered"})
"""Texts in a language of fixed commands."""


@pytest.mark.parametrize("name", MILK_TEXTS)
def test_an_action_of_ones_own_is_read_in_every_form(tmp_path, overlay, name):
    mine = overlaid(overlay)
    (tmp_path / "ours.txt").write_text(MILK_TEXTS[name])
    (tmp_path / "mine.txt").write_text(zapped(MILK_TEXTS[name]))
    ours = steps_of(tmp_path / "ours.txt", default())
    if name not in OTHERWISE:
        assert steps_of(tmp_path / "mine.txt", mine) == [line.replace("[Open]", "[Zap]") for line in ours]


JSONS = {
    "mapping": {"ZAP": ["sofa"]},
    "mapping of several": {"WALK": ["sofa"], "ZAP": ["sofa"]},
    "tool calls": {"plan": [{"action": "walk", "object": "sofa"}, {"action": "zap", "object": "sofa"}]},
    "pairs": {"plan": [["walk", "sofa"], ["zap", "sofa"]]},
    "calls": {"plan": ["walk(sofa)", "zap(sofa)"]},
    "names": {"steps": [{"verb": "Zap", "noun": "sofa"}]},
}


@pytest.mark.parametrize("name", JSONS)
def test_check_and_run_read_it_in_json(tmp_path, overlay, name):
    file = tmp_path / "plan.json"
    file.write_text(json.dumps(JSONS[name]))
    args = [str(file), "--kb", str(overlay)]
    checked = CliRunner().invoke(app, ["check", *args])
    assert checked.exit_code == 0, checked.output
    ran = json.loads(CliRunner().invoke(app, ["run", *args, "--json"]).stdout)
    assert ran["steps"][-1].startswith("[Zap] <sofa>")
    assert CliRunner().invoke(app, ["check", str(file)]).exit_code == 1, "ours does not have the action"


def test_a_build_reads_it(tmp_path, overlay):
    file = tmp_path / "plan.jsonl"
    file.write_text(json.dumps({"task": "Zap", "plan": [["walk", "sofa"], ["zap", "sofa"]]}) + "\n")
    out = tmp_path / "out"
    words = ["--kb", str(overlay), "--home", "maple", "--per-program", "0", "--pictures", "0", "--workers", "1"]
    done = CliRunner().invoke(app, ["build", str(file), "--out", str(out), *words])
    assert "[Zap] sofa: [Zap] can be written, but the simulator does not execute it" in done.output
    assert "validate  1 in, 1 through" in " ".join(done.output.split()).replace("validate 1", "validate  1")


def test_a_reading_ends_with_its_knowledge(overlay):
    mine, before = overlaid(overlay), recognition()
    with recognizing(mine):
        assert recognition() is mine
        with recognizing(default()):
            assert recognition() is default()
        assert recognition() is mine
    assert recognition() is before is default()
    texts = ["1. Walk to sofa\n2. Zap sofa\n", "walk(sofa)\nzap(sofa)\n"] * 2
    found = [len(parse_steps(text, 0, "", known).program.steps) for text in texts for known in (mine, default())]
    assert all(a > b for a, b in list(pairwise(found))[::2]), found
