"""The environments in which predictions run, named by their rows."""

from collections.abc import Callable
from functools import lru_cache
from pathlib import Path

from hearth.homes.library import graph_of, load_graph
from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.scoring.predictions import Pair
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World
from hearth.storage.names import inside

Environments = Callable[[Pair], World | None]
"""Gives the initial world of a pair's programs; None if unknown."""

GRAPH = "graph"
HOME = "home"


def by_row(
    file: Path, knowledge: Knowledge, graph: Path | None = None, homes: Path | None = None, home: str = ""
) -> Environments:
    """Return environments named by each row: `graph`, a file next to the predictions', or `home`, a name.

    Args:
        file: the predictions; a row's path is relative to its folder.
        knowledge: of the environments.
        graph: the environment of rows with neither.
        homes: a folder of the user's own homes.
        home: the name of the home of rows with neither, where there is no graph for them.

    The result raises HearthError, naming the row, for a missing home or file, a file outside the folder of the
    predictions, or one that is not a regular file.
    """

    def environment(pair: Pair) -> World | None:
        named, own = pair.more.get(GRAPH), pair.more.get(HOME)
        try:
            if named is not None:
                return _from_file(inside(file.parent, str(named)), knowledge)
            if own is not None:
                return _from_home(str(own), homes, knowledge)
            if graph:
                return _from_file(graph, knowledge)
            return _from_home(home, homes, knowledge) if home else None
        except HearthError as error:
            raise HearthError(_at(fault, pair, file) for fault in error.diagnostics) from None

    return environment


def _at(fault: Diagnostic, pair: Pair, file: Path) -> Diagnostic:
    """Return the fault with the row that names the faulty file."""
    message = f"the environment of `{pair.id}` ({file}:{pair.line}): {fault.message}"
    return Diagnostic(fault.code, message, fault.file, suggestion=fault.suggestion)


@lru_cache(maxsize=32)
def _from_file(path: Path, knowledge: Knowledge) -> World:
    return World.start(Home.from_graph(graph_of(path, knowledge), path.stem, knowledge))


@lru_cache(maxsize=32)
def _from_home(name: str, homes: Path | None, knowledge: Knowledge) -> World:
    return World.start(Home.from_graph(load_graph(name, knowledge, homes), name, knowledge))
