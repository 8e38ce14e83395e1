"""Agreement of a planner with the engine: problems are solved by Fast Downward, and the plans run in the engine.

Besides the pruning of `pddl_problems`, three measures shorten the search: actions without an effect or with a
substitute are omitted (`dispensable`); actions without objects in the problem are omitted; and objects must themselves
be CLOSE, while the engine also accepts objects next to a CLOSE one.
"""

from collections import Counter
from collections.abc import Iterator
from contextlib import chdir
from dataclasses import dataclass
from itertools import islice
from tempfile import TemporaryDirectory
from typing import Any

from hearth.datasets.dataset import Dataset
from hearth.datasets.export.pddl_domain import TO_DOOR, planning_domain
from hearth.datasets.export.pddl_problems import WANTED, Task, object_names, problem, tasks
from hearth.datasets.export.program_batches import Wanted
from hearth.kb.formula import Term
from hearth.kb.knowledge import Knowledge
from hearth.kb.knowledge_records import Action, Process
from hearth.kb.tools.pddl import literals_of, states_in, waiting
from hearth.schemas.literals import Literal
from hearth.schemas.optional_libraries import library
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.simulation.actions.registry import ACTIONS, EVERY
from hearth.simulation.engine import run
from hearth.simulation.rules import rules_of
from hearth.storage.parallel import Seen, spread, unseen

LIMIT = 60
"""Seconds of search per problem."""

STEP = 61
"""Stride between selected programs, which spreads a few hundred over the whole dataset."""


@dataclass(frozen=True, slots=True)
class Outcome:
    """The result of one problem.

    Attributes:
        task: the problem.
        status: the planner's status.
        plan: the plan as our steps; None without one.
        ran: whether the engine executed all of it.
        reached: whether the goal held at its end.
        failure: the message of the failure, or "".
    """

    task: Task
    status: str
    plan: tuple[Step, ...] | None = None
    ran: bool = False
    reached: bool = False
    failure: str = ""


@dataclass(frozen=True, slots=True)
class Agreement:
    """Agreement of planner and engine.

    Attributes:
        problems: number of problems given to the planner.
        solved: number of problems with a plan.
        ran: number of plans that the engine executes to their end.
        reached: number of plans after which the goal holds.
        statuses: the planner's statuses of problems without a plan, with counts.
        objects: mean number of objects in a problem, and in its home.
        steps: mean number of steps in a plan.
        disagreements: one line each.
    """

    problems: int
    solved: int
    ran: int
    reached: int
    statuses: dict[str, int]
    objects: tuple[float, float]
    steps: float
    disagreements: tuple[str, ...]


def agreement(dataset: Dataset, problems: int, workers: int = 1, seen: Seen = unseen) -> Agreement:
    """Solve problems from all over a dataset in `workers` processes and run the plans; `seen` reports progress.

    Raises:
        HearthError: MISSING_FILE, when unified-planning or Fast Downward is not installed.
    """
    return summary(list(spread(solve, list(chosen(dataset, problems)), workers, seen)))


def chosen(dataset: Dataset, problems: int) -> Iterator[Task]:
    """`problems` tasks, at most one per program: of every `STEP`-th program first, then of the programs after them."""
    names = list(dataset)
    apart = [name for start in range(min(STEP, len(names))) for name in names[start::STEP]]
    found = (task for start in range(0, len(apart), ASKED) for task in _firsts(dataset, apart[start : start + ASKED]))
    return islice(found, problems)


ASKED = 32
"""Programs read in one query: a query for one takes as long."""


def _firsts(dataset: Dataset, names: list[str]) -> Iterator[Task]:
    """Yield the first task of each program with a task, in the order of the names."""
    found: dict[str, Task] = {}
    for task in tasks(dataset, Wanted(tuple(names))):
        found.setdefault(task.program_id, task)
    yield from (found[name] for name in names if name in found)


def dispensable(knowledge: Knowledge) -> dict[str, tuple[str, ...]]:
    """Actions that a plan never needs -> their substitutes, which have the same effect in every applicable state.

    FACING is a precondition only of actions without an effect.
    """
    variants = [knowledge.actions[name] for name in sorted(knowledge.group("variant"))]
    plain = [action for action in knowledge.actions.values() if action.name not in knowledge.group("variant")]
    same = {v.name: tuple(a.name for a in plain if a.effects == v.effects) for v in variants}
    alike = {a.name: (a.later.like,) for a in plain if a.executed and a.later and a.later.like}  # Crawl is a Walk
    return {**same, **alike, "TurnTo": ()}


def helpful(task: Task) -> tuple[str, ...]:
    """Return the actions that a plan may need: with objects in the problem, and with an effect that something asks for.

    Acts that only action set 3 executes move nothing that others cannot move; so they count for the states that they
    make, and for where the character is.
    """
    home = task.world.home
    there = sum(1 << home.index[node] for node in task.objects)
    spare = {*dispensable(home.knowledge), *home.knowledge.group("unplanned"), *(EVERY.keys() - ACTIONS.keys())}
    able = {
        name: action
        for name, action in sorted(home.knowledge.actions.items())
        if action.executed
        and action.effects
        and name not in spare
        and all(home.able(name, position) & there for position in range(action.arity))
    }
    waits = {name: waiting(home.knowledge)[name] for name in _awaited(task)}
    wanted = {state for _, state, _ in task.states}
    wanted |= {part.terms[1].name for each in waits.values() for part in literals_of(each) if part.name == "state"}
    found: set[str] = set()
    while more := {name for name, action in able.items() if name not in found and _makes_one(action, wanted)}:
        found |= more
        wanted |= {state for name in more for check in able[name].preconditions for state in states_in(check.formula)}
    return (*(name for name in able if name in found), *waits)


