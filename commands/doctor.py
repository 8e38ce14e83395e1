"""`doctor`: checks libraries, codecs, disk and data, with the consequence of each that is missing."""

import ctypes
import importlib.metadata
import os
import platform
import re
import shutil
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from hearth.commands import output
from hearth.rendering.film.stderr_suppression import quiet
from hearth.schemas.optional_libraries import lacking, remedy

LIBRARIES = {
    "libusb-1.0.so.0": "libusb-1.0-0",
    "libGL.so.1": "libgl1",
    "libEGL.so.1": "libegl1",
    "libX11.so.6": "libx11-6",
}
"""Libraries that open3d links at load, and their Debian and Ubuntu packages."""

CODECS = {"mp4v": ".mp4", "VP80": ".webm", "FFV1": ".mkv"}
"""Video codecs of rendering: for players, for browsers, lossless."""

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")

ROOMY = 2 * 2**30
"""Bytes of a full build with its pictures."""

OK, MISSING, BROKEN = "ok", "missing", "broken"


@dataclass(frozen=True, slots=True)
class Finding:
    """The state of one requirement of Hearth.

    Attributes:
        what: its name.
        state: `ok`; `missing`, if it is optional; `broken`, if Hearth can't work without it.
        found: its version, path or amount; or the reason why it does not work.
        cost: the consequence of its absence, and the remedy.
    """

    what: str
    state: str
    found: str
    cost: str = ""


def python() -> Finding:
    """Check the interpreter."""
    fits = (3, 11) <= sys.version_info[:2] < (3, 15)
    found = f"{platform.python_version()} on {platform.system()} {platform.machine()}"
    return Finding("Python", OK if fits else BROKEN, found, "" if fits else "needs Python 3.11 to 3.14")


def packages() -> Finding:
    """Check the libraries that Hearth always needs, by its metadata, without importing them."""
    installed = importlib.metadata.packages_distributions().get("hearth")
    if not installed:
        return Finding("libraries", BROKEN, "Hearth itself is not installed", "run `make setup`")
    wanted = importlib.metadata.requires(installed[0]) or []
    names = [re.split(r"[^\w.-]", line)[0] for line in wanted if ";" not in line]
    absent = [name for name in names if not _installed(name)]
    if absent:
        return Finding("libraries", BROKEN, f"without {', '.join(absent)}", "run `make setup`")
    return Finding("libraries", OK, f"all {len(names)} installed")


def _installed(name: str) -> bool:
    try:
        importlib.metadata.version(name)
    except importlib.metadata.PackageNotFoundError:
        return False
    return True


def folder() -> Finding:
    """Check the folder whose code runs: in a copy of a checkout, `.venv` runs that of the original."""
    runs, called = Path(__file__).resolve().parents[1], Path(sys.argv[0]).absolute()
    at = called.parents[2] if called.parts[-3:-1] == (".venv", "bin") else called.parent
    if (at / "commands/doctor.py").is_file() and at.resolve() != runs:
        return Finding("folder", BROKEN, f"runs the code of {runs}, not of {at}", f"run `make setup` in {at}")
    return Finding("folder", OK, str(runs))


def missing_libraries() -> list[str]:
    """Return the Debian packages of open3d's libraries that are missing on this machine."""
    return [package for library, package in LIBRARIES.items() if not _loads(library)]


def _loads(library: str) -> bool:
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True


def rays() -> Finding:
    """Check ray casting, by open3d with Embree."""
    cost = "no pictures; all else works"
    if lacking("pictures"):
        absent = ", ".join(lacking("pictures"))
        return Finding("rays (open3d)", MISSING, f"without {absent}", f"{cost}; {remedy('pictures')}")
    if wanted := missing_libraries():
        return Finding("rays (open3d)", MISSING, "system libraries", f"{cost}; apt-get install {' '.join(wanted)}")
    try:
        return Finding("rays (open3d)", OK, f"open3d {_cast_one_ray()}")
    except Exception as error:  # any of its many native libraries may fail in its own way
        return Finding("rays (open3d)", MISSING, f"{type(error).__name__}: {error}"[:80], cost)


def _cast_one_ray() -> str:
    """Cast a ray at a box a metre away, and return the library's version.

    Raises:
        ValueError: the ray hits at another distance.
    """
    import numpy as np
    import open3d

    scene = open3d.t.geometry.RaycastingScene()
    scene.add_triangles(open3d.t.geometry.TriangleMesh.create_box())
    ray = open3d.core.Tensor.from_numpy(np.array([[0.5, 0.5, 2, 0, 0, -1]], np.float32))
    hit = scene.cast_rays(ray)["t_hit"].item()
    if abs(hit - 1) > 1e-4:
        raise ValueError(f"a ray of 1 m came back as {hit} m")
    return str(open3d.__version__)


