"""Episodes as chats for fine-tuning: what the text environment says, and the commands that were answered.

A line is an episode: a system message with the protocol's instructions, then observations (`user`) and commands
(`assistant`) in turn. They are those of `hearth.TextHome`, in which the model will act.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import islice
from pathlib import Path
from typing import Any

from hearth.challenges.challenge_definition import challenge
from hearth.challenges.episodes import Record, read_instruction
from hearth.challenges.result_files import Results
from hearth.challenges.task_files import Suite
from hearth.challenges.tasks import Task
from hearth.envs.agent_answers import WAIT
from hearth.envs.compact_text import said_step
from hearth.envs.text_agent import plain
from hearth.envs.text_homes import TextHomes
from hearth.envs.text_protocol_settings import protocol
from hearth.envs.text_worlds import Play, TextWorld, begun, commanded, observed, seen
from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.terminal import shown_line
from hearth.simulation.world.digest import digest
from hearth.simulation.world.home import Home
from hearth.storage.files import write_bytes
from hearth.storage.names import inside

FILE = "messages.jsonl"
"""The name of the file in the folder."""

WALKS = "Walk "
"""The beginning of commands that go on for many ticks."""

EXPERT = "expert"
"""The agent of tasks that nobody has done yet: it sees everything."""

TWO = "a helper takes part, and a chat is of one agent"
TALKS = "an agent talks, for which the text environment has no words"
UNSEEN = "an agent did something that the text environment does not show or allow"
UNSOLVED = "the expert does not reach the goal by commands"


@dataclass
class Chats:
    """The result of an export.

    Attributes:
        episodes: how many were written.
        by_tick: those of them in which each tick is a turn, since whole walks end otherwise.
        left_out: those that were not written, by reason.
    """

    episodes: int = 0
    by_tick: int = 0
    left_out: Counter[str] = field(default_factory=Counter)


Chat = dict[str, Any]


def messages(source: Results | Suite, out: Path, knowledge: Knowledge, limit: int | None = None) -> Chats:
    """Write the episodes of a run without a helper, or, of tasks, those of an expert, into `messages.jsonl`.

    Args:
        source: results of a run, or tasks.
        out: an empty folder.
        knowledge: of the homes.
        limit: the first episodes or tasks only.
    """
    import orjson

    done, lines = Chats(), []
    found = _expert(source, knowledge) if isinstance(source, Suite) else _recorded(source, knowledge)
    for chat in islice(found, limit):
        if isinstance(chat, str):
            done.left_out[chat] += 1
            continue
        done.episodes += 1
        done.by_tick += not chat["travel"]
        lines.append(shown_line(orjson.dumps(chat)) + b"\n")
    write_bytes(inside(out, FILE), b"".join(lines))
    return done


def _expert(suite: Suite, knowledge: Knowledge) -> Iterator[Chat | str]:
    """Yield the chat of an expert for each task, or the reason why there is none."""
    which = challenge(suite.challenge)
    for task in suite.tasks:
        homes = TextHomes([task], worlds=1, limit=which.ticks, expert=True, knowledge=knowledge)
        texts, infos = homes.reset(indices=[0])
        turns: list[Mapping[str, str]] = []
        ended = False
        while not ended:
            turns += _turn(texts[0], infos[0]["expert"])
            texts, _, won, cut_off, infos = homes.step([infos[0]["expert"]])
            ended = won[0] or cut_off[0]
        if not won[0]:
            yield UNSOLVED
        else:
            yield _chat(task, EXPERT, 0, turns, infos[0]["ticks"], won=True, travel=True)


def _recorded(results: Results, knowledge: Knowledge) -> Iterator[Chat | str]:
    """Yield the chat of each episode of a run, or the reason why there is none."""
    tasks = {task.id: task for task in results.header.suite.tasks}
    main = results.header.lineup.main
    for record in results.records:
        yield TWO if record.helped else _replayed(tasks[record.task], record, main, knowledge)


def _replayed(task: Task, record: Record, main: str, knowledge: Knowledge) -> Chat | str:
    """Return the chat of an episode.

    Its commands are given again with whole walks. Where that does not end as the episode did, each tick is a turn.
    """
    which = challenge(task.challenge)
    play = Play(protocol(), which.allowed(knowledge), which.ticks, rules=which.rules, partial=which.partial)
    start = begun(task, play, knowledge)
    try:
        wanted = [_answer(texts[0], start.world.home, play) for texts in record.actions]
    except HearthError:  # a message to another agent
        return TALKS
    turns, last = _commands(start, _runs(wanted), play)
    if not last.faults and last.won == record.metrics["success"]:
        return _chat(task, main, record.seed, turns, last.ticks, won=last.won, travel=True)
    by_tick = replace(play, travel=False)
    turns, last = _commands(start, [(answer, 1) for answer in wanted], by_tick)
    if digest(last.world) != record.final:
        return UNSEEN
    return _chat(task, main, record.seed, turns, last.ticks, won=last.won, travel=False)


def _answer(text: str | None, home: Home, play: Play) -> str:
    """Return what was tried in a tick as a command."""
    return WAIT if text is None else said_step(plain(read_instruction(text, 0, home, play.actions)))


def _runs(answers: Sequence[str]) -> list[tuple[str, int]]:
    """Return equal walks one after the other once, with their number, and all other commands."""
    found: list[tuple[str, int]] = []
    for answer in answers:
        if found and answer.startswith(WALKS) and found[-1][0] == answer:
            found[-1] = answer, found[-1][1] + 1
        else:
            found.append((answer, 1))
    return found


def _commands(now: TextWorld, runs: Sequence[tuple[str, int]], play: Play) -> tuple[list[Mapping[str, str]], TextWorld]:
    """Return the turns of some commands, and the last world.

    A walk that is interrupted because something wanted comes into sight is taken up again where the episode's went on.
    """
    turns: list[Mapping[str, str]] = []
    for answer, number in runs:
        end = now.ticks + number
        while not now.over:
            shown = seen(now, play)
            turns += _turn(observed(now, play, shown), answer)
            now, _ = commanded(now, answer, play, shown)
            if not now.stopped or now.ticks >= end:
                break
    return turns, now


def _turn(observation: str, answer: str) -> list[Mapping[str, str]]:
    return [{"role": "user", "content": observation}, {"role": "assistant", "content": answer}]


def _chat(
    task: Task, agent: str, seed: int, turns: list[Mapping[str, str]], ticks: int, *, won: bool, travel: bool
) -> Chat:
    words = protocol()
    return {
        "task": task.id,
        "seed": seed,
        "split": task.split,
        "agent": agent,
        "won": won,
        "ticks": ticks,
        "protocol": words.name,
        "fingerprint": words.fingerprint,
        "travel": travel,
        "messages": [{"role": "system", "content": words.instructions}, *turns],
    }
