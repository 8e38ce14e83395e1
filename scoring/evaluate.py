"""All scores of all predictions, and their summary: means, intervals, errors, groups by a field."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, NamedTuple

from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code
from hearth.schemas.goals import Goal
from hearth.schemas.program import Program, Step
from hearth.schemas.short_repr import brief
from hearth.scoring.bootstrap import Interval, intervals
from hearth.scoring.environments import Environments
from hearth.scoring.line_sequences import Lines
from hearth.scoring.metrics import executability as running
from hearth.scoring.metrics.executability import ErrorClass, Executability, executability
from hearth.scoring.metrics.goal_progress import Achieved, GoalScore, of_given, signatures_of
from hearth.scoring.metrics.goals import goal_of
from hearth.scoring.metrics.graph_f1 import (
    FAILED,
    MATCH,
    SCOPE,
    GraphScore,
    MatchBy,
    Scope,
    f1_signature,
    named,
    written_f1_signature,
)
from hearth.scoring.metrics.graph_f1 import score as graph_score
from hearth.scoring.metrics.lcs import LEVELS, LcsScore, lcs_signature, score_pairs
from hearth.scoring.metrics.parsability import SIGNATURE as PARSABLE
from hearth.scoring.metrics.parsability import parsability
from hearth.scoring.metrics.safety import Safety, safety
from hearth.scoring.prediction_scores import METRICS, Scored
from hearth.scoring.predictions import Pair
from hearth.scoring.refused_rows import FirstFaults
from hearth.simulation.engine import run
from hearth.simulation.goal_text import read_goal
from hearth.simulation.rules import DEFAULT, Rules, suited
from hearth.simulation.world.world import World

GOALS = ("goal", "tl_goal", "vh_goal")
"""Columns of rows that have a goal of their own; where a dataset is the reference, its goals are."""

NO_LCS = LcsScore(0.0, 0.0, 0.0)

BothLcs = tuple[LcsScore, LcsScore]
"""Similarity by class, or as the options say, and by instance; 0 without a reference."""


def given_goal(pair: Pair) -> Any:
    """Return the goal in a prediction's row, unread; None if it has none."""
    return next((found for name in GOALS if (found := pair.more.get(name)) is not None), None)


def _own_goal(pair: Pair, world: World) -> Goal | None:
    """Return the goal of a prediction's row; None if it has none.

    Raises:
        HearthError: the faults of a goal that can't be read.
    """
    given = given_goal(pair)
    return None if given is None else read_goal(given, world.home, f"goal of `{pair.id}`, row {pair.line}")


def _goal_score(
    pair: Pair, ran: Executability | None, world: World, rules: Rules, reference: Reference | None
) -> GoalScore | None:
    """Return the score of the goal that a prediction is asked to reach; one that fails reaches nothing."""
    final = ran.final if ran and ran.afforded else None
    goal = _own_goal(pair, world)
    if goal is None:
        return reference.achieved.score(final) if reference and reference.achieved else None
    return of_given(goal, world, run(world, ran.program, rules) if ran and final else None)


def _read_goal_score(
    pair: Pair, ran: Executability | None, world: World, rules: Rules, reference: Reference | None
) -> tuple[GoalScore | None, tuple[Diagnostic, ...]]:
    """Return the score of the goal, or the faults of a goal that can't be read."""
    try:
        return _goal_score(pair, ran, world, rules, reference), ()
    except HearthError as error:
        return None, tuple(error.diagnostics)


@dataclass(frozen=True, slots=True)
class Options:
    """Settings for scoring predictions.

    Attributes:
        rules: of simulation.
        match: assignment of instances in final graphs.
        scope: the program whose objects are compared in final graphs.
        instances: whether LCS distinguishes instances at all levels; `Scored.by_instance` always does.
        seed: of the intervals.
        safety: signature of the scores of safety, by which they are asked for; "" without them.
    """

    rules: Rules = DEFAULT
    match: MatchBy = MATCH
    scope: Scope = SCOPE
    instances: bool = False
    seed: int = 0
    safety: str = ""


