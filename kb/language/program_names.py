"""Names of actions as programs, planners and robots' interfaces spell them, and the step of a call."""

import re
from collections.abc import Sequence

from hearth.kb.knowledge import Knowledge
from hearth.kb.loading.load import default
from hearth.kb.spelling import key_of

PLACED = "put"
"""The meaning of names that put a thing in or on another; the second thing decides which."""

NAMES: dict[str, str] = {
    **dict.fromkeys(("goto", "goes to", "navigate", "navigateto", "navto", "moveto", "walkto", "gotolocation"), "Walk"),
    **dict.fromkeys(("pick", "pickup", "pickupobject", "take", "takeobject", "fetch", "grasp", "get"), "Grab"),
    **dict.fromkeys(("put", "place", "putobject", "placeobject", "putdown", "puton", "placeon"), PLACED),
    **dict.fromkeys(("placein", "putinside", "insert"), "PutIn"),
    **dict.fromkeys(("turnon", "toggleon", "toggleobjecton", "activate", "toggle", "poweron"), "SwitchOn"),
    **dict.fromkeys(("turnoff", "toggleoff", "toggleobjectoff", "deactivate", "poweroff"), "SwitchOff"),
    **dict.fromkeys(("clean", "cleanobject"), "Wash"),
    **dict.fromkeys(("openobject",), "Open"),
    **dict.fromkeys(("closeobject", "shut"), "Close"),
    **dict.fromkeys(("sliceobject", "slice", "chop"), "Cut"),
    **dict.fromkeys(("dropobject", "letgo"), "Drop"),
    **dict.fromkeys(("examine", "inspect", "lookatobject"), "LookAt"),
    **dict.fromkeys(("search", "searchfor", "locate", "scanfor"), "Find"),
    **dict.fromkeys(("siton", "sitdownon"), "Sit"),
    **dict.fromkeys(("lieon", "liedownon"), "Lie"),
}
"""The key of a name in a program -> the action."""

_ALONE: dict[str, str] = {
    **dict.fromkeys(("putback", "putaway", "placeback", "returnobject"), "PutObjBack"),
    **dict.fromkeys(("putdown", "setdown", "release"), "Release"),
}
"""Names that mean another action where they have one thing."""

_ARITY = {PLACED: (2,), "PutIn": (2,)}
_HUMP = re.compile(r"(?<=[a-z0-9])(?=[A-Z])")


def action_of(name: str, objects: Sequence[str], relation: str = "") -> str:
    """Return the action that a program's name means for these objects; empty where the table has none.

    Args:
        name: the name of the call, the value of `action`, or the first word of a pair.
        objects: names of the things.
        relation: how the last thing is named, as `on` in `place(obj="cup", on="table")`.
    """
    key = key_of(words_of(name)).replace("_", "")
    meant = _ALONE.get(key, "") if len(objects) == 1 else ""
    meant = meant or NAMES.get(key, "")
    if not meant or len(objects) not in _ARITY.get(meant, (1,)):
        return ""
    return _put(default(), objects[1], relation) if meant == PLACED else meant


def _put(known: Knowledge, place: str, relation: str) -> str:
    """Return whether a thing is put in or on a place: in a hollow place without a top, unless the name says `on`."""
    if relation.lower() in ("on", "onto", "ontop"):
        return "PutBack"
    name = place.replace("_", " ")
    is_hollow = known.has(name, "CONTAINERS") or known.has(name, "RECIPIENT")
    is_in = relation.lower() in ("in", "into", "inside") or (is_hollow and not known.has(name, "SURFACES"))
    return "PutIn" if is_in else "PutBack"


def words_of(name: str) -> str:
    """Return a name of a program in words, `close eyes` of `closeEyes` and `close_eyes`."""
    return " ".join(_HUMP.sub(" ", name).replace("_", " ").split())
