"""The Watch stage: goals inferred from the demonstrations of tasks (thesis 6.5.3)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial

from hearth.agents.demonstration_goals import READERS, Question, by_states
from hearth.challenges.challenge_definition import challenge
from hearth.challenges.demonstration_episodes import Wish, demonstrate
from hearth.challenges.episodes import Known
from hearth.challenges.tasks import Task
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.goals import Goal
from hearth.schemas.literals import Literal, Name
from hearth.schemas.rng import rng
from hearth.simulation.world.home import Home
from hearth.storage.parallel import Seen, spread, unseen


@dataclass(frozen=True)
class Watched:
    """A demonstration of which the goal is to be inferred.

    Attributes:
        wish: the demonstration.
        reader: how it is read, one of `READERS`.
        model: the checkpoint that reads states, if not the one that comes with Hearth.
    """

    wish: Wish
    reader: str
    model: str | None = None


def inferred(
    tasks: Sequence[Task],
    reader: str,
    known: Known,
    rate: float = 1.0,
    workers: int = 1,
    seen: Seen = unseen,
    model: str | None = None,
) -> Iterator[Goal]:
    """Yield the inferred goals of tasks, in their order.

    Args:
        tasks: whose demonstrations are watched.
        reader: how, one of `READERS`.
        known: gives the knowledge.
        rate: of habits (see `demonstration_episodes.Wish`).
        workers: processes.
        seen: called with the number done.
        model: the checkpoint that reads states, if not the one that comes with Hearth.

    Raises:
        HearthError: BAD_ARGUMENT: there is no such reader, or it has no checkpoint.
    """
    if reader not in READERS:
        raise HearthError.of(
            Code.BAD_ARGUMENT, f"there is no way to read `{reader[:40]}`", suggestion=", ".join(READERS)
        )
    if model is not None and reader != "states":
        raise HearthError.of(Code.BAD_ARGUMENT, "only states are read by a model", suggestion="--from states")
    return spread(infer, [Watched(Wish(task, rate, known), reader, model) for task in tasks], workers, seen)


def infer(watched: Watched) -> Goal:
    """Return the goal that is inferred from a demonstration, in the words of the grammar."""
    task = watched.wish.task
    grammar = challenge(task.challenge).grammar
    ticks = demonstrate(watched.wish).ticks(watched.wish.known())
    places = bound(task, ticks[0].before.home) if ticks else {}
    question = Question(tuple(places), tuple(grammar.goals))
    reader = READERS[watched.reader] if watched.model is None else partial(by_states, model=watched.model)
    found = reader(ticks, question, rng(task.seed, "watch", watched.reader))
    counted = {places.get(literal, literal): number for literal, number in found}
    return Goal(tuple((each, counted[each]) for each in grammar.predicates if each in counted))


def bound(task: Task, home: Home) -> dict[Literal[Name], Literal[Name]]:
    """Return the predicates of the grammar, by those that name the home's furniture."""
    grammar = challenge(task.challenge).grammar
    every = Goal(tuple((each, 1) for each in grammar.predicates))
    return {here: each for (here, _), (each, _) in zip(grammar.in_home(every, home), every, strict=True)}
