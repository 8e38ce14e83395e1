"""Binding of a predicted program's objects to nodes of its environment."""

from collections.abc import Set

from hearth.grounding.node_ids import by_number
from hearth.kb.knowledge import Knowledge
from hearth.schemas.literals import Key
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.scoring.metrics.final_graph import Nodes


def bind(program: Program, nodes: Nodes, knowledge: Knowledge, reference: Program | None = None) -> Program:
    """Give each object of a program a node, in this order of preference:

    1. the node it names, `(1.41)`;
    2. the node that the reference binds the same name and instance to;
    3. the node whose id is its number, `(41)`, by the rule of `grounding.node_ids`;
    4. the first instance of its class, by id, to which no other object is bound;
    5. none: running it then fails as UNBOUND.

    Args:
        program: canonical names.
        nodes: of the environment.
        knowledge: for synonyms of classes.
        reference: bound, in the same environment.
    """
    every = program.objects()
    objects = [ref for ref in every if ref.node is None]
    if not objects:
        return program
    known = _bindings(reference) if reference else {}
    bound: dict[Key, int | None] = {}
    taken: set[int | None] = {ref.node for ref in every if ref.node is not None}
    numbers = by_number(objects, nodes.classes, knowledge)
    for ref in objects:
        node = known.get(ref.key, numbers.get(ref.key))
        if node is not None:
            bound[ref.key] = node
            taken.add(node)
    for ref in objects:
        if ref.key not in bound:
            bound[ref.key] = _first_free(ref, nodes, knowledge, taken)
            taken.add(bound[ref.key])
    return program.with_steps([_bound(step, bound) for step in program.steps])


def _bindings(program: Program) -> dict[Key, int]:
    return {ref.key: ref.node for ref in program.objects() if ref.node is not None}


def _bound(step: Step, nodes: dict[Key, int | None]) -> Step:
    objects = [ref if ref.node is not None else ObjectRef(*ref.key, nodes[ref.key]) for ref in step.objects]
    return Step(step.action, tuple(objects), step.agent, step.joins, step.modifiers)


def _first_free(ref: ObjectRef, nodes: Nodes, knowledge: Knowledge, taken: Set[int | None]) -> int | None:
    names = knowledge.found_as(ref.name)
    return next((node for name in names for node in nodes.instances.get(name, ()) if node not in taken), None)
