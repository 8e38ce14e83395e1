"""The worked examples and the tutorial do what they say, in a folder of their own, and make the pictures they show."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = sorted((ROOT / "docs/examples").glob("*.md"))
ENVIRONMENTS = [ROOT / "docs/text-environment.md", ROOT / "docs/arrays.md"]
TUTORIAL = sorted((ROOT / "docs/tutorial").glob("*.md"))
OF_A_CHECKOUT = ("agents", "new-action")
"""Pages whose commands are given in Hearth's folder, of which they get a copy."""

APART = shutil.ignore_patterns(".*", "*.egg-info", "__pycache__", "build", "dist", "data_out", "benchmarks")


@pytest.fixture(scope="module")
def followed(module):
    return module("docs/hooks/documentation_commands.py")


@pytest.mark.slow
@pytest.mark.parametrize("page", [*EXAMPLES, *TUTORIAL, *ENVIRONMENTS], ids=lambda page: page.stem)
def test_a_page_does_what_it_says(followed, page, tmp_path):
    text, folder, checkout = page.read_text("utf-8"), tmp_path / "here", ROOT
    if "stable_baselines3" in text:
        pytest.importorskip("stable_baselines3", reason="nothing to learn with: stable-baselines3 is not installed")
    if "hearth model train" in text or "hearth study figure" in text or "import torch" in text:
        pytest.importorskip("torch", reason="nothing to train or to run policies with: torch is not installed")
    if "ArrayHomes" in text:
        pytest.importorskip("numba", reason="nothing to compile kernels with: numba is not installed")
    if page.stem in OF_A_CHECKOUT:
        checkout = shutil.copytree(ROOT, folder, ignore=APART)
    folder.mkdir(exist_ok=True)
    assert not list(followed.follow(page, folder, checkout))
    for file, made in followed.pictures(page):
        assert file.is_file() and (folder / made).stat().st_size > 1000, made


def test_a_chapter_of_the_tutorial_ends_in_a_picture_of_its_commands(followed):
    assert [page.stem for page in TUTORIAL] == ["build", "challenge", "collect", "help", "play", "train"]
    for page in TUTORIAL:
        shown = followed.pictures(page)
        assert shown and page.read_text("utf-8").rstrip().endswith(f'"{shown[-1][1]}")'), page.stem
        assert all(file.is_file() for file, _ in shown), (
            "make it with: python docs/hooks/documentation_commands.py docs/tutorial/*.md"
        )
        assert len(page.read_text("utf-8").split()) < 350, page.stem


def test_a_line_that_was_not_printed_is_seen(followed):
    shown = followed.shown
    assert shown("a\n b", "a\n\nb\nc\n") and shown("a\n...\nc\n", "a\nb\nc") and shown("a\n...\n", "a\nb")
    assert not shown("a\nc", "a\nb\nc") and not shown("c\n...\na", "a\nb\nc")
    assert not shown("a\nc", "c\na") and not shown("a", "ab")
    assert shown("CLOSE  6,118", "CLOSE     70") and not shown("NOT_CLOSE 1", "NOT_CLOSE 2")
