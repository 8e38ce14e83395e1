"""`model`: trains models that write programs, and lets them predict."""

from pathlib import Path

import typer

from hearth.commands import language_predictions, model_tables, output
from hearth.commands.shared_options import LanguageOptions
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

app = typer.Typer(
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode=None,
    help="Train models that write programs from text and sketches, and use them; needs the extra `models`.",
)


DEFAULT_MODEL = "reader"
"""The model that `model show` asks where a text stands alone."""

app.command("retrieval")(language_predictions.retrieval)
app.command("table")(model_tables.table)
app.command("tables")(model_tables.tables)


@app.command("list")
def every(*, as_json: bool = False) -> None:
    """List the models, their input, and whether a trained one comes with Hearth.

    \b
    Example:
      hearth model list
    """
    from hearth.models.model_registry import MODELS, trained_names

    ready = trained_names()
    rows = [
        {"name": name, "input": entry.input, "trained": name in ready, "source": entry.source, "about": entry.line}
        for name, entry in MODELS.items()
    ]
    if as_json:
        output.emit(rows)
    else:
        output.records(rows)


@app.command("train")
def train(
    name: str,
    dataset: Path,
    *,
    out: Path,
    split: str = "activities",
    epochs: int = 30,
    minutes: float = 0.0,
    rate: float = 1e-3,
    settings: list[str] | None = None,
    augmented: bool = False,
    sketches: str = "annotated",
    seed: int = 0,
    as_json: bool = False,
) -> None:
    """Train a model on the training part of a split, and write a checkpoint.

    The part `validation`, or activities taken out of the training part, decides when training ends. A training that was
    stopped goes on where it was, by the same command. A budget in minutes is recorded as the epochs it came to.

    \b
    Example:
      hearth model train nearest data_out --out build/nearest
    """
    from hearth.commands.progress_line import bar
    from hearth.models.fit_model import fit

    with bar("epochs") as seen:
        facts = fit(
            name, dataset, out, split, settings or (), originals=not augmented, sketches=sketches,
            how={"epochs": epochs, "minutes": minutes, "rate": rate, "seed": seed}, seen=seen,
        )  # fmt: skip
    if as_json:
        output.emit({"out": out, **facts})
        return
    output.figures({key: value for key, value in facts.items() if not isinstance(value, dict)})


@app.command("predict")
def predict(
    model: str,
    dataset: Path,
    *,
    out: Path,
    split: str = "activities",
    part: str = "test",
    beam: int = 1,
    repair: bool = False,
    constrained: bool = False,
    originals: bool = False,
    sketches: str = "annotated",
    limit: int | None = None,
    shots: int = 0,
    embed: str = "",
    models: LanguageOptions = LanguageOptions(),
    as_json: bool = False,
) -> None:
    """Predict a program for each execution of a part of a dataset, into a file that `score dataset` reads.

    A language model, llm:MODEL@URL, gets the texts with the most similar training examples (--shots). Its replies are
    kept in --cache, and nothing is asked twice; the status is 1 if texts have no answer. With --embed, examples are
    chosen by vectors, too; `model retrieval` prints what they bring.

    \b
    Examples:
      hearth model predict build/nearest data_out --part test --out predicted.jsonl
      hearth model predict llm:smollm2 data_out --shots 4 --out predicted.jsonl
      hearth model predict llm:MODEL@URL data_out --shots 8 --repair --prices 0.15,0.60 --budget 2 --out p.jsonl
    """
    if model.startswith("llm:"):
        asked = models.model(model, out, constrained)
        language_predictions.predict(asked, dataset, out, split, part, shots, repair, originals, limit, embed, as_json)
        return
    language_predictions.refuse_options(given=bool(shots or embed or models.given))
    from hearth.commands.progress_line import bar
    from hearth.models.prediction_files import predict_part

    with bar("executions") as seen:
        count = predict_part(
            model,
            dataset,
            out,
            split,
            part,
            beam=beam,
            repaired=repair,
            is_constrained=constrained,
            originals=originals,
            sketches=sketches,
            limit=limit,
            seen=seen,
        )
    output.say(f"{output.counted(count, 'prediction')} in {out}", {"out": out, "predictions": count}, as_json)


