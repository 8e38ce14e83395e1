"""Features of each class and of the person in masks, frame by frame, as numbers independent of the picture's size.

Lengths are heights of the person where they are about the person, halves of the picture where they are places in it.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

NUMBERS = 14
"""Number of features of a class in a frame, see `_numbers`."""

PEOPLE = 9
"""Number of features of the person in a frame, see `_person`."""

CROP = 20
"""Width and height of the array of the area around the person, cells."""

AROUND = 0.65
"""Half the width of the area around the person, as a multiple of the person's height or width (the greater)."""

REACH = 0.03
"""Largest distance at which a pixel counts as touching the person, as a share of the picture's height."""


class SeenFilm(NamedTuple):
    """A film's frames as numbers.

    Attributes:
        classes: (C,) class numbers that some frame shows, without 0 and the person.
        numbers: (T, C, NUMBERS) of each class; 0 where a frame does not show it.
        people: (T, PEOPLE) of the person; 0 where a frame does not show it.
        crops: (T, CROP, CROP) class numbers around the person; 0 where a frame does not show it.
    """

    classes: NDArray[np.uint16]
    numbers: NDArray[np.float16]
    people: NDArray[np.float16]
    crops: NDArray[np.uint16]


def seen_film(masks: NDArray[np.uint16], person: int) -> SeenFilm:
    """Return the features of a film.

    Args:
        masks: (T, H, W) class numbers.
        person: class number of people.
    """
    classes, place = np.unique(masks, return_inverse=True)
    place = place.reshape(masks.shape)
    kept = np.flatnonzero((classes != 0) & (classes != person))
    rows, people, crops = [], [], []
    before: NDArray[np.int64] | None = None
    for mask, frame in zip(masks, place, strict=True):
        body = mask == person
        who = _person(body, 0.0 if before is None else float(np.mean(before != frame)))
        rows.append(_numbers(frame, len(classes), body, who, before)[kept])
        people.append(who)
        crops.append(_crop(mask, who))
        before = frame
    return SeenFilm(classes[kept], np.stack(rows).astype(np.float16), np.stack(people).astype(np.float16),
                    np.stack(crops))  # fmt: skip


def _person(body: NDArray[np.bool_], changed: float) -> NDArray[np.float64]:
    """Return the person's features.

    Visible, left, right, top, bottom, middle (x, y), share of the picture; share that changed.
    """
    height, width = body.shape
    found = np.zeros(PEOPLE)
    found[8] = changed
    if not body.any():
        return found
    ys, xs = np.nonzero(body)
    x, y = 2 * (xs + 0.5) / width - 1, 2 * (ys + 0.5) / height - 1
    found[:8] = 1.0, x.min(), x.max(), y.min(), y.max(), x.mean(), y.mean(), 4 * body.mean()
    return found


def _size(who: NDArray[np.float64], shape: tuple[int, ...]) -> float:
    """Return the person's height or width in pixels, whichever is greater."""
    height, width = shape
    return max(float(who[4] - who[3]) * height / 2, float(who[2] - who[1]) * width / 2, 2.0)


