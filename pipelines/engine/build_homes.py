"""The homes of a build: the catalog, the user's homes laid over it, and homes derived from stored start graphs."""

from functools import cache
from pathlib import Path

import orjson

from hearth.pipelines.engine.build_context import knowledge
from hearth.pipelines.engine.settings import DERIVED, Settings
from hearth.schemas.graph import Edge, EnvironmentGraph, from_release
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World
from hearth.storage.names import inside


def known_homes(settings: Settings) -> None:
    """Refuse names of homes that there can't be, before any source is read.

    Scene graphs among the sources are homes, too: a folder or a packed file may hold some, which `ingest` finds.

    Raises:
        HearthError: UNKNOWN_HOME.
    """
    from hearth.homes import library

    sources = [Path(source) for source in settings.sources]
    if all(source.is_file() and source.suffix not in _PACKED for source in sources):
        known = {*library.names(settings.homes_folder), *(source.stem for source in sources)}
        for name in settings.homes:
            if name not in known:
                library.load_graph(name, knowledge(settings), settings.homes_folder)


_PACKED = frozenset({".zip", ".gz", ".zst"})


class Homes:
    """The homes of a build, built once a process: the catalog's in their default state, derived ones as stored."""

    def __init__(self, settings: Settings) -> None:
        self._settings = settings
        self.home, self.edges = cache(self._home), cache(self._edges)
        self.knowledge = knowledge(settings)
        self._scenes = frozenset(path.stem for path in (settings.folder("ingest") / DERIVED).glob("*.json"))

    def names(self) -> tuple[str, ...]:
        """Homes to sample in: those named in the settings, or all of the catalog.

        Raises:
            HearthError: UNKNOWN_HOME.
        """
        for name in self._settings.homes:
            self.graph(name)
        return self._settings.homes or self.catalog()

    def catalog(self) -> tuple[str, ...]:
        """Return all homes of ours, of the user's folder, and of scene graphs among the sources."""
        from hearth.homes import library

        return tuple(sorted({*library.names(self._settings.homes_folder), *self._scenes}))

    def graph(self, name: str) -> EnvironmentGraph:
        """Return the scene graph of a home of the catalog.

        Raises:
            HearthError: UNKNOWN_HOME, or every fault of its plan or graph.
        """
        from hearth.homes import library

        if name in self._scenes:
            return self._stored("ingest", name)
        return library.load_graph(name, self.knowledge, self._settings.homes_folder)

    def in_catalog(self, name: str) -> bool:
        """Return whether a home is one of the catalog's."""
        return name in self.catalog()

    def _edges(self, name: str) -> frozenset[Edge]:
        """Return the edges of a home."""
        return frozenset(World.start(self.home(name)).edges())

    def _home(self, name: str) -> Home:
        """Return the home to which environments of that name are differences."""
        from hearth.grounding.environments.default_state import prepared

        if self.in_catalog(name):
            return prepared(Home.from_graph(self.graph(name), name, self.knowledge)).home
        return Home.from_graph(self._stored("sample", name), name, self.knowledge)

    def _stored(self, stage: str, name: str) -> EnvironmentGraph:
        path = inside(self._settings.folder(stage) / DERIVED, f"{name}.json")
        return from_release(orjson.loads(path.read_bytes()), str(path))