@app.command("score")
def score(
    predicted: Path,
    dataset: Path,
    *,
    unseen: Path | None = None,
    split: str = "activities",
    seed: int = 0,
    as_json: bool = False,
) -> None:
    """Score a file of predictions: the executions that it names, and no others.

    Intervals are of activities drawn with replacement. `score dataset` scores a whole part, where predictions lack too.
    With --unseen only programs count whose title no training program of that dataset has: how a model that was trained
    there does on other people's activities.

    \b
    Example:
      hearth model score predicted.jsonl data_out
      hearth model predict planner release --part "" --out planned.jsonl
      hearth model score planned.jsonl release --unseen data_out
    """
    from hearth.datasets.dataset import Dataset
    from hearth.models.evaluation import means
    from hearth.models.text_examples import of_new_titles
    from hearth.scoring.dataset_scores import score_given

    asked = Dataset.open(dataset)
    found = score_given(asked, predicted)
    if unseen is not None:
        new = of_new_titles(asked, Dataset.open(unseen), split)
        found = [each for each in found if each.pair.id in new]
    summary = means(found, seed)
    if as_json:
        output.emit({"count": len(found), "activities": len({each.pair.more["activity"] for each in found}),
                     "mean": summary})  # fmt: skip
        return
    output.table(["score", "mean", "95% from", "to"], [[name, *interval] for name, interval in summary.items()])


@app.command("bands")
def bands(predicted: Path, dataset: Path, *, out: Path | None = None, as_json: bool = False) -> None:
    """Draw figure 4-9 by automatic scores: the results of a file's predicted programs, by band of LCS.

    No person is asked: whether a program runs, how much of the goal it reaches and F1 stand for the ratings of films.
    `study figure 4-9` is the figure with people.

    \b
    Example:
      hearth model bands predicted.jsonl data_out --out figures
    """
    from hearth.analysis.scores_by_lcs import JUDGES, by_lcs, draw_by_lcs
    from hearth.datasets.dataset import Dataset
    from hearth.scoring.dataset_scores import score_given
    from hearth.storage.names import inside

    found = by_lcs(score_given(Dataset.open(dataset), predicted))
    files: list[Path] = []
    if out is not None:
        out.mkdir(parents=True, exist_ok=True)
        files = draw_by_lcs(found, predicted.stem, inside(out, "figure-4-9-scores"))
    if as_json:
        output.emit({**found._asdict(), "files": files})
        return
    rows = [[f"{row.low:.2f} to {row.high:.2f}", row.programs, *(row.scores[name] for name in JUDGES)]
            for row in found.bands]  # fmt: skip
    rows.append(["rank correlation", None, *(found.correlations[name] for name in JUDGES)])
    output.table(["LCS", "programs", *JUDGES], rows)
    for file in files:
        output.line(f"Drawn: {file}")


@app.command("examples")
def examples(
    predicted: Path,
    dataset: Path,
    *,
    out: Path,
    count: int = 9,
    pictures: int = 4,
    sketches: str = "annotated",
    as_json: bool = False,
) -> None:
    """Write a page of predictions next to people's programs: text, sketch, programs, scores, and pictures of the run.

    They are taken at equal steps of LCS from the best to the worst, each of another activity.

    \b
    Example:
      hearth model examples predicted.jsonl data_out --out examples.html
    """
    from hearth.analysis.prediction_examples import examples_page, prediction_examples
    from hearth.commands.progress_line import bar
    from hearth.datasets.dataset import Dataset
    from hearth.scoring.dataset_scores import score_given
    from hearth.storage.chosen_files import write

    data = Dataset.open(dataset)
    found = score_given(data, predicted)
    shown = []
    with bar("examples") as seen:
        for each in prediction_examples(data, found, count, pictures, sketches):
            shown.append(each)
            seen(len(shown), count)
    out.parent.mkdir(parents=True, exist_ok=True)
    write(out, examples_page(shown, f"Predictions of {predicted.stem}", len(found)).encode())
    output.say(f"{len(shown)} examples in {out}", {"out": out, "examples": len(shown), "of": len(found)}, as_json)


