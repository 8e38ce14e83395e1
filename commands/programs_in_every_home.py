"""`sample SOURCE`: runs every program in every home and reports the failures."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any

from hearth.commands import output

if TYPE_CHECKING:
    from hearth.analysis.programs_in_homes import Coverage, Script
    from hearth.pipelines.engine.build_homes import Homes
    from hearth.schemas.failures import Failure


def show(sources: Sequence[Path], settings: Mapping[str, Any], *, size: int | None, limit: int | None, strict: bool,
         as_json: bool) -> None:  # fmt: skip
    """Run and print; with `strict` the status is 1 if a pair failed that is not proven impossible."""
    from hearth.analysis.programs_in_homes import measure_coverage, scripts
    from hearth.commands.progress_line import bar, watched
    from hearth.grounding.environments.sampling import Size
    from hearth.pipelines.engine.build_homes import Homes
    from hearth.pipelines.engine.settings import Settings
    from hearth.pipelines.engine.user_overlays import of_new_dataset

    homes = Homes(of_new_dataset(Settings(**settings)))
    programs = islice(scripts(map(str, sources), homes.knowledge), limit)
    wanted = Size() if size is None else Size.about(size)
    with bar("programs tried") as seen:
        found = measure_coverage(watched(programs, seen, limit), homes, homes.names(), settings["seed"], wanted)
    if as_json:
        pairs = {"impossible": list(_impossible(found, homes)), "failures": list(_failures(found))}
        output.emit({**found.summary(), **pairs})
    else:
        figures = {**found.summary(), "homes": len(found.homes)}
        figures["failures_by_code"] = ", ".join(f"{k} {n:,}" for k, n in figures["failures_by_code"].items()) or "none"
        output.figures(figures)
        for one in (*_impossible(found, homes), *_failures(found)):
            output.line(f"{one['place']} in {one['home']}: {one['message']}")
    output.status(len(found.failed), strict=strict)


def _impossible(found: Coverage, homes: Homes) -> Iterator[dict[str, Any]]:
    from hearth.analysis.programs_in_homes import ANY_HOME
    from hearth.grounding.preconditions.precondition_inference import at_odds

    for script, where, failure in found.impossible:
        steps = at_odds(script.program, homes.knowledge) if where == ANY_HOME else (failure.tick,)
        yield _row(script, where, failure, steps)


def _failures(found: Coverage) -> Iterator[dict[str, Any]]:
    for script, home, failure in found.failed:
        yield _row(script, home, failure, (min(failure.tick, len(script.program.steps) - 1),))


def _row(script: Script, home: str, failure: Failure, steps: Sequence[int]) -> dict[str, Any]:
    """Return the reason why a program does not run, with the lines of the steps that contradict each other."""
    from hearth.schemas.failure_words import in_program

    return {
        "program": script.program_id,
        "place": script.place,
        "home": home,
        "code": str(failure.code),
        "steps": [{"step": number + 1, "line": script.program.line(number)} for number in steps],
        "expected": failure.expected,
        "actual": failure.actual,
        "message": in_program(failure, script.program),
    }
