"""Inferring sketches: the steps from which the repairer can make the rest, in several environments (thesis 5.5.1)."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from hearth.grounding.environments.sampling import Size, sample
from hearth.grounding.preconditions.conditions import Preconditions
from hearth.grounding.preconditions.postconditions import Postconditions, achieved, nodes_of
from hearth.grounding.preconditions.precondition_inference import infer
from hearth.kb.knowledge import Knowledge
from hearth.repair.activity_steps import asked, meant, milestones, replaceable
from hearth.repair.handlers.common import Handler
from hearth.repair.handlers.registry import HANDLERS
from hearth.repair.repair_loop import repair
from hearth.schemas.failures import Code, Failure
from hearth.schemas.literals import Key
from hearth.schemas.program import Program
from hearth.simulation.engine import Execution
from hearth.simulation.literal_truth import holds
from hearth.simulation.rules import Rules, rules_of, suited
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

ENVIRONMENTS = 2
"""In how many homes a sketch has to be enough; a third changed none of 179 sketches."""

_BARE = Size(0, 0, 0)
"""Random things that the program does not name make no difference to a sketch."""


class _Place(NamedTuple):
    """A program bound in an environment in which it runs, and the rules by which it does."""

    program: Program
    world: World
    rules: Rules


_EXPANDING: Mapping[Code, Handler] = {code: one for code, one in HANDLERS.items() if code is not Code.GOAL_LOST}
"""All handlers but the one that appends what the goal lacks, which would make any step needless."""

Keep = tuple[bool, ...]
"""For each step of a program, whether its sketch keeps it."""


def sketch(
    program: Program,
    homes: Sequence[Home],
    knowledge: Knowledge,
    seed: int = 0,
    record_id: str = "",
    original: tuple[Preconditions, Execution] | None = None,
) -> Keep:
    """Return the smallest part of a program from which repairing reaches the effects meant, with the steps its text
    names.

    Steps are left out one by one, from the first; one stays out if in every environment the rest can still be
    repaired so that it reaches the effects meant. Actions that no repair inserts stay. What is left out comes back
    where the description asks for it and no kept step after it is about the same thing.

    Args:
        program: with instances as counters.
        homes: the first of them are tried, each in an environment sampled for the program.
        knowledge: that of homes and program.
        seed, record_id: all the randomness there is.
        original: what the program needs, and how it runs in an environment of its own, which then is the first tried.

    Examples:
        >>> hearth.sketch(program, [home], known)
        (False, False, True)
    """
    program = program.numbered()
    rules = suited(program, knowledge, rules_of(knowledge))
    conditions = infer(program, knowledge, rules) if original is None else original[0]
    if isinstance(conditions, Failure):
        return _with_asked(program, _smallest(program, [], (), (), knowledge), asked(program, knowledge))
    runs = [] if original is None else [original]
    for home in homes[: ENVIRONMENTS - len(runs)]:
        drawn = sample(program, home, seed, f"{record_id}/sketch", conditions, _BARE, rules)
        if not isinstance(drawn, Failure):
            runs.append((drawn[0].conditions, drawn[1]))
    goal: Postconditions = ()
    passed: Postconditions = ()
    if runs:
        goal = meant(achieved(runs[0][1]), program, runs[0][0], knowledge)
        passed = tuple(fact for fact in milestones(runs[0][1]) if fact not in goal)
    # The rules are those of the runs: what is left of a program may look as if others suited it.
    places = [_Place(execution.program, execution.worlds[0], rules) for _, execution in runs]
    keep = _smallest(program, places, goal, passed, knowledge)
    return _with_asked(program, keep, asked(program, knowledge))


def inherited(keep: Sequence[bool], sources: Sequence[int]) -> Keep:
    """Return the sketch of a program made from another: the same steps, wherever they now stand.

    Args:
        keep: the parent's sketch.
        sources: for each step of the child, which of the parent's it is; below 0 for a new one.
    """
    return tuple(source >= 0 and keep[source] for source in sources)


def _smallest(
    program: Program, places: Sequence[_Place], goal: Postconditions, passed: Postconditions, knowledge: Knowledge
) -> Keep:
    """Tried in the first environment alone; in all of them if its result does not suffice in the others."""
    keep = [True] * len(program.steps)
    for tried in (places[:1], places):
        keep = [True] * len(program.steps)
        for number, step in enumerate(program.steps):
            if step.action in replaceable(knowledge):
                keep[number] = False
                keep[number] = not _suffices(keep, tried, goal, passed, knowledge)
        if _suffices(keep, places[len(tried) :], goal, passed, knowledge):
            break
    return tuple(keep)


def _suffices(
    keep: Sequence[bool], places: Sequence[_Place], goal: Postconditions, passed: Postconditions, knowledge: Knowledge
) -> bool:
    for program, world, rules in places:
        rest = program.with_steps(step for step, kept in zip(program.steps, keep, strict=True) if kept)
        done = repair(rest, world, goal, knowledge, rules, handlers=_EXPANDING, canonical_only=False)
        if done.failure is not None or not _passes(nodes_of(program, world), done.execution, passed):
            return False
    return True


def _passes(nodes: Mapping[Key, int], execution: Execution, passed: Postconditions) -> bool:
    """Return whether each of some effects is there at some time."""
    return all(any(holds(fact, world, nodes) for world in execution.worlds) for fact in passed)


def _with_asked(program: Program, keep: Keep, wanted: Sequence[bool]) -> Keep:
    found = list(keep)
    for number in range(len(program.steps) - 1, -1, -1):
        if wanted[number] and not keep[number]:
            first = program.steps[number].objects[:1]
            later = (s for n, s in enumerate(program.steps) if n > number and found[n])
            found[number] = not any(ref in step.objects for step in later for ref in first)
    return tuple(found)
