"""The linter of plain words: `python tests/house/plain_words.py [--count] [FILE OR FOLDER]...`.

It reads docstrings, messages and comments of the package, its YAML and its pages, and reports each place
where a reader would have to decode a sentence. Every pattern has a name, a regular expression and the
words to write instead. `ALLOWED` lists the places that stay, each with its reason.
"""

from __future__ import annotations

import ast
import collections
import io
import re
import subprocess
import sys
import tokenize
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[2]

QUESTION = re.compile(r"^(What|Whether|How|Why|Which|Who|Whose|Whom|Where|When|Is|Are|Does|Can|Has|Have)\b")
"""First words of a docstring that asks instead of naming a thing or an act."""


class Pattern(NamedTuple):
    """One pattern that plain text does not have."""

    name: str
    found: re.Pattern[str]
    rather: str


def _of(name: str, expression: str, rather: str) -> Pattern:
    return Pattern(name, re.compile(expression, re.IGNORECASE), rather)


PATTERNS = (
    _of(
        "what as a noun",
        r"\b(?:of|in|by|for|to|from|with|at|on|into|than|as|about|and|under|beside|near|before|after)"
        r" what\b(?! is it| for)",
        "name the thing: `allowed actions`, not `names of what may be tried`",
    ),
    _of(
        "who as a subject",
        r"(?:^|[.:;(]\s+|\b(?:for|of|to|by|around|from|with|at|than|as|near|beside|behind|under) )"
        r"who(?:ever)? (?!is who)",
        "the agent, the character, the caller, the reader",
    ),
    _of("mend", r"\bmend(?:s|ed|ing|able)?\b(?!, stitch| the chair)", "repair, fix"),
    _of("told", r"\b(?:told|untold)\b", "given, known to, reported"),
    _of("in vain", r"\bin vain\b", "failed attempts"),
    _of("the like", r"\band the like\b|\bor the like\b", "name them, or `and so on`"),
    _of("do again", r"\b(?:do|does|did|done|doing) (?:it |them |every \w+ )?again\b", "re-run, repeat"),
    _of("goes by", r"\b(?:go|goes|going) by\b(?! (?:car|bus|train))", "uses"),
    _of("beside", r"(?<!`)\bbeside\b(?!:)", "next to, compared with, as well as"),
    _of("lay over", r"\blays? \w+(?: \w+)? over\b", "overlays"),
    _of("of its own kind", r"\bno \w+ of its own kind\b", "name it"),
    _of("python cli.py", r"\bpython cli\.py\b", "hearth"),
)
"""Patterns of every kind of text."""

_FORMAT = "a key of the format of plans, or a message about it"
_COMMENTS = "comments of columns are part of published catalogs, which `verify` compares"
_NOTES = "notes on measurements, stored with the numbers"
_URL = "an address that links of earlier versions have"
_PHRASE = "a phrase of people, not of Hearth"
_CHECKOUT = "the name that a reader in a checkout can type"

