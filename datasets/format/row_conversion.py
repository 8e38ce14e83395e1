"""Between values (programs, graphs, changes, failures) and the rows of tables."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from operator import itemgetter
from typing import TYPE_CHECKING, Any

from hearth.grounding.preconditions.conditions import Condition, Preconditions
from hearth.schemas import row_types as forms
from hearth.schemas import stage_rows
from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.failures import Failure
from hearth.schemas.graph import Box, Edge, EnvironmentGraph, Node, edge_set
from hearth.schemas.graph_change import Change
from hearth.schemas.literals import RENAMED, Literal
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.schemas.row_types import columns_of

if TYPE_CHECKING:
    from hearth.simulation.engine import Execution

Bindings = dict[tuple[str, int], int]

_EDGE = itemgetter("source", "relation", "target")
_STATE = itemgetter("node", "state")


def node_row(node: Node) -> forms.NodeRow:
    """Return a node, as a row."""
    box: forms.BoxRow | None = node.box and {"center": _point_row(node.box.center), "size": _point_row(node.box.size)}
    return {
        "id": node.id,
        "class_name": node.class_name,
        "category": node.category,
        "properties": list(node.properties),
        "states": list(node.states),
        "prefab": node.prefab,
        "box": box,
        "yaw": node.yaw,
    }


def _point_row(point: tuple[float, float, float]) -> forms.PointRow:
    return {"x": point[0], "y": point[1], "z": point[2]}


def node_of(row: forms.NodeRow) -> Node:
    """Invert `node_row`."""
    box = row["box"]
    return Node(
        row["id"],
        row["class_name"],
        row["category"],
        tuple(row["properties"]),
        tuple(row["states"]),
        row["prefab"],
        box and Box(_point(box["center"]), _point(box["size"])),
        row["yaw"],
    )


def _point(row: forms.PointRow) -> tuple[float, float, float]:
    return row["x"], row["y"], row["z"]


def graph_row(graph: EnvironmentGraph) -> forms.GraphRow:
    """Return a graph, edges sorted, each once."""
    edges = sorted(edge_set(graph.edges))
    return {
        "nodes": [node_row(node) for node in graph.nodes],
        "sources": [source for source, _, _ in edges],
        "relations": [relation for _, relation, _ in edges],
        "targets": [target for _, _, target in edges],
    }


def graph_of(row: forms.GraphRow) -> EnvironmentGraph:
    """Invert `graph_row`."""
    edges = map(Edge, row["sources"], row["relations"], row["targets"])
    return EnvironmentGraph(tuple(map(node_of, row["nodes"])), tuple(edges))


def change_row(change: Change) -> forms.ChangeRow:
    """Return a change, as a row."""
    # Arrow accepts named tuples and pairs as structs, and reads them much faster than dicts.
    found: Any = {
        "added": list(change.added),
        "removed": list(change.removed),
        "set_states": list(change.set_states),
        "cleared_states": list(change.cleared_states),
    }
    row: forms.ChangeRow = found
    return row


def change_of(row: forms.ChangeRow) -> Change:
    """Invert `change_row`."""
    return Change(
        tuple(edges_of(row["added"])),
        tuple(edges_of(row["removed"])),
        tuple(map(_STATE, row["set_states"])),
        tuple(map(_STATE, row["cleared_states"])),
    )


def environment_row(change: Change) -> forms.DifferenceRow:
    """Return a difference from a home, as a row."""
    came, went = list(map(node_row, change.added_nodes)), list(change.removed_nodes)
    return {"added_nodes": came, "removed_nodes": went, **change_row(change)}


def environment_change(row: forms.DifferenceRow) -> Change:
    """Invert `environment_row`."""
    came, went = tuple(map(node_of, row["added_nodes"])), tuple(row["removed_nodes"])
    return replace(change_of(row), added_nodes=came, removed_nodes=went)


def edges_of(rows: Iterable[forms.EdgeRow]) -> Iterator[Edge]:
    """Yield the edges of rows."""
    return map(Edge._make, map(_EDGE, rows))


def named(row: stage_rows.NamedRow) -> stage_rows.NamedRow:
    """Return the columns of a row that a program keeps from stage to stage."""
    return columns_of(stage_rows.NamedRow, row)


def step_rows(program: Program) -> list[forms.StepRow]:
    """Return a program's steps as rows, without node ids."""
    return [
        {
            "agent": step.agent,
            "action": step.action,
            "objects": [{"name": ref.name, "instance": ref.instance} for ref in step.objects],
            "joins": step.joins,
            "modifiers": [{"name": name, "value": value} for name, value in step.modifiers],
            "line": program.line(number),
        }
        for number, step in enumerate(program.steps)
    ]


