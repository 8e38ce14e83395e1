"""Libraries and data that have one way in are used by that way only: DuckDB."""

import ast
import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
APART = {".venv", "tests", "benchmarks", "docs", "node_modules", "site"}
DOOR = "storage/duckdb_connections.py"

SOURCES = sorted(path for path in ROOT.rglob("*.py") if not APART & {*path.relative_to(ROOT).parts})


def opened(path):
    """The lines in which a file calls DuckDB's module itself, or takes its functions out of it."""
    for node in ast.walk(ast.parse(path.read_text())):
        if (
            isinstance(node, ast.ImportFrom)
            and node.module == "duckdb"
            and any(not each.name[0].isupper() for each in node.names)
        ):
            yield node.lineno
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
            owner = node.func.value
            if isinstance(owner, ast.Name) and owner.id == "duckdb" and node.func.attr != "tokenize":
                yield node.lineno


def test_duckdb_is_opened_in_one_place():
    found = {f"{path.relative_to(ROOT)}:{line}" for path in SOURCES for line in opened(path)}
    assert {place.partition(":")[0] for place in found} == {DOOR}, found


PRINTED = {
    ("commands/output.py", "print"): "the one function, `line`; tables and faults whose cells it has escaped",
    ("commands/output.py", "Console().print"): "the table of a terminal",
    ("commands/output.py", "sys.stdout.write"): "a JSON document, escaped as JSON",
    ("commands/corpus.py", "sys.stdout.buffer.writelines"): "lines of JSON, through `shown_line`",
    ("commands/query.py", "sys.stdout.write"): "pieces of a JSON document, escaped as JSON",
    ("cli.py", "sys.stderr.write"): "a sentence of ours",
    ("cli.py", "typer.echo"): "our version",
    ("storage/csv_files.py", "csv.writer"): "the one guarded writer, `rows_writer`",
    ("challenges/agent_guard.py", "sys.stderr.write"): "a line about a finalizer, through `shown`",
    ("challenges/agent_stderr.py", "sys.stderr.write"): "what agents' programs say, through `shown`",
    ("pipelines/engine/progress.py", "self._console.print"): "through `shown`, as commands are out of its reach",
    ("commands/model_output.py", "console.print"): "two columns in color, through `shown`",
    ("adapters/hearth-trl/recipes/grpo_on_cpu.py", "print"): "figures of a recipe",
}
"""Calls that put text out without `output.line` or `rows_writer`, by file, with the reason."""


STREAM = re.compile(r"sys\.(?:__)?std(?:out|err)(?:__)?\.(?:buffer\.|raw\.)*write(?:lines)?$")


def put_out(path):
    """Calls of a file that print, or make a writer of CSV."""
    for node in ast.walk(ast.parse(path.read_text())):
        if not isinstance(node, ast.Call):
            continue
        name = ast.unparse(node.func)
        last = name.rpartition(".")[2]
        streams = name in ("csv.writer", "csv.DictWriter", "typer.echo") or bool(STREAM.match(name))
        if name == "print" or streams or (last in ("print", "secho") and "." in name):
            yield name


def test_text_is_put_out_in_one_way():
    found = {(path.relative_to(ROOT).as_posix(), name) for path in SOURCES for name in put_out(path)}
    assert found <= PRINTED.keys(), sorted(found - PRINTED.keys())
    assert PRINTED.keys() <= {*found, ("commands/output.py", "print")}, "a reason for a call that is gone"


RAW = {
    "datasets/report/assets/index.html": (1, "the drawing of a plan, whose names its own writer escapes"),
    "analysis/prediction_examples.html": (1, "an attribute that is always the same"),
}
"""The number of a template's variables that are not escaped, with the reason."""


MARKUP = {"phrases.py": "sentences of ours for templates: the sentence and each value are escaped"}
"""Modules that make markup, with the reason."""


def test_no_template_has_raw_text():
    """Pages are written by templates that escape each variable."""
    marks = re.compile(r"\| ?safe\b|autoescape ?(=False|false)")
    texts = [path for path in ROOT.rglob("*.html") if not APART & {*path.relative_to(ROOT).parts}]
    found = {path.relative_to(ROOT).as_posix(): len(marks.findall(path.read_text())) for path in texts}
    assert {name: count for name, count in found.items() if count} == {name: count for name, (count, _) in RAW.items()}
    code = {path.name for path in SOURCES if re.search(r"Markup\(|mark_safe|autoescape=False", path.read_text())}
    assert code == {*MARKUP}
