"""Pictures by hand: of one program, and of all models."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from hearth.commands import output

if TYPE_CHECKING:
    from hearth.rendering.snapshots import Snapshot
    from hearth.simulation.engine import Execution

app = typer.Typer(no_args_is_help=True, help="Pictures of a program, and of every model.")

File = Annotated[Path, typer.Argument(metavar="FILE", help="A program file.")]
HomeName = Annotated[str, typer.Option("--home", metavar="NAME", help="A home with a floor plan.")]
Homes = Annotated[Path | None, typer.Option("--homes", metavar="DIR", help="A folder of homes laid over ours.")]
Out = Annotated[Path, typer.Option("--out", metavar="DIR", help="Where the pictures go.")]
OutFile = Annotated[Path, typer.Option("--out", metavar="FILE", help="A PNG file.")]
Seed = Annotated[int, typer.Option("--seed", metavar="N", help="Bodies, colours, and what has to be added.")]
Hour = Annotated[float, typer.Option("--hour", metavar="H", help="Time of day, 0 to 24.")]
Fine = Annotated[bool, typer.Option("--fine", help="Smooth edges and soft shadows; four times slower.")]
Width = Annotated[int, typer.Option("--width", metavar="PX", min=32, max=1920, help="Of one picture; 4 to 3.")]


@app.command()
def program(
    file: File,
    out: Out,
    home: HomeName = "maple",
    homes: Homes = None,
    seed: Seed = 0,
    hour: Hour = 10.0,
    width: Width = 320,
    fine: Fine = False,
) -> None:
    """Picture a program step by step: PNG files, and a contact sheet `sheet.png` with the steps as captions.

    \b
    Example:
      python cli.py render-program watch_tv.txt --home maple --out pictures
    """
    from hearth.rendering.contact import caption, contact_sheet
    from hearth.rendering.png import encode
    from hearth.rendering.snapshots import TOP, snapshots
    from hearth.simulation.homes import catalog

    execution = _execution(file, home, homes, seed)
    out.mkdir(parents=True, exist_ok=True)
    quality = "fine" if fine else "draft"
    frames = []
    graph = catalog.load_graph(home, homes)
    for shot in snapshots(execution, graph, size=(width, width * 3 // 4), quality=quality, seed=seed, hour=hour):
        _write(out, shot)
        if shot.camera.name != TOP:
            frames.append((shot.pictures["rgb"], caption(shot.tick, shot.steps)))
    (out / "sheet.png").write_bytes(encode(contact_sheet(frames, f"{execution.program.title}, in {home}")))
    print(f"{len(frames)} moments of {file.name} in {out}; all together: {out / 'sheet.png'}")
    if execution.failure is not None:
        print(f"It stopped there: {execution.failure.message()}")
        raise typer.Exit(output.BAD_INPUT)


@app.command()
def sheet(out: OutFile, fine: Fine = False) -> None:
    """Draw every model, variant and state at 128 pixels.

    \b
    Example:
      python cli.py render-sheet --out models.png
    """
    from hearth.rendering.png import encode
    from hearth.rendering.sheet import sheet as draw

    out.parent.mkdir(parents=True, exist_ok=True)
    out.write_bytes(encode(draw(quality="fine" if fine else "draft")))
    print(f"Every model is in {out}.")


def _execution(file: Path, home: str, homes: Path | None, seed: int) -> Execution:
    from hearth.commands.inputs import read_home, read_knowledge, read_program
    from hearth.grounding.trial import attempt
    from hearth.schemas.errors import HearthError
    from hearth.schemas.failures import Failure

    known = read_knowledge(None)
    trial = attempt(read_program(file, known), read_home(home, None, homes, known), seed)
    if isinstance(trial, Failure):
        raise HearthError.of(trial.code, trial.message(), file=str(file))
    return trial.execution


def _write(out: Path, shot: Snapshot) -> None:
    from hearth.rendering.png import encode
    from hearth.rendering.snapshots import TOP

    view = TOP if shot.camera.name == TOP else "auto"
    for modality, picture in shot.pictures.items():
        (out / f"{shot.tick:03d}.{view}.{modality}.png").write_bytes(encode(picture))
