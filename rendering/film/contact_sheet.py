"""Contact sheets: the steps of a program in one picture, with captions."""

from collections.abc import Sequence

import numpy as np

from hearth.rendering.arrays import Image
from hearth.schemas.optional_libraries import library
from hearth.schemas.program import Step
from hearth.schemas.syntax import print_step

CAPTION = 22
GAP = 6
TITLE = 30
INK = (35, 38, 44)
PAPER = 250


def contact_sheet(frames: Sequence[tuple[Image, str]], title: str = "", columns: int = 4) -> Image:
    """Frames of one size in rows, each over its caption, under a title.

    Args:
        frames: (picture (H, W, 3), caption).
        title: over the whole; left out when empty.
        columns: frames per row.
    """
    height, width = frames[0][0].shape[:2]
    columns = min(columns, len(frames))
    rows = -(-len(frames) // columns)
    top = TITLE if title else 0
    shape = (top + rows * (height + CAPTION + GAP) + GAP, columns * (width + GAP) + GAP, 3)
    page = np.full(shape, PAPER, np.uint8)
    if title:
        write(page, title, GAP + 2, 21, 0.6)
    for number, (picture, caption) in enumerate(frames):
        x = GAP + number % columns * (width + GAP)
        y = top + GAP + number // columns * (height + CAPTION + GAP)
        page[y : y + height, x : x + width] = picture
        write(page, fitted(caption, width, 0.42), x + 2, y + height + 15, 0.42)
    return page


def write(page: Image, text: str, x: int, y: int, scale: float) -> None:
    """Draw text into a picture; (x, y) is the left end of its baseline."""
    cv2 = library("cv2")

    plain = text.encode("ascii", "replace").decode()
    cv2.putText(page, plain, (x, y), cv2.FONT_HERSHEY_SIMPLEX, scale, INK, 1, cv2.LINE_AA)


def fitted(text: str, width: int, scale: float) -> str:
    """Return the text, truncated with dots to at most `width` pixels."""
    cv2 = library("cv2")

    while text and cv2.getTextSize(text, cv2.FONT_HERSHEY_SIMPLEX, scale, 1)[0][0] > width - 4:
        text = text[:-4] + "..." if text.endswith("...") else text[:-3] + "..."
    return text


def caption(tick: int, steps: Sequence[Step]) -> str:
    """`3. [Grab] <milk> (1)`, or `start`."""
    return f"{tick}. " + " | ".join(print_step(step) for step in steps) if steps else "start"
