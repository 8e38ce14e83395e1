"""Steps that JSON holds in another way than as a list of texts: under numbered keys, or as objects with a text."""

import re
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from hearth.pipelines.readers.json_actions import is_action, is_known

TEXTS = (
    "text", "description", "instruction", "content", "action", "act", "cmd", "command", "do", "move", "step", "task",
    "name", "detail", "value", "what",
)  # fmt: skip
"""Keys of the words of a step that is an object, the likeliest first."""

_SEEN = frozenset({
    "obs", "observation", "observations", "thought", "thoughts", "reason", "reasoning", "result", "feedback", "state",
    "reward", "note", "comment", "status",
})  # fmt: skip
"""Keys of thoughts, sights and answers next to a step."""

_COUNT_STEPS = frozenset({"order", "position", "sequence", "seq", "stepno", "stepnumber", "stepid", "schritt"})
_MAY_COUNT = frozenset(
    {"number", "num", "no", "nr", "index", "idx", "id", "n", "i", "t", "ts", "time", "tick", "frame", "turn", ""}
)
_HOLD_PROGRAMS = frozenset({"plan", "plans", "steps", "actions", "program", "programs"})

_OTHER = re.compile(r"[^a-z0-9]+")
_NUMBERED = re.compile(r"(?:(?:step|action|s|instruction|schritt|no|nr)\s?)?(\d{1,3})")
_LONGEST = 1_000


def plain_name(name: str) -> str:
    """Return the name of a key or column in lower case, with spaces for other characters than letters and digits."""
    return _OTHER.sub(" ", str(name).lower()).strip()


def numbered_names(names: Iterable[str]) -> list[str]:
    """Return the names that number steps, as `step1`, `step2`, in their order; none unless they go up from 0 or 1."""
    found: dict[int, str] = {}
    for name in names:
        number = _NUMBERED.fullmatch(plain_name(name))
        if number:
            found.setdefault(int(number[1]), name)
    in_order = sorted(found)
    follow = in_order[:1] in ([0], [1]) and in_order == list(range(in_order[0], in_order[0] + len(found)))
    return [found[number] for number in in_order] if follow else []


_NAMED = frozenset({
    "plan", "steps", "step", "actions", "action", "action list", "program", "instructions", "script", "trajectory",
    "commands", "sequence", "subtasks", "tasks", "moves", "calls",
})  # fmt: skip
_OURS = frozenset({
    "rooms", "props", "descriptions", "splits", "messages", "tool_calls", "choices", "graph", "init_graph",
    "final_graph", "nodes", "edges",
})  # fmt: skip
"""Keys of lists that are no steps."""


def with_step_lists(value: dict[str, Any]) -> dict[str, Any]:
    """Return a record whose steps are lists of texts and actions, under whatever keys they were."""
    lists = {
        key: steps
        for key, part in value.items()
        if key not in _OURS and (steps := step_list(part, plain_name(key) in _NAMED)) is not None
    }
    own = _under_numbers(value)
    if not lists and own is None:
        return value
    rest = {key: lists.get(key, part) for key, part in value.items()}
    if isinstance(value.get("action"), list) and "action" in lists and "steps" not in value:
        rest["steps"] = rest.pop("action")
    if own is None:
        return rest
    keys = set(numbered_names(value))
    return {**{key: part for key, part in rest.items() if key not in keys}, "steps": own}


def step_list(value: Any, is_named: bool) -> list[Any] | None:
    """Return the steps of a list or an object that holds them in another way than as texts; else None.

    Args:
        value: a list or object; anything else has no steps.
        is_named: whether its key says that it holds steps, so that any number counts them.
    """
    if isinstance(value, list):
        return _of_objects(value, is_named) if value and any(isinstance(each, (dict, list)) for each in value) else None
    if not isinstance(value, dict) or not value:
        return None
    if len(numbered_names(value)) == len(value):
        return _under_numbers(value)
    inside = [part for key, part in value.items() if plain_name(key) in ("steps", "plan", "actions")]
    if (
        not is_named
        or len(inside) != 1
        or not isinstance(inside[0], (list, dict))
        or any(map(_is_text, value.values()))
    ):
        return None
    steps = inside[0]
    is_list = isinstance(steps, list) and all(map(_is_text, steps))
    return list(steps) if is_list else step_list(steps, True)


