"""The knowledge as a networkx graph, and as tables in DuckDB."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from hearth.kb.knowledge import Knowledge
from hearth.kb.tools.correction_reasons import Reasons
from hearth.schemas.row_types import Row
from hearth.storage.duckdb_connections import open_database

if TYPE_CHECKING:
    import duckdb
    import networkx

Edge = tuple[str, str, str, dict[str, Any]]
"""Source, target, relation and attributes."""


def graph(knowledge: Knowledge) -> networkx.MultiDiGraph[str]:
    """Everything as a networkx MultiDiGraph.

    Nodes are names: classes as they are, others with their kind in front (`action:Open`, `property:CAN_OPEN`,
    `state:OPEN`, `kind:appliance`), each with a `type`. Edges have a `relation`: is_a, has, may_be, found_in, ON, IN,
    NEARBY (weight, room, evidence), same_as, stands_in, goes_with, serves (weight, evidence), takes_1 and takes_2 (an
    action its objects).
    """
    import networkx

    result: networkx.MultiDiGraph[str] = networkx.MultiDiGraph()
    for name, thing in knowledge.objects.items():
        kind = "room" if thing.category == "Rooms" else "class"
        result.add_node(name, type=kind, id=thing.id, gloss=thing.gloss, category=thing.category)
    for name, kind_above in knowledge.kinds.items():
        result.add_node(f"kind:{name}", type="kind", gloss=kind_above.gloss)
    for action in knowledge.actions.values():
        result.add_node(f"action:{action.name}", type="action", id=action.id, executed=action.executed)
    for source, target, relation, attributes in (*edges(knowledge), *_taking(knowledge)):
        for node in (source, target):
            if node not in result:
                result.add_node(node, type=node.partition(":")[0])
        room = attributes.get("room")
        result.add_edge(
            source, target, key=f"{relation} in {room}" if room else relation, relation=relation, **attributes
        )
    return result


def edges(knowledge: Knowledge) -> Iterator[Edge]:
    """Yield the edges of the graph, affordances aside, in a fixed order."""
    yield from _object_edges(knowledge)
    for kind in knowledge.kinds.values():
        if kind.parent:
            yield f"kind:{kind.name}", f"kind:{kind.parent}", "is_a", {}
    for name, thing in knowledge.objects.items():
        if not thing.same_as:
            for p in knowledge.placements(name):
                yield name, p.destination, p.relation, {"weight": p.weight, "room": p.room, "evidence": p.evidence}
    for a in knowledge.associations:
        other = f"action:{a.other}" if a.relation == "serves" else a.other
        yield a.name, other, a.relation, {"weight": a.weight, "evidence": a.evidence}


def _taking(knowledge: Knowledge) -> Iterator[Edge]:
    for row in _affordances(knowledge):
        position = row["position"]
        yield (
            f"action:{row['action']}",
            row["class"],
            f"takes_{position + 1}",
            {"position": position, "evidence": row["evidence"]},
        )


def _object_edges(knowledge: Knowledge) -> Iterator[Edge]:
    for name, thing in knowledge.objects.items():
        above = thing.hypernym if thing.hypernym in knowledge.objects else f"kind:{thing.hypernym}"
        yield name, above, "is_a", {}
        if thing.same_as:
            yield name, thing.same_as, "same_as", {}
        for prop in sorted(thing.properties):
            yield name, f"property:{prop}", "has", {}
        for state in thing.states:
            yield name, f"state:{state}", "may_be", {}
        for room in thing.rooms:
            yield name, room, "found_in", {}
        for rank, other in enumerate(knowledge.stand_ins(name), 1):
            stand_in = knowledge.object_class(other)
            if stand_in is not None:
                yield name, stand_in.name, "stands_in", {"rank": rank}


def tables(knowledge: Knowledge) -> dict[str, list[Row]]:
    """Everything as rows, by table; the first row of each shows its columns."""
    return {
        "actions": list(_actions(knowledge)),
        "arguments": list(_arguments(knowledge)),
        "literals": list(_literals(knowledge)),
        "objects": list(_objects(knowledge)),
        "names": list(_names(knowledge)),
        "kinds": [kind._asdict() for kind in knowledge.kinds.values()],
        "states": list(_states(knowledge)),
        "placements": [p._asdict() for name in _originals(knowledge) for p in knowledge.placements(name)],
        "associations": [a._asdict() for a in knowledge.associations],
        "affordances": list(_affordances(knowledge)),
        "repairs": list(_repairs(knowledge)),
    }


def connect(knowledge: Knowledge) -> duckdb.DuckDBPyConnection:
    """Return a DuckDB database in memory with one table for each of `tables`."""
    connection = open_database()
    fill(connection, knowledge)
    return connection


def fill(connection: duckdb.DuckDBPyConnection, knowledge: Knowledge) -> None:
    """Create one table for each of `tables` in a DuckDB database."""
    import pyarrow

    for name, rows in tables(knowledge).items():
        connection.register("rows_of_table", pyarrow.Table.from_pylist(rows))
        connection.execute(f'CREATE TABLE "{name}" AS SELECT * FROM rows_of_table')
        connection.unregister("rows_of_table")


def _originals(knowledge: Knowledge) -> Iterator[str]:
    return (name for name, thing in knowledge.objects.items() if not thing.same_as)


def _row(record: object, *columns: str) -> Row:
    """Attributes of a record, its sets sorted and its tuples as lists."""
    values = {column: getattr(record, column) for column in columns}
    lists = {column: sorted(value) for column, value in values.items() if isinstance(value, frozenset)}
    return {**values, **{c: list(value) for c, value in values.items() if isinstance(value, tuple)}, **lists}


def _actions(knowledge: Knowledge) -> Iterator[Row]:
    for action in knowledge.actions.values():
        yield _row(action, "id", "name", "arity", "executed", "template", "words", "aliases", "source")


def _arguments(knowledge: Knowledge) -> Iterator[Row]:
    for action in knowledge.actions.values():
        for position, role in enumerate(action.roles):
            needs, grammar = str(action.needs[position]), str(action.grammar[position])
            yield {"action": action.name, "position": position, "role": role, "needs": needs, "grammar": grammar}


def _literals(knowledge: Knowledge) -> Iterator[Row]:
    for action in knowledge.actions.values():
        parts: list[tuple[str, object, str, str]] = [
            ("before", c.formula, c.code.value, c.option) for c in action.preconditions
        ]
        parts += [("effect", effect, "", "") for effect in action.effects]
        for number, (kind, literal, code, option) in enumerate(parts):
            row = {"action": action.name, "number": number, "kind": kind, "literal": str(literal)}
            yield {**row, "failure": code, "option": option}


def _objects(knowledge: Knowledge) -> Iterator[Row]:
    for thing in knowledge.objects.values():
        row = _row(thing, "id", "name", "category", "hypernym", "gloss", "properties", "states", "rooms")
        size = dict(zip(("width", "height", "depth"), thing.size, strict=True))
        yield {**row, **size, "same_as": thing.same_as, "source": thing.source}


def _names(knowledge: Knowledge) -> Iterator[Row]:
    """Every name by which a thing of a class may appear, best first."""
    for name in knowledge.objects:
        for rank, other in enumerate(knowledge.same_class(name)):
            yield {"class": name, "rank": rank, "name": other}


def _states(knowledge: Knowledge) -> Iterator[Row]:
    for group in knowledge.state_groups.values():
        for state in group.states:
            row = {"name": state, "group": group.name, "exclusive": group.exclusive, "simulated": group.simulated}
            yield {**row, "in_table_a2": state in group.table}


def _affordances(knowledge: Knowledge) -> Iterator[Row]:
    reasons = Reasons(knowledge)
    for action in knowledge.actions.values():
        for position, need in enumerate(action.grammar):
            for name, thing in knowledge.objects.items():
                if need.accepts(thing.properties, name, thing.category == "Rooms"):
                    row = {"action": action.name, "position": position, "class": name}
                    yield {**row, "evidence": reasons.cell(action.name, position, name)}


def _repairs(knowledge: Knowledge) -> Iterator[Row]:
    for repair in knowledge.repairs.values():
        row = {"name": repair.name, "failure": repair.code.value, "actions": list(repair.actions)}
        yield {**row, "raised_when": repair.when, "say": repair.say, "source": repair.source}
