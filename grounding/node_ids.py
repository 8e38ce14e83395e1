"""The nodes that a program names by number: the one rule for `<chair> (1.71)` and `<chair> (71)`.

- The second number of `(1.71)` is a node. One that the home lacks is left out, and the object is bound like others;
  one that is a thing of another class is a fault.
- The only number of `(71)` is a node if every such number of the program is a node of its step's class; simulators
  print programs so. Where not all are, a number is a node if the home has a node of that number and class, and not so
  many things of the class that it could count them. Any other number counts the program's things, `(1)`, `(2)`.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.failures import Code
from hearth.schemas.literals import Key
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.simulation.world.home import Home


class NodeIds(NamedTuple):
    """A program with the nodes that it names.

    Attributes:
        program: its objects bound to the nodes that they name in the home.
        named: these objects, with their nodes.
        lacking: the objects, as they were, whose node the home lacks; the program has them without a node.
        faults: an object whose node is a thing of another class.
    """

    program: Program
    named: tuple[ObjectRef, ...]
    lacking: tuple[ObjectRef, ...]
    faults: tuple[Diagnostic, ...]


def read_ids(program: Program, home: Home, place: str = "") -> NodeIds:
    """Bind a program's objects to the nodes that it names by number.

    Args:
        program: canonical names.
        home: whose nodes are named.
        place: the program's file, for the faults.
    """
    objects = tuple(dict.fromkeys(ref for step in program.steps for ref in step.objects))
    given = [ref for ref in objects if ref.node is not None]
    lacking = tuple(ref for ref in given if ref.node not in home.index)
    wrong = [ref for ref in given if ref.node in home.index and not _is_of_class(home, ref)]
    faults = tuple(_fault(ref, program, home, place) for ref in wrong)
    said = {ref.key: ref.node for ref in reversed(given) if ref.node in home.index}
    free = [ref for ref in objects if ref.node is None and ref.key not in said]
    nodes = said | by_number(free, classes_of(home), home.knowledge)
    numbered = program.numbered() if any(not ref.instance for ref in lacking) else program
    bound = numbered.with_steps(_bound(step, nodes, home) for step in numbered.steps)
    bound = replace(bound, lines=program.lines)
    named = dict.fromkeys(ref for step in bound.steps for ref in step.objects if ref.node is not None)
    return NodeIds(bound, tuple(named), lacking, faults)


def _bound(step: Step, nodes: Mapping[Key, int | None], home: Home) -> Step:
    """Return a step in which what names a node of the home keeps it, and other objects have that of `nodes`, or
    none.
    """
    objects = (ref if ref.node in home.index else replace(ref, node=nodes.get(ref.key)) for ref in step.objects)
    return replace(step, objects=tuple(objects))


def by_number(refs: Sequence[ObjectRef], classes: Mapping[int, str], knowledge: Knowledge) -> dict[Key, int]:
    """Return the nodes that objects without a node name by their instance numbers, by the rule of this module.

    Args:
        refs: all such objects of a program.
        classes: the class of each node.
        knowledge: for the other names of classes.
    """
    named = [ref for ref in refs if classes.get(ref.instance) in knowledge.found_as(ref.name)]
    if len(named) < len(refs):
        named = [ref for ref in named if ref.instance > _count(ref.name, classes, knowledge)]
    return {ref.key: ref.instance for ref in named}


def classes_of(home: Home) -> dict[int, str]:
    """Return the class of each node of a home."""
    return {node: home.classes[index] for node, index in home.index.items()}


def _count(name: str, classes: Mapping[int, str], knowledge: Knowledge) -> int:
    names = knowledge.found_as(name)
    return sum(each in names for each in classes.values())


def _is_of_class(home: Home, ref: ObjectRef) -> bool:
    index = home.index[ref.node or 0]
    return home.classes[index] in home.knowledge.found_as(ref.name) or bool(home.instances(ref.name) >> index & 1)


def _fault(ref: ObjectRef, program: Program, home: Home, place: str) -> Diagnostic:
    found = home.classes[home.index[ref.node or 0]]
    message = f"`{ref.name}` is said to be node {ref.node}, but that is a `{found}` in {home.name or 'this home'}"
    hint = (
        f"write <{ref.name}> ({ref.instance or 1}) for any, or give the home that the ids are of by --graph or --home"
    )
    line = next((program.line(n) for n, step in enumerate(program.steps) if ref in step.objects), 0)
    return Diagnostic(Code.UNBOUND, message, place, line, found=f"{ref.instance}.{ref.node}", suggestion=hint)
