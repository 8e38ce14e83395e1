"""`study`: studies with people, from their file to the report."""

from __future__ import annotations

from collections import Counter
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from hearth.commands import output
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

if TYPE_CHECKING:
    from hearth.studies.study import Study
    from hearth.studies.study_folder import Collected

app = typer.Typer(
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode=None,
    help="Studies with people: check, simulate, prepare, export, report. `serve --study` lets people take part.",
)


@app.command("list")
def shipped(*, as_json: bool = False) -> None:
    """List the studies that come with Hearth.

    \b
    Example:
      hearth study list
    """
    from hearth.studies.study_file import SHIPPED, named

    rows = [_facts(named(name)) for name in SHIPPED]
    if as_json:
        output.emit(rows)
    else:
        output.records(rows)


@app.command()
def check(study: str, *, as_json: bool = False) -> None:
    """Check a study's file: its form, its helpers and tasks, and whether its assignment is balanced.

    \b
    Examples:
      hearth study check people-with-helpers
      hearth study check mine.yaml
    """
    from hearth.studies.assignment import assignment
    from hearth.studies.study_file import groups_of, named

    found = named(study)
    slots = assignment(found, groups_of(found))
    sizes = sorted({len(slot) for slot in slots})
    least = {
        each.name: min(Counter(planned.condition for planned in slot)[each.name] for slot in slots)
        for each in found.conditions
    }
    facts = {**_facts(found), "trials_each": sizes, "least_each": least, "digest": found.digest}
    if as_json:
        output.emit(facts)
        return
    output.figures({**facts, "trials_each": " or ".join(map(str, sizes)),
                    "least_each": ", ".join(f"{name} {count}" for name, count in least.items())})  # fmt: skip


def _facts(study: Study) -> dict[str, Any]:
    return {
        "study": study.name,
        "room": study.room,
        "people": study.people,
        "trials": study.trials,
        "conditions": ", ".join(each.name for each in study.conditions),
        "title": study.title,
    }


@app.command()
def simulate(
    study: str,
    *,
    out: Path,
    seed: int = 0,
    drop_outs: int = 1,
    workers: int = 0,
    as_json: bool = False,
) -> None:
    """Let agents take part in people's places, by the code that people's trials go through, until all is done.

    The other study that it is about, such as people's lengths alone, is simulated first. The events of a stopped
    simulation are kept; the same command continues from there.

    \b
    Examples:
      hearth study simulate people-with-helpers --out build/studies
      hearth study report build/studies/people-with-helpers
    """
    from hearth.storage.names import inside
    from hearth.studies.study_tables import helper_fault

    collected = _simulated(study, out, seed, drop_outs, workers)
    streams = collected.ledger.streams()
    standings = [collected.conduct.standing(person) for person in streams]
    facts = {
        "study": collected.study.name,
        "simulated": True,
        "people": len(streams),
        "finished": sum(each.finished for each in standings),
        "left": sum(each.stage == "left" for each in standings),
        "trials": sum(event.kind == "did" for each in standings for event in each.events),
        "counted": sum(event.kind == "did" for each in standings if each.finished for event in each.events),
        "helper_faults": sum(
            bool(helper_fault(event.data)) for each in standings for event in each.events if event.kind == "did"
        ),
        "out": str(inside(out, collected.study.name)),
    }
    if as_json:
        output.emit(facts)
    else:
        output.figures(facts)


def _simulated(study: str, out: Path, seed: int, drop_outs: int, workers: int) -> Collected:
    from hearth.commands.progress_line import bar
    from hearth.kb.loading.load import default
    from hearth.storage.parallel import Seen
    from hearth.studies.simulated_study import simulated_study
    from hearth.studies.study_file import SHIPPED, named
    from hearth.studies.study_simulation import Crowd

    files = None if study in SHIPPED else Path(study).parent
    with ExitStack() as stack:
        open_bar = ExitStack()
        stack.enter_context(open_bar)

        def watch(what: str) -> Seen:
            open_bar.close()
            return open_bar.enter_context(bar(what))

        return simulated_study(named(study), Crowd(seed, drop_outs), out, default, workers, watch, files)


@app.command()
def prepare(
    study: str,
    *,
    out: Path,
    predictions: Path | None = None,
    people: Path | None = None,
    workers: int = 0,
    as_json: bool = False,
) -> None:
    """Make the files that a study with people needs: the agent's episodes in its tasks, and the films to judge.

    Films that are there already are kept.

    \b
    Examples:
      hearth study prepare programs-by-lcs --out collected/studies
      hearth study prepare programs-by-lcs --predictions predicted.jsonl --out collected/studies
      hearth study prepare likeness-of-films --people collected --out collected/studies
    """
    from hearth.commands.progress_line import bar
    from hearth.kb.loading.load import default
    from hearth.studies.study_file import named
    from hearth.studies.study_preparation import prepared

    found = named(study)
    shown = None if people is None else _opened(people, "", found.films.study if found.films else "")
    with bar("films") as seen:
        facts = prepared(found, out, default, shown, predictions, workers, seen)
    if as_json:
        output.emit(facts)
    else:
        output.figures(facts)


