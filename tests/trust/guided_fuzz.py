"""Coverage-guided fuzzing of all readers and of the commands that read files, by Atheris.

    pip install atheris
    python tests/trust/guided_fuzz.py [--seconds 3600] [--jobs 2] [--seed 0] [--only NAME ...] [--out DIR]
    python tests/trust/guided_fuzz.py --replay NAME FILE

Each target is a process: Atheris mutates its examples and keeps what reaches new branches of Hearth. A finding is an
exception other than ours ("a fault of Hearth's" is one), a hang of over 20 seconds, more than 2 GB of memory, or a
record without an output. The time is shared evenly by the targets. Findings are written to --out, one file each;
the status is 1 if there are any. `--replay` runs a file once, with its traceback.
"""

from __future__ import annotations

import argparse
import os
import re
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from fuzz_room_targets import ROOMS

if TYPE_CHECKING:
    from hearth.simulation.world.home import Home

ROOT = Path(__file__).resolve().parents[2]
LIMITS = ("-timeout=20", "-report_slow_units=20", "-rss_limit_mb=2048", "-max_len=20000")

_TEXT = b"Sleep\nGo to bed.\n\n\n[Walk] <bedroom> (1)\n[Walk] <bed> (1)\n[Lie] <bed> (1)\n[Sleep]\n"
_GRAPH = (
    b'{"nodes": [{"id": 1, "class_name": "bedroom", "category": "Rooms", "properties": [], "states": []}, {"id": 2, '
    b'"class_name": "bed", "category": "Furniture", "properties": ["LIEABLE"], "states": ["CLEAN"]}, {"id": 3, '
    b'"class_name": "character", "category": "Characters", "properties": [], "states": []}], "edges": [{"from_id": 2, '
    b'"relation_type": "INSIDE", "to_id": 1}, {"from_id": 3, "relation_type": "INSIDE", "to_id": 1}]}'
)
_PAIR = b'{"id": "a", "predicted": ["[Sleep]"], "reference": ["[Lie] <bed> (1)", "[Sleep]"]}\n'
_GRAPH_ROW = b'{"id": "a", "predicted": ["[Sleep]"], "reference": ["[Sleep]"], "graph": ' + _GRAPH + b"}\n"
_ACTIONS = (
    b"Open:\n  id: 27\n  roles: [container]\n  needs: [{any: [CAN_OPEN]}]\n  before:\n  - NOT_CLOSE: close(a, o)\n"
    b'  effects: ["state(o, OPEN)"]\n  say: Open {0}\n'
)
_PLAN = (
    b"home: hut\nabout: One room.\nheight: 2.5\ncharacter: kitchen\nrooms:\n  - name: kitchen\n    at: [0, 0]\n"
    b"    size: [3.6, 3.2]\n    furniture:\n      - bench: {wall: west, at: 1.2, width: 0.9, on: [purse]}\n"
)
_OBJECTS = (
    b"id,name,category,hypernym,properties,states,rooms,size,gloss,same_as,source\n"
    b"990,spoonlet,Props,tool,GRABBABLE MOVABLE,fullness,kitchen,0.1 0.1 0.2,a small spoon,,ours\n"
)


class Command(NamedTuple):
    """A command line; `{file}` is the case's file, `{folder}` its folder, `{sleep}` a program that runs."""

    words: tuple[str, ...]
    name: str
    """Of the file."""
    example: bytes


COMMANDS: dict[str, Command] = {
    "check": Command(("check", "{file}"), "program.txt", _TEXT),
    "check-fix": Command(("check", "--fix", "{file}"), "program.txt", _TEXT),
    "run": Command(("run", "{file}", "--home", "maple", "--json"), "program.txt", _TEXT),
    "run-graph": Command(("run", "{sleep}", "--home", "{file}"), "graph.json", _GRAPH),
    "sketch": Command(("sketch", "{file}"), "program.txt", _TEXT),
    "lint-home": Command(("home", "lint", "{file}"), "home.json", _GRAPH),
    "lint-plan": Command(("home", "lint", "hut", "--homes", "{folder}"), "hut.yaml", _PLAN),
    "show-home": Command(("home", "show", "{file}"), "home.json", _GRAPH),
    "score-lcs": Command(("score", "lcs", "{file}"), "predictions.jsonl", _PAIR),
    "score-program": Command(("score", "program", "{file}"), "predictions.jsonl", _GRAPH_ROW),
    "score-graphs": Command(("score", "graphs", "{file}", "{file}"), "graph.json", _GRAPH),
    "knowledge": Command(("kb", "lint", "--kb", "{folder}"), "actions.yaml", _ACTIONS),
    "objects": Command(("kb", "lint", "--kb", "{folder}"), "objects_things.csv", _OBJECTS),
    "conditions": Command(("environment", "conditions", "{file}"), "program.txt", _TEXT),
    "replay": Command(("replay", "{folder}"), "program.txt", _TEXT),
}


