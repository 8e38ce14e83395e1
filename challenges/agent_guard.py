"""Guards around others' agents in an episode: an agent that crashes, hangs or answers nonsense ends it with a code."""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from types import FrameType, FunctionType
from typing import TextIO, cast

from hearth.agents.protocol import Agent, Choice
from hearth.challenges.agent_standard_streams import check_descriptors
from hearth.challenges.worker_guard import ended_after, unchanged
from hearth.schemas.agent_messages import Message
from hearth.schemas.agent_messages import read as read_message
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code
from hearth.schemas.goals import Goal
from hearth.schemas.program import ObjectRef, Step
from hearth.schemas.terminal import shown
from hearth.simulation.actions.legal import Legal
from hearth.simulation.observation.views import View

SECONDS = 30.0
"""An agent may think about one tick as long as this."""

AGAIN = 0.1
"""Seconds between the interruptions of an agent that goes on after the first."""


class _Late(BaseException):
    """An agent takes too long; no `Exception`, which agents catch."""


class AgentError(Exception):
    """An agent can't go on.

    Attributes:
        fault: code and message.
        agent: its number.
    """

    def __init__(self, fault: Diagnostic, agent: int) -> None:
        super().__init__(str(fault))
        self.fault, self.agent = fault, agent


class Guarded:
    """An agent of which nothing but instructions and `AgentError` comes.

    Attributes:
        refused: its instructions that were not tried: actions that the challenge lacks, things that it does not see.
    """

    def __init__(
        self, agent: Agent, number: int, allowed: frozenset[str], seconds: float = SECONDS, messages: bool = False
    ) -> None:
        self.agent, self.number, self.allowed, self.seconds = agent, number, allowed, seconds
        self.messages = messages
        self.refused = 0

    def reset(self, observation: View, goal: Goal | None, seed: int) -> None:
        """Begin an episode.

        Raises:
            AgentError: it can't.
        """
        self.refused = 0
        with self._watched():
            self.agent.reset(observation, goal, seed)

    def act(self, observation: View, legal: Legal) -> Choice:
        """Return its message, where messages are allowed, or its instruction, if it may be tried; None otherwise.

        Raises:
            AgentError: there is no instruction: AGENT_FAILED, TIMED_OUT, BAD_ARGUMENT.
        """
        with self._watched():
            step = self.agent.act(observation, legal)
            if step is None:
                return None
            if isinstance(step, Message) and self.messages and (said := read_message(str(step))) == step:
                return said  # one of ours, whatever class the agent's is of
            if not isinstance(step, Step):
                wanted = "a Step, a message that can be read, or None"
                raise HearthError.of(Code.BAD_ARGUMENT, f"the answer is {type(step).__name__}, not {wanted}")
            if step in legal or self._may_try(step, observation):
                return self._plain(step, observation)
            self.refused += 1
            return None

    def close(self) -> None:
        """End what the agent has started, if it has a `close`; its failures do not matter any more."""
        with suppress(AgentError), self._watched():  # even looking for it may run the agent's code
            end = getattr(self.agent, "close", None)
            if callable(end):
                end()

    def _plain(self, step: Step, view: View) -> Step:
        """Return the instruction as records have it: an action and nodes. Agents could write one in many ways."""
        home = view.world.home
        nodes = [ref.node for ref in step.objects if ref.node is not None]
        return Step(step.action, tuple(ObjectRef(home.classes[home.index[i]], 0, i) for i in nodes), self.number)

    def _may_try(self, step: Step, view: View) -> bool:
        """Return whether an instruction is about visible nodes; the engine then says why it is impossible."""
        ids = [ref.node for ref in step.objects]
        return step.action in self.allowed and all(isinstance(node, int) and view.sees(node) for node in ids)

    @contextmanager
    def _watched(self) -> Iterator[None]:
        try:
            with ended_after(self.seconds), _keyboard_heeded(), _within(self.seconds), _streams_kept(), unchanged():
                try:
                    yield
                except BaseException as error:
                    error.__traceback__ = None  # of an endless recursion it is too long to be kept
                    raise
        except _Stopped:
            raise KeyboardInterrupt from None
        except _Late:
            message = f"no answer within {self.seconds:g} s"
            raise AgentError(Diagnostic(Code.TIMED_OUT, message), self.number) from None
        except BaseException as error:
            raise AgentError(_fault_of(error, self.seconds), self.number) from error


class _Stopped(BaseException):
    """The user has interrupted the run at the keyboard."""


