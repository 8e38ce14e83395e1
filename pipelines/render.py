"""Stage 5: pictures of a few programs while they run: the home from above and one camera, colour and instance ids."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, NamedTuple

from hearth.pipelines.cases import rerun
from hearth.pipelines.files import value_digest, write_bytes
from hearth.pipelines.manifest import read_manifest
from hearth.pipelines.parts import READ_BATCH, Row, read_rows
from hearth.pipelines.settings import Settings
from hearth.pipelines.stage import Job, Partition, Record, Stage
from hearth.pipelines.surroundings import USES, Homes, overlays
from hearth.schemas.tables import RENDERED

if TYPE_CHECKING:
    from hearth.rendering.camera import Camera
    from hearth.rendering.snapshots import Snapshot

AUTO = "auto"
TOP = "top"

FRAMES = "frames"
"""Folder of the pictures, in the stage's own folder and in the dataset."""


class Context(NamedTuple):
    """What a case is filmed with."""

    homes: Homes
    job: Job


def process(case: Record, context: Context) -> Iterator[Row]:
    """One row for each picture of a case."""
    from hearth.rendering.png import encode
    from hearth.rendering.snapshots import snapshots
    from hearth.simulation.homes import catalog

    job = context.job
    home = catalog.load_graph(case["home"], job.settings.homes_folder)
    execution = rerun(case, context.homes)
    folder = _folder(case["execution_id"])
    for shot in snapshots(execution, home, knowledge=context.homes.knowledge):
        for modality, picture in shot.pictures.items():
            name = f"{FRAMES}/{folder}/{shot.tick:03d}.{_view(shot.camera)}.{modality}.png"
            path = job.folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            write_bytes(path, encode(picture))
            yield {**_camera(shot.camera), **_told(case, shot, modality), "file": name}


def _folder(execution_id: str) -> str:
    """A folder's name that any file system takes, and that no two executions share."""
    words = "".join(letter if letter.isalnum() or letter in "-_." else "_" for letter in execution_id)
    return f"{words.strip('._')[-80:]}-{value_digest(execution_id)[:8]}"


def _view(camera: Camera) -> str:
    """`top`, or `auto` for the camera of the room that was chosen: its name is in the row."""
    return TOP if camera.name == TOP else AUTO


def _camera(camera: Camera) -> Row:
    matrix = camera.intrinsics
    return {
        "camera": camera.name,
        "width": camera.width,
        "height": camera.height,
        "intrinsics": {
            "fx": float(matrix[0, 0]),
            "fy": float(matrix[1, 1]),
            "cx": float(matrix[0, 2]),
            "cy": float(matrix[1, 2]),
        },
        "pose": [float(number) for number in camera.pose.flatten()],
    }


def _told(case: Record, shot: Snapshot, modality: str) -> Row:
    return {"execution_id": case["execution_id"], "tick": shot.tick, "modality": modality}


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


def chosen(job: Job, partition: Partition) -> Iterator[Record]:
    """The cases of a part that are to be filmed; the others, nearly all, are never turned into rows."""
    import pyarrow as pa
    import pyarrow.compute as pc
    import pyarrow.parquet as pq

    wanted = pa.array(job.plan["executions"], pa.string())
    with pq.ParquetFile(partition.payload) as file:
        if not pc.any(pc.is_in(file.read(["execution_id"])["execution_id"], wanted)).as_py():
            return
        for batch in file.iter_batches(batch_size=READ_BATCH):
            yield from batch.filter(pc.is_in(batch["execution_id"], wanted)).to_pylist()


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
    records=chosen,
    identify=lambda case: str(case["execution_id"]),
)
