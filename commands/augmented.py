"""`augmented`: compares an augmented dataset with the thesis's."""

from pathlib import Path
from typing import Any

from hearth.commands import output

_BAR = 40


def augmented(
    dataset: Path = Path("data_out"),
    out: Path | None = None,
    circumstances: bool = False,
    workers: int = 0,
    as_json: bool = False,
) -> None:
    """Print table 5.1 of the thesis next to a dataset's own figures, and the effects of augmenting.

    The output counts programs, steps, nodes and edges. It has lengths of programs before and after, and conditions of
    their objects at the start (figure 5-4, for cups and sauce pans). It counts near-duplicates of one parent in one
    home (none are expected). With --circumstances every augmented program and its original run again. The output then
    has the share of programs that do each step they have kept as the original does it: sitting, lying, holding, with
    the same things opened or switched on. It also has the number of programs that are never seated for an activity that
    the original does in its seat.

    \b
    Examples:
      hearth augmented data_out --out figures
      hearth augmented data_out --circumstances
    """
    from hearth.analysis.augmentation_results import figures

    found = figures(_published(dataset))
    if circumstances:
        from hearth.analysis.context_preservation import measure
        from hearth.commands.progress_line import bar

        with bar("shares run again") as seen:
            found["circumstances"] = measure(_published(dataset), workers, seen)
    if out is not None:
        from hearth.analysis.augmentation_charts import draw

        found["files"] = [str(file) for file in draw(found, out)]
    if as_json:
        output.emit(found)
        return
    output.line(f"Augmented by the strength `{found['strength']}`.\n")
    _print_table(found["table"])
    if circumstances:
        _print_circumstances(found["circumstances"])
    output.line(f"\nNear-duplicates of a sibling in the same home: {found['near_duplicates']}")
    output.line(f"Programs with an environment they run in: {_percent(found['executable_share'])}")
    output.line(f"Bytes of an execution, with program, environment and repairs: {found['bytes_a_program']}")
    for file in found.get("files", ()):
        output.line(f"Drawn: {file}")
    before, after = found["lengths"]["executable"], found["lengths"]["augmented"]
    output.line("\nPrograms by length")
    output.table(("steps", "originals", "augmented"), [(name, before[name], after[name]) for name in before])
    for name, conditions in found["conditions"].items():
        if not conditions:
            output.line(f"\nNo condition of the start names a {name.replace('_', ' ')}.")
            continue
        output.line(f"\nConditions of the start that name a {name.replace('_', ' ')}: before and after augmenting")
        for condition, shares in conditions.items():
            for label, share in shares.items():
                output.line(f"  {condition if label == 'before' else '':12} {label:7} {_bar(share)} {_percent(share)}")


def _published(folder: Path) -> Path:
    return folder / "publish" if (folder / "publish").is_dir() else folder


def _print_table(table: dict[str, Any]) -> None:
    rows = [
        (group, who, *("-" if value is None else value for value in row.values()))
        for group, compared in table.items()
        for who, row in compared.items()
    ]
    output.table(("programs", "", "how many", "length", "nodes", "edges"), rows)
    output.line("The thesis's 1,387 and 27,284 add up to 28,671; it states 32,761.")


def _print_circumstances(found: dict[str, Any]) -> None:
    output.line("\nIn the circumstances of the original")
    for what in ("programs", "steps"):
        counts = found[what]
        output.line(f"  {what:8} {counts['as_original']:,} of {counts['all']:,}, {_percent(counts['share'])}")
    output.table(
        ("done in a seat by the original", "programs", "never in a seat"),
        [(action, *counts.values()) for action, counts in found["seats"].items()],
    )
    for name in found["odd"]:
        output.line(f"In others: {name}")


def _bar(share: float) -> str:
    return ("#" * round(share * _BAR)).ljust(_BAR)


def _percent(share: float | None) -> str:
    return "-" if share is None else f"{share:.1%}"
