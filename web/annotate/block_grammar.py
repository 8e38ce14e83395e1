"""Blocks from the action grammar: each action with its slots, each declared thing with the slots that take it."""

from functools import lru_cache
from typing import Any

from hearth.kb.knowledge import Knowledge
from hearth.kb.knowledge_records import Action
from hearth.web.annotate.program_draft import Draft

DRAWERS: tuple[tuple[str, tuple[str, ...]], ...] = (
    ("Go", ("goes",)),
    ("Sit, lie, stand", ("rests", "rises", "gets_up", "lies")),
    ("Take and put", ("takes", "puts", "frees_hand")),
    ("Open and switch", ("operates",)),
    ("Dress", ("dresses",)),
    ("Look", ("looks", "idle")),
    ("By hand", ("hand",)),
)
"""The drawers of actions and their groups; the first that fits has the action."""

OTHER = "Other"

DRINKWARE, POURED_FROM = "drinkware", "vessel"
"""Kinds of things that hold a drink: cups and glasses; and bottles and jugs, which are vessels that pour."""


def drawer(action: Action, known: Knowledge) -> str:
    """Return the drawer in which an action's block is found."""
    groups = ((name, each) for name, members in DRAWERS for each in members)
    return next((name for name, each in groups if action.name in known.group(each)), OTHER)


@lru_cache(maxsize=4)
def actions(known: Knowledge) -> tuple[dict[str, Any], ...]:
    """Every action as a block: its name, drawer, words with `{0}` for slots, the kind of each slot, whether it runs."""
    return tuple(
        {
            "name": action.name,
            "drawer": drawer(action, known),
            "words": action.template,
            "slots": [f"{action.name} {slot}" for slot in range(action.arity)],
            "roles": [role.replace("_", " ") for role in action.roles],
            "runs": action.executed,
        }
        for action in sorted(known.actions.values(), key=lambda each: (not each.executed, each.id))
    )


def things(draft: Draft, known: Knowledge) -> list[dict[str, Any]]:
    """Return every declared thing: its name, instance, words, and the kinds of slots that take it.

    A slot that has a thing already keeps it, as in a program of an earlier version.
    """
    kept = {(ref, f"{each.action} {slot}") for each in draft.blocks for slot, ref in enumerate(each.things) if ref}
    return [
        {
            "name": ref.name,
            "instance": ref.instance,
            "words": draft.called(ref),
            "room": ref.name in draft.rooms,
            "fits": sorted({*_slots(ref.name, known), *(slot for thing, slot in kept if thing == ref)}),
        }
        for ref in draft.things()
    ]


@lru_cache(maxsize=4_096)
def _slots(name: str, known: Knowledge) -> list[str]:
    return [
        f"{action.name} {slot}"
        for action in known.actions.values()
        for slot in range(action.arity)
        if is_offered(action.name, slot, name, known)
    ]


def is_offered(action: str, slot: int, name: str, known: Knowledge) -> bool:
    """Return whether pages offer a thing for a slot: what the grammar affords, but food and drink by their nature.

    The grammar affords "Drink" and "Eat" of any vessel, which stands for its content. In words that is "Drink plate".
    """
    thing = known.object_class(name)
    if thing is None or not known.affords(action, slot, name):
        return False
    if action == "Drink":
        return "DRINKABLE" in thing.properties or _holds_drinks(name, known)
    return action != "Eat" or "EATABLE" in thing.properties


def _holds_drinks(name: str, known: Knowledge) -> bool:
    thing, kinds = known.object_class(name), known.ancestors(name)
    return DRINKWARE in kinds or (thing is not None and POURED_FROM in kinds and "POURABLE" in thing.properties)
