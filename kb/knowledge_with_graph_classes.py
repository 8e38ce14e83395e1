"""The knowledge with the classes of a graph, each by its exact name.

Graphs of VirtualHome 2.x call a fork `cutleryfork`, and have classes that the knowledge lacks. A program for such a
graph may name everything as the graph does.
"""

from collections.abc import Iterable
from dataclasses import replace

from hearth.kb.knowledge import Knowledge
from hearth.kb.knowledge_records import ObjectClass
from hearth.kb.spelling import key_of
from hearth.schemas.graph import Node


def with_classes(knowledge: Knowledge, nodes: Iterable[Node]) -> Knowledge:
    """Return the knowledge with the classes of these nodes; itself where it has all of them by these names.

    A class that is known by another name becomes a class of its own that says `same_as`, as `sofa` does of `couch`; one
    that is not known has the category of its first node. Both have the properties of all their nodes, too.
    """
    new: dict[str, ObjectClass] = {}
    for node in nodes:
        name = node.class_name
        if name in knowledge.objects:
            continue
        first = new.get(name) or _called(name, node, knowledge)
        new[name] = replace(first, properties=first.properties | set(node.properties))
    if not new:
        return knowledge
    after = max(thing.id for thing in knowledge.objects.values()) + 1
    found = {name: replace(thing, id=number) for number, (name, thing) in enumerate(new.items(), after)}
    spellings = {key_of(name): thing for name, thing in found.items()}
    return replace(
        knowledge,
        objects={**knowledge.objects, **found},
        _object_names={**knowledge._object_names, **spellings},
    )


def _called(name: str, node: Node, knowledge: Knowledge) -> ObjectClass:
    known = knowledge.object_class(name)
    if known is None:
        return ObjectClass(name, 0, node.category, source="graph")
    return replace(known, name=name, same_as=known.same_as or known.name, synonyms=())
