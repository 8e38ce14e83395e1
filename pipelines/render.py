"""Stage 5: pictures of a few executions, from above and by one camera, as colour and instance ids; and films of some.

Each film has its own light, bodies, designs, positions and speed. Films for clips are small, and arrays; so are
demonstrations, pictures from above alone with class masks.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterator
from typing import TYPE_CHECKING, Any, NamedTuple

import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.parquet as pq

from hearth.datasets.format.case_rows import rerun
from hearth.pipelines.engine import executions_for_clips, executions_for_demonstrations
from hearth.pipelines.engine.build_homes import Homes
from hearth.pipelines.engine.settings import Settings
from hearth.pipelines.engine.split_assignment import programs_of
from hearth.pipelines.engine.stage import NOTE, Job, Partition, Plan, Stage
from hearth.pipelines.engine.user_overlays import overlays, overlays_used
from hearth.rendering.film.film_rate import FILM_RATE
from hearth.schemas.optional_libraries import lacking
from hearth.schemas.row_types import PinholeRow, TrackRow
from hearth.schemas.stage_rows import CaseRow, ClippedRow, DemonstratedRow, FilmedRow, RenderedRow
from hearth.schemas.tables import CLIPPED, DEMONSTRATED, FILMED, RENDERED
from hearth.storage.batch_sizes import ROWS_READ
from hearth.storage.files import value_digest, write_bytes
from hearth.storage.manifest import read_manifest
from hearth.storage.partitions import read_rows

if TYPE_CHECKING:
    from hearth.rendering.cameras.camera import Camera
    from hearth.rendering.film.execution_pictures import Snapshot
    from hearth.rendering.scene.home_geometry import DrawableHome
    from hearth.simulation.engine import Execution

AUTO = "auto"
TOP = "top"

FRAMES = "frames"
"""Folder of the pictures, in the stage's own folder and in the dataset."""

FILMS = "films"
"""Folder of the films, in both."""


class Context(NamedTuple):
    """The resources for filming a case."""

    homes: Homes
    job: Job
    drawable: dict[str, DrawableHome]

    def home(self, name: str) -> DrawableHome:
        """Return a home with geometry, derived from its relations if it has none; once a process."""
        from hearth.rendering.scene.home_geometry import with_geometry

        if name not in self.drawable:
            self.drawable[name] = with_geometry(self.homes.graph(name), name, self.homes.knowledge)
        return self.drawable[name]


Made = RenderedRow | FilmedRow | ClippedRow | DemonstratedRow
"""A row of any of the stage's tables."""


def process(case: CaseRow, context: Context) -> Iterator[tuple[str, Made]]:
    """One row for each picture of a case, its film, its clips and its demonstration, if any."""
    from hearth.rendering.film.execution_pictures import snapshots
    from hearth.rendering.film.png import encode

    job, place = context.job, context.home(case["home"])
    home = place.graph
    execution = rerun(case, context.homes)
    folder = _folder(case["execution_id"])
    if case["execution_id"] in job.plan["films"]:
        yield "videos", _film(case, execution, place, context)
    if case["execution_id"] in job.plan["clips"]:
        yield from (("clips", row) for row in _clips(case, execution, place, context))
    if case["execution_id"] in job.plan["demonstrations"]:
        yield from (("demonstration_frames", row) for row in _demonstrated(case, execution, place, context))
    if case["execution_id"] not in job.plan["pictures"]:
        return
    for shot in snapshots(execution, home, context.homes.knowledge):
        for modality, picture in shot.pictures.items():
            name = f"{FRAMES}/{folder}/{shot.tick:03d}.{_view(shot.camera)}.{modality}.png"
            path = job.folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            write_bytes(path, encode(picture))
            yield "", _picture(case, shot, modality, place.made, name)


FILM_SIZE = (320, 240)
"""Width and height of a film in pixels, and its pictures a second."""


def _film(case: CaseRow, execution: Execution, place: DrawableHome, context: Context) -> FilmedRow:
    """Write a film as webm, which browsers play; they do not play the mp4 that OpenCV writes."""
    from hearth.rendering.film.execution_keyframes import trajectory_of
    from hearth.rendering.film.video import record
    from hearth.rendering.scene.film_variation import drawn

    name, job, home = case["execution_id"], context.job, place.graph
    folder = f"{FILMS}/{_folder(name)}"
    (job.folder / folder).mkdir(parents=True, exist_ok=True)
    variation = drawn(job.settings.seed, name)
    trajectory = trajectory_of(execution, home, context.homes.knowledge, variation=variation)
    done = record(trajectory, home, job.folder / folder, AUTO, size=FILM_SIZE, fps=FILM_RATE, suffixes=(".webm",))
    return {
        "execution_id": name,
        "camera": AUTO,
        "width": FILM_SIZE[0],
        "height": FILM_SIZE[1],
        "fps": FILM_RATE,
        "frames": done.frames,
        "seconds": done.frames / FILM_RATE,
        "steps": done.steps,
        "track": list(_track(done.track)),
        "variation": variation.row(),
        "layout_made": place.made,
        "file": f"{folder}/{done.files[0].name}",
    }


