"""The actions of action set 3: those of set 2 with their consequences, and the acts that only set 3 executes.

An act that only set 3 executes has no function of its own: its checks and effects are read from its row of
`actions.yaml`. Where set 2 has a function for a check, that is used, with its words.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache

from hearth.kb.action_sets import excused
from hearth.kb.formula import And, Formula, Or, Some, Term, free
from hearth.kb.knowledge import Knowledge
from hearth.kb.knowledge_records import Action as Known
from hearth.kb.knowledge_records import Condition, Consequence
from hearth.schemas.failures import Code, Failure
from hearth.schemas.literals import Literal
from hearth.schemas.vocabulary import EVERY_STATE_ID
from hearth.simulation.actions import common
from hearth.simulation.actions.common import Action, Masks, refuse
from hearth.simulation.actions.formula_evaluation import Reading
from hearth.simulation.actions.locomotion import need_legs
from hearth.simulation.actions.prepared_effects import bound_to, prepared
from hearth.simulation.actions.registry import ACTIONS, EVERY
from hearth.simulation.actions.situation import Situation
from hearth.simulation.rules import Rules
from hearth.simulation.world import edge_rows
from hearth.simulation.world.agent import Agent
from hearth.simulation.world.bits import indices, mask_of
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World


@lru_cache(maxsize=16)
def actions(knowledge: Knowledge, placed: bool) -> Mapping[str, Action]:
    """Every action of set 3 by name, of characters at places or of others."""
    found = dict(EVERY if placed else ACTIONS)
    for name, known in knowledge.actions.items():
        later = known.later
        if later is None:
            continue
        if name in EVERY:
            if name in found:
                found[name] = _followed(found[name], later, knowledge)
        elif later.like:
            found[name] = _followed(found[later.like]._replace(name=name), later, knowledge)
        else:
            found[name] = _by_literals(known, later, knowledge)
    return found


def actions_of(home: Home, placed: bool) -> Mapping[str, Action]:
    """Return every action of set 3 in a home; kept with the home, since every step asks."""
    known = home.kinds.get(_OF_PLACED if placed else _OF_OTHERS)
    if known is None:
        known = home.kinds[_OF_PLACED if placed else _OF_OTHERS] = (None, actions(home.knowledge, placed))
    found: Mapping[str, Action] = known[1]
    return found


_OF_PLACED, _OF_OTHERS = -3, -4
"""The places of a home's actions among its `kinds`; no identity is below 0."""


def _followed(action: Action, later: Consequence, knowledge: Knowledge) -> Action:
    """Return an action of set 2 with the additions of set 3."""
    if later.unless:
        return _excused(_followed(action, replace(later, unless=()), knowledge), later, knowledge)
    if later.preconditions:
        return _checked(_followed(action, replace(later, preconditions=()), knowledge), later)
    if not later.effects:
        return action

    more, done = prepared(later.effects, knowledge), action.rule
    effects = more.after
    if not more.marks and len(more.guards) == 1:
        guard = more.guards[0]

        def rule(world: World, number: int, o: int, s: int, rules: Rules) -> World | Failure:
            result = done(world, number, o, s, rules)
            if type(result) is not World or not guard(world, world.agents[number], o, s):
                return result
            return effects(world, result, world.agents[number], o, s, rules)

    else:

        def rule(world: World, number: int, o: int, s: int, rules: Rules) -> World | Failure:
            result = done(world, number, o, s, rules)
            if type(result) is not World:
                return result
            return effects(world, result, world.agents[number], o, s, rules)

    return Action(action.name, rule, action.mask)


def _checked(action: Action, later: Consequence) -> Action:
    """Return an action that is refused in a few more states of its first object, after its own checks."""
    states = [str(each.formula.terms[1].name) for each in later.preconditions if isinstance(each.formula, Literal)]
    rows = [(EVERY_STATE_ID[name], name) for name in states]
    code = later.preconditions[0].code

    def rule(world: World, number: int, o: int, s: int, rules: Rules) -> World | Failure:
        result = action.rule(world, number, o, s, rules)
        if type(result) is World:
            for row, name in rows:
                if row < len(world.states) and world.states[row] >> o & 1:
                    return refuse(world, code, *_wanted(f"not state(o, {name})", world, o), o)
        return result

    def masks(situation: Situation) -> Masks:
        found, states = action.mask(situation), situation.world.states
        never = 0
        for row, _ in rows:
            never |= states[row] if row < len(states) else 0
        if not never or found is None:
            return found
        left = (found[0] & ~never, *found[1:])
        return left if left[0] else None

    return Action(action.name, rule, masks)


