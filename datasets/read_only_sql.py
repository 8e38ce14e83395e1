"""The test for SQL that only reads: by kind of statement, that of an EXPLAIN by the explained one, and by clauses."""

from typing import Any

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code


def check_question(connection: Any, query: str, parameters: dict[str, Any]) -> None:
    """Refuse a query that is more than one statement, or that does anything but read. Nothing of it is run.

    Raises:
        HearthError: SYNTAX.
        duckdb.Error: the query cannot be parsed or bound.
    """
    try:
        query.encode()
    except UnicodeEncodeError as error:
        message = f"the question is not text in UTF-8: character {error.start + 1} is half a character or another code"
        raise HearthError.of(Code.SYNTAX, message, suggestion="save it in UTF-8") from None
    kind, text = _statement(connection, query)
    if kind == "EXPLAIN":
        kind, text = _explained(connection, text)
    if kind != "SELECT":
        raise _refusal(f"{kind} is not a question")
    # A WITH clause may hold COPY, INSERT, UPDATE and DELETE in a statement whose kind is SELECT, but only at the top:
    # as a subquery it cannot be bound. To bind is not to run.
    connection.sql(f"FROM (\n{text}\n)", params=parameters or None)


def _statement(connection: Any, query: str) -> tuple[str, str]:
    """Kind and text of the only statement."""
    found = connection.extract_statements(query)
    if len(found) != 1:
        raise _refusal(f"{len(found)} statements where one is expected")
    return found[0].type.name, found[0].query.strip().rstrip(";")


def _explained(connection: Any, text: str) -> tuple[str, str]:
    """Return the statement in an EXPLAIN: the longest end that is a statement; ANALYZE and options begin none."""
    import duckdb

    data = text.encode()  # where tokens begin is counted in bytes
    for start, kind in duckdb.tokenize(text)[1:]:
        if kind == duckdb.token_type.comment or data[start : start + 7].lower() == b"explain":
            continue
        rest = data[start:].decode()
        try:
            return _statement(connection, rest)
        except duckdb.ParserException:
            continue
    raise _refusal("EXPLAIN of nothing")


def _refusal(message: str) -> HearthError:
    suggestion = "ask with SELECT, FROM, DESCRIBE, SHOW or EXPLAIN"
    return HearthError.of(Code.SYNTAX, f"a dataset can only be read: {message}", suggestion=suggestion)
