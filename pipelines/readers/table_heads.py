"""The first line of a table: names of columns, or the first row of a table that has none."""

from collections.abc import Sequence

from hearth.kb.language.operator_step_syntax import names_thing
from hearth.pipelines.readers.delimited import Layout, Rows, layout_of
from hearth.pipelines.readers.field_columns import FieldColumns
from hearth.pipelines.readers.json_actions import is_known
from hearth.pipelines.readers.program_columns import reading_of
from hearth.pipelines.readers.step_lists import is_time

NUMBERED = "Its first line is a row: its columns are known by their numbers."


def begun(rows: Rows, given: FieldColumns) -> tuple[int, Layout, bool]:
    """Return the number and layout of the first line with text, and whether it is a row; the row is read again.

    Excel's `sep=;` before it names the delimiter.
    """
    delimiter = ""
    for number, line in rows:
        if line.lower().startswith("sep=") and len(line) == len("sep=;"):
            delimiter = line[-1]
        elif line.strip() and not (line.startswith("# ") and not layout_of(line, delimiter).columns[1:]):
            layout = layout_of(line, delimiter)
            names = () if set(given.values()) & set(layout.columns) else _names(layout.columns)
            if names:
                rows.put_back(number, line)
            return number, Layout(names or layout.columns, layout.delimiter), bool(names)
    return 1, Layout((), ","), False


def _names(cells: Sequence[str]) -> tuple[str, ...]:
    """Return the names of the columns of a table whose first line is a row; none if the line names them itself."""
    counted = next((n for n, cell in enumerate(cells) if not (cell.strip() in ("0", "1") or is_time(cell))), 0)
    orders = tuple("time" if is_time(cell) else "number" for cell in cells[:counted])
    first, *rest = cells[counted:] or ("",)
    things = [cell for cell in rest if cell.strip()]
    if things and len(rest) < _MOST_OBJECTS and is_known(first, things) and all(map(names_thing, things)):
        return (*orders, "action", *(f"object{number}" for number in range(1, len(rest) + 1)))
    readings = [reading_of([cell]) for cell in cells]
    is_row = any(each.understood for each in readings) if counted else any(each.are_steps for each in readings)
    return (*orders, *(f"column {number}" for number in range(counted + 1, len(cells) + 1))) if is_row else ()


_MOST_OBJECTS = 4
