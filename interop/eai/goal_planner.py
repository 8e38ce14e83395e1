"""A planner for goals of the interface: it does an act that a fact needs, and before it the remedy of each refusal."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from itertools import permutations
from typing import Any

from hearth.interop.eai.task_worlds import TaskWorld
from hearth.kb.knowledge import Knowledge
from hearth.schemas.failures import Code, Failure
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.schemas.yaml_limits import packaged
from hearth.simulation.engine import act, run
from hearth.simulation.goal_text import read_goal
from hearth.simulation.goals import Progress
from hearth.simulation.rules import EVOLVING_GRAPH
from hearth.simulation.world.bits import indices
from hearth.simulation.world.world import World

DEEPEST = 8
"""Steps that are needed for one another, before the search is given up."""

MOST_ORDERS = 24
"""Orders of a goal's facts that are tried."""

ROUNDS = 4
"""Times that the planner repeats facts that later ones have undone."""

FIRST_DO: dict[Code, tuple[str, int]] = {
    Code.NOT_CLOSE: ("Walk", 0),
    Code.NOT_IN_ROOM: ("Walk", 0),
    Code.NOT_HOLDING: ("Grab", 0),
    Code.NOT_FACING: ("TurnTo", 0),
    Code.INSIDE_CLOSED: ("Open", 1),
    Code.IS_CLOSED: ("Open", 0),
    Code.IS_OPEN: ("Close", 0),
    Code.IS_ON: ("SwitchOff", 0),
    Code.IS_OFF: ("SwitchOn", 0),
    Code.IS_UNPLUGGED: ("PlugIn", 0),
    Code.IS_PLUGGED: ("PlugOut", 0),
    Code.SITTING: ("StandUp", -1),
    Code.LYING: ("StandUp", -1),
    Code.DOOR_CLOSED: ("Open", 0),
    Code.OCCUPIED: ("Grab", 1),
}
"""Remedies of a refused step: an action, and the place of its object among the failure's; -1 for none."""


@cache
def acts_of_facts() -> Mapping[str, Any]:
    """Return the content of `acts_of_facts.yaml`: actions by which relations come about."""
    found: Mapping[str, Any] = packaged("hearth.interop.eai", "acts_of_facts.yaml")
    return found


@dataclass(frozen=True, slots=True)
class Partial:
    """A world, and the steps that led to it."""

    world: World
    steps: tuple[Step, ...] = ()

    def with_step(self, step: Step) -> Partial | Failure:
        """Return the world after a step."""
        result = act(self.world, step, EVOLVING_GRAPH)
        return Partial(result, (*self.steps, step)) if isinstance(result, World) else result


