"""Agents of any language: JSON lines, one message each way a tick (docs/examples/agents.md has all messages).

Hearth sends `begin`, then each tick `observe`, which is answered by `{"tick": 3, "act": 17}`: the number or the text of
a legal instruction, or null to wait. An answer that can't be used is a fault: it is reported to the agent and recorded,
and the agent waits in that tick.
"""

from __future__ import annotations

import contextlib
import time
from typing import Any

import orjson

from hearth.agents.protocol import Choice
from hearth.challenges.agent_channels import Channel
from hearth.envs.agent_answers import Fault, Keep, by_number, by_words, keep_nothing, row
from hearth.envs.json_observations import instruction_text, observation
from hearth.envs.text_agent import description
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.goals import Goal
from hearth.schemas.program import Step
from hearth.simulation.actions.legal import Legal
from hearth.simulation.observation.views import View

PROTOCOL = 1
"""Version of the messages. It grows when an agent of before would no longer understand them."""

ANSWER_WITHIN = 30.0
"""Seconds that an agent may think about a tick."""

NOTICE = 0.5
"""Seconds that a fault or the end may take to be sent."""

FORMS = ("graph", "text")
"""Forms of an observation: `observation`, a mapping, and `text`, lines."""


class WireAgent:
    """An agent at the other end of a channel.

    Attributes:
        faults: of the episode, in their order.

    Args:
        channel: to it.
        within: seconds that it may think about a tick.
        forms: of the observations that it is sent, some of `FORMS`.
        limit: ticks of the episode, for its information; 0 if there is none.
        keep: gets a row for each tick: `tick`, `agent`, `answer`, `instruction`, `said`, `fault`.
        messages: whether it may say something instead of doing something.
    """

    def __init__(
        self,
        channel: Channel,
        within: float = ANSWER_WITHIN,
        forms: tuple[str, ...] = FORMS[:1],
        limit: int = 0,
        keep: Keep = keep_nothing,
        messages: bool = False,
    ) -> None:
        self.messages = messages
        self.channel, self.within, self.forms, self.limit, self.keep = channel, within, forms, limit, keep
        self.faults: list[Fault] = []
        self._goal: Goal | None = None

    def reset(self, observation: View, goal: Goal | None, seed: int) -> None:
        """Send `begin`."""
        self.faults, self._goal = [], goal
        begin = {
            "type": "begin",
            "protocol": PROTOCOL,
            "agent": observation.agent,
            "goal": None if goal is None else str(goal),
            "seed": seed,
            "ticks": self.limit or None,
            "messages": self.messages,
        }
        try:
            self.channel.send(orjson.dumps(begin), time.monotonic() + self.within)
        except HearthError as error:
            self._fault(observation, error)

    def act(self, observation: View, legal: Legal) -> Choice:
        """Send `observe`, wait for the answer; None where there is none that can be used."""
        if not self.channel.open:
            return None
        options = list(legal)
        deadline = time.monotonic() + self.within
        answer: int | str | None = None
        choice: Choice = None
        fault = None
        try:
            self.channel.send(orjson.dumps(self._observe(observation, options)), deadline)
            answer = self._answer(observation, deadline)
            choice = self._chosen(answer, observation, legal, options)
        except HearthError as error:
            fault = self._fault(observation, error)
            self._notify({"type": "fault", **fault.as_json()})
        self.keep(row(observation, answer, choice, fault))
        return choice

    def end(self, success: bool, ticks: int) -> None:
        """Send `end`: whether the goal was reached, and how many ticks it took."""
        self._notify({"type": "end", "tick": ticks, "success": success, "faults": len(self.faults)})

    def _fault(self, view: View, error: HearthError) -> Fault:
        self.faults.append(Fault(view.tick, error.diagnostics[0]))
        return self.faults[-1]

    def _notify(self, message: dict[str, Any]) -> None:
        """Send a message that needs no answer; its receiver may be gone, or not reading."""
        if self.channel.open:
            with contextlib.suppress(HearthError):
                self.channel.send(orjson.dumps(message), time.monotonic() + min(self.within, NOTICE))

    def _observe(self, view: View, options: list[Step]) -> dict[str, Any]:
        message: dict[str, Any] = {"type": "observe", "tick": view.tick, "agent": view.agent}
        if "graph" in self.forms:
            message["observation"] = observation(view, self._goal)
        if "text" in self.forms:
            message["text"] = description(view, self._goal)
        message["legal"] = [instruction_text(step) for step in options]
        return message

    def _chosen(self, act: int | str | None, view: View, legal: Legal, options: list[Step]) -> Choice:
        if act is None:
            return None
        return by_number(act, options) if isinstance(act, int) else by_words(act, view, legal, self.messages)

    def _answer(self, view: View, deadline: float) -> int | str | None:
        """Return the answer to this tick; late ones to earlier ticks are passed over."""
        while True:
            tick, act = read_answer(self.channel.receive(deadline), view.agent)
            if tick > view.tick:
                raise HearthError.of(Code.BAD_ARGUMENT, f"an answer to tick {tick}, and it is tick {view.tick}")
            if tick == view.tick:
                return act


def read_answer(line: bytes, agent: int) -> tuple[int, int | str | None]:
    """Return the tick of an answer and its choice: a number, a text, or None to wait.

    Args:
        line: as it came.
        agent: the agent that is asked; an answer may name it.

    Raises:
        HearthError: BAD_JSON; UNKNOWN_AGENT; BAD_ARGUMENT, of a field that is missing or of a wrong kind.
    """
    try:
        found = orjson.loads(line)
    except orjson.JSONDecodeError as error:
        raise HearthError.of(Code.BAD_JSON, f"not a line of JSON: {error}", suggestion=_EXAMPLE) from None
    if not isinstance(found, dict):
        raise HearthError.of(Code.BAD_JSON, f"{type(found).__name__} where an object is expected", suggestion=_EXAMPLE)
    tick, act, number = found.get("tick"), found.get("act", found), found.get("agent", agent)
    if type(number) is not int or number != agent:
        raise HearthError.of(Code.UNKNOWN_AGENT, f"an answer of another agent than {agent}, who is asked")
    if type(tick) is not int or tick < 0:
        raise HearthError.of(Code.BAD_ARGUMENT, "`tick` is not a whole number", suggestion=_EXAMPLE)
    if act is not None and type(act) not in (int, str):
        raise HearthError.of(Code.BAD_ARGUMENT, "`act` is not a number, a text or null", suggestion=_EXAMPLE)
    return tick, act


_EXAMPLE = 'answer {"tick": 3, "act": 17}'
