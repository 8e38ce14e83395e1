"""An episode in text for the hubs of other projects: asked for with plain values, and answered with plain values.

Doors over it (`hearth serve --text`, `hearth mcp`, the packages of `adapters/`) only translate: this module checks
values, and decides which facts a turn has.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from hearth.envs.session import MOST_SEED, HomeOpening, opening
from hearth.envs.text_homes import TextHome, TextHomes
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

if TYPE_CHECKING:
    from hearth.challenges.tasks import Task
    from hearth.simulation.world.home import Home

EXAMPLE = "wah:train, household:train:20, or a file of `hearth challenge tasks`"
"""Sources of tasks, for remedies."""

MOST_GOAL = 2_000
"""Characters of a goal."""


@dataclass(frozen=True)
class EpisodeTurn:
    """The state of an episode after a reset or a command, in values that JSON has.

    Attributes:
        observation: the words of the protocol.
        reward: of the ticks of the last command.
        total: of all ticks.
        won: whether the goal is reached.
        truncated: whether time is over and the goal is not reached.
        goal_fraction: the part of the goal that is reached, 0 to 1; 0 once a ban of it was broken.
        broken: the bans of the goal that were broken; then it can't be reached any longer.
        ticks: how many have passed.
        faults: how many commands were refused.
        fault: the reason for the last refusal (`code`, `message`, `remedy`), or None.
        turn: how many commands were given.
        task: its identifier.
        protocol: the fingerprint of the words.
    """

    observation: str
    reward: float
    total: float
    won: bool
    truncated: bool
    goal_fraction: float
    broken: tuple[str, ...]
    ticks: int
    faults: int
    fault: dict[str, str] | None
    turn: int
    task: str
    protocol: str

    @property
    def done(self) -> bool:
        """Return whether no command can follow."""
        return self.won or self.truncated

    def as_json(self) -> dict[str, Any]:
        """Return all fields, and `done`."""
        return {**vars(self), "done": self.done}


class TextEpisode:
    """One world that is played in text, by programs that send plain values.

    Args:
        home: the name of one of our homes; with `goal`.
        goal: the goal as text.
        tasks: instead of both: tasks of which a seed draws one, or their source (see `text_tasks`).
        options: as of `hearth.TextHome`: protocol, reward, travel, limit, actions, expert, knowledge.

    Attributes:
        instructions: how to act, for the first message to a language model.
        fingerprint: digest of the protocol.

    Raises:
        HearthError: UNKNOWN_HOME, BAD_ARGUMENT, and the faults of a goal's text.

    Examples:
        >>> episode = hearth.TextEpisode("maple", "HOLDS(agent, milk)")
        >>> turn = episode.reset(seed=1)
        >>> episode.step("fly").fault["code"]
        'UNKNOWN_ACTION'
    """

    def __init__(
        self, home: str = "", goal: str = "", tasks: str | Sequence[Task] | None = None, **options: Any
    ) -> None:
        self._turn: EpisodeTurn | None = None
        self._admissible: Sequence[str] = ()
        self._expert = ""
        self._homes: TextHomes | None = None
        self._home: TextHome | None = None
        if tasks is None:
            self._home = TextHome(home_opening(home, goal), **options)
            self._count = 0
        elif home or goal:
            message = "`tasks` and a home with a goal are both given"
            raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="give one of the two")
        else:
            found = text_tasks(tasks) if isinstance(tasks, str) else tuple(tasks)
            self._homes = TextHomes(found, worlds=1, **options)
            self._count = len(found)

    @property
    def instructions(self) -> str:
        """Return how to act."""
        return (self._homes or self._home).instructions  # type: ignore[union-attr]

    @property
    def fingerprint(self) -> str:
        """Return the digest of the protocol."""
        return (self._homes or self._home).fingerprint  # type: ignore[union-attr]

    def reset(self, seed: object = 0, index: object = None) -> EpisodeTurn:
        """Begin anew.

        Args:
            seed: draws the task, or the place where the agent stands.
            index: of a task, instead of a seed.

        Raises:
            HearthError: BAD_ARGUMENT: not a whole number from 0 to `MOST_SEED`; no task of that index.
        """
        number = checked_seed(seed)
        if self._home is not None:
            if index is not None:
                message = "`index` is given, and there are no tasks to choose from"
                raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="give `seed`")
            text, info = self._home.reset(number)
        else:
            assert self._homes is not None
            chosen = None if index is None else [_whole(index, "index", self._count - 1)]
            texts, infos = self._homes.reset(indices=chosen, seeds=[number] if chosen is None else None)
            text, info = texts[0], infos[0]
        return self._taken(text, info, 0.0, truncated=False)

    def step(self, action: object) -> EpisodeTurn:
        """Give the world a command, in any form of the protocol; what is not understood is a fault of the turn.

        Raises:
            HearthError: OUT_OF_ORDER: before `reset`, or after the end.
        """
        before = self.turn
        if before.done:
            message = f"the episode of {before.task} is over"
            raise HearthError.of(Code.OUT_OF_ORDER, message, suggestion="reset it, or close it")
        given: Any = action  # a value that is no text is a fault of the turn
        if self._home is not None:
            text, reward, _, truncated, info = self._home.step(given)
        else:
            assert self._homes is not None
            texts, rewards, _, cut, infos = self._homes.step([given])
            text, reward, truncated, info = texts[0], rewards[0], cut[0], infos[0]
        return self._taken(text, info, reward, truncated=truncated)

    @property
    def turn(self) -> EpisodeTurn:
        """Return the last turn.

        Raises:
            HearthError: OUT_OF_ORDER: before `reset`.
        """
        if self._turn is None:
            raise HearthError.of(Code.OUT_OF_ORDER, "the episode has not begun", suggestion="reset it first")
        return self._turn

    @property
    def admissible(self) -> list[str]:
        """Return all legal commands; after the end, none.

        Raises:
            HearthError: OUT_OF_ORDER: before `reset`.
        """
        return [] if self.turn.done else list(self._admissible)

    @property
    def expert(self) -> str:
        """Return the next command of an agent that sees everything.

        Raises:
            HearthError: OUT_OF_ORDER: before `reset`; BAD_ARGUMENT: the episode was made without `expert=True`.
        """
        if self.turn and not self._expert:
            message = "the episode has no expert"
            raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="make it with `expert=True`")
        return self._expert

    def _taken(self, text: str, info: dict[str, Any], reward: float, *, truncated: bool) -> EpisodeTurn:
        begun, before = info["ticks"] == 0, self._turn
        self._admissible, self._expert = info["admissible"], info.get("expert", "")
        self._turn = EpisodeTurn(
            observation=text,
            reward=float(reward),
            total=float(reward) if begun or before is None else before.total + float(reward),
            won=info["won"],
            truncated=truncated,
            goal_fraction=float(info["goal_fraction"]),
            broken=tuple(info["broken"]),
            ticks=info["ticks"],
            faults=info["faults"],
            fault=info["fault"],
            turn=0 if begun or before is None else before.turn + 1,
            task=info["id"],
            protocol=info["protocol"],
        )
        return self._turn


def home_opening(home: object, goal: object) -> HomeOpening:
    """Return the starts of episodes in one of our homes.

    Raises:
        HearthError: UNKNOWN_HOME; BAD_ARGUMENT: no goal, or a goal that is too long; the faults of a goal's text.
    """
    place = home_named(home)
    if not isinstance(goal, str) or not goal.strip() or len(goal) > MOST_GOAL:
        message = f"`goal` is not a text of 1 to {MOST_GOAL:,} characters"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion='"HOLDS(agent, milk)"')
    return _opening(place, goal)


@lru_cache(maxsize=256)
def _opening(home: Home, goal: str) -> HomeOpening:
    return opening(home, goal, agents=1)


def home_named(name: object) -> Home:
    """Return one of our homes for a stranger: the name is never read as a path.

    Raises:
        HearthError: UNKNOWN_HOME.
    """
    from hearth.homes.library import names

    if not isinstance(name, str) or name not in names():
        message = f"there is no home `{str(name)[:40]}`"
        raise HearthError.of(Code.UNKNOWN_HOME, message, suggestion=f"one of {', '.join(names())}")
    return _home(name)


@lru_cache(maxsize=16)
def _home(name: str) -> Home:
    """Return a home once for all episodes in it, which then share its words and ways."""
    from hearth.homes.library import named_graph
    from hearth.kb.loading.load import default
    from hearth.simulation.world.home import Home

    title, graph = named_graph(name, default())
    return Home.from_graph(graph, title, default())


@lru_cache(maxsize=16)
def text_tasks(source: str) -> tuple[Task, ...]:
    """Return the tasks of a source.

    Args:
        source: `CHALLENGE:SPLIT`, with `:N` for the first N, or a file of `hearth challenge tasks`. A file is opened:
            the source must come from the user of this machine.

    Raises:
        HearthError: BAD_ARGUMENT: no such challenge or split; `household` without a number, which takes a second a
            task; the faults of a file.
    """
    from hearth.challenges.household_definition import NAME as HOUSEHOLD
    from hearth.challenges.task_files import read, suite

    name, colon, rest = source.partition(":")
    if not colon or Path(source).is_file():
        return read(Path(source)).tasks
    split, _, number = rest.partition(":")
    if number and (not number.isdecimal() or int(number) < 1):
        raise HearthError.of(Code.BAD_ARGUMENT, f"`{number[:40]}` is not a number of tasks", suggestion=EXAMPLE)
    if name == HOUSEHOLD and not number:
        message = f"`{source[:80]}` draws all tasks, a second each"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion=f"{source[:80]}:20")
    return suite(name, split, limit=int(number) if number else None).tasks


def checked_seed(value: object) -> int:
    """Return the seed of a stranger.

    Raises:
        HearthError: BAD_ARGUMENT.
    """
    return _whole(value, "seed", MOST_SEED)


def _whole(value: object, name: str, most: int) -> int:
    """Return a whole number of a stranger.

    Raises:
        HearthError: BAD_ARGUMENT.
    """
    if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value <= most:
        message = f"`{name}` is {str(value)[:40]!r}, not a whole number from 0 to {most}"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion=f"{name}=0")
    return value
