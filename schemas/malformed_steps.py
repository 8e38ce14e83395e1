"""Diagnoses a line that is not a step: its first fault, the place, and the remedy."""

import re
from collections.abc import Iterator

from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.failures import Code

_FORM = "write [Action] <object> (1), with `|` between the agents of one tick"
_SPECIAL = re.compile(r"\s*\[\s*special\s*\]", re.IGNORECASE)
_AGENT = re.compile(r"<[^<>\[\]]*>(?=\s*\[)")
_NAMED_AGENT = re.compile(r"<\s*char[0-9]{1,3}\s*>", re.IGNORECASE)
_BRACKETS = re.compile(r"\[[^\[\]<>]*\]")
_ACTION_NAME = re.compile(r"\[\s*[A-Za-z][A-Za-z _-]*?\s*\]")
_OBJECT = re.compile(r"<([^<>\[\]]*)>")
_INSTANCE = re.compile(r"\(([^()<>\[\]|]*)\)")
_NUMBER = re.compile(r"\s*(?!0+\s*$)[0-9]{1,9}(\.[0-9]{1,9})?\s*")
_NEXT = ("", "<", "|", "{")
"""Tokens that may follow an object without an instance."""

_MODIFIERS = re.compile(r"\{[^{}]*\}")
_WORD = re.compile(r"[^\W_]")

Fault = tuple[int, int, str, str, Code]
"""Start and end in the line, message, remedy, code."""


def explain(line: str, position: int) -> Diagnostic:
    """Say what is wrong with a line that did not parse from `position` on; its line number is left 0."""
    if _SPECIAL.match(line, position):
        return special(line)
    start, end, message, suggestion, code = _fault(line, _skipped(line, position))
    found = line[start:end].rstrip()[:200]
    return Diagnostic(code, message, "", 0, start + 1, len(found), found, suggestion)


def special(line: str) -> Diagnostic:
    """Return the diagnostic of a Special block."""
    found = line.strip()
    message = "a special block: free text where no action fitted"
    suggestion = "map its text to steps in the special-blocks file, or leave it out"
    column = len(line) - len(line.lstrip()) + 1
    return Diagnostic(Code.SPECIAL_BLOCK, message, "", 0, column, len(found), found[:200], suggestion)


def _fault(line: str, at: int) -> Fault:
    agent = _AGENT.match(line, at)
    if agent:
        if not _NAMED_AGENT.fullmatch(agent[0]):
            remedy = "agents are <char0>, <char1>, ...; leave it out where there is one agent"
            return agent.start(), agent.end(), f"`{agent[0][:40]}` is not an agent", remedy, Code.SYNTAX
        at = _skipped(line, agent.end())
    action = _BRACKETS.match(line, at)
    if action is None:
        return _no_action(line, at)
    if not _ACTION_NAME.fullmatch(action[0]):
        message = f"`{action[0][:40]}` names no action" if _WORD.search(action[0]) else "an action without a name"
        remedy = "letters in the brackets, as in [Walk]"
        return action.start(), action.end(), message, remedy, Code.SYNTAX
    return next(_objects(line, _skipped(line, action.end())))


def _no_action(line: str, at: int) -> Fault:
    if line.startswith("[", at) and "]" not in line[at:].partition("<")[0]:
        message = "expected an action such as `[Walk]`: its bracket is never closed"
    else:
        message = "expected an action such as `[Walk]`"
    return _rest(line, at, message, _FORM)


def _objects(line: str, at: int) -> Iterator[Fault]:
    """Return the first fault among objects, instances and modifiers, and the tokens after them."""
    while name := _OBJECT.match(line, at):
        if not _WORD.search(name[1]):
            yield name.start(), name.end(), "an object without a name", "write <cup> (1)", Code.SYNTAX
        after = _skipped(line, name.end())
        instance = _INSTANCE.match(line, after)
        if instance is None and line[after : after + 1] in _NEXT:
            at = after
            continue
        if instance is None:
            message = f"`{name[0][:40]}` lacks its instance"
            remedy = f"write {name[0][:40]} (1); another of its kind in the program is (2)"
            yield name.start(), max(name.end(), _word_end(line, after)), message, remedy, Code.SYNTAX
            return
        if not _NUMBER.fullmatch(instance[1]):
            message = f"`{instance[1][:40]}` is not an instance"
            remedy = "a number: (1), or (1.319) once bound to node 319"
            yield instance.start(1), instance.end(1), message, remedy, Code.BAD_INSTANCE
        at = _skipped(line, instance.end())
    modifiers = _MODIFIERS.match(line, at)
    yield from _end(line, _skipped(line, modifiers.end()) if modifiers else at)


def _end(line: str, at: int) -> Iterator[Fault]:
    if at >= len(line):
        end = len(line.rstrip())
        yield max(0, end - 1), end, "nothing follows the `|`", _FORM, Code.SYNTAX
    elif line.startswith("{", at):
        yield _rest(line, at, "modifiers whose brace is never closed", "write {at=3,2 hand=left}")
    elif line.startswith("<", at):
        yield _rest(line, at, "expected an object such as `<cup> (1)`: its bracket is never closed", _FORM)
    else:
        yield _rest(line, at, "expected an object such as `<cup> (1)`", _FORM)


def _rest(line: str, at: int, message: str, remedy: str) -> Fault:
    if at >= len(line):
        end = len(line.rstrip())
        return max(0, end - 1), end, "nothing follows the `|`", remedy, Code.SYNTAX
    return at, len(line), message, remedy, Code.SYNTAX


def _skipped(line: str, at: int) -> int:
    """Return the place of the next character that is not blank, or the end."""
    return len(line) - len(line[at:].lstrip())


def _word_end(line: str, at: int) -> int:
    """Return the end of the words that stand where an instance should, up to the next bracket."""
    match = re.compile(r"[^<>\[\]|{]*").match(line, at)
    return at + len(match[0].rstrip()) if match else at
