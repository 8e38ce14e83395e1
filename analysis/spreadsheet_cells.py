"""CSV for spreadsheets, in which cells of text never run as formulas."""

import io
from collections.abc import Iterable

from hearth.storage.csv_files import rows_writer, safe_cell  # noqa: F401 safe_cell was here in 0.2


def original_cell(text: str) -> str:
    """Invert `safe_cell`; text without an apostrophe, which some spreadsheets remove, stays."""
    return text[1:] if text.startswith("'") else text


def sheet_of(rows: Iterable[Iterable[object]]) -> str:
    """Rows as CSV with safe text cells."""
    out = io.StringIO()
    rows_writer(out)(rows)
    return out.getvalue()
