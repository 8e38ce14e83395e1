"""Fixtures that several rooms' tests share: inputs of a build, ways to run stages and to read what they wrote."""

from __future__ import annotations

import shutil
from pathlib import Path

import pyarrow.parquet as pq
import pytest

from hearth.pipelines.engine.runner import run_stage
from hearth.pipelines.engine.settings import Settings
from hearth.pipelines.engine.stages import STAGES, stage
from hearth.pipelines.engine.workers import Workers

GOLDEN = Path(__file__).resolve().parent / "golden/pipelines"
INPUT = GOLDEN / "input"
GOLDEN_SOURCES = (INPUT / "crowd", INPUT / "programs/evening.txt", INPUT / "release")


@pytest.fixture(scope="session", autouse=True)
def hurried():
    """Nothing waits for the disk: no test here pulls the plug, and those that kill start processes of their own."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("os.fsync", lambda descriptor: None)
        yield


class Built:
    """A folder of stages, and their rows."""

    def __init__(self, out: Path, sources, **options) -> None:
        options = {"homes_folder": str(INPUT / "homes"), "homes": ("cabin",), "pictures": 0, **options}
        self.settings = Settings(tuple(map(str, sources)), str(out), **options)
        self.out = out

    def run(self, *names: str, workers: int = 1):
        with Workers(workers) as pool:
            for name in names:
                self.result = run_stage(stage(name), self.settings, pool)
        return self.result

    def run_all(self) -> Built:
        self.run(*STAGES)
        return self

    def rows(self, name: str) -> list[dict]:
        paths = sorted((self.out / name).glob("part-*.parquet"))
        return [row for path in paths for row in pq.ParquetFile(path).read().to_pylist()]

    def rejects(self, name: str) -> list[dict]:
        return pq.read_table(self.out / name / "rejects.parquet").to_pylist()

    def codes(self, name: str) -> list[tuple[str, str]]:
        """(record, code) of every fault."""
        return [(row["record_id"], row["code"]) for row in self.rejects(name)]


@pytest.fixture
def built(tmp_path):
    """A way to run stages over sources, into a folder of the test's own."""

    def start(*sources, **options) -> Built:
        return Built(tmp_path / "out", sources, **options)

    return start


@pytest.fixture
def write(tmp_path):
    """Write a file of a source folder; bytes or text."""

    def put(name: str, content: str | bytes) -> Path:
        path = tmp_path / "in" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    return put


@pytest.fixture
def release(tmp_path) -> Path:
    """A copy of the release in miniature, to be damaged."""
    return shutil.copytree(INPUT / "release", tmp_path / "release")


@pytest.fixture(scope="session")
def inputs() -> Path:
    """The golden tests' input."""
    return INPUT


@pytest.fixture(scope="session")
def build_folder():
    """A way to run stages over sources, into any folder."""
    return Built


@pytest.fixture(scope="session")
def made(tmp_path_factory) -> Built:
    """All stages over the golden input, built once. Not to be changed."""
    return Built(tmp_path_factory.mktemp("made") / "out", GOLDEN_SOURCES).run_all()
