"""Agents of others that crash in odd ways or do not stop: a code comes of it, and nothing else."""

import asyncio
import time
from contextlib import suppress

import pytest

from hearth.challenges.agent_guard import AgentError, Guarded
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code


class Unspeakable(Exception):
    def __str__(self):
        raise RuntimeError


class Agent:
    def __init__(self, does):
        self.does = does

    def reset(self, *_):
        self.does()

    def act(self, *_):
        self.does()


def stubborn():
    """Goes on whatever is raised, for two seconds."""
    end = time.monotonic() + 2
    while time.monotonic() < end:
        with suppress(Exception):
            time.sleep(0.01)


def raising(error):
    def does():
        raise error

    return does


def fault(does):
    with pytest.raises(AgentError) as found:
        Guarded(Agent(does), 1, frozenset(), 0.2).act(None, ())
    return found.value.fault.code


def test_an_agent_that_catches_its_interruption_is_stopped():
    began = time.monotonic()
    assert fault(stubborn) == Code.TIMED_OUT
    assert time.monotonic() - began < 1.5


@pytest.mark.parametrize(
    "error", [HearthError(()), Unspeakable(), asyncio.CancelledError(), SystemExit(3), ValueError()]
)
def test_whatever_an_agent_raises_is_its_failure(error):
    assert fault(raising(error)) == Code.AGENT_FAILED


def test_a_fault_of_ours_keeps_its_code():
    assert fault(raising(HearthError.of(Code.NO_PLACE, "x"))) == Code.NO_PLACE
