"""The library of homes: the designed ones, and a user's own from `--homes DIR`."""

from collections.abc import Mapping
from dataclasses import replace
from difflib import get_close_matches
from functools import lru_cache
from importlib.resources import as_file, files
from pathlib import Path
from typing import Any

from hearth.homes.from_graph.graph_layout import GraphLayout, lay_out
from hearth.homes.from_graph.layout_from_boxes import has_geometry, measured
from hearth.homes.node_defaults import filled
from hearth.homes.plans.layout import Layout, read
from hearth.homes.scene_graph import scene
from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code
from hearth.schemas.graph import EnvironmentGraph, from_release
from hearth.schemas.graph_wrappers import graph_in
from hearth.schemas.numbers import number_of
from hearth.schemas.text_decoding import decode
from hearth.storage.csv_files import CsvTable
from hearth.storage.input_files import read_input

IDS = ".ids.csv"
"""A plan `maple.yaml` may have its node ids fixed in `maple.ids.csv`, with columns id and name."""

LARGEST_IDS = 16 << 20
"""Bytes of such a file, at most: all of it is in memory."""


def names(directory: Path | str | None = None, *, alone: bool = False) -> tuple[str, ...]:
    """Return the homes' names, sorted: ours (unless `alone`), and those of the user's directory.

    Raises:
        HearthError: MISSING_FILE: the directory does not exist.
    """
    return tuple(sorted(_files(directory, {} if alone else _own())))


def load_graph(name: str, knowledge: Knowledge, directory: Path | str | None = None) -> EnvironmentGraph:
    """Return a home's scene graph; built once a process.

    Raises:
        HearthError: UNKNOWN_HOME, or every fault of its plan or graph.

    Examples:
        >>> graph = hearth.load_graph("maple", known)
        >>> len(graph.nodes), [node.class_name for node in graph.nodes if node.category == "Rooms"]
        (367, ['living_room', 'kitchen', 'bedroom', 'bathroom'])
    """
    path = _file(name, directory)
    return _graph(path, knowledge) if path.suffix == ".json" else _scene(path, knowledge)


def load_layout(name: str, knowledge: Knowledge, directory: Path | str | None = None) -> Layout:
    """Return a home's plan with everything in its place; a scene graph is laid out by its relations.

    Raises:
        HearthError: UNKNOWN_HOME; every fault of its plan; or NO_ROOM: a graph without rooms.
    """
    return layout_of(_file(name, directory), knowledge)


def layout_of(path: Path | str, knowledge: Knowledge) -> Layout:
    """Return a plan file with everything in its place, or a graph laid out; errors as of `load_layout`."""
    found = Path(path)
    if found.suffix != ".json":
        return _layout(found, knowledge)
    graph = _graph(found, knowledge)
    return measured(graph, found.stem, knowledge) if has_geometry(graph) else graph_layout(found, knowledge).layout


def graph_layout(home: Path | str, knowledge: Knowledge, directory: Path | str | None = None) -> GraphLayout:
    """Return a scene graph (a file, or a home's by name) with the geometry that its relations suggest, and the
    relations that it does not show; errors as of `load_graph`.
    """
    return _graph_layout(Path(home) if Path(home).suffix else _file(str(home), directory), knowledge)


@lru_cache(maxsize=16)
def _graph_layout(path: Path, knowledge: Knowledge) -> GraphLayout:
    return lay_out(graph_of(path, knowledge), path.stem, knowledge)


def graph_of(path: Path | str, knowledge: Knowledge) -> EnvironmentGraph:
    """Return the scene graph of a plan file, or of a JSON file in the release's layout; errors as of `load_graph`."""
    found = Path(path)
    return _graph(found, knowledge) if found.suffix == ".json" else _scene(found, knowledge)


FILES = (".json", ".yaml")
"""Endings of the names of scene graphs and plans."""


def given_file(home: str) -> Path | None:
    """Return the file of a home that is given by its path, `scenes/mine.json`; None where it is given by its name."""
    path = Path(home)
    return path if home.endswith(FILES) and path.is_file() else None


def named_graph(home: str, knowledge: Knowledge, directory: Path | str | None = None) -> tuple[str, EnvironmentGraph]:
    """Return the name and the scene graph of a home that is given by its name, or by its file's path.

    Raises:
        HearthError: as `load_graph`.
    """
    path = given_file(home)
    if path is not None:
        return path.stem, graph_of(path, knowledge)
    return home, load_graph(home, knowledge, directory)


