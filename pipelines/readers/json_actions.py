"""Steps as JSON objects: an action with its objects, a call of a tool, a mapping of actions to objects."""

import ast
import json
import re
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

from hearth.kb.language.action_keys import ACTIONS, INSTANCE, action_key, bare_key, holds_object, last_name
from hearth.kb.language.program_names import action_of
from hearth.kb.language.recognition_knowledge import recognition
from hearth.kb.language.steps_from_calls import class_of
from hearth.pipelines.readers.texts_with_positions import Pairs, Text, composed, pairs_of, pieces_of
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code
from hearth.schemas.syntax import normal_name

_NAME = re.compile(r"[A-Za-z][\w .'-]*")
_ACTION = re.compile(r"[A-Z][A-Z_]+", re.ASCII)
_FENCED = r"(?:[^{}\[\]`]*+```\w*+\s*+|\s*+)"
"""The text before an answer: empty, or a fence and perhaps words above it."""

_FENCE = re.compile(rf"{_FENCED}(?=[{{\[])")
_OF_MAPPING = re.compile(rf"""{_FENCED}(?:\[\s*+)?\{{\s*+["'][A-Z][A-Z_]+["']\s*:\s*\[""")
_BELOW = re.compile(r"\s*+(?:```[^{}\[\]`]*+)?")
"""The text below an answer: empty, or the end of the fence and perhaps words."""


def is_action(value: Any) -> bool:
    """Return whether a value is an object with an action and perhaps objects, or a call of a tool.

    A row of a dataset's steps, whose objects are objects with a name, is none.
    """
    if is_tool_use(value):
        return True
    if not isinstance(value, dict) or _action(value) is None:
        return False
    objects = value.get("objects")
    return not (isinstance(objects, list) and all(isinstance(each, dict) for each in objects))


def is_tool_use(value: Any) -> bool:
    """Return whether a value is a call of a tool as parts of messages hold it, with a name and an input.

    Without a `type` it has no other key than these and an `id`, and its input is an object.
    """
    if not isinstance(value, dict) or not isinstance(value.get("name"), str):
        return False
    given = [value[key] for key in _INPUTS if key in value]
    is_bare = len(given) == 1 and isinstance(given[0], dict) and value.keys() <= {"name", "id", *_INPUTS}
    return bool(given) and (value.get("type") in _TOOL_USES or is_bare)


_TOOL_USES = ("tool_use", "tool_call", "function_call")
_INPUTS = ("input", "arguments", "args", "parameters")


def is_only_action(value: Any) -> bool:
    """Return whether a value is an action with its objects, and nothing else."""
    if is_tool_use(value):
        return True
    if not is_action(value) or isinstance(value.get("function"), dict):
        return False
    named = all(key.lower() in ACTIONS or holds_object(key) or INSTANCE.fullmatch(key) for key in value)
    return named and any(map(holds_object, value))


def step_of(value: dict[str, Any]) -> str:
    """Return the text of a step: as in programs if the action's name is known, else a sentence."""
    if is_tool_use(value):
        return _step(value["name"], _arguments(next(value[key] for key in _INPUTS if key in value)))
    call = value.get("function")
    if isinstance(call, dict):
        return _step(call["name"], _arguments(call.get("arguments")))
    key = _action(value)
    assert key is not None
    said: list[tuple[str, str, str]] = []
    for each, part in value.items():
        if holds_object(each):
            said += [(name, relation, "1") for name, relation in _related(each, part)]
        elif said and INSTANCE.fullmatch(each) and str(part).isdecimal() and int(part):
            said[-1] = (*said[-1][:2], str(int(part)))
    names, numbers = [name for name, _, _ in said], [number for _, _, number in said]
    return _step(last_name(value[key]), names, said[-1][1] if said else "", numbers)


def _related(key: str, value: Any) -> Iterator[tuple[str, str]]:
    """Yield the names in a value, each with its key: the word that relates it to the names before it."""
    if isinstance(value, dict):
        yield from ((name, bare_key(inside)) for inside, part in value.items() for name in _names({inside: part}))
    else:
        yield from ((name, bare_key(key)) for name in _names(value))