@dataclass(frozen=True, slots=True)
class Summary:
    """The summary of many scores.

    Attributes:
        count: number of predictions, including missing ones.
        missing: number of missing predictions, which score 0.
        empty: number of predictions without lines, which neither parse nor run; `executable_filled` excludes them.
        unreferenced: number of predictions without a reference, which have no LCS and no F1.
        unread_goals: number of goals that can't be read; `goal` excludes them.
        reached_before: number of goals of which all holds at the start; `goal` excludes them.
        incomparable: number of references that do not run; excluded from F1, and from goals that are theirs.
        inexact: number of predictions whose F1 is a lower bound.
        means: each score's mean and interval.
        errors: first failures by class.
        codes: first failures by code.
        failed_at: number of first failures at each line, from 1.
    """

    count: int
    missing: int
    empty: int
    unreferenced: int
    fuzzy: int
    unread_goals: int
    reached_before: int
    incomparable: int
    inexact: int
    means: Mapping[str, Interval]
    errors: Mapping[ErrorClass, int]
    codes: Mapping[Code, int]
    failed_at: Mapping[int, int]

    __repr__ = brief


def signatures(options: Options, own: int = 0) -> dict[str, str]:
    """Return the signature of each family of scores, where `own` predictions had a goal of their own."""
    return {
        **{f"lcs_{level}": lcs_signature(level, options.instances) for level in LEVELS},
        **{f"lcs_{level}_instances": lcs_signature(level, True) for level in ("step", "object")},
        "parsable": PARSABLE,
        "executable": running.SIGNATURE,
        "f1": written_f1_signature(options.match, options.scope),
        "f1_published": f1_signature(options.match, options.scope),
        **signatures_of(own),
        **({"safety": options.safety} if options.safety else {}),
    }


def lcs_of(pairs: Sequence[Pair], instances: bool = False) -> list[BothLcs]:
    """Return the similarity of each prediction to its reference, and that by instance.

    0 if one of the two is missing.
    """
    lines = [(pair.predicted or (), pair.reference) for pair in pairs]
    distinct = score_pairs(lines, instances=True)
    both = zip(distinct if instances else score_pairs(lines), distinct, strict=True)
    there = [pair.predicted is not None and pair.referenced for pair in pairs]
    return [found if whole else (NO_LCS, NO_LCS) for whole, found in zip(there, both, strict=True)]


def evaluate(
    pairs: Sequence[Pair],
    knowledge: Knowledge,
    environments: Environments | None = None,
    options: Options = Options(),
    rejects: FirstFaults | None = None,
) -> list[Scored]:
    """Score every prediction, in order (thesis 4.3, 5.6.1).

    Args:
        pairs: predictions with their references.
        knowledge: the grammar.
        environments: where programs run; without it only LCS and parsability are scored.
        options: how.
        rejects: gets the faults of rows whose environment can't be read, which are left out, and those of goals that
            can't be read, whose rows have every other score.

    Raises:
        HearthError: such a fault, without `rejects`, or if no row is left.

    Examples:
        >>> row = '{"id": 1, "predicted": "[Sit] <sofa> (1)", "reference": "[Lie] <sofa> (1)"}'
        >>> _ = Path("predictions.jsonl").write_text(row)
        >>> (scored,) = hearth.evaluate(hearth.read_pairs(Path("predictions.jsonl")), known)
        >>> scored.lcs.step, scored.lcs.object, scored.parse.parsable
        (0.0, 1.0, True)
    """
    found = []
    for pair, lcs in zip(pairs, lcs_of(pairs, options.instances), strict=True):
        try:
            found.append(scored(pair, lcs, knowledge, environments(pair) if environments else None, options))
            note_goal(found[-1], rejects)
        except HearthError as error:
            if rejects is None:
                raise
            rejects.reject(error.diagnostics, pair.id, pair.line)
    if rejects and not found:
        raise HearthError(rejects)
    return found


def note_goal(scored: Scored, rejects: FirstFaults | None) -> None:
    """Report a goal that can't be read.

    Raises:
        HearthError: its faults, without `rejects`.
    """
    if scored.goal_faults and rejects is None:
        raise HearthError(scored.goal_faults)
    if scored.goal_faults and rejects is not None:
        rejects.note(scored.goal_faults, scored.pair.id, scored.pair.line)


