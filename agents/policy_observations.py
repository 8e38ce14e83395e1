"""The input of a learned policy from a view, and the meaning of its choices (thesis B.3.4, B.3.5)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

from hearth.agents.belief import containers
from hearth.agents.subgoals import Aims, Missing, Subgoal, Wanted
from hearth.kb.knowledge import Knowledge
from hearth.models.helping.policy_inputs import MOST_CLASSES, Pair, Scene, Words
from hearth.schemas.goals import Goal
from hearth.schemas.literals import AGENT
from hearth.schemas.program import ObjectRef, Step
from hearth.schemas.vocabulary import STATE_ID
from hearth.simulation.actions.legal import Legal
from hearth.simulation.motion import positions
from hearth.simulation.observation import containment, reach
from hearth.simulation.observation.views import View
from hearth.simulation.world import edge_rows
from hearth.simulation.world.bits import indices, lowest
from hearth.simulation.world.home import Home

TENS = 10.0
"""Metres in which distances are given."""


@dataclass(frozen=True, slots=True)
class Moment:
    """A scene with the nodes that it is about, by position."""

    scene: Scene
    nodes: tuple[int, ...]


def words_of(wanted: Wanted, home: Home) -> tuple[str, str]:
    """Return the class of things of a part of a goal, and the class of their target."""
    literal = wanted.literal
    if wanted.candidates.by_target:
        return str(literal.target), AGENT
    there = wanted.candidates.targets
    return str(literal.subject), home.classes[lowest(there)] if there else ""


class SceneReader:
    """The scenes of one agent in one episode.

    They record the rooms that it was in and the containers it has looked into.

    Attributes:
        pairs: the numbers of each part of the goal; of none whose words the policy does not know.
    """

    def __init__(self, words: Words, home: Home, me: int, aims: Aims) -> None:
        self.home, self.me = home, me
        found = {each.part: words.number(*words_of(each, home)) for each in aims.wanted}
        self.pairs = {part: pair for part, pair in found.items() if pair is not None}
        self.targets = {each.part: each.candidates.targets for each in aims.wanted}
        self.counted = {each.part: each.counted for each in aims.wanted}
        self.looked = 0
        self.fixed = containers(home)
        of_words = 0
        for name in words.things:
            of_words |= home.instances(name)
        self.shown = of_words | self.fixed | home.rooms | home.doors | home.characters
        for targets in self.targets.values():
            self.shown |= targets

    def note(self, view: View) -> None:
        """Record the agent's room and the open containers in view."""
        opened = view.world.states[STATE_ID["OPEN"]] & self.fixed & view.mask
        room = edge_rows.agent_room(view.world, view.world.agents[view.agent])
        self.looked |= opened | (1 << room if room >= 0 else 0)

    def subgoals(self, view: View, missing: Missing) -> Moment:
        """Return the policy's input for choosing a subgoal: all parts of the goal that are missing by belief."""
        counts = {part: number for part, (number, _) in missing.items() if part in self.pairs}
        return self._moment(view, counts)

    def actions(self, view: View, subgoal: Subgoal, legal: Legal) -> Moment:
        """Return the policy's input for choosing an action: a subgoal, and the possible actions."""
        moment = self._moment(view, {subgoal.part: 1})
        masks = self._masks(view, subgoal, legal)
        able = tuple(tuple(bool(mask >> i & 1) for i in moment.nodes) for mask in masks)
        near = reach.close_to(view.world, view.world.agents[view.agent])
        close = tuple(bool(near >> i & 1) for i in moment.nodes)
        return Moment(moment.scene._replace(legal=able, close=close), moment.nodes)

    def _moment(self, view: View, counts: dict[int, int]) -> Moment:
        world, home = view.world, view.world.home
        nodes = tuple(indices(self.shown & view.mask & ~(1 << self.me)))
        held = world.agents[view.agent].held
        others = 0
        for pose in view.others:
            others |= world.agents[pose.agent].held
        room = edge_rows.agent_room(world, world.agents[view.agent])
        here = containment.in_room(world, room) if room >= 0 else 0
        things = targets = 0
        for part in counts:
            things |= self.counted[part]
            targets |= self.targets[part]
        opened, closed = (world.states[STATE_ID[name]] for name in ("OPEN", "CLOSED"))
        sets = (opened & view.mask, closed & view.mask, held, others, here, self.looked, things, targets)
        me = view.me.place.point if view.me.place else (0.0, 0.0)
        features = []
        for i in nodes:
            there = positions.spot(world, i) or me
            dx, dz = (there[0] - me[0]) / TENS, (there[1] - me[1]) / TENS
            features.append((*(float(mask >> i & 1) for mask in sets), dx, dz, (dx * dx + dz * dz) ** 0.5))
        classes = tuple(_class_number(home.classes[i], home.knowledge) for i in nodes)
        wanted = tuple((*self.pairs[part], count) for part, count in counts.items())
        return Moment(Scene(classes, tuple(features), wanted), nodes)

    def _masks(self, view: View, subgoal: Subgoal, legal: Legal) -> list[int]:
        """Return the nodes with which each kind of action is possible.

        Only the subgoal's kind of thing is put, if held.
        """
        found = [0] * 5
        thing = self._put(view, subgoal)
        for name, masks in legal.masks.items():
            kind = _kinds(self.home.knowledge).get(name, -1)
            if kind == PUT:
                found[kind] |= masks[1] if thing >= 0 and masks[0] >> thing & 1 else 0
            elif kind >= 0:
                found[kind] |= masks[0]
        return found

    def _put(self, view: View, subgoal: Subgoal) -> int:
        """Return the thing that it would put down: one of the subgoal's kind, else any; -1 if it holds nothing."""
        held = view.world.agents[view.agent].held
        return lowest(held & self.counted.get(subgoal.part, 0) or held) if held else -1

    def step(self, view: View, subgoal: Subgoal, legal: Legal, moment: Moment, choice: Pair) -> Step | None:
        """Return the instruction that a choice stands for; None where it can't be done."""
        kind, position = choice
        if not moment.scene.legal[kind][position]:
            return None
        node, thing = moment.nodes[position], self._put(view, subgoal)
        for name in sorted(legal.masks):
            if _kinds(self.home.knowledge).get(name) != kind:
                continue
            nodes = (thing, node) if kind == PUT else (node,)
            if all(i >= 0 and mask >> i & 1 for mask, i in zip(legal.masks[name], nodes, strict=True)):
                refs = tuple(ObjectRef(self.home.classes[i], 0, self.home.ids[i]) for i in nodes)
                return Step(name, refs, view.agent)
        return None

    def choice(self, step: Step, moment: Moment) -> Pair | None:
        """Return another agent's instruction as a choice, the inverse; None where no choice stands for it."""
        kind = _kinds(self.home.knowledge).get(step.action)
        if kind is None or not step.objects:
            return None
        node = self.home.index[step.objects[-1].node or 0]
        if node not in moment.nodes:
            return None
        position = moment.nodes.index(node)
        return (kind, position) if moment.scene.legal[kind][position] else None


