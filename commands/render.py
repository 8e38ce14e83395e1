"""Pictures of one program, and of all models."""

from __future__ import annotations

from contextlib import contextmanager
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import typer

from hearth.commands import inputs, output
from hearth.rendering.film.film_rate import FILM_RATE
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Failure

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from hearth.kb.knowledge import Knowledge
    from hearth.rendering.cameras.visibility import TickVisibility
    from hearth.rendering.film.execution_pictures import Snapshot
    from hearth.schemas.graph import EnvironmentGraph
    from hearth.schemas.program import Program
    from hearth.simulation.engine import Execution
    from hearth.simulation.world.home import Home


def program(
    file: Path,
    out: Path,
    home: str = "maple",
    graph: Path | None = None,
    homes: Path | None = None,
    mode: Literal["snapshots", "video"] = "snapshots",
    cameras: str = "auto",
    seed: int = 0,
    hour: float = 10.0,
    width: int = 320,
    fps: float = FILM_RATE,
    fine: bool = False,
    vary: bool = False,
    modalities: str = "",
    which: int = 1,
    columns: str = "",
    strict: bool = False,
    as_json: bool = False,
) -> None:
    """Picture a program: PNG files of every step, or a video with a page that plays it; and a contact sheet.

    A home's file stays as it is, and the pictures end where the program stops. To a home of ours, things may be added.

    \b
    Examples:
      hearth render-program watch_tv.txt --home maple --out pictures
      hearth render-program watch_tv.txt --home maple --mode video --cameras auto,top --out film
      hearth render-program watch_tv.txt --home maple --mode video --modalities rgb,depth,flow --out film
    """
    from hearth.homes.library import given_file
    from hearth.kb.loading.load import default
    from hearth.rendering.scene.home_geometry import with_geometry
    from hearth.schemas.failure_words import in_program
    from hearth.simulation.world.home import Home

    given = {"--cameras": cameras != "auto", "--fps": fps != FILM_RATE, "--vary": vary, "--hour": hour != 10}
    _check(mode, width, given)
    known = default()
    own = graph is not None or given_file(home) is not None
    home, scene = _scene(home, graph, homes, known)
    program = inputs.read_given(file, known, which, strict, columns).program
    execution = _execution(program, Home.from_graph(scene, home, known), seed, own=own)
    changes = _changes(scene, home, execution, known)
    place = with_geometry(scene, home, known)
    title, size = f"{execution.program.title}, in {home}", (width, _height(width, mode))
    shooting = Shooting(execution, place.graph, known, out, size, seed, hour, title, vary)
    with _folder(out):
        if mode == "video":
            made = videos(shooting, _split(cameras), fps, "fine" if fine else "draft", _split(modalities or "rgb"))
        else:
            made = _snapshots(shooting, "fine" if fine else "draft", _split(modalities or "rgb,instance_ids"))
    failure = in_program(execution.failure, execution.program) if execution.failure else None
    if as_json:
        facts = {"program": execution.program.title, "home": home, "failure": failure, "layout_made": place.made,
                 "home_changes": changes}  # fmt: skip
        output.emit({**facts, **made})
    else:
        _say(made, failure, changes, place.note(home), f"{made['pictures']} pictures of {file.name} in {out}")
    output.status(failure is not None, strict=True)


@contextmanager
def _folder(out: Path) -> Iterator[None]:
    """Make a folder for pictures; one that was made here and is empty goes again if they are refused."""
    new = not out.exists()
    out.mkdir(parents=True, exist_ok=True)
    try:
        yield
    except HearthError:
        if new and not any(out.iterdir()):
            out.rmdir()
        raise


def _scene(home: str, graph: Path | None, homes: Path | None, known: Knowledge) -> tuple[str, EnvironmentGraph]:
    """Return the name and the scene graph of where a program is pictured."""
    from hearth.homes import library

    if graph is not None:
        return graph.stem, library.graph_of(graph, known)
    return library.named_graph(home, known, homes)


