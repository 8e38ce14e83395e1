"""An agent that a language model decides for, through the text protocol hearth-text/1: an actor, or a helper.

Its walks go on as in `hearth.TextHome`: the model is asked again when it arrives, or sees something that is wanted. All
that it says depends on the observations and the answers alone, so that recorded answers give the same episode.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

from hearth.agents.protocol import Choice
from hearth.envs.agent_answers import SAYING, Fault, by_words
from hearth.envs.answer_forms import WALK, command_line, read_answer
from hearth.envs.compact_text import compact, wanted_nodes
from hearth.envs.text_layout import printable
from hearth.envs.text_protocol_settings import Protocol as Words
from hearth.envs.text_protocol_settings import protocol
from hearth.envs.text_worlds import reason
from hearth.llm.language_settings import Asking
from hearth.llm.legal_commands import constraint
from hearth.llm.picture_messages import pictured
from hearth.llm.prompt_pages import PromptPage, page, unmarked
from hearth.llm.replies import Reply
from hearth.llm.turns import Transcript, Turn
from hearth.schemas.agent_messages import ASK, TELL
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.goals import Goal
from hearth.schemas.program import Step
from hearth.schemas.rng import derive
from hearth.simulation.actions.legal import Legal
from hearth.simulation.observation.views import View

ACTOR, HELPER = 0, 1
"""Numbers of the agent that acts, and of its helper."""

THOUGHT = re.compile(r"<think>.*?</think>", re.DOTALL)
"""The thoughts that some models write before an answer."""


class Ask(Protocol):
    """Gives the reply to a chat: an endpoint, or recorded answers."""

    def __call__(self, messages: Sequence[Mapping[str, Any]], seed: int = 0, **more: Any) -> Reply:
        """Return the reply."""


@dataclass
class _Walk:
    """A walk under way: its instruction, what was seen when it began, where it last was, and its ticks."""

    step: Step
    began: View
    place: Any
    ticks: int = 1


class Actor:
    """An agent whose answers a language model gives.

    Attributes:
        transcript: the answers of the episode.
        faults: answers that could not be used.

    Args:
        ask: gives replies.
        asking: settings: how many earlier turns the model is shown.
        instruction: the task as somebody says it; the goal in words where empty.
        messages: whether it may say something instead of doing something.
        number: of the agent; a helper has another prompt.
        form: the way in which the server is sent the grammar of legal commands (see `constraints`); "" for none.
        eyes: makes what draws the pictures of an episode from its first view; a replay has none, and draws none.
    """

    subgoal = None

    def __init__(
        self,
        ask: Ask,
        asking: Asking | None = None,
        instruction: str = "",
        messages: bool = False,
        number: int = ACTOR,
        form: str = "",
        eyes: Callable[[View], Callable[[View], str]] | None = None,
    ) -> None:
        self._ask, self._asking, self._instruction = ask, asking or Asking(), instruction
        self._messages, self._number, self._form, self._open = messages, number, form, eyes
        self._words: Words = protocol()
        self._page: PromptPage = page("helper" if number else "actor")
        self.reset_state()

    def reset_state(self) -> None:
        """Forget the episode."""
        self.transcript = Transcript(constraint=self._form)
        self.faults: list[Fault] = []
        self._goal, self._seed = Goal(), 0
        self._told = False
        self._walk: _Walk | None = None
        self._fault: Diagnostic | None = None
        self._history: list[tuple[str, str]] = []
        self._system = ""
        self._eyes: Callable[[View], str] | None = None

    def reset(self, observation: View, goal: Goal | None, seed: int) -> None:
        """Begin an episode."""
        self.reset_state()
        self._goal, self._seed, self._told = goal or Goal(), seed, goal is not None
        self._system = self._first_message()
        self._eyes = self._open(observation) if self._open is not None else None

    def _first_message(self) -> str:
        facts = {"agent": self._number, "other": HELPER - self._number, "ask": ASK, "saying": SAYING}
        said = self._page.said("system", instructions=self._words.instructions, **facts)
        return f"{said}\n{self._page.said('talking', **facts)}" if self._messages and self._number else said

    def act(self, observation: View, legal: Legal) -> Choice:
        """Return the next tick's choice; the model is asked unless a walk goes on.

        Raises:
            HearthError: those of the endpoint.
        """
        stopped = False
        if self._walk is not None:
            goes_on, stopped = self._goes_on(self._walk, observation, legal)
            if goes_on:
                return self._walk.step
            self._walk = None
        if len(self.transcript.turns) >= self._asking.most_turns:
            return None
        choice = self._answered(observation, legal, stopped)
        if isinstance(choice, Step) and choice.action == WALK:
            self._walk = _Walk(choice, observation, observation.me.place)
        return choice

    def _goes_on(self, walk: _Walk, view: View, legal: Legal) -> tuple[bool, bool]:
        """Return whether a walk goes on, and whether it ends early because of something wanted (see `text_worlds`)."""
        last, here = view.me.last, view.me.place
        if (last is not None and last.failure is not None) or here == walk.place:
            return False, False
        if wanted_nodes(self._goal, view.world.home, view.mask) & ~walk.began.mask:
            return False, walk.step in legal
        if walk.ticks > self._words.most_walked or walk.step not in legal:
            return False, False
        walk.place, walk.ticks = here, walk.ticks + 1
        return True, False

    def _answered(self, view: View, legal: Legal, stopped: bool) -> Choice:
        """Ask the model, and return the choice in its answer; the next prompt says why an answer was refused."""
        said = self._observation(view, legal, stopped)
        messages = list(self._chat(said))
        if self._asking.images:  # its place alone is in the digest of the prompts: the world says what it shows
            self.transcript.prompt([*messages[:-1], {"role": "user", "content": pictured(said, "")}])
            self.transcript.pictures += 1
        else:
            self.transcript.prompt(messages)
        if self._eyes is not None:
            messages[-1] = {"role": "user", "content": pictured(said, self._eyes(view))}
        more, keeps = constraint(self._form, legal, self._words) if self._form else ({}, None)
        seed = derive(self._seed, "turn", len(self.transcript.turns)) if self._asking.temperature > 0 else 0
        reply = self._ask(messages, seed, **more)
        text = reply.text[: self._words.most_answer + 1]
        choice, self._fault = self._understood(text, view, legal)
        code = str(self._fault.code) if self._fault is not None else ""
        if self._fault is not None:
            self.faults.append(Fault(view.tick, self._fault))
        disobeyed = keeps is not None and not keeps(text)
        self.transcript.add(Turn(view.tick, text, code), reply, [messages, more, seed], disobeyed=disobeyed)
        self._history.append((said, self._remembered(text)))
        return choice

    def _understood(self, text: str, view: View, legal: Legal) -> tuple[Choice, Diagnostic | None]:
        bare = THOUGHT.sub("", text)
        try:
            line = command_line(bare)
            if self._messages and line.partition(" ")[0] in (ASK, TELL):
                return by_words(line, view, legal, messages=True), None
            return read_answer(bare, view, legal, self._words), None
        except HearthError as error:
            return None, error.diagnostics[0]

    def _observation(self, view: View, legal: Legal, stopped: bool) -> str:
        note = "" if self._fault is None else f"refused, you waited. {reason(self._fault)}"
        task = self._instruction if self._told else self._page.said("unknown_goal", other=HELPER - self._number)
        text = compact(view, legal, self._goal, self._words, task, note, stopped=stopped)
        if not self._told:
            text = text.replace(" You see  done.", "", 1)
        heard = [f"Agent {number} said: {printable(str(said))}." for number, said in view.messages]
        return unmarked("\n".join([*heard, text]))

    def _chat(self, said: str) -> Iterator[Mapping[str, Any]]:
        """Yield the messages of a prompt: how to act, earlier turns, and the observation."""
        yield {"role": "system", "content": self._system}
        memory = self._asking.memory
        for observation, answer in self._history[-memory:] if memory else ():
            yield {"role": "user", "content": observation}
            yield {"role": "assistant", "content": answer}
        yield {"role": "user", "content": said}

    def _remembered(self, text: str) -> str:
        """Return an answer as later prompts show it: without thoughts, and not endless."""
        bare = THOUGHT.sub("", text).strip()
        most = self._page["most_remembered"]
        return bare if len(bare) <= most else bare[:most] + " ..."
