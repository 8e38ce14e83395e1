"""The orders of `home edit`: `CLASS:on:ID`, `ID:inside:ID`, `ID:STATE`."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, NoReturn

from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failure_words import sentence
from hearth.schemas.failures import Code, Failure
from hearth.schemas.numbers import number_of

if TYPE_CHECKING:
    from hearth.kb.knowledge import Knowledge
    from hearth.schemas.graph import EnvironmentGraph, Node

_IDS = "`home convert HOME FILE.json` writes a home's nodes with their ids"

MOST_NAMED = 12
"""Things that a refusal lists."""

RELATIONS = {"on": "ON", "in": "INSIDE", "inside": "INSIDE"}


def edited(
    graph: EnvironmentGraph,
    *,
    add: Sequence[str],
    remove: Sequence[int],
    move: Sequence[str],
    states: Sequence[str],
    knowledge: Knowledge,
    name: str = "",
) -> tuple[EnvironmentGraph, tuple[int, ...]]:
    """Return a graph with things added, removed and moved and states set, and the ids of added things.

    In a home with geometry, added and moved things get a position with room on or in their place.

    Raises:
        HearthError: an order can't be read, names an unknown node or class, or contradicts the knowledge.
    """
    from hearth.homes.from_graph.layout_from_boxes import has_geometry
    from hearth.homes.moved_boxes import posed
    from hearth.simulation.world.edit import edit, free_id
    from hearth.simulation.world.home import Home
    from hearth.simulation.world.world import World

    world = World.start(Home.from_graph(graph, name, knowledge))
    first = free_id(world.home)
    orders = [_placing(text, "CLASS:on:ID") for text in add]
    nodes = [_node(thing, first + k, knowledge) for k, (thing, _, _) in enumerate(orders)]
    place = {node.id: (relation, target) for node, (_, relation, target) in zip(nodes, orders, strict=True)}
    for thing, relation, target in (_placing(text, "ID:on:ID") for text in move):
        place[_number(thing, thing)] = (relation, target)
    wanted = [_state(text) for text in states]
    _check_ids([*remove, *place, *(target for _, target in place.values()), *(node for node, _ in wanted)],
               world.home.index.keys() | {node.id for node in nodes})  # fmt: skip
    _need_empty(graph, remove, place)
    found = edit(world, add=nodes, remove=remove, place=place, set=wanted)
    if isinstance(found, Failure):
        raise HearthError(
            Diagnostic(
                found.code,
                sentence(found, remedy=None, code=False),
                suggestion="another place; `kb show CLASS` names some",
            )
        )
    after = replace(found.graph(), extra=graph.extra)
    return posed(after, place, knowledge) if has_geometry(after) else after, tuple(node.id for node in nodes)


def _check_ids(named: Sequence[int], known: Collection[int]) -> None:
    missing = [Diagnostic(Code.UNKNOWN_ID, f"no node has the id {node}", found=str(node), suggestion=_IDS)
               for node in dict.fromkeys(named) if node not in known]  # fmt: skip
    if missing:
        raise HearthError(missing)


def _need_empty(graph: EnvironmentGraph, removed: Collection[int], moved: Collection[int]) -> None:
    """Refuse to remove a room or a thing while other things stand in it or on it."""
    left: dict[int, set[int]] = {node: set() for node in removed}
    gone = {*removed, *moved}
    for source, relation, target in graph.edges:
        if target in left and relation in RELATIONS.values() and source not in gone:
            left[target].add(source)
    faults = [_left(node, sorted(things)) for node, things in left.items() if things]
    if faults:
        raise HearthError(faults)


def _left(node: int, things: Sequence[int]) -> Diagnostic:
    count = "1 thing" if len(things) == 1 else f"{len(things):,} things"
    more = f" and {len(things) - MOST_NAMED:,} more" if len(things) > MOST_NAMED else ""
    remedy = f"move or remove first: {', '.join(map(str, things[:MOST_NAMED]))}{more}"
    message = f"{count} in or on node {node} would be nowhere without it"
    return Diagnostic(Code.OCCUPIED, message, found=str(node), suggestion=remedy)


def _placing(text: str, form: str) -> tuple[str, str, int]:
    parts = text.split(":")
    if len(parts) != 3 or parts[1].lower() not in RELATIONS:
        _refuse(f"`{text}` is not a placement", f"write {form}, with `on` or `inside`")
    return parts[0], RELATIONS[parts[1].lower()], _number(parts[2], text)


def _state(text: str) -> tuple[int, str]:
    from hearth.schemas.vocabulary import STATES

    thing, _, state = text.partition(":")
    if state.upper() not in STATES:
        _refuse(f"`{text}` does not name a state", f"write ID:STATE, with one of {', '.join(STATES)}")
    return _number(thing, text), state.upper()


def _number(text: str, whole: str) -> int:
    number = number_of(text)
    if number is None:
        _refuse(f"`{text[:40]}` in `{whole[:80]}` is not a node id", _IDS)
    return number


def _node(class_name: str, node_id: int, knowledge: Knowledge) -> Node:
    from hearth.schemas.graph import Node

    known = knowledge.object_class(class_name)
    if known is None:
        near = knowledge.suggest(class_name)
        hint = f"did you mean `{near[0]}`?" if near else "`kb find` lists the classes"
        raise HearthError.of(Code.UNKNOWN_OBJECT, f"`{class_name}` is not a class", suggestion=hint)
    states = knowledge.default_states(known.name)
    return Node(node_id, known.name, known.category, tuple(sorted(known.properties)), states)


def _refuse(message: str, hint: str) -> NoReturn:
    raise HearthError.of(Code.SYNTAX, message, suggestion=hint)
