"""Running a program in a home: bound to the home's own objects if it can run, else in an environment sampled for it."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import islice

from hearth.grounding.binding import Binding, bind, bind_far
from hearth.grounding.environments.default_state import need_somebody, prepared
from hearth.grounding.environments.sampling import USUAL, Environment, Size, sample
from hearth.grounding.environments.sampling_for_several_characters import sample_together
from hearth.grounding.preconditions.conditions import Preconditions
from hearth.grounding.preconditions.precondition_inference import infer
from hearth.grounding.preconditions.source_places import source_conditions
from hearth.schemas.failures import Code, Failure
from hearth.schemas.program import Program
from hearth.schemas.vocabulary import CHARACTER_CLASS
from hearth.simulation.engine import Execution, run
from hearth.simulation.env import with_agents
from hearth.simulation.rules import DEFAULT, Rules, suited
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World


@dataclass(frozen=True, slots=True)
class Trial:
    """A program's execution, and how it was grounded.

    Attributes:
        execution: what happened, as far as it went.
        environment: what was sampled, when the home alone would not do.
        refused: why the home alone would not do, when an environment was sampled.
    """

    execution: Execution
    environment: Environment | None = None
    refused: Failure | None = None


LEAST = Size(0, 0, 0, sparing=True)
"""Of an environment to which nothing is added but what the program needs and the home has nowhere."""


def as_given(program: Program, home: Home, seed: int = 0, rules: Rules = DEFAULT) -> Trial:
    """Run a program in a home as it is, as far as its steps can be done with any of the home's objects.

    Args:
        program: instances that carry node ids keep them.
        home: nothing is added to it but characters that it lacks, which stand in random rooms.
        seed: of those rooms.
        rules: how actions are read.

    Raises:
        HearthError: BAD_GRAPH: nobody is in the home.
    """
    need_somebody(home)
    rules = suited(program, home.knowledge, rules)
    world = with_agents(World.start(home), _characters(program), seed)
    program, failure = bound_far(program, world, rules)
    execution = run(world, program, rules)
    if failure is not None and failure.tick == len(execution.worlds) - 1:
        execution = replace(execution, failure=failure)
    return Trial(execution)


def as_given_or_sampled(
    program: Program, home: Home, seed: int, sampling: bool, rules: Rules, sources: Sequence[tuple[int, str]] = ()
) -> tuple[Trial, Trial | Failure | None]:
    """Run a program in a home as it is; if that stops and `sampling` is True, also in a home made for it.

    Args:
        program, home, seed, rules: see `attempt`.
        sampling: whether a home may be made.
        sources: steps whose author says from where a thing is taken, each with that place (`Given.sources`). In the
            home that is made the things are there, if the program can run so.

    Returns:
        The run in the home as it is. The run in the home made for it: None if there was no need for one, a failure if
        none could be made.
    """
    trial = as_given(program, home, seed, rules)
    if trial.execution.failure is None or not sampling:
        return trial, None
    unbound = program.unbound()
    return trial, _from_places(unbound, home, seed, rules, sources) or attempt(unbound, home, seed, rules, size=LEAST)


def _from_places(
    program: Program, home: Home, seed: int, rules: Rules, sources: Sequence[tuple[int, str]]
) -> Trial | None:
    """Return the run in a home in which things are where their author says; None if there is no such run."""
    wanted = source_conditions(program, sources, home.knowledge)
    suitable = suited(program, home.knowledge, rules)
    needs = infer(program, home.knowledge, suitable) if wanted and _characters(program) == 1 else None
    if not isinstance(needs, Preconditions):
        return None
    found = sample(program, home, seed, program.title, needs.plus(*wanted), LEAST, rules)
    return None if isinstance(found, Failure) else Trial(found[1], found[0])


def bound_far(program: Program, world: World, rules: Rules) -> tuple[Program, Failure | None]:
    """Return a program bound to nodes of a world as far as it runs, and why it goes no further.

    No object fits that a later step misuses; then the steps before that one are bound without it, so that it fails.
    """
    found, failure = bind_far(program, world, rules)
    while failure is not None and failure.code is Code.UNBOUND:
        before = [step for steps in islice(program.ticks(), failure.tick + 1) for step in steps]
        part, stopped = bind_far(program.with_steps(before), world, rules)
        if stopped is not None:
            break
        program = part.apply(program)
        found, failure = bind_far(program, world, rules)
    return found.apply(program), failure


def attempt(
    program: Program,
    home: Home,
    seed: int = 0,
    rules: Rules = DEFAULT,
    default_state: bool = True,
    add: bool = True,
    size: Size = USUAL,
) -> Trial | Failure:
    """Ground and run a program.

    Args:
        program: instances that carry node ids keep them.
        home: where.
        seed: of the sampling.
        rules: how actions are read.
        default_state: begin with the home in its default state; else as it is given.
        add: sample an environment when the home alone has no binding that runs.
        size: of the environment that is sampled for one character; `LEAST` adds only the program's needs.

    Returns:
        The trial, or why the program can be grounded neither way. Where the program has or names more characters than
        the home, the others stand in random rooms.
    """
    wanted = _characters(program)
    rules = suited(program, home.knowledge, rules)
    world = with_agents(World.start(prepared(home).home if default_state else home), wanted, seed)
    found = bind(program, world, rules)
    if isinstance(found, Binding):
        return Trial(run(world, found.apply(program), rules))
    named = [ref.node is not None for ref in program.objects()]
    if named and all(named):
        return Trial(run(world, program, rules))
    if any(named) or not add:
        return found  # where some objects have no node, a run would end at the first of them, whatever is amiss
    sampled = (
        sample(program, home, seed, program.title, size=size, rules=rules)
        if wanted == 1
        else sample_together(program, home, wanted, seed, rules)
    )
    if isinstance(sampled, Failure):
        # Environments are sampled without places: the home says what is in the way of a move by metres.
        return found if sampled.code is Code.NOT_SIMULATED and not _is_unknown_to_rules(sampled, home) else sampled
    environment, execution = sampled
    return Trial(execution, environment, found)


def _is_unknown_to_rules(failure: Failure, home: Home) -> bool:
    """Return whether an action is never executed, wherever the character is."""
    action = home.knowledge.actions.get(failure.action)
    return action is not None and not action.executed


def _characters(program: Program) -> int:
    """Return the participants: the acting characters, and the one that the first of them meets."""
    acting = max((step.agent for step in program.steps), default=0)
    return 1 + max(acting, sum(ref.name == CHARACTER_CLASS for ref in program.objects()))
