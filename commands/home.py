"""`home`: list, show, check, convert, edit and generate homes."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from hearth.commands import options, output
from hearth.commands.inputs import read_knowledge

if TYPE_CHECKING:
    from hearth.homes.from_graph.graph_layout import GraphLayout
    from hearth.schemas.diagnostics import Diagnostic
    from hearth.schemas.graph import EnvironmentGraph

app = typer.Typer(
    no_args_is_help=True, add_completion=False, help="The homes: list, show, check, convert, edit and generate them."
)

Home = Annotated[str, typer.Argument(metavar="HOME", help="A home's name, a plan (.yaml) or a scene graph (.json).")]


@app.command("list")
def list_homes(homes: options.Homes = None, as_json: options.Json = False) -> None:
    """List the homes with their numbers of rooms, nodes and edges.

    \b
    Example:
      python cli.py home list --homes my_homes
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
def show(
    home: Home,
    out: Annotated[
        Path | None, typer.Option("--out", metavar="FILE", help="Draw the floor plan: .svg or .png.")
    ] = None,
    homes: options.Homes = None,
    as_json: options.Json = False,
) -> None:
    """Show the rooms of a home and their contents; with --out, draw its floor plan.

    \b
    Example:
      python cli.py home show maple --out maple.svg
    """
    graph = _graph(home, homes)
    if out is not None:
        from hearth.homes import drawing

        drawing.write(_layout(home, homes), out)
    rooms = _rooms(graph)
    if as_json:
        output.emit({"home": home, **_figures(graph), "contents": rooms, "drawing": out})
        return
    for room in rooms:
        things = ", ".join(f"{name} {count}" if count > 1 else name for name, count in room["things"].items())
        print(f"{room['room']} ({room['id']}): {things}")
    figures = _figures(graph)
    print(f"{figures['nodes']:,} nodes, {figures['edges']:,} edges" + (f"; floor plan in {out}" if out else ""))


@app.command()
def lint(
    home: Home,
    layout: Annotated[
        bool,
        typer.Option("--layout", help="Lay a scene graph out, and report the relations that the layout can't show."),
    ] = False,
    homes: options.Homes = None,
    as_json: options.Json = False,
) -> None:
    """Report the faults of a home or of any scene graph; the status is 1 if there are any.

    With --layout, a graph without geometry is laid out, and every relation that the layout can't show is named; these
    are not faults.

    \b
    Examples:
      python cli.py home lint TrimmedTestScene1_graph.json
      python cli.py home lint TrimmedTestScene1_graph.json --layout
    """
    from hearth.homes import library
    from hearth.homes.lint import lint as check

    graph = _graph(home, homes)
    known = read_knowledge(None)
    faults = check(graph, known, file=home if Path(home).suffix else "")
    made = library.graph_layout(home, known, homes) if layout else None
    if as_json:
        document = {"home": home, "faults": faults, "by_code": _codes(faults)}
        output.emit(document if made is None else {**document, "met": met(made), "unmet": made.unmet})
    else:
        output.report(faults)
        if made is not None:
            for fault in made.unmet:
                print(f"{fault.message} ({fault.suggestion})")
            output.table(("of the graph", "there are", "shown by the layout"), [
                (row["what"], row["all"], row["shown"]) for row in met(made)])  # fmt: skip
        codes = ", ".join(f"{code} {count}" for code, count in _codes(faults).items())
        print(f"{home}: {output.counted(len(faults), 'fault')} of the graph itself" + (f": {codes}" if codes else ""))
    output.status(len(faults), strict=True)


def _codes(faults: Sequence[Diagnostic]) -> dict[str, int]:
    return dict(sorted(Counter(str(fault.code) for fault in faults).items()))


def met(layout: GraphLayout) -> list[dict[str, Any]]:
    """For nodes and for each relation, the number in the graph and the number that the layout shows."""
    edges = Counter(edge.relation for edge in layout.graph.edges)
    lost = Counter(
        "things" if fault.code == "NO_PLACE" else next(name for name in edges if f") {name} " in fault.message)
        for fault in layout.unmet
    )
    rows = {"things": len(layout.graph.nodes), **{name: edges[name] for name in ("ON", "INSIDE", "CLOSE", "FACING")}}
    return [{"what": name, "all": count, "shown": count - lost[name]} for name, count in rows.items()]


@app.command()
def convert(
    home: Home,
    out: Annotated[Path, typer.Argument(metavar="FILE", help="`.json`: the release's layout; `.ids.csv`: node ids.")],
    layout: Annotated[bool, typer.Option("--layout", help="Lay a scene graph out by its relations.")] = False,
    homes: options.Homes = None,
    as_json: options.Json = False,
) -> None:
    """Write a home as a scene graph in the release's layout, or its node ids by name.

    A file `x.ids.csv` beside a plan `x.yaml` keeps the ids when the plan changes; new nodes get new ids.

    \b
    Examples:
      python cli.py home convert maple maple.json
      python cli.py home convert my_homes/oak.yaml my_homes/oak.ids.csv
      python cli.py home convert TrimmedTestScene1_graph.json scene1.json --layout
    """
    from hearth.homes import exporting, library

    if out.name.endswith(".ids.csv"):
        written = exporting.write_ids(_layout(home, homes), out)
    else:
        made = library.graph_layout(home, read_knowledge(None), homes).graph if layout else _graph(home, homes)
        written = exporting.write_release(made, out)
    output.say(f"{out}: {output.counted(written, 'node')}", {"home": home, "file": out, "nodes": written}, as_json)


