"""Sentences for people stand in one table, and no page for people names a code, a class, a field or a command."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from hearth.schemas.failures import Code
from hearth.web.phrases import NOT_FOR_PEOPLE, phrases, refused

WEB = Path(__file__).resolve().parents[2] / "web"

FOR_RESEARCHERS = {
    "desk.html": "the desk", "desk_door.html": "the desk's door", "annotate/desk.html": "the desk",
    "annotate/invitation.html": "the desk", "play/desk.html": "the desk", "study/desk.html": "the desk",
    "study/desk_none.html": "the desk",
    "study/trial.html": "the desk", "annotate/item.html": "the desk",
    "study/none.html": "shown where a server was started for no study",
    "fault_facts.html": "shown at the desk alone", "start.html": "names what a server lacks, and how it is fetched",
}  # fmt: skip
"""Templates that researchers read, with the reason."""

TEMPLATES = sorted(each.relative_to(WEB / "templates").as_posix() for each in (WEB / "templates").rglob("*.html"))

_MARKUP = re.compile(r"\{%.*?%\}|\{\{.*?\}\}|<[^>]*>", re.DOTALL)

_DEVELOPERS = re.compile(r"<code>|`|\b[A-Z]{2,}_[A-Z_]+\b|\b[a-z]+_[a-z_]+\b|--[a-z]")

_SENTENCE = re.compile(r"""(["`])((?:\\.|(?!\1).)*\b[a-z]+ [a-z]+ [a-z]+\b(?:\\.|(?!\1).)*[.!?…]?)\1""")
"""A text of three or more words in a script."""


@pytest.mark.parametrize("part", phrases())
def test_no_sentence_of_the_table_is_for_developers(part):
    for name, sentence in phrases()[part].items():
        plain = re.sub(r"\{\w+\}", "", sentence)
        assert not NOT_FOR_PEOPLE.search(plain), f"{part}.{name}: {sentence}"


@pytest.mark.parametrize("template", [each for each in TEMPLATES if each not in FOR_RESEARCHERS])
def test_no_page_for_people_names_what_is_for_developers(template):
    text = (WEB / "templates" / template).read_text("utf-8")
    assert "<code>" not in text
    assert not _DEVELOPERS.findall(_MARKUP.sub(" ", text))


def test_researchers_pages_are_there():
    assert set(FOR_RESEARCHERS) <= set(TEMPLATES)


@pytest.mark.parametrize("script", sorted((WEB / "static/play").glob("*.js")), ids=lambda each: each.name)
def test_scripts_of_play_have_no_sentence_of_their_own(script):
    found = [said for _, said in _SENTENCE.findall(re.sub(r"//.*", "", script.read_text("utf-8"))) if ";" not in said]
    assert found == [], "it belongs into web/phrases.yaml"


@pytest.mark.parametrize("code", Code, ids=str)
def test_every_refusal_has_a_sentence_with_what_one_can_do(code):
    said = refused(code, "title", "at most 80 characters")
    assert len(said) > 20 and said[-1] in ".…" and not NOT_FOR_PEOPLE.search(said)


def test_what_only_developers_understand_is_left_out():
    remedy = "`challenge tasks household`"
    assert refused(Code.BAD_ARGUMENT, "task", remedy) == phrases()["refused"]["other"]
    assert refused(Code.BAD_ARGUMENT, "household_id", "a text") == phrases()["refused"]["other"]
    assert "at most 80 characters" in refused(Code.BAD_ARGUMENT, "title", "at most 80 characters")
