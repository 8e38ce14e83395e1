"""Stand-ins for the classes of VirtualHome's symbolic half, `evolving_graph`: same names, inputs and outputs."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from enum import Enum
from pathlib import Path
from typing import Any

from hearth.homes.node_defaults import filled
from hearth.kb.action_grammar import check
from hearth.kb.knowledge import Knowledge
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.graph import EnvironmentGraph as SceneGraph
from hearth.schemas.graph import Node, from_release, to_release
from hearth.schemas.program import Program
from hearth.schemas.syntax import parse_programs
from hearth.schemas.vocabulary import PROPERTIES, RELATIONS, STATES
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World
from hearth.storage.input_files import read_input

Relation = Enum("Relation", {name: number for number, name in enumerate(RELATIONS, 1)})  # type: ignore[misc]
State = Enum("State", {name: number for number, name in enumerate(STATES, 1)})  # type: ignore[misc]
Property = Enum("Property", {name: number for number, name in enumerate(PROPERTIES, 1)})  # type: ignore[misc]


class ScriptParseException(Exception):  # noqa: N818 - VirtualHome's own name
    """A script that cannot be read."""


@dataclass(frozen=True)
class GraphNode:
    """A node, with the attributes that VirtualHome's has."""

    id: int
    class_name: str
    category: str
    properties: frozenset[Any]
    states: frozenset[Any]
    prefab_name: str | None = None
    bounding_box: Any = None

    @classmethod
    def of(cls, node: Node) -> GraphNode:
        """Return a node of ours as theirs."""
        can = frozenset(Property[name] for name in node.properties if name in PROPERTIES)
        states = frozenset(State[name] for name in node.states if name in STATES)
        return cls(node.id, node.class_name, node.category, can, states, node.prefab, node.box)

    def __str__(self) -> str:
        return f"<{self.class_name}> ({self.id})"


class _Graph:
    """The questions that graphs and states answer alike."""

    _scene: SceneGraph

    def get_nodes(self) -> list[GraphNode]:
        """Return all nodes."""
        return [GraphNode.of(node) for node in self._scene.nodes]

    def get_node_ids(self) -> list[int]:
        """Return the ids of all nodes."""
        return [node.id for node in self._scene.nodes]

    def get_max_node_id(self) -> int:
        """Return the largest id."""
        return max(self.get_node_ids(), default=0)

    def get_node(self, node_id: int) -> GraphNode:
        """Return the node of an id.

        Raises:
            KeyError: there is none.
        """
        return GraphNode.of(self._scene.node(node_id))

    def get_nodes_by_attr(self, attr: str, value: Any) -> list[GraphNode]:
        """Return the nodes with an attribute's value; of a set, those that have the value in it."""
        found = []
        for node in self.get_nodes():
            has = getattr(node, attr)
            if has == value or (isinstance(has, frozenset) and value in has):
                found.append(node)
        return found

    def get_node_ids_from(self, from_id: int, relation: Any) -> list[int]:
        """Return the ids of the nodes to which a node has a relation."""
        name = relation.name
        return [edge.target for edge in self._scene.edges if edge.source == from_id and edge.relation == name]

    def get_nodes_from(self, from_node: Any, relation: Any) -> list[GraphNode]:
        """Return the nodes to which a node has a relation."""
        return [self.get_node(number) for number in self.get_node_ids_from(from_node.id, relation)]

    def has_edge(self, from_node: Any, relation: Any, to_node: Any) -> bool:
        """Return whether a node has a relation to another."""
        return to_node.id in self.get_node_ids_from(from_node.id, relation)

    def get_char_node(self, char_index: int) -> GraphNode | None:
        """Return the character of a number; None where there is none."""
        found = self.get_nodes_by_attr("class_name", "character")
        return found[char_index] if 0 <= char_index < len(found) else None

    def to_dict(self) -> dict[str, Any]:
        """Return the graph as VirtualHome's files have it."""
        return to_release(self._scene)


class EnvironmentGraph(_Graph):
    """A scene graph.

    Args:
        dictionary: `{"nodes": [...], "edges": [...]}`.
        knowledge: of its classes; ours if None.

    Raises:
        HearthError: BAD_GRAPH.
    """

    def __init__(self, dictionary: Mapping[str, Any] | None = None, knowledge: Knowledge | None = None) -> None:
        self.knowledge = knowledge or default()
        data = filled(dictionary or {"nodes": [], "edges": []}, self.knowledge).data
        self._scene = from_release(data)

    def world(self) -> World:
        """Return the graph as a world of ours."""
        return World.start(Home.from_graph(self._scene, "graph", self.knowledge))


class EnvironmentState(_Graph):
    """A state of an execution.

    Args:
        graph: at the start.
        name_equivalence: read over: our knowledge has the names that mean the same.
        instance_selection: read over, too.
    """

    def __init__(self, graph: EnvironmentGraph, name_equivalence: Any = None, instance_selection: bool = False) -> None:
        self.world = graph.world()
        self._scene = self.world.graph()

    @classmethod
    def at(cls, world: World) -> EnvironmentState:
        """Return the state of a world of ours."""
        made = cls.__new__(cls)
        made.world, made._scene = world, world.graph()
        return made


@dataclass
class ExecutionInfo:
    """The reasons for which a script was not executed."""

    messages: list[str] = field(default_factory=list)

    def error(self, message: str) -> None:
        """Note a reason."""
        self.messages.append(message)

    def get_error_string(self) -> str:
        """Return the reasons as one text."""
        return ", ".join(self.messages)


class Script:
    """A script: a program of ours."""

    def __init__(self, program: Program) -> None:
        self.program = program

    def __len__(self) -> int:
        return len(self.program.steps)

    def __iter__(self) -> Iterator[Any]:
        return iter(self.program.steps)


def read_script_from_list_string(lines: Iterable[str], knowledge: Knowledge | None = None) -> Script:
    """Return the script of some lines: `[WALK] <sofa> (1)`.

    Raises:
        ScriptParseException: a line is no step, or names an action or a thing that there is not.
    """
    known, given = knowledge or default(), [line.strip() for line in lines if line.strip()]
    parsed = parse_programs("Script\n\n\n\n" + "\n".join(given) + "\n")
    faults = list(parsed.diagnostics)
    if not parsed.programs or len(parsed.programs) > 1:
        raise ScriptParseException("; ".join(map(str, faults)) or "several scripts")
    program, wrong = check(parsed.programs[0], known)
    if faults or wrong:
        raise ScriptParseException("; ".join(map(str, (*faults, *wrong))))
    return Script(program)


def read_script_from_string(text: str) -> Script:
    """Return the script of a text, steps parted by commas or line breaks."""
    return read_script_from_list_string(text.replace("],", "]\n").replace("),", ")\n").split("\n"))


def read_script(file_name: str | Path) -> Script:
    """Return the script of a file as the release has it: a title and a description before the steps.

    Raises:
        ScriptParseException: it is none.
    """
    try:
        text = read_input(Path(file_name)).decode("utf-8", "replace")
    except HearthError as error:
        raise ScriptParseException(str(error)) from error
    return read_script_from_list_string(line for line in text.split("\n") if line.strip().startswith("["))