ALLOWED: dict[tuple[str, str], str] = {
    ("README.md", "python cli.py"): _CHECKOUT,
    ("cli.py", "python cli.py"): _CHECKOUT,
    ("commands/command_line_name.py", "python cli.py"): _CHECKOUT,
    ("analysis/synthesis.py", "told"): "a key of grammars of 0.1",
    ("analysis/synthesis.yaml", "what as a noun"): _PHRASE,
    ("commands/film_output.py", "beside"): "the name of a published file",
    ("commands/home.py", "beside"): "a published key of `home stats --json`",
    ("docs/tables.md", "beside"): _COMMENTS,
    ("docs/tables.md", "what as a noun"): _COMMENTS,
    ("schemas/published_rows.py", "what as a noun"): _COMMENTS,
    ("schemas/row_types.py", "who as a subject"): _COMMENTS,
    ("schemas/stage_rows.py", "beside"): _COMMENTS,
    ("schemas/stage_rows.py", "what as a noun"): _COMMENTS,
    ("docs/thesis.md", "beside"): _NOTES,
    ("docs/thesis.md", "what as a noun"): _NOTES,
    ("docs/thesis.yaml", "beside"): _NOTES,
    ("docs/thesis.yaml", "what as a noun"): _NOTES,
    ("homes/plans/furniture.py", "beside"): _FORMAT,
    ("interop/scene_graphs/shapes.yaml", "beside"): "a word of relations that others write",
    ("homes/plans/object_packing.py", "beside"): _FORMAT,
    ("homes/plans/plan_entries.py", "beside"): _FORMAT,
    ("homes/procedural/furnishing.py", "beside"): _FORMAT,
    ("envs/session.py", "told"): "a parameter of 0.2",
    ("kb/data/repairs.yaml", "what as a noun"): "texts of repairs in published reports",
    ("kb/language/request_words.yaml", "beside"): _PHRASE,
    ("kb/language/requests.yaml", "beside"): _PHRASE,
    ("models/reading/mentions.py", "beside"): _PHRASE,
    ("models/reading/rewordings.py", "beside"): _PHRASE,
    ("kb/loading/load.py", "lay over"): "an act of the reader on files",
    ("simulation/engine.py", "what as a noun"): "the text of stored failures",
    ("web/annotate/annotate_room.py", "mend"): _URL,
    ("web/annotate/annotate_tables.py", "mend"): "a value of published tables",
    ("web/annotate/review_stage.py", "mend"): _URL,
    ("web/templates/annotate/review.html", "mend"): _URL,
}
"""Places that keep a pattern, (file, pattern name), and the reason."""


class Finding(NamedTuple):
    """One place that a reader would have to decode."""

    file: str
    line: int
    pattern: str
    text: str
    rather: str


def texts(path: Path) -> Iterator[tuple[int, str, bool]]:
    """Yield each text of a file for readers: its line, its words, and whether it is a docstring's beginning."""
    source = path.read_text(encoding="utf-8", errors="replace")
    if path.suffix != ".py":
        yield from ((number, line, False) for number, line in enumerate(source.splitlines(), 1))
        return
    tree = ast.parse(source)
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            for number, line in enumerate(node.value.splitlines()):
                yield node.lineno + number, line.strip(), False
    for node in _docstrings(tree):
        yield node.lineno, node.value.strip(), True
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type == tokenize.COMMENT:
            yield token.start[0], token.string.lstrip("# "), False


def _docstrings(tree: ast.AST) -> Iterator[ast.Constant]:
    """Yield the texts that stand alone as statements: docstrings of functions, classes, modules and constants."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str):
            yield node.value


def findings(path: Path) -> Iterator[Finding]:
    """Yield what the linter finds in one file, without the places that are allowed."""
    name = path.relative_to(ROOT).as_posix()
    for line, text, docstring in texts(path):
        if docstring:
            if QUESTION.match(text):
                yield Finding(name, line, "question", text.splitlines()[0], "Return ..., or a noun")
            continue
        for pattern in PATTERNS:
            if (name, pattern.name) not in ALLOWED:
                for _ in pattern.found.finditer(text):
                    yield Finding(name, line, pattern.name, text.strip(), pattern.rather)


SKIPPED = ("tests/", "data_raw/", ".types/", "docs/hooks/", "benchmarks/")
"""Folders that are not read: tests, people's texts, and programs that no reader of Hearth meets."""


def files(names: list[str]) -> list[Path]:
    """Return the files to read: those named, or all of the package, its knowledge and its pages."""
    listed = subprocess.run(["git", "ls-files", *names], cwd=ROOT, capture_output=True, text=True, check=True)
    return [
        ROOT / name
        for name in listed.stdout.splitlines()
        if name.endswith((".py", ".md", ".yaml", ".html"))
        and (ROOT / name).exists()
        and (names or not name.startswith(SKIPPED))
        and name != "CHANGELOG.md"
    ]


def main(arguments: list[str]) -> int:
    """Print the findings of the files named, or their number by pattern; return 1 if there are any."""
    names = [each for each in arguments if each != "--count"]
    found = [each for path in files(names) for each in findings(path)]
    if "--count" in arguments:
        for pattern, number in sorted(collections.Counter(each.pattern for each in found).items()):
            print(f"{number:6d}  {pattern}")
    else:
        for each in found:
            print(f"{each.file}:{each.line}: {each.pattern}: {each.text[:110]}  (write: {each.rather})")
    return bool(found)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
