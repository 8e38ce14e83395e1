"""The user's own parts of a build, knowledge and homes: kept for stages run alone, named in plans and manifests."""

from dataclasses import replace
from pathlib import Path
from typing import Any

from hearth.datasets import dataset_homes, dataset_knowledge
from hearth.kb.action_sets import NEW_DATASETS, number_of_set
from hearth.pipelines.engine.build_context import knowledge_laid_over, knowledge_used
from hearth.pipelines.engine.settings import Settings
from hearth.pipelines.engine.stage import Job
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.manifest import read_manifest


def keep_homes(job: Job) -> None:
    """Copy the user's homes into the stage's folder, for stages that are run alone later."""
    dataset_homes.copy_homes(job.settings.homes_folder, job.folder)


def kept_overlays(settings: Settings, only: str) -> Settings:
    """Return the settings of a stage run alone.

    Knowledge that they do not name is `validate`'s, homes are `sample`'s, the action set is that of the stages before.
    Before `validate` there is none: it begins with that of new datasets.

    Raises:
        HearthError: BAD_ARGUMENT, when they name another action set than that of `sample`, whose executions the stage
            reads.
    """
    settings = _of_same_set(settings, only)
    known = settings.folder("validate") / dataset_knowledge.FOLDER
    homes = settings.folder("sample") / dataset_homes.FOLDER
    if only != "validate" and not settings.kb_folder and known.is_dir():
        settings = replace(settings, kb_folder=str(known))
    if only not in ("validate", "sample") and not settings.homes_folder and homes.is_dir():
        settings = replace(settings, homes_folder=str(homes))
    return settings


def _of_same_set(settings: Settings, only: str) -> Settings:
    stages = {"ingest": (), "validate": (), "sample": ("validate",)}.get(only, ("sample", "validate"))
    for stage in stages:
        manifest = read_manifest(settings.folder(stage))
        if manifest is None:
            continue
        made = number_of_set(manifest.content["action_set"])
        if stage == "sample" and settings.action_set not in (None, made):
            message = f"its executions are of action set {made}, not {settings.action_set}"
            remedy = f"leave --action-set out, or run `sample --action-set {settings.action_set}` first"
            raise HearthError.of(Code.BAD_ARGUMENT, message, file=str(manifest.folder), suggestion=remedy)
        return settings if settings.action_set is not None else replace(settings, action_set=made)
    return of_new_dataset(settings)


def of_new_dataset(settings: Settings) -> Settings:
    """Return the settings of a build of all stages: without an action set they get that of new datasets."""
    return settings if settings.action_set is not None else replace(settings, action_set=NEW_DATASETS)


def overlays(settings: Settings) -> dict[str, Any]:
    """Digests of the user's own knowledge and homes, for a plan; errors as of `knowledge_laid_over`."""
    made = knowledge_laid_over(settings)
    if settings.homes_folder:
        made["homes_overlay"] = dataset_homes.digest(Path(settings.homes_folder))
    return made


def overlays_used(job: Job) -> dict[str, Any]:
    """Return the knowledge and homes that a stage used, for its manifest."""
    return {**knowledge_used(job), **dataset_homes.homes_used(job.settings.homes_folder, job.folder)}