class GoalPlanner:
    """Plans for one task.

    Args:
        there: the task at its start.
        knowledge: of actions.
    """

    def __init__(self, there: TaskWorld, knowledge: Knowledge) -> None:
        self.there, self.knowledge = there, knowledge
        self.me = there.start.home.ids[there.start.agents[0].index]
        self.goal = read_goal({"vh_goal": there.task.record["vh_goal"]}, there.start.home)

    def plan(self) -> tuple[Program, bool]:
        """Return a program that runs, and whether it reaches the goal; the first that was found where none does."""
        best: Program | None = None
        for facts in self._orders():
            for done in self._acted(Partial(self.there.start), self.there.task.actions):
                found = self._with_facts(done, facts)
                program = Program(steps=found.steps)
                execution = run(self.there.start, program, EVOLVING_GRAPH)
                if execution.failure is not None:
                    continue
                if Progress.of(self.goal, execution).satisfied:
                    return program, True
                best = best or program
        return best or Program(), False

    def _orders(self) -> Iterator[tuple[Any, ...]]:
        """Yield the goal's facts in orders to be tried: things before the character's own place, closing last."""
        facts = sorted((*self.there.task.relations, *self.there.task.states), key=self._rank)
        yield tuple(facts)
        for number, order in enumerate(permutations(facts)):
            if number >= MOST_ORDERS:
                return
            yield order

    def _rank(self, fact: Any) -> int:
        if "state" in fact:
            return {"OPEN": 0, "PLUGGED_IN": 1, "CLOSED": 3, "ON": 4}.get(fact["state"], 2)
        of_me = self.me in (fact["from_id"], fact["to_id"])
        return {"HOLDS_RH": 5, "HOLDS_LH": 5, "ON": 6, "INSIDE": 6, "CLOSE": 7, "FACING": 8}.get(
            fact["relation_type"], 6
        ) if of_me else 1  # fmt: skip

    def _acted(self, start: Partial, actions: Sequence[str]) -> Iterator[Partial]:
        """Yield worlds in which a goal's actions were done in their order, by things that the task is about."""
        if not actions:
            yield start
            return
        for word in actions[0].split("|"):
            for step in self._ways_to_do(word.strip().replace(" ", "")):
                done = self._achieved(start, step, ())
                if done is not None:
                    yield from self._acted(done, actions[1:])

    def _ways_to_do(self, word: str) -> Iterator[Step]:
        known = self.knowledge.action(word)
        if known is None:
            return
        home = self.there.start.home
        nodes = [number for number in self.there.names.values() if number != self.me]
        groups = [
            [n for n in nodes if home.able(known.name, place) >> home.index[n] & 1] for place in range(known.arity)
        ]
        if known.arity == 0:
            yield Step(known.name)
        elif known.arity == 1:
            yield from (self._step(known.name, node) for node in groups[0])
        else:
            yield from (self._step(known.name, a, b) for a in groups[0] for b in groups[1] if a != b)

    def _with_facts(self, done: Partial, facts: Sequence[Any]) -> Partial:
        """Return a world in which as many facts hold as can be brought about, one after the other."""
        for _ in range(ROUNDS):
            missing = [fact for fact in facts if not self._holds(done.world, fact)]
            for fact in missing:
                done = next(self._made(done, fact), done)
            if not missing:
                break
        return done

    def _made(self, done: Partial, fact: Any) -> Iterator[Partial]:
        """Yield worlds in which a fact was brought about."""
        begun = self._with_full_right_hand(done, fact) if fact.get("relation_type") == "HOLDS_LH" else done
        for step in self._ways(fact):
            found = self._achieved(begun, step, ())
            if found is not None and self._holds(found.world, fact):
                yield found

    def _with_full_right_hand(self, done: Partial, fact: Any) -> Partial:
        """Return a world in which the character holds another thing, so that the next one comes into its left hand."""
        home = self.there.start.home
        others = [home.ids[i] for i in indices(home.properties["GRABBABLE"] & ~home.characters)]
        for other in others[:MOST_ORDERS]:
            found = None if other == fact["to_id"] else self._achieved(done, self._step("Grab", other), ())
            if found is not None:
                return found
        return done

    def _seats(self) -> list[int]:
        """Return the things that a character may lie or sit on: the goal's, then those that the task is about."""
        ons = [row["to_id"] for row in self.there.task.relations if row["relation_type"] == "ON"]
        return [*ons, *(number for number in self.there.names.values() if number != self.me)]

    def _holds(self, world: World, fact: Any) -> bool:
        if "state" in fact:
            return world.has_state(fact["id"], fact["state"])
        return (fact["from_id"], fact["relation_type"], fact["to_id"]) in set(world.edges())

    def _ways(self, fact: Any) -> Iterator[Step]:
        """Yield the steps that bring a fact about."""
        if "state" in fact:
            names: tuple[str, ...] = tuple(sorted(self.knowledge.achieving(fact["state"])))
            if fact["id"] == self.me:
                seats = [number for number in self.there.names.values() if number != self.me]
                yield from (self._step(name, seat) for name in names for seat in seats if self._arity(name) == 1)
            yield from (self._step(name, fact["id"]) for name in names if self._arity(name) == 1)
            return
        acts = acts_of_facts()
        one, relation, other = fact["from_id"], fact["relation_type"], fact["to_id"]
        if one == self.me:
            names = acts["character"].get(relation, acts["character"]["ON"])
            yield from (self._step(name, other) for name in names)
        elif other == self.me:
            yield from (self._step(name, one) for name in acts["thing_of_character"])
        else:
            names = acts["things"].get(relation, ())
            yield from (self._step(name, one, other) for name in names)

    def _arity(self, name: str) -> int:
        return self.knowledge.arity[name]

    def _step(self, name: str, *nodes: int) -> Step:
        home = self.there.start.home
        return Step(name, tuple(ObjectRef(home.classes[home.index[node]], 1, node) for node in nodes))

    def _achieved(self, done: Partial, step: Step, above: tuple[Step, ...]) -> Partial | None:
        """Return the world after a step and the steps that it needed before."""
        for _ in range(DEEPEST):
            result = done.with_step(step)
            if isinstance(result, Partial):
                return result
            if step in above or len(above) >= DEEPEST:
                return None
            before = next(self._prepared(done, step, result, above), None)
            if before is None or before == done:
                return None
            done = before
        return None

    def _prepared(self, done: Partial, step: Step, failure: Failure, above: tuple[Step, ...]) -> Iterator[Partial]:
        """Yield worlds in which the reason of a refusal is gone."""
        if failure.code is Code.NO_FREE_HAND:
            yield from self._hands_freed(done, (*above, step))
            return
        if failure.code is Code.NOT_SITTING_OR_LYING:
            rests = [self._step(name, seat) for seat in self._seats() for name in acts_of_facts()["rests"]]
            yield from filter(None, (self._achieved(done, rest, (*above, step)) for rest in rests))
            return
        name, place = FIRST_DO.get(failure.code, ("", 0))
        if not name:
            return
        nodes = failure.objects or tuple(ref.node for ref in step.objects if ref.node is not None)
        wanted = Step(name) if place < 0 else self._step(name, nodes[min(place, len(nodes) - 1)]) if nodes else None
        if wanted is None or wanted.action == step.action:
            return
        found = self._achieved(done, replace(wanted, agent=step.agent), (*above, step))
        if found is not None:
            yield found

    def _hands_freed(self, done: Partial, above: tuple[Step, ...]) -> Iterator[Partial]:
        """Yield worlds in which a held thing, not one that the steps above need, is put down."""
        needed = {ref.node for step in above for ref in step.objects}
        home = done.world.home
        surfaces = [home.ids[i] for i in indices(home.properties["SURFACES"] & home.furniture)]
        for held in done.world.holding()[0]:
            for surface in surfaces if held not in needed else ():
                found = self._achieved(done, self._step("PutBack", held, surface), above)
                if found is not None:
                    yield found
