"""Tables of people's own: a program or a description a row, in columns that are given or guessed."""

from collections.abc import Iterator

from hearth.pipelines.readers import ours
from hearth.pipelines.readers.columns import FieldColumns, Found, guessed, lacks, rivals
from hearth.pipelines.readers.delimited import Layout, Rows, cells_at, layout_of, row_fault
from hearth.pipelines.readers.item import Item, refused
from hearth.schemas.failures import Code
from hearth.storage.archives import Place
from hearth.storage.rejects import Reject

NAME = "spreadsheet"


def names_it(line: str) -> bool:
    """Whether a first line names the columns of such a table; a file called `.csv` is one whatever it says."""
    columns = layout_of(line).columns
    return len(columns) > 1 and {"program", "description"} & guessed(columns, {}, exact=True).keys() != set()


def columns_of(path: Place, given: FieldColumns) -> dict[str, str]:
    """The column of each field that a table has."""
    names = _begun(Rows(path))[1].columns
    found = Found(guessed(names, given))
    found.rivals, found.is_table = rivals(names, found, given), True
    return found


def _begun(rows: Rows) -> tuple[int, Layout]:
    """The number and layout of the first line with text; Excel's `sep=;` before it names the delimiter."""
    delimiter = ""
    for number, line in rows:
        if line.lower().startswith("sep=") and len(line) == len("sep=;"):
            delimiter = line[-1]
        elif line.strip():
            return number, layout_of(line, delimiter)
    return 1, Layout((), ",")


def scan(path: Place, place: str, given: FieldColumns) -> Iterator[Item]:
    """One item for each row with text; `ours` reads it as a record."""
    rows = Rows(path)
    first, layout = _begun(rows)
    columns = guessed(layout.columns, given)
    if not {"program", "description"} & columns.keys():
        yield refused(place, _unnamed(rows, first, layout, place, given))
        return
    names = dict.fromkeys(layout.columns)
    for field, name in given.items():
        if name not in names:
            yield refused(place, lacks(field, name, names, place, first), f"{place}~{name}")
    empty = True
    for line, raw, cells in rows.parsed(layout):
        full = cells and [*cells, *[""] * (len(layout.columns) - len(cells))]
        wrong = row_fault(line, raw, full, layout, place)
        if wrong or (full and any(full)):
            empty = False
        if wrong:
            yield refused(place, Reject((wrong,)), line=line)
        elif full and any(full):
            placed = cells_at(raw, full, line, layout)
            values = {field: placed[layout.columns.index(name)] for field, name in columns.items()}
            yield from ours.items(values, place, line, f"{place}:{line}", {})
    if empty:
        yield refused(place, Reject.of(Code.EMPTY, "a table with its first line only", file=place, line=first))


def _unnamed(rows: Rows, line: int, layout: Layout, place: str, given: FieldColumns) -> Reject:
    """The fault of a table none of whose columns is known; the longest cell of its first row may be a program."""
    lacking = [name for field, name in given.items() if field in ("program", "description")]
    message = "a table without a column of programs or descriptions that is known by its name"
    if lacking:
        message = f"a table without a column {' or '.join(f'`{name}`' for name in lacking)}"
    names, cells = layout.columns or ("...",), next((cells for _, _, cells in rows.parsed(layout) if cells), [])
    lengths = [*map(len, cells), *[0] * len(names)]
    program = max(range(len(names)), key=lambda at: lengths[at])
    title = next((name for at, name in enumerate(names) if at != program), "...")
    return Reject.of(
        Code.BAD_TABLE,
        message,
        file=place,
        line=line,
        found=", ".join(layout.columns)[:200],
        suggestion=f"name them, as in `--columns title={title},program={names[program]}`",
    )
