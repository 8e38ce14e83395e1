"""All scores of all predictions, and their summary: means, intervals, errors, groups by a field."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, NamedTuple

from hearth.kb.knowledge import Knowledge
from hearth.schemas.brief import brief
from hearth.schemas.goals import Goal
from hearth.schemas.program import Program
from hearth.scoring.bootstrap import Interval, intervals
from hearth.scoring.environments import Environments
from hearth.scoring.lines import Lines
from hearth.scoring.metrics import executability as running
from hearth.scoring.metrics import goals
from hearth.scoring.metrics.executability import ErrorClass, Executability, executability
from hearth.scoring.metrics.goals import goal_of
from hearth.scoring.metrics.graph_f1 import FAILED, MATCH, SCOPE, GraphScore, MatchBy, Scope, f1_signature, named
from hearth.scoring.metrics.graph_f1 import score as graph_score
from hearth.scoring.metrics.lcs import LEVELS, LcsScore, lcs_signature, score_pairs
from hearth.scoring.metrics.parsability import SIGNATURE as PARSABLE
from hearth.scoring.metrics.parsability import Parsability, parsability
from hearth.scoring.predictions import Pair
from hearth.simulation.engine import run
from hearth.simulation.goal_text import read_goal
from hearth.simulation.goals import Progress
from hearth.simulation.rules import DEFAULT, Rules
from hearth.simulation.world.world import World

GOALS = ("goal", "tl_goal", "vh_goal")
"""Columns of rows that have a goal of their own; where a dataset is the reference, its goals are."""

NO_LCS = LcsScore(0.0, 0.0, 0.0)

BothLcs = tuple[LcsScore, LcsScore]
"""Similarity by class, or as the options say, and by instance."""


@dataclass(frozen=True, slots=True)
class Options:
    """How predictions are scored.

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
        lcs: similarity of the programs, by class unless the options say otherwise.
        by_instance: similarity where each object is an instance, as in tables 5.2 to 5.5.
        parse: None for a missing prediction.
        execution: None without an environment, and for a missing prediction.
        graph: None without an environment, or if the reference does not run.
        goal: progress of the row's own goal, else of the goal that the reference achieves; None if the prediction does
            not run, or without either.
        comparable: whether the reference runs; None without an environment.
    """

    pair: Pair
    lcs: LcsScore
    by_instance: LcsScore
    parse: Parsability | None = None
    execution: Executability | None = None
    graph: GraphScore | None = None
    goal: Progress | None = None
    comparable: bool | None = None

    __repr__ = brief

    @property
    def missing(self) -> bool:
        """Whether the prediction is missing."""
        return self.pair.predicted is None

    @property
    def empty(self) -> bool:
        """Whether the prediction has no lines."""
        return self.pair.predicted == ()


def _goal(scored: Scored, value: Callable[[Progress], float]) -> float | None:
    if not scored.comparable and given_goal(scored.pair) is None:
        return None
    return value(scored.goal) if scored.goal else 0.0


def given_goal(pair: Pair) -> Any:
    """The goal in a prediction's row, unread; None if it has none."""
    return next((found for name in GOALS if (found := pair.more.get(name)) is not None), None)


def _progress(pair: Pair, ran: Executability, world: World, rules: Rules, achieved: Goal | None) -> Progress | None:
    """The progress of the goal that a prediction is asked to reach, at the end of its run."""
    given = given_goal(pair)
    if ran.final is None or given is None:
        return Progress.at(achieved, ran.final) if ran.final and achieved else None
    place = f"goal of `{pair.id}`, row {pair.line}"
    return Progress.of(read_goal(given, world.home, place), run(world, ran.program, rules))


def _executable(scored: Scored) -> float | None:
    if scored.comparable is None:
        return None
    return float(scored.execution is not None and scored.execution.executable)


METRICS: dict[str, Callable[[Scored], float | None]] = {
    "lcs_step": lambda s: s.lcs.step,
    "lcs_action": lambda s: s.lcs.action,
    "lcs_object": lambda s: s.lcs.object,
    "lcs_mean": lambda s: s.lcs.mean,
    "lcs_step_instances": lambda s: s.by_instance.step,
    "lcs_object_instances": lambda s: s.by_instance.object,
    "parsable": lambda s: float(s.parse is not None and s.parse.parsable),
    "parsable_names": lambda s: float(s.parse is not None and s.parse.named),
    "executable": _executable,
    "executable_filled": lambda s: None if s.empty else _executable(s),
    "f1_state": lambda s: s.graph.states.f1 if s.graph else None,
    "f1_relation": lambda s: s.graph.relations.f1 if s.graph else None,
    "f1": lambda s: s.graph.both.f1 if s.graph else None,
    "goal": lambda s: _goal(s, lambda found: float(found.satisfied)),
    "goal_fraction": lambda s: _goal(s, lambda found: found.fraction),
}
"""Every score by name, from 0 to 1; None if it does not apply. To add a scorer: a module, a row here, a test."""