@app.command()
def figure(number: str, dataset: Path, *, model: str, out: Path, as_json: bool = False) -> None:
    """Draw figure 4-4 (SVG: actions and their predictions) or 4-7 (HTML: films, true and predicted programs).

    \b
    Examples:
      hearth model figure 4-4 data_out/clips --model clips-seen --out figure-4-4.svg
      hearth model figure 4-7 data_out/clips --model clips-seen --out figure-4-7.html
    """
    from hearth.datasets.dataset import Dataset
    from hearth.models.films import clip_confusion, film_figure
    from hearth.storage.chosen_files import write

    data = Dataset.open(dataset)
    if number == "4-4":
        drawn = clip_confusion.drawn(clip_confusion.confusion(data, model))
    elif number == "4-7":
        drawn = film_figure.film_page(data, model)
    else:
        raise HearthError.of(Code.BAD_ARGUMENT, f"there is no figure `{number[:20]}`", suggestion="4-4 or 4-7")
    out.parent.mkdir(parents=True, exist_ok=True)
    write(out, drawn.encode())
    output.say(str(out), {"figure": number, "files": [str(out)]}, as_json)


@app.command("show")
def show(
    model: str,
    text: str = "",
    *,
    sketch: Path | None = None,
    writer: str = "",
    home: list[str] | None = None,
    homes: Path | None = None,
    kb: Path | None = None,
    beam: int = 1,
    film: Path | None = None,
    masks: str = "masks",
    explain: bool = False,
    as_json: bool = False,
) -> None:
    """Write a program for a text or a sketch and run it in a home: the words, the sketch, the program, each step shown.

    The sketch is the output of a model of texts, or the file of --sketch for a model of sketches. Its objects are bound
    to the home's, steps that it lacks are inserted as in `repair`, and those that cannot run there are left out. With
    two homes the programs stand side by side, common steps marked and coloured. The status is 1 if nothing is left.
    A model of films reads a film in place of the text, arrays of a dataset of clips or a video, whose masks are
    predicted: its steps with times, and the program. A model of demonstrations reads pictures from above.

    A text alone is read by `reader`, which refuses a text that it does not understand, or that the home cannot do.
    With --explain it prints the words of each step.

    \b
    Example:
      hearth model show "Make coffee"
      hearth model show reader "Heat the milk, then set the table for two" --home maple --explain
      hearth model show retrieve-edit "Turn on the TV and sit down" --home maple
      hearth model show planner --sketch sketch.txt --home maple --home birch
      hearth model show clips-seen data_out/clips/publish/films/FOLDER --film shown
      hearth model show clips-seen film.webm --film shown
      hearth model show build/demo2sketch data_out/demos/publish/frames/FOLDER --writer chooser --home maple
    """
    from hearth.commands import model_output
    from hearth.models.demonstrations.demonstration_data import is_demonstration
    from hearth.models.films.film_files import is_film

    if not text and sketch is None and " " in model.strip():
        model, text = DEFAULT_MODEL, model
    if is_film(text) and not is_demonstration(text):
        from hearth.commands import film_output

        found = film_output.show(model, Path(text), (home or ["maple"])[0], homes, kb, film, masks)
        output.emit(found) if as_json else film_output.printed(found)
        output.status(int(not found["executable"]), strict=True)
        return
    shown = model_output.shown(model, text, sketch, writer, home or ["maple"], homes, kb, beam)
    films = model_output.filmed(shown, film, homes, kb) if film else {}
    if as_json:
        documents = [model_output.document(each) | films.get(name, {}) for name, each in shown.items()]
        named = [{"home": name, **each} for name, each in zip(shown, documents, strict=True)]
        output.emit(documents[0] if len(named) == 1 else {"homes": named})
    else:
        model_output.printed(shown, explain=explain)
        for name, made in films.items():
            output.line(f"Film in {name}: {', '.join(made['pages'])}")
    output.status(sum(each.failure is not None for each in shown.values()), strict=True)
