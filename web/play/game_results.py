"""Games as results: people's actions, in the files that `challenge verify`, `score` and `build` read."""

from collections.abc import Iterable
from dataclasses import replace

from hearth.challenges.episode_agents import Lineup
from hearth.challenges.episodes import Record
from hearth.challenges.result_files import MOST_SEEDS, Header, Results, first_line, line
from hearth.challenges.task_files import Suite
from hearth.challenges.tasks import Task
from hearth.web.play.games import Game

MAIN = "person"
"""The main agent of people's results."""

Kind = tuple[str, str, str, str]
"""Challenge, split, helper and the helper's goal: those of one file."""


def kind_of(game: Game) -> Kind:
    """Return the file that a game belongs in."""
    trial = game.trial
    return (trial.task.challenge, trial.task.split, trial.helper, trial.goal)


def results(games: Iterable[Game]) -> dict[Kind, Results]:
    """Return the results of games by their kind.

    Of two games of one task with one seed, the later gets the next seed that is free: a seed names an episode.
    """
    found: dict[Kind, list[Game]] = {}
    for game in games:
        found.setdefault(kind_of(game), []).append(game)
    return {kind: _results(kind, some) for kind, some in found.items()}


def _results(kind: Kind, games: list[Game]) -> Results:
    tasks: dict[str, Task] = {game.trial.task.id: game.trial.task for game in games}
    taken: set[tuple[str, int]] = set()
    records: list[Record] = []
    for game in games:
        record = game.record()
        free = (n % MOST_SEEDS for n in range(record.seed, record.seed + MOST_SEEDS))
        seed = next((n for n in free if (record.task, n) not in taken), None)
        if seed is None:  # a file has no room for more games of a task
            continue
        taken.add((record.task, seed))
        records.append(replace(record, seed=seed))
    place = {name: number for number, name in enumerate(tasks)}
    records.sort(key=lambda each: (place[each.task], each.seed))
    suite = Suite(kind[0], kind[1], 0, tuple(tasks.values()))
    keys = tuple((each.task, each.seed, each.helped) for each in records)
    header = Header(suite, Lineup(MAIN, kind[2], kind[3]), 1 + max(each.seed for each in records), episodes=keys)
    return Results(header, tuple(records))


def as_bytes(found: Results) -> bytes:
    """Return a file of results."""
    return b"".join((first_line(found.header), *(line(found.header, each) for each in found.records)))
