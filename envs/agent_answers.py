"""Answers of agents that are no Python objects: number or text of an instruction, read against the legal ones.

Only legal instructions are tried. The agent's observation alone decides why an answer is refused, so that answers
reveal nothing about the rest of the home.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

from hearth.agents.protocol import Choice
from hearth.envs.json_observations import instruction_text, seen_instances
from hearth.envs.places_to_look import places_to_look
from hearth.kb.action_grammar import check
from hearth.kb.knowledge import Knowledge
from hearth.schemas.agent_messages import ASK, TELL, Message
from hearth.schemas.agent_messages import read as read_message
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failure_words import usual_remedy, why
from hearth.schemas.failures import Code, Failure
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.schemas.syntax import normal_name, parse_steps
from hearth.simulation.actions.legal import Legal
from hearth.simulation.engine import act
from hearth.simulation.observation.masked_world import as_seen
from hearth.simulation.observation.views import View
from hearth.simulation.world.bits import indices

WAIT = "wait"
"""The answer of an agent that does nothing in this tick."""

SAYING = f"{TELL} ON(plate, 55) 2"
"""An example of a message, for remedies and prompts."""

LONGEST = 500
"""Characters of an answer in text."""

_NAMED = re.compile(r"([a-z][a-z_ ]*?)\s*([0-9]{1,9})?", re.ASCII | re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class Fault:
    """The reason for an agent's failure to act in its own tick.

    Attributes:
        tick: which, from 0.
        fault: code, message and remedy.
    """

    tick: int
    fault: Diagnostic

    def as_json(self) -> dict[str, Any]:
        """Return the fault as agents and files get it."""
        code, message = str(self.fault.code), self.fault.message
        return {"tick": self.tick, "code": code, "message": message, "remedy": self.fault.suggestion}


Keep = Callable[[Mapping[str, Any]], None]
"""Takes the rows of a transcript."""


def keep_nothing(row: Mapping[str, Any]) -> None:
    """No transcript."""


def row(view: View, answer: int | str | None, choice: Choice, fault: Fault | None) -> dict[str, Any]:
    """Return a tick of a transcript: the answer, its action or message, and the reason if it had none."""
    return {
        "tick": view.tick,
        "agent": view.agent,
        "answer": answer,
        "instruction": instruction_text(choice) if isinstance(choice, Step) else None,
        "said": str(choice) if isinstance(choice, Message) else None,
        "fault": None if fault is None else fault.as_json(),
    }


def by_number(number: int, options: Sequence[Step]) -> Step:
    """Return the legal instruction of that number, from 0.

    Raises:
        HearthError: BAD_ARGUMENT: there is none of that number.
    """
    if not 0 <= number < len(options):
        remedy = f"0 to {len(options) - 1}" if options else "nothing can be done now but to wait"
        raise HearthError.of(Code.BAD_ARGUMENT, f"no legal instruction has the number {number}", suggestion=remedy)
    return options[number]


def by_words(text: str, view: View, legal: Legal, messages: bool) -> Choice:
    """Return the message of a text, where agents may talk; otherwise the instruction that it means (see `by_text`).

    Raises:
        HearthError: SYNTAX: it begins as a message and is none; and the faults of `by_text`.
    """
    line = text.strip()
    if not messages or line.partition(" ")[0] not in (ASK, TELL):
        return by_text(text, view, legal)
    found = read_message(line)
    if found is None:
        raise HearthError.of(Code.SYNTAX, f"`{line[:60]}` is not a message", suggestion=f"`{ASK}`, or `{SAYING}`")
    return found


def by_text(text: str, view: View, legal: Legal) -> Step | None:
    """Return the legal instruction that a text means; None for `wait`.

    It may be written as in programs, `[Grab] <cup> (1.41)`, where `(2)` is the second of its class that is seen; or
    plainly, `Grab cup 41`, `PutBack cup 41, table 55`, where a number may be left out if one alone is seen.

    Raises:
        HearthError: a fault of syntax and grammar; NOT_SEEN, AMBIGUOUS; or the reason why it can't be done now.
    """
    line = text.strip().strip("`*").rstrip(".").strip()
    if len(line) > LONGEST:
        raise HearthError.of(Code.LINE_TOO_LONG, f"an answer of {len(line):,} characters", suggestion="one instruction")
    if line.lower() == WAIT:
        return None
    step = _formal(line, view) if line.startswith(("[", "<")) else _plain(line, view)
    step = Step(step.action, step.objects, view.agent, modifiers=step.modifiers)
    _need_legal(step, view, legal)
    return step


def _formal(line: str, view: View) -> Step:
    found = parse_steps(line)
    if isinstance(found, Diagnostic):
        raise HearthError(found)
    if len(found) != 1:
        raise HearthError.of(Code.SYNTAX, f"{len(found)} instructions where one is expected")
    if line.startswith("<") and found[0].agent != view.agent:
        raise HearthError.of(Code.UNKNOWN_AGENT, f"an instruction of agent {found[0].agent}; you are {view.agent}")
    (step,) = _checked(found[0], view.world.home.knowledge, line).steps
    return replace(step, objects=tuple(_bound(ref, view) for ref in step.objects))


def _plain(line: str, view: View) -> Step:
    step = _read_plainly(line, view.world.home.knowledge)
    return Step(step.action, tuple([_bound(ref, view) for ref in step.objects]))


@lru_cache(maxsize=4096)
def _read_plainly(line: str, known: Knowledge) -> Step:
    """Return the instruction of a plain command, with the numbers that it gives."""
    word, _, rest = line.partition(" ")
    parts = [_NAMED.fullmatch(part.strip()) for part in rest.split(",")] if rest.strip() else []
    matches = [part for part in parts if part is not None]
    if not word.isalpha() or len(matches) < len(parts):
        remedy = "a number, `wait`, or an instruction: `Grab cup 41`, `PutBack cup 41, table 55`"
        raise HearthError.of(Code.NOT_UNDERSTOOD, f"`{line[:60]}` is not an answer", suggestion=remedy)
    action = known.action(word)
    if action is None:
        near = known.suggest(word, "action")
        remedy = f"did you mean {near[0]}?" if near else ""
        raise HearthError.of(Code.UNKNOWN_ACTION, f"no action is called `{word[:60]}`", suggestion=remedy)
    names = tuple([normal_name(part[1]) for part in matches])
    nodes = [int(part[2]) if part[2] else None for part in matches]
    checked = _canonical(action.name, names, known)
    if checked is None:
        given = [ObjectRef(name, 1, node) for name, node in zip(names, nodes, strict=True)]
        checked = tuple([ref.name for ref in _checked(Step(action.name, tuple(given)), known, line).steps[0].objects])
    return Step(action.name, tuple([ObjectRef(name, 0, node) for name, node in zip(checked, nodes, strict=True)]))


@lru_cache(maxsize=4096)
def _canonical(action: str, names: tuple[str, ...], known: Knowledge) -> tuple[str, ...] | None:
    """Return the canonical names of an action's things; None where they are at fault, or equal."""
    step = Step(action, tuple([ObjectRef(name, 1) for name in names]))
    program, faults = check(Program(steps=(step,), lines=(1,)), known)
    return None if faults else tuple([ref.name for ref in program.steps[0].objects])


