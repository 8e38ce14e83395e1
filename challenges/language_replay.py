"""The verification of language models' answers: read again in the recorded episode, they must be what was done.

Nothing is asked: the prompts are written anew, and the recorded answers are read by the same protocol.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from hearth.challenges.agent_guard import AgentError, Guarded
from hearth.challenges.challenge_definition import Challenge, challenge
from hearth.challenges.episode_loop import Playing
from hearth.challenges.episodes import Record, goals_of, read_choices, start_of, written
from hearth.challenges.language_agents import WAITING, same_words
from hearth.challenges.tasks import Task
from hearth.kb.knowledge import Knowledge
from hearth.llm.actor import Actor
from hearth.llm.language_settings import Asking
from hearth.llm.recorded_answers import RecordedAnswers
from hearth.llm.turns import turns_of
from hearth.schemas.failures import Code
from hearth.schemas.goals import Goal

CHECKED = ("turns", "asked", "pictures")
"""The parts of a transcript that reading the answers again gives; tokens and seconds are the server's word."""

Fault = str
"""A difference in words; "" for none."""


def answers_differ(task: Task, record: Record, language: Mapping[str, Mapping[str, Any]], known: Knowledge) -> Fault:
    """Return how the answers of language models differ from the episode; "" where they do not.

    Args:
        task: the task of the episode.
        record: the episode, whose actions can be done (see `episodes.again`).
        language: the models that took part, as the results describe them.
        known: the knowledge.
    """
    taking_part = {n for n in language if n == "0" or record.helped}
    if taking_part != set(record.language or {}):
        return "it has not the answers of the language models that took part"
    for number, transcript in (record.language or {}).items():
        if not same_words(language[number], int(number)):
            return f"the prompts of agent {number} were of another protocol, which this version does not have"
        if fault := _replayed(task, record, int(number), language[number], transcript, known):
            return fault
    return ""


def _replayed(
    task: Task, record: Record, number: int, facts: Mapping[str, Any], transcript: Mapping[str, Any], known: Knowledge
) -> Fault:
    """Return how one agent's answers differ."""
    which = challenge(task.challenge)
    start = start_of(task, known, None if record.helped else 1)
    goals = goals_of(which, task, record, start.home)
    answers = RecordedAnswers(turns_of(transcript))
    instruction = "" if number else task.instruction
    images = facts.get("images") is True
    asking = Asking(memory=int(facts["memory"]), most_turns=int(facts["most_turns"]), images=images)
    actor = Actor(answers, asking, instruction, which.messages, number)
    guarded = Guarded(actor, number, which.allowed(known), WAITING, which.messages)
    playing = Playing(
        start, goals[0] or Goal(), [which.partial] * len(start.agents), actions=which.allowed(known),
        limit=which.ticks, rules=which.rules, messages=which.messages,
    )  # fmt: skip
    guarded.reset(playing.view(number), goals[number], 0)
    for tick, texts in enumerate(record.actions):
        try:
            choice = guarded.act(playing.view(number), playing.legal(number))
        except AgentError as error:
            return f"tick {tick + 1}: agent {number}: {error.fault.message}"
        if written(choice) != texts[number]:
            did = written(choice) or "wait"
            return f"tick {tick + 1}: agent {number} answered `{did}`, and did `{texts[number] or 'wait'}`"
        _stepped(playing, texts, which, known)
    return _rest(
        record, number, answers, actor, transcript, lambda: guarded.act(playing.view(number), playing.legal(number))
    )


def _stepped(playing: Playing, texts: tuple[str | None, ...], which: Challenge, known: Knowledge) -> None:
    steps, said = read_choices(texts, playing.env.world.home, which.allowed(known), which.messages)
    playing.step({**steps, **said})


def _rest(
    record: Record,
    number: int,
    answers: RecordedAnswers,
    actor: Actor,
    transcript: Mapping[str, Any],
    once_more: Callable[[], Any],
) -> Fault:
    """Return whether answers are left over, or their prompts and faults were others."""
    if record.end is not None and record.end.get("agent") == number:
        try:  # the prompt that brought no answer was written, too
            once_more()
            return f"agent {number} has more answers than it did something"
        except AgentError as error:
            if error.fault.code is not Code.NO_ANSWER:
                return f"agent {number}: {error.fault.message}"
    if answers.left:
        return f"agent {number} has {answers.left} answers more than it gave"
    again = actor.transcript.as_json()
    for name in CHECKED:
        if again.get(name) != transcript.get(name):
            what = "a fault of an answer" if name == "turns" else "a prompt"
            return f"{what} of agent {number} is another than was recorded"
    return ""
