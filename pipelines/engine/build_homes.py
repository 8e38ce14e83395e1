"""The homes of a build: the catalog, the user's homes laid over it, and homes derived from stored start graphs."""

from functools import cache

import orjson

from hearth.pipelines.engine.context import knowledge
from hearth.pipelines.engine.settings import Settings
from hearth.schemas.graph import Edge, EnvironmentGraph, from_release
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World
from hearth.storage.names import inside

DERIVED = "homes"
"""Folder of the sample stage that holds homes derived from stored start graphs."""


class Homes:
    """The homes of a build, built once a process: the catalog's in their default state, derived ones as stored."""

    def __init__(self, settings: Settings) -> None:
        self._settings = settings
        self.home, self.edges = cache(self._home), cache(self._edges)
        self.knowledge = knowledge(settings)

    def names(self) -> tuple[str, ...]:
        """Homes to sample in: those named in the settings, or all of the catalog.

        Raises:
            HearthError: UNKNOWN_HOME.
        """
        from hearth.homes import library

        for name in self._settings.homes:
            library.load_graph(name, self.knowledge, self._settings.homes_folder)
        return self._settings.homes or library.names(self._settings.homes_folder)

    def catalog(self) -> tuple[str, ...]:
        """All homes of ours and of the user's folder."""
        from hearth.homes import library

        return library.names(self._settings.homes_folder)

    def in_catalog(self, name: str) -> bool:
        """Whether a home is one of the catalog's."""
        return name in self.catalog()

    def _edges(self, name: str) -> frozenset[Edge]:
        """The edges of a home."""
        return frozenset(World.start(self.home(name)).edges())

    def _home(self, name: str) -> Home:
        """The home to which environments of that name are differences."""
        from hearth.grounding.environments.default_state import prepared
        from hearth.homes import library

        if self.in_catalog(name):
            graph = library.load_graph(name, self.knowledge, self._settings.homes_folder)
            return prepared(Home.from_graph(graph, name, self.knowledge)).home
        return Home.from_graph(self._derived(name), name, self.knowledge)

    def _derived(self, name: str) -> EnvironmentGraph:
        path = inside(self._settings.folder("sample") / DERIVED, f"{name}.json")
        return from_release(orjson.loads(path.read_bytes()), str(path))