class _Frame(NamedTuple):
    """A frame's pixels: their places in a list of classes, the order that sorts those places, and (x, y) of each."""

    classes: int
    flat: NDArray[np.int64]
    order: NDArray[np.int64]
    xs: NDArray[np.int64]
    ys: NDArray[np.int64]
    area: NDArray[np.float64]

    @classmethod
    def of(cls, places: NDArray[np.int64], count: int) -> _Frame:
        flat = places.ravel()
        ys, xs = np.divmod(np.arange(flat.size), places.shape[1])
        order = np.argsort(flat.astype(np.uint16), kind="stable")  # of few bits: sorted by their digits
        return cls(count, flat, order, xs, ys, np.bincount(flat, minlength=count).astype(np.float64))

    def sums(self, values: NDArray[Any]) -> NDArray[np.float64]:
        """Return (count,) the sum over each class's pixels."""
        return np.bincount(self.flat, values, self.classes).astype(np.float64)

    def ends(self, values: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
        """Return the least and the greatest over the pixels of each class that is there."""
        given = values[self.order]
        starts = (np.cumsum(self.area) - self.area).astype(np.int64)[self.area > 0]
        return np.minimum.reduceat(given, starts), np.maximum.reduceat(given, starts)


def _numbers(
    places: NDArray[np.int64],
    count: int,
    body: NDArray[np.bool_],
    who: NDArray[np.float64],
    before: NDArray[np.int64] | None,
) -> NDArray[np.float64]:
    """Return (count, NUMBERS) of each class in a frame of their places in a list.

    The numbers are: whether the class is visible; the root of its share of the picture; its middle (x, y); its width
    and height; its offset (x, y) from the person's middle; its distance from the person; the root of the area that
    touches the person; the point (x, y) on the person where it is nearest; the share that has changed; and its growth
    since the previous frame.
    """
    height, width = places.shape
    frame = _Frame.of(places, count)
    some, full = frame.area > 0, np.maximum(frame.area, 1)
    x, y = (frame.sums(values + 0.5) / full for values in (frame.xs, frame.ys))
    found = np.zeros((count, NUMBERS))
    found[:, 0] = some
    found[:, 1] = np.sqrt(frame.area / body.size)
    found[:, 2], found[:, 3] = 2 * x / width - 1, 2 * y / height - 1
    for column, values, size in ((4, frame.xs, width), (5, frame.ys, height)):
        least, greatest = frame.ends(values)
        found[some, column] = (greatest - least + 1) / size
    if who[0]:
        found[:, 6:12] = _beside(frame, x, y, body, who)
    if before is not None:
        old = np.bincount(before.ravel(), minlength=count)
        same = np.bincount(frame.flat[frame.flat == before.ravel()], minlength=count)
        found[:, 12] = 1 - same / np.maximum(frame.area + old - same, 1)
        found[:, 13] = (frame.area - old) / np.maximum(frame.area + old, 1)
    found[~some] = 0.0
    return found


def _beside(
    frame: _Frame, x: NDArray[np.float64], y: NDArray[np.float64], body: NDArray[np.bool_], who: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return (count, 6) positions of each class, with its middle at (x, y), relative to the person."""
    from scipy.ndimage import distance_transform_edt

    height, width = body.shape
    size, middle = _size(who, body.shape), ((who[5] + 1) * width / 2, (who[6] + 1) * height / 2)
    far = distance_transform_edt(~body).ravel() / height
    found = np.zeros((frame.classes, 6))
    found[:, 0], found[:, 1] = ((a - b) / size for a, b in zip((x, y), middle, strict=True))
    found[frame.area > 0, 2] = frame.ends(far)[0]
    found[:, 3] = np.sqrt(frame.sums(far <= REACH) / size)
    weight = np.exp(-far / REACH) + 1e-9
    total = np.maximum(frame.sums(weight), 1e-12)
    for column, values, centre in ((4, frame.xs, middle[0]), (5, frame.ys, middle[1])):
        found[:, column] = (frame.sums(weight * values) / total - centre) / size
    return np.clip(found, -3, 3)


def _crop(mask: NDArray[np.uint16], who: NDArray[np.float64]) -> NDArray[np.uint16]:
    """Return (CROP, CROP) class numbers around the person, the nearest of each cell's middle.

    Cells outside of the picture are 0.
    """
    if not who[0]:
        return np.zeros((CROP, CROP), np.uint16)
    height, width = mask.shape
    middle = (who[1] + who[2] + 2) * width / 4, (who[3] + who[4] + 2) * height / 4
    offsets = ((np.arange(CROP) + 0.5) / CROP * 2 - 1) * AROUND * _size(who, mask.shape)
    xs, ys = (np.floor(centre + offsets).astype(np.int64) for centre in middle)
    inside = ((ys >= 0) & (ys < height))[:, None] & ((xs >= 0) & (xs < width))[None]
    found = mask[np.clip(ys, 0, height - 1)[:, None], np.clip(xs, 0, width - 1)[None]]
    return np.where(inside, found, 0).astype(np.uint16)
