"""The forms in which language models answer: a command, `Action:`, a JSON tool call, ALFWorld's strings, a sentence.

Each form gives a command line, which `agent_answers.by_text` reads; nothing else reads commands.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any

from hearth.envs.agent_answers import WAIT, by_text
from hearth.envs.taken_from import need_there, taken_from
from hearth.envs.text_protocol_settings import Protocol
from hearth.kb.language.forms.alfworld_commands import command
from hearth.kb.language.forms.react_logs import act_of
from hearth.kb.language.step_understanding import understand_exactly
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code
from hearth.schemas.program import Step
from hearth.schemas.syntax import normal_name
from hearth.simulation.actions.legal import Legal
from hearth.simulation.observation.views import View

WALK = "Walktowards"
"""The walk by metres; where it is not legal, `Walk`."""

IDLE = frozenset({"look", "look around", "inventory", "check inventory", "do nothing", "noop", "stop"})
"""Answers of other games that do nothing here."""

_TWO = re.compile(r"\bthen\b|;|[a-z0-9]\. +[A-Za-z]|, and \b|\band [a-z]+ (?:the|an?)\b", re.IGNORECASE)
"""Signs of a second command; only looked for where a line is not understood."""

_MARK = re.compile(r"(?:step +)?\d{1,3}[.):] +(?=[A-Za-z\[<])|[-*\u2022] +(?=[A-Za-z\[<])", re.IGNORECASE)
"""A number or a mark before a command, as lists have it."""

_INLINE = re.compile(r"[.;!?] +action: *(?=\S)", re.IGNORECASE)
"""The beginning of an act on the line of its thought."""

_STEP = re.compile(r"((?:<char\d+> *)?)\[(\w+)\](.*)", re.DOTALL)
"""A step of a program: an agent, an action and objects."""

_FENCE = re.compile(r"```[a-z]*\s*\n?(.*?)\n?```", re.DOTALL)
_PROGRAM = re.compile(r"<([^>]*)> \((\d+)\)")
_PLAIN = re.compile(r"[A-Za-z][A-Za-z0-9_, ]*(?<! )")
_NUMBERED = re.compile(r"\b([a-z][a-z_]*(?: [a-z_]+)?) (\d{1,9})\b", re.IGNORECASE)
_FIELDS = ("command", "action", "answer", "input")


def read_answer(answer: object, view: View, legal: Legal, protocol: Protocol) -> Step | None:
    """Return the legal instruction that an answer means; None for `wait`.

    Raises:
        HearthError: NOT_TEXT, EMPTY, LINE_TOO_LONG; SYNTAX: more than one command; NOT_SEEN: a thing is not where the
            answer says; and the faults of `agent_answers.by_text`.
    """
    if not isinstance(answer, str):
        message = f"an answer is {type(answer).__name__}, not text"
        raise HearthError.of(Code.NOT_TEXT, message, suggestion="one command, such as `Walk fridge 142`")
    if len(answer) > protocol.most_answer:
        message = f"an answer of {len(answer):,} characters"
        raise HearthError.of(Code.LINE_TOO_LONG, message, suggestion=f"at most {protocol.most_answer:,}: one command")
    line = command_line(answer)
    if not line:
        raise HearthError.of(Code.EMPTY, "an empty answer", suggestion=f"a command, or `{WAIT}`")
    if line.lower().rstrip(".") in IDLE:
        return None
    try:
        if taken := taken_from(line, view):
            return need_there(_read(taken.command, view, legal, protocol), taken, view)
        return _read(line, view, legal, protocol)
    except HearthError as error:
        if _TWO.search(line):
            message = "more than one command"
            raise HearthError.of(Code.SYNTAX, message, suggestion="give the first alone, then the next") from None
        raise HearthError([_remedied(fault) for fault in error.diagnostics]) from None


def _read(line: str, view: View, legal: Legal, protocol: Protocol) -> Step | None:
    """Return the instruction of a line: a command, else another game's string or a sentence."""
    try:
        return by_text(_walks(line, legal, protocol), view, legal)
    except HearthError as error:
        for other in _otherwise(line, view):
            return by_text(_walks(other, legal, protocol), view, legal)
        raise error


