"""The grammar of steps, for constrained decoding: every action with the classes that afford it."""

from __future__ import annotations

import json
from collections import defaultdict
from collections.abc import Iterator
from typing import Any

from hearth.kb.knowledge import Knowledge
from hearth.kb.tools.line_grammars import Group, LineGrammar, Part, gbnf, lark, line_grammar, possible, regex

MOST_STEPS = 30
"""Steps of a program that a grammar lets be written, at most; people's programs have 11 on average."""

NUMBERS = tuple("123456789")
"""The instances of a class in a program."""

NUMBER: tuple[Part, ...] = ("> (", NUMBERS, ")")
"""The end of an argument."""

BLOCK = 9
"""Classes whose pairs are listed one by one."""

Choice = tuple[str, ...]


def argument_sets(knowledge: Knowledge) -> dict[tuple[Choice, ...], list[str]]:
    """Return the actions by the classes that each of their arguments may be."""
    found: defaultdict[tuple[Choice, ...], list[str]] = defaultdict(list)
    for action in knowledge.actions.values():
        sets = (
            tuple(name for name in sorted(knowledge.objects) if knowledge.affords(action.name, place, name))
            for place in range(action.arity)
        )
        found[tuple(sets)].append(action.name)
    return {sets: names for sets, names in found.items() if all(sets)}


def step_grammar(knowledge: Knowledge, most: int = MOST_STEPS) -> LineGrammar:
    """Return the grammar of programs: lines as `[Grab] <milk> (1)`."""
    alternatives: list[list[Part]] = []
    for sets, names in argument_sets(knowledge).items():
        arguments: list[Part] = []
        if len(sets) == 1:
            arguments = [" <", sets[0], *NUMBER]
        elif sets:
            arguments = [" <", Group(possible(_pairs(*sets)))]
        alternatives.append(["[", tuple(names), "]", *arguments])
    return line_grammar(alternatives, most)


def _pairs(first: Choice, second: Choice) -> Iterator[list[Part]]:
    """Yield the ways to write two arguments, after the bracket of the first; no object is named twice.

    Two of a class are the first and a later one. Classes that may be both arguments come in blocks: the others of the
    block are listed for each, and those of other blocks once for all, so that the length grows slowly.
    """
    shared = {*first} & {*second}
    both = [name for name in first if name in shared]
    one, other = (tuple(name for name in choice if name not in shared) for choice in (first, second))
    yield [one, *NUMBER, " <", second, *NUMBER]
    yield [tuple(both), *NUMBER, " <", other, *NUMBER]
    for at in range(0, len(both), BLOCK):
        block = both[at : at + BLOCK]
        yield [tuple(block), *NUMBER, " <", tuple(both[:at] + both[at + BLOCK :]), *NUMBER]
        for name in block:
            yield [name, *NUMBER, " <", tuple(each for each in block if each != name), *NUMBER]
            yield [f"{name}> (1) <{name}> (", NUMBERS[1:], ")"]


def step_schema(knowledge: Knowledge, most: int = MOST_STEPS) -> dict[str, Any]:
    """Return the JSON schema of programs: `{"steps": [{"action": "Grab", "object1": "milk"}]}`.

    A schema of this kind cannot say that two objects differ; a step that names one twice is refused when it is read.
    """
    names: dict[Choice, str] = {}
    items = []
    for sets, actions in argument_sets(knowledge).items():
        fields: dict[str, Any] = {"action": {"enum": list(actions)}}
        for number, choice in enumerate(sets, 1):
            fields[f"object{number}"] = {"$ref": f"#/$defs/{names.setdefault(choice, f'c{len(names)}')}"}
        items.append({"type": "object", "properties": fields, "required": list(fields), "additionalProperties": False})
    return {
        "type": "object",
        "properties": {"steps": {"type": "array", "minItems": 1, "maxItems": most, "items": {"anyOf": items}}},
        "required": ["steps"],
        "additionalProperties": False,
        "$defs": {name: {"enum": list(choice)} for choice, name in names.items()},
    }


def as_gbnf(knowledge: Knowledge) -> str:
    """Return the grammar of steps in GBNF."""
    return gbnf(step_grammar(knowledge))


def as_lark(knowledge: Knowledge) -> str:
    """Return the grammar of steps in Lark."""
    return lark(step_grammar(knowledge))


def as_regex(knowledge: Knowledge) -> str:
    """Return the regular expression of one step; that of a whole program repeats it."""
    return regex(step_grammar(knowledge, most=1)) + "\n"


def as_schema(knowledge: Knowledge) -> str:
    """Return the JSON schema of programs."""
    return json.dumps(step_schema(knowledge), indent=1) + "\n"
