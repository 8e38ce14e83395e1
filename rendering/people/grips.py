"""Forms of the fingers, as bends of their joints."""

from typing import NamedTuple


class Bends(NamedTuple):
    """Bend of the joints of a hand, degrees.

    Attributes:
        fingers: of the three joints of each finger.
        forefinger: of those of the index finger; None as the others.
        thumb: how far the thumb is turned towards the palm, and the bends of its two outer joints.
        spread: degrees between neighbouring fingers.
    """

    fingers: tuple[float, float, float]
    forefinger: tuple[float, float, float] | None = None
    thumb: tuple[float, float, float] = (8.0, 8.0, 10.0)
    spread: float = 0.0

    @property
    def of_index(self) -> tuple[float, float, float]:
        """The bends of the index finger."""
        return self.forefinger or self.fingers


GRIPS: dict[str, Bends] = {
    "relaxed": Bends((14, 20, 14), (8, 15, 10)),
    "flat": Bends((4, 4, 3), thumb=(0.0, 3.0, 3.0), spread=2.0),
    "handle": Bends((62, 80, 50), thumb=(32.0, 22.0, 38.0)),
    "body": Bends((32, 42, 28), thumb=(34.0, 10.0, 16.0), spread=3.0),
    "rim": Bends((58, 18, 10), thumb=(30.0, 14.0, 12.0)),
    "two hands": Bends((24, 30, 18), thumb=(16.0, 8.0, 10.0), spread=3.0),
    "sheet": Bends((52, 34, 16), thumb=(24.0, 14.0, 14.0)),
    "pinch": Bends((50, 56, 34), (46, 38, 20), thumb=(34.0, 20.0, 18.0)),
    "point": Bends((66, 84, 52), (3, 4, 3), thumb=(30.0, 24.0, 34.0)),
    "typing": Bends((28, 34, 18), thumb=(10.0, 8.0, 10.0), spread=3.0),
}
"""The form of the fingers by the name of a grip."""
