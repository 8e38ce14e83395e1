"""The tables of requests: patterns of clauses with the acts that they ask for (`kb/language/requests.yaml`)."""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import cache
from typing import Any, NamedTuple

from hearth.schemas.literals import Literal
from hearth.schemas.yaml_limits import packaged

NUMBERS = {
    "one": 1, "a": 1, "an": 1, "two": 2, "three": 3, "four": 4, "five": 5, "six": 6, "seven": 7, "eight": 8,
    "nine": 9, "ten": 10, "a couple of": 2, "a pair of": 1, "both": 2, "another": 1,
}  # fmt: skip
"""Numbers as words."""

_COUNT = "one|two|three|four|five|six|seven|eight|nine|ten|[1-9]|10"
_SLOT = re.compile(r"\{(\w+)(?::([^{}]+))?\}")
_ANYTHING = re.compile(r"(?<!\w)\.\+")
_OF_ONE_CLAUSE = "(?:(?!(?: |(?<= ))(?:and|then|but) |[,;:] ).)+"
"""Any words of a pattern are those of one clause."""

_ANYTHING_ELSE = re.compile(r"\.(?=[+*])")
_OF_ONE_JOINT = "(?:(?!(?: |(?<= ))then |,? then |[,;] (?:and|but) |; ).)"
"""Any words of an ending do not reach into the next clause."""

_GROUP = re.compile(r"<(\w+)>")


class ActTemplate(NamedTuple):
    """An act of the table.

    Attributes:
        action: its name.
        arguments: slots, or classes in order of preference; each with how many of it (0 for the number of the text,
            -1 for several).
        optional: whether it is left out where it cannot be done.
        times: how often it is done.
    """

    action: str
    arguments: tuple[tuple[tuple[str, ...], int], ...]
    optional: bool
    times: int = 1

    @property
    def slots(self) -> frozenset[str]:
        """Return the slots that it is about."""
        return frozenset(names[0] for names, _ in self.arguments if is_slot(names[0]))


class Pattern(NamedTuple):
    """A pattern of clauses.

    Attributes:
        pattern: with a named group for each slot.
        needs: for each slot, properties, kinds and classes of which a thing must have one; none for any thing.
    """

    pattern: re.Pattern[str]
    needs: Mapping[str, frozenset[str]]


class Request(NamedTuple):
    """A row of the table.

    Attributes:
        patterns: those of clauses that ask for it.
        ways: lists of acts, the first to be preferred.
        goal: literals that are to hold at the end, with slots as terms.
        it: slots that no word names, with the needs of the last thing spoken of that fills them.
    """

    patterns: tuple[Pattern, ...]
    ways: tuple[tuple[ActTemplate, ...], ...]
    goal: tuple[Literal[str], ...]
    it: Mapping[str, frozenset[str]]


class Words(NamedTuple):
    """The words around requests (`request_words.yaml`); `groups` are nouns of `things` for several classes."""

    courtesy: re.Pattern[str]
    openings: re.Pattern[str]
    endings: tuple[re.Pattern[str], ...]
    asides: re.Pattern[str]
    things: Mapping[str, tuple[str, ...]]
    groups: frozenset[str]


def is_slot(name: str) -> bool:
    """Return whether an argument of an act is a slot."""
    return len(name) == 1


_NOT_WITHOUT_YOURSELF = frozenset({"get yourself", "put yourself", "take yourself", "seat yourself", "place yourself"})
"""Verbs that mean something else without `yourself`, which is left out elsewhere as a word of courtesy."""


@cache
def requests() -> tuple[Request, ...]:
    """Return the table, in its order."""
    data: dict[str, Any] = packaged("hearth.kb.language", "requests.yaml")
    groups = {name: _alternatives(words) for name, words in data["words"].items()}
    groups["meal"] = str(_word_data()["meals"])
    return tuple(_request(row, groups) for row in data["requests"])


