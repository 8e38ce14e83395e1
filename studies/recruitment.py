"""People who come to a study from a platform, such as Prolific: ids of their links, and the way back."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any
from urllib.parse import quote

from hearth.schemas.yaml_limits import packaged

_ID = re.compile(r"[A-Za-z0-9_.-]{1,100}")

_ADDRESS = re.compile(r"https://[A-Za-z0-9.-]+(?::[0-9]{1,5})?/[A-Za-z0-9_.~%/?&=+{}-]*")
"""A completion address: by https, of characters that need no quoting, with `{person}` and `{code}`."""

FILLED = ("{person}", "{code}")
"""The places of a completion address that are filled in."""


@dataclass(frozen=True, slots=True)
class Recruitment:
    """The platform by which the people of a study come.

    Attributes:
        platform: one of `platforms`.
        completion: the address to which a person is sent at the end; "" for none.
    """

    platform: str
    completion: str = ""

    @property
    def title(self) -> str:
        """Return the platform's name, for people."""
        return str(platforms()[self.platform]["title"])

    @property
    def parameters(self) -> tuple[str, ...]:
        """Return the parameters of its links: the person's id first."""
        row = platforms()[self.platform]
        return (str(row["person"]), *map(str, row["more"]))

    def came(self, fields: Mapping[str, str]) -> dict[str, str]:
        """Return the parameters of a link that a person came by; empty where they came by another link."""
        found = {name: fields[name] for name in self.parameters if fields.get(name)}
        return found if self.parameters[0] in found else {}

    def back(self, came: Mapping[str, str], code: str) -> str:
        """Return the address to which a person is sent back at the end; "" where there is none."""
        person = came.get(self.parameters[0], "")
        if "{person}" in self.completion and not person:
            return ""
        filled = self.completion.replace("{person}", quote(person, safe=""))
        return filled.replace("{code}", quote(code, safe=""))


@cache
def platforms() -> dict[str, dict[str, Any]]:
    """Return the platforms by name."""
    found: dict[str, dict[str, Any]] = packaged("hearth.studies", "platforms.yaml")
    return found


def is_id(text: str) -> bool:
    """Return whether a text may be an id of a platform: letters, digits, `_`, `-` and `.`."""
    return bool(_ID.fullmatch(text))


def is_completion(text: Any) -> bool:
    """Return whether a text is an address to which people may be sent at the end."""
    plain = text
    if isinstance(text, str):
        for each in FILLED:
            plain = plain.replace(each, "")
    return isinstance(text, str) and len(text) <= 500 and bool(_ADDRESS.fullmatch(text)) and not set("{}") & set(plain)
