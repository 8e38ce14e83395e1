"""Mutation testing by drawn mutations: how many of them does a test notice?

    python benchmarks/drawn_mutations.py [--number 600] [--seed 0] [--jobs 2] [--rooms simulation,...] [--json FILE]

Cosmic Ray proposes the mutations (`pip install cosmic-ray pytest-cov`); equally many are drawn in each room. Each is
made in a copy of the checkout, and the quick tests that run its line are run there, the fastest first and then those
that run most of its room, until one fails. A test that is stopped by its time limit has noticed, too. A mutation lives
where all of them pass; it is printed with its reason: `unreached` (no quick test runs the line) or `passed` (the tests
do not depend on it). The status is 1 if fewer than --share of the mutations are noticed. `--coverage FILE` keeps which
test runs which line, and uses it if the file is there.
"""

from __future__ import annotations

import argparse
import ast
import compileall
import contextlib
import json
import os
import queue
import re
import shutil
import subprocess
import sys
import tempfile
from collections import Counter, defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from math import ceil
from pathlib import Path
from random import Random
from typing import Any, NamedTuple
from xml.etree import ElementTree

ROOT = Path(__file__).resolve().parents[1]
ROOMS = ("simulation", "grounding", "repair", "scoring", "datasets")
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

RULES = """
[run]
data_file = {data}
source = {source}
parallel = true
omit = */tests/*
patch = subprocess
context = ${{PYTEST_CURRENT_TEST-}}
"""
"""How coverage is measured: a program that a test starts runs its lines for that test."""

CONTEXT = re.compile(r"\|(setup|run|teardown)$| \((setup|call|teardown)\)$")
"""What a coverage context has besides the test: the phase, of the test itself or of a program that it started."""

UNNOTICED = ("NoOp", "_Eq_Is", "_Is_Eq", "_NotEq_IsNot", "_IsNot_NotEq")
"""Operators that change nothing: names, small numbers and members of enumerations that are equal are the same."""

BUDGET = 60
"""Seconds that the tests of one mutation take at most, as they took in the run that measured the coverage."""

FIRST = 12
"""Tests that are run before the rest is collected: they notice most mutations."""

STARTING = 30
"""Seconds of the processor that pytest may need before its first test."""

Reached = Mapping[str, Mapping[str, Sequence[str]]]
"""File -> line -> tests that run it."""


class Mutation(NamedTuple):
    """A place, and what Cosmic Ray does there."""

    file: str
    line: int
    column: int
    operator: str
    occurrence: int
    """Which of the places in the file at which the operator applies."""


class Result(NamedTuple):
    """What became of a mutation."""

    mutation: Mutation
    outcome: str
    """`noticed`, `unreached` or `passed`."""
    line: str
    """The line as the mutation makes it."""
    tests: int
    """How many tests were run at most."""


def _without_behaviour(tree: ast.AST) -> set[tuple[int, int]]:
    """Where types stand, the slots of classes and the sizes of caches: what is mutated there cannot be noticed."""
    found: set[tuple[int, int]] = set()
    for node in ast.walk(tree):
        fields = [getattr(node, name, None) for name in ("annotation", "returns")]
        for decorator in getattr(node, "decorator_list", ()):
            if isinstance(decorator, ast.Call):
                cached = ast.unparse(decorator.func).endswith("cache")
                fields += [word.value for word in decorator.keywords if cached or word.arg == "slots"]
        if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.dump(node.test):
            fields += node.body
        for field in filter(None, fields):
            for part in ast.walk(field):
                if hasattr(part, "lineno"):
                    found |= {(line, -1) for line in range(part.lineno + 1, part.end_lineno)}
                    found |= {(part.lineno, column) for column in range(part.col_offset, 400)
                              if part.lineno < part.end_lineno or column < part.end_col_offset}  # fmt: skip
    return found


def proposed(file: str, root: Path = ROOT) -> Iterator[Mutation]:
    """All mutations of a file."""
    from cosmic_ray.ast import ast_nodes, get_ast
    from cosmic_ray.plugins import get_operator, operator_names

    source = (root / file).read_bytes()
    typed = _without_behaviour(ast.parse(source))
    tree = get_ast(source.decode())
    if len(names := sorted(operator_names())) < 50:
        raise SystemExit("Cosmic Ray lacks its own operators; install it with what it needs: pip install cosmic-ray")
    for name in names:
        kind = get_operator(name)
        if kind.arguments() or name.endswith(UNNOTICED):
            continue
        operator, number = kind(), 0
        for node in ast_nodes(tree):
            for (line, column), _ in operator.mutation_positions(node):
                if (line, column) not in typed and (line, -1) not in typed:
                    yield Mutation(file, line, column, name, number)
                number += 1


