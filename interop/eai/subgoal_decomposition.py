"""Subgoal decomposition: whether the subgoals of a model can be brought about, and reach the goal, by both rules."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from enum import StrEnum
from itertools import islice, product
from typing import NamedTuple

from hearth.interop.eai.action_sequencing import Fault, fault_of
from hearth.interop.eai.answer_texts import subgoals_of
from hearth.interop.eai.subgoal_acts import arity, ways
from hearth.interop.eai.task_worlds import TaskWorld, bound, task_world
from hearth.interop.eai.temporal_logic import Act, Atom, Compound, Formula, Run, atoms_of, fulfilled, read_formula
from hearth.interop.eai.wheel import Answer, Wheel
from hearth.kb.knowledge import Knowledge
from hearth.schemas.program import Program, Step
from hearth.simulation.engine import act, run
from hearth.simulation.goal_text import read_goal
from hearth.simulation.goals import Progress
from hearth.simulation.rules import EVOLVING_GRAPH, Rules
from hearth.simulation.world.world import World

MOST_BRANCHES = 256
"""Runs that are tried for one answer."""

MOST_CHOICES = 16
"""Choices among the parts of `or` that are tried by ours."""

MOST_CHANCES = 64
"""Choices among the parts of `or` that are tried by the interface's rules."""

ALONE = ("SLEEP", "WAKEUP", "STANDUP")
"""Acts without arguments, which may stand without brackets."""


class Unread(StrEnum):
    """The class of an answer whose subgoals cannot be judged."""

    PARSING = "parsing"
    HALLUCINATION = "hallucination"


class Verdict(NamedTuple):
    """Subgoals judged.

    Attributes:
        task: its number.
        executed, succeeds: by the interface's rules.
        runs, reaches: by ours.
        fault: why they are not executed by the interface's rules.
    """

    task: str
    executed: bool
    succeeds: bool
    runs: bool
    reaches: bool
    fault: str = ""


def judged(wheel: Wheel, answer: Answer, knowledge: Knowledge) -> Verdict:
    """Return the verdict on an answer; of the parts of `or` the interface's rules then take the first."""
    there = task_world(wheel, answer.task, knowledge)
    subgoals = subgoals_of(answer.text)
    runs, reaches = _by_ours(there, subgoals or [], knowledge)
    executed, succeeds, fault = next(_by_theirs(there, subgoals, knowledge))
    return Verdict(answer.task, executed, succeeds, runs, reaches, fault)


def outcomes(wheel: Wheel, answer: Answer, knowledge: Knowledge) -> set[tuple[bool, bool]]:
    """Return execution and success by the interface's rules for every choice among the parts of `or`.

    The interface chooses by chance. Of more than 64 choices the first 64 are tried.
    """
    there = task_world(wheel, answer.task, knowledge)
    found = _by_theirs(there, subgoals_of(answer.text), knowledge)
    return {(executed, succeeds) for executed, succeeds, _ in islice(found, MOST_CHANCES)}


def _by_theirs(
    there: TaskWorld, subgoals: Sequence[str] | None, knowledge: Knowledge
) -> Iterator[tuple[bool, bool, str]]:
    """Yield execution, success and fault for each choice among the parts of `or`, that of all first parts first."""
    goal = there.task.record.get("tl_goal")
    for chosen in [None] if subgoals is None else _chances(subgoals):
        read = Unread.PARSING if chosen is None else _as_scored(chosen, there)
        if isinstance(read, Unread) or not goal:
            yield False, False, str(read if isinstance(read, Unread) else Unread.PARSING)
            continue
        found, faults = _runs(there, read, knowledge)
        wanted = read_formula(goal)
        yield bool(found), any(fulfilled(wanted, done) for done in found), "" if found else str(faults[0])


def _chances(subgoals: Sequence[str]) -> Iterator[tuple[str, ...]]:
    """Yield the subgoals with one part of each `or`; texts without brackets are passed over."""
    kept = [[f"{each}()"] if each in ALONE else each.split(" or ") for each in subgoals
            if each in ALONE or re.search(r"\w+\(.*?\)", each)]  # fmt: skip
    yield from product(*kept)


def _as_scored(chosen: Sequence[str], there: TaskWorld) -> list[Atom] | Unread:
    """Return the subgoals one after the other as the interface reads them. It cannot read negations."""
    try:
        formula = read_formula(" then ".join(chosen))
    except ValueError:
        return Unread.PARSING
    atoms = atoms_of(formula)
    if any(arity(atom.name) is None for atom in atoms):
        return Unread.HALLUCINATION
    if any(arity(atom.name) != len(atom.terms) or not all(_is_there(term, there) for term in atom.terms)
           for atom in atoms):  # fmt: skip
        return Unread.HALLUCINATION
    if any("." not in term for atom in atoms for term in atom.terms) or _has(formula, ("not", "exists")):
        return Unread.PARSING
    return atoms


def _has(formula: Formula, joins: Iterable[str]) -> bool:
    if isinstance(formula, Atom):
        return False
    return formula.join in joins or any(_has(part, joins) for part in formula.parts)


def _is_there(term: str, there: TaskWorld) -> bool:
    """Return whether a term names a node, `cup.12`, or a class of the home."""
    home = there.start.home
    name, _, number = term.rpartition(".")
    if not name:
        return term in home.classes
    node = int(number) if number.isdecimal() else -1
    return node in home.index and home.classes[home.index[node]] == name


