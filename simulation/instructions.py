"""Instructions as text, for agents that write: `[Walk] <kitchen> (1)`, `<char1> [Grab] <cup> (1.41)`."""

from dataclasses import replace

from hearth.kb.action_grammar import check
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.schemas.syntax import parse_steps
from hearth.simulation.world.bits import indices
from hearth.simulation.world.home import Home


def instruction_of(text: str, home: Home) -> Step:
    """Return the one instruction of a line, bound to nodes: `(1.41)` names node 41, `(2)` the second of its class by
    id.

    Raises:
        HearthError: every fault of syntax and grammar; UNBOUND where the home has fewer of the class.
    """
    if not isinstance(text, str):
        raise HearthError.of(Code.SYNTAX, f"{type(text).__name__} is neither an instruction nor text")
    found = parse_steps(text)
    if isinstance(found, Diagnostic):
        raise HearthError(found)
    if len(found) != 1:
        raise HearthError.of(Code.SYNTAX, f"{len(found)} instructions where one is expected")
    program, faults = check(Program(steps=found, lines=(1,)), home.knowledge, source=[text])
    if faults:
        raise HearthError(faults)
    (step,) = program.steps
    return replace(step, objects=tuple(_bound(ref, home) for ref in step.objects))


def _bound(ref: ObjectRef, home: Home) -> ObjectRef:
    if ref.node is not None:
        return ref
    ids = [home.ids[i] for i in indices(home.instances(ref.name))]
    if not 0 < ref.instance <= len(ids):
        message = f"the home has {len(ids)} of `{ref.name}`, and number {ref.instance} is asked for"
        raise HearthError.of(Code.UNBOUND, message, suggestion="number them from 1, or name a node: (1.41)")
    return replace(ref, node=ids[ref.instance - 1])
