"""Regression: from a literal that is to hold back to an instruction that can be done now (thesis B.1.1).

The search asks the action table which actions bring a literal about and which conditions each needs first. A condition
that does not hold by belief is the next literal, until an action is legal. So for `INSIDE(plate, dishwasher)`: put it
in, which needs it held, which needs it within reach and its container open, which needs that within reach, which needs
a walk towards its room.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from functools import lru_cache

from hearth.agents.belief import Belief
from hearth.kb.formula import And, Effect, Formula, Or, Term
from hearth.kb.knowledge import Knowledge
from hearth.kb.knowledge_records import Action
from hearth.schemas.literals import HANDS, HOLDS, Literal
from hearth.schemas.program import ObjectRef, Step
from hearth.schemas.vocabulary import OPPOSITE, STATE_ID
from hearth.simulation.actions.legal import Legal
from hearth.simulation.actions.registry import MOVES
from hearth.simulation.observation.views import View
from hearth.simulation.world import edge_rows
from hearth.simulation.world.bits import indices, lowest

ME, FIRST, SECOND = "a", "o", "s"
"""The variables of the action table: the agent, and the objects."""

DEEPEST = 8
"""Literals that stand for each other before a search is given up."""

Bound = Mapping[str, int]
Way = tuple[Action, Bound]
"""An action, and the nodes that its variables stand for."""


class Regression:
    """The search in one tick.

    Attributes:
        seen: the set of nodes in view.
        spare: held things from the one to be put down first, should a hand be needed.
    """

    def __init__(self, view: View, legal: Legal, belief: Belief, spare: tuple[int, ...] = ()) -> None:
        self.seen = view.mask
        self.world = view.world
        self.home = view.world.home
        self.agent = view.agent
        self.me = view.world.agents[view.agent]
        self.legal = legal
        self.belief = belief
        self.spare = spare

    def first(self, literal: Literal[int], above: tuple[Literal[int], ...] = ()) -> Step | None:
        """Return the instruction of now by which a literal is to hold in the end; None where none is found."""
        if literal in above or len(above) >= DEEPEST:
            return None
        ways = list(self._ways(literal))
        for action, bound in ways:
            if (step := self._step(action, bound)) is not None:
                return step
        above = (*above, literal)
        if literal.name == "CLOSE" and not literal.negated and literal.terms[0] == self.me.index:
            if (step := self._towards(literal.terms[1], above)) is not None:
                return step
        elif literal.negated and literal.name in HANDS and (step := self._put_down(literal.terms[1], above)):
            return step
        return next((step for action, bound in ways if (step := self._prepared(action, bound, above))), None)

    def _prepared(self, action: Action, bound: Bound, above: tuple[Literal[int], ...]) -> Step | None:
        """Return the instruction of now by which the first condition of an action that does not hold is to hold."""
        for condition in action.preconditions:
            if missing := self._missing(condition.formula, bound):
                return next((step for each in missing if (step := self.first(each, above))), None)
        return None

    def _ways(self, literal: Literal[int]) -> Iterator[Way]:
        """Yield the actions that make a literal true, the plainest first, with the values of their variables."""
        for action, terms in _making(self.home.knowledge, literal.name, len(literal.terms), literal.negated):
            bound = dict(zip(terms, literal.terms, strict=True))
            if bound.setdefault(ME, self.me.index) != self.me.index:
                continue
            arguments = [bound.get(variable, -1) for variable in _variables(action)]
            if all(i >= 0 and self.home.able(action.name, n) >> i & 1 for n, i in enumerate(arguments)):
                yield action, bound

    def _step(self, action: Action, bound: Bound) -> Step | None:
        return self._legal_step(action.name, *(bound[variable] for variable in _variables(action)))

    def _legal_step(self, name: str, *nodes: int) -> Step | None:
        """Return the instruction, if it can be done now."""
        masks = self.legal.masks.get(name)
        if masks is None or len(masks) != len(nodes):
            return None
        if not all(mask >> node & 1 for mask, node in zip(masks, nodes, strict=True)):
            return None
        home = self.home
        return Step(name, tuple(ObjectRef(home.classes[i], 0, home.ids[i]) for i in nodes), self.agent)

    def _towards(self, node: int, above: tuple[Literal[int], ...]) -> Step | None:
        """Return a walk to a node, or to its believed place, or an instruction that opens the way there."""
        for name in self._moves():
            if (step := self._legal_step(name, node)) is not None:
                return step
        if (place := self.place(node)) >= 0 and place != node:
            return self.first(Literal("CLOSE", (self.me.index, place)), above)
        return self._through(node, above) if self.home.rooms >> node & 1 else None

    def _through(self, room: int, above: tuple[Literal[int], ...]) -> Step | None:
        """Return a closed door on the way to a room opened, or a walk to where more doors are seen, nearest first."""
        home, closed = self.home, self.seen & self.belief.states[STATE_ID["CLOSED"]]
        rooms = [room]
        for each in rooms:  # grows
            for door in indices(home.doors):
                if not home.between[door] >> each & 1:
                    continue
                if closed >> door & 1 and (step := self.first(Literal("OPEN", (door,)), above)) is not None:
                    return step
                rooms += [i for i in indices(home.between[door] & home.rooms) if i not in rooms]
        others = (i for i in rooms[1:] if i != self.belief.room)
        return next((step for i in others for name in self._moves() if (step := self._legal_step(name, i))), None)

    def _moves(self) -> tuple[str, ...]:
        """Return the actions after which the agent is at, or nearer to, their object.

        By meters where those are allowed.
        """
        return _moves(self.home.knowledge)

    def place(self, node: int) -> int:
        """Return the believed node that a thing is on or in, and the room of a fixed thing.

        The answer is -1 for a room and for a character whose place is unknown.
        """
        if node in self.belief.where:
            return self.belief.where[node].node
        if (self.home.rooms | self.home.characters) >> node & 1:
            return -1
        return edge_rows.room_of(self.world, node)

    def _put_down(self, thing: int, above: tuple[Literal[int], ...]) -> Step | None:
        """Return a held thing on a surface within reach, or else on the nearest that is in view."""
        home = self.home
        surfaces = home.properties["SURFACES"] & home.furniture & self.seen
        for name in sorted(home.knowledge.group("puts") & self.legal.masks.keys()):
            if home.knowledge.relation_of(name) == "ON":
                near = surfaces & self.legal.masks[name][1]
                if near and (step := self._legal_step(name, thing, lowest(near))) is not None:
                    return step
        for surface in sorted(indices(surfaces), key=lambda i: (self._metres(i), i)):
            if (step := self.first(Literal("CLOSE", (self.me.index, surface)), above)) is not None:
                return step
        return None

    def _metres(self, node: int) -> float:
        """Return the straight distance to a fixed thing, meters; 0 without geometry."""
        box, pose = self.home.node(node).box, self.me.pose
        return 0.0 if box is None or pose is None else math.dist(pose.point, (box.center[0], box.center[2]))

    def _missing(self, formula: Formula, bound: Bound) -> tuple[Literal[int], ...]:
        """Return the literals that would make a condition hold, best first; none if it holds, or if none is known."""
        if isinstance(formula, And):
            return tuple(each for part in formula.parts for each in self._missing(part, bound))
        if isinstance(formula, Or):
            if any(self._holds(part, bound) for part in formula.parts):
                return ()
            return tuple(each for part in formula.parts for each in self._missing(part, bound))
        if not isinstance(formula, Literal) or self._holds(formula, bound):
            return ()
        return self._means(formula, tuple(bound.get(term.name, -1) for term in formula.terms))

    def _means(self, formula: Literal[Term], nodes: tuple[int, ...]) -> tuple[Literal[int], ...]:
        """Return the literals that would make one predicate of the action table hold."""
        name = formula.name
        if name == "state":
            return (Literal(formula.terms[1].name, nodes[:1], formula.negated),)
        if name == "close":
            return (Literal("CLOSE", nodes),)
        if name == "holds":
            return (Literal(HANDS[0], nodes),)
        if name == "hidden" and (container := self.belief.shut_in(nodes[0])) >= 0:
            return (Literal("OPEN", (container,)),)
        if name == "free_hand":
            held = (*self.spare, *(i for i in edge_rows.held_indices(self.me) if i not in self.spare))
            return tuple(Literal(HANDS[0], (self.me.index, i), True) for i in held)
        return ()

    def _holds(self, formula: Formula, bound: Bound) -> bool:
        """Return whether a condition holds by belief; a condition without a belief about it holds."""
        if isinstance(formula, And):
            return all(self._holds(part, bound) for part in formula.parts)
        if isinstance(formula, Or):
            return any(self._holds(part, bound) for part in formula.parts)
        if not isinstance(formula, Literal):
            return True
        found = self._believed(formula, tuple(bound.get(term.name, -1) for term in formula.terms))
        return found is None or found != formula.negated

    def _believed(self, formula: Literal[Term], nodes: tuple[int, ...]) -> bool | None:
        name, node = formula.name, nodes[-1]
        if name == "state":
            state = formula.terms[1].name
            return bool(self.belief.states[STATE_ID[state]] >> nodes[0] & 1) if state in STATE_ID else None
        if name == "property":
            return bool(self.home.properties[formula.terms[1].name] >> nodes[0] & 1)
        if name == "close":
            return self.near(node)
        if name == "holds":
            return bool(self.me.held >> node & 1)
        if name == "hidden":
            return self.belief.shut_in(nodes[0]) >= 0
        return not (self.me.right and self.me.left) if name == "free_hand" else None

    def near(self, node: int) -> bool:
        """Return whether the agent is close to a thing; if it is out of view, to the closed node that it is in."""
        if not self.seen >> node & 1:
            node = self.belief.shut_in(node)
        return node >= 0 and bool(self.seen >> node & 1) and edge_rows.is_close(self.world, self.me, node)


@lru_cache(maxsize=512)
def _making(knowledge: Knowledge, name: str, terms: int, negated: bool) -> tuple[tuple[Action, tuple[str, ...]], ...]:
    """Return the actions that make a literal true, or false, with the variables of its terms.

    Those that the thesis animates first, and none that only does more than a plainer one.
    """
    found = _effects(knowledge, HANDS[0] if name == HOLDS else name, terms, negated)
    if not found and negated and terms == 1:  # only effects that make its opposite true make it false
        found = _effects(knowledge, OPPOSITE[name], terms, negated=False)
    avoided = knowledge.group("variant") | knowledge.group("unplanned")
    ways = {
        (action.name, variables): (action, variables)
        for action, effect in found
        if (variables := tuple(term.name for term in effect.literal.terms[:terms])) and action.name not in avoided
    }
    return tuple(sorted(ways.values(), key=lambda way: ("animated" not in way[0].groups, way[0].id)))


def _effects(knowledge: Knowledge, name: str, terms: int, negated: bool) -> list[tuple[Action, Effect]]:
    """Return the effects on a predicate of an action's things; `ON` of one thing is its state, of two a relation."""
    return [
        (action, effect)
        for action in knowledge.actions.values()
        for effect in action.effects
        if effect.literal.negated == negated
        and _name(effect) == name
        and (effect.literal.name == "state") == (terms == 1)
        and not effect.variables
        and not any(term.function for term in effect.literal.terms)
    ]


def _name(effect: Effect) -> str:
    literal = effect.literal
    return literal.terms[1].name if literal.name == "state" else literal.name


@lru_cache(maxsize=8)
def _moves(knowledge: Knowledge) -> tuple[str, ...]:
    """Return the actions after which an agent is at, or nearer to, their object: by meters where those are allowed."""
    goes = knowledge.group("goes") - knowledge.group("variant") - knowledge.group("unplanned")
    return tuple(sorted(goes, key=lambda name: (name not in MOVES, name)))


def _variables(action: Action) -> tuple[str, ...]:
    return (FIRST, SECOND)[: action.arity]