def drawn(rooms: Sequence[str], number: int, seed: int, root: Path = ROOT) -> list[Mutation]:
    """Equally many of each room: a place first, then one of its mutations, so that no operator outweighs the others."""
    found = []
    for n, room in enumerate(rooms):
        share = number * (n + 1) // len(rooms) - number * n // len(rooms)
        places: dict[tuple[str, int, int], list[Mutation]] = defaultdict(list)
        for path in sorted((root / room).rglob("*.py")):
            for mutation in proposed(path.relative_to(root).as_posix(), root):
                places[mutation[:3]].append(mutation)
        rng = Random(f"{seed}/{room}")
        for place in rng.sample(sorted(places), min(share, len(places))):
            found += next(([m] for m in rng.sample(places[place], len(places[place])) if _is_made(m, root)), [])
    return found


def _is_made(mutation: Mutation, root: Path) -> bool:
    """Cosmic Ray fails at some that it proposes, such as another exception for `except module.Error`."""
    try:
        return bool(mutated((root / mutation.file).read_text("utf-8"), mutation))
    except (AttributeError, ValueError):
        return False


def mutated(source: str, mutation: Mutation) -> str:
    """The text of a file with the mutation made."""
    from cosmic_ray.mutating import mutate_code
    from cosmic_ray.plugins import get_operator

    made = mutate_code(source, get_operator(mutation.operator)(), mutation.occurrence)
    if made is None:
        raise ValueError(f"{mutation} cannot be made")
    return made


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


def measured(rooms: Sequence[str], jobs: int) -> tuple[Reached, dict[str, float]]:
    """Which quick tests run which lines of the rooms, and how many seconds each takes."""
    import coverage

    with tempfile.TemporaryDirectory() as folder:
        copy = copied(Path(folder))
        data, times = Path(folder, "coverage"), Path(folder, "times.xml")
        rules = Path(folder, "rules")
        rules.write_text(RULES.format(data=data, source=copy))
        words = ["-p", "xdist", "-p", "pytest_cov", "-n", str(jobs), "--dist", "loadfile", "--cov",
                 f"--cov-config={rules}", "--cov-context=test", "--cov-report=", f"--junitxml={times}",
                 "-o", "junit_family=xunit1"]  # fmt: skip
        status = pytest_run(copy, words, 5_400)
        if status not in (0, 1):
            raise SystemExit(f"the tests did not end (pytest's status {status})")
        kept = coverage.CoverageData(str(data))
        kept.read()
        reached = {
            path.relative_to(copy).as_posix(): {
                str(line): sorted({CONTEXT.sub("", test) for test in tests if test})
                for line, tests in kept.contexts_by_lineno(str(path)).items()
            }
            for path in map(Path, kept.measured_files())
            if path.relative_to(copy).parts[0] in rooms
        }
        return reached, durations(times)


def durations(times: Path) -> dict[str, float]:
    """Seconds that each test takes; one that fails as it is would notice everything, so it is named and left out."""
    seconds: dict[str, float] = defaultdict(float)
    failed: set[str] = set()
    for case in ElementTree.parse(times).iter("testcase"):
        test = f"{case.get('file')}::{case.get('name')}"
        seconds[test] += float(case.get("time", 0))
        if case.find("failure") is not None or case.find("error") is not None:
            failed.add(test)
    for test in sorted(failed):
        print(f"fails as it is, left out: {test}")
    return {test: spent for test, spent in seconds.items() if test not in failed}


def breadths(reached: Reached) -> dict[str, Counter[str]]:
    """How many lines of each room a test runs."""
    found: dict[str, Counter[str]] = defaultdict(Counter)
    for file, lines in reached.items():
        for tests in lines.values():
            found[file.partition("/")[0]].update(tests)
    return found


def chosen(
    mutation: Mutation, reached: Reached, breadth: Mapping[str, Counter[str]], seconds: Mapping[str, float]
) -> list[str]:
    """The tests of a mutation within the budget: those that run its line, and those of its room that run its file; of a
    line that only an import runs, those that run its file, and all of its room.

    The latter because a cache may keep what one test computes, so that a later test does not run the line itself.
    First the fastest, each of another file. Then by turns the one that runs most lines of the room, the room's own
    before others, and the fastest that is left: hundreds of short tests of one table would use up the budget of those
    that look at everything.
    """
    lines = reached.get(mutation.file, {})
    room = mutation.file.partition("/")[0]
    of_file = {test for each in lines.values() for test in each}
    of_line = set(lines.get(str(mutation.line), ()))
    own = {test for test in of_file if test.startswith(f"tests/{room}/")}
    # What runs when a module is imported runs for no test: any of the room may depend on it.
    tests = of_line | own if of_line else of_file | {test for test in seconds if test.startswith(f"tests/{room}/")}
    fastest = sorted(tests & seconds.keys(), key=lambda test: (seconds[test], test))
    lines_run = breadth.get(room, Counter())
    broadest = sorted(fastest, key=lambda test: (test not in own, -lines_run[test]))
    of_files: dict[str, str] = {}
    for test in fastest:
        of_files.setdefault(test.partition("::")[0], test)
    turns = (test for pair in zip(broadest, fastest, strict=True) for test in pair)
    found: list[str] = []
    spent = 0.0
    for test in dict.fromkeys([*list(of_files.values())[:FIRST], *turns]):
        if not found or spent + seconds[test] <= BUDGET:
            spent += seconds[test]
            found.append(test)
    return found


