"""`build`, and each stage by its name."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from hearth.commands import options, output

if TYPE_CHECKING:
    from hearth.pipelines.build import Funnel

Sources = Annotated[
    list[Path] | None, typer.Argument(metavar="[SOURCE]...", help="Files and folders; the embedded corpus if none.")
]
Out = Annotated[Path, typer.Option("--out", "-o", metavar="DIR", help="Gets one folder a stage.")]
Jobs = Annotated[
    int,
    typer.Option(
        "--workers", "-j", metavar="N", min=0, callback=options.processes, help="Processes; 0 for one a core."
    ),
]
Only = Annotated[str | None, typer.Option("--only", metavar="STAGE", help="Run one stage on what is there.")]
InHomes = Annotated[
    list[str] | None, typer.Option("--home", metavar="NAME", help="Sample in this home; may be given several times.")
]
SomeHomes = Annotated[
    list[str] | None, typer.Option("--homes", metavar="DIR", help="A folder of homes laid over ours; or `all` of them.")
]
Rehearsed = Annotated[
    list[Path] | None, typer.Argument(metavar="[SOURCE]...", help="Try these programs, and write nothing.")
]
NodesWanted = Annotated[
    int | None,
    typer.Option(
        "--nodes",
        metavar="N",
        min=1,
        help="With SOURCE: environments of N nodes, 10 more or less: small homes are filled, large ones thinned.",
    ),
]
Salt = Annotated[
    str | None, typer.Option("--salt", metavar="TEXT", envvar="HEARTH_SALT", help="Hashed with the ids of workers.")
]
Pictures = Annotated[int, typer.Option("--pictures", metavar="N", min=0, help="Picture so many programs.")]
Videos = Annotated[int, typer.Option("--videos", metavar="N", min=0, help="Film so many of them in motion.")]
Variants = Annotated[
    int,
    typer.Option("--per-program", "--variants", metavar="N", min=0, help="Perturbed environments for each execution."),
]
Target = Annotated[
    int, typer.Option("--target", metavar="N", min=0, help="Augmented programs wanted; 0 for all --per-program gives.")
]
HomesEach = Annotated[
    int,
    typer.Option("--homes-each", metavar="N", min=0, help="Sample each program in N homes drawn for it; 0 for all."),
]

Tier = Annotated[
    str, typer.Option("--tier", metavar="NAME", help="How much it holds: mini, full or frames; other options go first.")
]

EngineName = Annotated[
    str, typer.Option("--engine", metavar="NAME", help="What runs the partitions: local (processes here) or dask.")
]
Scheduler = Annotated[
    str, typer.Option("--scheduler", metavar="ADDRESS", help="With --engine dask: use the cluster that is there.")
]
TimeLimit = Annotated[
    float,
    typer.Option("--time-limit", metavar="SECONDS", min=0, help="What one record may take in a stage; 0 for any time."),
]
LogJson = Annotated[bool, typer.Option("--log-json", help="Progress as lines of JSON on stderr.")]
Force = Annotated[bool, typer.Option("--force", help="Build even where the disk looks too small for it.")]

_OUT = Path("data_out")
_CODES = 4
_ALL = "all"


def build(
    context: typer.Context,
    sources: Sources = None,
    out: Out = _OUT,
    seed: options.Seed = 0,
    workers: Jobs = 0,
    limit: options.Limit = None,
    only: Only = None,
    home: InHomes = None,
    homes: options.Homes = None,
    kb: options.Kb = None,
    salt: Salt = None,
    homes_each: HomesEach = 0,
    variants: Variants = 3,
    target: Target = 0,
    pictures: Pictures = 3,
    videos: Videos = 1,
    tier: Tier = "",
    engine: EngineName = "local",
    scheduler: Scheduler = "",
    time_limit: TimeLimit = 60.0,
    force: Force = False,
    log_json: LogJson = False,
    strict: options.Strict = False,
    as_json: options.Json = False,
) -> None:
    """Run the stages one after another and publish a dataset.

    What a source is, is told by its content: the ActivityPrograms release (zip or folder), crowd-sourcing CSV, program
    text, steps in words, JSON Lines, sketches, scene graphs, a dataset; packed or not. What did not change since the
    last build is not done again, and a build that was stopped goes on where it was. Ends with what became of every
    record. Folders may be URLs (s3://bucket/folder): see `pip install 'hearth[remote]'`.

    \b
    Examples:
      python cli.py build --out data_out
      python cli.py build release.zip my_programs/ --out mine --seed 7 --workers 4
      python cli.py build corpus.csv --out small --tier mini
      python cli.py build corpus.csv --out s3://bucket/homes --engine dask --scheduler tcp://10.0.0.1:8786
    """
    from hearth.pipelines.engine.tiers import tiered

    sources_of = {name: context.get_parameter_source(name) for name in context.params}
    given = [name for name, source in sources_of.items() if source and source.name == "COMMANDLINE"]
    _run(context, only, tiered(tier, context.params, given))


def ingest(
    context: typer.Context,
    sources: Sources = None,
    out: Out = _OUT,
    limit: options.Limit = None,
    salt: Salt = None,
    workers: Jobs = 0,
    strict: options.Strict = False,
    as_json: options.Json = False,
) -> None:
    """Read descriptions and programs, from whatever they arrived in.

    \b
    Example:
      python cli.py ingest batch.csv --out data_out
    """
    _run(context, "ingest")


def validate(
    context: typer.Context,
    out: Out = _OUT,
    kb: options.Kb = None,
    workers: Jobs = 0,
    strict: options.Strict = False,
    as_json: options.Json = False,
) -> None:
    """Check every ingested program against the action grammar.

    \b
    Example:
      python cli.py validate --out data_out
    """
    _run(context, "validate")


def sample(
    context: typer.Context,
    sources: Rehearsed = None,
    out: Out = _OUT,
    seed: options.Seed = 0,
    home: InHomes = None,
    homes: SomeHomes = None,
    kb: options.Kb = None,
    size: NodesWanted = None,
    limit: options.Limit = None,
    workers: Jobs = 0,
    strict: options.Strict = False,
    as_json: options.Json = False,
) -> None:
    """Place every valid program in homes where it runs.

    With a SOURCE nothing is written: its programs are tried in environments sampled from every home, and what becomes
    of each pair of a program and a home is counted: ran; proven impossible, with the two steps or the fact that forbid
    it; failed, with why.

    \b
    Examples:
      python cli.py sample --out data_out --seed 7 --home maple
      python cli.py sample release.zip --homes all --homes their_homes --json
      python cli.py sample release.zip --homes all --nodes 290
    """
    folder = next((Path(text) for text in homes or () if text != _ALL), None)
    if not sources:
        if size is not None or limit is not None:
            raise typer.BadParameter("only for programs of a SOURCE, which are tried and not written",
                                     param_hint="--nodes, --limit")  # fmt: skip
        _run(context, "sample", {**context.params, "homes": folder})
        return
    from hearth.commands import coverage

    settings = _settings({"seed": seed, "home": home, "homes": folder, "kb": kb})
    coverage.show(sources, settings, size=size, limit=limit, strict=strict, as_json=as_json)


def augment(
    context: typer.Context,
    out: Out = _OUT,
    seed: options.Seed = 0,
    home: InHomes = None,
    homes: SomeHomes = None,
    kb: options.Kb = None,
    variants: Variants = 3,
    target: Target = 0,
    workers: Jobs = 0,
    strict: options.Strict = False,
    as_json: options.Json = False,
) -> None:
    """Perturb what programs rely on, run them, and repair what breaks.

    With --target, pairs are spread evenly over all executions, at most --per-program each. `--homes` takes a folder of
    homes, or names of ours, separated by commas, to augment in; `all` by default.

    \b
    Examples:
      python cli.py augment --out data_out --per-program 5
      python cli.py augment --out data_out --target 30000 --homes maple,birch --json
    """
    folder, names = _homes_or_names(homes)
    chosen = {**context.params, "home": [*(home or ()), *names], "homes": folder}
    if not as_json:
        _run(context, "augment", chosen)
        return
    from hearth.analysis.augment_figures import outcome

    found = _built("augment", chosen)
    output.emit(outcome(out / "augment"))
    output.status(found.stages["augment"].rejected, strict=strict)


def _homes_or_names(given: list[str] | None) -> tuple[Path | None, list[str]]:
    """What stands after --homes: the folder, and names where it is none."""
    texts = [text for text in given or () if text != _ALL]
    folder = next((Path(text) for text in texts if Path(text).is_dir()), None)
    return folder, [name for text in texts if not Path(text).is_dir() for name in text.split(",") if name]


def render(
    context: typer.Context,
    out: Out = _OUT,
    seed: options.Seed = 0,
    pictures: Pictures = 3,
    videos: Videos = 1,
    homes: options.Homes = None,
    kb: options.Kb = None,
    workers: Jobs = 0,
    strict: options.Strict = False,
    as_json: options.Json = False,
) -> None:
    """Picture a few programs while they run, and film some of them.

    \b
    Example:
      python cli.py render --out data_out --pictures 10 --videos 2
    """
    _run(context, "render")


def publish(
    context: typer.Context,
    out: Out = _OUT,
    seed: options.Seed = 0,
    homes: options.Homes = None,
    kb: options.Kb = None,
    workers: Jobs = 0,
    strict: options.Strict = False,
    as_json: options.Json = False,
) -> None:
    """Write the tables, the catalog and the manifest; what does not replay is refused.

    \b
    Example:
      python cli.py publish --out data_out
    """
    _run(context, "publish")


def _run(context: typer.Context, only: str | None, chosen: Mapping[str, Any] | None = None) -> None:
    """Build as a command's options say, or as `chosen` does instead, and print what became of the records."""
    given = context.params
    found = _built(only, chosen or given)
    if given["as_json"]:
        output.emit(found.to_json())
    else:
        _print(found, given["out"], whole=only is None)
    output.status(found.rejected, strict=given["strict"])


def _built(only: str | None, chosen: Mapping[str, Any]) -> Funnel:
    from hearth.pipelines.build import build as run
    from hearth.pipelines.engine.progress import JsonLines, for_terminal

    paths = [str(path) for path in chosen.get("sources") or ()]
    progress = JsonLines() if chosen.get("log_json") else for_terminal()
    return run(paths, str(chosen["out"]), only=only, progress=progress, **_settings(chosen))


_NAMES = {"homes": "homes_folder", "kb": "kb_folder", "home": "homes"}
"""Options that are called otherwise in `Settings`."""

_OTHERS = frozenset({"sources", "out", "only", "tier", "size", "log_json", "strict", "as_json"})
"""Options that are none of the settings."""


def _settings(chosen: Mapping[str, Any]) -> dict[str, Any]:
    """The settings of a build by what was chosen for the options of a command."""
    found = {_NAMES.get(name, name): value for name, value in chosen.items() if name not in _OTHERS}
    folders = {name: str(found[name]) for name in ("homes_folder", "kb_folder") if found.get(name) is not None}
    return {**found, **folders, **({"homes": tuple(found["homes"] or ())} if "homes" in found else {})}


def _print(found: Funnel, out: Path, *, whole: bool) -> None:
    rows = [
        (name, counts.records_in, counts.through, counts.rejected, counts.rows.total(), _reasons(counts.codes))
        for name, counts in found.stages.items()
    ]
    sys.stdout.write("\n")
    output.table(("stage", "records in", "went on", "rejected", "rows out", "why rejected"), rows)
    if whole and found.dataset:
        command = Path(sys.argv[0]).name
        program = "python cli.py" if command == "cli.py" else "hearth"
        print(f"\nThe dataset is in {found.dataset}. Try next:")
        for line in _NEXT:
            print(f"  {program} {line.format(out=out)}")


_NEXT = (
    'query {out} "SELECT title, count(*) AS programs FROM programs GROUP BY title ORDER BY programs DESC LIMIT 10"',
    'query {out} "SELECT code, count(*) AS rejects FROM rejects GROUP BY code ORDER BY rejects DESC"',
    'query {out} "SELECT program_text(program_id) FROM programs WHERE parent_id IS NOT NULL LIMIT 1"',
)


def _reasons(codes: Any) -> str:
    shown = [f"{code} {count:,}" for code, count in codes.most_common(_CODES)]
    return ", ".join(shown) + (", ..." if len(codes) > _CODES else "")