def steps_of(rows: Iterable[forms.StepRow], bindings: Bindings | None = None) -> tuple[Step, ...]:
    """Invert `step_rows`; objects in `bindings` are bound."""
    bound: Bindings = bindings or {}
    return tuple(
        Step(
            row["action"],
            tuple(
                ObjectRef(ref["name"], ref["instance"], bound.get((ref["name"], ref["instance"])))
                for ref in row["objects"]
            ),
            row["agent"],
            row["joins"],
            tuple((pair["name"], pair["value"]) for pair in row["modifiers"]),
        )
        for row in rows
    )


def program_of(row: forms.ScriptRow, bindings: Bindings | None = None) -> Program:
    """Return the program of a row."""
    lines = tuple(step["line"] for step in row["steps"])
    return Program(row["title"], row["description"], steps_of(row["steps"], bindings), lines)


def binding_rows(program: Program) -> list[forms.BindingRow]:
    """Return the node of each object in a bound program, as rows."""
    return [
        {"name": ref.name, "instance": ref.instance, "node": ref.node}
        for ref in program.objects()
        if ref.node is not None
    ]


def bindings_of(rows: Iterable[forms.BindingRow]) -> Bindings:
    """Invert `binding_rows`."""
    return {(row["name"], row["instance"]): row["node"] for row in rows}


def failure_row(failure: Failure) -> forms.FailureRow:
    """Return a failure, as a row."""
    return {
        "code": str(failure.code),
        "tick": failure.tick,
        "agent": failure.agent,
        "action": failure.action,
        "objects": list(failure.objects),
        "names": list(failure.names),
        "expected": failure.expected,
        "actual": failure.actual,
    }


def tick_rows(execution: Execution) -> list[forms.TickRow]:
    """Instructions and changes of each executed tick, as rows."""
    rows: list[forms.TickRow] = []
    number = 0
    for steps, change in zip(execution.program.ticks(), execution.changes(), strict=False):
        instructions: list[forms.InstructionRow] = [
            {"agent": step.agent, "step": number + place} for place, step in enumerate(steps)
        ]
        rows.append({"instructions": instructions, **change_row(change)})
        number += len(steps)
    return rows


def condition_rows(conditions: Iterable[Condition]) -> list[forms.ConditionRow]:
    """Preconditions, as rows."""
    return [
        {
            "name": condition.name,
            "objects": [{"name": name, "instance": instance} for name, instance in condition.objects],
            "step": condition.step,
            "hard": condition.hard,
        }
        for condition in conditions
    ]


def conditions_of(rows: Iterable[forms.ConditionRow]) -> Preconditions:
    """Invert `condition_rows`; conditions that came with a program are soft."""
    return Preconditions(
        tuple(
            Condition(
                Literal(
                    RENAMED.get(row["name"], row["name"]),
                    tuple((ref["name"], ref["instance"]) for ref in row["objects"]),
                ),
                row["step"] or 0,
                bool(row["hard"]),
            )
            for row in rows
        )
    )


def warning_row(fault: Diagnostic) -> forms.WarningRow:
    """Return a diagnostic that does not stop a program."""
    return {
        "code": str(fault.code),
        "line": fault.line,
        "column": fault.column,
        "found": fault.found,
        "message": fault.message,
        "suggestion": fault.suggestion,
    }
