"""The package as others get it: built, installed into an empty environment, used from somewhere else."""

import os
import shutil
import subprocess
import sys
import sysconfig
import zipfile
from pathlib import Path

import pytest

from hearth.kb.loading.load import default

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = (
    "schemas", "storage", "kb", "homes", "simulation", "grounding", "repair", "rendering", "datasets", "scoring",
    "pipelines", "models", "agents", "envs", "challenges", "interop", "analysis", "studies", "web", "commands",
    "data_raw",
)  # fmt: skip
APART = (".*", "*.egg-info", "__pycache__", "build", "dist", "data_out", "node_modules", "fetched")
ENDINGS = {".py", ".yaml", ".csv", ".sql", ".jinja"}


def run(*command, cwd):
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    done = subprocess.run(
        [*map(str, command)], cwd=cwd, env=environment, capture_output=True, text=True, check=False, timeout=300
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    """The wheel, built by way of a source archive, as a release would be.

    From a copy: setuptools writes beside the sources, where other builds may be writing.
    """
    out, copy = tmp_path_factory.mktemp("dist"), tmp_path_factory.mktemp("copy") / "hearth"
    shutil.copytree(ROOT, copy, ignore=shutil.ignore_patterns(*APART))
    run(sys.executable, "-m", "build", "--no-isolation", "--outdir", out, copy, cwd=out)
    (file,) = out.glob("*.whl")
    return file


def test_the_wheel_holds_the_package_whole_and_nothing_else(wheel):
    names = set(zipfile.ZipFile(wheel).namelist())
    tops = {name.split("/")[0] for name in names}
    assert {top for top in tops if not top.endswith(".dist-info")} == {"hearth"}
    wanted = {
        f"hearth/{path.relative_to(ROOT).as_posix()}"
        for package in PACKAGES
        for path in (ROOT / package).rglob("*.*")
        if path.suffix in ENDINGS and "__pycache__" not in path.parts
    }
    assert len(wanted) > 100
    assert wanted <= names, sorted(wanted - names)
    tops = ("py.typed", "__init__.py", "__init__.pyi", "cli.py", "old_names.csv", "old_names.py", "version.py")
    assert {f"hearth/{name}" for name in tops} <= names
    code = {name for name in names if name.startswith("hearth/") and name.endswith(".py")}
    assert not {name for name in code if name.split("/")[1] in ("tests", "benchmarks", "conftest.py", "build")}


@pytest.fixture(scope="module")
def installed(wheel, tmp_path_factory):
    """An environment that holds the wheel alone, and sees the libraries of this one."""
    place = tmp_path_factory.mktemp("installed")
    run(sys.executable, "-m", "venv", "--without-pip", place / "venv", cwd=place)
    python = place / "venv/bin/python"
    run(sys.executable, "-m", "pip", "--python", python, "install", "-q", "--no-index", "--no-deps", wheel, cwd=place)
    (site,) = (place / "venv/lib").glob("python*/site-packages")
    (site / "libraries.pth").write_text(sysconfig.get_path("purelib") + "\n")
    return place / "venv/bin"


def test_it_is_imported_from_where_it_was_installed(installed, tmp_path):
    code = "import hearth, hearth.kb.loading.load as kb; print(hearth.__file__); print(len(kb.default().actions))"
    file, actions = run(installed / "python", "-c", code, cwd=tmp_path).split()
    assert Path(file).is_relative_to(installed.parent)
    assert int(actions) == len(default().actions)


def test_its_command_runs_in_any_folder(installed, tmp_path):
    (tmp_path / "sleep.txt").write_text("Sleep\n\n\n[Walk] <bed> (1)\n[Lie] <bed> (1)\n")
    assert run(installed / "hearth", "check", "sleep.txt", cwd=tmp_path) == "1 file, 1 program, 2 steps: no faults\n"
    assert "Usage: hearth " in run(installed / "hearth", "--help", cwd=tmp_path)


def test_it_brings_its_homes(installed, tmp_path):
    assert "maple" in run(installed / "hearth", "home", "list", cwd=tmp_path)
