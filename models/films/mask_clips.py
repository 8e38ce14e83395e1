"""Clips as features of each class in their frames: the arrays that `mask_clip_network` reads."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from hearth.models.films.clip_data import Clip, Clips
from hearth.models.films.mask_features import NUMBERS, SeenFilm, seen_film
from hearth.models.films.object_class_properties import ClassTable
from hearth.storage.parallel import Seen, unseen

MOST_SEEN = 40
"""Classes of a clip at most; of more, those that are nearest to the person or largest."""

CONTEXT = (6, 9, 12, 16, 20, 25, 30)
"""Frames before and after a clip that are looked at for its context, counted from its middle: up to seven seconds."""


class SeenClips(NamedTuple):
    """The features of N clips of F frames, with T frames of context: T is F where there is none.

    Attributes:
        classes: (N, K) rows of the class table; 0 fills up.
        numbers: (N, K, T, NUMBERS) of each class, see `mask_features`; 0 before and after the film.
        people: (N, T, PEOPLE) of the person.
        crops: (N, F, CROP, CROP) rows of the class table around the person.
    """

    classes: NDArray[np.int16]
    numbers: NDArray[np.float16]
    people: NDArray[np.float16]
    crops: NDArray[np.int16]

    def part(self, which: NDArray[np.int64] | slice) -> SeenClips:
        """Return some of the clips."""
        return SeenClips(*(getattr(self, name)[which] for name in self._fields))


def joined(parts: Sequence[SeenClips]) -> SeenClips:
    """Return the clips of several parts, one after another."""
    if len(parts) == 1:
        return parts[0]  # half a gigabyte is not copied
    return SeenClips(*(np.concatenate(columns) for columns in zip(*parts, strict=True)))


def offsets(frames: int, context: bool) -> NDArray[np.int64]:
    """Return (T,) the frames of a clip and of its context, from the clip's first."""
    around = sorted([-each for each in CONTEXT] + [*CONTEXT]) if context else []
    return np.array([*range(frames), *(frames // 2 + each for each in around)], np.int64)


def seen_clips(clips: Clips, table: ClassTable, context: bool = False, report: Seen = unseen) -> SeenClips:
    """Return the features of clips, in their order; each film is read once.

    Args:
        clips: in the order of their films.
        table: of the classes.
        context: look at frames before and after each clip, too.
        report: reports progress: films.
    """
    found = []
    for done, (film, group) in enumerate(groupby(clips.clips, key=lambda clip: clip.film), 1):
        seen = seen_film(clips.films[film], table.person)
        found += [*_clips(seen, [*group], clips.frames, table, offsets(clips.frames, context))]
        report(done, len(clips.films))
    return SeenClips(*(np.stack(columns) for columns in zip(*found, strict=True)))


def _clips(
    seen: SeenFilm, clips: list[Clip], frames: int, table: ClassTable, taken: NDArray[np.int64]
) -> Iterator[SeenClips]:
    rows = table.rows[seen.classes].astype(np.int16)
    known = rows > 0
    crops = table.rows[seen.crops].astype(np.int16)
    for clip in clips:
        places = clip.first + taken
        inside = (places >= 0) & (places < len(seen.people))
        places = np.where(inside, places, 0)
        people = seen.people[places] * inside[:, None]
        numbers = (seen.numbers[places] * inside[:, None, None]).transpose(1, 0, 2)  # (C, T, NUMBERS)
        worth = (numbers[..., 0] * (1 - numbers[..., 8] + numbers[..., 1])).max(1) * known
        order = np.argsort(-worth.astype(np.float64), kind="stable")[:MOST_SEEN]
        order = order[worth[order] > 0]
        classes = np.zeros(MOST_SEEN, np.int16)
        classes[: len(order)] = rows[order]
        full = np.zeros((MOST_SEEN, len(taken), NUMBERS), np.float16)
        full[: len(order)] = numbers[order]
        yield SeenClips(classes, full, people, crops[clip.first : clip.first + frames])
