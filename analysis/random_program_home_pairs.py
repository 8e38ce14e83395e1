"""Pairs of a program and a home, drawn from sources by a seed, for measurements of pictures and films."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from hearth.analysis.programs_in_homes import Script, scripts
from hearth.grounding.grounded_run import attempt
from hearth.homes import library
from hearth.kb.knowledge import Knowledge
from hearth.schemas.failures import Failure
from hearth.schemas.graph import EnvironmentGraph
from hearth.schemas.rng import rng
from hearth.simulation.engine import Execution
from hearth.simulation.world.home import Home


class FilmedPair(NamedTuple):
    """A program that ran to its end in a home.

    Attributes:
        execution: the execution that is filmed.
        home: the home's name.
        graph: the home's graph, with boxes.
    """

    execution: Execution
    home: str
    graph: EnvironmentGraph


def pairs(sources: Sequence[str], knowledge: Knowledge, seed: int = 0) -> Iterator[FilmedPair]:
    """Yield the programs of some sources in an order that the seed decides, each in the next of our homes.

    Programs that cannot run there are left out.
    """
    names = library.names()
    read = [script.program for script in scripts(sources, knowledge) if isinstance(script, Script)]
    rng(seed, "visible", "").shuffle(read)
    for number, program in enumerate(read):
        name = names[number % len(names)]
        graph = library.load_graph(name, knowledge)
        trial = attempt(program, Home.from_graph(graph, name, knowledge), seed)
        if not isinstance(trial, Failure) and trial.execution.executable:
            yield FilmedPair(trial.execution, name, graph)
