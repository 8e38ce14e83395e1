"""All scores of all predictions, and their summary: means, intervals, errors, groups by a field."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, NamedTuple

from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code
from hearth.schemas.program import Program
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
from hearth.scoring.metrics.parsability import Parsability, parsability
from hearth.scoring.predictions import Pair
from hearth.scoring.refused_rows import FirstFaults
from hearth.simulation.engine import run
from hearth.simulation.goal_text import read_goal
from hearth.simulation.rules import DEFAULT, Rules
from hearth.simulation.world.world import World

GOALS = ("goal", "tl_goal", "vh_goal")
"""Columns of rows that have a goal of their own; where a dataset is the reference, its goals are."""

NO_LCS = LcsScore(0.0, 0.0, 0.0)

BothLcs = tuple[LcsScore, LcsScore]
"""Similarity by class, or as the options say, and by instance; 0 without a reference."""


@dataclass(frozen=True, slots=True)
class Options:
    """Settings for scoring predictions.

    Attributes:
        rules: of simulation.
        match: assignment of instances in final graphs.
        scope: the program whose objects are compared in final graphs.
        instances: whether LCS distinguishes instances at all levels; `Scored.by_instance` always does.
        seed: of the intervals.
    """

    rules: Rules = DEFAULT
    match: MatchBy = MATCH
    scope: Scope = SCOPE
    instances: bool = False
    seed: int = 0


@dataclass(frozen=True, slots=True)
class Scored:
    """One prediction's scores. Scores that do not apply are None; a missing prediction fails in all that apply.

    Attributes:
        pair: the prediction and its reference.
        lcs: similarity of the programs, by class unless the options say otherwise; 0 without a reference.
        by_instance: similarity where each object is an instance, as in tables 5.2 to 5.5.
        parse: None for a missing prediction.
        execution: None without an environment, and for a missing prediction.
        graph: None without an environment, or if the reference does not run.
        goal: of the row's own goal, else of the goal that the reference achieves; None without either.
        comparable: whether the reference runs; None without an environment or a reference.
        placed: whether there is an environment.
        goal_faults: why the row's own goal can't be read; such a row has every score but those of the goal.
    """

    pair: Pair
    lcs: LcsScore
    by_instance: LcsScore
    parse: Parsability | None = None
    execution: Executability | None = None
    graph: GraphScore | None = None
    goal: GoalScore | None = None
    comparable: bool | None = None
    placed: bool = False
    goal_faults: tuple[Diagnostic, ...] = ()

    __repr__ = brief

    @property
    def missing(self) -> bool:
        """Return whether the prediction is missing."""
        return self.pair.predicted is None

    @property
    def empty(self) -> bool:
        """Return whether the prediction has no lines."""
        return self.pair.predicted == ()


def _left(scored: Scored, value: Callable[[GoalScore], float]) -> float | None:
    """Return the value of a goal of which something was left to do at the start."""
    return float(value(scored.goal)) if scored.goal and scored.goal.left else None


def _whole(scored: Scored, value: Callable[[GoalScore], float]) -> float | None:
    return float(value(scored.goal)) if scored.goal else None


def _f1(value: Callable[[GraphScore], float]) -> Callable[[Scored], float | None]:
    """Return an F1 of final graphs, which is 0 for a prediction without steps."""
    return lambda scored: None if scored.graph is None else 0.0 if scored.empty else value(scored.graph)


def _lcs(level: str, by_instance: bool = False) -> Callable[[Scored], float | None]:
    def value(scored: Scored) -> float | None:
        found: float = getattr(scored.by_instance if by_instance else scored.lcs, level)
        return found if scored.pair.referenced else None

    return value


def given_goal(pair: Pair) -> Any:
    """Return the goal in a prediction's row, unread; None if it has none."""
    return next((found for name in GOALS if (found := pair.more.get(name)) is not None), None)


def _goal_score(
    pair: Pair, ran: Executability | None, world: World, rules: Rules, reference: Reference | None
) -> GoalScore | None:
    """Return the score of the goal that a prediction is asked to reach; one that fails reaches nothing."""
    final = ran.final if ran and ran.afforded else None
    given = given_goal(pair)
    if given is None:
        return reference.achieved.score(final) if reference and reference.achieved else None
    goal = read_goal(given, world.home, f"goal of `{pair.id}`, row {pair.line}")
    return of_given(goal, world, run(world, ran.program, rules) if ran and final else None)


def _read_goal_score(
    pair: Pair, ran: Executability | None, world: World, rules: Rules, reference: Reference | None
) -> tuple[GoalScore | None, tuple[Diagnostic, ...]]:
    """Return the score of the goal, or the faults of a goal that can't be read."""
    try:
        return _goal_score(pair, ran, world, rules, reference), ()
    except HearthError as error:
        return None, tuple(error.diagnostics)


def _executable(scored: Scored) -> float | None:
    if not scored.placed:
        return None
    return float(scored.execution is not None and scored.execution.executable)


METRICS: dict[str, Callable[[Scored], float | None]] = {
    "lcs_step": _lcs("step"),
    "lcs_action": _lcs("action"),
    "lcs_object": _lcs("object"),
    "lcs_mean": _lcs("mean"),
    "lcs_step_instances": _lcs("step", by_instance=True),
    "lcs_object_instances": _lcs("object", by_instance=True),
    "parsable": lambda s: float(s.parse is not None and s.parse.parsable),
    "parsable_names": lambda s: float(s.parse is not None and s.parse.named),
    "executable": _executable,
    "executable_filled": lambda s: None if s.empty else _executable(s),
    "f1_state": _f1(lambda found: found.states.f1),
    "f1_relation": _f1(lambda found: found.relations.f1),
    "f1": _f1(lambda found: found.both.f1),
    "f1_state_published": lambda s: s.graph.states.f1 if s.graph else None,
    "f1_relation_published": lambda s: s.graph.relations.f1 if s.graph else None,
    "f1_published": lambda s: s.graph.both.f1 if s.graph else None,
    "goal": lambda s: _left(s, lambda found: found.reached),
    "goal_fraction": lambda s: _left(s, lambda found: found.fraction),
    "goal_whole": lambda s: _whole(s, lambda found: found.whole),
    "goal_whole_fraction": lambda s: _whole(s, lambda found: found.whole_fraction),
}
"""Every score by name, from 0 to 1; None if it does not apply.

`f1` of an empty prediction is 0. In the thesis's reading, `f1_published`, an empty program runs: it shares the
character's place with its reference, or has no state as its reference. `goal` counts only literals that did not hold at
the start. `goal_whole` is the reading before version 2, which counts all.

To add a scorer: a module, a row here, a test.
"""


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
    return Scored(pair, *lcs, parsed, ran, graph, goal, comparable, placed=True, goal_faults=goal_faults)


def _graph(ran: Executability | None, reference: Reference, options: Options) -> GraphScore:
    if ran is None or ran.final is None or reference.final is None:
        return FAILED
    objects = named(ran.program), named(reference.program)
    return graph_score(ran.final, reference.final, *objects, match=options.match, scope=options.scope)
