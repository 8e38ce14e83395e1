"""Why a step could be done: each check of its action in the knowledge's words, and the edges or states it held by."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from hearth.kb.formula import Atom, Formula, Not, Or, Some
from hearth.schemas.program import Step
from hearth.schemas.vocabulary import STATE_ID, STATES
from hearth.simulation import rows
from hearth.simulation.agent import Agent
from hearth.simulation.bits import indices, lowest
from hearth.simulation.nodes import states_of
from hearth.simulation.rules import Rules
from hearth.simulation.world import World


@dataclass(frozen=True, slots=True)
class Check:
    """One check before a step: the literal as the knowledge writes it, and what it held by."""

    literal: str
    by: str


@dataclass(frozen=True, slots=True)
class _Cast:
    """A world and who plays which variable."""

    world: World
    agent: Agent
    o: int
    s: int

    def index(self, variable: str) -> int:
        return {"a": self.agent.index, "o": self.o, "s": self.s}.get(variable, -1)

    def name(self, index: int) -> str:
        home = self.world.home
        return f"{home.classes[index]} ({home.ids[index]})" if index >= 0 else "nothing"


def checks(world: World, step: Step, rules: Rules) -> Iterator[Check]:
    """The checks of a step that can be done in this world, in the order they are made."""
    home = world.home
    index = [home.index[ref.node] for ref in step.objects if ref.node is not None]
    cast = _Cast(world, world.agents[step.agent], *([*index, -1, -1][:2]))
    for condition in home.knowledge.actions[step.action].preconditions:
        if condition.option and not getattr(rules, condition.option, False):
            continue
        yield Check(str(condition.formula), _witness(condition.formula, cast))


def _witness(formula: Formula, cast: _Cast) -> str:
    if isinstance(formula, Or):
        return next((text for part in formula.parts if (text := _witness(part, cast))), "")
    if isinstance(formula, Atom):
        tell = _TELL.get(formula.name)
        return tell(formula, cast) if tell else ""
    if isinstance(formula, Not) and isinstance(formula.part, Atom):
        return _states(formula.part, cast) if formula.part.name == "state" else ""
    if isinstance(formula, Some):
        return ", ".join(map(cast.name, rows.held_indices(cast.agent)))
    return ""


def _close(atom: Atom, cast: _Cast) -> str:
    agent, x = cast.agent, cast.index(atom.terms[1].name)
    if x < 0:
        return ""
    if agent.close >> x & 1:
        return f"character CLOSE {cast.name(x)}"
    world = cast.world
    hop = agent.close & rows.on(world, x)
    if hop:
        return f"character CLOSE {cast.name(lowest(hop))}, {cast.name(x)} ON {cast.name(lowest(hop))}"
    hop = agent.close & rows.close(world, x)
    return f"character CLOSE {cast.name(lowest(hop))} CLOSE {cast.name(x)}" if hop else ""


def _facing(atom: Atom, cast: _Cast) -> str:
    agent, x = cast.agent, cast.index(atom.terms[1].name)
    if agent.facing >> x & 1:
        return f"character FACING {cast.name(x)}"
    hop = agent.facing & rows.faced(cast.world, x)
    return f"character FACING {cast.name(lowest(hop))} FACING {cast.name(x)}" if hop else ""


def _holds(atom: Atom, cast: _Cast) -> str:
    x = cast.index(atom.terms[1].name)
    hand = "right" if cast.agent.right >> x & 1 else "left"
    return f"{cast.name(x)} in the {hand} hand"


def _hands(atom: Atom, cast: _Cast) -> str:
    return "the right hand is free" if not cast.agent.right else "the left hand is free"


def _states(atom: Atom, cast: _Cast) -> str:
    x = cast.index(atom.terms[0].name)
    if x < 0:
        return ""
    pair = STATE_ID[atom.terms[1].name] & ~1
    now = [name for name in states_of(x, cast.world.states) if name in STATES[pair : pair + 2]]
    return f"{cast.name(x)} is {' and '.join(now) or 'neither'}"


def _affords(atom: Atom, cast: _Cast) -> str:
    x = cast.index(atom.terms[0].name)
    home = cast.world.home
    names = sorted(name for name, mask in home.properties.items() if mask >> x & 1)
    return f"{cast.name(x)} is {' '.join(names) or 'without properties'}"


def _room(atom: Atom, cast: _Cast) -> str:
    x = cast.index(atom.terms[0].name)
    return f"in {cast.name(rows.room_of(cast.world, x))}"


def _seat(atom: Atom, cast: _Cast) -> str:
    on = [cast.name(i) for i in indices(rows.bearing(cast.world, cast.o))]
    return f"on it: {', '.join(on) or 'nothing'}"


_TELL: dict[str, Callable[[Atom, _Cast], str]] = {
    "affords": _affords,
    "close": _close,
    "facing": _facing,
    "free_hand": _hands,
    "has_room": _room,
    "holds": _holds,
    "room_to_lie": _seat,
    "room_to_sit": _seat,
    "state": _states,
}
