"""The agents of episodes: agents by name or the user's own, and the goal of the helper."""

from __future__ import annotations

import importlib.util
from collections.abc import Callable
from concurrent.futures.process import BrokenProcessPool
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from hearth.agents.agent_registry import HELPERS, MAIN, MainAgent
from hearth.agents.online_helper_registry import ONLINE, PROPOSED
from hearth.agents.protocol import Agent
from hearth.challenges.agent_descendants import none_left
from hearth.challenges.agent_guard import SECONDS, Guarded, refusing, say_unraisable
from hearth.challenges.agent_standard_streams import StandardDescriptors
from hearth.challenges.challenge_definition import Challenge, challenge
from hearth.challenges.command_agents import CommandAgent, is_command
from hearth.challenges.episode_loop import Player
from hearth.challenges.language_agents import WAITING, described, need_model, player_of
from hearth.kb.knowledge import Knowledge
from hearth.llm.addresses import is_model
from hearth.llm.language_settings import Asking, Means
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.goals import Goal
from hearth.schemas.optional_libraries import lacking, remedy
from hearth.storage.files import file_digest
from hearth.storage.parallel import spread

NOBODY = "none"
"""The helper's name for a main agent that acts alone."""

GOALS = ("true", "inferred", "inferred_states", "random", "none")
"""The goals that a helper may have.

The main agent's, the goal that counting or a network infers from a demonstration, another task's goal, none.
"""


@dataclass(frozen=True)
class Lineup:
    """The agents that take part.

    Attributes:
        main: the agent that acts, and is helped: a name, `FILE.py:CLASS`, the command of a program, `llm:MODEL@URL`.
        helper: the helper's name; `none`, or `FILE.py:CLASS` for the user's own agent, or `llm:MODEL@URL`.
        goal: the helper's goal; as its row in the registry says where empty.
        seconds: an agent may think about a tick as long as this; a language model has its own time.
        asking: what language models are asked with.
        means: by which they are asked; they change no answer.
    """

    main: str = "human_like"
    helper: str = NOBODY
    goal: str = ""
    seconds: float = SECONDS
    asking: Asking = field(default_factory=Asking)
    means: Means = field(default_factory=Means, compare=False)

    @property
    def language(self) -> dict[str, dict[str, Any]]:
        """Return its language models by the agent's number, as results describe them."""
        return {
            str(n): described(name, n, self.asking, self.means) for n, name in enumerate(self.names) if is_model(name)
        }

    @property
    def names(self) -> tuple[str, str]:
        """Return the names of its agents."""
        return self.main, self.helper

    @property
    def own(self) -> tuple[str, ...]:
        """Return the classes of others among its agents, as `FILE.py:CLASS`."""
        return tuple(each for each in (self.main, self.helper) if is_own(each))

    @property
    def code(self) -> str:
        """Return digests of the files of a user's own agents; "" for ours."""
        files = [each.rpartition(":")[0] for each in self.own]
        return "".join(file_digest(Path(file))[:32] for file in files)

    def checked(self) -> Lineup:
        """Return the same lineup, with the goal of the helper filled in.

        Raises:
            HearthError: BAD_ARGUMENT: there is no such agent or goal; MISSING_FILE.
        """
        known = HELPERS.get(self._helper)
        for name in filter(is_model, self.names):
            need_model(name)
        if is_own(self.main):
            need_class(self.main)
        elif not is_model(self.main) and self.main not in MAIN and not is_command(self.main):
            raise _unknown("main agent", self.main, (*MAIN, "FILE.py:CLASS", "llm:MODEL@URL", "a command"))
        if self.goal and self.goal not in GOALS:
            raise _unknown("goal", self.goal, GOALS)
        if self._helper not in (NOBODY, *HELPERS, *ONLINE) and ":" not in self.helper:
            raise _unknown("helper", self.helper, (NOBODY, *HELPERS, *ONLINE))
        if ":" in self.helper and not is_model(self.helper):
            need_class(self.helper)
        untold = self.helper in (NOBODY, *ONLINE)
        goal = self.goal or (known.goal if known else "none" if untold else "true")
        return replace(self, helper=self._helper, goal=goal)

    def installed(self) -> Lineup:
        """Return the same lineup, if the networks that its helper needs are installed.

        Raises:
            HearthError: MISSING_FILE: the extra `models` is not installed.
        """
        kind = HELPERS.get(self.helper) or ONLINE.get(self.helper)
        network = (kind.network if kind else "") or ("goal-inference" if self.goal == "inferred_states" else "")
        if network and lacking("models"):
            message = f"the helper `{self.helper}` asks the network `{network}`, and torch is not installed"
            raise HearthError.of(Code.MISSING_FILE, message, suggestion=remedy("models"))
        return self

    def fits(self, which: Challenge) -> Lineup:
        """Return the same lineup, if its helper can work in a challenge.

        Raises:
            HearthError: BAD_ARGUMENT: it would end every episode there: there is one agent alone, it talks where nobody
                may, or its network was trained for the goals of another challenge.
        """
        kind = ONLINE.get(self.helper)
        why = ""
        if self.helper != NOBODY and which.agents < 2:
            why = "its tasks are for one agent"
        elif kind and kind.talks and not which.messages:
            why = f"it talks, and in `{which.name}` nobody may say anything"
        elif kind and kind.network and which.grammar.sets != challenge(PROPOSED).grammar.sets:
            why = f"its network was trained for the goals of `{PROPOSED}`"
        if why:
            message = f"the helper `{self.helper}` can't help in `{which.name}`: {why}"
            raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="hp, nopa, expected_time, ...")
        return self

    @property
    def _helper(self) -> str:
        """Return the helper that is made for this goal, where there is one: `hp` with the true goal is `hp_true`."""
        special = f"{self.helper}_{self.goal}"
        return special if special in HELPERS else self.helper

    def players(
        self,
        which: Challenge,
        goal: Goal,
        helper_goal: Goal | None,
        knowledge: Knowledge,
        helped: bool,
        make: Callable[[], MainAgent] | None = None,
        instruction: Callable[[], str] = str,
    ) -> list[Player]:
        """Return new agents for one episode.

        Without a helper where `helped` is False. `make` makes another main agent. `instruction` gives the task as
        somebody says it, to a language model that does it.
        """
        allowed = which.allowed(knowledge)
        known = HELPERS.get(self.helper)
        name = known.main if helped and known and known.main else self.main
        main: Any = make() if make else self._main(name, which, instruction)
        found = [Player(Guarded(main, 0, allowed, self._time(name), which.messages), goal, partial_of(main))]
        if helped and self.helper != NOBODY:
            agent: Agent = known.make(main) if known else self._own(self.helper, which)
            guarded = Guarded(agent, 1, allowed, self._time(self.helper), which.messages)
            found.append(Player(guarded, helper_goal, partial_of(agent)))
        return found

    def _time(self, name: str) -> float:
        """Return the seconds that an agent may think about a tick."""
        return WAITING if is_model(name) else self.seconds

    def _main(self, name: str, which: Challenge, instruction: Callable[[], str]) -> Agent:
        """Return the agent that acts: one of ours, a language model, the user's own, or a program."""
        if is_model(name):
            return player_of(name, self.asking, self.means, instruction(), which.messages, 0)
        if name in MAIN:
            return MAIN[name](which.goals_in)
        if not is_own(name):
            return CommandAgent(name, self.seconds, which.messages)
        own = self._own(name, which)
        with refusing(name):
            if not hasattr(own, "subgoal"):
                with suppress(AttributeError):  # a class with slots: helpers that ask for its subgoal then say so
                    own.subgoal = None  # type: ignore[attr-defined]
        return own

    def _own(self, place: str, which: Challenge) -> Agent:
        """Return an agent that is made without its partner: one that does not know the goal, or the user's own."""
        if place in ONLINE:
            return ONLINE[place].make(which.goals_in)
        if is_model(place):
            return player_of(place, self.asking, self.means, "", which.messages, 1)
        made = load(place)
        with refusing(place):
            own: Agent = made()
            lacking = [f"`{name}`" for name in ("reset", "act") if not callable(getattr(own, name, None))]
        if lacking:
            message = f"{place} has no {' and '.join(lacking)}"
            suggestion = "write reset(self, observation, goal, seed) and act(self, observation, legal)"
            raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion=suggestion)
        return own


