"""The ActivityPrograms release, as a zip or a folder in its own layout; any of its folders may be missing."""

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from operator import itemgetter
from pathlib import Path
from typing import Any

import orjson

from hearth.datasets.format.row_conversion import change_row, node_row
from hearth.pipelines.readers.graph_pairs import EDGE, JsonObject, pair_of, read_pair
from hearth.pipelines.readers.program_text import header
from hearth.pipelines.readers.reader_items import LARGEST_FILE, Item, record, refused
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code
from hearth.schemas.graph import Edge, EdgeColumns, read_node
from hearth.schemas.graph_change import Change
from hearth.schemas.graph_json_faults import REMEDY, graph_fault
from hearth.schemas.numbers import stored
from hearth.schemas.row_types import ChangeRow, ConditionRow, GraphRow
from hearth.schemas.stage_rows import IngestedRow, WrittenGroundingRow
from hearth.schemas.text_decoding import decode
from hearth.storage.archives import archive, members, refusal_of
from hearth.storage.files import file_digest, walk
from hearth.storage.names import leaves
from hearth.storage.rejects import Reject

NAME = "release"

FOLDERS: dict[str, str] = {
    "withoutconds": "collected",
    "initstate": "conditions",
    "executable_programs": "grounded",
    "init_and_final_graphs": "graphs",
    "init_and_final_graph": "graphs",
    "state_list": "states",
}
"""The release's folders by the kind of their files."""

_IN_HOMES = frozenset({"grounded", "graphs", "states"})

_HOME = re.compile(r"(.*?)(_graph)?")


def names_it(path: str) -> bool:
    """Return whether a path inside an archive or folder belongs to the release's layout."""
    return _located(path) is not None


def _located(path: str) -> tuple[str, str, str] | None:
    """Return the kind of a file, its home ("" for none), and its program (`batch/file`).

    The result is None for a file of another layout.
    """
    parts = path.split("/")
    for number, part in enumerate(parts[:-1]):
        kind = FOLDERS.get(part)
        if kind:
            inside = parts[number + 1 :]
            home = inside.pop(0) if kind in _IN_HOMES and len(inside) > 1 else ""
            stem, dot, suffix = "/".join(inside).rpartition(".")
            if not dot or suffix not in ("txt", "json"):
                return None
            match = _HOME.fullmatch(home)
            return kind, match[1] if match else home, stem
    return None


def scan(path: Path, place: str) -> Iterator[Item]:
    """One item for each program of any of the folders, ordered by name.

    Raises:
        HearthError: the archive is damaged, or holds none of the folders.
    """
    programs: dict[str, JsonObject] = {}
    versions: dict[str, str] = {}
    for name, version in _listing(path):
        located = _located(name)
        if located is None or located[0] == "states":
            continue
        if leaves(name):
            message = f"`{name[:100]}` leaves the archive"
            yield refused(f"{place}/{name}", Reject.of(Code.BAD_ARCHIVE, message, file=place, found=name[:200]))
            continue
        kind, home, key = located
        members = programs.setdefault(key, {})
        if kind in _IN_HOMES:
            members.setdefault(kind, {})[home] = name
        else:
            members[kind] = name
        versions[key] = f"{versions.get(key, '')}{version} "
    if not programs:
        suggestion = f"it needs one of the folders {', '.join(sorted(FOLDERS))}"
        raise HearthError.of(Code.BAD_ARCHIVE, "not a release: no programs in it", file=place, suggestion=suggestion)
    for key in sorted(programs):
        yield _item(path, place, key, programs[key], versions[key])


def _item(path: Path, place: str, key: str, members: JsonObject, version: str) -> Item:
    where = f"{place}/{key}"
    if "collected" not in members and "grounded" not in members:
        have = " and ".join(sorted(members))
        fault = Diagnostic(Code.MISSING_FILE, f"{have} of a program that is in no other folder", where)
        return refused(where, Reject((fault,)), f"{NAME}:{key}")
    return Item(f"{NAME}:{key}", NAME, where, {"label": place, "key": key, **members}, version, str(path))


