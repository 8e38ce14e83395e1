"""Tables of people's own: a program or a description a row, in columns that are given or guessed."""

import itertools
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from hearth.pipelines.readers import json_records
from hearth.pipelines.readers.delimited import Layout, Rows, cells_at, layout_of, row_fault
from hearth.pipelines.readers.field_columns import FieldColumns, Found, guessed, is_condition, is_formula, lacks, rivals
from hearth.pipelines.readers.json_actions import is_action
from hearth.pipelines.readers.program_columns import column_of_steps, is_one_step, reading_of
from hearth.pipelines.readers.reader_items import Item, refused
from hearth.pipelines.readers.records_in_json import Converted
from hearth.pipelines.readers.step_lists import is_count, is_time, number_of, numbered_names, plain_name
from hearth.pipelines.readers.step_rows import joined, row_of_table
from hearth.pipelines.readers.step_rows_by_task import Entry, StepRow
from hearth.pipelines.readers.step_texts import SAID
from hearth.pipelines.readers.table_heads import NUMBERED, begun
from hearth.schemas.failures import Code
from hearth.storage.archives import Place
from hearth.storage.rejects import Reject

NAME = "spreadsheet"


def names_it(line: str) -> bool:
    """Return whether a first line names the columns of such a table; a file called `.csv` is one whatever it says."""
    columns = layout_of(line).columns
    return len(columns) > 1 and {"program", "description"} & guessed(columns, {}, exact=True).keys() != set()


class Table(NamedTuple):
    """The contents of a table's columns.

    Attributes:
        first: the number of the line that names the columns.
        layout: the columns and their separator.
        columns: the column of each field.
        steps: columns that hold a step each, in order; empty if a cell holds a whole program, or a row is a step.
        number: the column that counts the steps of a program whose steps are rows.
        by_title: whether rows of one title are the steps of one program, without a number.
    """

    first: int
    layout: Layout
    columns: Found
    steps: tuple[str, ...] = ()
    number: str = ""
    by_title: bool = False

    @property
    def has_actions(self) -> bool:
        """Return whether a row is an action with its objects, in columns of their own."""
        return not self.steps and _is_action(self.layout, self.columns)


class Row(dict[str, str]):
    """The cells of a row by their columns."""


_SAMPLE = 40
_ROWS_ARE_STEPS = "A row is a step: rows of one task are one program."
_BY_CELLS = "No name says which column holds the programs: its cells read as steps."


def columns_of(path: Place, given: FieldColumns) -> dict[str, str]:
    """Return the column of each field that a table has."""
    return table_of(path, given).columns


def table_of(path: Place, given: FieldColumns) -> Table:
    """Return the contents of a table's columns: as given, by their names, or by the cells of its first rows."""
    rows = Rows(path)
    first, layout, is_row = begun(rows, given)
    names = layout.columns
    good = (cells for _, _, cells in rows.parsed(layout) if cells and len(cells) == len(names))
    sample = list(itertools.islice(good, _SAMPLE))
    cells = {name: [row[at] for row in sample if row[at].strip()] for at, name in enumerate(names)}
    counts = [name for name in names if cells[name] and all(map(is_count, cells[name]))]
    steps = tuple(numbered_names(names)) if "program" not in given else ()
    times = [name for name in names if cells[name] and all(map(is_time, cells[name]))]
    others = {*counts, *steps, *times} - {*given.values()}
    texts = [name for name in names if name not in others]
    found = Found(guessed(texts, given))
    found.rivals, found.is_table = rivals(texts, found, given), True
    if (times or counts) and not steps:
        _ordered_steps(found, given, {name: cells[name] for name in texts})
    table = Table(first, layout, found, steps, _number(sample, layout, found, counts))
    if steps:
        found.pop("program", None)
        found["program"], found.note = " ".join(steps), "A column is a step."
    elif "program" not in found and "program" not in given:
        _guess_program(table, {name: cells[name] for name in texts})
    found.note = f"{NUMBERED} {found.note}".strip() if is_row else found.note
    if "title" not in found and "title" not in given and found:
        rest = (name for name in texts if name not in found.values() and not _are_conditions(name, found, cells[name]))
        title = next((name for name in rest if _is_title(cells[name])), "")
        found.update({"title": title} if title else {})
    if not (table.number or steps) and _is_by_title(sample, layout, found):
        found.note = f"{found.note} {_ROWS_ARE_STEPS}".strip()
        return table._replace(by_title=True)
    return table


