"""The lines that quick tests run, and the tests chosen for a mutation: the fastest and the broadest."""

from __future__ import annotations

import re
import tempfile
from collections import Counter, defaultdict
from collections.abc import Mapping, Sequence
from pathlib import Path
from xml.etree import ElementTree

from mutated_checkout import copied, pytest_run
from proposed_mutations import Mutation

RULES = """
[run]
data_file = {data}
source = {source}
parallel = true
omit = */tests/*
patch = subprocess
context = ${{PYTEST_CURRENT_TEST-}}
"""
"""Settings of the coverage measurement: a program that a test starts runs its lines for that test."""

CONTEXT = re.compile(r"\|(setup|run|teardown)$| \((setup|call|teardown)\)$")
"""The part of a coverage context after the test: the phase, of the test itself or of a program that it started."""

BUDGET = 60
"""Seconds that the tests of one mutation take at most, as they took in the run that measured the coverage."""

FIRST = 12
"""Tests that are run before the rest is collected: they notice most mutations."""

Reached = Mapping[str, Mapping[str, Sequence[str]]]
"""File -> line -> tests that run it."""


def measured(rooms: Sequence[str], jobs: int) -> tuple[Reached, dict[str, float]]:
    """Return the lines of the rooms that each quick test runs, and the seconds that each test takes."""
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
    """Return the number of lines of each room that a test runs."""
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
