"""Replaying a release: every grounded program on its stored start graph, against its stored end graph."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from time import perf_counter
from typing import Any

from hearth.kb import action_grammar
from hearth.kb.knowledge import Knowledge
from hearth.pipelines.readers import release
from hearth.pipelines.readers.graph_pairs import read_pair
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code, Failure
from hearth.schemas.graph_change import Change
from hearth.schemas.program import Program
from hearth.schemas.syntax import parse_program
from hearth.simulation.engine import run
from hearth.simulation.rules import REPLAY, Rules
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World


@dataclass(frozen=True, slots=True)
class Replayed:
    """One program of a release, in one home.

    Attributes:
        program_id: `batch/file`.
        home: the home's folder.
        steps: number of executed steps.
        faults: of reading, if it could not be read.
        failure: if it stopped.
        difference: from its final graph to the stored one.
        seconds: of reading, building worlds and executing.
    """

    program_id: str
    home: str
    steps: int = 0
    faults: tuple[Diagnostic, ...] = ()
    failure: Failure | None = None
    difference: Change = field(default_factory=Change)
    seconds: tuple[float, float, float] = (0.0, 0.0, 0.0)

    @property
    def executed(self) -> bool:
        """Return whether it was read and ran to its end."""
        return not self.faults and self.failure is None

    @property
    def exact(self) -> bool:
        """Return whether it was executed and reached every state and relation of the stored end."""
        return self.executed and not self.difference


def replay(path: Path, knowledge: Knowledge, rules: Rules = REPLAY) -> Iterator[Replayed]:
    """Run every grounded program of a release, one at a time, in the order of their names.

    Args:
        path: zip or folder, in the release's own layout.
        knowledge: names, arity and affordances.
        rules: variant of the actions' semantics; by default the release's, with its quirks.

    Raises:
        HearthError: the path is not a release, or has no grounded programs.
    """
    found = False
    for item in release.scan(path, path.name):
        value = {**item.value, "path": item.path} if isinstance(item.value, dict) else {}
        for home in sorted(value.get("grounded", {})):
            found = True
            yield _one(value, home, knowledge, rules)
    if not found:
        message = "no grounded programs in it"
        raise HearthError.of(
            Code.MISSING_FILE, message, file=str(path), suggestion="it needs the folder executable_programs"
        )


def _one(value: dict[str, Any], home: str, knowledge: Knowledge, rules: Rules) -> Replayed:
    key = value["key"]
    begun = perf_counter()
    read = _read(value, home, knowledge)
    if isinstance(read, tuple) and isinstance(read[0], Diagnostic):
        return Replayed(key, home, faults=read)
    program, (graph, expected) = read
    read_at = perf_counter()
    try:
        start = World.start(Home.from_release(graph, home, knowledge))
    except HearthError as error:
        return Replayed(key, home, faults=(_bad_graph(value, home, error),))
    built_at = perf_counter()
    execution = run(start, program, rules)
    done_at = perf_counter()
    seconds = (read_at - begun, built_at - read_at, done_at - built_at)
    steps = len(execution.worlds) - 1
    if execution.failure is not None or expected is None or execution.final.changes(start) == expected:
        return Replayed(key, home, steps, failure=execution.failure, seconds=seconds)
    # Graphs may be irregular: only worlds made of both tell where they differ.
    final = release.json_of(value, value["graphs"][home])["final_graph"]
    difference = World.start(Home.from_release(final, home, knowledge)).changes(execution.final)
    return Replayed(key, home, steps, difference=difference, seconds=seconds)


def _read(
    value: dict[str, Any], home: str, knowledge: Knowledge
) -> tuple[Program, tuple[dict[str, Any], Change | None]] | tuple[Diagnostic, ...]:
    place = f"{value['label']}/{value['grounded'][home]}"
    name = value.get("graphs", {}).get(home)
    if name is None:
        return (Diagnostic(Code.MISSING_FILE, "no stored graphs for it", place),)
    text = release.text_of(value, value["grounded"][home])
    try:
        graphs = release.json_of(value, name, read_pair)
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        return (_bad_graph(value, home, error),)
    if isinstance(text, Diagnostic) or isinstance(graphs, Diagnostic):
        return tuple(fault for fault in (text, graphs) if isinstance(fault, Diagnostic))
    written, faults = parse_program(text, place)
    program, wrong = action_grammar.check(written, knowledge, place, text.split("\n"))
    return (*faults, *wrong) or (program, graphs)


def _bad_graph(value: dict[str, Any], home: str, error: Exception) -> Diagnostic:
    place = f"{value['label']}/{value['graphs'][home]}"
    return Diagnostic(Code.BAD_GRAPH, f"no environment graph: {type(error).__name__} {error}", place)