def _are_conditions(name: str, found: FieldColumns, cells: Sequence[str]) -> bool:
    """Return whether a column `goal` next to predictions holds conditions; one that holds words names the tasks."""
    return is_condition(name, found) and any(map(is_formula, cells))


def _ordered_steps(found: Found, given: FieldColumns, cells: Mapping[str, Sequence[str]]) -> None:
    """Take the column of titles for that of steps, where numbers or times order its rows, which all differ."""
    name = found.get("title", "")
    if "program" in found or {"program", "title"} & given.keys() or not name:
        return
    reading, texts = reading_of(cells[name]), cells[name]
    if column_of_steps({other: those for other, those in cells.items() if other != name}):
        return
    if len(set(texts)) == len(texts) and reading.are_steps and all(map(is_one_step, texts[:_FEW])):
        found["program"] = found.pop("title")
        found.note = _ROWS_ARE_STEPS


_FEW = 12


def _number(sample: Sequence[Sequence[str]], layout: Layout, found: FieldColumns, counts: Sequence[str]) -> str:
    """Return the column that counts steps.

    One whose name says so, else one that counts the rows of each task from 0 or 1.
    """
    names = dict.fromkeys(counts, "1")
    sure, may = number_of(names), number_of(names, any_number=True)
    if sure or not may or not ("title" in found or _row_is_step(layout, found) or _are_single(sample, may, layout)):
        return sure
    title, number, program = (layout.columns.index(found.get(each, may)) for each in ("title", "", "program"))
    rows = [("title" in found and row[title], row[number], row[program]) for row in sample if is_count(row[number])]
    counts_of = _by_task(rows)
    begins = all(min(counts) in (0, 1) for counts in counts_of)
    follows = any(len(counts) > 1 for counts in counts_of)
    single = "program" not in found or all(is_one_step(step) for _, _, step in rows if step.strip())
    return may if follows and begins and single else ""


def _by_task(rows: Iterable[tuple[Any, str, str]]) -> list[set[int]]:
    """Return the numbers of each task's rows; a number that is there already begins another program of the task."""
    found: list[set[int]] = []
    last: dict[Any, set[int]] = {}
    for task, number, _ in rows:
        if task not in last or int(number) in last[task]:
            last[task] = set()
            found.append(last[task])
        last[task].add(int(number))
    return found


def _are_single(sample: Sequence[Sequence[str]], number: str, layout: Layout) -> bool:
    """Return whether no cell next to the numbers holds several steps."""
    at = layout.columns.index(number)
    rest = (cell for row in sample[:_FEW] for n, cell in enumerate(row) if n != at and cell.strip())
    return all(map(is_one_step, rest))


def _row_is_step(layout: Layout, found: FieldColumns) -> bool:
    """Return whether the names of columns say that a row is a step: it is an action, or has one `step`."""
    return _is_action(layout, found) or plain_name(found.get("program", "")) in ("step", "action")


def _is_action(layout: Layout, found: FieldColumns) -> bool:
    return "program" not in found and is_action(dict.fromkeys(layout.columns, "x"))


def _is_by_title(sample: Sequence[Sequence[str]], layout: Layout, found: Found) -> bool:
    """Return whether most rows hold one step and are next to another row of their title.

    Where titles begin again, the column of programs must be called `step` or `action`.
    """
    if "title" not in found and "program" in found and (_row_is_step(layout, found) or found.note == _ROWS_ARE_STEPS):
        program = layout.columns.index(found["program"])
        return len(sample) > 1 and all(is_one_step(row[program]) for row in sample if row[program])
    if not {"title", "program"} <= found.keys():
        return False
    title, program = (layout.columns.index(found[field]) for field in ("title", "program"))
    runs = [(name, len(list(rows))) for name, rows in itertools.groupby(sample, key=lambda row: row[title])]
    beside = sum(count for name, count in runs if count > 1 and name)
    if len({name for name, _ in runs}) < len(runs):  # a title begins again: only a column `step` says what a row is
        are_steps = _row_is_step(layout, found)
    else:
        are_steps = 2 * beside > len(sample)
    return are_steps and all(is_one_step(row[program]) for row in sample if row[program])


