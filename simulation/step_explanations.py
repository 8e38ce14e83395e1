"""Explanations of steps: each check of an action, and the edges or states by which it held or failed."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

from hearth.kb.formula import And, Formula, Or, Some, Term, free
from hearth.kb.knowledge_records import Condition
from hearth.schemas.failures import Failure
from hearth.schemas.literals import Literal
from hearth.schemas.program import Step
from hearth.schemas.vocabulary import EVERY_STATE_ID, STATE_ID, STATES
from hearth.simulation.rules import Rules
from hearth.simulation.world import edge_rows
from hearth.simulation.world.agent import Agent
from hearth.simulation.world.bits import indices, lowest
from hearth.simulation.world.node_states import states_of
from hearth.simulation.world.world import World


@dataclass(frozen=True, slots=True)
class Check:
    """One check before a step: the literal as the knowledge writes it, what it held by, and whether it held."""

    literal: str
    by: str
    held: bool = True


@dataclass(frozen=True, slots=True)
class _Cast:
    """A world, a binding of the variables, and whether the rule `made_bed` is on."""

    world: World
    agent: Agent
    o: int
    s: int
    made_bed: bool

    def index(self, term: Term) -> int:
        """Return the index of the node that a term names, or -1."""
        index = {"a": self.agent.index, "o": self.o, "s": self.s}.get(term.name, -1)
        if index < 0 or not term.function:
            return index
        if term.function == "room":
            return edge_rows.room_of(self.world, index)
        return next((place for thing, place, _ in self.agent.origins if thing == index), -1)

    def name(self, index: int) -> str:
        home = self.world.home
        return f"{home.classes[index]} ({home.ids[index]})" if index >= 0 else "nothing"


def checks(world: World, step: Step, rules: Rules) -> Iterator[Check]:
    """Yield the checks of a step that can be done in this world, in the order they are made.

    Examples:
        >>> from hearth.simulation.step_explanations import checks
        >>> for check in list(checks(execution.worlds[1], execution.program.steps[1], hearth.Env().rules))[:2]:
        ...     print(check.literal, "|", check.by)
        affords(o) | fridge (137) is CAN_OPEN CONTAINERS HAS_PLUG HAS_SWITCH
        close(a, o) | character CLOSE fridge (137)
    """
    home = world.home
    index = [home.index[ref.node] for ref in step.objects if ref.node is not None]
    o, s = [*index, -1, -1][:2]
    cast = _Cast(world, world.agents[step.agent], o, s, rules.made_bed)
    for condition in _conditions(world, step, rules):
        yield Check(str(condition.formula), _witness(condition.formula, cast))


def checks_until(world: World, step: Step, rules: Rules, failure: Failure) -> Iterator[Check]:
    """Yield the checks of a step that fails, in the order they are made: those that hold, then the one that does not.

    There is none where the failure is not one of the checks: nothing has to be bound, or the action is not executed.
    """
    conditions = list(_conditions(world, step, rules))
    at = _failing(conditions, world, step, failure)
    if at is None:
        return
    for number, check in enumerate(checks(world, step, rules)):
        if number == at:
            yield Check(check.literal, "", held=False)
            return
        yield check


def facts(world: World, agent: int, nodes: Iterable[int]) -> Iterator[str]:
    """Yield what holds of a character and of some nodes: states and places, what it is close to, faces and holds."""
    home = world.home
    cast = _Cast(world, world.agents[agent], -1, -1, made_bed=True)
    for i in dict.fromkeys(home.index[node] for node in nodes if node in home.index):
        if not home.characters >> i & 1:
            yield f"{cast.name(i)}: {'; '.join(filter(None, (' '.join(states_of(i, world.states)), _place(cast, i))))}"
    me = cast.agent
    shown = {"CLOSE": me.close, "FACING": me.facing, "ON": me.on, "holding": me.held}
    posture = " ".join(states_of(me.index, world.states)) or "standing"
    related = (f"{word} {_some(cast, mask)}" for word, mask in shown.items() if mask)
    room = cast.name(edge_rows.agent_room(world, me))
    yield f"{cast.name(me.index)}: {'; '.join((f'{posture} in {room}', *related))}"


def _place(cast: _Cast, i: int) -> str:
    world = cast.world
    holders = [cast.name(agent.index) for agent in world.agents if agent.held >> i & 1]
    around = edge_rows.inside(world, i) & ~world.home.rooms
    places = [f"held by {name}" for name in holders]
    places += [
        f"{word} {_some(cast, mask)}" for word, mask in (("ON", edge_rows.on(world, i)), ("INSIDE", around)) if mask
    ]
    room = edge_rows.room_of(world, i)
    return ", ".join((*places, f"in {cast.name(room)}" if room >= 0 else "in no room"))


def _some(cast: _Cast, mask: int) -> str:
    names = [cast.name(i) for i in indices(mask) if not cast.world.home.properties["BODY_PART"] >> i & 1]
    rest = f" and {len(names) - MOST_NAMED} more" if len(names) > MOST_NAMED else ""
    return (", ".join(names[:MOST_NAMED]) or "only itself") + rest


MOST_NAMED = 4
"""Things that a fact names."""


def _conditions(world: World, step: Step, rules: Rules) -> Iterator[Condition]:
    """Yield the checks of an action that these rules make."""
    action = world.home.knowledge.actions.get(step.action)
    for condition in action.preconditions if action is not None else ():
        if not condition.option or getattr(rules, condition.option, False):
            yield condition


def _failing(conditions: list[Condition], world: World, step: Step, failure: Failure) -> int | None:
    """Return the check of a failure: of several with its code, the one about the state found, or the first object."""
    found = [number for number, condition in enumerate(conditions) if condition.code is failure.code]
    if failure.actual in EVERY_STATE_ID:
        states = [n for n in found if str(conditions[n].formula).endswith(f", {failure.actual})")]
        found = states or found
    node = next(iter(failure.objects), None)
    variable = next((name for name, ref in zip("os", step.objects, strict=False) if ref.node == node), "")
    about = (number for number in found if variable in free(conditions[number].formula))
    return next(about, next(iter(found), None))


def _witness(formula: Formula, cast: _Cast) -> str:
    if isinstance(formula, Or):
        return next((text for part in formula.parts if (text := _witness(part, cast))), "")
    if isinstance(formula, Literal):
        find = (_NEGATED_WITNESSES if formula.negated else _WITNESSES).get(formula.name)
        return find(formula, cast) if find else ""
    if isinstance(formula, And):
        return ", ".join(text for part in formula.parts if (text := _witness(part, cast)))
    if isinstance(formula, Some) and "REMEMBERS" in str(formula):
        return f"it came from {cast.name(cast.index(Term('o', 'origin')))}"
    if isinstance(formula, Some):
        return ", ".join(map(cast.name, edge_rows.held_indices(cast.agent)))
    return ""


def _close(atom: Literal[Term], cast: _Cast) -> str:
    agent, x = cast.agent, cast.index(atom.terms[1])
    if x < 0:
        return ""
    if agent.close >> x & 1:
        return f"character CLOSE {cast.name(x)}"
    world = cast.world
    hop = agent.close & edge_rows.on(world, x)
    if hop:
        return f"character CLOSE {cast.name(lowest(hop))}, {cast.name(x)} ON {cast.name(lowest(hop))}"
    hop = agent.close & edge_rows.close(world, x)
    return f"character CLOSE {cast.name(lowest(hop))} CLOSE {cast.name(x)}" if hop else ""


def _facing(atom: Literal[Term], cast: _Cast) -> str:
    agent, x = cast.agent, cast.index(atom.terms[1])
    if agent.facing >> x & 1:
        return f"character FACING {cast.name(x)}"
    hop = agent.facing & edge_rows.faced(cast.world, x)
    return f"character FACING {cast.name(lowest(hop))} FACING {cast.name(x)}" if hop else ""


def _holds(atom: Literal[Term], cast: _Cast) -> str:
    x = cast.index(atom.terms[1])
    hand = "right" if cast.agent.right >> x & 1 else "left"
    return f"{cast.name(x)} in the {hand} hand"


def _hands(atom: Literal[Term], cast: _Cast) -> str:
    return "the right hand is free" if not cast.agent.right else "the left hand is free"


def _states(atom: Literal[Term], cast: _Cast) -> str:
    x = cast.index(atom.terms[0])
    if x < 0:
        return ""
    state = atom.terms[1].name
    matter = _pair(state) or (state, *cast.world.home.knowledge.excludes(state))
    now = [name for name in states_of(x, cast.world.states) if name in matter]
    if not now and x == cast.agent.index and state in STATE_ID:
        return "the character stands"
    if now or len(matter) == 1:
        return f"{cast.name(x)} is {' and '.join(now) or f'not {state}'}"
    return f"{cast.name(x)} is neither {' nor '.join(matter)}"


def _pair(state: str) -> tuple[str, ...]:
    """Return one of the ten states with its opposite, in the vocabulary's order; nothing of a further state."""
    first = STATE_ID.get(state, -1) & ~1
    return STATES[first : first + 2] if first >= 0 else ()