def _readers() -> dict[str, tuple[str, bytes]]:
    """Name of the target -> name and content of an example, of every reader."""
    from oracles import mutated_input

    return {f"read-{name}": (name, make()) for name, make in mutated_input.SEEDS.items()}


def targets() -> list[str]:
    """The names of all targets."""
    return [*_readers(), *COMMANDS, *ROOMS, "query", "goal", "formula"]


def examples(name: str) -> list[bytes]:
    """Return the examples from which the mutations of a target begin."""
    if name in COMMANDS:
        return [COMMANDS[name].example]
    if name in ROOMS:
        return [ROOMS[name].example()]
    if name == "query":
        return [b"SELECT count(*) FROM programs", b"EXPLAIN ANALYZE FROM steps", b"WITH x AS (SELECT 1) FROM x"]
    if name == "goal":
        return [b"ON(plate, table): 2", b"HOLDS(agent, book)", b"CLEAN(sofa)"]
    if name == "formula":
        return [b"some k: holds(a, k) & class_contains(k, knife)", b"count x: ON(x, o) < limit(o)"]
    return [_readers()[name][1]]


def target(name: str, scratch: Path) -> Callable[[bytes], None]:
    """A function of one input that raises at a finding."""
    if name in COMMANDS:
        return _command(COMMANDS[name], scratch)
    if name in ROOMS:
        return _refusing(ROOMS[name].reader(scratch))
    if name == "query":
        return _query(scratch)
    if name == "goal":
        return _text(_goal)
    if name == "formula":
        return _text(_formula)
    return _reader(_readers()[name][0], scratch)


def _reader(file: str, scratch: Path) -> Callable[[bytes], None]:
    from oracles import mutated_input

    from hearth.kb.loading.load import default

    known = default()

    def one(data: bytes) -> None:
        report = mutated_input.Report()
        mutated_input._attempt(mutated_input.placed(scratch, file, data), known, report)
        if report.crashes or not all(row.adds_up for row in report.table()):
            raise AssertionError(report.crashes or report.table())

    return one


def _command(command: Command, scratch: Path) -> Callable[[bytes], None]:
    from typer.testing import CliRunner

    from hearth.cli import app

    runner = CliRunner()
    sleep = scratch.parent / f"{scratch.name}.txt"
    sleep.write_bytes(_TEXT)

    def one(data: bytes) -> None:
        file = scratch / command.name
        file.write_bytes(data)
        words = [word.format(file=file, folder=scratch, sleep=sleep) for word in command.words]
        done = runner.invoke(app, words)
        if done.exception is not None and not isinstance(done.exception, SystemExit):
            raise done.exception
        if done.exit_code not in (0, 1, 2) or re.search(
            r"(fault|error) (of|in) Hearth|INTERNAL_ERROR|Traceback", done.output
        ):
            raise AssertionError(f"status {done.exit_code}: {done.output[-600:]}")

    return one


def _query(scratch: Path) -> Callable[[bytes], None]:
    from hearth.datasets.dataset import Dataset
    from hearth.pipelines.build import build
    from hearth.schemas.diagnostics import HearthError

    source = scratch / "sleep.txt"
    source.write_bytes(_TEXT)
    build([str(source)], scratch / "out")
    dataset = Dataset.open(scratch / "out")

    def one(data: bytes) -> None:
        before = {path: path.stat().st_mtime_ns for path in (scratch / "out").rglob("*.parquet")}
        try:
            dataset.rows(data.decode("utf-8", "replace"), limit=10)
        except HearthError as error:
            if any(fault.code == "INTERNAL_ERROR" for fault in error.diagnostics):
                raise
        assert before == {path: path.stat().st_mtime_ns for path in (scratch / "out").rglob("*.parquet")}

    return one


def _refusing(read: Callable[[bytes], object]) -> Callable[[bytes], None]:
    """Reads, and may refuse as Hearth does."""
    from hearth.schemas.diagnostics import HearthError

    def one(data: bytes) -> None:
        try:
            read(data)
        except HearthError as error:
            if any(fault.code == "INTERNAL_ERROR" for fault in error.diagnostics):
                raise

    return one


