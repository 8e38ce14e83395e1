"""`corpus`: what a dataset's words and programs look like, more of them, and how well faults in them are found."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated, Any

import typer

from hearth.commands import output
from hearth.commands.inputs import Kb

app = typer.Typer(help="What people say and write: statistics, synthesis, ratings, and how well faults are found.")

Count = Annotated[int, typer.Argument(metavar="[N]", min=1, help="How many programs.")]
Seed = Annotated[int, typer.Option("--seed", metavar="N", min=0, help="Of everything random.")]
Out = Annotated[Path | None, typer.Option("--out", "-o", metavar="FILE", help="Where to; standard output if left out.")]


@app.command()
def synthesize(
    count: Count = 5_193,
    seed: Seed = 0,
    actions: Annotated[
        str, typer.Option("--actions", metavar="animated|all", help="The 14 that the thesis animates, or all.")
    ] = "animated",
    told: Annotated[int, typer.Option("--descriptions", metavar="N", min=1, help="Ways to tell each program.")] = 2,
    grammar: Annotated[
        Path | None, typer.Option("--grammar", metavar="FILE", help="A grammar instead of ours.")
    ] = None,
    out: Out = None,
    kb: Kb = None,
    as_json: output.Json = False,
) -> None:
    """Draw distinct programs with descriptions from a probabilistic grammar, as JSON Lines that `build` reads.

    \b
    Examples:
      python cli.py corpus synthesize --out synthetic.jsonl
      python cli.py corpus synthesize 20000 --seed 7 --actions all --out more.jsonl
    """
    import orjson

    from hearth.commands.inputs import read_knowledge
    from hearth.pipelines import synthesis
    from hearth.pipelines.files import replacing

    if actions not in ("animated", "all"):
        raise typer.BadParameter("`animated` or `all`", param_hint="--actions")
    weights = synthesis.load(grammar or synthesis.FILE, read_knowledge(kb), every_action=actions == "all")
    drawn = synthesis.synthesize(count, seed, weights, told)
    lines = (orjson.dumps(synthesis.record(one, number, seed)) + b"\n" for number, one in enumerate(drawn, 1))
    if out is None:
        sys.stdout.buffer.writelines(lines)
        return
    with replacing(out) as temporary, temporary.open("wb") as file:
        file.writelines(lines)
    if as_json:
        output.emit({"programs": count, "seed": seed, "file": out})
    else:
        print(f"{output.counted(count, 'program')} in {out}")


def _say(title: str, columns: tuple[str, ...], rows: list[tuple[Any, ...]]) -> None:
    output.table(columns, rows, title)
    print()
