"""`environment`: preconditions of programs, sampled environments, and their distribution."""

from __future__ import annotations

from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from hearth.commands import inputs, output
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code, Failure

if TYPE_CHECKING:
    from hearth.pipelines.engine.build_homes import Homes as AllHomes

app = typer.Typer(
    no_args_is_help=True,
    add_completion=False,
    help="Preconditions of programs, sampled environments, and their distribution.",
)


@app.command()
def conditions(file: Path, kb: Path | None = None, as_json: bool = False) -> None:
    """Print the preconditions of a program, step by step, next to those of the release's rules.

    \b
    Example:
      hearth environment conditions watch_tv.txt
    """
    from hearth.grounding.preconditions.precondition_inference import at_odds, infer
    from hearth.grounding.preconditions.release_rules import compare
    from hearth.schemas.failure_words import in_program
    from hearth.schemas.syntax import print_step

    known = inputs.read_knowledge(kb)
    program = inputs.read_program(file, known)
    found = infer(program, known)
    if isinstance(found, Failure):
        steps = [
            {"step": n + 1, "line": program.line(n), "text": print_step(program.steps[n])}
            for n in at_odds(program, known)
        ]
        if as_json:
            output.emit({"impossible": in_program(found, program), "steps": steps})
        else:
            output.line(in_program(found, program))
            for step in steps:
                output.line(f"  step {step['step']}, line {step['line']}: {step['text']}")
        output.status(1, strict=True)
        return
    ours = [{"step": c.step + 1, "condition": str(c), "needed": c.hard} for c in found]
    theirs = [{"condition": str(c.condition), "ours": c.ours, "why": c.why} for c in compare(program, found, known)]
    if as_json:
        output.emit({"conditions": ours, "release_rules": theirs})
        return
    output.table(("step", "condition", "because"), [
        (o["step"], o["condition"], "the step needs it" if o["needed"] else "it is usual")
        for o in ours])  # fmt: skip
    output.line()
    output.table(("by the release's rules", "among ours"), [(t["condition"], t["why"] or "yes") for t in theirs])


@app.command()
def rules(source: Path, limit: int | None = None, as_json: bool = False) -> None:
    """Compare the preconditions of all programs with those of the release's rules, by kind.

    `not needed`: every step runs without it. `refused`: a step fails with it. `missed`: only ours.
    `environment conditions` compares them for one program, step by step.

    \b
    Example:
      hearth environment rules release.zip
    """
    from hearth.analysis.precondition_agreement import agreement
    from hearth.analysis.programs_in_homes import scripts

    known = inputs.read_knowledge(None)
    found = agreement(islice(scripts([str(source)], known), limit), known)
    if as_json:
        output.emit(found)
        return
    rows = found["conditions"]
    output.table(tuple(name.replace("_", " ") for name in rows[0]) if rows else ("condition",),
                 [tuple(row.values()) for row in rows])  # fmt: skip
    output.line(f"{found['programs']} programs, {found['impossible']} impossible")


@app.command("sample")
def sample_one(
    file: Path | None = None,
    goal: list[str] | None = None,
    home: str = "maple",
    homes: Path | None = None,
    kb: Path | None = None,
    nodes: int | None = None,
    seed: int = 0,
    out: Path | None = None,
    as_json: bool = False,
) -> None:
    """Sample one environment: for a program, for a goal that can be reached and is not met, or for neither.

    A goal counts up to nine objects of a class; --goal may be given several times.

    \b
    Examples:
      hearth environment sample watch_tv.txt --home maple --out tv.json
      hearth environment sample --goal "ON(plate, kitchen_table): 9" --goal "CLEAN(stove)" --nodes 290
      hearth environment sample --home birch --seed 7 --out any.json
    """
    from hearth.commands import sampled_environment
    from hearth.homes import home_export

    known = inputs.read_knowledge(kb)
    place = inputs.read_home(home, None, homes, known)
    program = None if file is None else inputs.read_program(file, known)
    drawn = sampled_environment.draw(program, goal or (), place, seed, nodes)
    graph = drawn.world.graph()
    if out is not None:
        home_export.write_release(graph, out)
    nodes_found, edges = len(graph.nodes), len(graph.edges)
    if as_json:
        output.emit({"home": home, "seed": seed, "nodes": nodes_found, "edges": edges, "file": out, **drawn.facts})
        return
    output.line(f"{nodes_found:,} nodes, {edges:,} edges" + (f"; {out}" if out else ""))
    for name in ("objects", "conditions", "goal"):
        output.records(drawn.facts.get(name) or ())