def _action(value: dict[str, Any]) -> str | None:
    call = value.get("function")
    if isinstance(call, dict):
        return "function" if isinstance(call.get("name"), str) else None
    return action_key(value) or None


def _arguments(given: Any) -> list[str]:
    """Return the names among the arguments of a call, which are an object or its JSON."""
    source = given
    if isinstance(given, str):
        try:
            given = json.loads(given)
        except (ValueError, RecursionError):
            return []
    found = list(_names(given))
    return pieces_of(source, found) if isinstance(source, str) else found


def _names(value: Any) -> Iterator[str]:
    """Yield the names in a value: itself, or those in a list or an object."""
    if isinstance(value, str):
        yield from [value] if value.strip() else []
    elif isinstance(value, int) and not isinstance(value, bool):
        yield str(value)
    elif isinstance(value, list):
        for part in value:
            yield from _names(part) if isinstance(part, (str, int)) else ()
    elif isinstance(value, dict):
        for part in value.values():
            yield from _names(part) if isinstance(part, (str, int)) else ()


def _step(action: str, names: Sequence[str], relation: str = "", numbers: Sequence[str] = ()) -> str:
    """Return a step of names; they have the instances of `numbers`, 1 if none are given."""
    are_names = all(map(_NAME.fullmatch, names))
    numbers = numbers or ["1"] * len(names)
    if _takes(action, len(names)) and are_names:
        return _written(action, zip(map(class_of, names), numbers, strict=True))
    *verb, last = re.split(r"[\s_-]+", action.strip())
    if len(names) == 2 and verb and last.lower() in _BETWEEN:
        return composed(" ".join(verb), " ", names[0], f" {last} ", names[1])
    meant = action_of(recognition(), action, names, relation) if names and are_names else ""
    if meant:
        return _written(meant, zip(map(class_of, names), numbers, strict=True))
    names = [name if number == "1" else f"{name} {number}" for name, number in zip(names, numbers, strict=True)]
    if len(names) == 2 and relation in _BETWEEN:
        return composed(action, " ", names[0], f" {relation} ", names[1])
    return composed(action, *(piece for name in names for piece in (" ", name)))


_BETWEEN = frozenset({"on", "in", "into", "onto", "to", "from", "at", "with", "inside"})
"""Words that stand between the objects of an action that ends with one: `put_on(cup, table)` is put cup on table."""


def _takes(action: str, count: int) -> bool:
    """Return whether a word is the name of an action with no fewer objects."""
    name = _plain(action)
    return any(each.arity >= count for each in recognition().actions.values() if each.name.lower() == name)


def _plain(action: str) -> str:
    return normal_name(action).replace("_", "")


def is_known(action: str, objects: Sequence[str] = ()) -> bool:
    """Return whether a word is the name of an action, or one that programs use for it with these objects."""
    known = recognition()
    return _plain(action) in {name.lower() for name in known.actions} or bool(action_of(known, action, objects))


def _written(action: str, objects: Iterable[tuple[str, str]]) -> str:
    pieces = ["[", action, "]"]
    for name, number in objects:
        pieces += [" <", name, f"> ({number})"]
    return composed(*pieces)


def is_mapping(value: Any) -> bool:
    """Return whether an object maps action names in capitals, one of them known, to lists of names and numbers."""
    pairs = pairs_of(value) if isinstance(value, dict) else []
    if not pairs or not all(_ACTION.fullmatch(key) and _are_names(part) for key, part in pairs):
        return False
    return any(is_known(key, [str(part) for part in parts]) for key, parts in pairs)


def _are_names(value: Any) -> bool:
    return isinstance(value, list) and len(value) <= 4 and all(_is_name(part) for part in value)


def _is_name(value: Any) -> bool:
    if isinstance(value, str):
        return value.isdecimal() or (_NAME.fullmatch(value) is not None)
    return isinstance(value, int) and not isinstance(value, bool)


