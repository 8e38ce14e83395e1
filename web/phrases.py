"""The sentences that pages say to people, from the one table of them: `phrases.yaml`."""

from __future__ import annotations

import re
from functools import cache
from typing import Any

import orjson

from hearth.schemas.failures import Code
from hearth.schemas.yaml_limits import packaged

NOT_FOR_PEOPLE = re.compile(r"[`_]|\b[A-Z]{3,}\b|--\w")
"""Words for developers alone: codes, names of classes and fields, options and commands."""


@cache
def phrases() -> dict[str, dict[str, str]]:
    """Return the sentences by the part of the pages that says them, and by their names."""
    found: dict[str, dict[str, str]] = packaged("hearth.web", "phrases.yaml")
    return found


def say(part: str, name: str, **values: Any) -> str:
    """Return a sentence, with its values filled in."""
    return phrases()[part][name].format(**values)


def refused(code: Code, place: str = "", expected: str = "") -> str:
    """Return the sentence about a refusal, with a remedy.

    Args:
        code: of the refusal.
        place: the field at fault.
        expected: what was expected there; left out where only developers would understand it.
    """
    known = phrases()["refused"]
    if str(code) in known:
        return known[str(code)]
    if place and expected and not NOT_FOR_PEOPLE.search(f"{place} {expected}"):
        return say("refused", "field", place=place, expected=expected)
    return known["other"]


@cache
def script() -> bytes:
    """Return the sentences as a module for browsers."""
    return b"export default " + orjson.dumps(phrases()) + b";\n"
