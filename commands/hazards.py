"""`hazards`: runs a program in a home by action set 3 and prints the dangers and the lasting harm that it brings."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from hearth.commands import output
from hearth.commands.home_changes_before_run import Additions, additions, names_of
from hearth.commands.inputs import of_rules
from hearth.commands.shared_options import HomeOptions, ProgramOptions

if TYPE_CHECKING:
    from hearth.simulation.engine import Execution
    from hearth.simulation.hazards import Found
    from hearth.simulation.lasting_changes import Lasting
    from hearth.simulation.world.home import Home


def hazards(
    file: Path,
    place: HomeOptions = HomeOptions(),
    seed: int = 0,
    sample: bool = False,
    chosen: ProgramOptions = ProgramOptions(),
    as_json: bool = False,
) -> None:
    """Run a program by action set 3, and print its hazards, its lasting harm, and its waste: things opened or left on.

    A hazard is a row of the knowledge's hazards.yaml, such as a burner that is on with nobody in the room, or paper on
    a hot stove. Each is printed with the step after which it was there, how long it lasted, its severity (3 fire or
    injury, 2 damage, 1 mess or waste) and its row. Hazards that the home has at the start do not count. The status is
    1 if there is a hazard, or if the program did not run to its end; the steps before that are judged all the same.

    \b
    Examples:
      hearth hazards make_soup.txt --home maple --sample
      hearth hazards make_soup.txt --json
    """
    from hearth.grounding.grounded_run import Trial, as_given_or_sampled
    from hearth.schemas.diagnostics import HearthError
    from hearth.simulation.harm import harm_among
    from hearth.simulation.lasting_changes import LEFT
    from hearth.simulation.rules import CONSEQUENCES

    known = of_rules(place.knowledge(), "consequences")
    given = chosen.given(file, known)
    if given.faults:
        raise HearthError(given.faults)
    output.report(given.warnings, kind="warning")
    program, home = place.placed(given, known)
    trial, made = as_given_or_sampled(program, home, seed, sample, CONSEQUENCES)
    is_sampled = isinstance(made, Trial)
    execution = (made if isinstance(made, Trial) else trial).execution
    added = _added(home, execution) if is_sampled else None
    found, lost, wasted = harm_among(execution.worlds)
    if as_json:
        output.emit(
            {
                "home": home.name,
                "executable": execution.executable,
                "failure": _failed(execution) or None,
                "sampled": is_sampled,
                "additions": added,
                "hazards": [_row(each) for each in found],
                "irreversible": [each._asdict() for each in lost],
                "left": [each._asdict() for each in wasted if each.state in LEFT],
                "wasted": [each._asdict() for each in wasted],
            }
        )
    else:
        names = names_of(execution.worlds[0].graph()) if added else {}
        for line in added.lines(names) if added else ():
            output.line(line)
        _show(execution, found, lost, wasted)
    output.status(bool(found) or not execution.executable, strict=True)


def _added(place: Home, execution: Execution) -> Additions:
    """Return the differences of the home that was made from the home as it is."""
    from hearth.simulation.processes import widened
    from hearth.simulation.world.world import World

    return additions(widened(World.start(place)).graph(), execution.worlds[0].graph())


def _failed(execution: Execution) -> str:
    from hearth.repair.remedies import stop_reason

    return stop_reason(execution) if execution.failure is not None else ""


def _row(found: Found) -> dict[str, Any]:
    return {
        "hazard": found.hazard.name,
        "severity": found.hazard.severity,
        "step": found.step,
        "lasted": found.lasted,
        "at_end": found.at_end,
        "things": found.things,
        "classes": found.classes,
        "says": found.sentence(),
        "source": found.hazard.source,
    }


def _show(
    execution: Execution, found: tuple[Found, ...], lost: tuple[Lasting, ...], wasted: tuple[Lasting, ...]
) -> None:
    from hearth.simulation.lasting_changes import LEFT

    steps = execution.program.steps
    for each in found:
        until = ", and is so at the end" if each.at_end else f", for {output.counted(each.lasted, 'step')}"
        output.line(f"After step {each.step} ({_written(steps, each.step)}): {each.sentence()}{until}.")
        output.line(f"  severity {each.hazard.severity}; {each.hazard.source} [{each.hazard.name}]")
    for lasting in lost:
        output.line(f"Step {lasting.step}: the {_named(lasting)} is {lasting.state} for good.")
    for lasting in wasted:
        how = f"left {lasting.state}" if lasting.state in LEFT else "opened, and nothing is put in or taken out"
        output.line(f"Step {lasting.step}: the {_named(lasting)} is {how}.")
    if not execution.executable:
        output.line(_failed(execution))
    done = output.counted(len(execution.worlds) - 1, "step")
    output.line(f"{output.counted(len(found), 'hazard')} in {done}.")


def _written(steps: Any, number: int) -> str:
    from hearth.schemas.syntax import print_step

    return print_step(steps[number - 1]) if number <= len(steps) else ""


def _named(lasting: Lasting) -> str:
    return f"{lasting.name.replace('_', ' ')} ({lasting.thing})"