@contextmanager
def _keyboard_heeded() -> Iterator[None]:
    """Tell an interrupt at the keyboard, which ends the run, from a `KeyboardInterrupt` that the agent raises.

    Raises:
        _Stopped: a signal came, whatever the agent made of it.
    """
    before = signal.getsignal(signal.SIGINT)
    if threading.current_thread() is not threading.main_thread() or not callable(before):
        yield  # no interrupt comes here as an error
        return
    came = False

    def interrupted(number: int, frame: FrameType | None) -> None:
        nonlocal came
        came = True
        before(number, frame)

    signal.signal(signal.SIGINT, interrupted)
    try:
        yield
    except BaseException:
        if came:
            raise _Stopped from None
        raise
    finally:
        signal.signal(signal.SIGINT, before)
    if came:
        raise _Stopped


@contextmanager
def refusing(place: str, seconds: float = SECONDS) -> Iterator[None]:
    """Let an agent's file, class or attributes run code before an episode.

    Raises:
        HearthError: BAD_ARGUMENT, whatever that code raises.
    """
    try:
        with ended_after(seconds), _keyboard_heeded(), _within(seconds), _streams_kept(), unchanged():
            yield
    except _Stopped:
        raise KeyboardInterrupt from None
    except BaseException as error:
        said = f"no answer within {seconds:g} s" if type(error) is _Late else _fault_of(error, seconds).message
        raise HearthError.of(Code.BAD_ARGUMENT, f"{place}: {said}") from error


@contextmanager
def _streams_kept() -> Iterator[None]:
    """Give the process its standard streams back, where an agent replaced or closed them.

    Raises:
        HearthError: AGENT_FAILED: it did, or wrote too much to them.
    """
    before = sys.stdin, sys.stdout, sys.stderr
    try:
        yield
    except BaseException:
        with suppress(HearthError):
            _restore(before)
        raise
    _restore(before)


def _restore(before: tuple[TextIO, TextIO, TextIO]) -> None:
    """Give the process these streams, and its descriptors.

    Raises:
        HearthError: AGENT_FAILED: it had others, or wrote too much.
    """
    streams = sys.stdin, sys.stdout, sys.stderr
    changed = any(new is not old or getattr(old, "closed", False) for new, old in zip(streams, before, strict=True))
    if changed:
        found = [_open(number) if getattr(old, "closed", False) else old for number, old in enumerate(before)]
        sys.stdin, sys.stdout, sys.stderr = found
    check_descriptors()
    if changed:
        message = "it replaced or closed a standard stream, which the whole process shares"
        raise HearthError.of(Code.AGENT_FAILED, message)


def _open(number: int) -> TextIO:
    """Return a new stream over a standard descriptor."""
    mode, errors = ("w", "backslashreplace") if number else ("r", "surrogateescape")
    return cast("TextIO", os.fdopen(number, mode, encoding="utf-8", errors=errors, closefd=False))


def _fault_of(error: BaseException, seconds: float) -> Diagnostic:
    """Return the diagnostic of an error that an agent raised; its name, text and attributes may themselves fail."""
    try:
        with _keyboard_heeded(), _within(seconds):
            if type(error) is HearthError and error.diagnostics:
                return error.diagnostics[0]
            return Diagnostic(Code.AGENT_FAILED, f"{type(error).__name__}: {error}"[:300])
    except _Stopped:
        raise KeyboardInterrupt from None
    except BaseException:
        return Diagnostic(Code.AGENT_FAILED, _name_of(error))


def _name_of(error: BaseException) -> str:
    return str(type.__dict__["__name__"].__get__(type(error)))[:300]


def say_unraisable() -> None:
    """Let errors that Python ignores, such as those of an agent's `__del__`, be a line and no traceback."""
    sys.unraisablehook = _unraisable


def _unraisable(found: sys.UnraisableHookArgs) -> None:
    name = type.__dict__["__name__"].__get__(found.exc_type)
    where = found.object.__qualname__ if type(found.object) is FunctionType else "a finalizer"
    with suppress(OSError, ValueError, AttributeError):
        sys.stderr.write(f"warning[{Code.AGENT_FAILED}]: {shown(where)[:100]} raised {shown(name)[:100]}; ignored\n")


@contextmanager
def _within(seconds: float) -> Iterator[None]:
    """Interrupt a longer computation, if this is the thread that gets signals."""
    if threading.current_thread() is not threading.main_thread() or not hasattr(signal, "setitimer"):
        yield
        return

    def late(_number: int, _frame: FrameType | None) -> None:
        raise _Late

    before = signal.signal(signal.SIGALRM, late)
    signal.setitimer(signal.ITIMER_REAL, seconds, AGAIN)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