def _clips(case: CaseRow, execution: Execution, place: DrawableHome, context: Context) -> Iterator[ClippedRow]:
    """Write a film's arrays, and give the rows of its clips; no file without clips."""
    from hearth.rendering.film import clips
    from hearth.rendering.film.clip_file import FILE
    from hearth.rendering.film.execution_keyframes import trajectory_of
    from hearth.rendering.scene.film_variation import drawn

    name, job, known = case["execution_id"], context.job, context.homes.knowledge
    trajectory = trajectory_of(execution, place.graph, known, variation=drawn(job.settings.seed, name))
    coloured = executions_for_clips.coloured(name, job.settings.seed)
    film = clips.clip_film(trajectory, place.graph, known.class_ids, clips.MODALITIES if coloured else clips.MASKS_ONLY)
    if not film.clips:
        return
    file = f"{FILMS}/{_folder(name)}/{FILE}"
    path = job.folder / file
    path.parent.mkdir(parents=True, exist_ok=True)
    write_bytes(path, clips.stored(film))
    part, kind = job.plan["clips"][name]
    for number, clip in enumerate(film.clips):
        yield {
            "execution_id": name,
            "number": number,
            "part": part,
            "kind": kind,
            "tick": clip.tick,
            "action": clip.step.action,
            "objects": [ref.name for ref in clip.step.objects],
            "first": clip.first,
            "frames": clips.FRAMES,
            "fps": clips.RATE,
            "width": clips.SIZE[0],
            "height": clips.SIZE[1],
            "camera": clip.camera,
            "modalities": sorted(film.pictures),
            "file": file,
        }


def _demonstrated(
    case: CaseRow, execution: Execution, place: DrawableHome, context: Context
) -> Iterator[DemonstratedRow]:
    """Write a demonstration's arrays, and give the rows of its pictures."""
    from hearth.rendering.film import pictures_from_above

    job, known = context.job, context.homes.knowledge
    found = pictures_from_above.demonstration(execution, place.graph, known, known.class_ids, job.settings.seed)
    file = f"{FRAMES}/{_folder(case['execution_id'])}/{pictures_from_above.FILE}"
    path = job.folder / file
    path.parent.mkdir(parents=True, exist_ok=True)
    write_bytes(path, pictures_from_above.stored(found))
    for number in range(len(found.class_ids)):
        yield {
            "execution_id": case["execution_id"],
            "tick": number,
            "index": number,
            "width": found.camera.width,
            "height": found.camera.height,
            "intrinsics": _intrinsics(found.camera),
            "pose": _pose(found.camera),
            "layout_made": place.made,
            "file": file,
        }


def _track(track: list[tuple[int, Camera]]) -> Iterator[TrackRow]:
    """Yield the pictures at which the tick or the camera changes."""
    before: tuple[int, Camera] | None = None
    for number, (tick, camera) in enumerate(track):
        if before != (tick, camera):
            yield {
                "frame": number,
                "tick": tick,
                "camera": camera.name,
                "intrinsics": _intrinsics(camera),
                "pose": _pose(camera),
            }
        before = (tick, camera)


def _folder(execution_id: str) -> str:
    """Return a folder name, unique to the execution, that any file system accepts."""
    words = "".join(letter if letter.isalnum() or letter in "-_." else "_" for letter in execution_id)
    return f"{words.strip('._')[-80:]}-{value_digest(execution_id)[:8]}"


def _view(camera: Camera) -> str:
    """`top`, or `auto` for the chosen camera of the room, whose name is in the row."""
    return TOP if camera.name == TOP else AUTO


def _picture(case: CaseRow, shot: Snapshot, modality: str, made: bool, file: str) -> RenderedRow:
    return {
        "execution_id": case["execution_id"],
        "tick": shot.tick,
        "camera": shot.camera.name,
        "modality": modality,
        "width": shot.camera.width,
        "height": shot.camera.height,
        "intrinsics": _intrinsics(shot.camera),
        "pose": _pose(shot.camera),
        "start_time": None,
        "end_time": None,
        "layout_made": made,
        "file": file,
    }


def _intrinsics(camera: Camera) -> PinholeRow:
    matrix = camera.intrinsics
    return {"fx": float(matrix[0, 0]), "fy": float(matrix[1, 1]), "cx": float(matrix[0, 2]), "cy": float(matrix[1, 2])}


def _pose(camera: Camera) -> list[float]:
    """Camera to world, 4 by 4, row by row."""
    return [float(number) for number in camera.pose.flatten()]