def _excused(action: Action, later: Consequence, knowledge: Knowledge) -> Action:
    """Return an action of which some checks hold in one more case; it is read from its literals then."""
    known = knowledge.actions[action.name]
    effects = (*known.effects, *later.effects)
    by_literals = _by_literals(known, Consequence(excused(known.preconditions, later), effects), knowledge)
    codes = {each.code for each in later.unless}
    rows = [EVERY_STATE_ID[each.formula.terms[1].name] for each in later.unless if isinstance(each.formula, Literal)]

    def rule(world: World, number: int, o: int, s: int, rules: Rules) -> World | Failure:
        result = action.rule(world, number, o, s, rules)
        if (
            not isinstance(result, Failure)
            or result.code not in codes
            or not any(world.states[k] >> o & 1 for k in rows)
        ):
            return result
        return by_literals.rule(world, number, o, s, rules)

    def masks(situation: Situation) -> Masks:
        found, world = action.mask(situation), situation.world
        if not any(world.states[k] for k in rows if k < len(world.states)):
            return found
        more = by_literals.mask(situation)
        if found is None or more is None:
            return found or more
        return tuple(one | other for one, other in zip(found, more, strict=True))

    return Action(action.name, rule, masks)


def _by_literals(known: Known, later: Consequence, knowledge: Knowledge) -> Action:
    checks = tuple(_Check(condition, known) for condition in later.preconditions)
    effects = prepared(later.effects, knowledge).after

    def rule(world: World, number: int, o: int, s: int, rules: Rules) -> World | Failure:
        agent, objects = world.agents[number], (o, s)
        if o == s and s >= 0:
            return refuse(world, Code.NOT_AFFORDED, "two different things", "the same twice", o)
        reading, bound = Reading(world, agent, rules, known.name), bound_to(agent, o, s)
        for check in checks:
            if not reading.holds(check.condition.formula, bound):
                return check.refusal(world, agent, objects, rules)
        return effects(world, world, agent, o, s, rules, known.name)

    return Action(known.name, rule, lambda situation: _masks(situation, known, checks))


@dataclass(frozen=True, slots=True)
class _Check:
    """A check of an act, the argument that it is about, and its failure."""

    condition: Condition
    action: Known

    @property
    def position(self) -> int:
        """The argument that it is about: 0 or 1; -1 for the character alone."""
        return max(("os".index(name) for name in free(self.condition.formula) & {*"os"}), default=-1)

    def refusal(self, world: World, agent: Agent, objects: tuple[int, int], rules: Rules) -> Failure:
        """Return the failure of a check that does not hold, in the words that set 2 has for it."""
        code, at = self.condition.code, max(self.position, 0)
        o = objects[at]
        if code is Code.NOT_CLOSE and "close(a" in str(self.condition.formula) and self.position >= 0:
            found = common.need_close(world, agent, o, near_hands=rules.near_hands)
        elif code is Code.NOT_AFFORDED:
            found = common.need_able(world, agent, o, self.action.name, at)
        elif code is Code.NOT_HOLDING and self.position >= 0:
            found = common.need_holding(world, agent, o)
        elif code in (Code.SITTING, Code.LYING):
            found = need_legs(world, agent, *[i for i in objects if i >= 0])
        else:
            found = _REFUSALS[code](world, agent, o) if code in _REFUSALS and o >= 0 else None
        if found is not None:
            return found
        expected, actual = _wanted(str(self.condition.formula), world, o)
        if self.position >= 0:
            return refuse(world, code, expected, actual, o)
        names, tools = tools_of(self.condition.formula, world)
        if not tools:
            return replace(refuse(world, code, expected, actual), names=names[:1])
        here = edge_rows.agent_room(world, agent)
        return refuse(world, code, expected, actual, min(tools, key=lambda i: (edge_rows.room_of(world, i) != here, i)))


