"""Films as examples for a writer of programs: a classifier's probabilities for their clips, and their steps."""

from dataclasses import asdict, dataclass, field
from functools import lru_cache
from typing import NamedTuple

from hearth.datasets.dataset import Dataset
from hearth.models.execution_trials import Trial
from hearth.models.films.clip_data import Clips
from hearth.models.films.clip_probabilities import ClipProbabilities, of_film
from hearth.models.films.film_contents import shown_films
from hearth.models.films.mask_clip_model import TrainedSeenModel
from hearth.models.interface import Steps
from hearth.models.text_examples import facts_of
from hearth.storage.files import value_digest


class FilmExample(NamedTuple):
    """A film with its program.

    Attributes:
        execution: its id.
        clips: a classifier's probabilities for its clips: all that a writer reads.
        steps: its steps, by the classes of their objects.
        trial: its execution, in which other programs may be tried.
    """

    execution: str
    clips: ClipProbabilities
    steps: Steps
    trial: Trial


def film_examples(dataset: Dataset, part: str, reader: TrainedSeenModel, most: int = 0) -> list[FilmExample]:
    """Return the films of a part; each is read once.

    Args:
        dataset: with clips.
        part: of the clips.
        reader: the classifier.
        most: films at most; 0 for all.

    Raises:
        HearthError: errors of `Clips.of`.
    """
    clips = Clips.of(dataset, part, most)
    shown, read = shown_films(dataset, clips.executions), film_probabilities(dataset, clips, part, most, reader)
    return [
        FilmExample(name, found, each.steps, each.trial)
        for name, found, each in zip(clips.executions, read, shown, strict=True)
    ]


@dataclass(frozen=True)
class _Question:
    """A classifier and films: alike for equal weights and equal files."""

    dataset: str
    part: str
    most: int
    weights: str
    clips: Clips = field(compare=False)
    reader: TrainedSeenModel = field(compare=False)


def film_probabilities(
    dataset: Dataset, clips: Clips, part: str, most: int, reader: TrainedSeenModel
) -> tuple[ClipProbabilities, ...]:
    """Return a classifier's probabilities for each film of a part.

    It takes two seconds a film, and several writers read the same: a process remembers it.

    Args:
        dataset: with clips.
        clips: its clips of the part.
        part, most: as of `film_examples`.
        reader: the classifier.
    """
    weights = {name: value.cpu().numpy().tobytes().hex() for name, value in reader.network.state_dict().items()}
    about = value_digest([asdict(reader.settings), reader.table.document(), weights])
    return _read(_Question(facts_of(dataset)["digest"], part, most, about, clips, reader))


@lru_cache(maxsize=12)
def _read(asked: _Question) -> tuple[ClipProbabilities, ...]:
    return tuple(of_film(asked.reader, masks) for masks in asked.clips.films)
