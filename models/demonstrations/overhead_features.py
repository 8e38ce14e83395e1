"""Features of pictures from above, as arrays: of each class relative to the person, and of the area around the person.

The person performs every action. A step is therefore about objects near the person and about changes since the previous
picture. Lengths are pixels of the picture, about four centimeters each.
"""

from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

MOST_SEEN = 16
"""Classes of a picture at most: those that are nearest to the person or have changed most."""

NUMBERS = 10
"""Number of features of a class in a picture, see `_numbers`."""

PEOPLE = 8
"""Number of features of the person in a picture, see `_person`."""

AROUND = 32
"""Half the width of the area that is read around the person, pixels."""

CELLS = 22
"""Width of the masks around the person."""

PIXELS = 32
"""Width of the colours around the person."""

EVERY = 4
"""One of how many pixels of the whole picture is looked at, each way."""

REACH = 3.0
"""Largest distance from the person at which a pixel counts as touching the person, pixels."""

FADES = 8.0
"""The distance from the person at which nearness has fallen to a third."""


Pixel = TypeVar("Pixel", np.uint8, np.uint16)


class Above(NamedTuple):
    """T pictures of a demonstration as arrays; G and S are the widths of masks and colours, or heights and widths.

    Attributes:
        classes: (T, K) class numbers, nearest first; 0 fills up.
        numbers: (T, K, NUMBERS) of each class, see `_numbers`.
        people: (T, PEOPLE) of the person, see `_person`.
        masks: (T, G, G) class numbers around the person, or of the whole picture.
        colours: (T, S, S, 3) the same of colours.
    """

    classes: NDArray[np.uint16]
    numbers: NDArray[np.float32]
    people: NDArray[np.float32]
    masks: NDArray[np.uint16]
    colours: NDArray[np.uint8]

    @property
    def length(self) -> int:
        """Return how many pictures there are."""
        return len(self.classes)


class _Window(NamedTuple):
    """The area around the person in a picture.

    Attributes:
        mask: class numbers.
        far: the distance of each pixel from the person.
        x, y: of each pixel, from the person's middle.
    """

    mask: NDArray[np.uint16]
    far: NDArray[np.float64]
    x: NDArray[np.float64]
    y: NDArray[np.float64]


def above(masks: NDArray[np.uint16], colours: NDArray[np.uint8], person: int, whole: bool = False) -> Above:
    """Return the features of pictures.

    Args:
        masks: (T, H, W) class numbers.
        colours: (T, H, W, 3).
        person: class number of people.
        whole: masks and colours are of the whole picture, one of `EVERY` pixels, instead of around the person.
    """
    bodies = masks == person
    middles = _middles(bodies)
    starts = np.bincount(masks[0].ravel(), minlength=1 << 16)
    rows = []
    before: dict[int, float] = {}
    for number, (mask, middle) in enumerate(zip(masks, middles, strict=True)):
        old = max(number - 1, 0)
        window = _window(mask, bodies[number], middle)
        changed = (mask != masks[old]) & ~bodies[number] & ~bodies[old]
        found, before = _numbers(window, mask, masks[old], changed, starts, before, person)
        who = _person(bodies[number], middle, middles[old], changed, bodies[old], number, len(masks))
        rows.append((*found, who, *_pictures(mask, colours[number], middle, whole)))
    columns = zip(*rows, strict=True)
    return Above(*(np.stack(column) for column in columns))


def _middles(bodies: NDArray[np.bool_]) -> list[tuple[float, float]]:
    """Return the middle (x, y) of the person in each picture; where it is not seen, that of the picture before."""
    found = []
    last = bodies.shape[2] / 2, bodies.shape[1] / 2
    for body in bodies:
        ys, xs = np.nonzero(body)
        last = (float(xs.mean()), float(ys.mean())) if len(xs) else last
        found.append(last)
    return found


def _window(mask: NDArray[np.uint16], body: NDArray[np.bool_], middle: tuple[float, float]) -> _Window:
    from scipy.ndimage import distance_transform_edt

    height, width = mask.shape
    left, top = (round(each) - AROUND for each in middle)
    part = slice(max(0, top), min(top + 2 * AROUND, height)), slice(max(0, left), min(left + 2 * AROUND, width))
    ys, xs = np.mgrid[part]
    x, y = xs - middle[0], ys - middle[1]
    seen = body[part]
    far = distance_transform_edt(~seen) if seen.any() else np.hypot(x, y)
    return _Window(mask[part], far, x, y)