def _request(row: Mapping[str, Any], groups: Mapping[str, str]) -> Request:
    ways = tuple(tuple(map(_act, way)) for way in (row["do"], *row.get("or", ())))
    goals = (re.fullmatch(r"(\w+)\(([^()]+)\)", text) for text in row.get("goal", ()))
    literals = tuple(Literal.of(found[1], *re.split(", *", found[2])) for found in goals if found)
    it = {slot: frozenset(needs.split("|")) for slot, needs in row.get("it", {}).items()}
    return Request(tuple(_pattern(text, groups) for text in row["say"]), ways, literals, it)


def _alternatives(words: list[str]) -> str:
    plain = [each.replace(" yourself", "") for each in words if each not in _NOT_WITHOUT_YOURSELF]
    ordered = sorted({*words, *plain}, key=lambda each: (-len(each), each))
    return f"(?:{'|'.join(map(re.escape, ordered))})"


def _pattern(text: str, groups: Mapping[str, str]) -> Pattern:
    needs: dict[str, frozenset[str]] = {}

    def slot(found: re.Match[str]) -> str:
        name, condition = found[1], found[2]
        if name == "meal":
            return groups["meal"]
        if name in needs:
            return rf"(?P={name})"
        needs[name] = frozenset(condition.split("|")) if condition else frozenset()
        return rf"(?P<{name}>{_COUNT if name == 'n' else '.+?'})"

    filled = _GROUP.sub(lambda found: groups[found[1]], _ANYTHING.sub(_OF_ONE_CLAUSE, text))
    pattern = re.compile(_SLOT.sub(slot, filled))
    needs.pop("n", None)
    return Pattern(pattern, needs)


def _act(text: str) -> ActTemplate:
    name, *arguments = text.removeprefix("?").split()
    name, _, times = name.partition("*")
    found = tuple((tuple(each.partition("#")[0].split("|")), _many(each)) for each in arguments)
    return ActTemplate(name, found, text.startswith("?"), int(times or 1))


def _many(argument: str) -> int:
    many = argument.partition("#")[2] or "1"
    return int({"n": "0", "s": "-1"}.get(many, many))


@cache
def _word_data() -> Mapping[str, Any]:
    found: dict[str, Any] = packaged("hearth.kb.language", "request_words.yaml")
    return found


@cache
def words() -> Words:
    """Return the words around requests."""
    data = _word_data()
    courtesy = "|".join(sorted(data["courtesy"], key=len, reverse=True))
    return Words(
        re.compile(rf"(?<![\w'])(?:{courtesy})(?![\w'])"),
        re.compile(rf"(?:{'|'.join(data['openings'])})(?![\w'])[\s,:]*"),
        tuple(re.compile(rf",? {_ANYTHING_ELSE.sub(_OF_ONE_JOINT, each)}$") for each in data["endings"]),
        re.compile("|".join(data["asides"])),
        {name: tuple(classes) for kind in ("things", "groups") for name, classes in data[kind].items()},
        frozenset(data["groups"]),
    )


@cache
def hints() -> tuple[tuple[re.Pattern[str], str], ...]:
    """Return wishes that are only hinted at, each with the request that it stands for (a template of its groups)."""
    return tuple((re.compile(pattern), str(request)) for pattern, request in _word_data()["hints"].items())


@cache
def acts_of(kind: str) -> frozenset[str]:
    """Return the names of the acts of a kind of `request_words.yaml`, such as `held`."""
    return frozenset(_word_data()[kind])


def number_in(text: str) -> int:
    """Return the number that a word says; 0 where it says none."""
    return NUMBERS.get(text, 0) or (int(text) if text.isascii() and text.isdigit() and len(text) < 3 else 0)


@cache
def shorthand() -> Mapping[str, str]:
    """Return the shorthand of typed requests, each with its words in full."""
    return {str(short): str(words) for short, words in _word_data()["shorthand"].items()}


@cache
def table_words() -> frozenset[str]:
    """Return the words of which the patterns and the nouns of the tables are made."""
    data: dict[str, Any] = packaged("hearth.kb.language", "requests.yaml")
    texts = [text for row in data["requests"] for text in row["say"]]
    texts += [text for group in data["words"].values() for text in group]
    plain = (re.sub(r"\{[^{}]*\}|<\w+>|\\\\.", " ", text) for text in (*texts, *words().things))
    return frozenset(word for text in plain for word in re.findall(r"[a-z]{2,}", text))
