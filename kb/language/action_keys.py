"""The words by which people, programs and tools name the parts of a step: keys of JSON, attributes, columns."""

import re
from collections.abc import Mapping, Sequence
from typing import Any

from hearth.kb.language.program_names import action_of
from hearth.kb.language.recognition_knowledge import recognition
from hearth.kb.spelling import key_of

ACTIONS = (
    "action", "verb", "act", "function", "skill", "primitive", "operator", "command", "cmd", "name", "op", "operation",
    "service", "tool", "type", "method", "id", "do",
)  # fmt: skip
"""Keys of the action of a step, the likeliest first."""

_WITH_OBJECTS = frozenset({"skill", "primitive", "operator", "command", "name"})
"""Keys that name an action only where the mapping has objects too."""

_WITH_KNOWN = frozenset({"cmd", "op", "operation", "service", "tool", "type", "method", "id", "do"})
"""Keys that name an action only where the mapping has objects too and the action is known: they may say much else."""

OBJECTS = frozenset({
    "object", "objects", "obj", "noun", "object_name", "where", "container", "surface", "target", "targets", "thing",
    "arg", "args", "arguments", "parameter", "parameters", "entity", "entity_id",
    "params", "item", "items", "receptacle", "location", "destination", "recipient", "room", "place", "to", "into",
    "on", "onto", "in", "inside", "from", "with", "value",
})  # fmt: skip
"""Keys of the objects of a step; or one with a number, as `arg1`."""


_MODIFIERS = frozenset({
    "first", "second", "third", "primary", "secondary", "main", "other", "source", "goal", "direct", "indirect", "name",
    "class", "interacted", "manipulated", "held", "step",
})  # fmt: skip
"""Words that say which of the objects of a step a key names, as `target_object` or `secondary_object_name`."""

INSTANCE = re.compile(r"(?:object[_ ])?inst(?:ance)?s?(?:[_ ](?:id|no|nr|number))?[._ -]?\d*", re.IGNORECASE)
"""The name of a column or key with the instance of the thing before it, or of the only one."""


def names_action(name: str, things: Sequence[str] = ()) -> bool:
    """Return whether a name is that of an action, or one that programs use for it with these things."""
    return recognition().action(name) is not None or bool(action_of(recognition(), name, things))


def action_key(value: Mapping[str, Any]) -> str:
    """Return the key that names the action of a step; empty where none does."""
    texts = {key.lower(): key for key, part in value.items() if isinstance(part, str)}
    found = next((name for name in ACTIONS if name in texts), "")
    if found in _WITH_OBJECTS | _WITH_KNOWN and not any(map(holds_object, value)):
        return ""
    if found in _WITH_KNOWN and recognition().action(verb := last_name(value[texts[found]])) is None:
        return texts[found] if key_of(verb) in recognition().called else ""
    return texts[found] if found else ""


def last_name(name: str) -> str:
    """Return the name behind the last dot, `walk` of `robot.walk`."""
    return name.strip().rpartition(".")[2] if "." in name else name


def bare_key(key: str) -> str:
    """Return a key without its number and marks, `arg` of `arg_1`."""
    return key.lower().rstrip("_-# 0123456789")


def holds_object(key: str) -> bool:
    """Return whether a key names an object of a step."""
    bare = bare_key(key)
    return bare in OBJECTS or _is_compound(bare)


def _is_compound(key: str) -> bool:
    """Return whether a key of several words names an object of a step, as `target_object` does."""
    words = _BETWEEN.split(key)
    return 1 < len(words) <= _MOST_WORDS and not _NOUNS.isdisjoint(words) and (OBJECTS | _MODIFIERS).issuperset(words)


_BETWEEN = re.compile(r"[\s_.-]+")
_NOUNS = frozenset({"object", "objects", "obj", "target", "item", "receptacle", "thing", "entity", "location"})
_MOST_WORDS = 3
