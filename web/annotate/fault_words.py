"""The faults of a draft in people's words: the words of the blocks, no names of actions, classes or codes."""

import re
from collections.abc import Sequence
from dataclasses import replace

from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.failure_words import REMEDIES, usual_remedy, why
from hearth.schemas.failures import Code, Failure
from hearth.schemas.spoken_words import spoken
from hearth.web.annotate.program_draft import Block, Draft
from hearth.web.phrases import ENGLISH, language, phrases, say

PART = "annotate"
"""The part of the table of phrases."""

IN_ORDER: dict[Code, str] = {
    Code.WRONG_ARITY: "empty_slot",
    Code.CONTRADICTION: "twice",
    Code.NO_EFFECT: "only_walks",
    Code.NOT_SIMULATED: "not_run",
}
"""The phrases of the faults that need no more than the words of their block."""

RESTING, RISES = frozenset({Code.LYING, Code.SITTING}), "StandUp"
"""The reasons for which a resting person does no step, and the action that helps."""


def in_words(each: Diagnostic, block: Block | None, draft: Draft, known: Knowledge) -> tuple[str, str]:
    """Return a fault of a draft, and its remedy.

    Args:
        each: as the check of programs finds it.
        block: of the faulty step; None where the program as a whole is meant.
        draft: the scene and the steps.
        known: the knowledge.
    """
    shown = block.words(known, draft) if block else ""
    if each.code is Code.NOT_CLOSE:
        thing = spoken(each.found)
        return said("not_near", thing=thing, walk=known.actions["Walk"].template.format(thing))
    if each.code is Code.OFF_TOPIC:
        return said("off_topic", things=things_in_words(each.found.split(", ")))
    return said(IN_ORDER.get(each.code, "unfit" if block else "unfit_program"), block=shown)


def scene_in_words(kind: str, names: Sequence[str]) -> tuple[str, str]:
    """Return that the scene and the steps differ, with every thing: `unused`, `fewer`, `more`, `missing`, `no_room`."""
    return said(kind, things=things_in_words(names))


def things_in_words(names: Sequence[str]) -> str:
    """Return classes by the names that people read, separated by commas."""
    return ", ".join(map(spoken, names))


def stop_in_words(failure: Failure, numbers: Sequence[int], draft: Draft, known: Knowledge) -> str:
    """Return why a run stops, with a remedy.

    Args:
        failure: of the run.
        numbers: of the blocks that run, from 0, in their order.
        draft: the scene and the steps.
        known: the knowledge.
    """
    code, step = failure.code, numbers[failure.tick] if failure.tick < len(numbers) else -1
    rise = say(PART, "rise_between", block=known.actions[RISES].template)
    if code is Code.NOT_SIMULATED and step >= 0:
        return ": ".join(said("not_run", block=draft.blocks[step].words(known, draft))) + "."
    inner = Code.__members__.get(failure.expected.partition(":")[0]) if code is Code.CONTRADICTION else None
    if inner is None:
        return _sentence(_reason(failure, known), rise if code in RESTING else _remedy(usual_remedy(failure)))
    reason = _reason(replace(failure, code=inner, expected="", actual=""), known)
    earlier = re.search(r"made impossible by step (\d+)", failure.actual)
    if earlier and 0 < int(earlier[1]) <= len(numbers):
        reason = say(PART, "after_step", reason=reason, number=numbers[int(earlier[1]) - 1] + 1)
    return _sentence(reason, rise if inner in RESTING else _remedy(REMEDIES.get(inner, "")) or say(PART, "leave_one"))


def _reason(failure: Failure, known: Knowledge) -> str:
    """Return why a step fails, with blocks' words instead of actions; in other languages by the code alone."""
    if language() != ENGLISH:
        words = phrases(language()).get("failed", {})
        return words.get(str(failure.code), words.get("other", "")).rstrip(".")
    return re.sub(r"\[(\w+)\]", lambda named: _block_words(named[1], known), why(failure))


def _block_words(action: str, known: Knowledge) -> str:
    found = known.actions.get(action)
    return f"“{found.template.format('…', '…')}”" if found else action


def _remedy(usual: str) -> str:
    """Return a usual remedy in English; reasons of other languages have theirs."""
    return usual if language() == ENGLISH else ""


def _sentence(reason: str, remedy: str) -> str:
    said = f"{reason}; {remedy}" if remedy else reason
    return f"{said[:1].upper()}{said[1:]}."


def said(name: str, **values: str) -> tuple[str, str]:
    """Return a fault of the table of phrases, and its remedy."""
    return say(PART, name, **values), say(PART, f"{name}_remedy", **values)
