"""People: bodies in clothes, drawn around the joints of a body pose."""

from dataclasses import dataclass
from functools import lru_cache

from hearth.rendering.models.mesh import Mesh
from hearth.rendering.people.body_pose import STILL, BodyPose
from hearth.rendering.people.clothed_body import dressed_mesh
from hearth.rendering.people.person_appearance import Body
from hearth.rendering.people.simple_figure import simple_mesh
from hearth.rendering.people.skeleton import Joints, joints


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


@lru_cache(maxsize=16)
def figure_mesh(figure: Figure) -> Mesh:
    """Return the mesh of a figure, in its own frame."""
    if figure.body.shape is None:
        return simple_mesh(figure.body, figure.body_pose, figure.joints())
    return dressed_mesh(figure.body, figure.body_pose)
