"""Programs against the action grammar: known names, the right number of objects, objects that afford the action."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from hearth.kb.knowledge import Knowledge
from hearth.kb.records import Action
from hearth.schemas.errors import Diagnostic
from hearth.schemas.failures import Code
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.schemas.syntax import print_object


def check(
    program: Program, knowledge: Knowledge, file: str = "", source: Sequence[str] = ()
) -> tuple[Program, tuple[Diagnostic, ...]]:
    """Make a program's names canonical and report every name and number of arguments that is wrong.

    Args:
        program: as parsed, names as they were written.
        knowledge: the grammar.
        file: named in the diagnostics.
        source: the file's lines, for columns and underlining.

    Returns:
        The program with canonical names (faulty steps unchanged) and the faults: UNKNOWN_ACTION, WRONG_ARITY,
        UNKNOWN_OBJECT, in the order of the steps.
    """
    checker = _Checker(knowledge, file, source)
    steps: list[Step] = []
    faults: list[Diagnostic] = []
    for number, step in enumerate(program.steps):
        canonical, found = checker.step(step, program.line(number))
        steps.append(canonical)
        faults.extend(found)
    return replace(program, steps=tuple(steps)), tuple(faults)


def affordances(
    program: Program, knowledge: Knowledge, file: str = "", source: Sequence[str] = ()
) -> tuple[Diagnostic, ...]:
    """Every step of a canonical program whose object does not afford its action (NOT_AFFORDED)."""
    checker = _Checker(knowledge, file, source)
    return tuple(
        fault
        for number, step in enumerate(program.steps)
        if step.action in knowledge.actions
        for fault in checker.affordances(step, program.line(number))
    )


class _Checker:
    """The checks of one file's steps, and where their faults stand."""

    def __init__(self, knowledge: Knowledge, file: str, source: Sequence[str]) -> None:
        self.knowledge = knowledge
        self.file = file
        self.source = source

    def step(self, step: Step, line: int) -> tuple[Step, list[Diagnostic]]:
        action = self.knowledge.action(step.action)
        if action is None:
            near = self.knowledge.suggest(step.action, "action")
            return step, [self._fault(Code.UNKNOWN_ACTION, "unknown action", step.action, line, _did_you_mean(near))]
        faults = list(self._arity(action, step, line))
        objects: list[ObjectRef] = []
        for ref in step.objects:
            name = self._class_name(ref.name)
            if name is None:
                near = self.knowledge.suggest(ref.name, "object")
                faults.append(self._fault(Code.UNKNOWN_OBJECT, "unknown object", ref.name, line, _did_you_mean(near)))
            objects.append(ref if name in (None, ref.name) else replace(ref, name=name))
        if faults:
            return step, faults
        if action.name == step.action and tuple(objects) == step.objects:
            return step, []
        return replace(step, action=action.name, objects=tuple(objects)), []

    def affordances(self, step: Step, line: int) -> Iterator[Diagnostic]:
        action = self.knowledge.actions[step.action]
        for position, ref in enumerate(step.objects[: action.arity]):
            if not self.knowledge.affords(step.action, position, ref.name):
                requirement = action.grammar[position]
                yield self._fault(
                    Code.NOT_AFFORDED, f"[{step.action}] can't be done to", ref.name, line, f"it takes {requirement}"
                )

    def _arity(self, action: Action, step: Step, line: int) -> Iterator[Diagnostic]:
        if len(step.objects) != action.arity:
            found = " ".join(map(print_object, step.objects))
            wanted = f"[{action.name}]" + "".join(f" <{role}> (1)" for role in action.roles)
            message = f"[{action.name}] takes {action.arity} object{'s' * (action.arity != 1)}, not {len(step.objects)}"
            yield self._fault(Code.WRONG_ARITY, message, found or step.action, line, f"write {wanted}", quote=False)

    def _class_name(self, name: str) -> str | None:
        if name in self.knowledge.objects:
            return name
        found = self.knowledge.object_class(name)
        return found.name if found else None

    def _fault(
        self, code: Code, message: str, found: str, line: int, suggestion: str, quote: bool = True
    ) -> Diagnostic:
        text = self.source[line - 1] if 0 < line <= len(self.source) else ""
        start = _position(text, found)
        whole = f"{message} `{found}`" if quote else message
        return Diagnostic(
            code,
            whole,
            self.file,
            line,
            start + 1,
            len(found) if start >= 0 else 0,
            found,
            suggestion,
            text.rstrip("\n"),
        )


def _position(text: str, found: str) -> int:
    """Where the words stand in the line as written, or -1."""
    return text.lower().replace("_", " ").find(found.lower().replace("_", " "))


def _did_you_mean(names: Sequence[str]) -> str:
    return f"did you mean {' or '.join(f'`{name}`' for name in names[:3])}?" if names else ""
