"""Random variation between films of one execution, chosen by a seed and recorded with the film."""

import random
from dataclasses import asdict, dataclass, replace
from typing import cast

from hearth.rendering.cameras.camera import Camera
from hearth.schemas.graph import Box, EnvironmentGraph
from hearth.schemas.rng import derive
from hearth.schemas.row_types import VariationRow

HOURS = (7.5, 18.5)
"""Range of the random hour of the day."""

SPEEDS = (0.85, 1.25)
JITTER = 0.12
"""Greatest offset of a camera along each axis, metres."""


@dataclass(frozen=True, slots=True)
class Variation:
    """The variable parameters of a film.

    Attributes:
        seed: decides bodies, colours and designs of objects.
        hour: of the day.
        speed: factor of the characters' speed.
        jitter: greatest offset of cameras, metres.
        scatter: greatest offset of small things, metres.
        wander: whether characters begin at a random spot of their room.
    """

    seed: int = 0
    hour: float = 10.0
    speed: float = 1.0
    jitter: float = 0.0
    scatter: float = 0.0
    wander: bool = False

    def random(self, *use: object) -> random.Random:
        """Return a random generator for one use, the same for the same seed."""
        return random.Random(derive(self.seed, "variation", *use))

    def moved(self, camera: Camera) -> Camera:
        """Return a camera with an offset of at most `jitter`, the same for the same name."""
        if not self.jitter:
            return camera
        numbers = self.random("camera", camera.name)
        x, y, z = (value + numbers.uniform(-self.jitter, self.jitter) for value in camera.eye)
        return replace(camera, eye=(x, y, z), fov=camera.fov * numbers.uniform(0.95, 1.05))

    def row(self) -> VariationRow:
        """Return the variation as a row of the published table."""
        return cast(VariationRow, asdict(self))


def scattered(home: EnvironmentGraph, variation: Variation) -> EnvironmentGraph:
    """Return a home with its small things moved slightly on their supports, without collisions."""
    if not variation.scatter:
        return home
    boxes = {node.id: node.box for node in home.nodes if node.box}
    on = {edge.source: edge.target for edge in home.edges if edge.relation == "ON" and edge.target in boxes}
    laden = set(on.values())
    for node in home.nodes:
        support = on.get(node.id)
        if support is None or node.id in laden or "GRABBABLE" not in node.properties or node.id not in boxes:
            continue
        others = [boxes[other] for other, under in on.items() if under == support and other != node.id]
        moved = _nudged(boxes[node.id], boxes[support], others, variation, node.id)
        boxes[node.id] = moved or boxes[node.id]
    nodes = tuple(replace(node, box=boxes[node.id]) if node.id in boxes else node for node in home.nodes)
    return replace(home, nodes=nodes)


TRIES = 6


def _nudged(box: Box, support: Box, others: list[Box], variation: Variation, node_id: int) -> Box | None:
    """Return the box at another position on its support; None if none was found."""
    numbers = variation.random("place", node_id)
    (x, y, z), far = box.center, variation.scatter
    for _ in range(TRIES):
        moved = Box((x + numbers.uniform(-far, far), y, z + numbers.uniform(-far, far)), box.size)
        inside = all(abs(moved.center[k] - support.center[k]) + box.size[k] / 2 <= support.size[k] / 2 for k in (0, 2))
        if inside and not any(_touch(moved, other) for other in others):
            return moved
    return None


def _touch(one: Box, other: Box) -> bool:
    return all(
        abs(a - b) < (s + t) / 2 for a, b, s, t in zip(one.center, other.center, one.size, other.size, strict=True)
    )


PLAIN = Variation()
"""No variation."""


def drawn(seed: int, record_id: str = "") -> Variation:
    """Return a random variation.

    Args:
        seed: of the run.
        record_id: of the filmed execution.
    """
    numbers = random.Random(derive(seed, "film", record_id))
    return Variation(
        numbers.randrange(1 << 31),
        round(numbers.uniform(*HOURS), 2),
        round(numbers.uniform(*SPEEDS), 3),
        JITTER,
        0.08,
        True,
    )
