"""Programs of four bands of LCS for people to judge (thesis 4.6, figure 4-9): a model's, or damaged ones."""

from collections.abc import Iterator
from pathlib import Path
from random import Random
from typing import NamedTuple

from hearth.analysis import synthesis
from hearth.grounding.environments.sampling import sample
from hearth.homes.library import load_graph
from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code, Failure
from hearth.schemas.program import Program, Step
from hearth.schemas.rng import derive, rng
from hearth.schemas.syntax import parse_program, print_lines
from hearth.scoring.line_sequences import steps_of
from hearth.scoring.metrics.lcs import score
from hearth.scoring.predictions import read_pairs
from hearth.simulation.engine import Execution
from hearth.simulation.world.home import Home
from hearth.studies.films_to_judge import JudgedFilm
from hearth.studies.study import Band, Study

HOMES = ("rowan", "willow")
"""The homes in which programs are filmed: the homes of testing."""

DRAWN = 600
"""Synthetic programs that are drawn, of which those that fit are damaged."""

TRIES = 40
"""Changes that are tried to bring a program into its band."""


class Written(NamedTuple):
    """A program that was written for a description.

    Attributes:
        program: with title and description.
        lcs: normalised LCS of its steps with those of the description's own program.
    """

    program: Program
    lcs: float


def judged_programs(study: Study, knowledge: Knowledge, predictions: Path | None = None) -> list[JudgedFilm]:
    """Return as many programs of each band as the study asks for; only those that run in a home of testing.

    Args:
        study: its films' bands.
        knowledge: of actions and objects.
        predictions: a file of a model's, as `score` reads it, with `title` and `description`; where None, programs of
            SyntheticPrograms in which steps were left out and put in at random.

    Raises:
        HearthError: EMPTY: a band has too few; every fault of the predictions.
    """
    films = study.films
    assert films is not None
    homes = [Home.from_graph(load_graph(name, knowledge), name, knowledge) for name in HOMES]
    found: dict[str, list[JudgedFilm]] = {band.name: [] for band in films.bands}
    for number, one in enumerate(_predicted(predictions) if predictions else _damaged(study, knowledge)):
        band = next((each for each in films.bands if each.holds(one.lcs)), None)
        if band is None or len(found[band.name]) == films.each:
            continue
        home = homes[number % len(homes)]
        if execution_in(one.program, home, study.seed) is not None:
            found[band.name].append(_film(study, band, len(found[band.name]), one, home.name))
    for band in films.bands:
        if len(found[band.name]) < films.each:
            message = f"band `{band.name}` has {len(found[band.name])} programs that run, not {films.each}"
            raise HearthError.of(Code.EMPTY, message, suggestion="ask for fewer, or give more predictions")
    return sorted((film for some in found.values() for film in some), key=lambda film: film.item)


def _film(study: Study, band: Band, turn: int, one: Written, home: str) -> JudgedFilm:
    assert study.films is not None
    item = turn * len(study.films.bands) + study.films.bands.index(band)
    about = f"{one.program.title}: {one.program.description}"
    name, lines = f"{item:03d}-{band.name}", list(print_lines(one.program))
    return JudgedFilm(item, study.conditions[0].name, name, band.name, about, home, round(one.lcs, 6), lines)


def execution_in(program: Program, home: Home, seed: int) -> Execution | None:
    """Return a program's execution in an environment that is drawn for it; None where it does not run in the home."""
    found = sample(program, home, seed, program.title)
    return None if isinstance(found, Failure) else found[1]


def program_of(film: JudgedFilm) -> Program:
    """Return the program of a film."""
    title, _, description = film.about.partition(": ")
    return Program(
        title=title, description=description, steps=parse_program("\n".join([title, "", *film.content]))[0].steps
    )


def _predicted(path: Path) -> Iterator[Written]:
    for pair in read_pairs(path):
        steps = steps_of(pair.predicted or ())
        if steps:
            title, description = str(pair.more.get("title", pair.id)), str(pair.more.get("description", ""))
            lcs = score(steps, pair.reference).step
            yield Written(Program(title=title, description=description, steps=steps), lcs)


def _damaged(study: Study, knowledge: Knowledge) -> Iterator[Written]:
    """Synthetic programs, each changed until it is in a band; bands come in turn."""
    assert study.films is not None
    grammar = synthesis.load(synthesis.FILE, knowledge)
    drawn = list(synthesis.synthesize(DRAWN, derive(study.seed, "judged programs"), grammar, 1))
    programs = [parse_program("\n".join([each.title, "", "", *each.lines()]))[0] for each in drawn]
    bands = study.films.bands
    for number, (each, program) in enumerate(zip(drawn, programs, strict=True)):
        chooser = rng(study.seed, "damaged", number)
        steps = _in_band(program.steps, programs[number - 1].steps, bands[number % len(bands)], chooser)
        if steps:
            lcs = score(steps, program.steps).step
            yield Written(Program(title=each.title, description=each.descriptions[0], steps=steps), lcs)


def _in_band(steps: tuple[Step, ...], others: tuple[Step, ...], band: Band, chooser: Random) -> tuple[Step, ...]:
    """Return steps with some left out and some of another program put in, until their LCS is in a band.

    () if it never is.
    """
    now = list(steps)
    for _ in range(TRIES):
        if now and band.holds(score(tuple(now), steps).step):
            return tuple(now)
        place = chooser.randrange(len(now) + 1)
        if len(now) > 2 and chooser.random() < 0.5:
            del now[min(place, len(now) - 1)]
        else:
            now.insert(place, chooser.choice(others))
        if score(tuple(now), steps).step < band.low:
            now = list(steps)
    return ()
