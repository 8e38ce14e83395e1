"""The recipe for OpenCV on the page of frames gives the pixels that the camera itself gives."""

import re
from pathlib import Path

import numpy as np
import pytest

from hearth.rendering.cameras.camera import Camera

PAGE = Path(__file__).parents[2] / "docs/examples/frames.md"


def recipe():
    (block,) = [
        text for text in re.findall(r"```python\n(.*?)```", PAGE.read_text("utf-8"), re.DOTALL) if "opencv" in text
    ]
    names = {}
    exec(block, names)
    return names["opencv"]


def test_opencv_projects_points_to_the_same_pixels():
    cv2 = pytest.importorskip("cv2")
    camera = Camera("corner", (4.0, 2.2, 3.5), (1.0, 0.7, 0.4), 320, 240)
    (fx, _, cx), (_, fy, cy), _ = camera.intrinsics
    assert fy < 0
    row = {"intrinsics": {"fx": fx, "fy": fy, "cx": cx, "cy": cy}, "pose": camera.pose.flatten().tolist()}
    matrix, turn, shift = recipe()(row)
    assert np.linalg.det(turn) == pytest.approx(1)
    points = np.array([[1.0, 0.7, 0.4], [1.5, 0.2, 0.9], [0.3, 1.1, 0.8]])
    pixels, _ = cv2.projectPoints(points * [1, -1, 1], cv2.Rodrigues(turn)[0], shift, matrix, None)
    np.testing.assert_allclose(pixels[:, 0], camera.project(points)[0], atol=1e-6)