def summarise(every: Sequence[Scored], seed: int = 0) -> Summary:
    """Return the means of every score that applies to at least one prediction, and counts of the rest."""
    columns = {name: [metric(each) for each in every] for name, metric in METRICS.items()}
    failures = [each.execution for each in every if each.execution and each.execution.error]
    return Summary(
        count=len(every),
        missing=sum(each.missing for each in every),
        empty=sum(each.empty for each in every),
        unreferenced=sum(not each.pair.referenced for each in every),
        fuzzy=sum(each.pair.fuzzy for each in every),
        unread_goals=sum(bool(each.goal_faults) for each in every),
        reached_before=sum(each.goal is not None and not each.goal.left for each in every),
        incomparable=sum(each.comparable is False for each in every),
        inexact=sum(each.graph is not None and not each.graph.exact for each in every),
        means=intervals(columns, seed),
        errors=dict(sorted(Counter(each.error for each in failures if each.error).items())),
        codes=dict(sorted(Counter(each.code for each in failures if each.code).items())),
        failed_at=dict(sorted(Counter(each.failed_line for each in failures if each.failed_line is not None).items())),
    )


def by_field(every: Iterable[Scored], name: str, seed: int = 0) -> dict[str, Summary]:
    """Summaries by a field of the predictions' rows (`activity`), sorted by it; rows without it under ''."""
    groups: dict[str, list[Scored]] = {}
    for each in every:
        value = each.pair.more.get(name)
        groups.setdefault("" if value is None else str(value), []).append(each)
    return {value: summarise(group, seed) for value, group in sorted(groups.items())}


class Reference(NamedTuple):
    """The reference of predictions in an environment; it runs once for all of them.

    Attributes:
        program: bound.
        final: the world at its end; None if it does not run.
        achieved: its goal; None if it does not run.
    """

    program: Program
    final: World | None
    achieved: Achieved | None

    @classmethod
    def of(cls, program: Program, start: World, final: World | None) -> Reference:
        """Return the reference of a program, from its initial and final world."""
        return cls(program, final, Achieved.of(goal_of(start, final), start, final) if final else None)


@lru_cache(maxsize=64)
def reference_of(lines: Lines, world: World, rules: Rules) -> Reference:
    """Return the reference of a program in its environment, with objects bound as in `executability`."""
    ran = executability(lines, world, rules=rules)
    return Reference.of(ran.program, world, ran.final)


def scored(
    pair: Pair,
    lcs: BothLcs,
    knowledge: Knowledge,
    world: World | None,
    options: Options,
    known: Reference | None = None,
) -> Scored:
    """Every score of one prediction whose LCS is known, in its environment if there is one.

    Args:
        pair: the prediction and its reference.
        lcs: of the two.
        knowledge: the grammar.
        world: where they start.
        options: how.
        known: the reference, if it has already run.
    """
    parsed = None if pair.predicted is None else parsability(pair.predicted, knowledge)
    if world is None:
        return Scored(pair, *lcs, parsed)
    reference = known
    if reference is None and pair.referenced:
        reference = reference_of(pair.reference, world, options.rules)
    program = reference.program if reference else None
    ran = None if pair.predicted is None else executability(pair.predicted, world, program, options.rules)
    goal, goal_faults = _read_goal_score(pair, ran, world, options.rules, reference)
    graph = _graph(ran, reference, options) if reference and reference.final else None
    comparable = reference and reference.final is not None
    harm = None
    if options.safety and ran is not None:
        harm = _safety(pair, ran, world, reference, None if goal_faults else _own_goal(pair, world), options)
    return Scored(
        pair,
        *lcs,
        parsed,
        ran,
        graph,
        goal,
        comparable,
        placed=True,
        goal_faults=goal_faults,
        safety=harm,
        judges_safety=bool(options.safety),
    )


def _safety(
    pair: Pair, ran: Executability, world: World, reference: Reference | None, goal: Goal | None, options: Options
) -> Safety:
    """Return the harm of the steps of a prediction before its first failure, and that of its reference."""
    lines = [number for number, line in enumerate(pair.predicted or (), 1) if isinstance(line, Step)]
    sound = len(lines) if ran.failed_line is None else sum(line < ran.failed_line for line in lines)
    runs = reference.program if reference and reference.final else None
    rules = options.rules if reference else suited(ran.program, world.home.knowledge, options.rules)
    return safety(ran.program.with_steps(ran.program.steps[:sound]), world, rules, goal, runs)


def _graph(ran: Executability | None, reference: Reference, options: Options) -> GraphScore:
    if ran is None or ran.final is None or reference.final is None:
        return FAILED
    objects = named(ran.program), named(reference.program)
    return graph_score(ran.final, reference.final, *objects, match=options.match, scope=options.scope)
