"""Table 4.6: programs from films, with the thesis's figures, ours and yardsticks."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from hearth.datasets.dataset import Dataset
from hearth.models.evaluation import by_group
from hearth.models.films.clip_data import Clips
from hearth.models.films.clip_probabilities import ClipProbabilities
from hearth.models.films.clip_result_tables import HOMES, looks_at_masks, standard_error
from hearth.models.films.film_contents import Shown, by_class, shown_films
from hearth.models.films.film_prediction import cut
from hearth.models.films.film_programs import FilmProgram, alone, described, followed
from hearth.models.films.film_training_examples import film_probabilities
from hearth.models.films.film_writer import TrainedFilmWriter
from hearth.models.films.mask_clip_model import TrainedSeenModel
from hearth.models.films.possible_instructions import Reading
from hearth.models.films.step_order import StepOrder, programs_of
from hearth.models.interface import Steps
from hearth.models.model_registry import restore
from hearth.repair.runnable_predictions import complete
from hearth.schemas.program import ObjectRef, Step
from hearth.schemas.rng import rng
from hearth.scoring.bootstrap import Interval
from hearth.scoring.dataset_scores import score_steps
from hearth.scoring.metrics.lcs import score_pairs
from hearth.scoring.prediction_scores import METRICS
from hearth.simulation.world.world import World
from hearth.storage.parallel import Seen, unseen

TABLE = "4.6"

COLUMNS = ("action", "object", "step", "mean", "executable", "goal", "goal_whole")

THESIS = {
    ("Random retrieval", "all"): (0.473, 0.079, 0.071, 0.207, 1.0),
    ("MLE", "all"): (0.735, 0.359, 0.341, 0.478, 0.194),
    ("PG(LCS)", "all"): (0.761, 0.383, 0.364, 0.502, 0.190),
    ("PG(LCS+Sim)", "all"): (0.751, 0.377, 0.358, 0.495, 0.224),
    ("PG(LCS+Sim)", "seen"): (0.851, 0.556, 0.528, 0.645, 0.246),
    ("PG(LCS+Sim)", "unseen"): (0.680, 0.250, 0.236, 0.389, 0.209),
}


class FilmRow(NamedTuple):
    """A method's scores in some homes.

    Attributes:
        method: its name.
        of: `thesis`, `yardstick` or `ours`.
        homes: of `clip_tables.HOMES`.
        scores: by column; ours have intervals, for which activities are drawn with replacement.
        films: how many; None where the thesis does not say.
        seeds: how many trained models the scores are means of.
        spread: the standard error over seeds of `mean`; None of fewer than two.
    """

    method: str
    of: str
    homes: str
    scores: Mapping[str, Interval | float]
    films: int | None = None
    seeds: int = 0
    spread: float | None = None


Way = Callable[[Reading, StepOrder, World], FilmProgram]


def _repaired(program: FilmProgram, world: World) -> FilmProgram:
    """Return a program that runs: repaired, without steps that no repair makes run; inserted steps have no clips."""
    done = complete(program.steps, world, world.home.knowledge)
    return FilmProgram(done.execution.program.steps, ())


WAYS: dict[str, Way] = {
    "each clip alone": lambda found, order, world: alone(found.scores, found.instructions),
    "Viterbi": lambda found, order, world: described(found.scores, found.instructions),
    "Viterbi, order of steps": lambda found, order, world: described(
        found.scores, found.instructions, found.moves(order)
    ),
    "Viterbi, order of steps, repaired": lambda found, order, world: _repaired(
        described(found.scores, found.instructions, found.moves(order)), world
    ),
    "engine": lambda found, order, world: followed(found.scores, found.instructions, world),
    "engine, order of steps": lambda found, order, world: followed(
        found.scores, found.instructions, world, found.moves(order)
    ),
}
"""The ways from the reading of a film to a program, by name."""


def film_table(
    dataset: Dataset, models: Sequence[Path | str], seed: int = 0, part: str = "test", beam: int = 1,
    seen: Seen = unseen,
) -> list[FilmRow]:  # fmt: skip
    """Return the rows of table 4.6, over the films of a part, each cut into clips whatever is done in it.

    Args:
        dataset: with clips.
        models: checkpoints of classifiers of clips, and of writers of programs; several of one model are its seeds.
        seed: of yardsticks and intervals.
        part: of the clips.
        beam: programs that a writer follows at once.
        seen: reports progress: films, over all models.

    Raises:
        HearthError: errors of `restore` and of `Clips.of`; BAD_ARGUMENT, for a model of another kind.
    """
    learned, test = Clips.of(dataset, "train"), Clips.of(dataset, part)
    known, films = programs_of(learned), shown_films(dataset, test.executions)
    draw, order = rng(seed, "random films"), StepOrder.of(known)
    rows = [FilmRow(method, "thesis", homes, dict(zip(COLUMNS, values, strict=False)))
            for (method, homes), values in THESIS.items()]  # fmt: skip
    retrieved = [tuple(Step(each.action, tuple(map(ObjectRef, each.objects))) for each in draw.choice(known))
                 for _ in test.executions]  # fmt: skip
    rows += _rows(dataset, "Random retrieval", "yardstick", test, films, [retrieved], seed)
    answers: dict[str, list[list[Steps]]] = {}
    worlds = [film.world for film in films]
    for number, model in enumerate(models):
        name, trained = restore(model)
        if isinstance(trained, TrainedFilmWriter):
            read = film_probabilities(dataset, test, part, 0, trained.reader)
            written = _by_writer(trained, read, worlds, beam)
        else:
            written = _classified(looks_at_masks(trained, name), test, worlds, order)
        for done, found in enumerate(written, number * len(films) + 1):
            for way, steps in found.items():
                answers.setdefault(f"{name}, {way}", [[] for _ in models])[number].append(steps)
            seen(done, len(models) * len(films))
    for method, each in answers.items():
        rows += _rows(dataset, method, "ours", test, films, [found for found in each if found], seed)
    return rows


def _by_writer(
    trained: TrainedFilmWriter, read: Sequence[ClipProbabilities], worlds: Sequence[World], beam: int
) -> Iterator[dict[str, Steps]]:
    """Yield the programs that an encoder-decoder writes for each film, by method."""
    for film, world in zip(read, worlds, strict=True):
        yield by_writer(trained, film, world, beam)


def _classified(
    trained: TrainedSeenModel, test: Clips, worlds: Sequence[World], order: StepOrder
) -> Iterator[dict[str, Steps]]:
    """Yield the programs that a classifier of clips reads from each film, by method."""
    for masks, world in zip(test.films, worlds, strict=True):
        (found,) = trained.readings(cut(masks))
        yield {way: write(found, order, world).steps for way, write in WAYS.items()}


def by_writer(trained: TrainedFilmWriter, film: ClipProbabilities, world: World, beam: int = 1) -> dict[str, Steps]:
    """Return an encoder-decoder's programs for a film: free, repaired, and if possible with the engine in the loop."""
    (steps,) = trained.write([film], beam)
    found = {"free": steps, "free, repaired": _repaired(FilmProgram(steps, ()), world).steps}
    if not trained.closed:
        found["engine"] = trained.followed([film], [world], beam)[0]
    return found


