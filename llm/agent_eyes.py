"""The eyes of an agent as a language model is shown them: the first-person camera's picture, as a data URL.

A picture is a function of the world alone, so that the same prompt comes again when a run goes on.
"""

from __future__ import annotations

import threading
from base64 import b64encode
from typing import Any

from hearth.schemas.graph import EnvironmentGraph
from hearth.simulation.observation.views import View

SIZE = (320, 240)
"""Width and height of a picture."""

_DRAWING = threading.Lock()
"""Episodes in threads draw one after the other: they share a home's prepared models."""


class Eyes:
    """Pictures by an agent's eyes, in one episode.

    Args:
        start: the view before the first tick, of a home with geometry.

    Raises:
        HearthError: NOT_RENDERED: the home has no geometry; MISSING_FILE: the extra `pictures` is not installed.
    """

    def __init__(self, start: View) -> None:
        from hearth.rendering.film.followed_scene import FollowedScene

        home: EnvironmentGraph = start.world.graph()
        with _DRAWING:
            self._followed: Any = FollowedScene(home, start.world.home.knowledge)

    def __call__(self, view: View) -> str:
        """Return the picture of a view, as a data URL."""
        from hearth.rendering.film.png import encode
        from hearth.rendering.film.video import first_person
        from hearth.rendering.modalities import render

        with _DRAWING:
            self._followed.begin(view.world)
            camera = first_person(self._followed.actors[view.agent], SIZE)
            data = encode(render(self._followed.scene, camera)["rgb"])
        return f"data:image/png;base64,{b64encode(data).decode()}"
