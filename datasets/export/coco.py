"""`coco`: pictures with the things in them, as COCO's instances."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import orjson

from hearth.datasets.damage_faults import reading
from hearth.datasets.dataset import Dataset
from hearth.datasets.export.program_batches import Wanted
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.names import inside

if TYPE_CHECKING:
    from numpy.typing import NDArray

_SHOTS = """SELECT p.execution_id, p.tick, p.camera, p.width, p.height, p.file AS picture, m.file AS mask, e.program_id
    FROM frames p JOIN frames m USING (execution_id, tick, camera) JOIN executions e USING (execution_id)
    WHERE p.modality = 'rgb' AND m.modality = 'instance_ids' AND e.program_id IN ({chosen})
    ORDER BY p.execution_id, p.tick, p.camera"""


def coco(dataset: Dataset, to: Path, wanted: Wanted) -> int:
    """Write `instances.json` and the folder `images`: each picture that has a mask of instances.

    `load_dataset("imagefolder", data_dir=".../images")` gives the pictures and their columns.

    An annotation is one thing in one picture, with its node, box, area and mask (COCO's run lengths). Categories are
    the classes of `vocabulary`. Parts of a mask without a node of the graph, such as walls, are background.

    Returns:
        Number of pictures.

    Raises:
        HearthError: NOT_RENDERED, where no picture has a mask; DAMAGED_FILE, where a picture is not one.
    """
    chosen, asked = wanted.chosen()
    shots = dataset.read(_SHOTS.format(chosen=chosen), asked or None)
    if not shots:
        remedy = "build with --pictures N, or publish the tier `frames`"
        raise HearthError.of(Code.NOT_RENDERED, "no picture with a mask", file=str(dataset.folder), suggestion=remedy)
    known = dict(dataset.rows("SELECT name, id FROM vocabulary WHERE kind = 'class' ORDER BY id")[1])
    categories = [{"id": number + 1, "name": name} for name, number in known.items()]
    (to / "images").mkdir(parents=True, exist_ok=True)
    images, annotations = [], 0
    with (to / "instances.json").open("wb") as file:
        file.write(b'{"info":{"description":"Hearth"},"categories":' + orjson.dumps(categories) + b',"annotations":[')
        for number, (shot, classes) in enumerate(_with_classes(dataset, shots), 1):
            images.append(_image(dataset, to, number, shot))
            for each in _things(_mask(dataset, shot["mask"]), classes, known):
                annotations += 1
                row = {"id": annotations, "image_id": number, **each}
                file.write((b",\n" if annotations > 1 else b"\n") + orjson.dumps(row))
        file.write(b'\n],"images":' + orjson.dumps(images) + b"}\n")
    lines = b"".join(orjson.dumps(each, option=orjson.OPT_APPEND_NEWLINE) for each in images)
    (to / "images/metadata.jsonl").write_bytes(lines)
    return len(images)


def _with_classes(dataset: Dataset, shots: list[Any]) -> Iterator[tuple[Any, dict[int, str]]]:
    """Yield each picture with the class of every node of its graph, which is made once for all cameras of a tick."""
    graph_of: tuple[Any, dict[int, str]] = None, {}
    query = "SELECT id, class_name FROM graph_nodes($execution, $tick)"
    for shot in shots:
        key = shot["execution_id"], shot["tick"]
        if graph_of[0] != key:
            graph_of = key, dict(dataset.rows(query, execution=key[0], tick=key[1])[1])
        yield shot, graph_of[1]


def _image(dataset: Dataset, to: Path, number: int, shot: Any) -> dict[str, Any]:
    """Copy a picture under a name of ours, and return its entry."""
    name = f"{number:012}.png"
    with reading(dataset.folder):
        shutil.copyfile(inside(dataset.folder, shot["picture"]), inside(to, f"images/{name}"))
    about = {key: shot[key] for key in ("width", "height", "execution_id", "program_id", "tick", "camera")}
    return {"id": number, "file_name": name, **about}


def _mask(dataset: Dataset, name: str) -> NDArray[Any]:
    from hearth.rendering.film.png import decode

    with reading(dataset.folder):
        return decode(inside(dataset.folder, name).read_bytes())


def _things(mask: NDArray[Any], classes: dict[int, str], known: dict[str, int]) -> Iterator[dict[str, Any]]:
    """Yield the annotation of each thing in a picture, by node id."""
    for node in np.unique(mask).tolist():
        if classes.get(node) not in known:
            continue
        shown = mask == node
        rows, columns = np.flatnonzero(shown.any(axis=1)), np.flatnonzero(shown.any(axis=0))
        left, top = int(columns[0]), int(rows[0])
        yield {
            "category_id": known[classes[node]] + 1,
            "node_id": node,
            "bbox": [left, top, int(columns[-1]) + 1 - left, int(rows[-1]) + 1 - top],
            "area": int(shown.sum()),
            "iscrowd": 0,
            "segmentation": {"size": list(mask.shape), "counts": run_lengths(shown)},
        }


def run_lengths(shown: NDArray[Any]) -> list[int]:
    """COCO's run lengths of a mask: column by column, how many pixels are off, on, off, and so on."""
    flat = shown.ravel(order="F")
    ends = np.flatnonzero(flat[1:] != flat[:-1]) + 1
    lengths: list[int] = np.diff([0, *ends.tolist(), len(flat)]).tolist()
    return [0, *lengths] if flat[0] else lengths
