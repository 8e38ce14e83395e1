"""A file's name says which of two like things it is: names repeat only where one file mirrors another."""

from __future__ import annotations

import subprocess
from collections import defaultdict
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

MIRRORS = frozenset({"simulation/actions", "repair/handlers"})
"""Folders whose files have the same names: an action's, and its repairs'."""

SUBJECTS = frozenset({"goals", "parallel"})
"""Names of a subject that each room treats in its own way; PettingZoo calls environments of several agents parallel."""


def mirrored(folders: list[str]) -> bool:
    """Return whether these are one folder, an action's and its repairs', or any of both and a command of that name."""
    others = set(folders) - {"commands"}
    return len(others) < 2 or others == MIRRORS


def test_names_repeat_only_where_files_mirror_each_other():
    names = subprocess.run(["git", "ls-files", "*.py"], cwd=ROOT, capture_output=True, text=True, check=True)
    folders = defaultdict(list)
    for path in map(Path, names.stdout.split()):
        if path.parts[0] not in ("tests", "docs", "benchmarks", "__init__.py") and path.stem != "__init__":
            folders[path.stem].append(path.parent.as_posix())
    repeated = {name: where for name, where in folders.items() if name not in SUBJECTS and not mirrored(where)}
    assert len(folders) > 300
    assert not repeated, f"give each a telling name: {repeated}"


LARGEST = 4_000_000
"""Bytes of a tracked file: more than any of ours; packages that somebody fetched beside the code have more."""


def test_no_tracked_file_is_a_package_or_larger_than_ours():
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    files = [ROOT / name for name in listed.split("\0") if name and (ROOT / name).is_file()]
    strange = [f.relative_to(ROOT).as_posix() for f in files if f.suffix == ".whl" or f.stat().st_size > LARGEST]
    assert not strange, f"remove them with git rm --cached: {strange}"