def _makes_one(action: Action, wanted: set[str]) -> bool:
    """Return whether an action changes a state that something asks for, or a place or a hand."""
    for effect in action.effects:
        literal = effect.literal
        if literal.name == "state" and literal.terms[1].name in wanted:
            return True
        moves = literal.name in WANTED and (action.name in ACTIONS or literal.terms[0].name == "a")
        if moves or (literal.name == "CLOSE" and action.name in ACTIONS):
            return True
    return False


def _awaited(task: Task) -> Iterator[str]:
    """Yield the waits by which states of the goal come about, and those that these wait for."""
    waits = waiting(task.world.home.knowledge)
    wanted, found = {state for _, state, holds in task.states if holds}, dict[str, Process]()
    while True:
        more = {name: each for name, each in waits.items() if name not in found and wanted & _makes(each)}
        if not more:
            break
        found |= more
        wanted = {part.terms[1].name for each in more.values() for part in literals_of(each) if _is_state(part)}
    classes = {task.world.home.classes[task.world.home.index[node]] for node in task.objects}
    for name, process in found.items():
        if {part.terms[1].name for part in literals_of(process) if part.name == "class"} <= classes:
            yield name


def _is_state(part: Literal[Term]) -> bool:
    return part.name == "state" and not part.negated


def _makes(process: Process) -> set[str]:
    """Return the states that a process brings about."""
    return {effect.literal.terms[-1].name for effect in process.effects if not effect.literal.negated} - {"ON", "OFF"}


def solve(task: Task) -> Outcome:
    """Parse a problem with unified-planning, solve it with Fast Downward, run the plan in the engine."""
    planning = library("unified_planning.shortcuts")
    planning.get_environment().credits_stream = None
    domain = planning_domain(task.world.home.knowledge, helpful(task), loose=False)
    parsed = library("unified_planning.io").PDDLReader().parse_problem_string(domain, problem(task))
    options = {"fast_downward_search_time_limit": f"{LIMIT}s"}
    # Fast Downward writes `output.sas` into its working directory: two at once would read each other's.
    fast_downward = planning.OneshotPlanner(name="fast-downward", params=options)
    with fast_downward as planner, TemporaryDirectory() as own, chdir(own):
        result = planner.solve(parsed)
    status = library("unified_planning.engines").PlanGenerationResultStatus(result.status).name
    return Outcome(task, status) if result.plan is None else executed(task, status, steps_of(task, result.plan))


def steps_of(task: Task, plan: Any) -> tuple[Step, ...]:
    """Return a plan of unified-planning as steps bound to nodes."""
    nodes = {name: node for node, name in object_names(task).items()}
    home = task.world.home
    actions = {name.lower(): name for name in home.knowledge.actions} | {TO_DOOR.lower(): "Walk"}
    steps = []
    waits = waiting(home.knowledge)
    for each in plan.actions:
        if each.action.name.lower() in waits:
            steps += [Step("Wait")] * waits[each.action.name.lower()].after
            continue
        _, *given = (nodes[str(argument)] for argument in each.actual_parameters)
        refs = tuple(ObjectRef(home.classes[home.index[node]], 1, node) for node in given)
        steps.append(Step(actions[each.action.name.lower()], refs))
    return tuple(steps)


def executed(task: Task, status: str, plan: tuple[Step, ...]) -> Outcome:
    """Run a plan in the engine."""
    execution = run(task.world, Program(steps=plan), rules_of(task.world.home.knowledge))
    failure = execution.failure.message() if execution.failure else ""
    return Outcome(task, status, plan, not failure, not failure and task.reached(execution.final), failure)


def summary(outcomes: list[Outcome]) -> Agreement:
    """Counts of outcomes, and the disagreements."""
    solved = [outcome for outcome in outcomes if outcome.plan is not None]
    wrong = [outcome for outcome in solved if not outcome.reached]
    several = max(len(outcomes), 1)
    return Agreement(
        problems=len(outcomes),
        solved=len(solved),
        ran=sum(outcome.ran for outcome in solved),
        reached=sum(outcome.reached for outcome in solved),
        statuses=dict(Counter(outcome.status for outcome in outcomes if outcome.plan is None)),
        objects=(
            sum(len(outcome.task.objects) for outcome in outcomes) / several,
            sum(len(outcome.task.world.home) for outcome in outcomes) / several,
        ),
        steps=sum(len(outcome.plan or ()) for outcome in solved) / max(len(solved), 1),
        disagreements=tuple(
            f"{outcome.task.name}: {outcome.failure or 'it runs, and the goal does not hold'}" for outcome in wrong
        ),
    )
