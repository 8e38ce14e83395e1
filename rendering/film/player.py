"""A page that plays a video next to its steps: the current step is highlighted, and a click jumps to a step."""

from collections.abc import Sequence
from importlib.resources import files as of_package

import jinja2

from hearth.schemas.row_types import FilmedStepRow


def page(title: str, files: Sequence[str], steps: Sequence[FilmedStepRow]) -> str:
    """Return one HTML document that plays the video files of its folder.

    Args:
        title: over the video.
        files: names of the video in several formats; the browser plays the first that it supports.
        steps: `tick`, `steps` (texts), `start` and `end` in seconds, as `video.times` gives them.
    """
    text = (of_package("hearth.rendering.film") / "player.html").read_text("utf-8")
    template = jinja2.Environment(autoescape=True, trim_blocks=True, keep_trailing_newline=True).from_string(text)
    return template.render(title=title, files=files, steps=steps)
