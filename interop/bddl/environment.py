"""A BDDL problem as an environment: rooms, things, relations and states, completed as other people's graphs are."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

from hearth.homes.node_defaults import filled
from hearth.interop.bddl.problem import Fact, Problem
from hearth.interop.bddl.words import words
from hearth.interop.scene_graphs.fillings import Filling
from hearth.interop.scene_graphs.reading import complete
from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code
from hearth.schemas.graph import EnvironmentGraph, from_release
from hearth.schemas.vocabulary import CHARACTER_CLASS

FLOOR = "floor"
"""Class of the instances that stand for the floors of rooms."""


@dataclass(frozen=True)
class Activity:
    """An environment of a problem.

    Attributes:
        problem: as read.
        graph: its home.
        nodes: instance -> node id; of a floor that of its room, as things on it are in the room.
        floors: instance of a floor -> node id of the floor itself.
        fillings: counts of stand-ins and of facts that were left out.
        left_out: instances and facts that are not in the home.
    """

    problem: Problem
    graph: EnvironmentGraph
    nodes: Mapping[str, int]
    floors: Mapping[str, int]
    fillings: tuple[Filling, ...]
    left_out: tuple[Diagnostic, ...]


def environment_of(problem: Problem, knowledge: Knowledge) -> Activity:
    """Return the environment that a problem describes.

    Raises:
        HearthError: NO_ROOM: none of its rooms is one of ours.
    """
    return _Building(problem, knowledge).built()


def _names_room(fact: Fact) -> bool:
    """Return whether a fact says in which room a thing is."""
    return fact.predicate == "inroom" and len(fact.terms) == 2


@dataclass
class _Building:
    """The building of one environment, step by step."""

    problem: Problem
    knowledge: Knowledge
    classes: dict[str, str] = field(default_factory=dict)
    rooms: dict[str, int] = field(default_factory=dict)
    ids: dict[str, int] = field(default_factory=dict)
    floors: dict[str, int] = field(default_factory=dict)
    states: dict[int, list[str]] = field(default_factory=dict)
    edges: set[tuple[int, str, int]] = field(default_factory=set)
    left_out: list[Diagnostic] = field(default_factory=list)
    notes: dict[str, list[str]] = field(default_factory=dict)

    def built(self) -> Activity:
        table = words()
        substances = self._substances()
        for name, synset in self.problem.instances.items():
            if synset in substances:
                continue
            found = table.class_of(synset, self.knowledge)
            if found:
                self.classes[name] = found
                if table.is_of_table(synset) and found != CHARACTER_CLASS:
                    self._note("classes that stand for others, by the table", f"{synset} = {found}")
            else:
                near = self.knowledge.suggest(synset.partition(".")[0])
                hint = f"did you mean `{near[0]}`? " if near else ""
                self._leave(Code.UNKNOWN_OBJECT, f"no class stands for `{synset}`", 0, f"{hint}add it to `words.yaml`")
        self._make_rooms()
        self._make_nodes()
        for fact in self.problem.facts:
            self._note_fact(fact)
        graph, fillings = self._graph()
        own = [Filling(what, len(each), tuple(dict.fromkeys(each))[:4]) for what, each in self.notes.items()]
        return Activity(self.problem, graph, self.ids, self.floors, (*own, *fillings), tuple(self.left_out))

    def _substances(self) -> set[str]:
        """Return the synsets that are only what something is covered by, filled with, or a source of."""
        about = {*words().substances, "insource", "contains"}
        as_second: set[str] = set()
        as_thing: set[str] = set()
        for fact in self.problem.facts:
            kinds = [self.problem.instances.get(term, "") for term in fact.terms]
            second = fact.predicate in about and len(kinds) == 2
            as_second |= set(kinds[:1] if second and fact.predicate == "insource" else kinds[1:] if second else ())
            as_second |= set(kinds[1:] if second and fact.predicate == "insource" else ()) - as_thing
            as_thing |= set(kinds if not second else kinds[:1])
        as_second |= {kind for kind in self.problem.instances.values() if words().kind_of(kind) != "other"} - as_thing
        return {kind for kind in as_second if words().kind_of(kind) != "other" or kind not in as_thing}

    def _make_rooms(self) -> None:
        for fact in self.problem.facts:
            if _names_room(fact):
                given = fact.terms[1]
                room = words().room_of(given, self.knowledge)
                if not room:
                    self._leave(Code.UNKNOWN_OBJECT, f"no room of ours stands for `{given}`", fact.line,
                                "add it to `words.yaml`")  # fmt: skip
                elif room not in self.rooms:
                    self.rooms[room] = len(self.rooms) + 1
                if room and room != given:
                    self._note("rooms that stand for others, by the table", f"{given} = {room}")
        if not self.rooms:
            rooms = sorted({str(fact.terms[1]) for fact in self.problem.facts if _names_room(fact)})
            message = f"no room of ours stands for {', '.join(rooms)}" if rooms else "it names no room"
            raise HearthError.of(Code.NO_ROOM, message, file=self.problem.file,
                                 suggestion="`(inroom floor.n.01_1 kitchen)` is in one")  # fmt: skip

    def _make_nodes(self) -> None:
        stateful = {fact.terms[0] for fact in self.problem.facts if fact.predicate in words().substances and fact.terms}
        stateful |= set(str(self.problem.goal).replace("?", " ").replace(")", " ").split())
        number = len(self.rooms)
        for name, class_name in self.classes.items():
            if class_name == FLOOR:
                self.ids[name] = self.rooms.get(self._room_named(name), 1)
                if name in stateful or self.problem.instances[name] in stateful:
                    number += 1
                    self.floors[name] = number
                    self.edges.add((number, "INSIDE", self.ids[name]))
            elif not self.knowledge.is_room(class_name):
                number += 1
                self.ids[name] = number

    def _room_named(self, name: str) -> str:
        facts = (fact for fact in self.problem.facts if fact.predicate == "inroom" and fact.terms[:1] == (name,))
        return next((words().room_of(fact.terms[1], self.knowledge) for fact in facts), "")

    def _note_fact(self, fact: Fact) -> None:
        table, first = words(), fact.terms[0] if fact.terms else ""
        if fact.predicate in table.silent or (fact.negated and fact.predicate in table.relations):
            self._note("facts that homes of ours do not have, left out", fact.predicate)
            return
        if first not in self.ids:
            if first in self.classes or self.problem.instances.get(first):
                self._note("facts about things of no class, left out", f"{fact.predicate} {first}")
            return
        me = self.floors.get(first, self.ids[first])
        if fact.predicate == "inroom":
            room = self.rooms.get(table.room_of(fact.terms[1], self.knowledge))
            if room is not None and room != self.ids[first]:
                self.edges.add((me, "INSIDE", room))
        elif fact.predicate in table.relations and len(fact.terms) == 2 and fact.terms[1] in self.ids:
            target = self.ids[fact.terms[1]]
            relation = "INSIDE" if target in self.rooms.values() else table.relations[fact.predicate]
            if self.ids[first] not in self.rooms.values() and target != self.ids[first]:
                self.edges |= {(me, relation, target), *([(target, relation, me)] if relation == "CLOSE" else [])}
        elif fact.predicate in table.states and table.states[fact.predicate][fact.negated]:
            self.states.setdefault(me, []).append(table.states[fact.predicate][fact.negated])
        elif fact.predicate in table.substances and len(fact.terms) == 2:
            kind = table.kind_of(self.problem.instances[fact.terms[1]])
            found = table.substances[fact.predicate].get(kind)
            if found is None:
                self._note("facts that homes of ours do not have, left out", f"{fact.predicate} {fact.terms[1]}")
            else:
                self.states.setdefault(me, []).append(found[fact.negated])
        else:
            self._leave(Code.NOT_UNDERSTOOD, f"`{fact.predicate}` of {len(fact.terms)} things is no fact of ours",
                        fact.line, "a predicate of `words.yaml`")  # fmt: skip

    def _graph(self) -> tuple[EnvironmentGraph, Sequence[Filling]]:
        nodes = [{"id": number, "class_name": name} for name, number in self.rooms.items()]
        nodes += [{"id": number, "class_name": self.classes[name]} for name, number in self.ids.items()
                  if self.classes[name] != FLOOR]  # fmt: skip
        nodes += [{"id": number, "class_name": FLOOR} for number in self.floors.values()]
        rows = [
            {"from_id": one, "relation_type": relation, "to_id": other} for one, relation, other in sorted(self.edges)
        ]
        graph = from_release(filled({"nodes": nodes, "edges": rows}, self.knowledge).data, self.problem.file)
        made = complete(graph, self.knowledge, self.problem.file)
        groups = {number: {self.knowledge.group_of(state) for state in given} for number, given in self.states.items()}
        changed = tuple(
            replace(node, states=(*self.states[node.id], *(
                state for state in node.states if self.knowledge.group_of(state) not in groups[node.id])))
            if node.id in self.states else node
            for node in made.graph.nodes
        )  # fmt: skip
        return replace(made.graph, nodes=changed), made.fillings

    def _note(self, what: str, example: str) -> None:
        self.notes.setdefault(what, []).append(example)

    def _leave(self, code: Code, message: str, line: int, suggestion: str) -> None:
        fault = Diagnostic(code, message, self.problem.file, line, suggestion=suggestion)
        if fault not in self.left_out:
            self.left_out.append(fault)
