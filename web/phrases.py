"""The sentences that pages say to people, from the one table of each language: `phrases.yaml` is the English one."""

from __future__ import annotations

import re
from collections.abc import Mapping
from contextvars import ContextVar
from functools import cache
from typing import Any

import orjson
from markupsafe import Markup, escape

from hearth.schemas.failures import Code
from hearth.schemas.yaml_limits import packaged

NOT_FOR_PEOPLE = re.compile(r"[`_]|\b[A-Z]{3,}\b|--\w")
"""Words for developers alone: codes, names of classes and fields, options and commands."""

ENGLISH, MIRRORED = "en", "qps-plocm"

LANGUAGES: Mapping[str, str] = {ENGLISH: "phrases.yaml", "de": "phrases_german.yaml", MIRRORED: ""}
"""The languages of participants' pages, with their tables. The last is for trying: English in brackets, from right to
left, so that what is not in the table is seen."""

_LANGUAGE: ContextVar[str] = ContextVar("language", default=ENGLISH)

Phrases = dict[str, dict[str, str]]


def speak(language: str) -> None:
    """Say sentences in a language from now on, in this request or socket."""
    _LANGUAGE.set(language)


def language() -> str:
    """Return the language in which sentences are said now."""
    return _LANGUAGE.get()


def direction() -> str:
    """Return the direction in which that language is written, as HTML has it."""
    return "rtl" if language() == MIRRORED else "ltr"


def preferred(accepted: str) -> str:
    """Return the first language of a browser's `Accept-Language` that there is; English if there is none."""
    for each in accepted[:200].split(","):
        name = each.partition(";")[0].strip().lower().partition("-")[0]
        if name in LANGUAGES:
            return name
    return ENGLISH


@cache
def phrases(language: str = ENGLISH) -> Phrases:
    """Return the sentences by the part of the pages that says them, and by their names."""
    if language == MIRRORED:
        return {part: {name: f"⟦{said}⟧" for name, said in some.items()} for part, some in phrases().items()}
    found: Phrases = packaged("hearth.web", LANGUAGES[language])
    return found


def say(part: str, name: str, **values: Any) -> str:
    """Return a sentence, with its values filled in."""
    return phrases(language())[part][name].format(**values)


def say_in_page(part: str, name: str, **values: Any) -> Markup:
    """Return a sentence for a template; values that are no markup, such as links, are escaped."""
    return Markup(escape(phrases(language())[part][name])).format(**values)


def room_title(name: str, title: str) -> str:
    """Return a room's title in the language of the page; its own where the table lacks it."""
    return phrases(language())["frame"].get(name, title)


def thing_name(name: str) -> str:
    """Return what people call a thing, in their language; its English name where the table lacks it."""
    return phrases(language()).get("things", {}).get(name, name)


def refused(code: Code, place: str = "", expected: str = "") -> str:
    """Return the sentence about a refusal, with a remedy.

    Args:
        code: of the refusal.
        place: the field at fault.
        expected: what was expected there; left out where only developers would understand it.
    """
    known = phrases(language())["refused"]
    if str(code) in known:
        return known[str(code)]
    if place and expected and not NOT_FOR_PEOPLE.search(f"{place} {expected}"):
        return say("refused", "field", place=place, expected=expected)
    return known["other"]


@cache
def script(language: str) -> bytes:
    """Return the sentences as a module for browsers."""
    return b"export default " + orjson.dumps({**phrases(language), "language": language}) + b";\n"
