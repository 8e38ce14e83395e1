"""A dataset's authors, method, purpose and limits: the same in every place."""

from pathlib import Path

from hearth.datasets.format.ids import OURS
from hearth.repair.perturbation_strengths import MILD, strength
from hearth.schemas.yaml_limits import packaged
from hearth.storage.duckdb_connections import open_database, pattern_of

STRENGTH = "strength"
"""Field of a manifest: the strength by which programs were augmented; missing in earlier datasets, which are mild."""


def datasheet(folder: Path, strength_used: str = MILD) -> dict[str, str]:
    """Paragraphs of Markdown by heading, for the tables of a folder; `authors` has those on its origins."""
    sheet, found = packaged("hearth.datasets.format", "datasheet.yaml"), _origins(folder)
    origins = sheet.pop("origins")
    origins["augmented"] += f" {strength(strength_used).says}"
    authors = [text for name, text in origins.items() if name in found]
    return {**sheet, "authors": " ".join(authors)}


def _origins(folder: Path) -> set[str]:
    """Return the origins of programs and descriptions; that of the embedded corpus was `crowd` in 0.1."""
    found: set[str] = set()
    with open_database() as connection:
        for table, key in (("programs", "program_id"), ("descriptions", "description_id")):
            ours = f"origin = 'crowd' AND regexp_matches({key}, '{OURS}')"
            rows = connection.read_parquet(f"{pattern_of(folder / table)}/*.parquet")
            found |= {name for (name,) in rows.project(f"if({ours}, 'written', origin)").distinct().fetchall()}
    return found
