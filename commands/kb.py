"""`kb ...`: looks up, checks, compares and extends the knowledge."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from hearth.commands import output
from hearth.commands.inputs import read_knowledge
from hearth.commands.time_limits import WITHIN
from hearth.schemas.diagnostics import HearthError

if TYPE_CHECKING:
    from hearth.kb.tools.compare import Comparison

app = typer.Typer(
    name="kb",
    help="The knowledge: actions, objects, places, states and their relations.",
    no_args_is_help=True,
    rich_markup_mode=None,
)

_SHOWN = 20


@app.command()
def show(name: str, every: bool = False, kb: Path | None = None, as_json: bool = False) -> None:
    """Show everything known about an object, or about an action if no object has the name.

    \b
    Example:
      hearth kb show fridge
    """
    from hearth.kb.tools.find import unknown
    from hearth.kb.tools.show import about_object

    known = read_knowledge(kb)
    thing = known.object_class(name)
    if thing is None and known.action(name) is not None:
        action(name, kb, as_json)
        return
    if thing is None:
        raise HearthError(unknown(known, name, "object"))
    _show(about_object(known, thing), every, as_json)


@app.command()
def action(name: str, kb: Path | None = None, as_json: bool = False) -> None:
    """Show an action: objects, preconditions, effects, phrases and repairs.

    \b
    Example:
      hearth kb action Open
    """
    from hearth.kb.tools.find import unknown
    from hearth.kb.tools.show import about_action

    known = read_knowledge(kb)
    found = known.action(name)
    if found is None:
        raise HearthError(unknown(known, name, "action"))
    _show(about_action(known, found), True, as_json)


@app.command()
def find(
    word: str = "",
    can: list[str] | None = None,
    on: str = "",
    inside: str = "",
    near: str = "",
    room: str = "",
    has: list[str] | None = None,
    may_be: list[str] | None = None,
    kind: str = "",
    kb: Path | None = None,
    as_json: bool = False,
) -> None:
    """Find the objects that meet all conditions, ordered by frequency if a place is given.

    A WORD finds the objects and the actions with it in one of their names.

    \b
    Examples:
      hearth kb find counter
      hearth kb find --can Grab --in fridge
    """
    from hearth.kb.tools.find import Query, find_actions
    from hearth.kb.tools.find import find as find_objects

    known = read_knowledge(kb)
    query = Query(tuple(can or ()), on, inside, near, room, tuple(has or ()), tuple(may_be or ()), kind, word)
    found = find_objects(known, query)
    actions = find_actions(known, word) if query == Query(word=word) and word else ()
    if as_json:
        named = {"actions": [action.name for action in actions]} if word else {}
        output.emit({"found": [thing.name for thing in found], "count": len(found), **named})
        return
    output.table(
        ("object", "kind", "rooms", "what it is"), [(o.name, o.hypernym, " ".join(o.rooms), o.gloss) for o in found]
    )
    if actions:
        output.table(("action", "as a phrase"), [(action.name, action.template) for action in actions])
    counts = [output.counted(len(found), "object"), *([output.counted(len(actions), "action")] if word else [])]
    output.line(", ".join(counts))


@app.command()
def path(first: str, second: str, kb: Path | None = None, as_json: bool = False) -> None:
    """Show the most specific chain of facts that relates two things, actions or kinds.

    \b
    Example:
      hearth kb path spectacles book
    """
    from hearth.kb.tools.find import unknown
    from hearth.kb.tools.relation_paths import path as chain

    known = read_knowledge(kb)
    try:
        links = chain(known, first, second)
    except KeyError as error:
        raise HearthError(unknown(known, error.args[0], "object")) from error
    if as_json:
        output.emit({"links": links})
        return
    for link in links:
        output.line(f"{link}  ({link.evidence})" if link.evidence else link)
    if not links:
        output.line(
            "they are one" if known.object_class(first) == known.object_class(second) else "nothing relates them"
        )


@app.command()
def lint(kb: Path | None = None, as_json: bool = False) -> None:
    """Check the knowledge for contradictions; the status is 1 if there are any.

    \b
    Example:
      hearth kb lint --kb my_knowledge
    """
    from hearth.kb.consistency import CHECKS
    from hearth.kb.consistency import lint as contradictions

    found = contradictions(read_knowledge(kb))
    if as_json:
        output.emit({"findings": found, "checks": list(CHECKS)})
    else:
        for finding in found:
            output.line(f"{finding.check}: {finding.subject} {finding.message}")
        output.line(
            f"{len(CHECKS)} checks: {output.counted(len(found), 'contradiction') if found else 'no contradictions'}"
        )
    output.status(len(found), strict=True)


@app.command()
def diff(other: Path, every: bool = False, kb: Path | None = None, as_json: bool = False) -> None:
    """Compare with other knowledge fact by fact, with the reason of each deliberate difference.

    The status is 1 if a fact of the other is missing here without a reason.

    \b
    Example:
      hearth kb diff ../shared/real/kb
    """
    from hearth.kb.tools.compare import compare, rejection

    known = read_knowledge(kb)
    found = compare(known, other)
    rejected = rejection(known)
    unexplained = sum(found.count(table, "missing", False) for table in found.theirs)
    if as_json:
        output.emit({**_comparison(found), "random_steps_rejected": rejected, "missing_without_reason": unexplained})
    else:
        _print_comparison(found, every)
        output.line(f"random steps the grammar rejects: {rejected:.1%}")
    output.status(unexplained, strict=True)


@app.command()
def mine(
    dataset: Path,
    least: int = 3,
    confidence: float = 0.3,
    kb: Path | None = None,
    as_json: bool = False,
    within: float = WITHIN,
) -> None:
    """Propose new facts from a dataset's programs, as lines to review and add.

    \b
    Example:
      hearth kb mine data_out
    """
    from hearth.commands.bounded_process import in_time
    from hearth.datasets.published_programs import programs
    from hearth.kb.tools.fact_mining import as_lines
    from hearth.kb.tools.fact_mining import mine as propose

    with in_time(within):
        found = propose(programs(dataset), read_knowledge(kb), least, confidence)
    if as_json:
        output.emit({"proposals": found, "lines": as_lines(found)})
        return
    new = [p for p in found if not p.known]
    rows = [(p.kind, p.subject, p.relation, p.other, p.seen, p.confidence, p.lift) for p in new]
    output.table(("kind", "subject", "relation", "other", "programs", "confidence", "lift"), rows)
    for file, lines in as_lines(found).items():
        output.line(f"\n--- {file}")
        output.line("\n".join(f"+{line}" for line in lines))
    output.line(f"\n{output.counted(len(found), 'fact')}, {len(found) - len(new)} of them known")


@app.command()
def export(form: str, to: Path | None = None, kb: Path | None = None) -> None:
    """Write the knowledge in another form: the table of actions, the PDDL domain, the graph, a database, grammars.

    A grammar lets a language model write steps alone that are of the action grammar: `grammar` in GBNF, as llama.cpp
    takes it, or `grammar-lark`, `grammar-regex` (of one step), `grammar-schema` (JSON).

    \b
    Examples:
      hearth kb export pddl --to domain.pddl
      hearth kb export grammar --to steps.gbnf
    """
    from hearth.kb.tools.export import export as write

    text = write(read_knowledge(kb), form, to)
    if text:
        output.line(text, end="")


def _show(sheet: dict[str, Any], every: bool, as_json: bool) -> None:
    """Print single facts as a table of two columns, then each list of rows as a table."""
    if as_json:
        output.emit(sheet)
        return
    plain = [(key, _text(value)) for key, value in sheet.items() if not _is_rows(value) and value not in ("", [], 0)]
    output.table(("", ""), plain)
    for key, rows in sheet.items():
        if _is_rows(rows):
            shown = rows if every else rows[:_SHOWN]
            output.line()
            output.records(shown, key)
            if len(shown) < len(rows):
                output.line(f"... {len(rows) - len(shown)} more with --all")


def _is_rows(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and isinstance(value[0], dict)


def _text(value: Any) -> str:
    if isinstance(value, dict):
        return ", ".join(f"{key} {number:g}" for key, number in value.items())
    if isinstance(value, bool):
        return "yes" if value else "no"
    return ", ".join(map(str, value)) if isinstance(value, list) else str(value)


def _comparison(found: Comparison) -> dict[str, Any]:
    return {
        "tables": {
            table: {
                "theirs": count,
                "held": found.held[table],
                "missing_with_reason": found.count(table, "missing", True),
                "missing_without_reason": found.count(table, "missing", False),
                "added_with_reason": found.count(table, "added", True),
                "added_without_reason": found.count(table, "added", False),
            }
            for table, count in found.theirs.items()
        },
        "affordance_cells": found.cells,
        "differences": found.differences,
    }


def _print_comparison(found: Comparison, every: bool) -> None:
    rows = [(table, *counts.values()) for table, counts in _comparison(found)["tables"].items()]
    output.table(("facts", "theirs", "held", "missing, why", "missing", "added, why", "added"), rows)
    for position, counts in sorted(found.cells.items()):
        words = ", ".join(f"{number:,} {name}" for name, number in counts.items())
        output.line(f"affordances of argument {int(position) + 1}: {words}")
    for difference in found.differences:
        if every or not difference.why or difference.kind == "missing":
            output.line(
                f"{difference.kind} {difference.table}: {' '.join(difference.fact)}: {difference.why or 'NO REASON'}"
            )
