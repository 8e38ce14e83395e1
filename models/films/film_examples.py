"""Films as examples for a writer of programs: what a classifier says of their clips, and what is done in them."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from hearth.models.films.clip_data import Clips
from hearth.models.films.clip_probabilities import ClipProbabilities, of_film
from hearth.models.films.film_executions import shown_films
from hearth.models.films.seen_model import TrainedSeenModel
from hearth.models.interface import Steps
from hearth.simulation.world.world import World

if TYPE_CHECKING:
    from hearth.datasets.dataset import Dataset


class FilmExample(NamedTuple):
    """A film with its program.

    Attributes:
        execution: its id.
        clips: what a classifier says of its clips: all that a writer reads.
        steps: what is done, by the classes of its objects.
        world: at its start.
    """

    execution: str
    clips: ClipProbabilities
    steps: Steps
    world: World


def film_examples(dataset: Dataset, part: str, reader: TrainedSeenModel, most: int = 0) -> list[FilmExample]:
    """The films of a part; each is read once.

    Args:
        dataset: with clips.
        part: of the clips.
        reader: the classifier.
        most: films at most; 0 for all.

    Raises:
        HearthError: errors of `Clips.of`.
    """
    clips = Clips.of(dataset, part, most)
    shown = shown_films(dataset, clips.executions)
    return [
        FilmExample(name, of_film(reader, masks), each.steps, each.world)
        for name, masks, each in zip(clips.executions, clips.films, shown, strict=True)
    ]
