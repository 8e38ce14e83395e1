"""Natural-language steps to a program: `Step 3: Put the milk in the fridge` to `[PutIn] <milk> (1) <fridge> (1)`."""

import re
from functools import lru_cache
from typing import NamedTuple

from hearth.kb import action_grammar
from hearth.kb.knowledge import Knowledge
from hearth.kb.language.line_diagnostics import LineFaults, of_language, phrase  # noqa: F401 - phrase was here in 0.2
from hearth.kb.language.mentioned_things import SaidBefore
from hearth.kb.language.named_sources import left_out
from hearth.kb.language.nothing_to_do_sentences import stays
from hearth.kb.language.number_order import IN_ORDER, NumberOrder
from hearth.kb.language.plan_lines import (
    BRACKETED,
    LOOSE,
    META,
    PlanLine,
    header_of,
    is_said_around,
    plan_line,
    unexplained,
)
from hearth.kb.language.program_lines import Kind, lines_of_program
from hearth.kb.language.pronouns import Mentioned
from hearth.kb.language.reading_modes import Fuzzy
from hearth.kb.language.recognition_knowledge import is_recognizing, recognizing
from hearth.kb.language.self_corrections import corrects_itself
from hearth.kb.language.sentences import asked_in_part, asked_steps, depends, nearest_steps, plain_step
from hearth.kb.language.single_clauses import Asked, unclear
from hearth.kb.language.step_like_lines import is_like_step, is_order, sentences
from hearth.kb.language.step_phrases import say
from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.failures import Code
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.schemas.short_repr import brief
from hearth.schemas.syntax import parse_steps as parse_ticks


class ParsedSteps(NamedTuple):
    """The program of the steps understood, faults for those not understood, warnings for fuzzy matches."""

    program: Program
    faults: tuple[Diagnostic, ...]
    warnings: tuple[Diagnostic, ...]

    def __repr__(self) -> str:
        return brief(self)


def parse_steps(text: str, before: int, place: str, known: Knowledge, fuzzy: Fuzzy = Fuzzy.TYPOS) -> ParsedSteps:
    """Parse natural-language steps. They name no instances, so that every object is instance 1.

    A line may ask for several things ("open the fridge and take the milk out"); a clause that is not understood is a
    fault at its column, and the others are steps. `it` is what the last step was about. Steps may also be written as in
    programs. An item below a step, or a line without a number, is a step if it reads exactly as one; else it explains,
    and is counted in a warning. Below a step that is not understood, as `1. In the kitchen:`, items are its steps.

    Args:
        text: title, description and steps, with or without Markdown.
        before: lines of the file before it.
        place: the file, for diagnostics.
        known: the grammar.
        fuzzy: how far a line may be from one that is known.
    """
    if is_recognizing(known):
        return _parsed(text, before, place, known, fuzzy)
    with recognizing(known):
        return _parsed(text, before, place, known, fuzzy)


def _parsed(text: str, before: int, place: str, known: Knowledge, fuzzy: Fuzzy) -> ParsedSteps:
    parser = _StepParser(known, place, fuzzy)
    raw = text.split("\n")
    lines = lines_of_program(text)
    for row, line, kind in lines:
        parser.take(line, kind, raw[row], before + row + 1)
    if parser.is_description(sum(line.prose for _, line, _ in lines)):
        parser = _StepParser(known, place, fuzzy)
        top = header_of(list(map(plan_line, raw)))
    else:
        top = header_of([line for _, line, _ in lines])
    if parser.refused:
        # The other lines are a part of the plan at most.
        faults = sorted(dict.fromkeys((*parser.faults, *parser.refused)), key=lambda fault: (fault.line, fault.column))
        return ParsedSteps(Program(top.title, top.description), tuple(faults), ())
    if not parser.steps and not parser.faults:
        fault = Diagnostic(Code.EMPTY, f"`{top.title[:60]}` has no steps", place, before + 1)
        parser.faults.append(fault)
    parser.faults = of_language(list(dict.fromkeys(parser.faults)), len(parser.steps))
    program = Program(top.title, top.description, tuple(parser.steps), tuple(parser.lines))
    return ParsedSteps(program, tuple(parser.faults), (*parser.warnings, *parser.explained()))


_ORDINAL = re.compile(
    r"(?:first|second|third|fourth|fifth|sixth|seventh|eighth|ninth|tenth|last)(?:ly)?\s*,\s+", re.IGNORECASE
)


