"""The output of `model show`: a text or a sketch, and programs that models write for homes, alone or side by side."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from hearth.commands import output
from hearth.rendering.film.film_rate import FILM_RATE
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

if TYPE_CHECKING:
    from hearth.models.interface import Steps
    from hearth.models.prediction_stages import Shown
    from hearth.schemas.program import Step
    from hearth.simulation.engine import Execution

WIDTH = 46
"""Width of a program next to another, characters."""


def shown(
    model: str,
    text: str,
    sketch: Path | None,
    writer: str,
    homes: Sequence[str],
    folder: Path | None,
    kb: Path | None,
    beam: int,
) -> dict[str, Shown]:
    """Return the programs by home.

    Raises:
        HearthError: a model of sketches without a sketch, or one of texts with one; errors of `restore`.
    """
    from hearth.commands.inputs import read_knowledge, read_program
    from hearth.grounding.environments.default_state import prepared
    from hearth.homes import library
    from hearth.kb.action_sets import LATEST
    from hearth.models.demonstrations.demonstration_data import is_demonstration
    from hearth.models.model_registry import MODELS, restore
    from hearth.models.prediction_stages import show_reading, show_sketch, show_text
    from hearth.models.reading.reader import Reader
    from hearth.simulation.world.home import Home
    from hearth.simulation.world.world import World

    known = read_knowledge(kb)
    name, trained = restore(model)
    _check(name, MODELS[name].input, text, sketch)
    beside = _writer(writer)
    if isinstance(trained, Reader):
        known = known.of_set(LATEST)
    steps = read_program(sketch, known).unbound().steps if sketch else ()
    above = is_demonstration(text)
    if above:
        steps = _seen(name, trained, Path(text), beam)
    found = {}
    for each in homes:
        place = Home.from_graph(library.load_graph(each, known, folder), each, known)
        world = World.start(prepared(place).home)
        if above:
            found[each] = show_sketch(beside, steps, world, "", beam)
        elif sketch:
            found[each] = show_sketch(trained, steps, world, text, beam)
        elif isinstance(trained, Reader) and beside is None:
            found[each] = show_reading(trained, text, world)
        else:
            found[each] = show_text(trained, text, world, beside, beam)
    return found


def _seen(name: str, trained: Any, pictures: Path, beam: int) -> Steps:
    """Return the sketch of pictures from above."""
    from hearth.models.demonstrations.demo_model import TrainedDemoModel
    from hearth.models.demonstrations.demonstration_data import read_pictures

    if not isinstance(trained, TrainedDemoModel):
        message = f"`{name}` does not read pictures from above"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="name a trained `demo2sketch`")
    (found,) = trained.sketches([trained.see(read_pictures(pictures))], beam)
    return found


def _check(name: str, kind: str, text: str, sketch: Path | None) -> None:
    if kind == "sketch" and sketch is None:
        message = f"`{name}` writes programs for sketches"
        suggestion = "give one with --sketch FILE, or name a model of texts and this one with --writer"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion=suggestion)
    if kind != "sketch" and sketch is not None:
        message = f"`{name}` reads texts, not sketches"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="name a model of sketches, such as `planner`")


def _writer(name: str) -> Any:
    from hearth.models.model_registry import MODELS, restore

    if not name:
        return None
    known, trained = restore(name)
    if MODELS[known].input != "sketch":
        message = f"`{known}` does not write programs for sketches"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="name a model of sketches, such as `planner`")
    return trained


def document(one: Shown) -> dict[str, Any]:
    """Return a program with all that led to it."""
    from hearth.schemas.syntax import print_step

    execution, left_out, _ = one.completion
    return {
        "words": one.words,
        "sketch": [print_step(step) for step in one.sketch],
        "program": [print_step(step) for step in execution.program.steps],
        "executable": execution.executable and one.failure is None,
        "failure": one.failure,
        "left_out": [{"step": print_step(step), "failure": failure} for step, failure in left_out],
        **({"explained": one.explained} if one.explained else {}),
        **({"unread": one.unread} if one.unread else {}),
        **({"forbidden": one.forbidden} if one.forbidden else {}),
        **({"corrected": one.corrected} if one.corrected else {}),
    }


def printed(found: Mapping[str, Shown], *, explain: bool = False) -> None:
    """Print programs: the words and the sketch once, then each program, or two side by side.

    Args:
        found: by home.
        explain: also print the words that each step is for.
    """
    from hearth.schemas.failure_words import sentence
    from hearth.schemas.syntax import print_step

    first = next(iter(found.values()))
    output.line(f"Words: {output.shown(' '.join(first.words)) or 'none'}")
    if first.corrected:
        output.line(
            f"Corrected {output.counted(len(first.corrected), 'word')}: {output.shown(', '.join(first.corrected))}"
        )
    for words in first.forbidden:
        output.line(f"Not to be done: {output.shown(words)}")
    output.line("Sketch:", *(f"  {print_step(step)}" for step in first.sketch), sep="\n")
    for home, one in found.items():
        for step, failure in one.completion.left_out:
            output.line(f"  left out in {home}: {print_step(step)}: {sentence(failure)}")
    if len(found) == 2:
        _print_beside(found)
    for home, one in found.items():
        if len(found) != 2:
            output.line(f"Program in {home}:", *_program_lines(one, explain), sep="\n")
        runs = document(one)["executable"]
        for part in one.unread:
            output.line(f"Not understood: {output.shown(part)}")
        output.line("It runs." if runs else f"Nothing runs: {sentence(one.failure) if one.failure else ''}")


def _program_lines(one: Shown, explain: bool) -> list[str]:
    """Return the steps of a program, with the words that each is for."""
    lines = [f"  {line}" for line in document(one)["program"]]
    if not explain or not one.explained or not lines:
        return lines
    width = max(map(len, lines)) + 2
    return [f"{line:<{width}}{output.shown(words) or '(so that it runs)'}"
            for line, words in zip(lines, one.explained, strict=False)]  # fmt: skip


def _print_beside(found: Mapping[str, Shown]) -> None:
    from rich.console import Console
    from rich.text import Text

    from hearth.models.prediction_stages import side_by_side

    (one, left), (other, right) = found.items()
    console = Console(width=2 * WIDTH + 4, highlight=False)
    console.print(Text(output.shown(f"  {one:<{WIDTH}}  {other}")), soft_wrap=True)
    for line in side_by_side(*(each.completion.execution.program.steps for each in (left, right))):
        text = f"{'=' if line.common else ' '} {_cell(line.left)}  {_cell(line.right)}".rstrip()
        console.print(Text(output.shown(text), style="green" if line.common else ""), soft_wrap=True)


def _cell(step: Step | None) -> str:
    from hearth.schemas.syntax import print_step

    return f"{print_step(step) if step else '':<{WIDTH}}"


def filmed(found: Mapping[str, Shown], out: Path, homes: Path | None, kb: Path | None) -> dict[str, dict[str, Any]]:
    """Film the programs, a folder for each home in `out`, and return the files, by home."""
    runs = {home: one.completion.execution for home, one in found.items() if one.failure is None}
    return {home: film_of(execution, home, out, homes, kb) for home, execution in runs.items()}


def film_of(execution: Execution, home: str, out: Path, homes: Path | None, kb: Path | None) -> dict[str, Any]:
    """Film a program in a home, in a folder of the home's name in `out`, and return the files."""
    from hearth.commands.inputs import read_knowledge
    from hearth.commands.render import Shooting, videos
    from hearth.homes import library
    from hearth.rendering.scene.home_geometry import with_geometry
    from hearth.storage.names import inside

    known = read_knowledge(kb)
    place = with_geometry(library.load_graph(home, known, homes), home, known)
    folder = inside(out, Path(home).name)
    folder.mkdir(parents=True, exist_ok=True)
    shooting = Shooting(execution, place.graph, known, folder, SIZE, 0, HOUR, f"In {home}")
    return videos(shooting, ["auto"], FPS)


SIZE, HOUR, FPS = (320, 240), 10.0, FILM_RATE
