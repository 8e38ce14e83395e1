"""JSON that is printed, and JSON in files that people look at, moves no cursor and keeps the direction of text."""

from __future__ import annotations

import io
import json
import os
import re
import sys
from contextlib import ExitStack
from pathlib import Path

import pytest
from typer.testing import CliRunner

from hearth import cli
from hearth.commands import output
from hearth.commands.play import _transcript
from hearth.pipelines.engine.progress import JsonLines
from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.failures import Code
from hearth.schemas.terminal import BIDIRECTIONAL, shown_json, shown_line
from hearth.storage.files import read_json, write_json

CODES = (*range(32), *range(127, 160), 0x2028, 0x2029, *BIDIRECTIONAL)
HOSTILE = "a" + "".join(map(chr, CODES)) + "ü\U0001f600"
RAW = re.compile(f"[{''.join(re.escape(chr(code)) for code in CODES if code not in (9, 10))}]")


def harmless(text):
    """The value of a JSON text that has none of the characters."""
    assert not RAW.search(text), ascii(RAW.findall(text))
    return json.loads(text)


def test_what_is_printed_says_the_same(capsys):
    value = {HOSTILE: [HOSTILE, {"x": HOSTILE}]}
    output.emit(value)
    assert harmless(capsys.readouterr().out) == value
    output.say("", value, True)
    assert harmless(capsys.readouterr().out) == value


@pytest.mark.parametrize("code", CODES)
def test_each_character_is_escaped_as_json_has_it(code):
    text = json.dumps({"a": chr(code)}, ensure_ascii=False)
    assert harmless(shown_json(text)) == {"a": chr(code)} == harmless(shown_line(text.encode()).decode())


def test_files_for_people_say_the_same(tmp_path):
    output.write(tmp_path / "a/b.json", [HOSTILE])
    write_json(tmp_path / "c.json", {"x": HOSTILE})
    assert read_json(tmp_path / "c.json") == {"x": HOSTILE}
    with ExitStack() as stack:
        _transcript(tmp_path / "d.jsonl", stack)({"x": HOSTILE})
    found = [harmless((tmp_path / name).read_text()) for name in ("a/b.json", "c.json", "d.jsonl")]
    assert found == [[HOSTILE], {"x": HOSTILE}, {"x": HOSTILE}]


def test_progress_in_json_is_harmless():
    stream = io.StringIO()
    JsonLines(stream, lambda: 1.0)._print(HOSTILE)
    assert harmless(stream.getvalue())["event"] == HOSTILE


@pytest.mark.parametrize("words", [
    ("query", "{data}", "SELECT {text} AS a, [{text}] AS b, {{'k': {text}}} AS c", "--json"),
    ("query", "{data}", "SELECT {text} AS a", "--csv"), ("query", "{data}", "SELECT {text} AS a", "--tsv"),
    ("query", "{data}", "SELECT {text} AS a"), ("query", "{data}", "SELECT {text} AS \"{raw}\"", "--json"),
    ("query", "{data}", "SELECT {text} AS a", "--json", "--out", "{out}.csv"),
    ("report", "{raw}", "--json"), ("diff", "{data}", "{raw}", "--json"), ("export", "{raw}", "--json"),
    ("check", "{raw}", "--json"), ("run", "{raw}", "--json"), ("home", "show", "{raw}", "--json"),
    ("kb", "find", "{raw}", "--json"), ("kb", "show", "{raw}", "--json"), ("challenge", "score", "{raw}", "--json"),
    ("{raw}",), ("kb", "{raw}"), ("check", "--{raw}"), ("--{raw}",), ("query", "x", "y", "--within", "{raw}"),
])  # fmt: skip
def test_every_answer_is_harmless(made, tmp_path, words):
    raw = HOSTILE.replace("\0", "").replace("\n", "")
    text = "chr(27) || chr(155) || chr(8238) || chr(127) || 'x'"
    filled = [word.format(data=made.out / "publish", text=text, raw=raw, out=tmp_path / "a") for word in words]
    result = CliRunner().invoke(cli.app, filled)
    said = result.stdout + result.stderr
    assert said and not RAW.search(said), ascii(said)
    assert "error in Hearth" not in said, said
    if "--json" in words and "--out" not in words and result.exit_code == 0:
        harmless(result.stdout)


@pytest.mark.skipif(sys.platform != "linux", reason="other systems have no such names")
@pytest.mark.parametrize("there", [True, False])
@pytest.mark.parametrize("words", ["check FILE", "run FILE", "hazards FILE", "home show FILE", "query FILE x"])
def test_a_name_that_is_no_text_is_in_a_document(tmp_path, words, there):
    """Bytes that are not UTF-8 in a file's name were an error of ours, and a traceback."""
    file = tmp_path / os.fsdecode(b"a\xff.txt")
    if there:
        file.write_text("Watch TV\nWatch it.\n\n\n[Walk] <couch> (1)\n[Sit] <couch> (1)\n")
    result = CliRunner().invoke(cli.app, [str(file) if word == "FILE" else word for word in words.split()] + ["--json"])
    assert "An error in Hearth" not in result.output and isinstance(result.exception, (SystemExit, type(None)))
    assert json.loads(result.stdout) is not None and (not there or "\\udcff" in result.stdout or result.exit_code == 0)


def test_texts_deep_in_a_document_are_escaped_where_they_are_no_text():
    half = "\udcff"
    fault = Diagnostic(Code.EMPTY, "empty", file=half)
    found = json.loads(output._document({half: [(half, 1.5, None)], "path": Path(half), "fault": (fault,)}))
    assert found["\\udcff"] == [["\\udcff", 1.5, None]] and found["path"] == "\\udcff"
    assert found["fault"][0]["file"] == "\\udcff" and found["fault"][0]["code"] == "EMPTY"
