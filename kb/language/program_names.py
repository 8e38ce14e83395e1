"""Names of actions as programs, planners and robots' interfaces spell them, and the action that a call means."""

import re
from collections.abc import Sequence

from hearth.kb.knowledge import Knowledge
from hearth.kb.spelling import key_of

_ON, _IN = ("on", "onto", "ontop"), ("in", "into", "inside")
_HUMP = re.compile(r"(?<=[a-z0-9])(?=[A-Z])")


def action_of(known: Knowledge, name: str, objects: Sequence[str], relation: str = "") -> str:
    """Return the action that a program's name means for these objects; empty where no action is called so.

    Args:
        known: the actions, whose `calls` are these names.
        name: the name of the call, the value of `action`, or the first word of a pair.
        objects: names of the things.
        relation: how the last thing is named, as `on` in `place(obj="cup", on="table")`.
    """
    called = known.called.get(key_of(words_of(name)), ())
    fitting = [action for action in called if known.arity[action] == len(objects)]
    if len(fitting) < 2:
        return fitting[0] if fitting else ""
    related = "INSIDE" if _is_in(known, objects[-1], relation.lower()) else "ON"
    return next((action for action in fitting if known.relation_of(action) == related), "")


def _is_in(known: Knowledge, place: str, relation: str) -> bool:
    """Return whether a thing is put in a place: in a hollow one without a top, unless the name says `on`."""
    if relation in (*_ON, *_IN):
        return relation in _IN
    name = place.replace("_", " ")
    is_hollow = known.has(name, "CONTAINERS") or known.has(name, "RECIPIENT")
    return is_hollow and not known.has(name, "SURFACES")


def words_of(name: str) -> str:
    """Return a name of a program in words, `close eyes` of `closeEyes` and `close_eyes`."""
    return " ".join(_HUMP.sub(" ", name).replace("_", " ").split())