def tools_of(formula: Formula, world: World) -> tuple[tuple[str, ...], tuple[int, ...]]:
    """Return what a check of a tool asks for, by class or part of its name, and the things of the world that are so.

    Of alternatives the first counts of which the home has things: a needle before a sewing machine.
    """
    names: list[str] = []
    for some in formula.parts if isinstance(formula, Or) else (formula,):
        if not isinstance(some, Some):
            continue
        kinds = [each for each in _literals(some.part) if each.name in ("class", "class_contains")]
        home = world.home
        things = mask_of(i for each in kinds for i in indices(_of_class(each, home)))
        names += [each.terms[1].name for each in kinds]
        things &= ~home.absent & ~(world.states[_GONE] if len(world.states) > _GONE else 0)
        if things:
            return tuple(names), tuple(indices(things))
    return tuple(names), ()


def _of_class(atom: Literal[Term], home: Home) -> int:
    name = atom.terms[1].name
    if atom.name == "class":
        return home.by_class.get(name, 0)
    return mask_of(i for known, row in home.by_class.items() if name in known for i in indices(row))


def _literals(formula: Formula) -> Iterator[Literal[Term]]:
    if isinstance(formula, Literal):
        yield formula
    elif isinstance(formula, And | Or):
        for part in formula.parts:
            yield from _literals(part)


_GONE = EVERY_STATE_ID["GONE"]


_REFUSALS = {
    Code.NO_FREE_HAND: common.need_free_hand,
    Code.INSIDE_CLOSED: common.need_reachable,
    Code.IS_CLOSED: lambda world, agent, o: common.need_open(world, o),
}


def _wanted(words: str, world: World, o: int) -> tuple[str, str]:
    """Return a formula as an expectation, with the act that would be needed, and how it is instead."""
    if not words.startswith("not state("):
        return words, "not so"
    name = words.rpartition(", ")[2].rstrip(")")
    act = next(_undoing(name, world, o), "")
    return f"not {name} ([{act}] would change that)" if act else f"not {name}, which nothing undoes", name


def _undoing(state: str, world: World, o: int) -> Iterator[str]:
    """Yield the acts that bring a thing out of a state, if it can be one of their objects."""
    knowledge = world.home.knowledge
    for known in knowledge.actions.values():
        for effect in (*known.effects, *(known.later.effects if known.later else ())):
            subject, *others = effect.literal.terms
            position = "os".find(subject.name)
            ends = effect.literal.name == "state" and others[0].name in (
                (state,) if effect.literal.negated else knowledge.excludes(state)
            )
            if ends and position >= 0 and not subject.function and world.home.able(known.name, position) >> o & 1:
                yield known.name
                break


def _masks(s: Situation, known: Known, checks: tuple[_Check, ...]) -> Masks:
    """Return the objects for which the checks hold, each argument for itself."""
    reading = Reading(s.world, s.me, s.rules, known.name)
    bound = {"a": s.me.index}
    if not all(reading.holds(check.condition.formula, bound) for check in checks if check.position < 0):
        return None
    masks = tuple(
        _mask(s, reading, "os"[at], at, [check.condition.formula for check in checks if check.position == at])
        for at in range(known.arity)
    )
    return masks if all(masks) else None


def _mask(s: Situation, reading: Reading, name: str, at: int, formulas: list[Formula]) -> int:
    found, slow = s.home.everything, []
    for formula in formulas:
        known = _known_mask(s, reading.action, str(formula).replace(f"({name}", "(o").replace(f" {name})", " o)"), at)
        if known is None:
            slow.append(formula)
        else:
            found &= known
    for formula in slow:
        found = mask_of(i for i in indices(found) if reading.holds(formula, {"a": s.me.index, name: i}))
    return found


def _known_mask(s: Situation, action: str, formula: str, at: int) -> int | None:
    if formula == "affords(o)":
        return s.able(action, at)
    if formula == "close(a, o)":
        return s.close
    if formula == "holds(a, o)":
        return s.held
    if formula == "not hidden(o)":
        return ~s.hidden
    return None


def executed(knowledge: Knowledge) -> Iterator[str]:
    """Yield the names of the actions that set 3 executes, those of characters at places among them."""
    yield from sorted(actions(knowledge, placed=True))