def text_of(value: Mapping[str, Any], any_number: bool = False) -> str | None:
    """Return the words of a step that is an object with its number; None for any other object.

    Args:
        value: the object.
        any_number: whether a number by any name counts the steps, or there may be none.
    """
    value = {key: part for key, part in value.items() if plain_name(key) not in _SEEN} if len(value) > 1 else value
    names = {plain_name(key) for key in value}
    if names & _HOLD_PROGRAMS or not (number_of(value, any_number) or len(value) == 1):
        return None
    texts = {
        name: part for key, part in value.items() if is_line(part) and not (name := plain_name(key)).endswith(" id")
    }
    if len(texts) == 1 or number_of(value):
        return next((texts[name] for name in (*TEXTS, *texts) if name in texts), None)
    return None


def number_of(value: Mapping[str, Any], any_number: bool = False) -> str:
    """Return the key that counts the steps; empty if there is none."""
    counts = [key for key, part in value.items() if is_count(part)]
    sure = (key for key in counts if "step" in (name := plain_name(key)).split() or name in _COUNT_STEPS)
    return next(sure, "") or next((key for key in counts if any_number and plain_name(key) in _MAY_COUNT), "")


def is_count(value: Any) -> bool:
    """Return whether a value is a number that counts steps."""
    if isinstance(value, str):
        return value.strip().isdecimal() and len(value.strip()) <= 4
    return isinstance(value, int) and not isinstance(value, bool)


_TIME = re.compile(r"\d{1,2}[:.]\d\d(?:[:.]\d\d)?(?:\s?[ap]\.?m\.?)?(?:\s*[-–]\s*\d{1,2}[:.]\d\d)?", re.IGNORECASE)


def is_time(value: Any) -> bool:
    """Return whether a value is a time of day, which orders steps and is none."""
    return isinstance(value, str) and _TIME.fullmatch(value.strip()) is not None


def is_line(value: Any) -> bool:
    """Return whether a value is words on one line."""
    if not isinstance(value, str) or is_count(value):
        return False
    return 0 < len(value.strip()) <= _LONGEST and "\n" not in value.strip()


def _under_numbers(value: dict[str, Any]) -> list[Any] | None:
    names = numbered_names(value)
    parts = [value[name] for name in names if value[name] not in (None, "")]
    if not parts or len(names) < 2:
        return None
    return parts if all(map(is_line, parts)) else _of_objects(parts, True)


def _of_objects(parts: list[Any], is_named: bool) -> list[Any] | None:
    """Return steps that are texts, actions, or objects with a text each; None if any of them is something else."""
    found = []
    are_pairs = _are_pairs(parts)
    parts = [part for _, part in sorted(enumerate(parts), key=_at(parts))]
    for part in parts:
        if isinstance(part, str) or is_action(part):
            found.append(part)
        elif isinstance(part, list) and are_pairs:
            found.append({"action": part[0], "args": part[1:]})
        elif isinstance(part, dict) and len(part) == 1 and _is_action_name(key := next(iter(part)), part[key]):
            found.append({"action": key, "args": part[key]})
        elif isinstance(part, dict) and (text := text_of(part, is_named)) is not None:
            found.append(text)
        else:
            return None
    return found


def _at(parts: list[Any]) -> Callable[[tuple[int, Any]], int]:
    """Return the place of each step: by its number where all have one of their own, else as in the list."""
    numbers = numbers_of(parts)
    return (lambda each: numbers[each[0]]) if numbers else (lambda each: each[0])


def numbers_of(parts: Any) -> list[int]:
    """Return the numbers of steps that are objects, in the order of a list; empty unless each has one of its own."""
    if not isinstance(parts, list) or not all(isinstance(part, dict) for part in parts):
        return []
    names = [number_of(part) for part in parts]
    numbers = [int(part[name]) for part, name in zip(parts, names, strict=True) if name]
    return numbers if len({*numbers}) == len(parts) else []


def _are_pairs(parts: Iterable[Any]) -> bool:
    """Return whether the lists among some steps are each an action with its objects.

    One of the actions is known, and each other is a single word: a list of sentences is a plan of its own.
    """
    lists = [part for part in parts if isinstance(part, list)]
    if not all(0 < len(part) <= 4 and all(map(_is_text, part)) for part in lists):
        return False
    known = [part for part in lists if is_known(part[0], part[1:])]
    return bool(known) and all(part in known or len(part[0].split()) == 1 for part in lists)


def is_pair(value: Any) -> bool:
    """Return whether a list is a known action with its objects."""
    return (
        isinstance(value, list) and 0 < len(value) <= 4 and all(map(_is_text, value)) and is_known(value[0], value[1:])
    )


def _is_text(value: Any) -> bool:
    return isinstance(value, str)


def _is_action_name(key: str, value: Any) -> bool:
    objects = [value] if isinstance(value, str) else value if isinstance(value, list) else []
    return plain_name(key) not in TEXTS and is_known(key, objects)
