"""Writing homes: plans, scene graphs in the release's layout, drawings, and files of node ids."""

import io
from dataclasses import replace
from pathlib import Path

import orjson

from hearth.homes import floor_plan_drawing
from hearth.homes.plans.layout import Layout
from hearth.homes.plans.plan_writer import plan_text
from hearth.homes.scene_graph import every_thing, node_ids, scene
from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.graph import EnvironmentGraph, to_release
from hearth.storage import chosen_files
from hearth.storage.csv_files import rows_writer


def write(layout: Layout, path: Path, knowledge: Knowledge) -> None:
    """Write a home as a plan, a scene graph or a drawing, by the file's ending.

    A plan is named after its file.

    Raises:
        HearthError: UNSUPPORTED_FILE for an ending other than .yaml, .json, .svg and .png.
    """
    if path.suffix == ".json":
        write_release(scene(layout, knowledge), path)
    elif path.suffix == ".yaml":
        chosen_files.write(path, plan_text(replace(layout.plan, name=path.stem)).encode())
    else:
        floor_plan_drawing.write(layout, path)


def write_release(graph: EnvironmentGraph, path: Path) -> int:
    """Write a graph as JSON in the release's layout, boxes and yaw with it; returns the number of nodes.

    Raises:
        HearthError: UNSUPPORTED_FILE: the file's ending is not `.json`.
    """
    if path.suffix != ".json":
        raise HearthError.of(Code.UNSUPPORTED_FILE, "a scene graph is written as .json", file=str(path))
    chosen_files.write(path, orjson.dumps(to_release(graph), option=orjson.OPT_INDENT_2 | orjson.OPT_APPEND_NEWLINE))
    return len(graph.nodes)


def write_ids(layout: Layout, path: Path) -> int:
    """Write the ids of a plan's nodes, sorted; ids that were fixed before stay. Returns how many there are."""
    ids = node_ids((thing.name for thing in every_thing(layout)), layout.plan.ids, layout.plan.file)
    removed = {name: number for name, number in layout.plan.ids.items() if name not in ids}
    text = io.StringIO()
    write = rows_writer(text)
    write([("id", "name")])
    write(sorted((number, name) for name, number in (ids | removed).items()))
    chosen_files.write(path, text.getvalue().encode())
    return len(ids)
