"""The knowledge of a build, and the digest of the user's own in a plan."""

from pathlib import Path
from typing import Any

from hearth.datasets.dataset_knowledge import copy_overlay, made_with
from hearth.kb.action_sets import USUAL, name_of_set
from hearth.kb.knowledge import Knowledge
from hearth.kb.loading.load import digest, overlaid
from hearth.pipelines.engine.settings import Settings
from hearth.pipelines.engine.stage import Job


def knowledge(settings: Settings) -> Knowledge:
    """Our knowledge, with the user's laid over it, and the actions of the build's set."""
    known = overlaid(Path(settings.kb_folder) if settings.kb_folder else None)
    return known.of_set(settings.action_set or USUAL)


def set_used(settings: Settings) -> dict[str, Any]:
    """Return the name of the build's action set, for a manifest or a row."""
    return {"action_set": name_of_set(settings.action_set or USUAL)}


def knowledge_used(job: Job) -> dict[str, Any]:
    """Return the knowledge that a stage used, for its manifest."""
    return made_with(job.settings.kb_folder, job.folder)


def keep_knowledge(job: Job) -> None:
    """Copy the user's knowledge into the stage's folder, for stages that are run alone later."""
    copy_overlay(job.settings.kb_folder, job.folder)


def knowledge_laid_over(settings: Settings) -> dict[str, Any]:
    """Digest of the user's own knowledge, for a plan.

    Raises:
        HearthError: a folder is not there; every fault of the knowledge.
    """
    if not settings.kb_folder:
        return {}
    knowledge(settings)
    return {"kb_overlay": digest(Path(settings.kb_folder))}