def _check(mode: str, width: int, given: Mapping[str, bool]) -> None:
    """Refuse options without effect; `given` has for some options whether they differ from their defaults."""
    for name in ("--cameras", "--fps", "--vary"):
        if mode != "video" and given[name]:
            raise typer.BadParameter("only videos have it: add `--mode video`", param_hint=name)
    if given["--vary"] and given["--hour"]:
        raise typer.BadParameter("`--vary` draws the hour: leave one out", param_hint="--hour")
    if mode == "video" and width % 2:
        raise typer.BadParameter(f"a video's width is even: {width - 1} or {width + 1}", param_hint="--width")


def _height(width: int, mode: str) -> int:
    """3/4 of the width; even in videos, whose codecs would cut a pixel."""
    height = width * 3 // 4
    return height // 2 * 2 if mode == "video" else height


class Shooting(NamedTuple):
    """A job of pictures: execution, folder, width and height, seed, hour, title of the sheet, whether to vary."""

    execution: Execution
    graph: EnvironmentGraph
    known: Knowledge
    out: Path
    size: tuple[int, int]
    seed: int
    hour: float
    title: str
    vary: bool = False


def _split(names: str) -> list[str]:
    return [name.strip() for name in names.split(",") if name.strip()]


def _snapshots(shooting: Shooting, quality: str, modalities: list[str]) -> dict[str, Any]:
    from hearth.rendering.film.contact_sheet import caption
    from hearth.rendering.film.execution_pictures import TOP, snapshots

    frames, files, seen = [], [], []
    how = {"size": shooting.size, "quality": quality, "seed": shooting.seed, "hour": shooting.hour}
    for shot in snapshots(*shooting[:3], modalities=("rgb", *modalities), **how):  # type: ignore[arg-type]
        files += _write(shooting.out, shot, modalities)
        if shot.camera.name != TOP:
            frames.append((shot.pictures["rgb"], caption(shot.tick, shot.steps)))
            seen.append(shot)
    visible = [shot.seen for shot in seen if shot.seen is not None]
    found = round(sum(share == 1 for share in visible) / len(visible), 4) if visible else None
    shows = {
        "pictures": len(seen),
        "with_person": sum(shot.person for shot in seen),
        "steps_with_objects": len(visible),
        "with_all_objects": sum(share == 1 for share in visible),
    }
    sheet = _sheet(shooting, frames)
    return {"pictures": len(files), "files": files, "visible": found, "shows": shows, "sheet": sheet}


def _shown(shows: Mapping[str, int]) -> str:
    """Return the line that counts what the pictures of the contact sheet show."""
    line = f"The contact sheet shows the person in {shows['with_person']} of {shows['pictures']} pictures"
    if not shows["steps_with_objects"]:
        return f"{line}."
    return (
        f"{line}, and all objects of {shows['with_all_objects']} of the {shows['steps_with_objects']} steps with any."
    )


def videos(
    shooting: Shooting, names: list[str], fps: float, quality: str = "draft", modalities: Sequence[str] = ("rgb",)
) -> dict[str, Any]:
    """Film an execution by some cameras, and return files, pages and steps."""

    from hearth.rendering.film.contact_sheet import caption
    from hearth.rendering.film.execution_keyframes import trajectory_of
    from hearth.rendering.film.player import page
    from hearth.rendering.film.video import record
    from hearth.rendering.scene.film_variation import drawn
    from hearth.storage.names import inside

    variation = drawn(shooting.seed, shooting.title) if shooting.vary else None
    trajectory = trajectory_of(*shooting[:3], seed=shooting.seed, hour=shooting.hour, variation=variation)
    out = shooting.out
    videos, frames, pages = [], [], []
    for name in names:
        how: dict[str, Any] = {"size": shooting.size, "fps": fps, "quality": quality, "modalities": modalities}
        done = record(trajectory, shooting.graph, out, name, **how)
        files = [path.name for path in done.files]
        pages.append(str(inside(out, f"{name}.html")))
        Path(pages[-1]).write_text(page(shooting.title, files, done.steps), encoding="utf-8")
        made = {"camera": name, "files": files, "fps": fps, "frames": done.frames, "steps": done.steps}
        if done.further:
            made["further"] = [path.name for path in done.further]
        videos.append({**made, "variation": trajectory.variation.row()})
        frames += [(picture, caption(span.tick, span.steps)) for picture, span in done.keyframes]
    output.write(out / "steps.json", videos)
    count = sum(int(video["frames"]) for video in videos)  # type: ignore[call-overload]
    return {"pictures": count, "videos": videos, "pages": pages, "sheet": _sheet(shooting, frames)}


