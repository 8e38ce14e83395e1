"""Prompt pages: the words of a role, with a fingerprint that results name."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from hashlib import blake2b
from importlib.resources import files
from typing import Any

from hearth.schemas.yaml_limits import packaged

ROLES = ("actor", "helper", "planner")
"""The roles; each has a page in `llm/prompts/`."""


@dataclass(frozen=True, eq=False)
class PromptPage:
    """The words of a role.

    Attributes:
        name: its identifier.
        fingerprint: digest of its file.
        words: its texts and limits, by name.
    """

    name: str
    fingerprint: str
    words: Mapping[str, Any]

    def __getitem__(self, name: str) -> Any:
        return self.words[name]

    def said(self, name: str, **facts: object) -> str:
        """Return one of its texts with facts in place of `{name}`; braces in facts stay as they are."""
        text = str(self.words[name]).strip()
        for key, value in facts.items():
            text = text.replace(f"{{{key}}}", str(value))
        return text


@cache
def page(role: str) -> PromptPage:
    """Return the page of a role; read once."""
    file = f"prompts/{role}.yaml"
    words = packaged("hearth.llm", file)
    digest = blake2b((files("hearth.llm") / file).read_bytes(), digest_size=8).hexdigest()
    return PromptPage(words["name"], digest, words)
