"""Text protocols: the words and limits of a text environment, with a fingerprint that results name."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from hashlib import blake2b
from pathlib import Path
from typing import Any

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.yaml_limits import packaged

PROTOCOLS = {"hearth-text/1": "hearth_text_1.yaml"}
"""The file of each protocol."""

CURRENT = "hearth-text/1"
"""The protocol that environments have where none is named."""


@dataclass(frozen=True, eq=False)
class Protocol:
    """The words and limits of a text environment.

    Attributes:
        name: its identifier.
        fingerprint: digest of its file.
        instructions: how to act, for the first message to a language model.
        usual: characters above which an observation has less detail.
        most: characters of an observation.
        most_walked: ticks that one command to walk takes.
        most_answer: characters of an answer.
        most_last: characters about the last command.
        fixtures: classes that are left out unless the goal names them.
        not_targets: classes that are not offered to put things on.
        hidden: actions that are accepted and not listed.
        walks: words that mean the walk.
        goals: how literals of a goal are said.
    """

    name: str
    fingerprint: str
    instructions: str
    usual: int
    most: int
    most_walked: int
    most_answer: int
    most_last: int
    fixtures: frozenset[str]
    not_targets: frozenset[str]
    hidden: frozenset[str]
    walks: frozenset[str]
    goals: Mapping[str, str]


@cache
def protocol(name: str = CURRENT) -> Protocol:
    """Return a protocol by name.

    Raises:
        HearthError: BAD_ARGUMENT: there is none of that name.
    """
    if name not in PROTOCOLS:
        message = f"there is no text protocol `{str(name)[:40]}`"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion=", ".join(PROTOCOLS))
    file = Path(__file__).with_name(PROTOCOLS[name])
    data = packaged("hearth.envs", file.name)
    sets: dict[str, Any] = {each: frozenset(data[each]) for each in ("fixtures", "not_targets", "hidden", "walks")}
    plain: dict[str, Any] = {
        each: data[each] for each in ("usual", "most", "most_walked", "most_answer", "most_last", "goals")
    }
    digest = blake2b(file.read_bytes(), digest_size=8).hexdigest()
    return Protocol(name, digest, data["instructions"].strip(), **plain, **sets)
