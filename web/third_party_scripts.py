"""Scripts of others that pages use: pinned in package-lock.json, fetched by `make web`, never committed.

`python -m hearth.web.third_party_scripts` copies the files that pages need from `node_modules` to `fetched`, with the
licences.
"""

import shutil
from pathlib import Path
from typing import NamedTuple

from hearth.schemas.optional_libraries import CHECKOUT

HERE = Path(__file__).resolve().parent
FETCHED = HERE / "fetched"
"""The folder that the server serves under `/fetched/`; the wheel contains it."""


class Script(NamedTuple):
    """A library for browsers.

    Attributes:
        files: by their path within its package; the first shows that it is there.
        purpose: the function that fails without it.
    """

    files: tuple[str, ...]
    purpose: str


THIRD_PARTY: dict[str, Script] = {
    "blockly": Script(
        (
            "blockly_compressed.js",
            "msg/en.js",
            *(f"media/{name}" for name in ("sprites.svg", "dropdown-arrow.svg", "delete-icon.svg", "foldout-icon.svg")),
            *(f"media/{name}" for name in ("handopen.cur", "handclosed.cur", "handdelete.cur", "resize-handle.svg")),
            *(f"media/{name}" for name in ("1x1.gif", "click.mp3", "delete.mp3", "disconnect.mp3", "drop.mp3")),
            "LICENSE",
        ),
        "programs are put together in a form instead of from blocks",
    ),
    "three": Script(
        (
            "build/three.module.js",
            "build/three.core.js",
            "examples/jsm/loaders/GLTFLoader.js",
            "examples/jsm/utils/BufferGeometryUtils.js",
            "examples/jsm/utils/SkeletonUtils.js",
            "examples/jsm/controls/OrbitControls.js",
            "LICENSE",
        ),
        "homes are not shown in 3D",
    ),
}
"""The libraries by their name in package.json. To add one: a row here, and `npm install --save-exact` in web/."""

THREE = "/fetched/three/build/three.module.js"
"""The address that scripts import three.js from."""

REMEDY = "run make web (it needs npm)" if CHECKOUT.is_file() else "install a wheel that was built after make web"


def missing() -> list[str]:
    """Return the libraries that are not there."""
    return [name for name, script in THIRD_PARTY.items() if not (FETCHED / name / script.files[0]).is_file()]


def copy(modules: Path = HERE / "node_modules") -> None:
    """Copy the files of each library from npm's folder; a module's imports by name become addresses."""
    shutil.rmtree(FETCHED, ignore_errors=True)
    for name, script in THIRD_PARTY.items():
        for file in script.files:
            target = FETCHED / name / file
            target.parent.mkdir(parents=True, exist_ok=True)
            source = modules / name / file
            if file.startswith("examples/"):  # browsers find a module by its name only with an inline import map
                text = source.read_text("utf-8").replace("from 'three'", f"from '{THREE}'")
                target.write_text(text, "utf-8")
            else:
                shutil.copyfile(source, target)


if __name__ == "__main__":
    copy()
