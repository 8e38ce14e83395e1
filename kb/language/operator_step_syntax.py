"""Steps as operators write them: a name and its things in any brackets, after keys, or in the tag of an element."""

import re

from hearth.kb.language.action_keys import action_key, bare_key, holds_object, last_name, names_action
from hearth.kb.language.english_lexicon import is_verb
from hearth.kb.language.noun_phrases import thing_of
from hearth.kb.language.recognition_knowledge import recognition, recognized_cache
from hearth.kb.language.steps_from_calls import composed_step, written

_DOES = r"(?:(?:do|exec(?:ute)?|run|call|perform|invoke)\s+)?"
_NAME = r"(?P<name>[A-Za-z][A-Za-z0-9]*(?:[_ .-][A-Za-z][A-Za-z0-9]*){0,3})"
_SHAPES = tuple(
    re.compile(rf"{_DOES}{_NAME}\s*{arguments}\s*[;,.?]*", re.IGNORECASE)
    for arguments in (
        r"\((?P<things>[^()]*)\)",
        r"\[(?P<things>[^\[\]]*)\]",
        r"\{(?P<things>[^{}]*)\}",
        r"(?P<things><[^<>]*>(?:\s*,?\s*<[^<>]*>)?)",
    )
)
_BETWEEN = re.compile(r"\s*[,|]\s*|>\s*,?\s*<")
_KEYWORD = re.compile(r"(?P<key>[A-Za-z]\w*)\s*[=:]\s*(?P<value>.*)")
_THING = re.compile(r"[A-Za-z][\w .'-]*")
_PLAIN = re.compile(
    r"(?P<name>[A-Z][A-Z]{2,}(?:[_-][A-Z]+)*|[A-Z][a-z]+(?:[A-Z][a-z]+)+|[a-z]+(?:[_-][a-z]+)+|[A-Za-z]{3,})"
    r"(?P<things>(?:\s+[A-Za-z][\w-]*){0,2})\s*[;.]?"
)
"""An action before its things, each a word."""

_KEYED = re.compile(
    r"[\"']?(?P<key>[A-Za-z]\w*)[\"']?\s*[=:]\s*(?P<value>\"[^\"]*\"|'[^']*'|"
    r"\[[^\]]*\]|[^=:,;{}<>\"']*?)(?=\s*[,;]?\s*[\"']?[A-Za-z]\w*[\"']?\s*[=:]|\s*[,;]?\s*$)"
)
_AROUND = re.compile(r"\s*(?:step\s+)?[({]?(?P<inner>.*?)[)}]?\s*[,;]?\s*")
_ELEMENT = re.compile(r"\s*<(?P<tag>[A-Za-z]\w*)\s+(?P<inner>[^<>]*?)/?>(?P<within>[^<>]{0,80})(?:</\w+>)?\s*")
_LONGEST = 300


@recognized_cache(maxsize=65_536)
def operator_step(text: str) -> str:
    """Return the step of a line that is an action with its things, in the syntax of programs; empty for another line.

    The action is known by one of its names, so that `Note[1]` and `Kitchen (old)` are none.
    """
    if len(text) > _LONGEST:
        return ""
    text = text.strip()
    if text.endswith(_ENDS) and (found := next((each for shape in _SHAPES if (each := shape.fullmatch(text))), None)):
        return _of_call(found["name"], found["things"].strip().strip("<>"))
    if "=" in text or ":" in text:
        return _of_keys(text)
    return _of_words(text)


def _of_words(text: str) -> str:
    """Return the step of a name that only programs write, `SWITCHON lamp` and `StandUp`, or of `walk desk`."""
    plain = _PLAIN.fullmatch(text)
    if not plain:
        return ""
    name, things = plain["name"], plain["things"].lower().split()
    is_name = not name.isalpha() or not (name.islower() or name.istitle())
    if not things:
        action = recognition().action(name) if is_name else None
        return written(action.name, []) if action and not action.arity else ""
    if not _SMALL.isdisjoint(things):
        return ""
    is_short = name.lower() in _GOING or (name.islower() and not is_verb(name))
    is_known = (is_name or is_short) and names_action(name, things) and all(map(names_thing, things))
    return composed_step(name, things) if is_known else ""


_GOING = frozenset(("walk", "run", "go", "sit", "lie"))
"""Verbs that have a preposition in sentences, and none in programs."""

_SMALL = frozenset(("a", "an", "the", "to", "on", "in", "into", "at", "from", "with", "of", "up", "down", "my", "your"))
"""Words that sentences have, and no thing is called so."""


_ENDS = (")", "]", "}", ">", ";", ",", ".", "?")


def _of_call(name: str, inside: str) -> str:
    things, relation = [], ""
    for each in _BETWEEN.split(inside) if inside else []:
        keyword = _KEYWORD.fullmatch(each.strip())
        relation = keyword["key"] if keyword else relation
        thing = (keyword["value"] if keyword else each).strip().strip("\"'`?$@<>")
        if not _THING.fullmatch(thing):
            return ""
        things.append(thing)
    name = last_name(name)
    return composed_step(name, things, relation) if names_action(name, things) else ""


def _of_keys(text: str) -> str:
    """Return the step of keys with values: `action=Walk object=desk`, or the attributes of an element."""
    element = _ELEMENT.fullmatch(text)
    inner = element["inner"] if element else _AROUND.fullmatch(text)["inner"]  # type: ignore[index]
    pairs = [(found["key"], found["value"].strip().strip("\"'")) for found in _KEYED.finditer(inner)]
    if _KEYED.sub("", inner).strip(" ,;"):
        return ""
    if element and element["within"].strip():
        pairs.append(("object", element["within"].strip()))
    name = last_name(dict(pairs).get(action_key(dict(pairs)), ""))
    if element and not (name and names_action(name, _things(pairs))):
        name = element["tag"]
    return composed_step(name, _things(pairs), _relation(pairs)) if name and names_action(name, _things(pairs)) else ""


def _things(pairs: list[tuple[str, str]]) -> list[str]:
    found = [each.strip(" \"'") for key, value in pairs if holds_object(key) for each in value.strip("[]").split(",")]
    return [each for each in found if each]


def _relation(pairs: list[tuple[str, str]]) -> str:
    return next((bare_key(key) for key, _ in reversed(pairs) if holds_object(key)), "")


def names_thing(name: str) -> bool:
    """Return whether a name is that of a thing or a room."""
    return thing_of(recognition(), name.strip().replace("_", " ").lower()) is not None