def _checked(step: Step, known: Knowledge, line: str) -> Program:
    program, faults = check(Program(steps=(step,), lines=(1,)), known, source=[line])
    if faults:
        raise HearthError(faults)
    return program


def _bound(ref: ObjectRef, view: View) -> ObjectRef:
    """Return the seen node that is meant: by its id, by its number among the seen of its class, or as the only one."""
    home = view.world.home
    some = seen_instances(ref.name, home, view.mask)
    at = home.index.get(ref.node, -1) if ref.node is not None else -1
    if at >= 0 and some >> at & 1:
        return ObjectRef(home.classes[at], 0, ref.node)
    seen = [home.ids[i] for i in indices(some)]
    if ref.node is not None:
        found = ref.node if view.sees(ref.node) else None
        first = ", ".join(map(str, seen[:8]))
        if found is not None and found not in seen:
            name = home.classes[home.index[found]]
            raise HearthError.of(
                Code.UNBOUND,
                f"{found} is `{name}`, not `{ref.name}`",
                suggestion=f"you see {first}" if seen else f"{name} {found}",
            )
    elif ref.instance == 0 and len(seen) > 1:
        first = ", ".join(map(str, seen[:8]))
        raise HearthError.of(Code.AMBIGUOUS, f"which `{ref.name}`?", suggestion=f"you see {first}")
    else:
        # A number that is too large for a count is the id of a node, as in programs of VirtualHome.
        counted = seen[max(ref.instance, 1) - 1] if max(ref.instance, 1) <= len(seen) else None
        found = ref.instance if counted is None and ref.instance in seen else counted
    if found is None:
        number = ref.node if ref.node is not None else ref.instance or ""
        remedy = f"you see {', '.join(map(str, seen[:8]))}" if seen else places_to_look(ref.name, view)
        raise HearthError.of(Code.NOT_SEEN, f"you do not see `{ref.name}` {number}".rstrip(), suggestion=remedy)
    return ObjectRef(home.classes[home.index[found]], 0, found)


def _need_legal(step: Step, view: View, legal: Legal) -> None:
    """Refuse an illegal instruction, and say why it is impossible in the world as far as the agent sees it."""
    if step in legal:
        return
    result = act(as_seen(view.world, view.mask), step)
    remedy = "take one of the legal instructions"
    if isinstance(result, Failure):
        raise HearthError.of(result.code, why(result), suggestion=usual_remedy(result) or remedy)
    raise HearthError.of(Code.NOT_ALLOWED, f"[{step.action}] is not among what you may do here", suggestion=remedy)
