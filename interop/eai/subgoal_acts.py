"""The acts by which the interface brings a subgoal about."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache
from typing import Any

from hearth.interop.eai.temporal_logic import RELATIONS, STATES, Act, Atom, fact_true
from hearth.schemas.vocabulary import PROPERTIES
from hearth.schemas.yaml_limits import packaged
from hearth.simulation.world.world import World


@cache
def table() -> Mapping[str, Any]:
    """Return the content of `subgoal_acts.yaml`."""
    found: Mapping[str, Any] = packaged("hearth.interop.eai", "subgoal_acts.yaml")
    return found


def arity(name: str) -> int | None:
    """Return the number of arguments of a predicate or an action of subgoals; None for an unknown name."""
    if name in RELATIONS:
        return 2
    if name in STATES or name in PROPERTIES:
        return 1
    number: int | None = table()["actions"].get(name)
    return number


def ways(atom: Atom, world: World, me: str) -> list[list[Act]]:
    """Return the lists of acts that may bring an atom about; none where the interface knows no way.

    Args:
        atom: a fact or an act.
        world: things that are held there need not be fetched.
        me: the character, `character.65`.
    """
    if atom.name in table()["actions"]:
        return [list(_acted(atom, world, me))]
    if len(atom.terms) == 1:
        return [[("FIND", atom.terms), *((act, atom.terms) for act in acts)]
                for acts in table()["states"].get(atom.name, ())]  # fmt: skip
    one, other = atom.terms
    if atom.name == "ONTOP" and other == me:
        return [[("PUTON", (one,))]]
    if one == me and atom.name == "INSIDE":
        return [[("WALK", (other,))]]
    alone = table()["of_character"].get(atom.name, ())
    if one == me or atom.name in ("FACING", "HOLDS_RH", "HOLDS_LH"):
        return [[("FIND", (other,)), *((act, (other,)) for act in acts)] for acts in alone]
    fetched = [] if _held(one, world, me) else [("FIND", (one,)), ("GRAB", (one,))]
    return [[*fetched, ("FIND", (other,)), *((act, atom.terms) for act in acts)]
            for acts in table()["of_things"].get(atom.name, ())]  # fmt: skip


def _acted(atom: Atom, world: World, me: str) -> Iterator[Act]:
    yield from (("FIND", (term,)) for term in atom.terms)
    if atom.name in table()["held"] and not _held(atom.terms[0], world, me):
        yield "GRAB", atom.terms
    if atom.name in table()["faced"]:
        yield "TURNTO", atom.terms
    yield atom.name, atom.terms


def _held(thing: str, world: World, me: str) -> bool:
    return any(fact_true(hand, (me, thing), world) for hand in ("HOLDS_RH", "HOLDS_LH"))
