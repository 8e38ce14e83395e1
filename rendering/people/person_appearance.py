"""The appearance of a person: body, skin, hair and clothes."""

from dataclasses import dataclass

from hearth.rendering.people.body_shape import Shape, proportions
from hearth.rendering.people.proportions import Proportions, standard
from hearth.schemas.yaml_limits import packaged


@dataclass(frozen=True, slots=True)
class Body:
    """A person's appearance.

    Attributes:
        height: metres.
        build: scale of the width of limbs and trunk of the simple figure; 1 is average.
        skin, hair, top, bottom, shoes, iris: colours as `#rrggbb`.
        style: of the hair, one of `HAIR` (clothed_body.py).
        weave: texture of the top.
        skirt: whether a skirt replaces the simple figure's trousers.
        sleeves: covered share of the simple figure's arms, 0 to 1.
        garment, legwear: what is worn above and below, of `UNDER` (clothed_body.py).
        shape: of the body; None draws the simple figure.
    """

    height: float = 1.72
    build: float = 1.0
    skin: str = "#d9a583"
    hair: str = "#3a2a20"
    top: str = "#c8573f"
    bottom: str = "#3d4f73"
    shoes: str = "#2a2a2e"
    iris: str = "#4a3a2a"
    style: str = "short"
    weave: str = "fabric"
    skirt: bool = False
    sleeves: float = 1.0
    garment: str = "longsleeve"
    legwear: str = "trousers"
    shape: Shape | None = None

    @property
    def proportions(self) -> Proportions:
        """Lengths of its bones."""
        return standard(self.height) if self.shape is None else proportions(self.shape, self.height)


BODIES: dict[str, Body] = {
    name: Body(**fields) for name, fields in packaged("hearth.rendering.people", "bodies.yaml").items()
}
"""Simple figures by name. To add one: a row of `bodies.yaml`."""
