"""The documentation's made pages: every command's help, every action, table and failure is in them."""

from __future__ import annotations

from pathlib import Path

import pytest

from hearth import cli
from hearth.kb.loading.load import default
from hearth.schemas.failures import Code
from hearth.schemas.tables import TABLES


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
    assert all(f"## {name}\n" in pages.tables() for name in TABLES)
    assert all(f"`{code}`" in pages.failures() for code in Code)


def test_every_module_has_a_page_and_a_line(pages):
    listed = pages.library()
    for name in pages.modules():
        assert f"]({Path(name).name}): " in listed, name
