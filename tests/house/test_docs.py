"""The documentation's made pages: every command's help, every action, table and failure is in them."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from hearth import cli
from hearth.datasets.format.catalog import VIEWS, comments
from hearth.kb.loading.load import default
from hearth.repair.perturbation import PERTURBATIONS
from hearth.schemas.failures import Code
from hearth.schemas.tables import TABLES, nested

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def pages(module):
    return module("docs/hooks/pages.py")


def test_every_commands_help_is_there(pages):
    text = pages.commands()
    for name in cli.COMMANDS_BY_NAME:
        command = cli.load(name)
        for words in (name, *(f"{name} {part}" for part in getattr(command, "commands", {}))):
            assert f"\n### {words}\n" in text
            assert f"hearth {words} [" in text, words
    assert text.count("Example") >= len(cli.COMMANDS_BY_NAME) - 4


def test_actions_objects_tables_and_failures_are_there(pages):
    known = default()
    assert all(f"`{name}`" in pages.actions() for name in known.actions)
    assert all(f"`{name}`" in pages.objects() for name in known.objects)
    assert all(f"## {name}\n" in pages.tables() for name in (*TABLES, *VIEWS))


def test_every_failure_has_its_meaning(pages):
    rows = {row.split(" | ")[0]: row.split(" | ")[1] for row in pages.failures().splitlines() if row.startswith("| `")}
    assert [*rows] == [f"| `{code}`" for code in Code]
    assert all(len(meaning) > 10 and "{" not in meaning for meaning in rows.values())
    assert rows["| `INSIDE_CLOSED`"] == "the thing is inside the other thing, which is closed"


@pytest.mark.parametrize("name", ["tables.md", "pictures/tables.svg", "prompts.md"])
def test_pages_that_are_kept_are_current(pages, name):
    kept = ROOT / "docs" / name
    assert kept.read_text("utf-8") == pages.WRITTEN[name](), "write it with: python docs/hooks/pages.py"


def test_the_page_of_the_tables_has_all_that_has_a_comment(pages):
    text = pages.tables()
    for table, schema in TABLES.items():
        section = text.split(f"\n## {table}\n")[1].split("\n## ")[0]
        assert all(f"| `{path}` |" in section for column in schema for path, _ in nested(column))
    commented = [words.split()[3:] for words in comments() if words.startswith("COMMENT ON MACRO")]
    assert commented and all(f"`{words[words[0] == 'TABLE']}(" in text for words in commented)
    assert ">repairs</text>" in pages.diagram() and pages.diagram().count("<path") > 10


def test_every_module_has_a_page_and_a_line(pages):
    listed = pages.library()
    for name in pages.modules():
        assert f"]({Path(name).name}): " in listed, name


def test_pages_for_all_installations_name_the_command_that_all_have():
    pages = [*(ROOT / "docs").rglob("*.md"), *(ROOT / "web/templates").rglob("*.html")]
    pages += [*(ROOT / "commands").glob("*.py"), ROOT / "kb/README.md", *(ROOT / "data_raw").rglob("README.md")]
    checked = [page for page in pages if page.name != "command_line_name.py"]
    assert not [page for page in checked if "python cli.py" in page.read_text("utf-8")]


def test_homes_and_the_knowledge_have_pages_that_name_the_command_of_all(pages):
    for page, words in (("homes.md", "home: hut"), ("knowledge.md", "waffle_iron")):
        text = pages.PAGES[page]()
        assert words in text and "python cli.py" not in text
    assert "](homes.md)" in pages.PAGES["index.md"]() and "](knowledge.md)" in pages.PAGES["index.md"]()


def test_the_page_of_the_tables_names_what_there_is_and_no_module(pages):
    text = pages.tables()
    assert not re.findall(r"\| [^|]*(?:, \.\.\.|\w\.\.\.|see `)[^|]* \|", text)
    (kinds,) = re.findall(r"what was changed: (.*?) \|", text)
    assert re.split(", | or ", kinds) == [*PERTURBATIONS]