def steps_of_mapping(value: dict[str, Any], source: str = "") -> list[str]:
    """Return the steps of a mapping, in the order of the file. A number after a name is the node of it.

    Args:
        value: as `is_mapping` takes it.
        source: the text in which it stands, if it is one within the file.
    """
    nodes: dict[str, list[str]] = {}
    found = []
    names = [part for key, parts in pairs_of(value) for part in (key, *map(_as_is, parts))]
    placed = iter(pieces_of(source, names) if source else names)
    for _, parts in pairs_of(value):
        action, objects = next(placed), []
        for name in [next(placed) for _ in parts]:
            if not name.isdecimal():
                objects.append((name, "1"))
            elif objects:
                known = nodes.setdefault(objects[-1][0], [])
                known += [] if name in known else [str(name)]
                objects[-1] = (objects[-1][0], f"{known.index(name) + 1}.{name}")
        meant = "" if _takes(action, len(objects)) else action_of(recognition(), action, [name for name, _ in objects])
        found.append(_written(meant or action, objects))
    return found


def _as_is(value: Any) -> str:
    return value if isinstance(value, str) else str(value)


def looks_like_mapping(text: str) -> bool:
    """Return whether a text begins a mapping of actions or a list of them, perhaps in a code fence below words."""
    return _OF_MAPPING.match(text) is not None


def mapping_in(text: str) -> dict[str, Any] | None:
    """Return the mapping of a text, as JSON or as Python writes it; None if it is cut off or is something else."""
    start = _FENCE.match(text)
    end = max(text.rfind("}"), text.rfind("]")) + 1
    inner = text[start.end() : end] if start else ""
    if not _BELOW.fullmatch(text[end:]):
        return None
    try:
        found = json.loads(inner, object_pairs_hook=Pairs)
    except (ValueError, RecursionError):
        found = _of_python(inner)
    if isinstance(found, list) and all(map(is_mapping, found)):
        found = Pairs([pair for each in found for pair in pairs_of(each)])
    return found if isinstance(found, dict) and is_mapping(found) else None


def mapped_steps(text: str) -> list[str]:
    """Return the steps of a mapping in a text.

    Raises:
        HearthError: BAD_JSON, it is cut off or is something else.
    """
    found = mapping_in(text)
    if found is None:
        line, column = (text.line, text.column) if isinstance(text, Text) else (0, 0)
        message, remedy = "an answer that is cut off, or that maps actions to no objects", "give it whole"
        shown = text.partition("\n")[0][:60]
        raise HearthError(Diagnostic(Code.BAD_JSON, message, "", line, column, len(shown), shown, remedy))
    return steps_of_mapping(found, text)


def _of_python(text: str) -> Any:
    """Return a dict of constants as Python writes it, with repeated keys."""
    try:
        tree = ast.parse(text, mode="eval").body
        if isinstance(tree, ast.Dict):
            pairs = zip(tree.keys, tree.values, strict=True)
            return Pairs([(ast.literal_eval(key), ast.literal_eval(value)) for key, value in pairs if key])
    except (SyntaxError, ValueError, RecursionError, MemoryError, TypeError):
        pass
    return None


_OF_PLANNER = re.compile(r"\(?\s*[a-z]+(?:_[a-z]+)*(?: \S+)* agent_n_\d+_\d+(?: \S+)*\s*\)?")
_ACTION_NAME = re.compile(r"[a-z]+(?:_[a-z]+)*")


def of_planner(plans: Iterable[Any]) -> bool:
    """Return whether lists are all actions of BEHAVIOR's planner, with WordNet's names of things, or action names."""
    steps = [step for plan in plans if isinstance(plan, list) for step in plan]
    if not steps or not all(isinstance(step, str) for step in steps):
        return False
    if all(map(_OF_PLANNER.fullmatch, steps)):
        return True
    return any("_" in step for step in steps) and all(map(_ACTION_NAME.fullmatch, steps))