def codecs() -> Finding:
    """Check the video codecs that OpenCV can open."""
    if "cv2" in lacking("pictures"):
        return Finding("video (OpenCV)", MISSING, "not installed", f"no pictures, no video; {remedy('pictures')}")
    import cv2

    with tempfile.TemporaryDirectory() as folder, quiet():
        works = [name for name, ending in CODECS.items() if _opens(name, Path(folder, f"video{ending}"))]
    closed = sorted(set(CODECS) - set(works))
    found = f"OpenCV {cv2.__version__}: {', '.join(works) or 'no codec'}"
    return Finding("video (OpenCV)", MISSING if closed else OK, found, f"no {', '.join(closed)}" if closed else "")


def _opens(codec: str, path: Path) -> bool:
    import cv2

    writer = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*codec), 10.0, (64, 64))
    opened = writer.isOpened()
    writer.release()
    return bool(opened)


def browser() -> Finding:
    """Check for a browser that runs without a display."""
    place = next(filter(None, map(shutil.which, BROWSERS)), None)
    if place:
        return Finding("browser", OK, place)
    return Finding("browser", MISSING, "no Chromium", "reports are written but not tried; apt-get install chromium")


def web() -> Finding:
    """Check the parts that pages of `serve` use: libraries, and the scripts that `make web` fetches."""
    if lacking("web"):
        return Finding("web", MISSING, f"without {', '.join(lacking('web'))}", f"no `serve`; {remedy('web')}")
    from hearth.web.third_party_scripts import REMEDY, THIRD_PARTY, missing

    if names := missing():
        cost = "; ".join(THIRD_PARTY[name].purpose for name in names)
        return Finding("web", MISSING, f"without {', '.join(names)}", f"{cost}; {REMEDY}")
    return Finding("web", OK, ", ".join(THIRD_PARTY))


def fonts() -> Finding:
    """Check the fonts of the system; figures have their own."""
    folders = (Path("/usr/share/fonts"), Path("/usr/local/share/fonts"), Path.home() / ".local/share/fonts")
    count = sum(1 for folder in folders if folder.is_dir() for file in folder.rglob("*") if file.suffix in _FONTS)
    if count:
        return Finding("fonts", OK, output.counted(count, "file"))
    return Finding("fonts", MISSING, "none", "a browser draws boxes for letters; apt-get install fonts-dejavu-core")


_FONTS = {".ttf", ".otf", ".ttc", ".pfb"}


def disk() -> Finding:
    """Check the free disk space in the working directory."""
    free = shutil.disk_usage(Path.cwd()).free
    cost = "" if free > ROOMY else f"a full build with pictures takes {ROOMY / 2**30:.0f} GB"
    return Finding("disk", OK if free > ROOMY else MISSING, f"{free / 2**30:.1f} GB free here", cost)


def cores() -> Finding:
    """Check the processors of this process, and the memory."""
    count = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 2**30
    cost = "" if count > 1 else "stages run one record after another"
    return Finding("cores", OK if count > 1 else MISSING, f"{output.counted(count, 'core')}, {memory:.0f} GB", cost)


def real_data() -> Finding:
    """Check for the sample of the original release, which some tests and benchmarks read."""
    root = Path(__file__).resolve().parent.parent
    folder = Path(os.environ.get("HEARTH_REAL_DATA") or root.parent / "shared/real")
    if folder.is_dir():
        return Finding("release sample", OK, str(folder))
    cost = "tests against the release are skipped; set HEARTH_REAL_DATA to its folder"
    return Finding("release sample", MISSING, "not found", cost)


def uv() -> Finding:
    """Check for the fast installer."""
    place = shutil.which("uv")
    return Finding("uv", OK, place) if place else Finding("uv", MISSING, "not found", "set-up takes some 30 s longer")


CHECKS: tuple[Callable[[], Finding], ...] = (
    python, folder, packages, rays, codecs, browser, web, fonts, disk, cores, real_data, uv,
)  # fmt: skip
"""All checks, in the order of the table."""


def doctor(libraries: bool = False, as_json: bool = False) -> None:
    """Check libraries, codecs, disk and data, and print the consequence of each that is missing.

    The status is 1 only if Hearth can't work without it.

    \b
    Example:
      hearth doctor
    """
    if libraries:
        wanted = [] if "open3d" in lacking("pictures") else missing_libraries()
        output.emit(wanted) if as_json else output.line("\n".join(wanted), end="\n" if wanted else "")
        return
    findings = [check() for check in CHECKS]
    broken = sum(finding.state == BROKEN for finding in findings)
    if as_json:
        output.emit({"findings": findings, "broken": broken})
    else:
        rows = [(each.what, each.state, each.found, each.cost) for each in findings]
        output.table(("what", "", "found", "consequence and remedy"), rows)
    output.status(broken, strict=True)
