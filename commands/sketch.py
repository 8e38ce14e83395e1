"""`sketch`: separates the steps of the activity from the steps that depend on the environment."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from hearth.commands import output
from hearth.commands.inputs import read_knowledge
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

if TYPE_CHECKING:
    from hearth.analysis.programs_in_homes import Script
    from hearth.analysis.sketch_evaluation import SketchEvaluation
    from hearth.kb.knowledge import Knowledge
    from hearth.simulation.world.home import Home


def sketch(
    sources: list[Path],
    judge: Path | None = None,
    disagreements: bool = False,
    model: str | None = None,
    fit: Path | None = None,
    folds: int = 0,
    homes: Path | None = None,
    kb: Path | None = None,
    seed: int = 0,
    as_json: bool = False,
) -> None:
    """Print the sketches of programs: the steps that do not depend on the environment.

    A sketch has the fewest steps from which, in several homes, repairs still reach the goal of the program, and the
    steps of which only the description speaks. With --judge the sketches are compared with people's. The output then
    has precision, recall and F1 over steps, and those of two baselines, one of which knows the answers. With --model a
    learned model decides: `ours`, fitted on our own annotations, or a file that --fit wrote, fitted on others' on top
    of ours. With --folds it is cross-validated: fitted on some activities, tested on others.

    \b
    Examples:
      hearth sketch watch_tv.txt
      hearth sketch release.zip --judge sketch_annotation.json --disagreements
      hearth sketch release.zip --judge sketch_annotation.json --folds 10
      hearth sketch release.zip --judge sketch_annotation.json --fit people.json
      hearth sketch watch_tv.txt --model people.json
    """
    from hearth.analysis.programs_in_homes import scripts
    from hearth.storage.rejects import Reject

    known = read_knowledge(kb)
    found = list(scripts(map(str, sources), known))
    programs = [one for one in found if not isinstance(one, Reject)]
    if not programs:
        raise HearthError([fault for one in found if isinstance(one, Reject) for fault in one.diagnostics])
    places = _homes(homes, known)
    if fit or folds:
        if judge is None:
            raise typer.BadParameter("the annotations are missing", param_hint="--judge")
        from hearth.commands.sketch_fitting import fitted

        fitted(judge, programs, places, known, model, fit, folds, seed, as_json=as_json)
    elif judge is None:
        _show(programs, places, known, seed, as_json, model)
    else:
        _judge(judge, programs, places, known, seed, as_json=as_json, every=disagreements, model=model)


def _homes(folder: Path | None, known: Knowledge) -> list[Home]:
    from hearth.homes import library
    from hearth.repair.sketch import ENVIRONMENTS
    from hearth.simulation.world.home import Home

    names = library.names(folder)[:ENVIRONMENTS]
    return [Home.from_graph(library.load_graph(name, known, folder), name, known) for name in names]


def _show(
    programs: list[Script], places: list[Home], known: Knowledge, seed: int, as_json: bool, model: str | None
) -> None:
    from hearth.repair.sketch import sketch as inferred
    from hearth.repair.sketch_model import learned_sketch, model_of
    from hearth.schemas.syntax import print_step

    learned = model_of(model) if model else None
    rows = []
    for script in programs:
        keep = inferred(script.program, places, known, seed, script.program_id)
        keep = learned_sketch(script.program, keep, known, learned) if learned else keep
        steps = [print_step(step) for step in script.program.steps]
        rows.append({"program_id": script.program_id, "title": script.program.title, "steps": steps, "keep": keep})
        if not as_json:
            _print_steps(f"{script.program.title or script.program_id}: {sum(keep)} of {len(keep)} steps", steps, keep)
    if as_json:
        output.emit(rows)


def _print_steps(heading: str, steps: list[str], keep: tuple[bool, ...]) -> None:
    output.line(heading)
    for step, kept in zip(steps, keep, strict=True):
        output.line(f"  {'*' if kept else ' '} {step}")


def _judge(
    file: Path, programs: list[Script], places: list[Home], known: Knowledge, seed: int, *, as_json: bool, every: bool,
    model: str | None
) -> None:  # fmt: skip
    from hearth.analysis.sketch_evaluation import annotated, evaluate_sketches
    from hearth.repair.sketch_model import model_of

    learned = model_of(model) if model else None
    found = evaluate_sketches(annotated(file, file.name, programs, known), places, known, seed, learned)
    if not found.rows:
        hint = "give the programs that the sketches are of: the release they were drawn for"
        raise HearthError.of(Code.EMPTY, "no sketch is of one of these programs", file=str(file), suggestion=hint)
    if as_json:
        more = {"disagreements": list(found.disagreements())} if every else {}
        output.emit({**found.summary(), **more})
    else:
        _print_judgement(found, every)


def _print_judgement(found: SketchEvaluation, every: bool) -> None:
    summary: dict[str, Any] = found.summary()
    kinds = ("inferred", "dropping_what_is_by_the_way", "keeping_what_people_usually_keep")
    rows = [
        (kind.replace("_", " "), *(f"{summary[kind][name]:.3f}" for name in ("precision", "recall", "f1")))
        for kind in kinds
    ]
    output.table(("sketch", "precision", "recall", "F1"), rows)
    lengths = ", ".join(f"{name} {value}" for name, value in summary["average_length"].items())
    output.line(f"\n{summary['programs']} programs, {summary['steps']} steps; {summary['alike']} sketches equal.")
    output.line(f"Steps on average: {lengths}.")
    for action, kinds_of in summary["disagreements_by_action"].items():
        output.line(f"  {action:10} {', '.join(f'{kind} {count}' for kind, count in kinds_of.items())}")
    for one in found.disagreements() if every else ():
        output.line(f"\n{one['title']}: {one['description']}")
        for step in one["steps"]:
            output.line(f"  {'*' if step['inferred'] else ' '}{'p' if step['people'] else ' '} {step['step']}")