def _rows(
    dataset: Dataset, method: str, of: str, test: Clips, films: Sequence[Shown], answers: Sequence[Sequence[Steps]],
    seed: int,
) -> Iterator[FilmRow]:  # fmt: skip
    """Yield a row for each kind of homes, of the answers of each seed."""
    kinds = {clip.film: clip.kind for clip in test.clips}
    scores = [_scored(dataset, test.executions, films, each) for each in answers]
    for homes, wanted in HOMES.items():
        which = [number for number in range(len(films)) if kinds[number] in wanted]
        values = {name: [_mean([found[number][name] for found in scores]) for number in which] for name in COLUMNS}
        found = by_group(values, [films[number].trial.activity for number in which], seed)
        means = [mean for each in scores if (mean := _mean([each[number]["mean"] for number in which])) is not None]
        yield FilmRow(method, of, homes, found, len(which), len(answers) if of == "ours" else 0, standard_error(means))


def _scored(
    dataset: Dataset, executions: Sequence[str], films: Sequence[Shown], answers: Sequence[Steps]
) -> list[dict[str, float | None]]:
    """Return the columns of each film's answer."""
    lcs = score_pairs([(by_class(answer, film.world), film.steps) for answer, film in zip(answers, films, strict=True)])
    ran = score_steps(dataset, zip(executions, answers, strict=True))
    more = ("executable", "goal", "goal_whole")
    return [
        {"action": one.action, "object": one.object, "step": one.step, "mean": one.mean,
         **{name: METRICS[name](other) for name in more}}
        for one, other in zip(lcs, ran, strict=True)
    ]  # fmt: skip


def _mean(values: Sequence[float | None]) -> float | None:
    given = [value for value in values if value is not None]
    return sum(given) / len(given) if given else None