def _runs(there: TaskWorld, atoms: Sequence[Atom], knowledge: Knowledge) -> tuple[list[Run], list[Fault]]:
    """Return the runs in which all subgoals were acted on, superfluous acts skipped, and the faults of the others."""
    me = _me(there.start)
    open_runs: list[Run] = [Run((there.start,), ())]
    faults: list[Fault] = []
    for atom in atoms:
        further: list[Run] = []
        for done in open_runs[:MOST_BRANCHES]:
            tried = ways(atom, done.worlds[-1], me)
            further += [] if tried else [done]
            for way in tried:
                found = _acted(done, way, knowledge)
                if isinstance(found, Fault):
                    faults.append(found)
                else:
                    further.append(found)
        open_runs = further
    return open_runs, faults


def _acted(done: Run, way: Sequence[Act], knowledge: Knowledge) -> Run | Fault:
    worlds, acts = list(done.worlds), list(done.acts)
    for name, terms in way:
        step = _step(name, terms, knowledge)
        result = act(worlds[-1], step, EVOLVING_GRAPH)
        if isinstance(result, World):
            worlds.append(result)
            acts.append((name, terms))
            continue
        fault = fault_of(step, result, worlds)
        if fault is not Fault.ADDITIONAL_STEP:
            return fault
    return Run(worlds, acts)


def _step(name: str, terms: Sequence[str], knowledge: Knowledge) -> Step:
    things = [(term.rpartition(".")[0], int(term.rpartition(".")[2])) for term in terms]
    return bound(name, things, knowledge)


def _me(world: World) -> str:
    number = world.home.ids[world.agents[0].index]
    return f"{world.home.classes[world.home.index[number]]}.{number}"


def _by_ours(there: TaskWorld, subgoals: Sequence[str], knowledge: Knowledge) -> tuple[bool, bool]:
    """Return whether the subgoals can be brought about one after the other, and whether the whole goal then holds."""
    formulas = read_subgoals(subgoals, there.start)
    goal = None if formulas is None else read_goal({"vh_goal": there.task.record["vh_goal"]}, there.start.home)
    runs = False
    for steps in () if formulas is None else achieved(there.start, formulas, knowledge):
        runs = True
        execution = run(there.start, Program(steps=steps), EVOLVING_GRAPH)
        if goal is not None and execution.failure is None and Progress.of(goal, execution).satisfied:
            return True, True
    return runs, False


def read_subgoals(subgoals: Sequence[str], start: World) -> list[Formula] | None:
    """Return subgoals as formulas; None where one cannot be read or names what the home lacks."""
    found: list[Formula] = []
    try:
        for text in subgoals:
            found.append(read_formula(f"{text}()" if text in ALONE else text))
    except ValueError:
        return None
    for atom in (atom for formula in found for atom in atoms_of(formula)):
        if len(atom.terms) != (0 if atom.name in ALONE else arity(atom.name)):
            return None
        for term in atom.terms:
            name, _, number = term.rpartition(".")
            node = int(number) if number.isdecimal() else -1
            if node not in start.home.index or start.home.classes[start.home.index[node]] != name:
                return None
    return found or None


def achieved(
    start: World, subgoals: Sequence[Formula], knowledge: Knowledge, rules: Rules = EVOLVING_GRAPH
) -> Iterator[tuple[Step, ...]]:
    """Yield the steps of runs in which each subgoal comes true, in their order.

    A subgoal that holds already needs no act; each part of `or` is tried; every act must be done.
    """
    me = _me(start)
    for count, chosen in enumerate(product(*(list(_choices(subgoal)) for subgoal in subgoals))):
        if count >= MOST_CHOICES:
            return
        open_runs = [Run((start,), ())]
        for subgoal in (part for parts in chosen for part in parts):
            further: list[Run] = []
            for done in open_runs[:MOST_BRANCHES]:
                further += _brought_about(done, subgoal, me, knowledge, rules)
            open_runs = further
        for done in open_runs:
            yield tuple(_step(name, terms, knowledge) for name, terms in done.acts)


def _choices(formula: Formula) -> Iterator[list[Formula]]:
    """Yield the atoms and negations of a subgoal, in order, for each choice among the parts of `or`."""
    if isinstance(formula, Atom) or formula.join == "not":
        yield [formula]
    elif formula.join == "or":
        for part in formula.parts:
            yield from _choices(part)
    else:
        for chosen in product(*(list(_choices(part)) for part in formula.parts)):
            yield [atom for parts in chosen for atom in parts]


def _brought_about(done: Run, subgoal: Formula, me: str, knowledge: Knowledge, rules: Rules) -> list[Run]:
    here = Run(done.worlds[-1:], ())
    if fulfilled(subgoal, here):
        return [done]
    if isinstance(subgoal, Compound):
        return []
    found: list[Run] = []
    for way in ways(subgoal, done.worlds[-1], me) if subgoal.name not in ALONE else [[(subgoal.name, ())]]:
        after = _strictly(done, way, knowledge, rules)
        if after is not None and fulfilled(subgoal, Run(after.worlds[-2:], after.acts[-1:])):
            found.append(after)
    return found


def _strictly(done: Run, way: Sequence[Act], knowledge: Knowledge, rules: Rules) -> Run | None:
    """Return a run with further acts; an approach that is not needed is left out."""
    worlds, acts = list(done.worlds), list(done.acts)
    for name, terms in way:
        result = act(worlds[-1], _step(name, terms, knowledge), rules)
        if isinstance(result, World):
            worlds.append(result)
            acts.append((name, terms))
        elif name != "FIND":
            return None
    return Run(worlds, acts)


def shares(verdicts: Sequence[Verdict]) -> tuple[float, float, float, float]:
    """Return per cent of the answers: success and execution by the interface's rules, and the same by ours."""
    count = max(len(verdicts), 1)
    columns = ([v.succeeds for v in verdicts], [v.executed for v in verdicts],
               [v.reaches for v in verdicts], [v.runs for v in verdicts])  # fmt: skip
    success, execution, ours, runs = (round(100 * sum(column) / count, 2) for column in columns)
    return success, execution, ours, runs
