"""Scripts of Unity clients: lines such as `<char0> [walk] <sofa> (12) | <char1> [grab] <mug> (4)`, a tick each."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from hearth.grounding.binding import Binding, bind
from hearth.interop.virtualhome.unity_class_names import means, to_unity
from hearth.kb.action_grammar import check
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failure_words import sentence
from hearth.schemas.failures import Code, Failure
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.schemas.syntax import parse_steps
from hearth.simulation import engine
from hearth.simulation.rules import Rules
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

MOST_LINES = 1_000
"""Lines of a script."""


def read_script(lines: Sequence[str], home: Home) -> Program:
    """Return a script as a program of ours; the number of an object is a node where the home has it.

    Raises:
        HearthError: every line that is no step, with its number: an unknown verb, a name that is not the node's.
    """
    if len(lines) > MOST_LINES:
        message = f"a script of {len(lines):,} lines"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion=f"at most {MOST_LINES:,}")
    faults: list[Diagnostic] = []
    steps: list[Step] = []
    numbers: list[int] = []
    for number, line in enumerate(lines, 1):
        found = parse_steps(line.strip())
        if isinstance(found, Diagnostic):
            faults.append(replace(found, message=f"line {number}: {found.message}"))
        else:
            steps += [_named(step, home) for step in found]
            numbers += [number] * len(found)
    if not steps and not faults:
        raise HearthError.of(Code.EMPTY, "the script has no lines")
    program = Program(steps=tuple(steps), lines=tuple(numbers))
    checked, wrong = check(program, home.knowledge, source=list(lines))
    faults += [replace(fault, message=f"line {fault.line}: {fault.message}") for fault in wrong]
    if faults:
        raise HearthError(faults)
    return checked


def _named(step: Step, home: Home) -> Step:
    """Return a step whose objects have the class names of the nodes that their numbers name."""
    return replace(step, objects=tuple(_class_of_node(ref, home) for ref in step.objects))


def _class_of_node(ref: ObjectRef, home: Home) -> ObjectRef:
    number = ref.instance if ref.node is None else ref.node
    index = home.index.get(number)
    if index is not None and means(ref.name, home.classes[index], home.knowledge):
        return ObjectRef(home.classes[index], ref.instance, ref.node)
    return ref


def bound_by_node(program: Program, home: Home) -> Program:
    """Return a program whose numbers name nodes, as Unity reads them.

    Raises:
        HearthError: UNBOUND, for each object whose number is no node of its class.
    """
    faults: list[Diagnostic] = []
    for number, step in enumerate(program.steps):
        for ref in step.objects:
            node = ref.instance if ref.node is None else ref.node
            index = home.index.get(node)
            if index is not None and means(ref.name, home.classes[index], home.knowledge):
                continue
            there = f"node {node} is a `{home.classes[index]}`" if index is not None else f"there is no node {node}"
            message = f"line {program.line(number)}: `{ref.name}` ({node}): {there}"
            hint = "take ids from `environment_graph`, or give find_solution"
            faults.append(Diagnostic(Code.UNBOUND, message, suggestion=hint))
    if faults:
        raise HearthError(faults)
    steps = tuple(
        replace(s, objects=tuple(replace(r, node=r.instance if r.node is None else r.node) for r in s.objects))
        for s in program.steps
    )
    return replace(program, steps=steps)


def bound_by_search(program: Program, world: World, rules: Rules) -> Program:
    """Return a program bound to things with which it runs.

    Raises:
        HearthError: why no things do.
    """
    found = bind(program, world, rules)
    if not isinstance(found, Binding):
        raise HearthError.of(found.code, failed(found, program))
    return found.apply(program)


def unity_step(step: Step) -> str:
    """Return a step as Unity writes it: `<char0> [Walk] <sofa> (12)`."""
    numbered = ((to_unity(ref.name), ref.instance if ref.node is None else ref.node) for ref in step.objects)
    objects = "".join(f" <{name}> ({number})" for name, number in numbered)
    return f"<char{step.agent}> [{step.action}]{objects}"


def failed(failure: Failure, program: Program) -> str:
    """Return why a tick failed, with its line and its instruction."""
    ticks = list(program.ticks())
    steps = ticks[failure.tick] if failure.tick < len(ticks) else ()
    mine = next((step for step in steps if step.agent == failure.agent), None)
    line = program.line(sum(len(tick) for tick in ticks[: failure.tick])) if steps else 0
    said = sentence(failure, code=False)
    return f"line {line}, {unity_step(mine)}: {said}" if mine else said


Done = list[tuple[tuple[Step, ...], World]]
"""Ticks that were done, each with the world after it."""


def ticks_done(world: World, program: Program, rules: Rules) -> tuple[Done, Failure | None]:
    """Return each tick of a program that can be done, with the world after it, and why it stopped."""
    execution = engine.run(world, program, rules)
    done = list(zip(program.ticks(), execution.worlds[1:], strict=False))
    return done, execution.failure
