"""The codebook of a study's tables: every column with its type and meaning, and every value that has a name."""

import io
from collections.abc import Iterator, Mapping

import pyarrow as pa

from hearth.schemas.tables import comment_of
from hearth.storage.csv_files import rows_writer
from hearth.studies.participant_flags import FLAGS
from hearth.studies.study import Question, Study

HEADER = ("table", "column", "value", "type", "meaning")


def codebook(study: Study, tables: Mapping[str, pa.Schema]) -> bytes:
    """Return the codebook as CSV: a row for every column, then for every named value of it."""
    written = io.StringIO()
    write = rows_writer(written)
    write([HEADER])
    for name, schema in tables.items():
        for column in schema:
            write([(name, column.name, "", str(column.type), comment_of(column))])
            write((name, column.name, value, "", meaning) for value, meaning in _values(study, name, column.name))
    return written.getvalue().encode()


def _values(study: Study, table: str, column: str) -> Iterator[tuple[str, str]]:
    if column == "condition":
        yield from ((each.name, each.title) for each in study.conditions)
    elif column == "flags":
        yield from FLAGS.items()
    elif (table, column) == ("ratings", "question"):
        yield from ((each.name, _asked(each)) for each in (*study.questions, *study.exit))


def _asked(question: Question) -> str:
    """Return a question with its answers: `How helpful was it? (1 to 7; 1 hurting, 7 helpful)`."""
    if question.kind == "scale":
        words = ", ".join(f"{number} {label}" for number, label in question.labels)
        return f"{question.text} ({question.low} to {question.high}{'; ' if words else ''}{words})"
    return f"{question.text} ({', '.join(question.choices)})" if question.choices else question.text
