"""`model table | tables`: the tables of chapters 4 and 5, with the thesis's figures, ours and yardsticks."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from hearth.commands import output

if TYPE_CHECKING:
    from hearth.models.method_scores import Row

FILMS = ("4.2", "4.3", "4.3b", "4.6")
"""Tables of clips and films."""


def table(
    number: str,
    dataset: Path,
    *,
    models: list[str] | None = None,
    split: str = "activities",
    beam: int = 4,
    repair: bool = False,
    sketches: str = "annotated",
    most: int = 400,
    seed: int = 0,
    as_json: bool = False,
) -> None:
    """Print a table of the thesis next to ours.

    The tables are 4.4 (a dataset of synthesized programs), 4.5 (of people's), 5.1 to 5.4; 4.2, 4.3, 4.3b and 4.6 of
    clips; 5.5 and A.4 of demonstrations.

    Rows are the thesis's, yardsticks, and the models of --model; several checkpoints of one model are its seeds.
    Intervals are of activities drawn with replacement. The parts of the test are original programs alone in 4.4, 4.5
    and 5.4; in 5.2 and 5.3 augmented ones, too. 5.4 needs a model that writes sketches, such as desc2sketch;
    5.5 needs a demo2sketch; A.4 compares both kinds.

    \b
    Example:
      hearth model table 4.5 data_out --model build/retrieve-edit --repair
      hearth model table 5.2 data_out --model planner --most 40 --beam 1
      hearth model table 4.2 data_out/clips --model clips-seen --model masks
      hearth model table 4.3 data_out/clips --model clips-0 --model clips-1
      hearth model table 4.6 data_out/clips --model clips-context --model films-mle
      hearth model table 5.5 data_out/demos --model build/demo2sketch --model chooser --beam 1
      hearth model table A.4 data_out/demos --model build/demo2sketch --model build/retrieve-sketch
    """
    from hearth.commands.progress_line import bar
    from hearth.datasets.dataset import Dataset

    data = Dataset.open(dataset)
    if number in FILMS:
        _of_films(number, data, models or (), beam, seed, as_json)
        return
    if number == "A.4":
        _compared(data, models or (), split, beam, sketches, as_json)
        return
    if number == "5.1":
        _statistics(data, as_json)
        return
    if number.startswith("5."):
        from hearth.models.sketches import sketch_result_tables

        with bar("executions") as seen:
            rows = sketch_result_tables.table(number, data, split, models or (), beam=beam, sketches=sketches,
                                              most=most, seed=seed, seen=seen)  # fmt: skip
    else:
        from hearth.models.text import text_result_tables

        rows = text_result_tables.table(number, data, split, models or (), beam=beam, repaired=repair, seed=seed)
    if as_json:
        output.emit(rows)
    else:
        _print(rows, _columns(number))


def _statistics(dataset: Any, as_json: bool) -> None:
    """Table 5.1."""
    from hearth.models.sketches.dataset_size_table import dataset_table

    found = dataset_table(dataset)
    output.emit(found) if as_json else output.records([each._asdict() for each in found])


def _of_films(number: str, dataset: Any, models: Sequence[str], beam: int, seed: int, as_json: bool) -> None:
    """Tables 4.2, 4.3, its part (b), and 4.6."""
    from hearth.commands.progress_line import bar
    from hearth.models.films import clip_result_tables, film_result_tables

    with bar("films") as seen:
        if number in clip_result_tables.TABLES:
            rows: Sequence[Any] = clip_result_tables.clip_table(number, dataset, models, seed)
        else:
            rows = film_result_tables.film_table(dataset, models, seed, beam=beam, seen=seen)
    output.emit(rows) if as_json else _print_films(number, rows)


def _print_films(number: str, rows: Sequence[Any]) -> None:
    from hearth.models.films import clip_result_tables, film_result_tables

    if number in clip_result_tables.TABLES:
        shown = [[row.method, row.of, row.homes, *(f"{row.scores[name]:.3f}" for name in clip_result_tables.COLUMNS),
                  row.spread, row.clips, row.seeds or None] for row in rows]  # fmt: skip
        output.table(["method", "of", "homes", *clip_result_tables.COLUMNS, "error", "clips", "seeds"], shown)
    else:
        shown = [[row.method, row.of, row.homes, *(_score(row.scores.get(name)) for name in film_result_tables.COLUMNS),
                  row.spread, row.films, row.seeds or None] for row in rows]  # fmt: skip
        output.table(["method", "of", "homes", *film_result_tables.COLUMNS, "error", "films", "seeds"], shown)


def _compared(dataset: Any, models: Sequence[str], split: str, beam: int, sketches: str, as_json: bool) -> None:
    """Print sketches from demonstrations next to those from descriptions (A.4)."""
    from hearth.models.demonstrations.demonstration_comparison import compared

    found = compared(dataset, split, models, beam, sketches)
    if as_json:
        output.emit(found)
        return
    for title, rows in (("Descriptions of", found.by_words), ("Activity", found.by_activity)):
        shown = [[row.group, row.programs, *(f"{value:.3f}" for value in row.lcs), row.easier] for row in rows]
        output.table([title, "programs", *found.models, "easier from pictures"], shown)
        output.line()
    words = f"{found.words_easier:.1f} words on average, the others {found.words_others:.1f}"
    output.line(f"Easier from pictures: {found.easier} of {found.programs}; their descriptions have {words}.")


def tables(
    dataset: Path,
    drawn: Path | None = None,
    *,
    clips: Path | None = None,
    out: Path,
    only: list[str] | None = None,
    seeds: int = 3,
    minutes: float = 10.0,
    most: int = 400,
    as_json: bool = False,
) -> None:
    """Tables 4.2 to 4.6 and 5.2 to 5.4 whole: all their models are trained, each with several seeds, and compared.

    Trained models are kept, so that the same command continues after a stop; with the usual budget it takes a night.
    Each table is written into the folder as JSON, too. 4.4 is made twice: for pairs of tasks, and for paraphrases, that
    are held out of training. Tables of films need a dataset of clips, and are left out without one.

    \b
    Examples:
      hearth model tables data_out data_out/synthetic --out data_out/tables
      hearth model tables data_out data_out/synthetic --out quick --table 4.5 --seeds 1 --minutes 1
      hearth model tables data_out --clips data_out/clips --out data_out/tables --table 4.3 --table 4.6
    """
    from hearth.commands.progress_line import bar
    from hearth.models import thesis_table_plan
    from hearth.storage.names import inside

    data = {"people": dataset, "drawn": drawn or dataset / "synthetic", "clips": clips or dataset / "clips"}
    plans = thesis_table_plan.chosen(only or (), () if data["clips"].is_dir() else ("clips",))
    for each in (missing := thesis_table_plan.training(plans, seeds)):
        with bar(f"epochs of {each.folder(out).name}") as seen:
            thesis_table_plan.train(each, data[each.data], out, minutes, seen)
    found: dict[str, list[Any]] = {}
    for plan in plans:
        with bar(f"executions of {plan.name}") as seen:
            found[plan.name] = thesis_table_plan.rows(plan, data[plan.data], out, seeds, most, seen)
        output.write(inside(out, f"{plan.name}.json"), found[plan.name])
    if as_json:
        output.emit({"models": len(missing), "tables": found})
        return
    for number, (name, rows) in enumerate(found.items()):
        output.line("\n" * bool(number) + f"Table {name}")
        _print_films(name, rows) if name in FILMS else _print(rows, _columns(name.partition("-")[0]))


def _columns(number: str) -> Mapping[str, str]:
    from hearth.models.sketches import sketch_result_tables
    from hearth.models.text import text_result_tables

    if number in text_result_tables.TABLES:
        return text_result_tables.COLUMNS
    return sketch_result_tables.COLUMNS | ({"sketch": ""} if number in sketch_result_tables.PREDICTED else {})


def _print(rows: Sequence[Row], columns: Mapping[str, str]) -> None:
    shown = [[row.method, row.of, *(_score(row.scores.get(name)) for name in columns), row.seeds or None, row.minutes]
             for row in rows]  # fmt: skip
    output.table(["method", "of", *columns, "seeds", "minutes"], shown)


def _score(value: Any) -> str:
    """Return a mean with its interval, or a number of the thesis."""
    if value is None:
        return ""
    return f"{value:.3f}" if isinstance(value, float) else f"{value.mean:.3f} ({value.low:.3f}-{value.high:.3f})"
