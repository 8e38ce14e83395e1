"""Copies of the checkout, whose commands run the copy's code."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def copied(place: Path) -> Path:
    """The checkout's tracked files in `place/hearth`; `python` in it is this one, and imports the copy."""
    copy = place / "hearth"
    names = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    for name in names.strip("\0").split("\0"):
        target = copy / name
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(ROOT / name, target, follow_symlinks=False)
    (place / "site").mkdir()
    (place / "site/hearth").symlink_to(copy)
    (place / "bin").mkdir()
    (place / "bin/python").write_text(f'#!/bin/sh\nexec "{sys.executable}" "$@"\n')
    (place / "bin/python").chmod(0o755)
    return copy


def run_in(copy: Path, *command: str) -> subprocess.CompletedProcess[str]:
    """Run something in a copy."""
    place = copy.parent
    path = f"{place / 'bin'}:{os.environ['PATH']}"
    environment = {**os.environ, "PATH": path, "PYTHONPATH": str(place / "site")}
    for name in [name for name in environment if name.startswith(("PYTEST_", "HEARTH_"))]:
        del environment[name]
    return subprocess.run(command, cwd=copy, env=environment, capture_output=True, text=True, check=False)


def done(copy: Path, *command: str) -> str:
    """Run something in a copy that has to succeed; its output."""
    ran = run_in(copy, *command)
    assert ran.returncode == 0, f"{' '.join(command)}\n{ran.stdout[-8000:]}\n{ran.stderr[-4000:]}"
    return ran.stdout
