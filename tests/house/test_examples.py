"""The worked examples of docs/examples do what they say, in a folder of their own."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = sorted((ROOT / "docs/examples").glob("*.md"))
FENCE = re.compile(r'^```(\w+)(?: title="([^"]+)")?\n(.*?)^```$', re.DOTALL | re.MULTILINE)
APART = shutil.ignore_patterns(".*", "*.egg-info", "__pycache__", "build", "dist", "data_out", "benchmarks")

pytestmark = pytest.mark.slow


def blocks(page: Path) -> list[tuple[str, str, str]]:
    """(language, title, text) of every fenced block."""
    return [match.groups(default="") for match in FENCE.finditer(page.read_text("utf-8"))]


def ran(script: str, folder: Path, checkout: Path) -> str:
    """Run a block as its reader would, `hearth` and `python` on the path; its output."""
    tools = folder.parent / "bin"
    tools.mkdir(exist_ok=True)
    for name, words in (("hearth", f'"{checkout / "cli.py"}"'), ("python", "")):
        (tools / name).write_text(f'#!/bin/sh\nexec "{sys.executable}" {words} "$@"\n')
        (tools / name).chmod(0o755)
    # In a copy the package is the copy, not the checkout that .venv knows.
    site = folder.parent / "site"
    site.mkdir(exist_ok=True)
    if not (site / "hearth").is_symlink():
        (site / "hearth").symlink_to(checkout)
    environment = {**os.environ, "PATH": f"{tools}:{os.environ['PATH']}", "PYTHONPATH": str(site)}
    done = subprocess.run(
        ["bash", "-euo", "pipefail", "-c", script], cwd=folder, env=environment, capture_output=True, text=True,
        timeout=900, check=False,
    )  # fmt: skip
    assert done.returncode == 0, f"{script}\n{done.stdout}\n{done.stderr}"
    return done.stdout + done.stderr


def test_there_are_seven():
    assert len(EXAMPLES) == 7


@pytest.mark.parametrize("page", EXAMPLES, ids=lambda page: page.stem)
def test_an_example_does_what_it_says(page, tmp_path):
    folder, checkout = tmp_path / "here", ROOT
    if "stable_baselines3" in page.read_text("utf-8"):
        pytest.importorskip("stable_baselines3", reason="nothing to learn with: stable-baselines3 is not installed")
    if "python cli.py" in page.read_text("utf-8"):
        checkout = shutil.copytree(ROOT, folder, ignore=APART)
    folder.mkdir(exist_ok=True)
    printed = ""
    for language, title, text in blocks(page):
        if title:
            (folder / title).write_text(text, "utf-8")
        elif language == "bash":
            printed = ran(text, folder, checkout)
        elif language == "text":
            assert shown(text, printed), f"{text}\nis not in\n{printed}"


def shown(text: str, printed: str) -> bool:
    """Whether the lines of a block are successive lines of the output, those after `...` further below; numbers of
    several digits may differ.
    """
    lines = [_plain(line) for line in printed.splitlines() if line.strip()]
    at = 0
    for piece in re.split(r"^\.\.\.$", text, flags=re.MULTILINE):
        wanted = [_plain(line) for line in piece.splitlines() if line.strip()]
        found = next((n for n in range(at, len(lines) + 1) if lines[n : n + len(wanted)] == wanted), None)
        if found is None:
            return False
        at = found + len(wanted)
    return True


def _plain(line: str) -> str:
    return " ".join(re.sub(r"\d[\d,]+", "N", line).split())


def test_a_line_that_was_not_printed_is_seen():
    assert shown("a\n b", "a\n\nb\nc\n") and shown("a\n...\nc\n", "a\nb\nc") and shown("a\n...\n", "a\nb")
    assert not shown("a\nc", "a\nb\nc") and not shown("c\n...\na", "a\nb\nc")
    assert not shown("a\nc", "c\na") and not shown("a", "ab")
    assert shown("CLOSE  6,118", "CLOSE     70") and not shown("NOT_CLOSE 1", "NOT_CLOSE 2")
