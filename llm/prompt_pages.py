"""Prompt pages: the words of a role, with a fingerprint that results name."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from hashlib import blake2b
from importlib.resources import files
from typing import Any

from hearth.envs.text_protocol_settings import PROTOCOLS, protocol
from hearth.schemas.yaml_limits import packaged

ROLES = ("actor", "helper", "judge", "planner")
"""The roles; each has a page in `llm/prompts/`."""


MARKUP = re.compile(r"<\|")
"""The beginning of the marks by which chats are taken apart."""


PLACE = re.compile(r"\{(\w+)\}")
"""The place of a fact in a text."""


def unmarked(text: str) -> str:
    """Return a text in which nothing ends a message: names and descriptions are a stranger's."""
    return MARKUP.sub("< |", text)


@dataclass(frozen=True, eq=False)
class PromptPage:
    """The words of a role.

    Attributes:
        name: its identifier.
        fingerprint: digest of its file.
        words: its texts and limits, by name.
        text: of its file.
    """

    name: str
    fingerprint: str
    words: Mapping[str, Any]
    text: str = ""

    def __getitem__(self, name: str) -> Any:
        return self.words[name]

    def said(self, name: str, **facts: object) -> str:
        """Return one of its texts with facts in place of `{name}`; braces in facts stay as they are."""
        text = str(self.words[name]).strip()
        return PLACE.sub(lambda place: str(facts.get(place[1], place[0])), text)


@cache
def page(role: str) -> PromptPage:
    """Return the page of a role; read once."""
    return _read("hearth.llm", f"prompts/{role}.yaml")


def every_page() -> dict[str, PromptPage]:
    """Return the pages of all roles by their names, and the text protocol of agents as `protocol`."""
    return {**{role: page(role) for role in ROLES}, "protocol": _read("hearth.envs", PROTOCOLS[protocol().name])}


def _read(package: str, file: str) -> PromptPage:
    words, data = packaged(package, file), (files(package) / file).read_bytes()
    digest = blake2b(data, digest_size=8).hexdigest()
    return PromptPage(words["name"], digest, words, data.decode())
