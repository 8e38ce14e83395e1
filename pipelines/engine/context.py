"""The knowledge of a build, and the digests of the user's overlays in a plan."""

from dataclasses import replace
from pathlib import Path
from typing import Any

from hearth.datasets.dataset_knowledge import FOLDER, copy_overlay, made_with
from hearth.kb.knowledge import Knowledge
from hearth.kb.loading.load import digest as knowledge_digest
from hearth.kb.loading.load import overlaid
from hearth.pipelines.engine.settings import Settings
from hearth.pipelines.engine.stage import Job
from hearth.storage.files import tree_digest


def knowledge(settings: Settings) -> Knowledge:
    """Our knowledge, with the user's laid over it."""
    return overlaid(Path(settings.kb_folder) if settings.kb_folder else None)


def knowledge_used(job: Job) -> dict[str, Any]:
    """The knowledge that a stage used, for its manifest."""
    return made_with(job.settings.kb_folder, job.folder)


def keep_knowledge(job: Job) -> None:
    """Copy the user's knowledge into the stage's folder, for stages that are run alone later."""
    copy_overlay(job.settings.kb_folder, job.folder)


def kept_knowledge(settings: Settings) -> Settings:
    """The settings, with the knowledge that `validate` used if they name none."""
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