def tried(copy: Path, mutation: Mutation, tests: Sequence[str], seconds: Mapping[str, float]) -> Result:
    """Make the mutation in a copy, run the tests, take it back; tests that take three times as long have noticed."""
    file = copy / mutation.file
    before, times = file.read_text("utf-8"), file.stat()
    after = mutated(before, mutation)
    line = "".join(after.splitlines()[mutation.line - 1 : mutation.line]).strip()  # the last line may be gone
    if not tests:
        return Result(mutation, "unreached", line, 0)
    try:
        file.write_text(after, "utf-8")
        os.utime(file, (times.st_atime, times.st_mtime + 10))  # so that the compiled module is not taken
        for part in (tests[:FIRST], tests[FIRST:]):
            limit = STARTING + 3 * ceil(sum(seconds[test] for test in part))
            status = pytest_run(copy, ["-x", *part], limit) if part else 0
            if status != 0:
                return Result(mutation, "noticed", line, len(tests))
        return Result(mutation, "passed", line, len(tests))
    finally:
        file.write_text(before, "utf-8")
        os.utime(file, (times.st_atime, times.st_mtime))


def run(mutations: Sequence[Mutation], reached: Reached, seconds: Mapping[str, float], jobs: int,
        show: Callable[[Result], None]) -> list[Result]:  # fmt: skip
    """All of them, `jobs` at a time, each in a copy of its own."""
    breadth = breadths(reached)
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(jobs) as pool:
        copies: queue.Queue[Path] = queue.Queue()
        for n in range(jobs):
            copies.put(copied(Path(folder, str(n))))

        def one(mutation: Mutation) -> Result:
            copy = copies.get()
            try:
                result = tried(copy, mutation, chosen(mutation, reached, breadth, seconds), seconds)
            finally:
                copies.put(copy)
            show(result)
            return result

        return list(pool.map(one, mutations))


def _shown(result: Result) -> None:
    m = result.mutation
    operator = m.operator.partition("/")[2]
    print(f"{result.outcome:9} {m.file}:{m.line}:{m.column + 1} {operator}: {result.line}", flush=True)


def summary(results: Sequence[Result]) -> dict[str, Any]:
    """How many of each room were noticed, and of all."""
    rooms: dict[str, list[bool]] = defaultdict(list)
    for result in results:
        rooms[result.mutation.file.partition("/")[0]].append(result.outcome == "noticed")
    everything = [noticed for found in rooms.values() for noticed in found]
    return {
        "mutations": len(everything),
        "noticed": sum(everything),
        "share": sum(everything) / max(len(everything), 1),
        "rooms": {room: f"{sum(found)} of {len(found)}" for room, found in rooms.items()},
    }


def _kept(file: Path | None, rooms: Sequence[str], jobs: int) -> tuple[Reached, dict[str, float]]:
    if file is not None and file.exists():
        kept = json.loads(file.read_text("utf-8"))
        return kept["reached"], kept["seconds"]
    reached, seconds = measured(rooms, jobs)
    if file is not None:
        file.write_text(json.dumps({"reached": reached, "seconds": seconds}), encoding="utf-8")
    return reached, seconds


def main(words: Sequence[str] | None = None) -> int:
    """Draw, run, print; 1 if too few are noticed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--number", type=int, default=600, metavar="N")
    parser.add_argument("--seed", type=int, default=0, metavar="N")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, metavar="N")
    parser.add_argument("--rooms", default=",".join(ROOMS), metavar="NAMES")
    parser.add_argument("--share", type=float, default=0.9, metavar="X", help="of the mutations that must be noticed")
    parser.add_argument("--coverage", type=Path, metavar="FILE")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write all results here, too")
    asked = parser.parse_args(words)
    rooms = asked.rooms.split(",")
    mutations = drawn(rooms, asked.number, asked.seed)
    reached, seconds = _kept(asked.coverage, rooms, asked.jobs)
    results = run(mutations, reached, seconds, asked.jobs, _shown)
    found = summary(results)
    print(json.dumps(found, indent=1))
    if asked.json:
        rows = [{**r.mutation._asdict(), "outcome": r.outcome, "text": r.line, "tests": r.tests} for r in results]
        asked.json.write_text(json.dumps({**found, "results": rows}, indent=1) + "\n", encoding="utf-8")
    return int(found["share"] < asked.share)


if __name__ == "__main__":
    sys.exit(main())
