"""What stages run programs in: the knowledge and the homes that a build was asked to use."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import orjson

from hearth.kb.knowledge import Knowledge
from hearth.kb.loading import digest as knowledge_digest
from hearth.kb.loading import laid_over
from hearth.pipelines.dataset_knowledge import FOLDER, copy_overlay, made_with
from hearth.pipelines.files import tree_digest
from hearth.pipelines.settings import Settings
from hearth.pipelines.stage import Job
from hearth.schemas.graph import Edge, EnvironmentGraph, from_release
from hearth.simulation.home import Home
from hearth.simulation.rules import DEFAULT, REPLAY, Rules
from hearth.simulation.world import World

DERIVED = "homes"
"""Folder of the sample stage that holds homes derived from stored start graphs."""

USES = ("kb", "simulation", "data_raw/homes", "pipelines/surroundings.py", "pipelines/rows.py")
"""What stages that run programs depend on."""


def knowledge(settings: Settings) -> Knowledge:
    """Our knowledge, with the user's laid over it."""
    return laid_over(Path(settings.kb_folder) if settings.kb_folder else None)


def knowledge_used(job: Job) -> dict[str, Any]:
    """Which knowledge a stage used, for its manifest."""
    return made_with(job.settings.kb_folder, job.folder)


def keep_knowledge(job: Job) -> None:
    """Copy what is laid over our knowledge into the stage's folder, for stages that are run alone later."""
    copy_overlay(job.settings.kb_folder, job.folder)


def kept_knowledge(settings: Settings) -> Settings:
    """The options, with the knowledge that the programs were checked with where they name none."""
    folder = settings.folder("validate") / FOLDER
    return settings if settings.kb_folder or not folder.is_dir() else replace(settings, kb_folder=str(folder))


def overlays(settings: Settings) -> dict[str, Any]:
    """Digests of the user's own knowledge and homes, for a plan.

    Raises:
        HearthError: a folder is not there; every fault of the knowledge.
    """
    made: dict[str, Any] = {}
    if settings.kb_folder:
        knowledge(settings)
        made["kb_overlay"] = knowledge_digest(Path(settings.kb_folder))
    if settings.homes_folder:
        made["homes_overlay"] = tree_digest(Path(settings.homes_folder))
    return made


RULES: dict[str, Rules] = {"default": DEFAULT, "replay": REPLAY}
"""The engine's options, by the names that rows give them."""


class Homes:
    """The homes of a build by name, each built once a process: the catalog's at rest, derived ones as they are."""

    def __init__(self, settings: Settings) -> None:
        self._settings = settings
        self._homes: dict[str, Home] = {}
        self._edges: dict[str, frozenset[Edge]] = {}
        self.knowledge = knowledge(settings)

    def names(self) -> tuple[str, ...]:
        """Homes to sample in: those asked for, or all of the catalog.

        Raises:
            HearthError: UNKNOWN_HOME.
        """
        from hearth.simulation.homes import catalog

        for name in self._settings.homes:
            catalog.load_graph(name, self._settings.homes_folder)
        return self._settings.homes or catalog.names(self._settings.homes_folder)

    def catalog(self) -> tuple[str, ...]:
        """All homes that come with us, or are laid over ours."""
        from hearth.simulation.homes import catalog

        return catalog.names(self._settings.homes_folder)

    def in_catalog(self, name: str) -> bool:
        """Whether a home is one of the catalog's."""
        from hearth.simulation.homes import catalog

        return name in catalog.names(self._settings.homes_folder)

    def home(self, name: str) -> Home:
        """The home that environments of that name differ from."""
        if name not in self._homes:
            self._homes[name] = self._build(name)
        return self._homes[name]

    def edges(self, name: str) -> frozenset[Edge]:
        """Its edges."""
        if name not in self._edges:
            self._edges[name] = frozenset(World.start(self.home(name)).edges())
        return self._edges[name]

    def _build(self, name: str) -> Home:
        from hearth.grounding.base import prepared
        from hearth.simulation.homes import catalog

        if self.in_catalog(name):
            return prepared(
                Home.from_graph(catalog.load_graph(name, self._settings.homes_folder), name, self.knowledge)
            ).home
        return Home.from_graph(self._derived(name), name, self.knowledge)

    def _derived(self, name: str) -> EnvironmentGraph:
        path = self._settings.folder("sample") / DERIVED / f"{name}.json"
        return from_release(orjson.loads(path.read_bytes()), str(path))
