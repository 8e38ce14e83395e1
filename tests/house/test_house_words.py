"""Files use the words of the field: none has a phrase that its readers would have to decode."""

from __future__ import annotations

import importlib
import re
import subprocess
import sys
from pathlib import Path

import pytest

from hearth.schemas.literals import RENAMED

ROOT = Path(__file__).resolve().parents[2]

ROOMS = (
    "schemas", "storage", "kb", "homes", "simulation", "grounding", "repair",
    "tests/schemas", "tests/storage", "tests/kb", "tests/homes", "tests/simulation", "tests/grounding", "tests/repair",
    "rendering", "datasets", "scoring", "analysis", "tests/rendering", "tests/datasets", "tests/scoring",
    "tests/analysis", "benchmarks", "tests/augment", "tests/oracles", "tests/golden", "pipelines", "docs", "README.md",
    "CONTRIBUTING.md", "cli.py", "__init__.py", "version.py", "tests/pipelines", "tests/commands", "commands",
    "tests/house", "tests/trust", "models", "tests/models", "web", "tests/web",
)  # fmt: skip
"""The folders and files that are checked."""

LINTER = ROOT / "tests/house/plain_words.py"

NAMING = ("test_house_words.py", "plain_words.py", "prompts.md")
"""Files that name the phrases, and the page that quotes the prompts, whose words have fingerprints."""

KINDS = frozenset({".py", ".yaml", ".md", ".expected", ".txt"})
"""Endings of the files that are read; pages and YAML too."""

PHRASES = {
    "told": "stored, reported or given",
    "untold": "not stored",
    "tells": "reports, or decides",
    "heard": "understood, or parsed",
    "stances": "hand and base pose",
    "surroundings": "build context",
    "spoils|spoilt|spoiling": "violates",
    "rehears\\w*": "coverage",
    "by lot": "random, or procedural",
    "in vain": "failed attempts",
    "at rest": "in its default state",
    "made otherwise": "perturbed",
    "so many": "the count's name",
    "no text": "not text",
    "clumsiness|idleness|loyalty": "rank, priority, switch penalty",
    "stowed|averted|shut_in": "in_closed_container, facing_away, doors_closed",
    "HEARD_NEARLY": "FUZZY_MATCH",
    "(?<!there )is no (?!more\\b|longer\\b)": "is not a",
}
"""A phrase as a regular expression, and the words to write instead."""

ALLOWED = {
    ("schemas/literals.py", "stowed|averted|shut_in"),  # names that readers of older datasets accept
    ("schemas/failures.py", "HEARD_NEARLY"),
    ("tests/schemas/test_failures.py", "HEARD_NEARLY"),
    ("commands/run_output.py", "stances"),  # a published key of `run --json`
    ("tests/commands/test_run_command.py", "stances"),
    ("analysis/synthesis.py", "told"),  # a key of older grammars
    ("kb/language/request_words.yaml", "heard"),  # a word of people
    ("models/reading/instruction_reading.py", "heard"),
    ("tests/datasets/test_cases.py", "stowed|averted|shut_in"),  # a row of an older dataset
}
"""Files that may have a phrase."""


def files():
    for room in ROOMS:
        paths = sorted((ROOT / room).rglob("*")) if (ROOT / room).is_dir() else [ROOT / room]
        yield from (path for path in paths if path.suffix in KINDS and path.is_file() and path.name not in NAMING)


@pytest.mark.parametrize("phrase", PHRASES)
def test_no_file_has_a_phrase_that_readers_have_to_decode(phrase):
    pattern = re.compile(rf"(?<![\w`])(?:{phrase})" + ("" if phrase.endswith(")") else r"\b"), re.IGNORECASE)
    found = [
        f"{name}:{number}: {line.strip()[:100]}"
        for path in files()
        if ((name := path.relative_to(ROOT).as_posix()), phrase) not in ALLOWED
        for number, line in enumerate(path.read_text(encoding="utf-8", errors="replace").splitlines(), 1)
        if pattern.search(line)
    ]
    assert not found, f"write {PHRASES[phrase]}:\n" + "\n".join(found)


def test_the_old_names_of_conditions_are_used_by_readers_alone():
    quoted = re.compile("|".join(f'"{name}"' for name in RENAMED))
    used = {path.relative_to(ROOT).as_posix() for path in files() if quoted.search(path.read_text(errors="replace"))}
    assert {name for name in used if not name.startswith("tests/")} == {"schemas/literals.py"}


def test_no_text_asks_its_reader_to_decode_it():
    done = subprocess.run([sys.executable, str(LINTER)], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize(
    ("source", "pattern"),
    [
        ('"""What a thing is."""', "question"),
        ('"""Names of what may be tried."""', "what as a noun"),
        ('"""The place of who sits there."""', "who as a subject"),
        ('"""A thing beside another."""', "beside"),
        ("# A thing that was told.", "told"),
        ('HELP = "run `python cli.py check`"', "python cli.py"),
    ],
)
def test_the_linter_finds_each_kind(source, pattern, tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(str(LINTER.parent))
    linter = importlib.import_module("plain_words")
    monkeypatch.setattr(linter, "ROOT", tmp_path)
    (tmp_path / "module.py").write_text(source + "\n")
    assert {each.pattern for each in linter.findings(tmp_path / "module.py")} == {pattern}
    (tmp_path / "module.py").write_text('"""A thing next to another."""\n')
    assert not list(linter.findings(tmp_path / "module.py"))


def test_the_list_of_allowed_places_is_short_and_used():
    sys.path.insert(0, str(LINTER.parent))
    linter = importlib.import_module("plain_words")
    assert len(linter.ALLOWED) < 60 and all(linter.ALLOWED.values())
    for (name, pattern), _ in linter.ALLOWED.items():
        kind = next(each for each in linter.PATTERNS if each.name == pattern)
        assert any(kind.found.search(text) for _, text, _ in linter.texts(ROOT / name)), f"{name}: no {pattern} left"