@app.command()
def export(source: Path, *, out: Path, store: str = "", study: str = "", as_json: bool = False) -> None:
    """Write the tables of a study as Parquet: participants, trials, decisions, ratings. Ids are salted; no names.

    \b
    Examples:
      hearth study export build/studies/people-with-helpers --out tables
      hearth study export collected --study people-alone --out tables
    """
    from hearth.studies.study_tables import export as write

    collected = _opened(source, store, study)
    facts = {"out": str(out), "simulated": collected.simulated, **write(collected, out)}
    if as_json:
        output.emit(facts)
    else:
        output.figures(facts)


@app.command()
def report(source: Path, *, out: Path | None = None, store: str = "", study: str = "", as_json: bool = False) -> None:
    """Write the page of a study, and print it: success, speedup, reward and ratings, and the thesis's tests.

    \b
    Examples:
      hearth study report build/studies/people-with-helpers --out report
      hearth study report collected --study people-alone --json
    """
    from hearth.studies.study_figures import names_of
    from hearth.studies.study_findings import findings
    from hearth.studies.study_report import as_json as for_machines
    from hearth.studies.study_report import failures, test_row, write_report

    collected = _opened(source, store, study)
    other = _alone(collected, source, store)
    found = findings(collected, other)
    if out is not None:
        write_report(found, findings(other) if other else None, out)
    if as_json:
        output.emit({**for_machines(found), "out": None if out is None else str(out)})
        return
    marked = "simulated: agents in people's places" if found.simulated else "people"
    output.line(f"{found.study.title} ({marked}): {found.people} finished, {found.left} left before the end")
    output.line("\n".join(["", *failures(found)]))
    who_in_words = names_of(found)
    rows = [
        [group, who_in_words[who], metric, each.count, each.mean, each.error]
        for who, group, metric in found.values
        if (each := found.figure(who, group, metric)) is not None
    ]
    output.table(("of", "who", "figure", "tasks", "mean", "standard error"), rows)
    output.line()
    columns = ("of", "one", "other", "pairs", "difference", "t", "p", "d", "K2, p", "Wilcoxon p", "thesis")
    output.table(columns, [test_row(each) for each in found.comparisons])
    for name, (rho, p) in found.correlations.items():
        output.line(f"\nSpearman's correlation of normalised LCS and {name}: {rho:.2f}, p = {p:.2g}")


@app.command()
def figure(
    number: str, *, out: Path, seed: int = 0, drop_outs: int = 1, workers: int = 0, as_json: bool = False
) -> None:
    """Draw the thesis's figure 6-8, 7-6b or 4-9: of the study in the folder, which is simulated if it is not there.

    \b
    Examples:
      hearth study figure 6-8 --out build/studies
      hearth study figure 7-6b --out build/studies
      hearth study figure 4-9 --out build/studies
    """
    from hearth.studies.study_figures import STUDIES, draw
    from hearth.studies.study_findings import findings
    from hearth.studies.study_folder import beside

    if number not in STUDIES:
        raise HearthError.of(Code.BAD_ARGUMENT, f"there is no figure `{number[:20]}`", suggestion=", ".join(STUDIES))
    collected = _simulated(STUDIES[number], out, seed, drop_outs, workers)
    other = beside(collected)
    files = draw(number, findings(collected, other), findings(other) if other else None, out)
    shown = "\n".join(map(str, files))
    document = {"figure": number, "simulated": collected.simulated, "files": list(map(str, files))}
    output.say(shown, document, as_json)


@app.command()
def forget(source: Path, person: str, *, store: str = "", study: str = "", as_json: bool = False) -> None:
    """Delete all that a study has of a person; the place is open again.

    The person is named by the id in the exported tables, or by that of the session, which the desk shows.

    \b
    Example:
      hearth study forget collected 3f6c0a9d2b7e4815 --study people-alone
    """
    from hearth.studies.study_tables import person_of

    collected = _opened(source, store, study)
    collected.conduct.forget(person_of(collected, person))
    output.say("Deleted.", {"forgotten": person}, as_json)


def _opened(source: Path, store: str, study: str) -> Collected:
    """Return the study of a folder that was simulated into, or that the server keeps its store in."""
    from hearth.kb.loading.load import default
    from hearth.studies.study_folder import EVENTS, opened

    if (source / EVENTS).is_file() and not store:
        return opened(source, default)
    from hearth.schemas.optional_libraries import library

    library("sqlalchemy")
    from hearth.web.study.study_store import opened_store

    return opened_store(source, store, study, default)


def _alone(collected: Collected, source: Path, store: str) -> Collected | None:
    """Return the study with the lengths without a helper, from the place of the other study."""
    from hearth.studies.study_folder import EVENTS, beside

    if (source / EVENTS).is_file() and not store:
        return beside(collected)
    from hearth.web.study.study_store import names_in

    return _opened(source, store, collected.study.alone) if collected.study.alone in names_in(source, store) else None
