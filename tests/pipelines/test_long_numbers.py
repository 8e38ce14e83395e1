"""Numbers of more digits than Python reads: a fault of their file, and the others of its folder are read."""

from __future__ import annotations

import pytest
from typer.testing import CliRunner

from hearth import cli

DIGITS = "9" * 5_000
STEP = "[Walk] <fridge> (1)"

FILES = {
    "yaml value": ("a.yaml", f'title: T\nprogram: "{STEP}"\nextra: {DIGITS}\n'),
    "yaml key": ("a.yaml", f'- title: T\n  program: "{STEP}"\n  {DIGITS}: 1\n'),
    "yaml title": ("a.yaml", f'title: {DIGITS}\nprogram: "{STEP}"\n'),
    "yaml list": ("a.yaml", f"- walk to the fridge\n- {DIGITS}\n"),
    "second document": ("a.yaml", f'title: T\nprogram: "{STEP}"\n---\nextra: {DIGITS}\n'),
    "yaml sign and hex": ("a.yaml", f'title: T\nprogram: "{STEP}"\nextra: -{DIGITS}\nother: 0x{DIGITS}\n'),
    "json": ("a.json", f'{{"title": "T", "program": "{STEP}", "extra": {DIGITS}}}'),
    "json with a key twice": ("a.json", f'{{"title": "T", "program": "{STEP}", "a": {DIGITS}, "a": 1}}'),
    "json step": ("a.json", f'{{"title": "T", "steps": [{{"action": "walk", "objects": [["fridge", {DIGITS}]]}}]}}'),
    "json lines": ("a.jsonl", f'{{"title": "T", "program": "{STEP}", "extra": {DIGITS}}}\n'),
    "graph": ("a.json", f'{{"nodes": [{{"id": {DIGITS}, "class_name": "fridge"}}], "edges": []}}'),
    "csv": ("a.csv", f'title,program,n\nT,"{STEP}",{DIGITS}\n'),
    "csv id": ("a.csv", f'id,title,program\n{DIGITS},T,"{STEP}"\n'),
    "instance": ("a.txt", f"T\n\n\n[Walk] <fridge> ({DIGITS})\n"),
    "count": ("a.txt", f"T\n\n\nrepeat {DIGITS} times: walk to the fridge\n"),
    "numbered steps": ("a.md", f"# T\n\n{DIGITS}. Walk to the fridge\n"),
    "code": ("a.py", f'def t():\n    for i in range({DIGITS}):\n        walk("fridge", {DIGITS})\n'),
    "plan of a planner": ("a.txt", f"{DIGITS}: (walk fridge_{DIGITS}) [1]\n"),
}
"""A file of each kind with such a number where it may stand."""


@pytest.mark.parametrize("name", FILES)
def test_a_number_of_5000_digits_is_no_error_of_ours(tmp_path, name):
    file, text = FILES[name]
    (tmp_path / file).write_text(text)
    result = CliRunner().invoke(cli.app, ["check", str(tmp_path / file)])
    assert result.exit_code in (0, 1) and "error in Hearth" not in result.output and "4300" not in result.output, (
        result.output
    )


@pytest.mark.parametrize("name", [name for name in FILES if name.startswith("yaml")])
def test_the_folder_goes_on(tmp_path, name, built):
    file, text = FILES[name]
    source = tmp_path / "source"
    source.mkdir()
    (source / file).write_text(text)
    (source / "good.txt").write_text(f"Good\n\n\n{STEP}\n")
    made = built(source)
    made.run("ingest")
    assert "Good" in [row["title"] for row in made.rows("ingest")]


def test_the_fault_names_its_line(tmp_path):
    (tmp_path / "a.yaml").write_text(FILES["yaml value"][1])
    result = CliRunner().invoke(cli.app, ["check", str(tmp_path / "a.yaml")])
    assert result.exit_code == 1 and "5,000 digits" in result.output and "a.yaml:3" in result.output, result.output
