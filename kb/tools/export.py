"""The knowledge in other forms: Markdown, PDDL, GraphML, grammars of steps, a DuckDB file."""

from collections.abc import Callable
from pathlib import Path

from hearth.kb.knowledge import Knowledge
from hearth.kb.tools.action_table import action_table
from hearth.kb.tools.graph_and_tables import fill, graph
from hearth.kb.tools.pddl import domain
from hearth.kb.tools.step_grammar import as_gbnf, as_lark, as_regex, as_schema
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage import chosen_files
from hearth.storage.duckdb_connections import open_database


def export(knowledge: Knowledge, form: str, to: Path | None = None) -> str:
    """Write the knowledge as one of `FORMS` to a file; without one, the text is returned.

    Raises:
        HearthError: the form is unknown, or it is binary and no file is given.
    """
    if form == "duckdb":
        return _database(knowledge, to)
    if form not in FORMS:
        raise HearthError.of(Code.UNSUPPORTED_FILE, f"`{form}` is not a form", suggestion=f"{', '.join(FORMS)}, duckdb")
    text = FORMS[form](knowledge)
    if to is None:
        return text
    chosen_files.write(to, text.encode())
    return ""


def _graphml(knowledge: Knowledge) -> str:
    import networkx

    return "\n".join(networkx.generate_graphml(graph(knowledge))) + "\n"


def _database(knowledge: Knowledge, to: Path | None) -> str:
    if to is None:
        raise HearthError.of(Code.UNSUPPORTED_FILE, "a database needs a file", suggestion="give --to FILE")
    with chosen_files.writing(to) as temporary, open_database(temporary) as connection:
        fill(connection, knowledge)
    return ""


FORMS: dict[str, Callable[[Knowledge], str]] = {
    "table": action_table,
    "pddl": domain,
    "graphml": _graphml,
    "grammar": as_gbnf,
    "grammar-lark": as_lark,
    "grammar-regex": as_regex,
    "grammar-schema": as_schema,
}
"""Forms that are text."""