def _sheet(shooting: Shooting, frames: list[Any]) -> str:
    from hearth.rendering.film.contact_sheet import contact_sheet
    from hearth.rendering.film.png import encode

    path = shooting.out / "sheet.png"
    path.write_bytes(encode(contact_sheet(frames, shooting.title)))
    return str(path)


def sheet(out: Path, fine: bool = False, as_json: bool = False) -> None:
    """Draw every model, variant and state at 128 pixels.

    \b
    Example:
      hearth render-sheet --out models.png
    """
    from hearth.rendering.film.png import encode
    from hearth.rendering.models.model_sheet import entries
    from hearth.rendering.models.model_sheet import sheet as draw
    from hearth.storage.chosen_files import write

    out.parent.mkdir(parents=True, exist_ok=True)
    write(out, encode(draw(quality="fine" if fine else "draft")))
    labels = [label for label, _ in entries()]
    output.say(f"Every model ({len(labels)}) is in {out}.", {"file": out, "models": labels}, as_json)


def gallery(
    out: Path,
    sources: list[Path] | None = None,
    count: int = 24,
    seed: int = 0,
    width: int = 320,
    fine: bool = False,
    as_json: bool = False,
) -> None:
    """Picture steps, each in another home, of another person, at another hour; actions differ as far as they can.

    \b
    Example:
      hearth render-gallery --fine --width 224 --out docs/pictures/steps.png
    """
    from hearth.analysis.programs_in_homes import Script, scripts
    from hearth.analysis.step_gallery import gallery as pictured
    from hearth.commands.progress_line import bar, watched
    from hearth.kb.loading.load import default
    from hearth.rendering.film.contact_sheet import contact_sheet
    from hearth.rendering.film.png import encode
    from hearth.schemas.syntax import print_step
    from hearth.storage.chosen_files import write

    known = default()
    programs = [script.program for script in scripts(inputs.paths(sources or []), known) if isinstance(script, Script)]
    size, quality = (width, width * 3 // 4), "fine" if fine else "draft"
    with bar("steps pictured") as seen:
        steps = pictured(programs, known, count, seed, size=size, quality=quality)
        found = list(watched(steps, seen, count))
    captions = [f"{number}. {print_step(step.step)}" for number, step in enumerate(found, 1)]
    frames = [(step.picture, caption) for step, caption in zip(found, captions, strict=True)]
    out.parent.mkdir(parents=True, exist_ok=True)
    write(out, encode(contact_sheet(frames, columns=6)))
    rows = [
        {"home": one.home, "hour": one.hour, "program": one.title, "step": print_step(one.step), "shown": one.shown}
        for one in found
    ]
    shown = sum(step.shown for step in found)
    output.say(
        f"{output.counted(len(found), 'step')} in {out}; person and object can be recognised in {shown}.",
        {"file": out, "steps": rows},
        as_json,
    )


def visible(sources: list[Path] | None = None, count: int = 30, seed: int = 0, as_json: bool = False) -> None:
    """Count the steps that the chosen picture shows, over programs drawn from a corpus.

    A step is shown if the person and the objects that it names can be recognised.

    \b
    Example:
      hearth render-visible --count 30 --seed 7
    """
    from hearth.commands.progress_line import bar, watched
    from hearth.rendering.cameras.visibility import shares

    found, missed, programs = [], [], 0
    with bar("programs looked at") as seen:
        looked = list(watched(_looked(sources or [], count, seed), seen, count))
    for execution, looks in looked:
        programs += 1
        found += looks
        classes = {node.id: node.class_name for node in execution.worlds[0].graph().nodes}
        title = execution.program.title
        missed += [
            (title, look.tick, ", ".join(classes[node] for node in look.unseen)) for look in looks if look.unseen
        ]
    share = shares(found)
    if as_json:
        output.emit({"programs": programs, **share._asdict(), "unseen": missed})
        return
    output.line(
        f"{share.shown:.1%} of the steps of {programs} programs are shown: one recognises the person and the objects,"
    )
    output.line("which cover at least 1.5 % and 0.1 % of the chosen picture and are less than half hidden.")
    output.line(f"{share.steps} steps name objects. All of these are visible to the chosen camera in")
    output.line(
        f"{share.chosen:.1%} of the steps, to it or from above in {share.either:.1%}; and in {share.open_:.1%} of the"
    )
    output.line("steps without an object in a closed container.")
    output.table(("program", "tick", "not visible"), missed)


def _looked(sources: list[Path], count: int, seed: int) -> Iterator[tuple[Execution, list[TickVisibility]]]:
    """Yield executable programs drawn by the seed, each in the next of our homes, with its objects' visibility."""
    from hearth.analysis.random_program_home_pairs import pairs
    from hearth.rendering.cameras.visibility import tick_visibilities
    from hearth.rendering.film.execution_keyframes import trajectory_of

    known = inputs.read_knowledge(None)
    for execution, _, graph in islice(pairs(inputs.paths(sources), known, seed), count):
        yield execution, list(tick_visibilities(trajectory_of(execution, graph, known, seed=seed), graph))


def _execution(program: Program, home: Home, seed: int, *, own: bool) -> Execution:
    """Return a program's execution: in a user's `own` home as it is, in one of ours also in a home made for it."""
    from hearth.grounding.grounded_run import as_given, attempt
    from hearth.schemas.failure_words import in_program

    if own:
        return as_given(program, home, seed).execution
    trial = attempt(program, home, seed)
    if isinstance(trial, Failure):
        raise HearthError.of(trial.code, in_program(trial, program, code=False))
    return trial.execution


def _say(made: Mapping[str, Any], failure: str | None, changes: Sequence[str], note: str, pictures: str) -> None:
    """Print what was pictured, what was changed in the home before, and why the program stopped."""
    output.line(note, end="\n" if note else "")
    if changes:
        output.line(f"The home was changed, so that the program runs: {'; '.join(changes)}.")
    output.line(f"{pictures}; contact sheet: {made['sheet']}")
    if "shows" in made:
        output.line(_shown(made["shows"]))
    for page in made.get("pages", ()):
        output.line(f"Open {page} in a browser.")
    if failure:
        output.line(f"Stopped: {failure}")


def _changes(scene: EnvironmentGraph, home: str, execution: Execution, known: Knowledge) -> list[str]:
    """Return the objects that were added to a home, and the states and relations that were changed, counted."""
    from hearth.commands.home_changes_before_run import additions, names_of
    from hearth.simulation.world.home import Home
    from hearth.simulation.world.world import World

    before = World.start(Home.from_graph(scene, home, known)).graph()
    after = execution.worlds[0].graph()
    found = additions(before, after)._replace(edges=(), removed_edges=())
    return list(found.lines(names_of(before, after)))


def _write(out: Path, shot: Snapshot, modalities: list[str]) -> list[str]:
    import orjson

    from hearth.rendering.film.execution_pictures import TOP
    from hearth.rendering.film.png import encode
    from hearth.rendering.modalities import PICTURES

    view = TOP if shot.camera.name == TOP else "auto"
    names = []
    for modality in modalities:
        value, drawn = shot.pictures[modality], modality in PICTURES
        names.append(f"{shot.tick:03d}.{view}.{modality}.{'png' if drawn else 'json'}")
        (out / names[-1]).write_bytes(encode(value) if drawn else orjson.dumps(value, option=orjson.OPT_INDENT_2))
    return names