@dataclass(frozen=True, slots=True)
class Summary:
    """The summary of many scores.

    Attributes:
        count: number of predictions, including missing ones.
        missing: number of missing predictions, which score 0.
        empty: number of predictions without lines, which parse and run; `executable_filled` excludes them.
        incomparable: number of references that do not run; excluded from F1, and from goals that are theirs.
        inexact: number of predictions whose F1 is a lower bound.
        means: each score's mean and interval.
        errors: first failures by class.
        failed_at: number of first failures at each line, from 0.
    """

    count: int
    missing: int
    empty: int
    incomparable: int
    inexact: int
    means: Mapping[str, Interval]
    errors: Mapping[ErrorClass, int]
    failed_at: Mapping[int, int]

    __repr__ = brief


def signatures(options: Options, own: int = 0) -> dict[str, str]:
    """The signature of each family of scores, where `own` predictions had a goal of their own."""
    return {
        **{f"lcs_{level}": lcs_signature(level, options.instances) for level in LEVELS},
        **{f"lcs_{level}_instances": lcs_signature(level, True) for level in ("step", "object")},
        "parsable": PARSABLE,
        "executable": running.SIGNATURE,
        "f1": f1_signature(options.match, options.scope),
        "goal": goals.signature_of(own),
    }


def lcs_of(pairs: Sequence[Pair], instances: bool = False) -> list[BothLcs]:
    """The similarity of each prediction to its reference, and that by instance; 0 for a missing one."""
    lines = [(pair.predicted or (), pair.reference) for pair in pairs]
    distinct = score_pairs(lines, instances=True)
    both = zip(distinct if instances else score_pairs(lines), distinct, strict=True)
    return [(NO_LCS, NO_LCS) if pair.predicted is None else found for pair, found in zip(pairs, both, strict=True)]


def evaluate(
    pairs: Sequence[Pair], knowledge: Knowledge, environments: Environments | None = None, options: Options = Options()
) -> list[Scored]:
    """Score every prediction, in order (thesis 4.3, 5.6.1).

    Args:
        pairs: predictions with their references.
        knowledge: the grammar.
        environments: where programs run; without it only LCS and parsability are scored.
        options: how.

    Examples:
        >>> row = '{"id": 1, "predicted": "[Sit] <sofa> (1)", "reference": "[Lie] <sofa> (1)"}'
        >>> _ = Path("predictions.jsonl").write_text(row)
        >>> (scored,) = hearth.evaluate(hearth.read_pairs(Path("predictions.jsonl")), known)
        >>> scored.lcs.step, scored.lcs.object, scored.parse.parsable
        (0.0, 1.0, True)
    """
    return [
        scored(pair, lcs, knowledge, environments(pair) if environments else None, options)
        for pair, lcs in zip(pairs, lcs_of(pairs, options.instances), strict=True)
    ]


def summarise(every: Sequence[Scored], seed: int = 0) -> Summary:
    """The means of every score that applies to at least one prediction, and counts of the rest."""
    columns = {name: [metric(each) for each in every] for name, metric in METRICS.items()}
    failures = [each.execution for each in every if each.execution and each.execution.error]
    return Summary(
        count=len(every),
        missing=sum(each.missing for each in every),
        empty=sum(each.empty for each in every),
        incomparable=sum(each.comparable is False for each in every),
        inexact=sum(each.graph is not None and not each.graph.exact for each in every),
        means=intervals(columns, seed),
        errors=dict(sorted(Counter(each.error for each in failures if each.error).items())),
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
        goal: its achieved goal.
    """

    program: Program
    final: World | None
    goal: Goal | None

    @classmethod
    def of(cls, program: Program, start: World, final: World | None) -> Reference:
        """The reference of a program, from its initial and final world."""
        return cls(program, final, goal_of(start, final) if final else None)


@lru_cache(maxsize=64)
def reference_of(lines: Lines, world: World, rules: Rules) -> Reference:
    """The reference of a program in its environment, with objects bound as in `executability`."""
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
    program, final, achieved = known or reference_of(pair.reference, world, options.rules)
    ran = None if pair.predicted is None else executability(pair.predicted, world, program, options.rules)
    goal = _progress(pair, ran, world, options.rules, achieved) if ran else None
    if final is None:
        return Scored(pair, *lcs, parsed, ran, goal=goal, comparable=False)
    if ran is None or ran.final is None:
        return Scored(pair, *lcs, parsed, ran, FAILED, comparable=True)
    objects = named(ran.program), named(program)
    graph = graph_score(ran.final, final, *objects, match=options.match, scope=options.scope)
    return Scored(pair, *lcs, parsed, ran, graph, goal, comparable=True)