def prepare(settings: Settings) -> Plan:
    """Choose the executions; none if libraries for pictures are not installed, which is not a fault of the data."""
    chosen, absent = _chosen(settings), lacking("pictures")
    if absent:
        left = f"{len(chosen['executions']):,} left out: {', '.join(absent)} not installed"
        noted = {NOTE: left} if chosen["executions"] else {}
        chosen = {**{name: type(value)() for name, value in chosen.items()}, **noted}
    return {**overlays(settings), **chosen, "lacking": absent}


def _chosen(settings: Settings) -> Plan:
    """Choose the executions: the first ones of different programs, in homes of the catalog."""
    homes = Homes(settings)
    wanted = max(settings.pictures, settings.videos)
    found: dict[str, tuple[str, str]] = {}
    ran: list[tuple[str, str, str]] = []
    files: dict[str, str] = {}
    for file, row in _sampled(settings):
        if len(found) >= wanted and not settings.clips and not settings.demonstrations:
            break
        if row["executable"] and homes.in_catalog(row["home"]):
            if len(found) < wanted:
                found.setdefault(row["program_id"], (row["execution_id"], file))
            if settings.clips or settings.demonstrations:
                ran.append((row["program_id"], row["execution_id"], row["home"]))
                files[row["execution_id"]] = file
    films = sorted(name for name, _ in list(found.values())[: settings.videos])
    steps = _steps(settings) if settings.clips else {}
    clips = dict(sorted(executions_for_clips.chosen(ran, steps, homes.names(), settings.clips, settings.seed).items()))
    above = executions_for_demonstrations.chosen(ran, homes.names(), settings.demonstrations, settings.seed)
    executions = dict(sorted([*found.values(), *((name, files[name]) for name in clips)]))
    executions |= {name: files[name] for name in above if name not in executions}
    chosen = {"executions": executions, "pictures": sorted(dict(found.values())), "films": films, "clips": clips}
    return chosen | {"demonstrations": above}


def no_pictures(libraries: list[str]) -> str:
    """Return the message of a build without these libraries."""
    return f"pictures are left out: {', '.join(libraries)} not installed"


def _sampled(settings: Settings) -> Iterator[tuple[str, Any]]:
    """Yield every case with its file, of the columns that the choice needs."""
    folder = settings.folder("sample")
    for file in _sample_files(settings):
        for row in read_rows(folder / file, ["program_id", "execution_id", "home", "executable"]):
            yield file, row


def _sample_files(settings: Settings) -> list[str]:
    """Return the files of cases in the folder of the stage `sample`."""
    manifest = read_manifest(settings.folder("sample"))
    return [file for part in manifest.parts for file in part["files"]] if manifest else []


def _steps(settings: Settings) -> dict[str, Hashable]:
    """Return the keys that distinguish the steps of each program: actions and classes."""
    files = [settings.folder("sample") / file for file in _sample_files(settings)]
    return {each.program_id: each.steps for each in programs_of(files, settings.seed)}


SHARES = 64
"""Partitions at most: enough for all workers, and a killed run loses little."""


def partitions(job: Job) -> Iterator[Partition]:
    """Yield the chosen executions, a few at a time; one empty partition if there are none."""
    manifest = read_manifest(job.settings.folder("sample"))
    known: dict[str, str] = job.plan["executions"]
    executions = list(known)
    size = max(1, -(-len(executions) // SHARES))
    for number, start in enumerate(range(0, max(len(executions), 1), size)):
        share = executions[start : start + size]
        files = sorted({known[execution] for execution in share})
        digests = [manifest.content["files"][file]["sha256"] for file in files] if manifest else []
        yield Partition(number, value_digest([digests, share]), share, len(share))


def records(job: Job, partition: Partition) -> Iterator[CaseRow]:
    """Yield the cases of a partition; the others, nearly all, are never converted to rows."""
    left = {execution: job.plan["executions"][execution] for execution in partition.payload}
    for name in sorted(set(left.values())):
        wanted = pa.array([execution for execution, file in left.items() if file == name])
        count = len(wanted)
        with pq.ParquetFile(job.settings.folder("sample") / name) as file:
            for batch in file.iter_batches(batch_size=ROWS_READ):
                rows = batch.filter(pc.is_in(batch["execution_id"], wanted)).to_pylist()
                yield from rows
                count -= len(rows)
                if not count:
                    break


def open_context(job: Job) -> Context:
    """Homes, built when first used."""
    return Context(Homes(job.settings), job, {})


STAGE = Stage(
    name="render",
    tables={"": RENDERED, "videos": FILMED, "clips": CLIPPED, "demonstration_frames": DEMONSTRATED},
    process=process,
    reads=("sample",),
    settings=("pictures", "videos", "clips", "demonstrations", "seed", "action_set"),
    open=open_context,
    prepare=prepare,
    facts=overlays_used,
    partitions=partitions,
    records=records,
    time_factor=10,
    identify=lambda case: str(case["execution_id"]),
)