def _guess_program(table: Table, cells: Mapping[str, Sequence[str]]) -> None:
    """Add the column of programs by the cells of the first rows; or of steps, where a column counts them."""
    found = table.columns
    if table.has_actions:
        found.note = _ROWS_ARE_STEPS
    elif table.number or "time" in table.layout.columns:
        rest = {name: reading_of(texts) for name, texts in cells.items() if name != found.get("title")}
        likeliest = max(rest, key=lambda name: rest[name].understood, default="")
        found.update({"program": found.pop("description", likeliest)} if likeliest else {})
        found.note = _ROWS_ARE_STEPS
    else:
        others = {name: texts for name, texts in cells.items() if name not in found.values()}
        about = found.get("description", "")
        if cells.get(about) and all(map(SAID.match, cells[about])) and column_of_steps({about: cells[about]}):
            others = {about: cells[found.pop("description")]}
        program = column_of_steps(others)
        found.update({"program": program} if program else {})
        found.note = _BY_CELLS if program else ""
        remaining = {name: texts for name, texts in others.items() if name != program}
        if program and (other := column_of_steps(remaining)):
            found.rivals["program"] = [*found.rivals.get("program", ()), other]


_WORDS = re.compile(r"(?!@)[^\d_]{2,}")


def _is_title(cells: Sequence[str]) -> bool:
    """Return whether cells are words, as names of tasks are, and ids such as `w_12` and `@kim` are not."""
    return bool(cells) and 2 * sum(bool(_WORDS.fullmatch(cell.strip())) for cell in cells) >= len(cells)


def scan(path: Place, place: str, given: FieldColumns) -> Iterator[Item]:
    """One item for each row with text, or for the rows of one program; `ours` reads it as a record."""
    table = table_of(path, given)
    columns, layout, first = table.columns, table.layout, table.first
    if not {"program", "description"} & columns.keys() and not table.has_actions:
        rows = Rows(path)
        begun(rows, given)
        yield refused(place, _unnamed(rows, first, layout, place, given))
        return
    names = dict.fromkeys(layout.columns)
    for field, name in given.items():
        if name not in names:
            yield refused(place, lacks(field, name, names, place, first), f"{place}~{name}")
    empty = True
    for value, line, name in joined(_rows(path, place, table, given), _reader_of(table)):
        empty = False
        if isinstance(value, Reject):
            yield refused(place, value, line=line)
        else:
            yield from json_records.items(
                _record(value, table) if isinstance(value, Row) else value, place, line, name, {}
            )
    if empty:
        yield refused(place, Reject.of(Code.EMPTY, "a table with its first line only", file=place, line=first))


def _reader_of(table: Table) -> Callable[[Any], StepRow | None]:
    """Return a function that reads a row as a step; no row is a step where cells hold whole programs."""
    is_counted = table.number and "program" in table.columns and not table.steps
    are_steps = is_counted or table.has_actions or table.by_title
    return row_of_table(table.columns, table.number) if are_steps else lambda _: None


def _rows(path: Place, place: str, table: Table, given: FieldColumns) -> Iterator[Entry]:
    """Each row with text, by its columns; a fault for one that can't be read."""
    rows, layout = Rows(path), table.layout
    begun(rows, given)
    for line, raw, cells in rows.parsed(layout):
        full = cells and [*cells, *[""] * (len(layout.columns) - len(cells))]
        wrong = row_fault(line, raw, full, layout, place)
        if wrong:
            yield Entry(Reject((wrong,)), line, "")
        elif full and any(full):
            placed = Row(zip(layout.columns, cells_at(raw, full, line, layout), strict=True))
            yield Entry(placed, line, f"{place}:{line}")


def _record(row: Row, table: Table) -> dict[str, Any]:
    """Return a row as a record, by our names of the fields."""
    fields = {field: name for field, name in table.columns.items() if not (table.steps and field == "program")}
    steps = {"steps": [row[name] for name in table.steps if row[name].strip()]} if table.steps else {}
    return Converted({**{field: row[name] for field, name in fields.items()}, **steps}, row)


def _unnamed(rows: Rows, line: int, layout: Layout, place: str, given: FieldColumns) -> Reject:
    """Return the fault of a table none of whose columns is known.

    The longest cell of its first row may be a program.
    """
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