def _listing(path: Path) -> Iterable[tuple[str, str]]:
    """Return the name and a checksum of each file."""
    if path.is_dir():
        for file in walk(path):
            yield file.relative_to(path).as_posix(), file_digest(file)[:16]
    else:
        for info in members(archive(path)):
            yield info.filename, f"{info.CRC:08x}"


def _bytes(value: JsonObject, name: str) -> bytes | Diagnostic:
    """Return a member's bytes, or the fault that prevents reading them."""
    path = Path(value["path"])
    place = f"{value['label']}/{name}"
    try:
        if path.is_dir():
            return (path / name).read_bytes()
        info = archive(path).getinfo(name)
        refusal = refusal_of(info, place)
        if refusal:
            return refusal.diagnostics[0]
        if info.file_size > LARGEST_FILE:
            message = f"it claims to unpack to {info.file_size:,} bytes, at most {LARGEST_FILE:,} are read"
            return Diagnostic(Code.FILE_TOO_LARGE, message, place, suggestion="leave it out, or split it")
        with archive(path).open(info) as file:
            return file.read(max(info.file_size, 1))  # Twice as fast as without a size, which is the most there is.
    except Exception as error:  # archives raise the errors of their compression: zlib, lzma, bz2, struct, ...
        return Diagnostic(Code.BAD_ARCHIVE, f"can't be read: {error}", place, suggestion="download it again")


def text_of(value: JsonObject, name: str) -> str | Diagnostic:
    """Return a member of the release as text, or its fault; `value` is an item's, with its path."""
    data = _bytes(value, name)
    return data if isinstance(data, Diagnostic) else decode(data, f"{value['label']}/{name}")


def json_of(value: JsonObject, name: str, loads: Callable[[bytes], Any] = orjson.loads) -> Any:
    """Return a member of the release as a JSON value, as `loads` reads it, or its fault."""
    data = _bytes(value, name)
    if isinstance(data, Diagnostic):
        return data
    try:
        return loads(data)
    except orjson.JSONDecodeError as error:
        return Diagnostic(Code.BAD_JSON, f"not JSON: {error}", f"{value['label']}/{name}", error.lineno, error.colno)


def read(item: Item) -> Iterator[IngestedRow | Reject]:
    """Yield the record of a program with all its groundings; a grounding that can't be read is refused alone."""
    value = {**item.value, "path": item.path}
    groundings: list[WrittenGroundingRow] = []
    faults: list[Diagnostic] = []
    for home in sorted({*value.get("grounded", {}), *value.get("graphs", {})}):
        grounding = _grounding(value, home)
        if isinstance(grounding, Diagnostic):
            faults.append(grounding)
        elif grounding:
            groundings.append(grounding)
    text = _collected(value, groundings)
    conditions = _conditions(value)
    faults.extend(fault for fault in (text, conditions) if isinstance(fault, Diagnostic))
    if isinstance(text, str):
        yield _row(item, text, groundings, conditions if isinstance(conditions, list) else [])
    yield from (Reject((fault,)) for fault in faults)


def _row(item: Item, text: str, groundings: list[WrittenGroundingRow], conditions: list[ConditionRow]) -> IngestedRow:
    title, description = header(text)
    value = item.value
    place = value.get("collected") or value["grounded"][min(value["grounded"])]
    return record(
        item,
        "program",
        title,
        description,
        place=f"{value['label']}/{place}",
        description_id=f"{NAME}:{value['key'].rpartition('_')[0] or value['key']}",
        text=text,
        line=0,
        groundings=groundings,
        conditions=conditions,
    )


def _collected(value: JsonObject, groundings: list[WrittenGroundingRow]) -> str | Diagnostic:
    """Return the text as collected, or else the first grounded one without its node ids."""
    if "collected" in value:
        return text_of(value, value["collected"])
    if groundings:
        return re.sub(r"\((\d+)\.\d+\)", r"(\1)", groundings[0]["text"])
    return Diagnostic(Code.MISSING_FILE, "none of its texts can be read", f"{value['label']}/{value['key']}")


