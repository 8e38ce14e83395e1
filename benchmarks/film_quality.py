"""Measure what films show: `python benchmarks/film_quality.py [--pairs N] [--seed S] [--no-pictures] [--list]`.

`--episodes FILE` judges N episodes of two agents instead, from a file of results that `challenge run` wrote.

Programs of the embedded corpus, each in the next of our homes. Bodies are judged at ten poses a second, pictures at
two: walks through solids; steps in which the person and what the step is about can be recognised (1.5 % and 0.1 % of
the picture, less than half hidden); pictures with something nearer than 0.7 m that fills 15 %; lengths of shots. With
`--list`, each fault. After `--minutes M` no further pair is begun; the first row says how many were judged.
"""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from statistics import median
from typing import NamedTuple

from measurement import Figure, as_line, finish, parser

from hearth.analysis.episode_figure import ticks_of
from hearth.analysis.random_program_home_pairs import FilmedPair, pairs
from hearth.challenges.episode_executions import execution_of
from hearth.challenges.result_files import read
from hearth.homes.library import load_graph
from hearth.kb.loading.load import default
from hearth.pipelines.build import corpus
from hearth.rendering.film.execution_keyframes import trajectory_of
from hearth.rendering.film.film_measures import FilmQuality, film_quality
from hearth.rendering.film.walks_through_solids import Walk, walks
from hearth.rendering.people.motion import frames
from hearth.schemas.syntax import print_step

POSES = 10.0


def episodes(file: Path) -> Iterator[FilmedPair]:
    """The episodes of a file of results in which two agents act."""
    found = read(file)
    for record in found.records:
        if record.helped:
            task = next(each for each in found.header.suite.tasks if each.id == record.task)
            execution = execution_of(*ticks_of(task, record, default()), task.id)
            if execution.program.steps:
                yield FilmedPair(execution, task.home, load_graph(task.home, default()))


class Judged(NamedTuple):
    """A pair, the walks of its film, and the film's quality."""

    pair: FilmedPair
    walks: list[Walk]
    film: FilmQuality | None


def judged(pair: FilmedPair, seed: int, pictures: bool) -> Judged:
    """Film a pair and judge it."""
    trajectory = trajectory_of(pair.execution, pair.graph, default(), seed=seed)
    found = walks(trajectory.prepared, trajectory.keyframes, frames(trajectory, POSES))
    return Judged(pair, found, film_quality(trajectory, pair.graph) if pictures else None)


def figures(found: list[Judged]) -> list[Figure]:
    """The measures over all pairs."""
    walked = [walk for each in found for walk in each.walks]
    through = [walk for walk in walked if walk.through]
    known = [
        Figure("pairs of a program and a home", len(found), "pairs"),
        Figure("walks", len(walked), "walks"),
        Figure("walks through solids", len(through), "walks", 0),
    ]
    films = [each.film for each in found if each.film]
    if not films:
        return known
    steps = [step for film in films for step in film.steps]
    shots = [length for film in films for length in film.shots]
    pictures, blocked = sum(film.pictures for film in films), sum(film.blocked for film in films)
    each = [share for film in films for share in by_agent(film)]
    return [
        *known,
        Figure("steps", len(steps), "steps"),
        Figure("agents of whose steps a film shows half", 100 * sum(s >= 0.5 for s in each) / len(each), "%", 100),
        Figure("steps shown", 100 * sum(step.shown for step in steps) / len(steps), "%", 95),
        Figure("pictures with something in the way", 100 * blocked / pictures, "%", 2),
        Figure("median shot", median(shots), "s", 3),
        Figure("shots under three seconds", 100 * sum(length < 3 for length in shots) / len(shots), "%"),
    ]


def by_agent(film: FilmQuality) -> list[float]:
    """The share of its steps that a film shows of each agent."""
    agents = sorted({step.step.agent for step in film.steps})
    own = [[step.shown for step in film.steps if step.step.agent == agent] for agent in agents]
    return [sum(shown) / len(shown) for shown in own]


def faults(found: list[Judged]) -> None:
    """Print each fault, and the actions of steps that are not shown."""
    missed: Counter[str] = Counter()
    for pair, walked, film in found:
        for walk in walked:
            if walk.through:
                names = ", ".join(f"{name} ({node})" for node, name in walk.through)
                print(f"through: {pair.home}, {pair.execution.program.title}, tick {walk.tick}: {names}")
        for step in film.steps if film else ():
            if not step.shown:
                print(f"unseen: {pair.home}, {pair.execution.program.title}, {step.tick}. {print_step(step.step)}")
                missed[step.step.action] += 1
        if film and film.blocked:
            print(f"in the way: {pair.home}, {pair.execution.program.title}: {film.blocked} of {film.pictures}")
    print(missed.most_common())


def main() -> None:
    """Print a table."""
    known = parser(__doc__)
    known.add_argument("--pairs", type=int, default=30)
    known.add_argument("--seed", type=int, default=0)
    known.add_argument("--no-pictures", action="store_true")
    known.add_argument("--episodes", type=Path)
    known.add_argument("--list", action="store_true")
    known.add_argument("--minutes", type=float, default=1e9)
    asked = known.parse_args()
    every = pairs([str(path) for path in corpus()], default(), asked.seed)
    drawn = islice(episodes(asked.episodes) if asked.episodes else every, asked.pairs)
    began, found = time.perf_counter(), []
    for pair in drawn:
        found.append(judged(pair, asked.seed, not asked.no_pictures))
        if time.perf_counter() - began > 60 * asked.minutes:
            break
    if asked.list:
        faults(found)
    for figure in figures(found):
        print(as_line(figure))
    finish(figures(found), asked.json)


if __name__ == "__main__":
    main()
