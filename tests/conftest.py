"""Fixtures of several test folders: the release sample (skipped if missing), and a home of our own."""

from __future__ import annotations

import importlib.util
import os
import signal
import sys
from pathlib import Path

import pytest
from hypothesis import settings

from hearth.homes import library
from hearth.kb.loading.load import default
from hearth.simulation.world.home import Home

settings.register_profile("hearth", derandomize=True, deadline=None, max_examples=50)
settings.load_profile("hearth")

ROOT = Path(__file__).resolve().parents[1]

# `python -m pytest` puts the checkout first in the path, where `datasets` would hide the library of that name.
OWN = [str(ROOT / folder) for folder in ("tests", "tests/trust", "benchmarks")]
sys.path[:] = [*OWN, *(entry for entry in sys.path if Path(entry or ".").resolve() != ROOT)]
pytest_plugins = ["builds"]
sys.path.append(str(ROOT / "tests"))  # for `oracles`


@pytest.fixture(scope="session")
def real_data() -> Path:
    """The folder of real data, where there is one."""
    folder = Path(os.environ.get("HEARTH_REAL_DATA", ROOT.parent / "shared/real"))
    if not (folder / "activityprograms-sample.zip").exists():
        pytest.skip(f"no release sample in {folder} (set HEARTH_REAL_DATA)")
    return folder


@pytest.fixture(scope="session")
def knowledge():
    return default()


@pytest.fixture(scope="session")
def maple(knowledge):
    return Home.from_graph(library.load_graph("maple", default()), "maple", knowledge)


@pytest.fixture(scope="session")
def module():
    """A function that loads a script outside the package, by its path from the root."""

    def load(path: str):
        file = Path(__file__).resolve().parents[1] / path
        spec = importlib.util.spec_from_file_location(file.stem, file)
        loaded = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(loaded)
        return loaded

    return load


@pytest.fixture
def interruptible():
    """Jobs in the background of a shell ignore interrupts, and what they start inherits that."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)