def _text(parse: Callable[[str], object]) -> Callable[[bytes], None]:
    return _refusing(lambda data: parse(data.decode("utf-8", "replace")))


def _goal(text: str) -> object:
    from hearth.simulation.goal_text import read_goal

    return read_goal(text, _maple())


@cache
def _maple() -> Home:
    from hearth.homes import library
    from hearth.kb.loading.load import default
    from hearth.simulation.world.home import Home

    return Home.from_graph(library.load_graph("maple", default()), "maple", default())


def _formula(text: str) -> object:
    from hearth.kb import formula

    return formula.parse_formula(text), formula.parse_effect(text)


class Found(NamedTuple):
    """The results of fuzzing a target."""

    name: str
    runs: int
    reached: int
    """Branches, as Atheris counts them."""
    files: tuple[Path, ...]
    error: str


def fuzzed(name: str, seconds: int, seed: int, out: Path) -> Found:
    """One target in a process of its own, for that time."""
    with tempfile.TemporaryDirectory() as folder:
        corpus = Path(folder, "corpus")
        corpus.mkdir()
        for n, data in enumerate(examples(name)):
            (corpus / str(n)).write_bytes(data)
        found = out / name
        found.mkdir(parents=True, exist_ok=True)
        known = {*found.iterdir()}
        command = [sys.executable, __file__, "--target", name, str(corpus), *LIMITS, f"-artifact_prefix={found}/",
                   f"-max_total_time={seconds}", f"-seed={seed + 1}"]  # fmt: skip
        environment = {**os.environ, "TMPDIR": folder, "PYTHONHASHSEED": "0"}
        done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, errors="replace",
                              check=False)  # fmt: skip
    said = done.stderr + done.stdout
    numbers = re.findall(r"#(\d+)\s+\w+\s+cov: (\d+)", said)
    runs, reached = map(int, numbers[-1]) if numbers else (0, 0)
    runs = int((re.findall(r"Done (\d+) runs", said) or [runs])[-1])
    error = "" if done.returncode == 0 else said[-3_000:]
    return Found(name, runs, reached, tuple(sorted({*found.iterdir()} - known)), error)


def _all(names: Sequence[str], seconds: int, jobs: int, seed: int, out: Path) -> int:
    """Every target, `jobs` at a time; prints a line for each."""
    each = max(10, seconds * jobs // len(names))
    began, found = time.monotonic(), []
    with ThreadPoolExecutor(jobs) as pool:
        for result in pool.map(lambda name: fuzzed(name, each, seed, out), names):
            found.append(result)
            print(f"{result.name:28} {result.runs:9,} runs {result.reached:7,} branches "
                  f"{len(result.files):3} findings", flush=True)  # fmt: skip
            if result.error:
                print(result.error, flush=True)
    bad = [result.name for result in found if result.error or result.files]
    print(f"{sum(result.runs for result in found):,} runs of {len(found)} targets in "
          f"{time.monotonic() - began:.0f} s; findings: {', '.join(bad) or 'none'}")  # fmt: skip
    return 1 if bad else 0


def _worker(name: str, words: Sequence[str]) -> None:
    """Runs Atheris; does not return."""
    import atheris

    with atheris.instrument_imports(include=["hearth"]), tempfile.TemporaryDirectory() as scratch:
        one = target(name, Path(scratch))
        for data in examples(name):
            one(data)  # imports what it needs, instrumented, and must be fine
        atheris.Setup([sys.argv[0], *words], one)
        atheris.Fuzz()


def main() -> int:
    """Fuzz, or run one file."""
    for place in (ROOT / "tests", ROOT / "tests/trust"):
        sys.path.insert(0, str(place))
    if sys.argv[1:2] == ["--target"]:
        _worker(sys.argv[2], sys.argv[3:])
        return 0
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=int, default=3_600, metavar="N", help="of the whole")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, metavar="N")
    parser.add_argument("--seed", type=int, default=0, metavar="N")
    parser.add_argument("--only", action="append", metavar="NAME", help="this target only; may be given again")
    parser.add_argument("--out", type=Path, default=Path("build/fuzz"), metavar="DIR", help="where findings go")
    parser.add_argument("--replay", nargs=2, metavar=("NAME", "FILE"))
    asked = parser.parse_args()
    if asked.replay:
        with tempfile.TemporaryDirectory() as scratch:
            target(asked.replay[0], Path(scratch))(Path(asked.replay[1]).read_bytes())
        return 0
    return _all(asked.only or targets(), asked.seconds, asked.jobs, asked.seed, asked.out)


if __name__ == "__main__":
    sys.exit(main())