def is_own(place: str) -> bool:
    """Return whether a text names a class in a file: `FILE.py:CLASS`."""
    file, _, name = place.rpartition(":")
    return file.endswith(".py") and name.isidentifier()


def partial_of(agent: Any) -> bool | None:
    """Return whether an agent sees only the part around it, for `Player`.

    Our oracles see everything, near-sighted agents never do; the challenge decides for all others.
    """
    with refusing("near_sighted"):
        ours = type(agent).__module__.startswith("hearth.agents.")
        if getattr(agent, "near_sighted", False):
            return True
    return False if ours and agent.__dict__.get("habits") is not None and agent.habits.sees_all else None


def _unknown(what: str, name: str, known: Any) -> HearthError:
    return HearthError.of(Code.BAD_ARGUMENT, f"there is no {what} `{name[:60]}`", suggestion=", ".join(known))


def need_class(place: str) -> None:
    """Run a user's file in another process, to see that it has the class: what it does there ends nothing here.

    Raises:
        HearthError: as of `load`; BAD_ARGUMENT: it ended its process.
    """
    try:
        with none_left():
            list(spread(_loaded, [place], 1, apart=True))
    except BrokenProcessPool as error:
        message = f"{place}: its process ended while the file was run"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="end no process in it") from error


def _loaded(place: str) -> None:
    with StandardDescriptors():
        load(place)


def load(place: str) -> Any:
    """Return the class of a user's own agent, named as on the command line: `FILE.py:CLASS`.

    Raises:
        HearthError: MISSING_FILE; BAD_ARGUMENT: the file has no such class, or does not run.
    """
    file, _, name = place.rpartition(":")
    path = Path(file)
    if not path.is_file():
        raise HearthError.of(Code.MISSING_FILE, f"there is no file `{file}`", suggestion="FILE.py:CLASS")
    spec = importlib.util.spec_from_file_location(f"agent_{path.stem}", path)
    if spec is None or spec.loader is None:
        raise HearthError.of(Code.BAD_ARGUMENT, f"`{file}` is not Python", suggestion="FILE.py:CLASS")
    module = importlib.util.module_from_spec(spec)
    say_unraisable()
    with refusing(place):
        spec.loader.exec_module(module)
    found = getattr(module, name, None)
    if not callable(found):
        classes = ", ".join(
            f"`{value.__name__}`"
            for value in vars(module).values()
            if isinstance(value, type) and value.__module__ == module.__name__
        )
        suggestion = f"its classes: {classes}" if classes else "write a class in it"
        raise HearthError.of(Code.BAD_ARGUMENT, f"`{file}` has no class `{name}`", suggestion=suggestion)
    return found
