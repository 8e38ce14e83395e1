"""The step of an action that a program names, whoever writes it: code, pairs, tuples, planners, tables and JSON."""

from collections.abc import Sequence

from hearth.kb.language.noun_phrases import thing_of
from hearth.kb.language.program_names import action_of, words_of
from hearth.kb.language.recognition_knowledge import recognition


def composed_step(name: str, objects: Sequence[str], relation: str = "") -> str:
    """Return the step of an action that a program names, in the syntax of programs, or in words where it has no object.

    Args:
        name: the action as the program spells it, `pick_up`, `goTo`, `SwitchOn`; `walk_to_kitchen` is a sentence.
        objects: names of the things.
        relation: how the last thing is named, as `on` in `place(obj="cup", on="table")`.
    """
    words = words_of(name)
    if not objects and " " in words:
        return words.lower()
    return written(action_of(recognition(), name, objects, relation) or name, list(map(class_of, objects)))


def class_of(name: str) -> str:
    """Return the class of a thing that programs do not call so, and people do, as `the ice cream`; else the name."""
    known = recognition()
    if known.object_class(name) or known.is_room(name):
        return name
    return thing_of(known, name.replace("_", " ").lower()) or name


def written(action: str, objects: Sequence[str]) -> str:
    """Return a step in the syntax of programs; an object is a name, and its instance behind a blank if it has one."""
    return " ".join([f"[{action}]", *(f"<{name}> ({number or 1})" for name, number in map(_numbered, objects))])


def _numbered(name: str) -> tuple[str, str]:
    words, _, last = name.strip().rpartition(" ")
    return (words, last) if words and last.isdecimal() and int(last) else (name.strip(), "")
