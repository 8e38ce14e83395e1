"""`run`: runs a program in a home and prints the changes of each step."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import typer

from hearth.commands import output
from hearth.commands.inputs import Given, of_rules, read_goals, read_rules
from hearth.commands.run_output import Outcome, document, show
from hearth.commands.shared_options import HomeOptions, ProgramOptions
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code, Failure

if TYPE_CHECKING:
    from hearth.grounding.grounded_run import Trial
    from hearth.schemas.program import Program
    from hearth.simulation.goals import Progress
    from hearth.simulation.rules import Rules
    from hearth.simulation.world.home import Home


def run(
    file: Path,
    place: HomeOptions = HomeOptions(),
    seed: int = 0,
    sample: bool = False,
    as_is: bool = False,
    explain: bool = False,
    goal: list[str] | None = None,
    chosen: ProgramOptions = ProgramOptions(),
    skip_faults: bool = False,
    strict: bool = False,
    rules: Literal["auto", "default", "replay", "evolving_graph", "consequences"] = "auto",
    as_json: bool = False,
) -> None:
    """Run a program in a home as it is, and print the changes of each step.

    Its objects are bound to nodes of the home so that as many steps as possible run. A step that fails ends the
    run: the output says why and names a fix. With --sample the home is changed and filled until the program runs,
    and the additions are printed; things are where lines take them from (`the milk out of the fridge`). The status
    is 1 if the program did not run as given, or if a goal is not reached: a literal at the end, an action
    (`WATCH(television)`), an order (`then`), or alternatives.

    Actions are read by --rules: ours (default), those of the release of 2018 (replay), those of VirtualHome 2.x
    (evolving_graph), or action set 3 (consequences: food is used up, and heat and water work in time). By
    evolving_graph the contents of an opened thing are within reach of a character next to it, and a room only walked
    into is not. `auto` chooses it for a graph in which no two things are CLOSE, and ours for any other home.

    \b
    Examples:
      hearth run watch_tv.txt --home maple --explain
      hearth run watch_tv.txt --goal "SITTING(agent) and (LOOKAT or WATCH)"
    """
    _check(sample, as_is, skip_faults, strict)
    known = of_rules(place.knowledge(), rules)
    given = chosen.given(file, known)
    _refuse_faults(given, skip_faults, strict)
    program, home = place.placed(given, known)
    outcome = _outcome(program, home, seed, sample, read_rules(rules, home), given.sources)
    progress = _progress(goal, outcome) if goal else None
    if as_json:
        goals = {"goal": _goal_json(progress)} if progress else {}
        skipped = [{"line": fault.line, "code": fault.code, "message": fault.message} for fault in given.faults]
        output.emit({**document(outcome, explain), "skipped": skipped, **goals})
    else:
        show(outcome, explain)
        if progress:
            output.line("Goal: reached." if progress.satisfied else f"Goal: not reached; unmet: {progress.unmet()}.")
    failure = outcome.trial.execution.failure
    not_reached = progress is not None and not progress.satisfied
    output.status(failure is not None or not_reached or bool(given.faults), strict=True)


def _check(sample: bool, as_is: bool, skip_faults: bool, strict: bool) -> None:
    """Refuse options that contradict each other."""
    if sample and as_is:
        raise typer.BadParameter("`--as-is` adds nothing: leave one of the two out", param_hint="--sample")
    if skip_faults and strict:
        raise typer.BadParameter("`--strict` skips nothing: leave one of the two out", param_hint="--skip-faults")


def _refuse_faults(given: Given, skip: bool, strict: bool) -> None:
    """Print warnings, and the faults that are skipped.

    Raises:
        HearthError: every fault, unless they are skipped and there are other steps; every corrected step if `strict`.
    """
    fuzzy = [each for each in given.warnings if each.code == Code.FUZZY_MATCH]
    if strict and fuzzy:
        raise HearthError([*given.faults, *fuzzy])
    steps = output.counted(len(given.program.steps), "other step")
    if given.faults and not (skip and given.program.steps):
        if given.program.steps:
            output.note(f"Nothing was run; `--skip-faults` leaves these lines out and runs the {steps}.")
        raise HearthError(given.faults)
    from hearth.commands.grouped_faults import in_order

    output.report(in_order((*given.faults, *given.warnings)), kind="warning")
    if given.faults:
        lines = output.counted(len({fault.line for fault in given.faults}), "line")
        output.note(f"Left out: {lines}. The status is 1: the program does not run as given.")


def _outcome(
    program: Program, place: Home, seed: int, sample: bool, rules: Rules, sources: tuple[tuple[int, str], ...] = ()
) -> Outcome:
    """Return the run in the home as it is; if that stops and `sample` is True, the run in a home made for it."""
    from hearth.grounding.grounded_run import as_given_or_sampled
    from hearth.repair.remedies import stop_reason
    from hearth.schemas.failure_words import in_program

    trial, found = as_given_or_sampled(program, place, seed, sample, rules, sources)
    if found is None:
        return Outcome(program, place, trial, sampling=sample)
    if isinstance(found, Failure):
        return Outcome(program, place, trial, "", in_program(found, program), found.code, True)
    _note_elsewhere(found, program.unbound(), sources, place)
    return Outcome(program, place, found, as_it_is=stop_reason(trial.execution), sampling=True)


def _note_elsewhere(made: Trial, program: Program, sources: tuple[tuple[int, str], ...], home: Home) -> None:
    """Say which things are not where the lines of their steps take them from, in the home that was made."""
    from hearth.grounding.preconditions.source_places import source_conditions

    held = {each.literal for each in made.environment.conditions} if made.environment else set()
    for number, place in sources:
        wanted = source_conditions(program, [(number, place)], home.knowledge)
        if any(each.literal not in held for each in wanted):
            output.note(f"Step {number + 1} takes its thing from elsewhere: no start was found with it at <{place}>.")


def _progress(goal: list[str], outcome: Outcome) -> Progress:
    from hearth.simulation.goals import Progress

    execution = outcome.trial.execution
    return Progress.of(read_goals(goal, execution.worlds[0].home), execution)


def _goal_json(progress: Progress) -> dict[str, Any]:
    return {"reached": progress.satisfied, "fraction": progress.fraction, "unmet": str(progress.unmet())}
