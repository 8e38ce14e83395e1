"""The commands of the README and the guides, one after another, in a copy of the checkout, as a new user types them."""

from __future__ import annotations

import json
import os
import re
import shlex
from importlib.util import find_spec
from pathlib import Path

import pytest
from checkouts import ROOT, copied, done, run_in

README = (ROOT / "README.md").read_text("utf-8")
GUIDES = "".join((ROOT / name).read_text("utf-8") for name in ("docs/tour.md", "docs/datasets.md", "docs/corpus.md"))
CALLS = re.compile(r"(?:`|^    )hearth ([a-z][^`\n]+)", re.M)
COMMANDS = [shlex.split(found.strip(), comments=True) for found in CALLS.findall(README + GUIDES)]

REAL = Path(os.environ.get("HEARTH_REAL_DATA", ROOT.parent / "shared/real"), "activityprograms-sample.zip")

NEEDS = {"plan": "unified_planning", "model": "torch"}
"""The library of another extra that a command needs."""

UNFINISHED = ("serve", "doctor", "render-visible", "build collected", "corpus synthesize")
"""Commands that do not end, that need answers of people, or whose status is the machine's; and two long ones."""

SMALL = {"render-gallery": ("--count", "2", "--width", "64")}

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def checkout(tmp_path_factory):
    """A copy with what the README says to save."""
    copy = copied(tmp_path_factory.mktemp("readme"))
    (program,) = re.findall(r"Save this as `watch_tv.txt`:\n\n((?:    .*\n|\n)+)", README)
    (copy / "watch_tv.txt").write_text(re.sub(r"^ {4}", "", program, flags=re.M))
    (copy / "plans.txt").write_bytes((copy / "watch_tv.txt").read_bytes())
    return copy


def prepared(copy: Path, words: list[str]) -> list[str]:
    """A command with files of ours in the places of the user's."""
    if words[:2] == ["score", "dataset"]:
        ids = json.loads(
            done(copy, "python", "cli.py", "query", "mine", "SELECT execution_id FROM executions", "--json")
        )
        rows = [{"id": row["execution_id"]} for row in ids]
        text = (copy / "watch_tv.txt").read_text()
        (copy / "predictions.jsonl").write_text("".join(json.dumps({**row, "predicted": text}) + "\n" for row in rows))
        return [*words, "--part", "train"]
    if words[:2] == ["score", "program"]:
        text = (copy / "watch_tv.txt").read_text()
        row = {"id": "a", "predicted": text, "reference": text}
        (copy / "predictions.jsonl").write_text(json.dumps(row) + "\n")
        done(copy, "python", "cli.py", "home", "convert", "maple", "home.json")
    given = {"release.zip": str(REAL), "RELEASE.zip": str(REAL), "data_out": "mine", "other": "mine"}
    return [*(given.get(word, word) for word in words), *SMALL.get(words[0], ())]


def test_every_command_of_the_tour_ends_well(checkout):
    left_out = []
    for words in COMMANDS:
        needed = NEEDS.get(words[0])
        absent = any("elease.zip" in word.lower() for word in words) and not REAL.exists()
        if " ".join(words).startswith(UNFINISHED) or absent or (needed and find_spec(needed) is None):
            left_out.append(words[0])
            continue
        ran = run_in(checkout, "python", "cli.py", *prepared(checkout, words))
        assert ran.returncode == 0, f"{' '.join(words)}\n{ran.stdout[-3000:]}\n{ran.stderr[-3000:]}"
        assert "Traceback" not in ran.stderr, words
    assert len(left_out) < len(COMMANDS) / 3, left_out


def test_pictures_of_the_tour_are_those_that_its_commands_write(checkout):
    for name in ("pictures/sheet.png", "report_out/index.html", "figures/actions.png", "help.png"):
        assert (checkout / name).stat().st_size > 1000, name