PUT = 4
"""The kind of action whose node is where something goes."""


@lru_cache(maxsize=8)
def _kinds(knowledge: Knowledge) -> dict[str, int]:
    """Return the kind of each action that a policy may choose (`models.helping.policy_inputs.KINDS`)."""
    found: dict[str, int] = {}
    for name in knowledge.group("played"):
        if name in knowledge.group("goes"):
            found[name] = 0
        elif knowledge.state_of(name) in ("OPEN", "CLOSED"):
            found[name] = 1 + (knowledge.state_of(name) == "CLOSED")
        elif name in knowledge.group("takes"):
            found[name] = 3
        elif name in knowledge.group("puts"):
            found[name] = PUT
    return found


@lru_cache(maxsize=4096)
def _class_number(name: str, knowledge: Knowledge) -> int:
    known = knowledge.object_class(name)
    return 1 if known is None else min(2 + known.id, MOST_CLASSES - 1)


def vocabulary(goals: Sequence[tuple[Goal, Home, int]]) -> Words:
    """Return the words of goals in homes, with the index of the agent that pursues each."""
    things: dict[str, None] = {}
    places: dict[str, None] = {}
    for goal, home, me in goals:
        for wanted in Aims(goal, home, me, gives=True).wanted:
            thing, place = words_of(wanted, home)
            things[thing], places[place] = None, None
    return Words(tuple(sorted(things)), tuple(sorted(places)))
