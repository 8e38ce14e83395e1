"""Class names, properties and requirements in people's words: `food_ice_cream` is `ice cream`."""

from __future__ import annotations

import re
from collections.abc import Mapping

_FAMILY = re.compile(r"(?:food|clothes|instrument)_(?=.)")
"""The family that stands before a name of the release: `food_apple`, `clothes_hat`."""

_SIDE = re.compile(r"(.+)_(both|left|right)")
"""A part of the body that comes in pairs: `hands_both`, `eye_left`."""

_ONE = {"feet": "foot", "hands": "hand", "arms": "arm", "legs": "leg", "eyes": "eye"}

_MANY = {"foot": "feet", "hand": "hands", "arm": "arms", "leg": "legs", "eye": "eyes"}

_SPELLED = {
    "ceilinglamp": "ceiling lamp", "clothes_pile": "pile of clothes", "coffe_maker": "coffee maker",
    "coffeetable": "coffee table", "cpuscreen": "computer screen", "dinnertable": "dinner table",
    "doorjamb": "door frame", "fryingpan": "frying pan", "instrument_guitar": "guitar", "instrument_piano": "piano",
    "instrument_violin": "violin", "kitchencounter": "kitchen counter", "knifeblock": "knife block",
    "light": "light switch", "maindoor": "front door", "photoframe": "photo frame", "powersocket": "power socket",
    "standingmirror": "standing mirror", "stovefan": "stove fan", "tablelamp": "table lamp",
    "tooth_paste": "toothpaste", "tvstand": "television stand", "walllamp": "wall lamp", "wallshelf": "wall shelf",
    "waterglass": "water glass", "wineglass": "wine glass",
}  # fmt: skip
"""Names of the release that are spelled or ordered as nobody would."""

PROPERTY_WORDS: Mapping[str, str] = {
    "BODY_PART": "a part of the body",
    "CAN_OPEN": "something that opens",
    "CLOTHES": "clothes",
    "CONTAINERS": "a container",
    "COVER_OBJECT": "a cover",
    "CREAM": "a cream",
    "CUTTABLE": "something that can be cut",
    "DRINKABLE": "a drink",
    "EATABLE": "food",
    "GRABBABLE": "something that can be picked up",
    "HANGABLE": "something that can be hung up",
    "HAS_PAPER": "something with paper",
    "HAS_PLUG": "something with a plug",
    "HAS_SWITCH": "something with a switch",
    "LIEABLE": "something to lie on",
    "LOOKABLE": "something to look at",
    "MOVABLE": "something that can be moved",
    "PERSON": "a person",
    "POURABLE": "something that can be poured",
    "READABLE": "something to read",
    "RECIPIENT": "a vessel",
    "SITTABLE": "something to sit on",
    "SURFACES": "something to put things on",
}
"""A thing of each property, in words."""


def spoken(name: str) -> str:
    """Return a class as people say it: `coffee maker`, `apple`, `left hand`."""
    if name in _SPELLED:
        return _SPELLED[name]
    if paired := _SIDE.fullmatch(name):
        part, side = paired.groups()
        return _MANY.get(part, part) if side == "both" else f"{side} {_ONE.get(part, part)}".replace("_", " ")
    return _FAMILY.sub("", name, count=1).replace("_", " ")


def requirement_words(requirement: str) -> str:
    """Return what an action asks of an object: `something that opens, or one of these: desk, window`.

    Args:
        requirement: as the knowledge prints it: `CAN_OPEN or `desk` or `window``.
    """
    kinds, classes = [], []
    requirement, _, never = requirement.partition(", not ")
    for part in requirement.split(" or "):
        if part.startswith("`"):
            classes.append(spoken(part.strip("`")))
        else:
            kinds.append(_kind(part))
    if len(classes) == 1:
        kinds.append(_with_article(classes.pop()))
    named = f"one of these: {', '.join(classes)}" if classes else ""
    but = f", but not {_either([spoken(each.strip('`')) for each in never.split(', ')])}" if never else ""
    return ", or ".join(filter(None, (_either(kinds), named))) + but


def fact_words(fact: str) -> str:
    """Return a fact that a failure names, with its states and classes in words: `open or closed`."""
    return re.sub(r"\b[A-Z]{2,}(?:_[A-Z]+)*\b|\b[a-z]+(?:_[a-z]+)+\b", lambda found: spoken(found[0].lower()), fact)


def _with_article(name: str) -> str:
    return f"{'an' if name[:1] in 'aeiou' else 'a'} {name}"


def _kind(part: str) -> str:
    """Return one property, or several together, in words; text that is in words already stays."""
    if named := re.fullmatch(r"a class named \*(.+)\*", part):
        return f"something with `{spoken(named[1])}` in its name"
    names = part.split(" and ")
    if len(names) == 1:
        return _property(part)
    first, *others = (_property(name) for name in names)
    return f"{first} and is {' and '.join(others)}"


def _property(name: str) -> str:
    if name in PROPERTY_WORDS or not re.fullmatch(r"[A-Z][A-Z_]*", name):
        return PROPERTY_WORDS.get(name, name)
    return f"a thing of the kind {name.lower().replace('_', ' ')}"


def _either(words: list[str]) -> str:
    *first, last = words or [""]
    return f"{', '.join(first)} or {last}" if first else last
