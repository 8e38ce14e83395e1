"""Augmenting a program in a home: perturb its preconditions, sample, run, repair (thesis 5.5.4, A.2, algorithm 4)."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from hearth.grounding.environments.default_state import Base, prepared
from hearth.grounding.environments.sampling import Environment, Size, draw, sample
from hearth.grounding.preconditions.condition_checks import unmet, unmet_failure
from hearth.grounding.preconditions.conditions import Condition, Preconditions
from hearth.grounding.preconditions.postconditions import Postconditions, achieved
from hearth.repair.perturbation import Case, Perturbation, Perturbed, distinct
from hearth.repair.perturbation_strengths import MILD, Strength, strength
from hearth.repair.repair_loop import TRIES, Attempt, repair
from hearth.repair.step_context import circumstances
from hearth.schemas.failures import Code, Failure
from hearth.schemas.program import Program
from hearth.schemas.rng import rng
from hearth.schemas.short_repr import brief
from hearth.simulation.engine import Execution
from hearth.simulation.rules import DEFAULT, Rules, suited
from hearth.simulation.world.home import Home

DRAWS = 3
"""Environments drawn for one perturbation before it is given up."""


@dataclass(frozen=True, slots=True)
class Options:
    """Settings of augmentation.

    Attributes:
        count: perturbed environments at most; there are fewer when no more distinct ones are found. One in which
            repairing is given up is replaced by another, up to twice this number in all.
        tries: repairs of one program in one environment.
        strength: how much is perturbed and cleared away: one of perturbations.yaml, or its name.
        rules: for the runs.
    """

    count: int = 5
    tries: int = TRIES
    strength: Strength | str = MILD
    rules: Rules = DEFAULT

    @property
    def power(self) -> Strength:
        """The strength itself."""
        return strength(self.strength) if isinstance(self.strength, str) else self.strength


@dataclass(frozen=True, slots=True)
class Pair:
    """A program in a perturbed environment, and its repair.

    Attributes:
        number: which of its program's pairs, from 0.
        perturbations: those of its preconditions.
        environment: the perturbed environment, with the original program bound in it.
        program: the repaired program, bound.
        sources: for each of its steps, the number of the original's step it is; below 0 for one that a repair inserted.
        execution: its run.
        attempts: every repair, in order; also of pairs that were given up.
        failure: why there is no new program; None where there is one.
    """

    number: int
    perturbations: tuple[Perturbation, ...]
    environment: Environment
    program: Program
    sources: tuple[int, ...]
    execution: Execution
    attempts: tuple[Attempt, ...]
    failure: Failure | None = None

    __repr__ = brief


@dataclass(frozen=True, slots=True)
class Augmented:
    """Everything that came of one program in one home.

    Attributes:
        execution: the original's own.
        goal: what it achieves there.
        pairs: the perturbed environments, in the order in which they were drawn.
    """

    execution: Execution
    goal: Postconditions
    pairs: tuple[Pair, ...]

    __repr__ = brief


def augment(
    program: Program,
    home: Home,
    seed: int,
    record_id: str = "",
    options: Options = Options(),
    original: tuple[Preconditions, Execution] | None = None,
) -> Augmented | Failure:
    """Repaired versions of a program for environments that violate some of its preconditions (thesis 5.5.4, A.2).

    Args:
        program: with instances as counters.
        home: any home.
        seed, record_id: all the randomness there is.
        options: how many environments, and how they are perturbed and programs repaired.
        original: what it needs, and its execution in its own environment; sampled when None.

    Returns:
        Every pair, successful or not. A pair that needed no repair fails as UNPERTURBED, one whose program came up
        before as DUPLICATE. A failure when the original itself can't be sampled.

    Examples:
        >>> first = hearth.augment(program, home, seed=0).pairs[0]
        >>> print(first.perturbations[0])
        container: inside(milk (1), fridge (1)) -> in_closed_container(milk (1), fridge (1))
        >>> [attempt.handler for attempt in first.attempts], first.failure
        (['not_close', 'inside_closed'], None)
    """
    program, base = program.numbered(), prepared(home)
    options = replace(options, rules=suited(program, base.knowledge, options.rules))
    if original is None:
        sampled = sample(program, home, seed, record_id, rules=options.rules)
        if isinstance(sampled, Failure):
            return sampled
        original = sampled[0].conditions, sampled[1]
    conditions, execution = original
    goal = achieved(execution)
    wanted = circumstances(execution, conditions)
    generator = rng(seed, "perturb", base.home.name, record_id)
    seen: set[object] = {_shape(program)}
    pairs: list[Pair] = []
    wished = options.count
    chances = options.power.chances
    for number, perturbed in enumerate(distinct(Case(program, conditions, base), chances, generator, 2 * wished)):
        if number == wished:
            break
        drawn = _drawn(program, base, perturbed, seed, f"{record_id}/{number}", options.rules)
        pairs.append(_judged(_pair(number, perturbed, drawn, (goal, wanted), options), seen))
        wished += _is_refused(pairs[-1])
    return Augmented(execution, goal, tuple(pairs))


def _is_refused(pair: Pair) -> bool:
    """Return whether repairing was given up: another environment is drawn instead, as long as there are any."""
    return bool(pair.attempts) and pair.failure is not None and pair.failure.code is not Code.DUPLICATE


def _drawn(
    program: Program, base: Base, perturbed: Perturbed, seed: int, record_id: str, rules: Rules
) -> Environment | tuple[Environment, Condition]:
    """Return an environment in which the perturbed conditions hold, or the last one drawn and the conditions that fail
    there.
    """
    for attempt in range(DRAWS):
        environment = draw(program, base, perturbed.conditions, seed, record_id, attempt, Size(), rules)
        nodes = {ref.key: ref.node for ref in environment.program.objects() if ref.node is not None}
        missing = unmet(perturbed.conditions, environment.world, nodes)
        if not missing:
            return environment
    return environment, missing[0]


def _pair(
    number: int,
    perturbed: Perturbed,
    drawn: Environment | tuple[Environment, Condition],
    aim: tuple[Postconditions, Sequence[Postconditions]],
    options: Options,
) -> Pair:
    """Return a perturbed environment's program, repaired to reach a goal, its steps in their circumstances."""
    if isinstance(drawn, tuple):
        environment, condition = drawn
        failure = unmet_failure(condition, environment.program.unbound(), DRAWS)
        program = environment.program
        execution = Execution(program, (environment.world,), failure, options.rules)
        sources = tuple(range(len(program.steps)))
        return Pair(number, perturbed.perturbations, environment, program, sources, execution, (), failure)
    goal, wanted = aim
    known = drawn.base.knowledge
    handlers = options.power.handlers
    done = repair(drawn.program, drawn.world, goal, known, options.rules, handlers, options.tries, wanted=wanted)
    return Pair(
        number, perturbed.perturbations, drawn, done.program, done.sources, done.execution, done.attempts, done.failure
    )


def _judged(pair: Pair, seen: set[object]) -> Pair:
    """Return the pair, refused when its program is the original's or one that came up before."""
    if pair.failure is not None:
        return pair
    shape = _shape(pair.program)
    if shape not in seen:
        seen.add(shape)
        return pair
    code, why = (Code.DUPLICATE, "an earlier pair has the same steps")
    if not pair.attempts:
        code, why = Code.UNPERTURBED, "the original runs here as it is"
    failure = Failure(code, expected="a program of its own", actual=why)
    return replace(pair, failure=failure)


def _shape(program: Program) -> object:
    """Return the key by which two programs of one parent are the same: their steps, whatever they are bound to."""
    return tuple((s.action, tuple(ref.key for ref in s.objects), s.agent, s.joins) for s in program.steps)
