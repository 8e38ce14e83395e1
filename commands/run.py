"""`run`: runs a program in a home and prints the changes of each step."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from hearth.commands import output
from hearth.commands.inputs import read_given, read_goals, read_knowledge
from hearth.kb.language.fuzzy import Fuzzy

if TYPE_CHECKING:
    from hearth.grounding.trial import Trial
    from hearth.schemas.failures import Failure
    from hearth.schemas.program import Program
    from hearth.simulation.goals import Progress
    from hearth.simulation.motion.base_pose import HandAndBasePose
    from hearth.simulation.rules import Rules
    from hearth.simulation.world.home import Home
    from hearth.simulation.world.world import World


_SHOWN = 6


def run(
    file: Path,
    home: str = "",
    graph: Path | None = None,
    homes: Path | None = None,
    kb: Path | None = None,
    seed: int = 0,
    as_is: bool = False,
    explain: bool = False,
    goal: list[str] | None = None,
    which: int = 1,
    columns: str = "",
    fuzzy: Fuzzy = Fuzzy.TYPOS,
    strict: bool = False,
    as_json: bool = False,
) -> None:
    """Run a program in a home and print the changes of each step.

    Its objects are bound to nodes of the home if all steps can then run; else an environment is sampled, with missing
    objects added. Prints the binding and the changes of each step. The status is 1 if a step fails, or if a goal is
    not reached: what holds at the end, what was done (`WATCH(television)`), in which order (`then`), or alternatives.

    \b
    Examples:
      python cli.py run watch_tv.txt --home maple --explain
      python cli.py run watch_tv.txt --goal "SITTING(agent) and (LOOKAT or WATCH)"
    """
    from hearth.grounding.trial import attempt
    from hearth.schemas.failures import Failure
    from hearth.simulation.rules import DEFAULT

    known = read_knowledge(kb)
    given = read_given(file, known, which, strict, columns, fuzzy)
    program, place, is_own = given.at_home(home, graph, homes, known)
    trial = attempt(program, place, seed, DEFAULT, default_state=not (as_is or is_own), add=not (as_is or is_own))
    failure = trial if isinstance(trial, Failure) else trial.execution.failure
    progress = None if isinstance(trial, Failure) or not goal else _progress(goal, trial)
    if as_json:
        output.emit(_json(trial, place) | ({"goal": _goal_json(progress)} if progress else {}))
    else:
        _print(program, trial, place, explain)
        if progress:
            print("Goal: reached." if progress.satisfied else f"Goal: not reached; unmet: {progress.unmet()}.")
    output.status(failure is not None or (progress is not None and not progress.satisfied), strict=True)


def _progress(goal: list[str], trial: Trial) -> Progress:
    from hearth.simulation.goals import Progress

    return Progress.of(read_goals(goal, trial.execution.worlds[0].home), trial.execution)


def _goal_json(progress: Progress) -> dict[str, Any]:
    return {"reached": progress.satisfied, "fraction": progress.fraction, "unmet": str(progress.unmet())}


def _print(program: Program, trial: Trial | Failure, place: Home, explain: bool) -> None:
    from hearth.schemas.failures import Failure
    from hearth.simulation.change_summary import summary

    print(f"{program.title or 'A program'}, in {place.name}")
    if isinstance(trial, Failure):
        print(f"  can't be placed there: {trial.message()}")
        return
    _print_binding(trial)
    execution = trial.execution
    poses = _poses(trial) if explain else ()
    for number, tick in enumerate(execution.program.ticks()):
        before = execution.worlds[number]
        if number + 1 == len(execution.worlds):
            assert execution.failure is not None
            print(f"{number + 1:3}  {_tick(tick)}\n     FAILED  {execution.failure.message()}")
            return
        change = execution.worlds[number + 1].changes(before)
        moves = list(_moved(before, execution.worlds[number + 1]))
        said = [summary(change, before)] if change or not moves else []
        print(f"{number + 1:3}  {_tick(tick)}", *said, *moves, sep="\n     ")
        for pose in poses[number] if poses else ():
            print(f"       {_pose(pose)}")
        if explain:
            _print_checks(before, tick, execution.rules)
    print(f"Done: {output.counted(len(execution.worlds) - 1, 'tick')}.")


def _poses(trial: Trial) -> tuple[tuple[HandAndBasePose, ...], ...]:
    """The hand and base pose of the characters for each tick; nothing in homes without geometry."""
    from hearth.simulation.motion.base_pose import hand_and_base_poses

    return hand_and_base_poses(trial.execution)


def _moved(before: World, after: World) -> Iterator[str]:
    """Where each character is that stands or looks elsewhere than before."""
    for number, (old, new) in enumerate(zip(before.agents, after.agents, strict=True)):
        if new.pose is not None and new.pose != old.pose:
            yield f"character {number} at ({new.pose.x:.2f}, {new.pose.z:.2f}) m, facing {new.pose.yaw:.0f} degrees"


def _pose(found: HandAndBasePose) -> str:
    x, z, yaw = found.pose
    hand = f", {found.hand} hand" if found.hand else ""
    return f"character {found.agent} at ({x:.2f}, {z:.2f}) m, facing {yaw:.0f} degrees{hand}"


def _tick(tick: tuple[Any, ...]) -> str:
    from hearth.schemas.syntax import print_step

    return " | ".join(print_step(step, show_agent=len(tick) > 1) for step in tick)


def _print_binding(trial: Trial) -> None:
    world = trial.execution.worlds[0]
    if trial.environment is not None:
        assert trial.refused is not None
        added = {node.id for node in trial.environment.nodes}
        print(f"  sampled, because the home alone does not suffice: {trial.refused.message()}")
    else:
        added = set()
    for ref in trial.execution.program.objects():
        index = world.home.index.get(ref.node or -1, -1)
        what = f"{world.home.classes[index]} ({ref.node})" if index >= 0 else "nothing"
        print(f"  <{ref.name}> ({ref.instance}) is {what}{', added' if ref.node in added else ''}")


def _print_checks(world: World, tick: tuple[Any, ...], rules: Rules) -> None:
    from hearth.simulation.explain import checks

    for step in tick:
        for check in checks(world, step, rules):
            print(f"       {check.literal}{'  by  ' + check.by if check.by else ''}")


def _json(trial: Trial | Failure, place: Home) -> dict[str, Any]:
    from hearth.datasets.format.codecs import change_row
    from hearth.schemas.failures import Failure
    from hearth.schemas.syntax import print_step

    if isinstance(trial, Failure):
        return {"home": place.name, "executable": False, "failure": trial}
    execution = trial.execution
    changes = [change_row(change) for change in execution.changes()]
    return {
        "home": place.name,
        "executable": execution.executable,
        "failure": execution.failure,
        "sampled": trial.environment is not None,
        "added_nodes": trial.environment.nodes if trial.environment else [],
        "binding": {f"{ref.name} ({ref.instance})": ref.node for ref in execution.program.objects()},
        "steps": [print_step(step) for step in execution.program.steps],
        "changes": changes,
        "stances": _poses(trial),
    }
