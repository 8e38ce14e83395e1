"""`augmented`: compares an augmented dataset with the thesis's."""

from pathlib import Path
from typing import Any

from hearth.commands import output

_BAR = 40


def augmented(dataset: Path = Path("data_out"), out: Path | None = None, as_json: bool = False) -> None:
    """Print table 5.1 of the thesis beside a dataset's own figures, and the effects of augmenting.

    Counts programs, steps, nodes and edges; lengths of programs before and after; conditions of their objects at the
    start (figure 5-4, for cups and sauce pans); near-duplicates of one parent in one home (none are expected).

    \b
    Example:
      python cli.py augmented data_out --out figures
    """
    from hearth.analysis.augment_figures import figures

    found = figures(_published(dataset))
    if out is not None:
        from hearth.analysis.augment_pictures import draw

        found["files"] = [str(file) for file in draw(found, out)]
    if as_json:
        output.emit(found)
        return
    _print_table(found["table"])
    print(f"\nNear-duplicates of a sibling in the same home: {found['near_duplicates']}")
    print(f"Programs with an environment they run in: {_percent(found['executable_share'])}")
    print(f"Bytes of an execution, with program, environment and repairs: {found['bytes_a_program']}")
    for file in found.get("files", ()):
        print(f"Drawn: {file}")
    before, after = found["lengths"]["executable"], found["lengths"]["augmented"]
    print("\nPrograms by length")
    output.table(("steps", "originals", "augmented"), [(name, before[name], after[name]) for name in before])
    for name, conditions in found["conditions"].items():
        print(f"\nConditions of the start that name a {name.replace('_', ' ')}: before and after augmenting")
        for condition, shares in conditions.items():
            for label, share in shares.items():
                print(f"  {condition if label == 'before' else '':12} {label:7} {_bar(share)} {_percent(share)}")


def _published(folder: Path) -> Path:
    return folder / "publish" if (folder / "publish").is_dir() else folder


def _print_table(table: dict[str, Any]) -> None:
    rows = [
        (group, who, *("-" if value is None else value for value in row.values()))
        for group, compared in table.items()
        for who, row in compared.items()
    ]
    output.table(("programs", "", "how many", "length", "nodes", "edges"), rows)
    print("The thesis's 1,387 and 27,284 add up to 28,671; it states 32,761.")


def _bar(share: float) -> str:
    return ("#" * round(share * _BAR)).ljust(_BAR)


def _percent(share: float | None) -> str:
    return "-" if share is None else f"{share:.1%}"
