"""A copy of the checkout in which a mutation is made and quick tests are run, each within its time."""

from __future__ import annotations

import compileall
import contextlib
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from proposed_mutations import ROOT

APART = (".*", "*.egg-info", "__pycache__", "build", "dist", "data_out")
NOT_SLOW = "not slow and not tools"
PYTEST = """
import resource, signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)  # ignored where this runs in the background of a shell
resource.setrlimit(resource.RLIMIT_CPU, ({limit}, {limit}))
sys.path.insert(0, {place!r})
import pytest
sys.exit(pytest.main(sys.argv[1:]))
"""
UNSHRUNK = """
from hypothesis import Phase
settings.register_profile("unshrunk", settings.get_profile("hearth"), phases=(Phase.explicit, Phase.generate))
settings.load_profile("unshrunk")
"""
"""Added to the tests of a copy: that an example fails is enough, a small one takes long to find."""


def copied(folder: Path, root: Path = ROOT) -> Path:
    """A copy of the checkout with compiled modules, in a folder of the package's name."""
    copy = folder / "site/hearth"
    shutil.copytree(root, copy, ignore=shutil.ignore_patterns(*APART))
    with (copy / "tests/conftest.py").open("a", encoding="utf-8") as conftest:
        conftest.write(UNSHRUNK)
    compileall.compile_dir(copy, quiet=2)
    return copy


def pytest_run(copy: Path, words: Sequence[str], limit: int) -> int | None:
    """The status of pytest with the package taken from the copy; None where it did not end.

    A process ends after `limit` seconds of the processor, so that a busy machine does not end one that works. What
    waits for ever uses none: ten times as long by the clock is the end for all.
    """
    place = str(copy.parent)
    code = PYTEST.format(place=place, limit=limit)
    data = os.environ.get("HEARTH_REAL_DATA", str(ROOT.parent / "shared/real"))
    environment = {**os.environ, "PYTHONPATH": place, "PYTHONDONTWRITEBYTECODE": "1", "HEARTH_REAL_DATA": data,
                   "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}  # plugins take as long to load as most tests run  # fmt: skip
    command = [sys.executable, "-c", code, "-q", "-p", "no:cacheprovider", "-m", NOT_SLOW, *words]
    with tempfile.TemporaryDirectory() as scratch:
        environment["TMPDIR"] = scratch  # whatever a stopped test leaves behind goes, too
        process = subprocess.Popen(command, cwd=copy, env=environment, start_new_session=True,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)  # fmt: skip
        try:
            return process.wait(10 * limit)
        except subprocess.TimeoutExpired:
            return None
        finally:
            _end(process)


def _end(process: subprocess.Popen[bytes]) -> None:
    """A mutated program may have started others that never end."""
    with contextlib.suppress(ProcessLookupError):
        os.killpg(process.pid, 9)
    process.wait()
