"""The output of `model show` for a film: its steps with times, and the program that runs in a home."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import TYPE_CHECKING, Any

from hearth.commands import output

if TYPE_CHECKING:
    from hearth.models.films.film_prediction import FilmShown

MASKS = "masks"
"""The checkpoint that predicts the masks of videos, unless another is named."""


def show(
    model: str, film: Path, home: str, homes: Path | None, kb: Path | None, out: Path | None, masks: str = MASKS
) -> dict[str, Any]:
    """Return the contents of a film, as JSON, with the pages that were written into `out`.

    Args:
        model: a classifier of clips by masks.
        film: of a dataset of clips, or a video; or a folder with one.
        home: where the program runs.
        homes, kb: laid over ours.
        out: the folder for films; None for none.
        masks: the checkpoint that predicts the masks of a video.

    Raises:
        HearthError: the film or a model can't be read.
    """
    from hearth.commands.inputs import read_knowledge
    from hearth.homes import library
    from hearth.models.films.clip_result_tables import classifier
    from hearth.models.films.film_files import ARRAYS, film_file
    from hearth.models.films.film_input import read_masks, read_pictures
    from hearth.models.films.film_prediction import show_film
    from hearth.models.films.predicted_masks import mask_predictor
    from hearth.simulation.world.home import Home

    known, path, trained = read_knowledge(kb), film_file(film), classifier(model)[1]
    seen = read_masks(path) if path.suffix == ARRAYS else mask_predictor(masks).masks(read_pictures(path))
    place = Home.from_graph(library.load_graph(home, known, homes), home, known)
    found = show_film(trained, seen, place)
    pages = _beside(found, path, seen, home, homes, kb, out) if out else []
    return {"film": path, **_document(found), "home": home, "pages": pages}


def _document(found: FilmShown) -> dict[str, Any]:
    from hearth.schemas.program import Program
    from hearth.schemas.syntax import print_step

    steps = [print_step(step) for step in Program(steps=found.seen.steps).unbound().steps]
    timed = [{"time": time, "step": step} for time, step in zip(found.times, steps, strict=True)]
    runs = found.failure is None and found.execution.executable
    return {"clips": found.clips, "steps": timed, "program": steps, "executable": runs, "failure": found.failure}


def _beside(
    found: FilmShown, film: Path, masks: Any, home: str, homes: Path | None, kb: Path | None, out: Path
) -> list[str]:
    """Write the film, its masks, the film of the program, and a page with all."""
    from html import escape

    from hearth.commands.model_output import film_of
    from hearth.models.films.film_files import VIDEOS
    from hearth.rendering.film.clips import RATE
    from hearth.rendering.film.mask_film import write_masks
    from hearth.storage.names import inside

    out.mkdir(parents=True, exist_ok=True)
    write_masks(masks, out / "masks.webm", RATE)
    videos = {"The masks": "masks.webm"}
    if film.suffix in VIDEOS:
        original = inside(out, f"original{film.suffix}")
        shutil.copyfile(film, original)
        videos = {"The film": original.name, **videos}
    if found.failure is not None:
        return []
    made = film_of(found.execution, home, out, homes, kb)
    videos["The program"] = f"{escape(inside(out, Path(home).name).name)}/auto.webm"
    cells = "".join(f'<figure><video src="{file}" controls muted width="512"></video><figcaption>{name}</figcaption>'
                    "</figure>" for name, file in videos.items())  # fmt: skip
    steps = "".join(f"<li>{escape(row['step'])} at {row['time']:.1f} s</li>" for row in _document(found)["steps"])
    page = out / "beside.html"
    page.write_text(f'<!doctype html><html lang="en"><meta charset="utf-8"><title>{escape(film.name)}</title>'
                    f"<style>figure{{display:inline-block}}</style>{cells}<ol>{steps}</ol></html>\n",
                    encoding="utf-8")  # fmt: skip
    return [str(page), *made["pages"]]


def printed(found: dict[str, Any]) -> None:
    """Print the steps with their times, and whether they run."""
    from hearth.schemas.failure_words import sentence

    output.line(f"{output.counted(found['clips'], 'clip')} of {output.shown(str(found['film']))}")
    for row in found["steps"]:
        output.line(f"  {row['time']:7.1f} s  {row['step']}")
    failure = found["failure"]
    said = sentence(failure) if failure else ""
    output.line(f"It runs in {found['home']}." if found["executable"] else f"Nothing runs: {said}")
    if found["pages"]:
        output.line(f"Films: {', '.join(found['pages'])}")