_TOLD = re.compile(
    r"(?:(?:then|next|now|first|finally|and|so)\s*,?\s+)*(?:i|you|he|she|it|we|they|the|this|that)\b", re.IGNORECASE
)


def _asks(sentence: str) -> bool:
    """Return whether a sentence asks for something, and is not about somebody."""
    return is_like_step(sentence) and not _TOLD.match(sentence)


class _StepParser:
    def __init__(self, known: Knowledge, place: str, fuzzy: Fuzzy) -> None:
        self.known, self.place, self.fuzzy = known, place, fuzzy
        self._writer = LineFaults(known, place)
        self.steps: list[Step] = []
        self.lines: list[int] = []
        self.faults: list[Diagnostic] = []
        self.warnings: list[Diagnostic] = []
        self.refused: list[Diagnostic] = []
        self._before = SaidBefore(known, self.lines)
        self._idle: list[tuple[str, str, int]] = []
        self._notes: list[tuple[str, str, int]] = []
        self._is_open = self._is_heading = False
        self._indent = 0
        self._order = NumberOrder()

    def take(self, line: PlanLine, kind: Kind, raw: str, number: int) -> None:
        """Take a line; items below a step that is not understood are its steps, and the step is their heading."""
        sure = _sure_step(self.known, line.text) if kind is Kind.STEP else None
        if line.numbered and (reason := self._order.fault_of(line)):
            self.warnings.append(self._writer.at(Code.AMBIGUOUS, reason, raw, line.text, number, IN_ORDER))
        if line.why:
            (self.warnings if line.why.is_warning else self.refused).append(self._writer.refused(line.why, raw, number))
        if line.why and not line.why.is_warning:
            self._is_open = self._is_heading = False
        elif kind is Kind.HEAD:
            self._is_open, self._is_heading, self._indent = True, True, line.indent
            self._note(line, raw, number)
        elif kind is Kind.STEP and self._is_open and line.indent > self._indent:
            self._take_item(line, raw, number)
        elif sure and not ((sure[2] or self._before.counted) and self._before.changes(sure[1].names, sure[2])):
            self._is_open = self._is_heading = False
            self.steps.append(sure[0])
            self.lines.append(number)
            self._before.mentions.append(sure[1])
            self._say_source(line.text, raw, number, len(self.steps) - 1)
        elif kind is Kind.STEP:
            before = len(self.steps)
            found = self._read(line, raw, number)
            is_unread = bool(found) and len(self.steps) == before
            self._is_open, self._is_heading = is_unread and not line.bracketed, False
            self._indent = line.indent
            self.faults += found
        elif kind == Kind.MISSING:
            self._is_open = False
            self.faults += [] if self._detail(line.text, raw, number) else self._nearest(line.text, raw, number)
        elif line.number is not None and self._is_open:
            self._take_item(line, raw, number)
        elif kind == Kind.DETAIL and not self._detail(line.text, raw, number) and not self._lacks(line, raw, number):
            self._is_open = self._is_open and line.indent > 0
            self._note(line, raw, number)
        elif kind == Kind.TEXT and line.text:
            self._is_open = self._is_open and line.indent > 0
            if (self.steps or self.faults) and not META.match(line.text):
                self._note(line, raw, number)

    def is_description(self, prose: int) -> bool:
        """Return whether the sentences of a text are its description: fewer of them are steps than are not.

        Where most ask for something, as orders do, each that is not understood is a fault of its own.
        """
        orders = sum(_asks(fault.found) for fault in self.faults)
        return prose > 0 and len(self.faults) > len(self.steps) and 2 * (orders + len(self.steps)) <= prose

    def _lacks(self, line: PlanLine, raw: str, number: int) -> bool:
        """Add the fault of an item below a step that asks for something, as a step does; return whether it does."""
        if line.number is None or not is_order(line.text):
            return False
        self.faults += self._read(line, raw, number)
        return True

    def _take_item(self, line: PlanLine, raw: str, number: int) -> None:
        said = len(self._before.mentions)
        found = self._read(line, raw, number)
        if not found and not self._is_heading:
            self._is_heading = True
            fault = self.faults.pop()
            if not fault.source.lstrip().startswith("#"):
                self._note(PlanLine(fault.found), fault.source, fault.line)
        if self._is_heading or is_order(line.text):
            self.faults += found
        elif found:
            self._before.cut(said)
            self._note(line, raw, number)

    def _note(self, line: PlanLine, raw: str, number: int) -> None:
        """Count a line that explains, unless it is a heading, or what a chat says around a plan."""
        if not is_said_around(line.text) and not line.text.endswith(":"):
            self._notes.append((line.text, raw, number))

    def explained(self) -> list[Diagnostic]:
        """Return warnings that count the lines that ask for nothing, and those that explain steps and are none."""
        return [*self._stayed(), *self._noted()]

    def _stayed(self) -> list[Diagnostic]:
        message = "nothing to do: the thing stays as the last step has left it"
        return [self._writer.at(Code.NO_STEP, message, raw, words, number) for words, raw, number in self._idle]

    def _noted(self) -> list[Diagnostic]:
        if not self._notes:
            return []
        words, raw, number = self._notes[0]
        count = len(self._notes)
        message = (
            f"{count} lines explain steps and are none" if count > 1 else "a line that explains a step and is none"
        )
        return [self._writer.at(Code.NO_STEP, message, raw, words, number, "number it if it is a step")]

    def _detail(self, words: str, raw: str, number: int) -> bool:
        """Add the steps of a line that may explain; return whether it reads exactly as steps."""
        if corrects_itself(words):
            return False
        said = self._before.last_first(words)
        if stays(self.known, words, said):
            self._idle.append((words, raw, number))
            return True
        asked = asked_steps(self.known, words, said, Fuzzy.OFF)
        for each in asked:
            self._add(each, words, number)
        return bool(asked)

    def _read(self, line: PlanLine, raw: str, number: int) -> list[Diagnostic]:
        """Add the steps of a line; the faults of one that is not understood."""
        if line.bracketed:
            return self._written(line.text, raw, number)
        words = _ORDINAL.sub("", line.text, count=1)
        if corrects_itself(words):
            self._take_back(number)
            self._before.add_unread(words, number)
            reason, remedy = "the line takes back its own words", "write the step that is meant, alone"
            return [self._writer.at(Code.AMBIGUOUS, reason, raw, words, number, remedy)]
        said = self._before.last_first(words)
        if stays(self.known, words, said):
            self._idle.append((words, raw, number))
            return []
        asked = asked_steps(self.known, words.removesuffix(":"), said, Fuzzy.OFF)
        if not asked and self.fuzzy is not Fuzzy.OFF:
            shorter = _unexplained(words)
            asked = self._asked(shorter, said) if shorter not in ("", words) else ()
            if not asked and not words.endswith(":"):
                asked = asked_steps(self.known, words, said, self.fuzzy)
            if not asked and shorter not in ("", words):
                asked = self._asked(shorter, said, self.fuzzy)
        first = len(self.steps)
        for each in asked:
            self._take_asked(each, raw, words, number)
        if not any(each.left_out for each in asked):
            self._say_source(words, raw, number, first)
        return [] if asked else self._read_in_part(words, raw, number, said)

    def _say_source(self, words: str, raw: str, number: int, first: int) -> None:
        """Warn of a place from which a step of the line takes a thing, and at which the plan is not."""
        takes = self.known.group("takes")
        at = max((n for n in range(first, len(self.steps)) if self.steps[n].action in takes), default=None)
        names = tuple(ref.name for ref in self.steps[at].objects) if at is not None else ()
        if at is not None and names and (out := left_out(self.known, words, names[0], self.steps[:at])):
            step = say(self.known.actions[self.steps[at].action], names)
            message = f"taken for `{step}`; no step goes there: {out} (`run --sample` takes it for the start)"
            self.warnings.append(self._writer.at(Code.FUZZY_MATCH, message, raw, words, number))

    def _take_back(self, number: int) -> None:
        """Leave out the steps that sentences before this one on the same line asked for."""
        while self.lines and self.lines[-1] == number:
            self._before.take_back()
            self.lines.pop()
            self.steps.pop()

    def _read_in_part(self, words: str, raw: str, number: int, said: tuple[Mentioned, ...]) -> list[Diagnostic]:
        """Add the steps of the clauses of a line that are understood; a fault for each other, or for all of it."""
        in_part = not words.endswith(":") and self.fuzzy is not Fuzzy.LOOSE
        parts = asked_in_part(self.known, words, said, self.fuzzy) if in_part else ()
        faults: list[Diagnostic] = []
        for part in parts or (words,):
            if isinstance(part, str):
                faults += self._nearest(part, raw, number)
            else:
                self._take_asked(part, raw, words, number)
        return faults

    def _take_asked(self, asked: Asked, raw: str, words: str, number: int) -> None:
        self._add(asked, words, number)
        if asked.fuzzy:
            self.warnings.append(self._writer.fuzzy(asked, raw, words, number))

    def _asked(self, shorter: str, said: tuple[Mentioned, ...], fuzzy: Fuzzy = Fuzzy.OFF) -> tuple[Asked, ...]:
        """Return the steps of a line before its explanation, which is left out."""
        first, *others = asked_steps(self.known, shorter, said, fuzzy) or (None,)
        left_out = f"{first.left_out}, the explanation".lstrip(", ") if first else ""
        return (first._replace(left_out=left_out), *others) if first else ()

    def _nearest(self, words: str, raw: str, number: int) -> list[Diagnostic]:
        """Add the step that a line most resembles where that is enough; else the fault, with the nearest steps."""
        said = self._before.last_first(words)
        whole = nearest_steps(self.known, words, said, self.fuzzy)
        reason = unclear(self.known, words, said)
        if not whole.meant or reason or words.endswith(":"):
            self._before.add_unread(words, number)
            return [self._writer.not_understood(whole, raw, words, number, said, reason)]
        self._add(Asked(whole.meant), words, number)
        self.warnings.append(self._writer.fuzzy(Asked(whole.meant), raw, words, number))
        return []

    def _written(self, text: str, raw: str, number: int) -> list[Diagnostic]:
        """Add the steps of a line in the syntax of programs."""
        loose = LOOSE.fullmatch(text)
        found = parse_ticks(f"[{loose[1]}] <{loose[2].rstrip('.')}>" if loose else text)
        faults: tuple[Diagnostic, ...] = (found,) if isinstance(found, Diagnostic) else ()
        if not isinstance(found, Diagnostic):
            written = Program(steps=found, lines=(1,) * len(found))
            program, faults = action_grammar.check(written, self.known, self.place, [text])
            if not faults:
                self.steps += program.steps
                self.lines += [number] * len(found)
                for step in program.steps:
                    self._before.add(_mentioned(step))
            else:
                self._before.add_unread(text, number)
        if text not in raw:  # in another form, whose faults all stand at its first word
            faults = faults[:1]
        return [self._writer.of_syntax(fault, text, raw, number) for fault in faults]

    def _add(self, asked: Asked, words: str, number: int) -> None:
        action, names = asked.meant.action.name, asked.meant.names
        mentioned = Mentioned(action, names, asked.instance, number, asked.second, words)
        self._append(_step(action, names, asked.instance, asked.second), mentioned, number)
        if asked.along:
            self._before.carry(asked.along)
        elif asked.left_out.startswith(("with it", "with them")):
            # What one walks with was spoken of last: `rinse it` after `walk to the sink with it` is not about the sink.
            self._before.swap_last()

    def _append(self, step: Step, mentioned: Mentioned, number: int) -> None:
        self.steps.append(step)
        self.lines.append(number)
        self._before.add(mentioned)


