"""Who wrote a dataset, how it was made, for what, and what it does not show: the same wherever it is said."""

from pathlib import Path

from hearth.datasets.format.ids import OURS
from hearth.schemas.yaml_extent import packaged


def datasheet(folder: Path) -> dict[str, str]:
    """Paragraphs of Markdown by heading, for the tables of a folder; `authors` has those on its origins."""
    sheet, found = packaged("hearth.datasets.format", "datasheet.yaml"), _origins(folder)
    authors = [text for name, text in sheet.pop("origins").items() if name in found]
    return {**sheet, "authors": " ".join(authors)}


def _origins(folder: Path) -> set[str]:
    """The origins of programs and descriptions; that of the embedded corpus was `crowd` in 0.1."""
    import duckdb

    found: set[str] = set()
    with duckdb.connect() as connection:
        for table, key in (("programs", "program_id"), ("descriptions", "description_id")):
            ours = f"origin = 'crowd' AND regexp_matches({key}, '{OURS}')"
            rows = connection.read_parquet(str(folder / table / "*.parquet"))
            found |= {name for (name,) in rows.project(f"if({ours}, 'written', origin)").distinct().fetchall()}
    return found
