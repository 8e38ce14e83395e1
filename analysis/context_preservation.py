"""The check that augmented programs do the steps of their originals in the circumstances of the originals.

Both are run again from a dataset. Which steps a program has kept is found anew, from the steps alone: nothing that
repairing recorded is used.
"""

from collections import Counter
from collections.abc import Iterator, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

from hearth.datasets.dataset import Dataset
from hearth.datasets.format.case_rows import rerun
from hearth.datasets.format.row_conversion import bindings_of
from hearth.datasets.format.stored_cases import stored_cases
from hearth.datasets.verify import opened
from hearth.grounding.preconditions.postconditions import Postconditions, missing, nodes_of
from hearth.repair.step_context import circumstances
from hearth.schemas.literals import Key
from hearth.schemas.program import Program, Step
from hearth.simulation.engine import Execution
from hearth.simulation.world.states import LYING, SITTING
from hearth.storage.parallel import Seen, spread, unseen

SHARE = 200
"""Programs per unit of work."""

_PAIRS = """
    SELECT c.execution_id, own.execution_id AS original_id, o.bindings
    FROM executions c JOIN programs p USING (program_id)
    JOIN (SELECT * FROM executions WHERE executable AND environment_id NOT IN
            (SELECT environment_id FROM perturbations)) own ON own.program_id = p.parent_id AND own.home = c.home
    LEFT JOIN executions o ON o.environment_id = c.environment_id AND o.program_id = p.parent_id
    WHERE p.origin = 'augmented' AND c.executable ORDER BY own.execution_id, c.execution_id"""
"""Executions of augmented programs, with that of the original in its own environment, and its bindings in theirs."""

_PARTS = ("seated", "otherwise")

Pair = tuple[str, str, list[Any] | None]


class Found(NamedTuple):
    """The result for some programs.

    Attributes:
        counts: `programs`, and those that do all they have kept in the same circumstances (`programs as_original`); and
            the same of the `steps` that they have kept.
        seats: for each action, the programs that do it and whose original does it seated (`seated`), and those that
            never do it seated (`otherwise`): a person who types standing, and then sits down, has done something else.
        odd: programs with a step in other circumstances.
    """

    counts: Counter[str]
    seats: Counter[tuple[str, str]]
    odd: list[str]


def measure(dataset: Path, workers: int = 1, seen: Seen = unseen) -> dict[str, Any]:
    """Run every augmented program of a dataset and its original, and count the steps done in the same circumstances.

    Args:
        dataset: its folder.
        workers: processes.
        seen: reports the progress.

    Returns:
        `programs` and `steps` with how many are in the original's circumstances (`as_original`) and their `share`, None
        of none; `seats`, by action; `odd`, ids of the programs with a step in other circumstances.
    """
    pairs: list[Pair] = Dataset.open(dataset).rows(_PAIRS)[1]
    jobs = [(str(dataset), pairs[start : start + SHARE]) for start in range(0, len(pairs), SHARE)]
    found = list(spread(_measured, jobs, workers, seen))
    counts = sum((each.counts for each in found), Counter[str]())
    seats = sum((each.seats for each in found), Counter[tuple[str, str]]())

    def share(what: str) -> dict[str, float | None]:
        every, kept = counts[what], counts[f"{what} as_original"]
        return {"all": every, "as_original": kept, "share": round(kept / every, 6) if every else None}

    return {
        "programs": share("programs"),
        "steps": share("steps"),
        "seats": {action: {part: seats[action, part] for part in _PARTS} for action in sorted({a for a, _ in seats})},
        "odd": [name for each in found for name in each.odd],
    }


def _measured(job: tuple[str, list[Pair]]) -> Found:
    folder, pairs = job
    dataset, homes = opened(folder)
    names = {name for pair in pairs for name in pair[:2]}
    cases = {case["execution_id"]: case for case in stored_cases(dataset, sorted(names))}

    @lru_cache(maxsize=4)  # pairs of one original follow one another
    def original(name: str) -> tuple[Execution, tuple[Postconditions, ...]]:
        execution = rerun(cases[name], homes)
        return execution, circumstances(execution)

    found = Found(Counter(), Counter(), [])
    for name, original_id, bindings in pairs:
        execution = rerun(cases[name], homes)
        before, wanted = original(original_id)
        nodes = {**bindings_of(bindings or []), **nodes_of(execution.program, execution.worlds[0])}
        kept, as_original = _kept(before.program, wanted, execution, nodes)
        found.counts.update({"programs": 1, "steps": kept, "steps as_original": as_original})
        found.counts["programs as_original"] += kept == as_original
        found.seats.update(_seats(before, execution))
        found.odd.extend([cases[name]["program_id"]] * (kept > as_original))
    return found


def _kept(
    program: Program, wanted: Sequence[Postconditions], execution: Execution, nodes: dict[Key, int]
) -> tuple[int, int]:
    """Return (steps of the original that a program has, those that it does as the original does).

    Two longest common subsequences: of the steps, and of the steps done in the same circumstances.
    """
    worlds = [world for world, steps in zip(execution.worlds, execution.program.ticks(), strict=False) for _ in steps]
    equal, same = [], []
    for step, facts in zip(program.steps, wanted, strict=True):
        known = tuple(fact for fact in facts if nodes.keys() >= set(fact.terms))
        equal.append([_is_step(step, other) for other in execution.program.steps])
        same.append([one and not missing(known, nodes, at) for one, at in zip(equal[-1], worlds, strict=True)])
    return _longest(equal), _longest(same)


def _is_step(one: Step, other: Step) -> bool:
    return one.action == other.action and one.agent == other.agent and _keys(one) == _keys(other)


def _keys(step: Step) -> list[Key]:
    return [ref.key for ref in step.objects]


def _longest(matches: Sequence[Sequence[bool]]) -> int:
    """Length of the longest common subsequence, given which elements match."""
    row = [0] * (len(matches[0]) + 1) if matches else [0]
    for line in matches:
        above = row
        row = [0]
        for number, match in enumerate(line):
            row.append(above[number] + 1 if match else max(row[-1], above[number + 1]))
    return row[-1]


def _seats(original: Execution, execution: Execution) -> Iterator[tuple[str, str]]:
    """Yield for each action that the original does seated: `seated`, and `otherwise` if the program never does so."""
    seated = _done_seated(execution)
    for action in sorted(_done_seated(original) & {step.action for step in execution.program.steps}):
        yield action, "seated"
        if action not in seated:
            yield action, "otherwise"


def _done_seated(execution: Execution) -> set[str]:
    """Return the actions done sitting or lying."""
    done = zip(execution.worlds, execution.program.ticks(), strict=False)
    return {
        step.action
        for world, steps in done
        for step in steps
        if (world.states[SITTING] | world.states[LYING]) & world.agents[step.agent].bit
    }
