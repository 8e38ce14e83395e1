"""Programs against the action grammar: known names, the right number of objects, objects that afford the action."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import replace

from hearth.kb import modifiers
from hearth.kb.knowledge import Knowledge
from hearth.kb.knowledge_records import Action
from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.failures import Code
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.schemas.syntax import print_object

Span = tuple[int, int, str]
"""Start and end in a line, and the words at fault; an end of 0 where they are not found."""

_NO_ACTION = "no action is spelt like it; `kb export table` lists them all"
_NO_OBJECT = "no object is spelt like it; use a commoner word, or add it to a folder of your own with --kb"


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
        UNKNOWN_OBJECT, and SYNTAX of modifiers, in the order of the steps.
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
            remedy = _did_you_mean(near) or _NO_ACTION
            span = _found_in(self._text(line), r"\[\s*({})", step.action)
            return step, [self._fault(Code.UNKNOWN_ACTION, f"unknown action `{step.action}`", line, remedy, span)]
        faults = list(self._arity(action, step, line))
        objects: list[ObjectRef] = []
        for ref in step.objects:
            name = self._class_name(ref.name)
            if name is None:
                remedy = _did_you_mean(self.knowledge.suggest(ref.name, "object")) or _NO_OBJECT
                span = self._object(ref, line)
                faults.append(self._fault(Code.UNKNOWN_OBJECT, f"unknown object `{ref.name}`", line, remedy, span))
            objects.append(ref if name in (None, ref.name) else replace(ref, name=name))
        if not faults and len(set(objects)) < len(objects):
            message = f"[{action.name}] takes {len(objects)} different objects, not `{print_object(objects[0])}` twice"
            remedy = f"another of its kind is <{objects[0].name}> ({objects[0].instance + 1})"
            faults.append(self._fault(Code.WRONG_ARITY, message, line, remedy, self._arguments(step, line)))
        if faults:
            return step, faults
        done = step
        if action.name != step.action or tuple(objects) != step.objects:
            done = replace(step, action=action.name, objects=tuple(objects))
        return done, list(self._modifiers(done, line)) if step.modifiers else []

    def _modifiers(self, step: Step, line: int) -> Iterator[Diagnostic]:
        text = self._text(line)
        for words, message, remedy in modifiers.faults(step, self.knowledge):
            start = text.rfind(words) if message.startswith("a second") else text.find(words)
            span = (start, start + len(words), words) if start >= 0 else (0, 0, words)
            yield self._fault(Code.SYNTAX, message, line, remedy, span)

    def affordances(self, step: Step, line: int) -> Iterator[Diagnostic]:
        action = self.knowledge.actions[step.action]
        for position, ref in enumerate(step.objects[: action.arity]):
            if self._class_name(ref.name) and not self.knowledge.affords(step.action, position, ref.name):
                message = f"[{step.action}] can't be done to `{ref.name}`"
                remedy = f"its object must be {action.grammar[position]}"
                yield self._fault(Code.NOT_AFFORDED, message, line, remedy, self._object(ref, line))

    def _arity(self, action: Action, step: Step, line: int) -> Iterator[Diagnostic]:
        if len(step.objects) != action.arity:
            wanted = f"[{action.name}]" + "".join(f" <{role}> (1)" for role in action.roles)
            message = f"[{action.name}] takes {action.arity} object{'s' * (action.arity != 1)}, not {len(step.objects)}"
            yield self._fault(Code.WRONG_ARITY, message, line, f"write {wanted}", self._arguments(step, line))

    def _class_name(self, name: str) -> str | None:
        if name in self.knowledge.objects:
            return name
        found = self.knowledge.object_class(name)
        return found.name if found else None

    def _text(self, line: int) -> str:
        return self.source[line - 1].rstrip("\n") if 0 < line <= len(self.source) else ""

    def _object(self, ref: ObjectRef, line: int) -> Span:
        """Return where an object's name stands, or whatever it was called before it became canonical."""
        text = self._text(line)
        names = (ref.name, *self.knowledge.same_class(ref.name))
        spans = (_found_in(text, r"<[\s_]*({})[\s_]*>", name) for name in names)
        return next((span for span in spans if span[1]), (0, 0, ref.name))

    def _arguments(self, step: Step, line: int) -> Span:
        """Return where the objects of a step stand, or its action where it has none."""
        text = self._text(line)
        start, end, _ = _found_in(text, r"(\[\s*{}\s*\])", step.action)
        after = text[end:].partition("|")[0].partition("{")[0]
        if end and step.objects and "<" in after:
            start, end = end + after.index("<"), end + len(after.rstrip())
        return start, end, text[start:end] if end else " ".join(map(print_object, step.objects)) or step.action

    def _fault(self, code: Code, message: str, line: int, suggestion: str, span: Span) -> Diagnostic:
        start, end, found = span
        column = start + 1 if end else 0
        return Diagnostic(code, message, self.file, line, column, end - start, found, suggestion, self._text(line))


def _found_in(text: str, pattern: str, name: str) -> Span:
    """Return where a name stands in a line as written: any case, spaces or underscores between its words."""
    words = r"[\s_]+".join(map(re.escape, name.replace("_", " ").split()))
    match = re.search(pattern.format(words), text, re.IGNORECASE)
    return (match.start(1), match.end(1), name) if match else (0, 0, name)


def _did_you_mean(names: Sequence[str]) -> str:
    return f"did you mean {' or '.join(f'`{name}`' for name in names[:3])}?" if names else ""
