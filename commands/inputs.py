"""Inputs of several commands: knowledge, a program file, a home, the paths of sources."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

    from hearth.kb.knowledge import Knowledge
    from hearth.schemas.program import Program
    from hearth.simulation.world.home import Home


def paths(sources: Sequence[Path] | None) -> list[str]:
    """The paths of the sources, or of the embedded corpus if there are none."""
    from hearth.pipelines.build import corpus

    return [str(path) for path in sources or corpus()]


def read_knowledge(overlay: Path | None) -> Knowledge:
    """Our knowledge, with a user's own files laid over it.

    Raises:
        HearthError: every fault of the user's files.
    """
    from hearth.kb.loading.load import overlaid

    return overlaid(overlay)


def read_program(file: Path, known: Knowledge) -> Program:
    """The first program of a file, names canonical.

    Raises:
        HearthError: every fault of the file.
    """
    from hearth.kb import grammar
    from hearth.schemas.decoding import decode
    from hearth.schemas.diagnostics import Diagnostic, HearthError
    from hearth.schemas.syntax import parse_program
    from hearth.storage.inputs import read_input

    text = decode(read_input(file), str(file))
    if isinstance(text, Diagnostic):
        raise HearthError(text)
    written, faults = parse_program(text, str(file))
    program, wrong = grammar.check(written, known, str(file), text.split("\n"))
    if faults or wrong:
        raise HearthError((*faults, *wrong))
    return program


def read_home(name: str, graph: Path | None, homes: Path | None, known: Knowledge) -> Home:
    """The home of that name, or that of a graph file.

    Raises:
        HearthError: UNKNOWN_HOME, or a fault of the file.
    """
    from hearth.homes import library
    from hearth.simulation.world.home import Home

    if graph is not None:
        return Home.from_graph(library.graph_of(graph, known), graph.stem, known)
    return Home.from_graph(library.load_graph(name, known, homes), name, known)
