"""Scene graphs as tests read them: their classes, and which thing holds which."""

from hearth.interop.scene_graphs.reading import read_scene
from hearth.interop.scene_graphs.shape import usual
from hearth.kb.loading.load import default

KNOWN = default()


def read(data, shape=None):
    return read_scene(data, shape or usual(), KNOWN, "scan.json")


def classes(found):
    return sorted(
        node.class_name for node in found.graph.nodes if node.category not in ("Rooms", "Characters", "Doors")
    )


def held(found, relation):
    names = {node.id: node.class_name for node in found.graph.nodes}
    rooms = {node.id for node in found.graph.nodes if node.category == "Rooms"}
    return {
        (names[edge.source], names[edge.target])
        for edge in found.graph.edges
        if edge.relation == relation and edge.target not in rooms
    }


def rooms_of(found):
    names = {node.id: node.class_name for node in found.graph.nodes}
    rooms = {node.id for node in found.graph.nodes if node.category == "Rooms"}
    return {names[e.source]: names[e.target] for e in found.graph.edges if e.relation == "INSIDE" and e.target in rooms}
