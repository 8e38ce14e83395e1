"""`home convert HOUSE` and `home export --format procthor`: houses of ProcTHOR, both ways."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING

from hearth.commands import output
from hearth.commands.inputs import read_knowledge

if TYPE_CHECKING:
    from hearth.interop.procthor.asset_sizes import Asset
    from hearth.schemas.graph import EnvironmentGraph


def export_house(graph: EnvironmentGraph, home: str, out: Path, assets: Path | None, as_json: bool) -> None:
    """Write a home with boxes as a house of ProcTHOR, and print what AI2-THOR has no object for.

    Raises:
        HearthError: BAD_GRAPH: a node has no box; or the database of models can't be read.
    """
    import orjson

    from hearth.interop.procthor.house_export import house_of

    written = house_of(graph, read_knowledge(None), known_assets(assets), home)
    out.write_bytes(orjson.dumps(written.data, option=orjson.OPT_INDENT_2 | orjson.OPT_APPEND_NEWLINE))
    foreign = Counter(written.foreign)
    objects = len(graph.nodes) - sum(node.class_name in ("wall", "floor", "ceiling") for node in graph.nodes)
    if foreign and not as_json:
        names = ", ".join(f"{name} {count}" if count > 1 else name for name, count in sorted(foreign.items()))
        output.note(f"AI2-THOR has no object for {output.counted(sum(foreign.values()), 'thing')}, which only Hearth "
                    f"reads back: {names}.")  # fmt: skip
    for words in () if as_json else written.unsaid:
        output.note(f"left out, as a house can't say it: {words}")
    text = f"{out}: {output.counted(len(graph.nodes), 'node')} of {home}"
    document = {"home": home, "file": out, "nodes": len(graph.nodes), "objects": objects,
                "only_for_hearth": dict(sorted(foreign.items())), "left_out": written.unsaid}  # fmt: skip
    output.say(text, document, as_json)


def known_assets(path: Path | None) -> dict[str, list[Asset]]:
    """Return the models of a database, or of the installed package `procthor`; {} without either."""
    from hearth.interop.procthor.asset_sizes import installed, read_assets

    return read_assets(path or installed())
