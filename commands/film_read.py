"""What `model show` prints for a film: its steps with times, and the program that runs in a home."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from hearth.commands import output

if TYPE_CHECKING:
    from hearth.models.films.film_shown import FilmShown


def show(model: str, film: Path, home: str, homes: Path | None, kb: Path | None, out: Path | None) -> dict[str, Any]:
    """What a film shows, as JSON, with the pages that were written into `out`.

    Raises:
        HearthError: the film or the model can't be read.
    """
    from hearth.commands.inputs import read_knowledge
    from hearth.homes import library
    from hearth.models.films.film_shown import read_masks, show_film
    from hearth.models.films.seen_model import TrainedSeenModel
    from hearth.models.model_registry import restore
    from hearth.schemas.diagnostics import HearthError
    from hearth.schemas.failures import Code
    from hearth.simulation.world.home import Home

    if film.suffix != ".npz":
        message = f"`{film.name}` has colours, and films are read by their class masks"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="give the `clips.npz` of a dataset of clips")
    known, masks = read_knowledge(kb), read_masks(film)
    trained = restore(model)[1]
    if not isinstance(trained, TrainedSeenModel):
        message = f"`{model}` does not read films"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="name a model such as `clips-seen`")
    place = Home.from_graph(library.load_graph(home, known, homes), home, known)
    found = show_film(trained, masks, place)
    pages = _beside(found, film, masks, home, homes, kb, out) if out else []
    return {"film": film, **_document(found), "home": home, "pages": pages}


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
    """Write the film of the masks, that of the program, and a page with both."""
    from html import escape

    from hearth.commands.model_shown import film_of
    from hearth.rendering.film.clips import RATE
    from hearth.rendering.film.mask_film import write_masks
    from hearth.storage.names import inside

    out.mkdir(parents=True, exist_ok=True)
    write_masks(masks, out / "original.webm", RATE)
    if found.failure is not None:
        return []
    made = film_of(found.execution, home, out, homes, kb)
    folder = escape(inside(out, Path(home).name).name)
    videos = (("The film", "original.webm"), ("The program", f"{folder}/auto.webm"))
    cells = "".join(f'<figure><video src="{file}" controls muted width="512"></video><figcaption>{name}</figcaption>'
                    "</figure>" for name, file in videos)  # fmt: skip
    steps = "".join(f"<li>{escape(row['step'])} at {row['time']:.1f} s</li>" for row in _document(found)["steps"])
    page = out / "beside.html"
    page.write_text(f'<!doctype html><html lang="en"><meta charset="utf-8"><title>{escape(film.name)}</title>'
                    f"<style>figure{{display:inline-block}}</style>{cells}<ol>{steps}</ol></html>\n",
                    encoding="utf-8")  # fmt: skip
    return [str(page), *made["pages"]]


def printed(found: dict[str, Any]) -> None:
    """Print the steps with their times, and whether they run."""
    print(f"{output.counted(found['clips'], 'clip')} of {output.shown(str(found['film']))}")
    for row in found["steps"]:
        print(f"  {row['time']:7.1f} s  {row['step']}")
    failure = found["failure"]
    print(f"It runs in {found['home']}." if found["executable"] else f"Nothing runs: {failure and failure.message()}")
    if found["pages"]:
        print(f"Films: {', '.join(found['pages'])}")