@app.command()
def generate(
    rooms: Annotated[int, typer.Option("--rooms", help="Number of rooms, 3 to 9.")] = 5,
    seed: Annotated[int, typer.Option("--seed", help="Seed of everything else.")] = 0,
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="FILE", help="A plan (.yaml), a scene graph (.json) or a drawing (.svg, .png)."),
    ] = None,
    as_json: options.Json = False,
) -> None:
    """Generate a home: rooms along a hall, furniture with clearances, objects placed by the knowledge.

    \b
    Example:
      python cli.py home generate --rooms 6 --seed 1 --out my_homes/oak.yaml
    """
    from hearth.homes import exporting
    from hearth.homes.procedural.generate import generate as generated_layout
    from hearth.homes.scene_graph import scene

    known = read_knowledge(None)
    layout = generated_layout(rooms, seed, known)
    if out is not None:
        exporting.write(layout, out, known)
    figures = _figures(scene(layout, known))
    names = ", ".join(room.name for room in layout.plan.rooms)
    text = f"{names}: {figures['nodes']:,} nodes, {figures['edges']:,} edges" + (f"; {out}" if out else "")
    output.say(text, {"home": layout.plan.name, "seed": seed, **figures, "file": out}, as_json)


@app.command()
def edit(
    home: Home,
    out: Annotated[Path, typer.Option("--out", metavar="FILE", help="Gets the scene graph, as .json.")],
    add: Annotated[
        list[str] | None, typer.Option("--add", metavar="CLASS:on:ID", help="Add a thing, on or inside another.")
    ] = None,
    remove: Annotated[list[int] | None, typer.Option("--remove", metavar="ID", help="Remove a thing.")] = None,
    move: Annotated[list[str] | None, typer.Option("--move", metavar="ID:on:ID", help="Move a thing.")] = None,
    states: Annotated[list[str] | None, typer.Option("--set", metavar="ID:STATE", help="Set a state.")] = None,
    homes: options.Homes = None,
    as_json: options.Json = False,
) -> None:
    """Add, remove and move things of a home and set states, if the knowledge allows it; options may be repeated.

    \b
    Example:
      python cli.py home edit maple --add apple:inside:137 --move 144:on:150 --set 137:OPEN --out mine.json
    """
    from hearth.commands.home_edits import edited
    from hearth.homes import exporting

    graph, new = edited(_graph(home, homes), add=add or (), remove=remove or (), move=move or (), states=states or (),
                        knowledge=read_knowledge(None), name=home)  # fmt: skip
    exporting.write_release(graph, out)
    ids = f", new ids {', '.join(map(str, new))}" if new else ""
    text = f"{out}: {output.counted(len(graph.nodes), 'node')}, {output.counted(len(graph.edges), 'edge')}{ids}"
    output.say(text, {"home": home, "file": out, "added": new, **_figures(graph)}, as_json)


@app.command()
def stats(
    generated: Annotated[
        int, typer.Option("--generated", metavar="N", min=0, help="Number of homes to generate.")
    ] = 28,
    seed: Annotated[int, typer.Option("--seed", help="Seed of the first generated home; the others follow.")] = 0,
    homes: options.Homes = None,
    as_json: options.Json = False,
) -> None:
    """Compare our homes, generated homes and those of a folder: room sizes, things, degrees and relations.

    Generated homes have 3 to 9 rooms in turn; each is checked as by `home lint`.

    \b
    Examples:
      python cli.py home stats --homes release_homes
      python cli.py home stats --generated 1000
    """
    from hearth.homes import library
    from hearth.homes.procedural.generate import generate as generated_layout
    from hearth.homes.scene_graph import scene
    from hearth.homes.statistics import beside, of_homes

    known, ours = read_knowledge(None), library.names()
    theirs = [name for name in library.names(homes) if name not in ours] if homes else []
    groups = {
        "ours": of_homes((_graph(name, None) for name in ours), known),
        "generated": of_homes(
            (scene(generated_layout(3 + k % 7, k, known), known) for k in range(seed, seed + generated)), known
        ),
        "theirs": of_homes((_graph(name, homes) for name in theirs), known),
    }
    found = {name: figures for name, figures in groups.items() if figures}
    for figures in found.values():
        # Homes of different sizes are compared by edges a node.
        figures["density beside theirs, %"] = beside(figures, found.get("theirs"))
    if as_json:
        output.emit(found)
        return
    output.table(("on average", *found), [
        (figure, *("" if figures[figure] is None else figures[figure] for figures in found.values()))
        for figure in found["ours"]])  # fmt: skip


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
    """Each room with what is INSIDE it, counted by class."""
    nodes = {node.id: node for node in graph.nodes}
    inside: dict[int, Counter[str]] = {node.id: Counter() for node in graph.nodes if node.category == "Rooms"}
    for edge in graph.edges:
        if edge.relation == "INSIDE" and edge.target in inside and edge.source in nodes:
            inside[edge.target][nodes[edge.source].class_name] += 1
    return [
        {"room": nodes[room].class_name, "id": room, "things": dict(sorted(things.items()))}
        for room, things in inside.items()
    ]