def _unexplained(words: str) -> str:
    """Return a step's words without the explanation behind them; with a sentence behind them that asks for a step."""
    shorter = unexplained(words)
    behind = words[len(shorter) :]
    asks = behind.startswith(". ") and any(is_order(each.rstrip(".!")) for each in sentences(behind[2:]))
    return words if asks else shorter


@lru_cache(maxsize=65_536)
def _sure_step(known: Knowledge, text: str) -> tuple[Step, Mentioned, frozenset[str]] | None:
    """Return the step of a line that reads exactly as one, as most lines do, and the classes on which that depends."""
    words = _ORDINAL.sub("", text, count=1).removesuffix(":")
    asked = () if BRACKETED.match(text) else plain_step(known, words)
    if len(asked) != 1 or asked[0].fuzzy:
        return None
    meant = asked[0].meant
    mentioned = Mentioned(meant.action.name, meant.names, 1, 0, 1, words)
    return _step(meant.action.name, meant.names, 1, 1), mentioned, depends(known, words)


def _mentioned(step: Step) -> Mentioned:
    names = tuple(ref.name for ref in step.objects)
    instance, second = (*(ref.instance for ref in step.objects), 1, 1)[:2]
    return Mentioned(step.action, names, instance, 0, second)


@lru_cache(maxsize=65_536)
def _step(action: str, names: tuple[str, ...], instance: int, second: int) -> Step:
    """Return a step whose things are counted."""
    return Step(action, tuple(map(ObjectRef, names, (instance, second))))
