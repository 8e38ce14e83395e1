"""A run as text and as JSON: the changes of each step, the reason why it stopped, and the fix."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict
from typing import TYPE_CHECKING, Any, NamedTuple

from hearth.commands import output
from hearth.commands.failure_output import failure_document
from hearth.commands.home_changes_before_run import Additions, additions, names_of

if TYPE_CHECKING:
    from hearth.grounding.grounded_run import Trial
    from hearth.schemas.failures import Code
    from hearth.schemas.graph import EnvironmentGraph
    from hearth.schemas.program import Program, Step
    from hearth.simulation.engine import Execution
    from hearth.simulation.motion.base_pose import HandAndBasePose
    from hearth.simulation.step_explanations import Check
    from hearth.simulation.world.home import Home
    from hearth.simulation.world.world import World


SAMPLE = "`--sample` adds what is missing, and prints all of it."
"""Advice of a run in which an object was missing."""

NOTHING_ADDED = "Nothing was added: the program runs in the home as it is."
"""Said where `--sample` had nothing to do."""


class Outcome(NamedTuple):
    """A run in a home.

    Attributes:
        program: as it was given.
        place: the home as it is.
        trial: the run that is shown.
        as_it_is: why the program did not run in the home as it is, where another start was sampled; else "".
        unsampled: why no other start could be sampled, where one was wanted; else "".
        unsampled_code: the code of that.
        sampling: whether `--sample` was given; then no output advises it.
    """

    program: Program
    place: Home
    trial: Trial
    as_it_is: str = ""
    unsampled: str = ""
    unsampled_code: Code | None = None
    sampling: bool = False

    def additions(self) -> Additions:
        """Return the additions of the start to the home, and the other changes."""
        return additions(*self._starts())

    def added_lines(self) -> Iterator[str]:
        """Yield the additions as text."""
        return self.additions().lines(names_of(*self._starts()))

    def _starts(self) -> tuple[EnvironmentGraph, EnvironmentGraph]:
        """Return the home as it is, and the start of the run."""
        from hearth.simulation.world.world import World

        return World.start(self.place).graph(), self.trial.execution.worlds[0].graph()


def show(outcome: Outcome, explain: bool) -> None:
    """Print a run: the binding, each step with its changes, and at the end why it stopped."""
    from hearth.repair.remedies import stop_reason

    output.line(f"{outcome.program.title or 'A program'}, in {outcome.place.name}")
    execution = outcome.trial.execution
    if outcome.as_it_is:
        output.line(f"  as it is, {outcome.as_it_is}")
    elif outcome.sampling and execution.failure is None:
        output.line(f"  {NOTHING_ADDED}")
    for line in outcome.added_lines():
        output.line(f"  {line}")
    _print_binding(execution)
    _print_steps(execution, explain)
    done = sum(len(steps) for steps in _ticks(execution)[: len(execution.worlds) - 1])
    if execution.failure is None:
        output.line(f"Done: {output.counted(done, 'step')}.")
        return
    output.line(stop_reason(execution))
    if _sampling_helps(outcome):
        output.line(SAMPLE)
    if outcome.unsampled:
        output.line(f"Sampling does not help: {outcome.unsampled}")
    if advice := _other_rules(outcome):
        output.line(advice)
    left = len(execution.program.steps) - len(_reached(execution))
    if left > 0:
        output.line(f"{output.counted(left, 'later step')} {'was' if left == 1 else 'were'} not run.")


def document(outcome: Outcome, explain: bool) -> dict[str, Any]:
    """Return a run for machines. Steps are counted from 1, ticks from 0."""
    from hearth.datasets.format.row_conversion import change_row
    from hearth.schemas.syntax import print_step

    execution, found = outcome.trial.execution, outcome.additions()
    sampled = outcome.trial.environment
    return {
        "home": outcome.place.name,
        "executable": execution.executable,
        "failure": _failure(outcome),
        "sampled": bool(outcome.as_it_is),
        "as_it_is": outcome.as_it_is or None,
        "not_sampled": outcome.unsampled or None,
        "added": {name: len(items) for name, items in found._asdict().items()},
        "additions": found,
        "added_nodes": sampled.nodes if sampled else [],
        "binding": {f"{ref.name} ({ref.instance})": ref.node for ref in execution.program.objects()},
        "steps": [print_step(step) for step in execution.program.steps],
        "changes": [change_row(change) for change in execution.changes()],
        "stances": _poses(execution),
        **({"checks": list(_explained(execution))} if explain else {}),
    }


def _sampling_helps(outcome: Outcome) -> bool:
    """Return whether an object is missing that `--sample` may add, and the option is not given already."""
    from hearth.schemas.failures import Code

    failure = outcome.trial.execution.failure
    if failure is None or failure.code != Code.UNBOUND or outcome.sampling:
        return False
    return failure.actual == "it has none" or failure.actual.startswith("other objects")


def _other_rules(outcome: Outcome) -> str:
    """Return which rules simulate an action that stopped the run or its sampling; empty where none would."""
    from hearth.schemas.failures import Code

    execution = outcome.trial.execution
    codes = {execution.failure.code if execution.failure else None, outcome.unsampled_code}
    if Code.NOT_SIMULATED not in codes or execution.rules.consequences:
        return ""
    actions = execution.worlds[0].home.knowledge.actions
    used = dict.fromkeys(step.action for step in execution.program.steps)
    later = [name for name in used if name in actions and not actions[name].executed and actions[name].later]
    named = ", ".join(f"[{name}]" for name in later)
    verb, object_ = ("is", "it") if len(later) == 1 else ("are", "them")
    return (
        f"Under these rules {named} {verb} not simulated; `--rules consequences` simulates {object_}." if later else ""
    )


def _failure(outcome: Outcome) -> dict[str, Any] | None:
    from hearth.repair.remedies import remedy, stop_reason
    from hearth.schemas.failure_words import why

    execution = outcome.trial.execution
    failure = execution.failure
    if failure is None:
        return None
    advice = remedy(execution) or _other_rules(outcome) or (SAMPLE if _sampling_helps(outcome) else None)
    words = {"message": stop_reason(execution), "why": why(failure), "remedy": advice}
    return {**(failure_document(failure, execution.program) or {}), **words}


def _explained(execution: Execution) -> Iterator[dict[str, Any]]:
    number = 1
    for tick, steps in enumerate(_ticks(execution)):
        if tick == len(execution.worlds):
            return
        for step in steps:
            yield {"step": number, "tick": tick, "checks": [asdict(check) for check in _checks(execution, tick, step)]}
            number += 1


def _ticks(execution: Execution) -> list[tuple[Step, ...]]:
    return list(execution.program.ticks())


def _reached(execution: Execution) -> list[Step]:
    """Return the steps that were done, and those of the tick that failed."""
    return [step for steps in _ticks(execution)[: len(execution.worlds)] for step in steps]


def _print_binding(execution: Execution) -> None:
    home = execution.worlds[0].home
    for ref in execution.program.with_steps(_reached(execution)).objects():
        index = home.index.get(ref.node or -1, -1)
        what = f"{home.classes[index]} ({ref.node})" if index >= 0 else "not bound"
        output.line(f"  <{ref.name}> ({ref.instance}) is {what}")


def _print_steps(execution: Execution, explain: bool) -> None:
    poses = _poses(execution) if explain else ()
    number = 1
    for tick, steps in enumerate(_ticks(execution)):
        output.line(f"{number:3}  {_text(steps)}")
        if tick + 1 == len(execution.worlds):
            output.line("     FAILED")
            if explain:
                _print_fault(execution, steps)
            return
        _print_changes(execution.worlds[tick], execution.worlds[tick + 1])
        for pose in poses[tick] if poses else ():
            output.line(f"       {_pose(pose)}")
        if explain:
            for step in steps:
                _print_checks(_checks(execution, tick, step))
        number += len(steps)


def _print_changes(before: World, after: World) -> None:
    from hearth.simulation.change_summary import summary

    change, moves = after.changes(before), list(_moved(before, after))
    said = [summary(change, before)] if change or not moves else []
    for line in (*said, *moves):
        output.line(f"     {line}")


def _print_fault(execution: Execution, steps: tuple[Step, ...]) -> None:
    """Print the checks of the steps that were to be done, the one that failed, and the facts in the world."""
    from hearth.simulation.step_explanations import facts

    failure = execution.failure
    assert failure is not None
    for step in steps:
        _print_checks(_checks(execution, len(execution.worlds) - 1, step))
    nodes = (*failure.objects, *(ref.node for step in steps for ref in step.objects if ref.node is not None))
    if failure.agent < len(execution.final.agents):
        for line in facts(execution.final, failure.agent, nodes):
            output.line(f"         {line}")
    for ref in (ref for step in steps for ref in step.objects if ref.node is None):
        output.line(f"         {_looked_for(execution.final.home, ref.name)}")


def _looked_for(home: Home, name: str) -> str:
    """Return the classes that a name stands for, and the nodes of a home that have one of them."""
    names = home.knowledge.found_as(name)
    nodes = [(cls, node) for cls, node in zip(home.classes, home.ids, strict=True) if cls in names]
    found = ", ".join(f"{cls} ({node})" for cls, node in nodes[:_MOST_NODES])
    more = f" and {len(nodes) - _MOST_NODES} more" if len(nodes) > _MOST_NODES else ""
    return f"looked for {', '.join(names)}: {f'found {found}{more}; none fits' if nodes else f'{home.name} has none'}"


_MOST_NODES = 6


def _checks(execution: Execution, tick: int, step: Step) -> list[Check]:
    from hearth.simulation.step_explanations import checks, checks_until

    world, failure = execution.worlds[tick], execution.failure
    if failure is None or tick != failure.tick:
        return list(checks(world, step, execution.rules))
    return list(checks_until(world, step, execution.rules, failure)) if step.agent == failure.agent else []


def _print_checks(found: list[Check]) -> None:
    for check in found:
        if check.held:
            output.line(f"       {check.literal}{'  by  ' + check.by if check.by else ''}")
        else:
            output.line(f"     x {check.literal}  does not hold:")


def _poses(execution: Execution) -> tuple[tuple[HandAndBasePose, ...], ...]:
    """Return the hand and base pose of the characters for each tick; nothing in homes without geometry."""
    from hearth.simulation.motion.base_pose import hand_and_base_poses

    return hand_and_base_poses(execution)


def _moved(before: World, after: World) -> Iterator[str]:
    """Yield where each character is that stands or looks elsewhere than before."""
    for number, (old, new) in enumerate(zip(before.agents, after.agents, strict=True)):
        if new.pose is not None and new.pose != old.pose:
            yield f"character {number} at ({new.pose.x:.2f}, {new.pose.z:.2f}) m, facing {new.pose.yaw:.0f} degrees"


def _pose(found: HandAndBasePose) -> str:
    x, z, yaw = found.pose
    hand = f", {found.hand} hand" if found.hand else ""
    return f"character {found.agent} at ({x:.2f}, {z:.2f}) m, facing {yaw:.0f} degrees{hand}"


def _text(steps: tuple[Step, ...]) -> str:
    from hearth.schemas.syntax import print_step

    return " | ".join(print_step(step, show_agent=len(steps) > 1) for step in steps)
