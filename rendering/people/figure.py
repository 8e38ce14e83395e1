"""People: bodies in clothes, drawn around the joints of a body pose."""

from dataclasses import dataclass
from functools import lru_cache

from hearth.rendering.models.mesh import Mesh
from hearth.rendering.people.body_pose import STILL, BodyPose
from hearth.rendering.people.dressed import dressed_mesh
from hearth.rendering.people.proportions import Proportions, standard
from hearth.rendering.people.shape import Shape, proportions
from hearth.rendering.people.simple_figure import simple_mesh
from hearth.rendering.people.skeleton import Joints, joints
from hearth.schemas.yaml_extent import packaged


@dataclass(frozen=True, slots=True)
class Body:
    """A person's appearance.

    Attributes:
        height: metres.
        build: scale of the width of limbs and trunk of the simple figure; 1 is average.
        skin, hair, top, bottom, shoes, iris: colours as `#rrggbb`.
        style: of the hair, one of `HAIR` (dressed.py).
        weave: texture of the top.
        skirt: whether a skirt replaces the simple figure's trousers.
        sleeves: covered share of the simple figure's arms, 0 to 1.
        garment, legwear: what is worn above and below, of `UNDER` (dressed.py).
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


@dataclass(frozen=True, slots=True)
class Figure:
    """A body in a pose."""

    body: Body
    body_pose: BodyPose = STILL

    def joints(self) -> Joints:
        """Positions of the joints in the figure's own frame, metres; not to be changed."""
        return _joints(self)


@lru_cache(maxsize=512)
def _joints(figure: Figure) -> Joints:
    return joints(figure.body_pose, figure.body.proportions)


@lru_cache(maxsize=256)
def figure_mesh(figure: Figure) -> Mesh:
    """The mesh of a figure, in its own frame."""
    if figure.body.shape is None:
        return simple_mesh(figure.body, figure.body_pose, figure.joints())
    return dressed_mesh(figure.body, figure.body_pose)
