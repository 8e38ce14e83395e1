"""`home convert --fill`: a scene graph of any shape, written as a home with everything that it needs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from hearth.commands import output
from hearth.commands.grouped_faults import alike, report
from hearth.commands.inputs import read_knowledge

if TYPE_CHECKING:
    from hearth.interop.scene_graphs.fillings import Filling, ReadGraph


def convert_filled(source: Path, out: Path, mapping: Path | None, as_json: bool) -> None:
    """Write a scene graph as a home, and print what was understood, filled in and left out.

    Raises:
        HearthError: the file or the mapping can't be read, or describes no home.
    """
    from hearth.homes import home_export
    from hearth.homes.lint import lint

    found = read_home(source, mapping)
    written = home_export.write_release(found.graph, out)
    faults = lint(found.graph, read_knowledge(None))
    if as_json:
        output.emit({
            "home": str(source), "file": out, "nodes": written, "edges": len(found.graph.edges),
            "filled": [filling._asdict() for filling in found.fillings], "left_out": found.left_out,
            "ids": {str(number): own for number, own in found.ids.items()}, "faults": faults})  # fmt: skip
        output.status(len(found.left_out) + len(faults), strict=True)
        return
    report(found.left_out, key=alike)
    output.table(("", "number", "such as"), _rows(found.fillings))
    left = f"; left out: {len(found.left_out):,}" if found.left_out else ""
    output.line(f"{out}: {output.counted(written, 'node')}, {output.counted(len(found.graph.edges), 'edge')}{left}")
    if faults:
        output.note(f"{output.counted(len(faults), 'fault')} of the home: `hearth home lint {out}` names them.")
    output.status(len(found.left_out) + len(faults), strict=True)


def _rows(fillings: Sequence[Filling]) -> list[tuple[str, int, str]]:
    return [(filling.what, filling.number, ", ".join(filling.examples)) for filling in fillings]


def read_home(source: Path, mapping: Path | None) -> ReadGraph:
    """Return the home of a file: a graph in the release's layout is completed, one of another shape is read."""
    from hearth.homes.node_defaults import filled
    from hearth.interop.scene_graphs.mapping_file import read_mapping
    from hearth.interop.scene_graphs.reading import complete, read_scene
    from hearth.interop.scene_graphs.shape import usual
    from hearth.schemas.graph import from_release
    from hearth.schemas.graph_wrappers import graph_in

    known = read_knowledge(None)
    data = _json(source)
    inner = graph_in(data)
    if mapping is None and inner is not None and _is_ours(inner):
        return complete(from_release(filled(inner, known).data, str(source)), known, str(source))
    return read_scene(data, usual() if mapping is None else read_mapping(mapping, known), known, str(source))


def _is_ours(data: Mapping[str, Any]) -> bool:
    """Return whether a graph has the field names of the release's layout."""
    nodes, edges = data["nodes"], data["edges"]
    if not isinstance(nodes, list) or not isinstance(edges, list):
        return False
    return all(isinstance(node, dict) and {"id", "class_name"} <= node.keys() for node in nodes) and all(
        isinstance(edge, dict) and {"from_id", "relation_type", "to_id"} <= edge.keys() for edge in edges
    )


def _json(source: Path) -> Any:
    import orjson

    from hearth.schemas.diagnostics import HearthError
    from hearth.schemas.failures import Code
    from hearth.storage.input_files import read_input

    try:
        return orjson.loads(read_input(source))
    except orjson.JSONDecodeError as error:
        raise HearthError.of(Code.BAD_JSON, f"not JSON: {error}", file=str(source)) from error