def _file(name: str, directory: Path | str | None) -> Path:
    known = _files(directory, _own())
    if name not in known:
        near = get_close_matches(name, known, 1)
        hint = f"did you mean `{near[0]}`?" if near else f"homes are {', '.join(sorted(known))}"
        if name.endswith(FILES):
            there = f"`--homes FOLDER --home {Path(name).stem}` takes a home of a folder"
            hint = f"there is no file of that name; {hint}" if given_file(name) is None else there
        raise HearthError.of(Code.UNKNOWN_HOME, f"there is no home `{name}`", suggestion=hint)
    return known[name]


def _files(directory: Path | str | None, own: Mapping[str, Path]) -> dict[str, Path]:
    found = dict(own)
    if directory is not None:
        found.update(_in(_folder(directory)))
    return found


@lru_cache(maxsize=1)
def _own() -> Mapping[str, Path]:
    with as_file(files("hearth.data_raw") / "homes") as folder:
        return _in(folder)


def files_of(directory: Path) -> list[Path]:
    """Return the files of homes in a directory, by name: plans, their ids, scene graphs.

    Raises:
        HearthError: MISSING_FILE: the directory does not exist.
    """
    found = sorted(_folder(directory).iterdir())
    return [path for path in found if path.name.endswith((".yaml", ".json", IDS)) and path.is_file()]


def _folder(directory: Path | str) -> Path:
    folder = Path(directory)
    if not folder.is_dir():
        raise HearthError.of(Code.MISSING_FILE, f"`{folder}` is not a directory", suggestion="--homes DIR")
    return folder


def _in(folder: Path) -> dict[str, Path]:
    plans = {path.stem: path for path in sorted(folder.glob("*.yaml"))}
    return {path.stem: path for path in sorted(folder.glob("*.json"))} | plans


@lru_cache(maxsize=64)
def _scene(path: Path, knowledge: Knowledge) -> EnvironmentGraph:
    return scene(_layout(path, knowledge), knowledge)


def _graph(path: Path, knowledge: Knowledge) -> EnvironmentGraph:
    return _filled_graph(path, knowledge)[0]


def filled_nodes(home: Path | str, knowledge: Knowledge, directory: Path | str | None = None) -> tuple[str, ...]:
    """Return the nodes of a scene graph (a file, or a home's by name) that left out what the knowledge says of their
    class, as `salmon (1000)`; none of a plan. Errors as of `load_graph`.
    """
    path = Path(home) if Path(home).suffix else _file(str(home), directory)
    return _filled_graph(path, knowledge)[1] if path.suffix == ".json" else ()


@lru_cache(maxsize=64)
def _filled_graph(path: Path, knowledge: Knowledge) -> tuple[EnvironmentGraph, tuple[str, ...]]:
    found = filled(_graph_data(path, "init_graph"), knowledge)
    return from_release(found.data, str(path)), found.nodes


def read_graph(path: Path, which: str) -> EnvironmentGraph:
    """Read a scene graph, or the `init_graph` or `final_graph` of a pair as the release stores it.

    Raises:
        HearthError: MISSING_FILE, BAD_JSON or BAD_GRAPH.
    """
    return from_release(_graph_data(path, which), str(path))


def _graph_data(path: Path, which: str) -> Mapping[str, Any]:
    import orjson

    try:
        data = orjson.loads(read_input(path))
        data = data[which] if isinstance(data, dict) and which in data else graph_in(data) or data
        orjson.dumps(data)  # what is read may stand deeper in one another than can be written
    except (orjson.JSONDecodeError, orjson.JSONEncodeError) as error:
        raise HearthError.of(Code.BAD_JSON, f"not JSON: {error}", file=str(path)) from error
    if not isinstance(data, dict):
        raise HearthError.of(Code.BAD_GRAPH, "not an environment graph", file=str(path), suggestion="nodes and edges")
    return data


@lru_cache(maxsize=64)
def _layout(path: Path, knowledge: Knowledge) -> Layout:
    text = decode(read_input(path), str(path))
    if not isinstance(text, str):
        raise HearthError(text)
    layout = read(text, str(path), knowledge)
    return replace(layout, plan=replace(layout.plan, ids=_ids(path.with_name(path.stem + IDS))))


def _ids(path: Path) -> dict[str, int]:
    """Return node ids by name, from the file that belongs to a plan; empty where there is none."""
    if not path.exists():
        return {}
    found: dict[str, int] = {}
    taken: set[int] = set()
    for line, (name, given) in CsvTable(path, ("name", "id"), LARGEST_IDS).rows():
        number = number_of(given)
        if number is None or not name or name in found or number in taken:
            message = f"`{given[:40]},{name[:40]}` repeats an id or a name, or lacks one"
            raise HearthError(Diagnostic(Code.BAD_TABLE, message, str(path), line,
                                         suggestion="columns id and name, each once"))  # fmt: skip
        found[name] = number
        taken.add(number)
    return found
