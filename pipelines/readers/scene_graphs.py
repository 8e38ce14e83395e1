"""Scene graphs: a home in the release's layout, without a program."""

from collections.abc import Iterator

from hearth.datasets.format.row_conversion import graph_of, graph_row
from hearth.kb.knowledge import Knowledge
from hearth.pipelines.readers.json_documents import document
from hearth.pipelines.readers.reader_items import Item, home_of, record, refused
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code
from hearth.schemas.graph import from_release
from hearth.schemas.graph_wrappers import graph_in
from hearth.schemas.row_types import NodeRow
from hearth.schemas.stage_rows import IngestedRow, WrittenGroundingRow
from hearth.schemas.vocabulary import OPPOSITE
from hearth.simulation.world.home import Home
from hearth.storage.archives import Place
from hearth.storage.rejects import Reject

NAME = "scenes"


def scan(path: Place, place: str) -> Iterator[Item]:
    """One item: the graph of the file, or the first one of a pair."""
    value = document(path, place)
    if isinstance(value, Reject):
        yield refused(place, value)
        return
    graph = graph_in(value)
    yield Item(f"{NAME}:{place}", NAME, place, graph)


def read(item: Item) -> IngestedRow | Reject:
    """Return the record of a scene: the graph of a home that is named by the file."""
    try:
        graph = graph_row(from_release(item.value, item.place))
    except HearthError as error:
        return Reject.because(error.diagnostics, item.place)
    faults = tuple(_state_faults(graph["nodes"], item.place))
    if faults:
        return Reject(faults)
    name = home_of(item.place)
    grounding: WrittenGroundingRow = {"home": name, "text": "", "start": graph, "final": None}
    return record(item, "scene", name, "", line=0, groundings=[grounding])


def check(row: IngestedRow, known: Knowledge) -> None:
    """Raise a HearthError if nothing can run in a scene: its graph contradicts itself, or lacks rooms or characters."""
    start = (row["groundings"] or [])[0]["start"]
    assert start is not None
    home = Home.from_graph(graph_of(start), row["title"], known)
    lacking = [what for what, found in (("a room", home.rooms), ("a character", home.agents)) if not found]
    if lacking:
        message = f"no home to sample programs in: it lacks {' and '.join(lacking)}"
        raise HearthError.of(Code.BAD_GRAPH, message, file=row["place"], suggestion="add it, or leave the graph out")


def _state_faults(nodes: list[NodeRow], place: str) -> Iterator[Diagnostic]:
    """Nodes with a state twice, or with two states that exclude each other."""
    for node in nodes:
        states = node["states"]
        twice = sorted({state for state in states if states.count(state) > 1})
        both = sorted(state for state in set(states) if OPPOSITE.get(state) in states)
        for found, fault in ((twice, "the same state twice"), (both, "states that exclude each other")):
            if found:
                names = ", ".join(found)
                message = f"node {node['id']} ({node['class_name']}) has {fault}: {names}"
                yield Diagnostic(Code.BAD_GRAPH, message, place, found=names, suggestion="keep one")
