"""`build`, and a command for each stage."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from inspect import Signature, signature
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from hearth.commands import output
from hearth.commands.command_line_name import program_name
from hearth.kb.language.reading_modes import Fuzzy

if TYPE_CHECKING:
    from hearth.pipelines.build import Funnel


_OUT = Path("data_out")
_CODES = 4
_ALL = "all"


def build(
    context: typer.Context,
    sources: list[Path] | None = None,
    out: Path = _OUT,
    seed: int = 0,
    workers: int = 0,
    limit: int | None = None,
    columns: str = "",
    fuzzy: Fuzzy = Fuzzy.TYPOS,
    only: str | None = None,
    home: list[str] | None = None,
    homes: Path | None = None,
    kb: Path | None = None,
    salt: str | None = None,
    homes_each: int = 0,
    action_set: int | None = None,
    strength: str = "mild",
    variants: int = 3,
    target: int = 0,
    pictures: int = 3,
    videos: int = 1,
    clips: int = 0,
    demonstrations: int = 0,
    tier: str = "",
    engine: str = "local",
    scheduler: str = "",
    time_limit: float = 60.0,
    force: bool = False,
    log_json: bool = False,
    strict: bool = False,
    as_json: bool = False,
) -> None:
    """Run the stages one after another and publish a dataset.

    Sources are recognised by content: the ActivityPrograms release (zip or folder), tables (CSV), program text, plans
    of language models, JSON or JSON Lines, sketches, scene graphs, a dataset; packed or not. A second build runs only
    the changed parts, and a stopped build continues. The last table counts the records of each stage. Folders may be
    URLs (s3://bucket/folder), with the extra `remote`.

    \b
    Examples:
      hearth build --out data_out
      hearth build release.zip my_programs/ --out mine --seed 7 --workers 4
      hearth build corpus.csv --out small --tier mini
      hearth build release.zip --out hard --strength thesis
      hearth build corpus.csv --out before --action-set 2
      hearth build sheet.csv --out mine --columns title=Task,description=Text,program=Plan
      hearth build corpus.csv --out s3://bucket/homes --engine dask --scheduler tcp://10.0.0.1:8786
    """
    from hearth.pipelines.engine.option_presets import STANDARD

    _run(context, only, _tiered(context, tier or ("" if sources else STANDARD)))


def _tiered(context: typer.Context, tier: str = "") -> dict[str, Any]:
    """Return the options of a command, with those that its tier and its strength set."""
    from hearth.pipelines.engine.option_presets import tiered

    sources_of = {name: context.get_parameter_source(name) for name in context.params}
    given = [name for name, source in sources_of.items() if source and source.name == "COMMANDLINE"]
    return tiered(tier, context.params, given)


def _with_options(*names: str) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Give a stage's command these options of `build`, and those of every stage."""
    of_build = signature(build, eval_str=True).parameters
    wanted = [of_build[name] for name in ("context", *names, "workers", "strict", "as_json")]

    def given(command: Callable[..., None]) -> Callable[..., None]:
        command.__signature__ = Signature(wanted)  # type: ignore[attr-defined]
        return command

    return given


@_with_options("sources", "out", "limit", "columns", "salt")
def ingest(context: typer.Context, **_: Any) -> None:
    """Read descriptions and programs of any known form.

    \b
    Example:
      hearth ingest batch.csv --out data_out
    """
    _run(context, "ingest")


@_with_options("out", "fuzzy", "kb", "action_set")
def validate(context: typer.Context, **_: Any) -> None:
    """Check every ingested program against the action grammar.

    \b
    Example:
      hearth validate --out data_out
    """
    _run(context, "validate")


def sample(
    context: typer.Context,
    sources: list[Path] | None = None,
    out: Path = _OUT,
    seed: int = 0,
    home: list[str] | None = None,
    homes: list[str] | None = None,
    kb: Path | None = None,
    action_set: int | None = None,
    size: int | None = None,
    limit: int | None = None,
    workers: int = 0,
    strict: bool = False,
    as_json: bool = False,
) -> None:
    """Place every valid program in homes where it runs.

    With a SOURCE nothing is written: its programs are run in environments sampled from every home. Each pair of a
    program and a home is counted as run; as impossible, with the steps or the fact that prove it; or as failed, with
    the reason.

    \b
    Examples:
      hearth sample --out data_out --seed 7 --home maple
      hearth sample --out data_out --action-set 2
      hearth sample release.zip --homes all --homes their_homes --json
      hearth sample release.zip --homes all --nodes 290
    """
    folder = next((Path(text) for text in homes or () if text != _ALL), None)
    if not sources:
        if size is not None or limit is not None:
            raise typer.BadParameter("only with a SOURCE, whose programs are tried and not written",
                                     param_hint="--nodes, --limit")  # fmt: skip
        _run(context, "sample", {**context.params, "homes": folder})
        return
    from hearth.commands import programs_in_every_home

    settings = _settings({"seed": seed, "home": home, "homes": folder, "kb": kb, "action_set": action_set})
    programs_in_every_home.show(sources, settings, size=size, limit=limit, strict=strict, as_json=as_json)


def augment(
    context: typer.Context,
    out: Path = _OUT,
    seed: int = 0,
    home: list[str] | None = None,
    homes: list[str] | None = None,
    kb: Path | None = None,
    action_set: int | None = None,
    strength: str = "mild",
    variants: int = 3,
    target: int = 0,
    workers: int = 0,
    strict: bool = False,
    as_json: bool = False,
) -> None:
    """Perturb the preconditions of programs, run them, and repair the failures.

    With --target, pairs are spread evenly over all executions, at most --per-program each. `--homes` is a folder of
    homes, or names of ours separated by commas; by default programs are augmented in `all` homes.

    \b
    Examples:
      hearth augment --out data_out --per-program 5
      hearth augment --out data_out --strength thesis
      hearth augment --out data_out --target 30000 --homes maple,birch --json
    """
    folder, names = _homes_or_names(homes)
    chosen = {**_tiered(context), "home": [*(home or ()), *names], "homes": folder}
    if not as_json:
        _run(context, "augment", chosen)
        return
    from hearth.analysis.augmentation_results import outcome

    found = _built("augment", chosen)
    output.emit(outcome(out / "augment"))
    output.status(found.stages["augment"].rejected, strict=strict)


def _homes_or_names(given: list[str] | None) -> tuple[Path | None, list[str]]:
    """Return the values of --homes: a folder, and names of homes."""
    texts = [text for text in given or () if text != _ALL]
    folder = next((Path(text) for text in texts if Path(text).is_dir()), None)
    return folder, [name for text in texts if not Path(text).is_dir() for name in text.split(",") if name]


@_with_options("out", "seed", "pictures", "videos", "clips", "demonstrations", "homes", "kb")
def render(context: typer.Context, **_: Any) -> None:
    """Picture a few programs while they run, and film some of them.

    \b
    Example:
      hearth render --out data_out --pictures 10 --videos 2
    """
    _run(context, "render")


@_with_options("out", "seed", "homes", "kb")
def publish(context: typer.Context, **_: Any) -> None:
    """Write the tables, the catalog and the manifest; an execution that does not replay is refused.

    \b
    Example:
      hearth publish --out data_out
    """
    _run(context, "publish")


def _run(context: typer.Context, only: str | None, chosen: Mapping[str, Any] | None = None) -> None:
    """Build by the options of a command, or by `chosen`, and print the counts of records."""
    given = context.params
    found = _built(only, chosen or given)
    if given["as_json"]:
        output.emit(found.to_json())
    else:
        _print(found, given["out"], whole=only is None)
    output.status(found.rejected, strict=given["strict"])


def _built(only: str | None, chosen: Mapping[str, Any]) -> Funnel:
    from hearth.pipelines.build import FIRST, corpus
    from hearth.pipelines.build import build as run
    from hearth.pipelines.engine.option_presets import FIRST as FIRST_TIER
    from hearth.pipelines.engine.progress import JsonLines, for_terminal

    paths = [str(path) for path in chosen.get("sources") or ()]
    if not paths and chosen.get("tier") == FIRST_TIER:
        paths = list(corpus(FIRST))
    progress = JsonLines() if chosen.get("log_json") else for_terminal()
    return run(paths, str(chosen["out"]), only=only, progress=progress, **_settings(chosen))


_NAMES = {"homes": "homes_folder", "kb": "kb_folder", "home": "homes"}
"""Options with another name in `Settings`."""

_OTHERS = frozenset({"sources", "out", "only", "tier", "size", "log_json", "as_json"})
"""Options that are not settings."""


def _settings(chosen: Mapping[str, Any]) -> dict[str, Any]:
    """Return the settings of a build, from the options of a command."""
    found = {_NAMES.get(name, name): value for name, value in chosen.items() if name not in _OTHERS}
    folders = {name: str(found[name]) for name in ("homes_folder", "kb_folder") if found.get(name) is not None}
    return {**found, **folders, **({"homes": tuple(found["homes"] or ())} if "homes" in found else {})}


def _print(found: Funnel, out: Path, *, whole: bool) -> None:
    rows = [
        (
            name,
            *(counts.records_in, counts.through, counts.rejected, counts.partial, counts.rows.total()),
            found.records[name],
            _reasons(counts.codes),
        )
        for name, counts in found.stages.items()
    ]
    output.line()
    for line in found.guesses:
        output.line(output.shown(line))
    if fuzzy := found.fuzzy:
        output.line(f"Read with words corrected or left out: {output.counted(fuzzy, 'step')}; `--strict` refuses them.")
    for line in found.unread:
        output.line(output.shown(f"Not read: {line}"))
    head = ("records in", "passed", "rejected", "parts rejected", "rows out", "records are", "reasons")
    output.table(("stage", *head), rows)
    if whole and found.dataset:
        output.line(f"\nThe dataset is in {found.dataset}. Try next:")
        for line in _NEXT:
            output.line(f"  {program_name()} {line.format(out=out)}")


_NEXT = (
    'query {out} "SELECT title, count(*) AS programs FROM programs GROUP BY title ORDER BY programs DESC LIMIT 10"',
    'query {out} "SELECT code, count(*) AS rejects FROM rejects GROUP BY code ORDER BY rejects DESC"',
    'query {out} "SELECT program_text(program_id) FROM programs WHERE parent_id IS NOT NULL LIMIT 1"',
)


def _reasons(codes: Any) -> str:
    shown = [f"{code} {count:,}" for code, count in codes.most_common(_CODES)]
    return ", ".join(shown) + (", ..." if len(codes) > _CODES else "")