@app.command()
def realism(
    source: Path,
    out: Path | None = None,
    home: list[str] | None = None,
    homes: Path | None = None,
    seed: int = 0,
    limit: int | None = None,
    as_json: bool = False,
) -> None:
    """Compare the places and states of sampled objects with those of a release's stored start graphs (figure B-4).

    The distance of two distributions is 0 if they are equal and 1 if they are disjoint. The release places most added
    objects neither on nor in anything, so the distance is also given without those objects.

    \b
    Example:
      hearth environment realism release.zip --out realism
    """
    from hearth.analysis import object_distribution as report

    found = _homes(home, homes)
    theirs, their_states = report.observed(source, found.knowledge, limit)
    ours, our_states = report.sampled(source, found, found.names(), seed, limit)
    places, states = report.distances(theirs, ours), report.distances(their_states, our_states)
    if out is not None:
        out.mkdir(parents=True, exist_ok=True)
        (out / "release.svg").write_text(report.heat_map(theirs, "Start graphs of the release"), encoding="utf-8")
        (out / "sampled.svg").write_text(report.heat_map(ours, "Sampled environments"), encoding="utf-8")
    held = report.distances(report.held(theirs), report.held(ours))
    means = {"places": report.overall(places), "places_held": report.overall(held), "states": report.overall(states)}
    if as_json:
        output.emit({**means, "places_by_class": places, "states_by_class": states, "files": out})
        return
    for what, by_class in (("places", places), ("states", states)):
        output.table((what, "distance", "in the release", "sampled"), [(k, *row) for k, row in by_class.items()])
        output.line(f"{what}: {means[what]} on average\n")
    output.line(f"places of objects on or in something in both: {means['places_held']} on average")


@app.command()
def diversity(
    file: Path,
    home: str = "maple",
    homes: Path | None = None,
    samples: int = 1000,
    seed: int = 0,
    as_json: bool = False,
) -> None:
    """Count the different environments among several samples for one program.

    \b
    Example:
      hearth environment diversity watch_tv.txt --home maple --samples 1000
    """
    from hearth.analysis import object_distribution as report

    found = _homes([home], homes)
    found.names()
    figures = report.diversity(inputs.read_program(file, found.knowledge), found, home, samples, seed)
    if as_json:
        output.emit({"home": home, **figures})
    else:
        output.figures({name: str(value) for name, value in figures.items()})


@app.command()
def preconditions(
    source: Path,
    classes: list[str] | None = None,
    dataset: Path | None = None,
    drawing: Path | None = None,
    limit: int | None = None,
    as_json: bool = False,
) -> None:
    """Print the distribution of the preconditions on some classes, before and after augmenting (figure 5-4).

    \b
    Examples:
      hearth environment preconditions release.zip --class cup --class sauce_pan --out data_out
      hearth environment preconditions release.zip --drawing bars.svg
    """
    from hearth.analysis import object_distribution as report

    names = classes or ["cup", "sauce_pan"]
    groups = {"programs": report.of_programs(source, inputs.read_knowledge(None), names, limit)}
    for stage in ("sample", "augment"):
        if dataset is not None and (dataset / stage).is_dir():
            groups[stage] = report.of_cases(dataset / stage, names)
    if drawing is not None:
        _svg(drawing, report.bar_chart(groups, names))
    if as_json:
        output.emit(
            {group: {name: dict(sorted(c.items())) for name, c in found.items()} for group, found in groups.items()}
        )
        return
    for name in names:
        output.line(name)
        for group, found in groups.items():
            _bars(group, found[name])


def _svg(path: Path, text: str) -> None:
    if path.suffix != ".svg":
        raise HearthError.of(Code.UNSUPPORTED_FILE, "a drawing is written as .svg", file=str(path))
    from hearth.storage.chosen_files import write

    write(path, text.encode())


def _bars(group: str, counts: Any) -> None:
    """One bar for each condition, as long as its share."""
    total = counts.total()
    for condition, count in sorted(counts.items(), key=lambda pair: (-pair[1], pair[0])):
        output.line(f"  {group:10} {condition:12} {'#' * round(40 * count / total):40} {count:,}")


def _homes(names: list[str] | None, folder: Path | None) -> AllHomes:
    from hearth.pipelines.engine.build_homes import Homes
    from hearth.pipelines.engine.settings import Settings

    return Homes(Settings(homes=tuple(names or ()), homes_folder=str(folder) if folder else None))
