"""The documentation as one walks it: pages in two clicks from the first, and links that lead somewhere."""

from __future__ import annotations

import ast
import posixpath
import re
from pathlib import Path

import pytest
import yaml

from hearth import cli

ROOT = Path(__file__).resolve().parents[2]
CODE = re.compile(r"^```.*?^```|`[^`\n]*`", re.DOTALL | re.MULTILINE)
LINK = re.compile(r"\]\(([^)\s]+)(?: \"[^\"]*\")?\)")


@pytest.fixture(scope="module")
def pages(module):
    """Text of every page by its path."""
    made = module("docs/hooks/pages.py")
    written = {str(path.relative_to(ROOT / "docs")): path.read_text("utf-8") for path in (ROOT / "docs").rglob("*.md")}
    written = {name: text if "/" in name else made.of_the_site(text) for name, text in written.items()}
    return written | {name: page() for name, page in made.PAGES.items()} | made.modules()


@pytest.fixture(scope="module")
def navigation():
    """The pages that stand beside every page."""
    text = (ROOT / "mkdocs.yml").read_text("utf-8")
    entries = yaml.safe_load(text)["nav"]

    def listed(entry):
        return [entry] if isinstance(entry, str) else [page for each in entry for page in listed(each)] if isinstance(
            entry, list) else [page for each in entry.values() for page in listed(each)]  # fmt: skip

    return listed(entries)


def links(page: str, text: str) -> list[tuple[str, str]]:
    """(path, anchor) of the links of a page into the documentation, code left out."""
    found = [link for link in LINK.findall(CODE.sub("", text)) if not re.match(r"[a-z]+:", link)]
    parts = [link.partition("#") for link in found]
    return [(posixpath.normpath(posixpath.join(posixpath.dirname(page), path)) if path else page, anchor)
            for path, _, anchor in parts]  # fmt: skip


def anchors(text: str) -> set[str]:
    """The anchors of a page's headings, as Markdown makes them."""
    plain = re.sub(r"^```.*?^```", "", text, flags=re.DOTALL | re.MULTILINE)
    titles = [re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", title) for title in re.findall(r"^#+ (.+)$", plain, re.M)]
    return {re.sub(r"[-\s]+", "-", re.sub(r"[^\w\s-]", "", title).strip().lower()) for title in titles}


def test_every_page_is_two_clicks_away(pages, navigation):
    assert set(navigation) <= set(pages) and len(set(navigation)) == len(navigation)
    near = {"index.md", *navigation}
    near |= {path for page in near for path, _ in links(page, pages[page])}
    assert not set(pages) - near


def test_every_command_and_entry_point_is_a_heading_of_a_page_one_click_away(pages, navigation, module):
    made = module("docs/hooks/pages.py")
    assert {"reference/commands.md", "python-api.md"} <= set(navigation)
    for name in cli.COMMANDS_BY_NAME:
        parts = getattr(cli.load(name), "commands", {})
        for words in (name, *(f"{name} {part}" for part in parts)):
            assert words.replace(" ", "-") in anchors(pages["reference/commands.md"]), words
    for place in (each for group in made.ENTRY_POINTS.values() for each in group):
        assert f"\n### {place.replace(':', '.')}\n" in pages["python-api.md"], place


def test_links_of_pages_lead_somewhere_in_a_checkout_too():
    for path in (ROOT / "docs").rglob("*.md"):
        for link, _ in links("", path.read_text("utf-8")):
            assert not link.endswith(".md") or (path.parent / link).is_file(), f"{path}: {link}"


def test_links_lead_somewhere(pages):
    lost = []
    for page, text in pages.items():
        for path, anchor in links(page, text):
            known = path in pages or (ROOT / "docs" / path).is_file()
            if not known or (anchor and path in pages and anchor not in anchors(pages[path])):
                lost.append((page, path, anchor))
    assert not lost
    assert sum(len(links(page, text)) for page, text in pages.items()) > 100


def arguments(node: ast.FunctionDef) -> tuple[set[str], set[str]]:
    """The arguments that a docstring describes, several a line if alike, and those of the signature."""
    section = re.search(r"^Args:\n((?:    .*\n|\n)+)", f"{ast.get_docstring(node) or ''}\n", re.M)
    lines = re.findall(r"^    (\*{0,2}\w+(?:, \w+)*):", section[1], re.M) if section else []
    given = node.args
    own = [*given.posonlyargs, *given.args, *given.kwonlyargs, *filter(None, (given.vararg, given.kwarg))]
    return {name.strip("* ") for line in lines for name in line.split(",")}, {each.arg for each in own}


def test_arguments_in_docstrings_are_those_of_the_signature(module):
    wrong = []
    for package in module("docs/hooks/pages.py").PACKAGES:
        for file in (ROOT / package).rglob("*.py"):
            for node in ast.walk(ast.parse(file.read_text("utf-8"))):
                if isinstance(node, ast.FunctionDef) and (lost := set.difference(*arguments(node))):
                    wrong.append((str(file.relative_to(ROOT)), node.name, sorted(lost)))
    assert not wrong


def test_an_argument_that_is_not_there_is_seen():
    node = ast.parse('def f(a, b):\n    """X.\n\n    Args:\n        a, c: Y:\n            z: more.\n    """').body[0]
    assert set.difference(*arguments(node)) == {"c"}


def test_a_lost_link_is_seen():
    assert links("a/b.md", "[x](../c.md#d) ![y](z.png \"w\") `[n](o.md)` [u](https://x.org)") == [
        ("c.md", "d"), ("a/z.png", ""),
    ]  # fmt: skip
    assert anchors("# Two words, `code`\n```\n# no\n```\n") == {"two-words-code"}
