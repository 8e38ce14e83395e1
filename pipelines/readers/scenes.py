"""Scene graphs: a home in the release's layout, without a program."""

from collections.abc import Iterator
from pathlib import PurePath

from hearth.datasets.format.codecs import graph_row
from hearth.pipelines.readers.document import document
from hearth.pipelines.readers.item import Item, record, refused, suffixless
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code
from hearth.schemas.graph import from_release
from hearth.schemas.rows import IngestedRow, NodeRow, WrittenGroundingRow
from hearth.schemas.vocabulary import OPPOSITE
from hearth.storage.archives import Place
from hearth.storage.rejects import Reject

NAME = "scenes"


def scan(path: Place, place: str) -> Iterator[Item]:
    """One item: the graph of the file, or the first one of a pair."""
    value = document(path, place)
    if isinstance(value, Reject):
        yield refused(place, value)
        return
    graph = value.get("init_graph", value)
    yield Item(f"{NAME}:{place}", NAME, place, graph)


def read(item: Item) -> IngestedRow | Reject:
    """The record of a scene: the graph of a home that is named by the file."""
    try:
        graph = graph_row(from_release(item.value, item.place))
    except HearthError as error:
        return Reject.because(error.diagnostics, item.place)
    faults = tuple(_state_faults(graph["nodes"], item.place))
    if faults:
        return Reject(faults)
    name = suffixless(PurePath(item.place).name)
    grounding: WrittenGroundingRow = {"home": name, "text": "", "start": graph, "final": None}
    return record(item, "scene", name, "", line=0, groundings=[grounding])


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
