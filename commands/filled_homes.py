"""`home convert --fill`: a scene graph of any shape, or a house, written as a home with everything that it needs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from hearth.commands import output
from hearth.commands.grouped_faults import alike, report
from hearth.commands.houses import known_assets
from hearth.commands.inputs import read_knowledge

if TYPE_CHECKING:
    from hearth.interop.scene_graphs.fillings import Filling, ReadGraph


class Source(NamedTuple):
    """A file to convert.

    Attributes:
        path: of the file.
        mapping: names of its fields and classes.
        scene: which of several; "" for a file with one.
        assets: a database of models with their sizes.
    """

    path: Path
    mapping: Path | None = None
    scene: str = ""
    assets: Path | None = None


def is_of_others(path: Path) -> bool:
    """Return whether a file is a house of ProcTHOR, has one a line, or is an activity of BEHAVIOR."""
    if path.suffix == ".bddl" and path.is_file():
        return True
    if not (path.suffix == ".json" or path.name.endswith((".jsonl", ".jsonl.gz"))) or not path.is_file():
        return False
    from hearth.interop.procthor.house_files import has_houses

    return has_houses(path)


def convert_filled(source: Source, out: Path, as_json: bool) -> None:
    """Write a scene graph as a home, and print what was understood, filled in and left out.

    Raises:
        HearthError: the file or the mapping can't be read, or describes no home.
    """
    from hearth.homes import home_export
    from hearth.homes.lint import lint

    found, goal = read_home(source)
    written = home_export.write_release(found.graph, out)
    faults = lint(found.graph, read_knowledge(None))
    if as_json:
        output.emit({
            "home": str(source.path), "file": out, "nodes": written, "edges": len(found.graph.edges),
            "filled": [filling._asdict() for filling in found.fillings], "left_out": found.left_out,
            "ids": {str(number): own for number, own in found.ids.items()}, "faults": faults,
            **({"goal": goal} if goal else {})})  # fmt: skip
        output.status(len(found.left_out) + len(faults), strict=True)
        return
    report(found.left_out, key=alike)
    output.table(("", "number", "such as"), _rows(found.fillings))
    left = f"; left out: {len(found.left_out):,}" if found.left_out else ""
    output.line(f"{out}: {output.counted(written, 'node')}, {output.counted(len(found.graph.edges), 'edge')}{left}")
    if goal:
        output.line(f"goal: {goal}")
    if faults:
        output.note(f"{output.counted(len(faults), 'fault')} of the home: `hearth home lint {out}` names them.")
    output.status(len(found.left_out) + len(faults), strict=True)


def _rows(fillings: Sequence[Filling]) -> list[tuple[str, int, str]]:
    return [(filling.what, filling.number, ", ".join(filling.examples)) for filling in fillings]


def read_home(source: Source) -> tuple[ReadGraph, str]:
    """Return the home of a file, and the goal of an activity or "".

    A house, an activity or a graph of another shape is read, a graph in the release's layout is completed.
    """
    if source.path.suffix == ".bddl":
        from hearth.interop.bddl.read_activity import read_activity

        return read_activity(source.path, read_knowledge(None))
    return _read_graph(source), ""


def _read_graph(source: Source) -> ReadGraph:
    from hearth.homes.node_defaults import filled
    from hearth.interop.procthor.house import is_house, read_house
    from hearth.interop.procthor.house_files import scene_of
    from hearth.interop.procthor.house_reading import read_house_home
    from hearth.interop.scene_graphs.map_files import MAPS, map_of
    from hearth.interop.scene_graphs.mapping_file import read_mapping
    from hearth.interop.scene_graphs.reading import complete, read_scene
    from hearth.interop.scene_graphs.shape import usual
    from hearth.schemas.graph import from_release
    from hearth.schemas.graph_wrappers import graph_in

    known, file = read_knowledge(None), str(source.path)
    data = map_of(source.path) if source.path.suffix in MAPS else scene_of(source.path, source.scene)
    shape = usual() if source.mapping is None else read_mapping(source.mapping, known)
    if is_house(data):
        sizes = {each.id: each.size for models in known_assets(source.assets).values() for each in models}
        return read_house_home(read_house(data, file), shape, known, sizes, file)
    inner = graph_in(data)
    if source.mapping is None and inner is not None and _is_ours(inner):
        return complete(from_release(filled(inner, known).data, file), known, file)
    return read_scene(data, shape, known, file)


def _is_ours(data: Mapping[str, Any]) -> bool:
    """Return whether a graph has the field names of the release's layout."""
    nodes, edges = data["nodes"], data["edges"]
    if not isinstance(nodes, list) or not isinstance(edges, list):
        return False
    return all(isinstance(node, dict) and {"id", "class_name"} <= node.keys() for node in nodes) and all(
        isinstance(edge, dict) and {"from_id", "relation_type", "to_id"} <= edge.keys() for edge in edges
    )
