"""The stages, in order. To add one: a file that defines `STAGE`, and a row here."""

import importlib

from hearth.pipelines.engine.stage import NOTE, Plan, Stage
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

STAGES: dict[str, str] = {
    "ingest": "hearth.pipelines.ingest",
    "validate": "hearth.pipelines.validate",
    "sample": "hearth.pipelines.sample",
    "augment": "hearth.pipelines.augment",
    "render": "hearth.pipelines.render",
    "publish": "hearth.pipelines.publish",
}
"""The module of each stage, imported when the stage is run."""


RECORDS = {
    "ingest": "records of the sources: programs, descriptions, sketches, scenes",
    "validate": "programs; descriptions and sketches go on to publish",
    "sample": "valid programs, each run in several homes",
    "augment": "executions of originals, each in several perturbed environments",
    "render": "executions chosen for pictures",
    "publish": "executions of sample and of augment",
}
"""The meaning of a record of each stage: its input is counted in these."""


def record_of(name: str, plan: Plan) -> str:
    """Return the meaning of a record of a stage, and its plan's note of the records left out."""
    return "; ".join(filter(None, (RECORDS[name], plan.get(NOTE))))


def stage(name: str) -> Stage:
    """Return the stage of that name.

    Raises:
        HearthError: UNKNOWN_ID, with the names of the stages.
    """
    if name not in STAGES:
        suggestion = f"stages are {', '.join(STAGES)}"
        raise HearthError.of(Code.UNKNOWN_ID, f"unknown stage `{name}`", suggestion=suggestion)
    found: Stage = importlib.import_module(STAGES[name]).STAGE
    return found
