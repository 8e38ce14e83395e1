"""Agents of others that crash in odd ways or do not stop: a code comes of it, and nothing else."""

import asyncio
import signal
import sys
import time
from contextlib import suppress

import pytest
from typer.testing import CliRunner

from hearth import cli
from hearth.challenges.agent_guard import AgentError, Guarded
from hearth.challenges.challenge_definition import challenge
from hearth.challenges.episode_agents import Lineup, load
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.program import Step


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


def ending(*_):
    raise SystemExit(3)


class Ends(Exception):
    """Ends the process, whatever is asked of it."""

    __str__ = __repr__ = __eq__ = __hash__ = __format__ = ending


class EndsOurs(HearthError):
    """A fault of ours by its class, that ends the process when it is read."""

    def __init__(self):
        pass

    diagnostics = property(ending)
    __str__ = ending


class EndsByName(type):
    __name__ = property(ending)


class Nameless(Exception, metaclass=EndsByName):
    __str__ = ending


class EndsCompared(Step):
    """A step that ends the process when it is compared, hashed or printed."""

    __eq__ = __hash__ = __str__ = __repr__ = ending


@pytest.mark.parametrize("error", [Ends(), EndsOurs(), Nameless()])
def test_what_ends_the_process_when_it_is_read_is_the_agents_failure(error):
    assert fault(raising(error)) == Code.AGENT_FAILED


def test_an_answer_that_ends_the_process_when_it_is_compared_is_the_agents_failure():
    agent = Agent(lambda: None)
    agent.act = lambda *_: EndsCompared("Walk", ())
    with pytest.raises(AgentError) as found:
        Guarded(agent, 1, frozenset({"Walk"}), 0.2).act(None, (Step("Walk", ()),))
    assert found.value.fault.code == Code.AGENT_FAILED


@pytest.mark.parametrize(
    "error", [HearthError(()), Unspeakable(), asyncio.CancelledError(), SystemExit(3), ValueError()]
)
def test_whatever_an_agent_raises_is_its_failure(error):
    assert fault(raising(error)) == Code.AGENT_FAILED


def test_a_fault_of_ours_keeps_its_code():
    assert fault(raising(HearthError.of(Code.NO_PLACE, "x"))) == Code.NO_PLACE


class Silent(BaseException):
    """No `Exception`, and its texts end the process."""

    __str__ = ending

    def __repr__(self):
        raise Silent


class Endless(Exception):
    def __str__(self):
        stubborn()
        return ""


@pytest.mark.parametrize("error", [BaseExceptionGroup("x", [SystemExit(1)]), Silent(), BaseException("x"), Endless()])
def test_what_is_no_exception_is_the_agents_failure_too(error):
    assert fault(raising(error)) == Code.AGENT_FAILED


def test_an_interrupt_of_the_keyboard_is_ours():
    with pytest.raises(KeyboardInterrupt):
        Guarded(Agent(lambda: signal.raise_signal(signal.SIGINT)), 1, frozenset()).act(None, ())


class Hidden:
    """Ends the process when any attribute is looked for."""

    def __getattribute__(self, _name):
        raise SystemExit(9)


def test_an_agent_without_attributes_is_the_agents_failure():
    hidden = Guarded(Hidden(), 1, frozenset())
    with pytest.raises(AgentError) as found:
        hidden.act(None, ())
    assert found.value.fault.code == Code.AGENT_FAILED
    hidden.close()


def test_an_agent_that_takes_the_standard_streams_away_fails_and_they_are_back(monkeypatch):
    before = sys.stdout
    assert fault(lambda: setattr(sys, "stdout", None)) == Code.AGENT_FAILED
    assert sys.stdout is before


OWN = """
import signal
import sys

class Hidden:
    def __getattribute__(self, name):
        raise SystemExit(9)

class Group:
    def __init__(self):
        raise BaseExceptionGroup("x", [SystemExit(1)])

class Ends:
    reset = act = lambda *_: None

    def __del__(self):
        sys.exit(1)
"""


@pytest.mark.parametrize("name", ["Hidden", "Group"])
def test_a_class_that_ends_the_process_before_an_episode_is_refused(tmp_path, name):
    file = tmp_path / "own.py"
    file.write_text(OWN)
    with pytest.raises(HearthError) as found:
        Lineup(f"{file}:{name}")._main(f"{file}:{name}", challenge("household"), str)
    assert found.value.diagnostics[0].code == Code.BAD_ARGUMENT


def test_what_a_finalizer_raises_is_a_line(tmp_path, monkeypatch, capsys):
    file = tmp_path / "own.py"
    file.write_text(OWN)
    monkeypatch.setattr(sys, "unraisablehook", sys.unraisablehook)
    made = load(f"{file}:Ends")()
    del made
    assert capsys.readouterr().err == "warning[AGENT_FAILED]: Ends.__del__ raised SystemExit; ignored\n"


@pytest.mark.parametrize("seconds", ["inf", "1e400", "99999999999999999999"])
@pytest.mark.parametrize("words", [("play", "maple", "--within"), ("challenge", "run", "x", "--seconds")])
def test_a_time_that_no_clock_takes_is_refused(words, seconds):
    result = CliRunner().invoke(cli.app, [*words, seconds])
    assert result.exit_code == 2 and words[-1] in result.output and "31536000" in result.output
