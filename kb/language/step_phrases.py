"""Steps as phrases and back: `[PutBack] <cup> <table>` is `Put cup on table`."""

import re
from collections.abc import Sequence
from functools import lru_cache

from hearth.kb.knowledge import Knowledge
from hearth.kb.knowledge_records import Action

Parse = tuple[Action, tuple[str, ...]]
"""An action with the names of its objects, as the sentence has them."""


def say(action: Action, names: Sequence[str]) -> str:
    """Return the step as a phrase, names with spaces: `Pour milk into coffee cup`."""
    return action.template.format(*(name.replace("_", " ") for name in names))


def parses(knowledge: Knowledge, text: str) -> tuple[Parse, ...]:
    """Return the steps that a sentence may mean, the likeliest first: those whose objects are all known come first.

    An article before an object and a full stop are skipped; `go to the kitchen.` is a Walk to `kitchen`.
    """
    cleaned = " ".join(text.strip().rstrip(".!").lower().split())
    found: list[tuple[int, int, Parse]] = []
    for rank, template, action in _templates(knowledge).get(cleaned.partition(" ")[0], ()):
        match = _pattern(template).fullmatch(cleaned)
        if match:
            names = tuple(_named(knowledge, name) for name in match.groups())
            unknown = sum(knowledge.object_class(name) is None for name in names)
            found.append((unknown, rank, (action, names)))
    return tuple(dict.fromkeys(parse for _, _, parse in sorted(found, key=lambda each: each[:2])))


def first_words(knowledge: Knowledge) -> frozenset[str]:
    """Return the words with which phrases of actions begin."""
    return frozenset(_templates(knowledge))


def _named(knowledge: Knowledge, words: str) -> str:
    """Return the class the words mean, or the words joined by underscores when they mean none."""
    thing = knowledge.object_class(words)
    return thing.name if thing else words.replace(" ", "_")


@lru_cache(maxsize=8)
def _templates(knowledge: Knowledge) -> dict[str, tuple[tuple[int, str, Action], ...]]:
    """Return the paraphrases of all actions by their first words: rank, template, action.

    Templates come before other words, longer ones first.
    """
    templates: list[tuple[bool, int, str, Action]] = []
    for action in knowledge.actions.values():
        head, _, tail = action.template.lower().partition(" {0}")
        templates.append((False, -len(action.template), action.template.lower(), action))
        for words in action.words:
            joined = f"{words} {{0}}{tail}" if action.arity else words
            templates.append((words != head, -len(joined), joined, action))
    found: dict[str, list[tuple[int, str, Action]]] = {}
    for rank, (_, _, template, action) in enumerate(sorted(templates, key=lambda each: each[:3])):
        found.setdefault(template.partition(" ")[0], []).append((rank, template, action))
    return {first: tuple(alike) for first, alike in found.items()}


@lru_cache(maxsize=1024)
def _pattern(template: str) -> re.Pattern[str]:
    parts = re.split(r"\{\d\}", template)
    return re.compile("(?:the |a |an |some |my )?(.+?)".join(re.escape(part) for part in parts))
