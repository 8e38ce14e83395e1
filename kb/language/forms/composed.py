"""The step of a call, whoever writes it: code, pairs, tuples, planners and JSON."""

from collections.abc import Sequence

from hearth.kb.language.forms.form import written
from hearth.kb.language.program_names import action_of, words_of
from hearth.kb.loading.load import default


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
    return written(action_of(default(), name, objects, relation) or name, objects)