def _grounding(value: JsonObject, home: str) -> WrittenGroundingRow | Diagnostic | None:
    name = value.get("grounded", {}).get(home)
    if name is None:
        place = f"{value['label']}/{value['graphs'][home]}"
        return Diagnostic(Code.MISSING_FILE, f"graphs for {home}, but no program grounded there", place)
    text = text_of(value, name)
    if isinstance(text, Diagnostic):
        return text
    start, final = None, None
    if home in value.get("graphs", {}):
        graphs = _graphs(value, value["graphs"][home])
        if isinstance(graphs, Diagnostic):
            return graphs
        start, final = graphs
    return {"home": home, "text": text, "start": start, "final": final}


def _graphs(value: JsonObject, name: str) -> tuple[GraphRow, ChangeRow | None] | Diagnostic:
    return _pair_row(partial(json_of, value, name, read_pair), f"{value['label']}/{name}")


def graphs_of(data: Any, place: str) -> tuple[GraphRow, ChangeRow | None] | Diagnostic:
    """Return the start graph of a pair, and the change to its final graph if there is one."""
    return _pair_row(partial(pair_of, data), place)


def _pair_row(
    read_it: Callable[[], tuple[JsonObject, Change | None] | Diagnostic], place: str
) -> tuple[GraphRow, ChangeRow | None] | Diagnostic:
    start: JsonObject | None = None
    try:
        pair = read_it()
        if isinstance(pair, Diagnostic):
            return pair
        start, change = pair
        sources, relations, targets = _columns(sorted(_edges(start)))
        nodes = [node_row(read_node(node)) for node in start["nodes"]]
        row: GraphRow = {"nodes": nodes, "sources": sources, "relations": relations, "targets": targets}
        _columns(change.added if change else ())
        return row, None if change is None else change_row(change)
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        why = graph_fault(start, error) if start else f"{type(error).__name__} {error}"
        message = f"not a pair of environment graphs: {why}"
        return Diagnostic(Code.BAD_GRAPH, message, place, suggestion=REMEDY)


def _edges(graph: JsonObject) -> set[Edge]:
    """Edges as plain tuples, which equal `Edge` and are made faster."""
    edges = graph["edges"]
    return set(edges.rows() if isinstance(edges, EdgeColumns) else map(EDGE, edges))


def _columns(edges: Sequence[Edge]) -> tuple[list[int], list[str], list[int]]:
    """Edges column by column.

    Raises:
        TypeError: an id is not a number, or a relation not a word.
    ValueError: an id has more than 32 bits.
    """
    sources, relations, targets = (list(map(itemgetter(place), edges)) for place in range(3))
    if not {*map(type, sources), *map(type, targets)} <= {int} or not {*map(type, relations)} <= {str}:
        raise TypeError("an edge needs numbers for ids and a word for its relation")
    if edges:
        list(map(stored, (min(sources), max(sources), min(targets), max(targets))))
    return sources, relations, targets


def _conditions(value: JsonObject) -> list[ConditionRow] | Diagnostic:
    if "conditions" not in value:
        return []
    data = json_of(value, value["conditions"])
    if isinstance(data, Diagnostic):
        return data
    try:
        return [_condition(name, objects) for entry in data for name, objects in entry.items()]
    except (AttributeError, TypeError, ValueError, IndexError, KeyError) as error:
        message = f"not a list of preconditions: {error}"
        return Diagnostic(Code.BAD_JSON, message, f"{value['label']}/{value['conditions']}")


def _condition(name: str, objects: list[Any]) -> ConditionRow:
    pairs = objects if objects and isinstance(objects[0], list) else [objects]
    return {
        "name": name,
        "objects": [{"name": str(o[0]).lower(), "instance": stored(o[1])} for o in pairs],
        "step": None,
        "hard": None,
    }