def _affords(atom: Literal[Term], cast: _Cast) -> str:
    x = cast.index(atom.terms[0])
    home = cast.world.home
    names = sorted(name for name, mask in home.properties.items() if mask >> x & 1)
    return f"{cast.name(x)} is {' '.join(names) or 'without properties'}"


def _room(atom: Literal[Term], cast: _Cast) -> str:
    x = cast.index(atom.terms[0])
    return f"in {cast.name(edge_rows.room_of(cast.world, x))}"


def _seat(atom: Literal[Term], cast: _Cast) -> str:
    world = cast.world
    on, aside = (
        edge_rows.taking_room(world, cast.o, cast.made_bed),
        edge_rows.turned_back(world, cast.o) * cast.made_bed,
    )
    bedding = f"; turned back: {', '.join(map(cast.name, indices(aside)))}" if aside else ""
    return f"on it: {', '.join(map(cast.name, indices(on))) or 'nothing'}{bedding}"


def _same_room(atom: Literal[Term], cast: _Cast) -> str:
    return f"both in {cast.name(edge_rows.agent_room(cast.world, cast.agent))}"


def _open(atom: Literal[Term], cast: _Cast) -> str:
    around = edge_rows.inside(cast.world, cast.index(atom.terms[0])) & ~cast.world.home.rooms
    return f"inside {cast.name(lowest(around))}, which is not CLOSED" if around else "inside nothing but its room"


def _edge(atom: Literal[Term], cast: _Cast) -> str:
    x = cast.index(atom.terms[1])
    return f"character {atom.name} {cast.name(x)}" if atom.name == "FACING" and cast.agent.facing >> x & 1 else ""


_NEGATED_WITNESSES: dict[str, Callable[[Literal[Term], _Cast], str]] = {"hidden": _open, "state": _states}

_WITNESSES: dict[str, Callable[[Literal[Term], _Cast], str]] = {
    "FACING": _edge,
    "affords": _affords,
    "close": _close,
    "facing": _facing,
    "free_hand": _hands,
    "has_room": _room,
    "holds": _holds,
    "room_to_lie": _seat,
    "room_to_sit": _seat,
    "same_room": _same_room,
    "state": _states,
}
