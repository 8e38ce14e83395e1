"""Figure 4-7: films of the test part, each with its description, its true program and the predicted program."""

from base64 import b64encode
from collections.abc import Iterator
from html import escape
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hearth.datasets.dataset import Dataset
from hearth.models.films.clip_data import Clips
from hearth.models.films.clip_result_tables import classifier
from hearth.models.films.film_arrays import COLOURS, FORMS
from hearth.models.films.film_contents import shown_films
from hearth.models.films.film_prediction import cut
from hearth.models.films.film_programs import followed
from hearth.models.interface import Steps
from hearth.models.prediction_stages import side_by_side
from hearth.rendering.film.clips import RATE
from hearth.rendering.film.png import encode
from hearth.schemas.syntax import print_step

FRAMES = 8
"""Number of pictures that the figure shows of a film."""

STYLE = (
    "body{font:14px sans-serif;max-width:1100px;margin:1em auto}img{width:130px;margin:2px;image-rendering:pixelated}"
    "figure{display:inline-block;margin:0}figcaption{text-align:center;color:#555}td{padding:1px 12px;font-family:"
    "monospace}.both td{background:#d5f0d5}th{text-align:left;padding:1px 12px}"
)


def film_page(dataset: Dataset, model: Path | str, films: int = 3) -> str:
    """Return some coloured test films as HTML: frames with their times; true and read program, common steps opposite.

    Programs are read by the engine, from the world in which the film begins.

    Args:
        dataset: with clips.
        model: a checkpoint of a classifier by masks.
        films: how many; the first in the order of their names.

    Raises:
        HearthError: errors of `restore` and `Clips.of`.
    """
    trained, test = classifier(model)[1], Clips.of(dataset, "test", films, coloured=True)
    coloured = Clips.of(dataset, "test", films, array=COLOURS)
    shown, texts = shown_films(dataset, test.executions), _texts(dataset)
    kinds = {clip.film: clip.kind for clip in test.clips}
    parts = []
    for film, name in enumerate(test.executions):
        (found,) = trained.readings(cut(test.films[film]))
        moves = found.moves(trained.order)
        read = followed(found.scores, found.instructions, shown[film].world, moves)
        title, text = texts.get(name, (name, ""))
        home = f"in {escape(name.rpartition('@')[2].partition('/')[0])} ({escape(kinds[film])} home)"
        parts.append(f"<h2>{escape(title)}, {home}</h2><p>{escape(text)}</p>{''.join(_frames(coloured.films[film]))}")
        parts.append(_programs(shown[film].steps, read.steps))
    head = f'<!doctype html><html lang="en"><meta charset="utf-8"><title>Programs from films</title><style>{STYLE}'
    return f"{head}</style><h1>Programs from films</h1>{''.join(parts)}</html>\n"


def _texts(dataset: Dataset) -> dict[str, tuple[str, str]]:
    """Title and description of each execution's program."""
    query = (
        "SELECT execution_id, any_value(programs.title), any_value(programs.description) FROM clips "
        "JOIN executions USING (execution_id) JOIN programs USING (program_id) GROUP BY execution_id"
    )
    return {name: (title or "", text or "") for name, title, text in dataset.rows(query)[1]}


def _frames(pictures: NDArray[Any]) -> Iterator[str]:
    assert pictures.ndim == FORMS[COLOURS][0]
    for number in np.linspace(0, len(pictures) - 1, FRAMES).round().astype(int).tolist():
        picture = b64encode(encode(pictures[number])).decode()
        source = f"data:image/png;base64,{picture}"
        yield f'<figure><img alt="" src="{source}"><figcaption>{number / RATE:.1f} s</figcaption></figure>'


def _programs(done: Steps, read: Steps) -> str:
    rows = "".join(
        f"<tr{' class=both' if line.common else ''}><td>{_text(line.left)}</td><td>{_text(line.right)}</td></tr>"
        for line in side_by_side(done, read)
    )
    return f"<table><tr><th>What was done</th><th>What is read from the film</th></tr>{rows}</table>"


def _text(step: Any) -> str:
    return escape(print_step(step)) if step else ""
