"""Agents that are programs of any language: a command that reads observations and writes answers, one an episode."""

from __future__ import annotations

import shlex
import shutil
from pathlib import Path

from hearth.agents.protocol import Choice
from hearth.challenges.agent_channels import ProcessChannel
from hearth.challenges.wire_protocol import FORMS, WireAgent
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.goals import Goal
from hearth.simulation.actions.legal import Legal
from hearth.simulation.observation.views import View


class CommandAgent:
    """A program that is started for an episode and gets its lines (see `wire_protocol`).

    Args:
        command: the program and its arguments, as a shell has them.
        seconds: that it may think about a tick.
        messages: whether it may say something instead of doing something.
    """

    subgoal = None

    def __init__(self, command: str, seconds: float, messages: bool = False) -> None:
        self.command, self.seconds, self.messages = command, seconds, messages
        self._wire: WireAgent | None = None

    def reset(self, observation: View, goal: Goal | None, seed: int) -> None:
        """Start the program, and tell it the goal."""
        self.close()
        channel = ProcessChannel(argv(self.command))
        self._wire = WireAgent(channel, self.seconds, FORMS, messages=self.messages)
        self._wire.reset(observation, goal, seed)
        self._need_there()

    def act(self, observation: View, legal: Legal) -> Choice:
        """Return its choice.

        Raises:
            HearthError: DISCONNECTED: the program has ended. What it writes that is no answer is its own fault, and it
                waits then.
        """
        assert self._wire is not None
        choice = self._wire.act(observation, legal)
        self._need_there()
        return choice

    def _need_there(self) -> None:
        if self._wire is not None and not self._wire.channel.open:
            raise HearthError.of(Code.DISCONNECTED, f"`{self.command[:60]}` has ended in the middle of an episode")

    def close(self) -> None:
        """End the program."""
        if self._wire is not None:
            self._wire.channel.close()
            self._wire = None


def argv(command: str) -> list[str]:
    """Return the words of a command; none where a quotation is open."""
    try:
        return shlex.split(command)
    except ValueError:
        return []


def is_command(text: str) -> bool:
    """Return whether a text begins with a program of this machine."""
    words = argv(text)
    return bool(words) and (shutil.which(words[0]) is not None or Path(words[0]).is_file())