def _remedied(fault: Diagnostic) -> Diagnostic:
    """Return a fault with a remedy that an agent has: it can't change the knowledge."""
    if fault.suggestion and "--kb" not in fault.suggestion and fault.code is not Code.NOT_UNDERSTOOD:
        return fault
    return replace(fault, suggestion="a command as under `Do:`, about things that you see")


def command_line(answer: str) -> str:
    """Return the command in an answer: of a tool call, of the last `Action:`, or its last line."""
    if _PLAIN.fullmatch(answer):
        return answer
    fenced = _FENCE.findall(answer)
    text = fenced[-1] if fenced else answer
    if called := _called(text.strip()):
        return called
    lines = [_INLINE.sub("\nAction: ", line).strip() for line in text.splitlines()]
    lines = [line.strip().strip("`*") for line in "\n".join(lines).splitlines() if line.strip()]
    acts = [act for line in lines if (act := act_of(line))]
    if acts:
        return _called(acts[-1]) or acts[-1]
    return _MARK.sub("", lines[-1].removeprefix(">").strip(), count=1) if lines else ""


def _called(text: str) -> str:
    """Return the command of a tool call in JSON; empty where a text is none."""
    import orjson

    if not text.startswith(("{", "[")) or not text.endswith(("}", "]")):
        return ""
    try:
        given = orjson.loads(text)
    except orjson.JSONDecodeError:
        return ""
    return _of_call(given[-1] if isinstance(given, list) and given else given)


def _of_call(given: Any) -> str:
    """Return the command of a call as servers write it, with its arguments as a mapping or as JSON."""
    if not isinstance(given, Mapping):
        return ""
    inner = given.get("function", given)
    arguments = inner.get("arguments", inner) if isinstance(inner, Mapping) else inner
    if isinstance(arguments, str):
        return _called(arguments.strip()) or arguments.strip()
    if not isinstance(arguments, Mapping):
        return ""
    word = next((arguments[name] for name in _FIELDS if isinstance(arguments.get(name), str)), "")
    objects = arguments.get("objects", [])
    some = [each for each in objects if isinstance(each, str)] if isinstance(objects, list) else []
    return f"{word} {', '.join(some)}".strip()


def _walks(line: str, legal: Legal, protocol: Protocol) -> str:
    """Return a line with the walk that is played here in place of any word for walking."""
    walk = WALK if WALK in legal.masks else "Walk"
    if step := _STEP.fullmatch(line):
        return f"{step[1]}[{walk}]{step[3]}" if step[2].lower() in protocol.walks else line
    word, _, rest = line.partition(" ")
    if word.lower() not in protocol.walks or not rest:
        return line
    return f"{walk} {rest.removeprefix('to ').removeprefix('the ')}"


def _otherwise(line: str, view: View) -> Iterator[str]:
    """Yield the command that another game's string or a plain sentence means."""
    if line.startswith(("[", "<")):
        return
    if foreign := command(line[:300]):
        yield _plain(foreign)
        return
    numbers = {normal_name(name.split()[-1]): number for name, number in _NUMBERED.findall(line[:300])}
    words = _NUMBERED.sub(lambda found: found[1], line[:300])
    meant = understand_exactly(view.world.home.knowledge, words).meant
    if meant is not None:
        objects = (f"{name} {numbers.get(name, numbers.get(name.split('_')[-1], ''))}".strip() for name in meant.names)
        yield f"{meant.action.name} {', '.join(objects)}".strip()


def _plain(program: str) -> str:
    """Return a step of a program as a plain command: `[Grab] <milk> (149)` is `Grab milk 149`."""
    action = program[1 : program.index("]")]
    return (
        f"{action} {', '.join(f'{normal_name(name)} {number}' for name, number in _PROGRAM.findall(program))}".strip()
    )