def _numbers(
    window: _Window,
    mask: NDArray[np.uint16],
    old: NDArray[np.uint16],
    changed: NDArray[np.bool_],
    starts: NDArray[np.int64],
    before: dict[int, float],
    person: int,
) -> tuple[tuple[NDArray[np.uint16], NDArray[np.float32]], dict[int, float]]:
    """Return the classes of a picture with (K, NUMBERS) of each, and how near each class is, for the next picture.

    The numbers are: nearness; amount that touches the person; amount around the person; (x, y) of its nearest pixels;
    amounts that appeared and disappeared since the previous picture; nearness in that picture; growth since the first
    picture; and whether the class is nearest.
    """
    appeared, gone = np.bincount(mask[changed], minlength=1 << 16), np.bincount(old[changed], minlength=1 << 16)
    near = np.flatnonzero(np.bincount(window.mask.ravel(), minlength=1 << 16))
    every = np.union1d(near, np.flatnonzero(appeared + gone))
    every = every[(every != 0) & (every != person)]
    found = np.zeros((len(every), NUMBERS), np.float32)
    total = np.bincount(mask.ravel(), minlength=1 << 16)
    for row, number in enumerate(every.tolist()):
        where = window.mask == number
        if where.any():
            far = window.far[where]
            weight = np.exp(-far / REACH)
            found[row, 0] = np.exp(-far.min() / FADES)
            found[row, 1] = np.sqrt(np.count_nonzero(far <= REACH)) / 6
            found[row, 2] = np.sqrt(len(far)) / AROUND
            middle = (weight * window.x[where]).sum(), (weight * window.y[where]).sum()
            found[row, 3:5] = np.array(middle) / weight.sum() / AROUND
        found[row, 7] = before.get(number, 0.0)
    found[:, 5], found[:, 6] = np.sqrt(appeared[every]) / 8, np.sqrt(gone[every]) / 8
    found[:, 8] = (total[every] - starts[every]) / (total[every] + starts[every] + 1)
    worth = found[:, 0] + np.minimum(found[:, 5] + found[:, 6], 1)
    order = np.argsort(-worth, kind="stable")
    if len(order):
        found[order[0], 9] = 1
    return _filled(every, found, order[:MOST_SEEN]), dict(zip(every.tolist(), found[:, 0].tolist(), strict=True))


def _filled(
    every: NDArray[np.int64], found: NDArray[np.float32], kept: NDArray[np.int64]
) -> tuple[NDArray[np.uint16], NDArray[np.float32]]:
    classes, numbers = np.zeros(MOST_SEEN, np.uint16), np.zeros((MOST_SEEN, NUMBERS), np.float32)
    classes[: len(kept)], numbers[: len(kept)] = every[kept], found[kept]
    return classes, numbers


def _person(
    body: NDArray[np.bool_],
    middle: tuple[float, float],
    old: tuple[float, float],
    changed: NDArray[np.bool_],
    body_before: NDArray[np.bool_],
    number: int,
    count: int,
) -> NDArray[np.float32]:
    """Return the person's features.

    Visible; size; growth since the picture before; distance moved, and whether; area that has changed elsewhere; share
    of the demonstration that is over; its length.
    """
    size, past = np.count_nonzero(body), np.count_nonzero(body_before)
    moved = float(np.hypot(middle[0] - old[0], middle[1] - old[1]))
    return np.array(
        [size > 0, np.sqrt(size) / 10, (size - past) / (size + past + 1), min(moved / AROUND, 3.0), moved > 1.5,
         np.sqrt(np.count_nonzero(changed)) / 16, number / max(count - 1, 1), count / 20], np.float32,
    )  # fmt: skip


def _pictures(
    mask: NDArray[np.uint16], colours: NDArray[np.uint8], middle: tuple[float, float], whole: bool
) -> tuple[NDArray[np.uint16], NDArray[np.uint8]]:
    """Masks and colours around the person, 0 outside of the picture; or of the whole picture."""
    if whole:
        half = EVERY // 2
        return mask[half::EVERY, half::EVERY], colours[half::EVERY, half::EVERY]
    return _around(mask, middle, CELLS), _around(colours, middle, PIXELS)


def _around(picture: NDArray[Pixel], middle: tuple[float, float], cells: int) -> NDArray[Pixel]:
    height, width = picture.shape[:2]
    offsets = ((np.arange(cells) + 0.5) / cells * 2 - 1) * AROUND
    xs, ys = (np.floor(centre + 0.5 + offsets).astype(np.int64) for centre in middle)
    inside = ((ys >= 0) & (ys < height))[:, None] & ((xs >= 0) & (xs < width))[None]
    found = picture[np.clip(ys, 0, height - 1)[:, None], np.clip(xs, 0, width - 1)[None]]
    found[~inside] = 0
    return found
