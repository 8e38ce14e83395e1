"""Greedy, beam and sampled decoding, level by level over all programs at once, masked by the engine (thesis 5.4.2).

By construction each program parses, and runs in the environment it is written for, whatever the scores.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from random import Random
from typing import Any

import numpy as np

from hearth.models.decoding.equal_scores import best_places
from hearth.models.decoding.next_step_options import NONE, NOTHING, Grammar, Options, Partial
from hearth.models.decoding.scorers import Asked, Part, Scorer, Scores
from hearth.schemas.failures import Failure
from hearth.schemas.program import ObjectRef, Step
from hearth.simulation.engine import act
from hearth.simulation.rules import DEFAULT, Rules
from hearth.simulation.world.bits import indices
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World


@dataclass(frozen=True)
class Search:
    """Settings of the search for programs.

    Attributes:
        beam: programs kept at a time.
        temperature: of sampling; 0 takes the best.
        constrained: whether only possible steps are chosen.
        least: steps at least, where something can be done; the empty program runs, too, and says nothing.
        longest: steps at most.
        free_moves: steps in a row at most that only go, look or prepare. Of 1,771 references three have more.
        repeats: times at most that a program has the same step. Of 1,771 references none has more.
    """

    beam: int = 1
    temperature: float = 0.0
    constrained: bool = True
    least: int = 1
    longest: int = 60
    free_moves: int = 12
    repeats: int = 6


@dataclass(frozen=True)
class Start:
    """The inputs for writing one program.

    Attributes:
        world: at the start.
        given: the model's own input: a sketch, a text.
        random: for sampling; its own for each program, so that no program depends on its neighbours.
        rules: of the engine.
    """

    world: World
    given: Any = None
    random: Random = field(default_factory=lambda: Random(0))
    rules: Rules = DEFAULT


@dataclass(frozen=True)
class _Draft:
    """A program being written: the row it is for, its score, and the part of the next step chosen so far."""

    row: int
    world: World
    state: Any
    options: Options | None
    score: float = 0.0
    steps: tuple[Step, ...] = ()
    chosen: Partial = NOTHING
    whole: Step | None = None
    free: int = 0
    ended: bool = False

    def asked(self) -> Asked:
        return Asked(self.state, self.chosen, self.world, self.options, self.steps)


Choice = tuple[float, _Draft]


def decode(scorer: Scorer, starts: Sequence[Start], search: Search = Search()) -> list[tuple[Step, ...]]:
    """Write a program for each start.

    Args:
        scorer: the model.
        starts: the world and the model's input of each program.
        search: how.

    Returns:
        The programs, bound to nodes. Constrained ones parse and run.
    """
    return _Decoder(scorer, starts, search).programs()


class _Decoder:
    def __init__(self, scorer: Scorer, starts: Sequence[Start], search: Search) -> None:
        self.scorer, self.starts, self.search = scorer, starts, search
        self.grammars: dict[tuple[int, Rules], tuple[Home, Grammar]] = {}
        self.free: frozenset[str] = frozenset()
        if starts:
            known = starts[0].world.home.knowledge
            self.free = known.group("goes") | known.group("looks") | known.group("idle") | known.group("preparation")
            self.arity = known.arity

    def programs(self) -> list[tuple[Step, ...]]:
        states = self.scorer.begin([each.world for each in self.starts], [each.given for each in self.starts])
        beams = [
            [_Draft(row, start.world, state, self._options(start.world, start.rules))]
            for row, (start, state) in enumerate(zip(self.starts, states, strict=True))
        ]
        while any(not draft.ended for beam in beams for draft in beam):
            for part in self.scorer.order:
                beams = self._level(beams, part)
            beams = self._done(beams)
        return [numbered(beam[best_places(np.array([*map(_mean, beam)]), 1)[0]].steps) for beam in beams]

    def _options(self, world: World, rules: Rules) -> Options | None:
        if not self.search.constrained:
            return None
        home = world.home
        key = id(home), rules
        if key not in self.grammars:
            self.grammars[key] = home, Grammar(home, rules)
        return self.grammars[key][1].options(world)

    # Choosing the parts of the next step

    def _level(self, beams: list[list[_Draft]], part: Part) -> list[list[_Draft]]:
        """Return all programs after the choice of one part."""
        open_ = [draft for beam in beams for draft in beam if self._needs(draft, part)]
        if not open_:
            return beams
        scores = self.scorer.score([draft.asked() for draft in open_], part)
        found = {id(draft): self._choices(draft, part, each) for draft, each in zip(open_, scores, strict=True)}
        return [self._kept(beam, found) for beam in beams]

    def _needs(self, draft: _Draft, part: Part) -> bool:
        if draft.ended:
            return False
        action = draft.chosen.action
        if part is Part.FIRST and action is not None:
            return self.arity.get(action, 0) > 0
        if part is Part.SECOND:
            return action is not None and self.arity.get(action, 0) > 1 and draft.chosen.first != NONE
        return True

    def _kept(self, beam: list[_Draft], found: dict[int, list[Choice]]) -> list[_Draft]:
        """Return the best drafts of a beam, or random ones; those that this part is not for stay as they are."""
        choices = [c for draft in beam for c in found.get(id(draft), [(draft.score, draft)])]
        if len(choices) > self.search.beam:
            scores = np.array([score for score, _ in choices])
            choices = [choices[place] for place in best_places(scores, self.search.beam)]
        return [draft for _, draft in choices]

    def _choices(self, draft: _Draft, part: Part, scores: Scores) -> list[Choice]:
        """Return the possible continuations of a draft: the best choices, as many as the beam has, or a random one."""
        allowed = self._allowed(draft, part, scores)
        values = scores.values[allowed]
        if not np.isfinite(values).any():
            return [(draft.score, replace(draft, ended=True, chosen=NOTHING))]
        best = self._drawn(values, draft.row) if self.search.temperature else best_places(values, self.search.beam)
        made = []
        for place in best:
            if np.isfinite(values[place]):
                score = draft.score + float(values[place])
                made.append((score, replace(self._with(draft, part, int(allowed[place]), scores), score=score)))
        return made

    def _drawn(self, values: np.ndarray, row: int) -> Iterable[int]:
        scaled = values / self.search.temperature
        weights = np.exp(scaled - scaled.max())
        total = np.cumsum(weights)
        return [min(int(np.searchsorted(total, self.starts[row].random.random() * total[-1])), len(values) - 1)]

    def _allowed(self, draft: _Draft, part: Part, scores: Scores) -> np.ndarray:
        """Return the places in `scores.values` that may be chosen."""
        count = len(scores.values)
        if draft.options is None:
            return np.arange(count)
        options, chosen, nodes = draft.options, draft.chosen, len(draft.world.home)
        first = part is self.scorer.order[0]
        if part is Part.STEP:
            places = [place for place, step in enumerate(scores.steps) if _allows(options, step, draft.world.home)]
        elif part is Part.ACTION:
            names = set(options.actions(chosen))
            places = [place for place, name in enumerate(self.scorer.actions) if name in names]
        elif part is Part.FIRST:
            mask = options.firsts if first else options.masks[chosen.action or ""][0]
            places = list(indices(mask))
            if first and not all(options.masks.values()):
                places.append(nodes)
        else:
            places = list(indices(options.second(chosen)))
        if first and (len(draft.steps) >= self.search.least or not places):
            places.append(count - 1)
        return np.array(places, dtype=np.int64)

    def _with(self, draft: _Draft, part: Part, place: int, scores: Scores) -> _Draft:
        """Return the draft with one more part."""
        if part is self.scorer.order[0] and place == len(scores.values) - 1:
            return replace(draft, ended=True, chosen=NOTHING)
        if part is Part.STEP:
            return replace(draft, whole=scores.steps[place])
        if part is Part.ACTION:
            return replace(draft, chosen=draft.chosen._replace(action=self.scorer.actions[place]))
        node = NONE if place >= len(draft.world.home) else place
        chosen = draft.chosen._replace(first=node) if part is Part.FIRST else draft.chosen._replace(second=node)
        return replace(draft, chosen=chosen)

    # Doing the step

    def _done(self, beams: list[list[_Draft]]) -> list[list[_Draft]]:
        """Return all programs after the chosen step."""
        flat = [draft if draft.ended else self._after(draft) for beam in beams for draft in beam]
        going = [draft for draft in flat if draft.steps and not draft.ended]
        states = self.scorer.advance([draft.asked() for draft in going], [draft.steps[-1] for draft in going])
        advanced = {id(draft): replace(draft, state=s) for draft, s in zip(going, states, strict=True)}
        drafts = iter([self._braked(advanced.get(id(draft), draft)) for draft in flat])
        return [[next(drafts) for _ in beam] for beam in beams]

    def _after(self, draft: _Draft) -> _Draft:
        step = draft.whole or _step(draft.chosen, draft.world.home)
        world = draft.world
        if draft.options is not None:
            after = act(world, step, self.starts[draft.row].rules)
            assert not isinstance(after, Failure), after.message()  # the mask is exact, as the engine is
            world = after
        free = draft.free + 1 if step.action in self.free else 0
        return replace(draft, world=world, steps=(*draft.steps, step), chosen=NOTHING, whole=None, free=free)

    def _braked(self, draft: _Draft) -> _Draft:
        """Return the draft with its allowed next choices, or ended."""
        if draft.ended or len(draft.steps) >= self.search.longest:
            return replace(draft, ended=True)
        options = self._options(draft.world, self.starts[draft.row].rules)
        if options is not None:
            barred = self.free if draft.free >= self.search.free_moves else frozenset()
            repeated = self._repeated(draft) if len(draft.steps) >= self.search.repeats else ()
            if barred or repeated:
                options = options.without(barred, repeated)
        return replace(draft, options=options)

    def _repeated(self, draft: _Draft) -> list[tuple[str, int]]:
        counts: dict[Step, int] = {}
        for step in draft.steps:
            counts[step] = counts.get(step, 0) + 1
        index = draft.world.home.index
        often = (step for step, count in counts.items() if count >= self.search.repeats)
        return [(s.action, index[s.objects[0].node or 0] if s.objects else NONE) for s in often]


def _allows(options: Options, step: Step, home: Home) -> bool:
    nodes = [home.index.get(NONE if ref.node is None else ref.node) for ref in step.objects]
    return None not in nodes and options.allows(step.action, [node for node in nodes if node is not None])


def _mean(draft: _Draft) -> float:
    """Return a draft's score by step: a sum would prefer short programs."""
    return draft.score / (len(draft.steps) + 1)


def _step(chosen: Partial, home: Home) -> Step:
    nodes = [node for node in (chosen.first, chosen.second) if node is not None and node != NONE]
    return Step(chosen.action or "", tuple(ObjectRef(home.classes[node], 1, home.ids[node]) for node in nodes))


def numbered(steps: Sequence[Step]) -> tuple[Step, ...]:
    """Return steps bound to nodes, with instances: the nodes of a class are numbered as they are mentioned."""
    instances: dict[str, dict[int | None, int]] = {}

    def named(ref: ObjectRef) -> ObjectRef:
        known = instances.setdefault(ref.name, {})
        return replace(ref, instance=known.setdefault(ref.node, len(known) + 1))

    return tuple(replace(step, objects=tuple(map(named, step.objects))) for step in steps)
