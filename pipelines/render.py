"""Stage 5: pictures of a few programs while they run: the home from above, and one camera; colour and instance ids."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple

from hearth.pipelines.cases import rerun
from hearth.pipelines.files import write_bytes
from hearth.pipelines.manifest import read_manifest
from hearth.pipelines.parts import Row, read_rows
from hearth.pipelines.rejects import Reject
from hearth.pipelines.settings import Settings
from hearth.pipelines.stage import Job, Record, Stage
from hearth.pipelines.surroundings import USES, Homes, overlays
from hearth.schemas.tables import RENDERED

FRAMES = "frames"
"""Folder of the pictures, in the stage's own folder and in the dataset."""


class Context(NamedTuple):
    """What a case is filmed with."""

    homes: Homes
    job: Job


def process(case: Record, context: Context) -> Iterable[Row] | Reject:
    """One row for each picture of a case."""
    from hearth.rendering import snapshots

    execution = rerun(case, context.homes)
    return _pictures(case, context, snapshots.film(execution, context.homes.layout(case["home"])))


def _pictures(case: Record, context: Context, shots: Iterable[Any]) -> Iterator[Row]:
    folder = "".join(letter if letter.isalnum() or letter in "-_." else "_" for letter in case["execution_id"])
    for shot in shots:
        name = f"{FRAMES}/{folder}/{shot.tick:03d}_{shot.camera}_{shot.modality}.png"
        path = context.job.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        write_bytes(path, shot.png)
        yield {"execution_id": case["execution_id"], "file": name}


def prepare(settings: Settings) -> dict[str, Any]:
    """Choose the executions: the first ones of different programs, in homes that have geometry."""
    homes = Homes(settings)
    chosen: dict[str, str] = {}
    manifest = read_manifest(settings.folder("sample"))
    for part in manifest.parts if manifest else ():
        for file in part["files"]:
            for row in read_rows(manifest.folder / file, ["program_id", "execution_id", "home", "executable"]):
                if len(chosen) < settings.pictures and row["executable"] and homes.in_catalog(row["home"]):
                    chosen.setdefault(row["program_id"], row["execution_id"])
    return {**overlays(settings), "executions": sorted(chosen.values())}


def is_chosen(case: Record, plan: dict[str, Any]) -> bool:
    """Whether a case is to be filmed."""
    return case["execution_id"] in plan["executions"]


def open_context(job: Job) -> Context:
    """Homes, built when first asked for."""
    return Context(Homes(job.settings), job)


STAGE = Stage(
    name="render",
    tables={"": RENDERED},
    process=process,
    reads=("sample",),
    uses=(*USES, "grounding", "rendering", "pipelines/render.py", "pipelines/cases.py"),
    settings=("pictures",),
    open=open_context,
    prepare=prepare,
    select=is_chosen,
    identify=lambda case: str(case["execution_id"]),
)
