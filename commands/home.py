"""`home`: list, show, check, convert, export, edit and generate homes."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import typer

from hearth.commands import output
from hearth.commands.grouped_faults import alike, report
from hearth.commands.homes_tried_out import try_out
from hearth.commands.inputs import read_knowledge
from hearth.kb.loading.load import default

if TYPE_CHECKING:
    from hearth.homes.from_graph.graph_layout import GraphLayout
    from hearth.schemas.diagnostics import Diagnostic
    from hearth.schemas.graph import EnvironmentGraph

app = typer.Typer(
    no_args_is_help=True, add_completion=False, help="The homes: list, show, check, convert, edit and generate them."
)


@app.command("list")
def list_homes(homes: Path | None = None, as_json: bool = False) -> None:
    """List the homes with their numbers of rooms, nodes and edges.

    \b
    Example:
      hearth home list --homes my_homes
    """
    from hearth.homes import library

    rows = [{"home": name, **_figures(_graph(name, homes))} for name in library.names(homes)]
    if as_json:
        output.emit({"homes": rows})
        return
    output.table(
        ("home", "rooms", "nodes", "edges", "per node", "on", "inside", "close", "facing", "between"),
        [
            (row["home"], row["rooms"], row["nodes"], row["edges"], row["edges_per_node"], *row["relations"].values())
            for row in rows
        ],
    )


@app.command()
def show(home: str, out: Path | None = None, homes: Path | None = None, as_json: bool = False) -> None:
    """Show the rooms of a home and their contents; with --out, draw its floor plan.

    \b
    Example:
      hearth home show maple --out maple.svg
    """
    graph = _graph(home, homes)
    if out is not None:
        from hearth.homes import floor_plan_drawing

        floor_plan_drawing.write(_layout(home, homes), out)
    rooms = _rooms(graph)
    if as_json:
        output.emit({"home": home, **_figures(graph), "contents": rooms, "drawing": out})
        return
    for room in rooms:
        things = ", ".join(f"{name} {count}" if count > 1 else name for name, count in room["things"].items())
        output.line(f"{room['room']} ({room['id']}): {things}")
    figures = _figures(graph)
    output.line(f"{figures['nodes']:,} nodes, {figures['edges']:,} edges" + (f"; floor plan in {out}" if out else ""))


@app.command()
def lint(home: str, layout: bool = False, homes: Path | None = None, as_json: bool = False) -> None:
    """Report the faults of a home or of any scene graph; the status is 1 if there are any.

    Nodes without category, properties or states have those of their class in the knowledge, here and wherever a graph
    is read. The output also names the number of these nodes, and the things that no action applies to.

    With --layout, a graph without geometry is laid out, and every relation that the layout can't show is named; these
    are not faults.

    \b
    Examples:
      hearth home lint TrimmedTestScene1_graph.json
      hearth home lint TrimmedTestScene1_graph.json --layout
    """
    from hearth.commands.inputs import note_filled
    from hearth.homes import library
    from hearth.homes.lint import lint as check
    from hearth.homes.lint import unusable

    graph = _graph(home, homes)
    known = read_knowledge(None)
    note_filled(library.filled_nodes(home, known, homes))
    useless = unusable(graph, known)
    faults = check(graph, known, file=home if Path(home).suffix else "")
    made = library.graph_layout(home, known, homes) if layout else None
    if as_json:
        document = {"home": home, "faults": faults, "by_code": _codes(faults), "unusable": useless}
        output.emit(document if made is None else {**document, "met": met(made), "unmet": made.unmet})
    else:
        report(faults, key=alike)
        for sentence in useless:
            output.note(sentence)
        if made is not None:
            for fault in made.unmet:
                output.line(f"{fault.message} ({fault.suggestion})")
            output.table(("of the graph", "there are", "shown by the layout"), [
                (row["what"], row["all"], row["shown"]) for row in met(made)])  # fmt: skip
        codes = ", ".join(f"{code} {count}" for code, count in _codes(faults).items())
        output.line(
            f"{home}: {output.counted(len(faults), 'fault')} of the graph itself" + (f": {codes}" if codes else "")
        )
    output.status(len(faults), strict=True)


def _codes(faults: Sequence[Diagnostic]) -> dict[str, int]:
    return dict(sorted(Counter(str(fault.code) for fault in faults).items()))


def met(layout: GraphLayout) -> list[dict[str, Any]]:
    """Return for nodes and for each relation the number in the graph and the number that the layout shows."""
    edges = Counter(edge.relation for edge in layout.graph.edges)
    lost = Counter(
        "things" if fault.code == "NO_PLACE" else next(name for name in edges if f") {name} " in fault.message)
        for fault in layout.unmet
    )
    rows = {"things": len(layout.graph.nodes), **{name: edges[name] for name in ("ON", "INSIDE", "CLOSE", "FACING")}}
    return [{"what": name, "all": count, "shown": count - lost[name]} for name, count in rows.items()]


app.command(name="try")(try_out)


@app.command()
def convert(
    home: str,
    out: Path,
    layout: bool = False,
    fill: bool = False,
    mapping: Path | None = None,
    scene: str | None = None,
    assets: Path | None = None,
    homes: Path | None = None,
    as_json: bool = False,
) -> None:
    """Write a home as a scene graph in the release's layout, or its node ids by name.

    A file `x.ids.csv` next to a plan `x.yaml` keeps the ids when the plan changes; new nodes get new ids.

    With --fill, HOME may be a scene graph of any shape: of a robot, a scan or a simulator. What the file leaves out is
    filled in: rooms, places, states, boxes, nearness. A table counts what was understood, filled in and left out; the
    status is 1 if anything was left out. `classes: {rocket: null}` in a mapping file leaves it out without a word.
    A house of ProcTHOR and an activity of BEHAVIOR (.bddl) are recognized by themselves.

    \b
    Examples:
      hearth home convert house.json mine.json
      hearth home convert maple maple.json
      hearth home convert scan.json mine.json --fill
      hearth home convert scan.json mine.json --fill --mapping names.yaml
      hearth home convert my_homes/oak.yaml my_homes/oak.ids.csv
      hearth home convert TrimmedTestScene1_graph.json scene1.json --layout
    """
    from hearth.commands.filled_homes import Source, convert_filled, is_of_others
    from hearth.homes import home_export, library

    if fill or mapping is not None or scene is not None or is_of_others(Path(home)):
        convert_filled(Source(Path(home), mapping, scene or "", assets), out, as_json)
        return
    if out.name.endswith(".ids.csv"):
        written = home_export.write_ids(_layout(home, homes), out)
    else:
        made = library.graph_layout(home, read_knowledge(None), homes).graph if layout else _graph(home, homes)
        written = home_export.write_release(made, out)
    output.say(f"{out}: {output.counted(written, 'node')}", {"home": home, "file": out, "nodes": written}, as_json)


@app.command()
def schema(as_json: bool = False) -> None:
    """Print the JSON schema of scene graphs, for files that people or programs write.

    \b
    Example:
      hearth home schema > scene-graph.schema.json
    """
    from hearth.schemas.graph_json_schema import graph_schema

    output.emit(graph_schema())


@app.command()
def export(
    home: str,
    form: Literal["gltf", "obj", "procthor"] = "gltf",
    out: Path | None = None,
    seed: int = 0,
    assets: Path | None = None,
    homes: Path | None = None,
    as_json: bool = False,
) -> None:
    """Write the drawn contents of a home for other programs: Blender, three.js, MuJoCo.

    A glTF is one file, in which the extras of a node have id and class of the graph's node. An OBJ has colors, in an
    .mtl next to it, and no textures. A ProcTHOR house is one that AI2-THOR builds, and that `home convert` reads.

    \b
    Examples:
      hearth home export maple --format gltf
      hearth home export maple --format procthor
      hearth home export TrimmedTestScene1_graph.json --format obj --out scene1.obj
    """
    from hearth.rendering.scene.gltf_and_obj import ENDINGS, write
    from hearth.rendering.scene.home_geometry import with_geometry
    from hearth.rendering.scene.scene_preparation import PreparedScene

    if form == "procthor":
        from hearth.commands.houses import export_house

        export_house(_graph(home, homes), home, out or Path(f"{Path(home).stem}.json"), assets, as_json)
        return
    known = read_knowledge(None)
    drawable = with_geometry(_graph(home, homes), home, known)
    file = out or Path(Path(home).stem + ENDINGS[form])
    written = write(PreparedScene(drawable.graph, known, seed).scene(), file, form)
    output.note(drawable.note(home))
    output.say(f"{file}: {output.counted(written, 'node')}", {"home": home, "file": file, "nodes": written}, as_json)


@app.command()
def generate(rooms: int = 5, seed: int = 0, out: Path | None = None, as_json: bool = False) -> None:
    """Generate a home: rooms along a hall, furniture with clearances, objects placed by the knowledge.

    \b
    Example:
      hearth home generate --rooms 6 --seed 1 --out my_homes/oak.yaml
    """
    from hearth.homes import home_export
    from hearth.homes.procedural.home_generator import generate as generated_layout
    from hearth.homes.scene_graph import scene

    known = read_knowledge(None)
    layout = generated_layout(rooms, seed, known)
    if out is not None:
        home_export.write(layout, out, known)
    figures = _figures(scene(layout, known))
    names = ", ".join(room.name for room in layout.plan.rooms)
    text = f"{names}: {figures['nodes']:,} nodes, {figures['edges']:,} edges" + (f"; {out}" if out else "")
    output.say(text, {"home": layout.plan.name, "seed": seed, **figures, "file": out}, as_json)


@app.command()
def edit(
    home: str,
    out: Path,
    add: list[str] | None = None,
    remove: list[int] | None = None,
    move: list[str] | None = None,
    states: list[str] | None = None,
    homes: Path | None = None,
    as_json: bool = False,
) -> None:
    """Add, remove and move things of a home and set states, if the knowledge allows it; options may be repeated.

    \b
    Example:
      hearth home edit maple --add apple:inside:137 --move 144:on:150 --set 137:OPEN --out mine.json
    """
    from hearth.commands.home_edits import edited
    from hearth.homes import home_export

    graph, new = edited(_graph(home, homes), add=add or (), remove=remove or (), move=move or (), states=states or (),
                        knowledge=read_knowledge(None), name=home)  # fmt: skip
    home_export.write_release(graph, out)
    ids = f", new ids {', '.join(map(str, new))}" if new else ""
    text = f"{out}: {output.counted(len(graph.nodes), 'node')}, {output.counted(len(graph.edges), 'edge')}{ids}"
    output.say(text, {"home": home, "file": out, "added": new, **_figures(graph)}, as_json)


@app.command()
def stats(
    generated: int = 28,
    seed: int = 0,
    homes: Path | None = None,
    against: Path | None = None,
    as_json: bool = False,
) -> None:
    """Compare our homes, generated homes and those of a folder: room sizes, things, degrees and relations.

    Generated homes have 3 to 9 rooms in turn; each is checked as by `home lint`. With --against, placement_distance is
    how differently the homes there place the same things on and in others, from 0 to 1: the total variation distance,
    averaged over classes by their smaller counts. At the top of the JSON is that of our homes, in `against` the mean
    of those of each home there to the others.

    \b
    Examples:
      hearth home stats --homes release_homes
      hearth home stats --against release_homes
      hearth home stats --generated 1000
    """
    from hearth.commands.home_groups import among, homes_in
    from hearth.homes import library
    from hearth.homes.home_statistics import beside, of_homes, placement_distance, places
    from hearth.homes.procedural.home_generator import generate as generated_layout
    from hearth.homes.scene_graph import scene

    known, ours = read_knowledge(None), library.names()
    groups = {
        "ours": [_graph(name, None) for name in ours],
        "generated": [scene(generated_layout(3 + k % 7, k, known), known) for k in range(seed, seed + generated)],
        "theirs": homes_in(homes),
        "against": homes_in(against),
    }
    found: dict[str, Any] = {name: of_homes(graphs, known) for name, graphs in groups.items() if graphs}
    for figures in found.values():
        # Homes of different sizes are compared by edges a node.
        figures["density beside theirs, %"] = beside(figures, found.get("theirs"))
    if reference := groups.pop("against"):
        for name, graphs in groups.items():
            if graphs:
                found[name]["placement_distance"] = placement_distance(places(graphs, known), places(reference, known))
        found["against"]["placement_distance"] = among(reference)
    if as_json:
        output.emit(found | ({"placement_distance": found["ours"]["placement_distance"]} if reference else {}))
        return
    output.table(("on average", *found), [
        (figure, *("" if figures[figure] is None else figures[figure] for figures in found.values()))
        for figure in found["ours"]])  # fmt: skip


@app.command()
def ways(names: list[str] | None = None, homes: Path | None = None, workers: int = 0, as_json: bool = False) -> None:
    """Make the shortest ways to everything in homes beforehand, and store them; walks by metres then read them there.

    All homes if none is named. The files are next to our homes, or in the folder that HEARTH_WAYS names. Each belongs
    to a floor: a home that is changed makes its ways anew, stored or not.

    \b
    Examples:
      hearth home ways
      HEARTH_WAYS=ways hearth home ways oak --homes my_homes
    """
    from hearth.commands.progress_line import bar
    from hearth.homes import library
    from hearth.simulation.motion.distance_field_jobs import Wanted, make
    from hearth.simulation.motion.stored_distance_fields import folder

    chosen = names or library.names(homes)
    wanted = [Wanted(name, library.load_graph(name, default(), homes), default, folder()) for name in chosen]
    with bar("homes") as seen:
        found = [each._asdict() for each in make(wanted, workers, seen)]
    output.emit(found) if as_json else output.records(found)


def _graph(home: str, homes: Path | None) -> EnvironmentGraph:
    from hearth.homes import library

    return (
        library.graph_of(home, read_knowledge(None))
        if Path(home).suffix
        else library.load_graph(home, read_knowledge(None), homes)
    )


def _layout(home: str, homes: Path | None) -> Any:
    from hearth.homes import library

    return (
        library.layout_of(home, read_knowledge(None))
        if Path(home).suffix
        else library.load_layout(home, read_knowledge(None), homes)
    )


def _figures(graph: EnvironmentGraph) -> dict[str, Any]:
    counts = Counter(edge.relation for edge in graph.edges)
    return {
        "rooms": sum(node.category == "Rooms" for node in graph.nodes),
        "nodes": len(graph.nodes),
        "edges": len(graph.edges),
        "edges_per_node": round(len(graph.edges) / max(1, len(graph.nodes)), 2),
        "relations": {name: counts[name] for name in ("ON", "INSIDE", "CLOSE", "FACING", "BETWEEN")},
    }


def _rooms(graph: EnvironmentGraph) -> list[dict[str, Any]]:
    """Return each room with the objects INSIDE it, counted by class."""
    nodes = {node.id: node for node in graph.nodes}
    inside: dict[int, Counter[str]] = {node.id: Counter() for node in graph.nodes if node.category == "Rooms"}
    for edge in graph.edges:
        if edge.relation == "INSIDE" and edge.target in inside and edge.source in nodes:
            inside[edge.target][nodes[edge.source].class_name] += 1
    return [
        {"room": nodes[room].class_name, "id": room, "things": dict(sorted(things.items()))}
        for room, things in inside.items()
    ]
