"""Paths in the documents: every file and folder that README, CONTRIBUTING and their like name is in the checkout."""

from __future__ import annotations

import fnmatch
import os
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
BUILT = frozenset({".venv", ".git", "build", "data_out", "dist", "__pycache__"})
NAMES = (
    "*.md",
    "benchmarks/README.md",
    "data_raw/*.md",
    "data_raw/homes/*.md",
    "docs/**/*.md",
    "kb/*.md",
    "tests/trust/*.md",
)
DOCUMENTS = sorted(path for name in NAMES for path in ROOT.glob(name))
SPAN = re.compile(r"`([^`\n]+)`|\]\(([^)\s]+)\)")
FILE = re.compile(r"[\w.*-]+(?:/[\w.*-]+)*/?")
PAGE = re.compile(r"\bdocs/[\w/-]+\.md\b")
SUFFIXES = (".py", ".yaml", ".yml", ".csv", ".md", ".toml", ".lock", ".sh", ".sql", "Makefile", "/")
WRITTEN = ("data_out/", "build/", "my_programs/", "dist/", "x.yaml", "x.ids.csv", "RESULTS.md")
"""Beginnings of paths that commands or users write."""


def checkout() -> frozenset[str]:
    """The files and folders of the checkout, without those that are built."""
    found: set[str] = set()
    for folder, folders, files in os.walk(ROOT):
        folders[:] = [name for name in folders if name not in BUILT]
        inside = Path(folder).relative_to(ROOT)
        found |= {(inside / name).as_posix() for name in files} | {f"{(inside / name).as_posix()}/" for name in folders}
    return frozenset(found)


def paths(text: str) -> list[str]:
    """The words of code spans and links that look like paths of the checkout."""
    words = [word.rstrip(",.;") for span, link in SPAN.findall(text) for word in (span or link).split()]
    words = [re.sub(r"^(\.\./)+", "", word) for word in words]
    return [word for word in words if FILE.fullmatch(word) and word.endswith(SUFFIXES) and not word.startswith(WRITTEN)]


def missing(document: Path, known: frozenset[str]) -> list[str]:
    """The paths in a document that no file or folder ends with; `*` stands for any name."""
    found = paths(document.read_text("utf-8"))
    return [path for path in found if not any(fnmatch.fnmatch(f"/{name}", f"*/{path}") for name in known)]


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: str(path.relative_to(ROOT)))
def test_every_path_exists(document):
    assert not missing(document, checkout())


def test_documents_that_code_names_exist():
    known = checkout()
    code = [name for name in known if name.endswith(".py")]
    named = {(name, page) for name in code for page in PAGE.findall((ROOT / name).read_text("utf-8"))}
    assert len(named) > 3
    assert not [each for each in named if each[1] not in known]


def test_paths_are_seen(tmp_path):
    page = tmp_path / "page.md"
    page.write_text(
        "`exports/`, [rules](HOUSE.md), `kb/data/*.csv`, `cli.py kb` and `tests/gone/x.py`; [up](../kb/x.md)."
    )
    assert paths(page.read_text()) == [
        "exports/",
        "HOUSE.md",
        "kb/data/*.csv",
        "cli.py",
        "tests/gone/x.py",
        "kb/x.md",
    ]
    assert missing(page, checkout()) == ["exports/", "HOUSE.md", "tests/gone/x.py", "kb/x.md"]
