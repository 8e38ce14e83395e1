"""Trajectories of ALFRED: people's descriptions of a task, and the plan that was carried out, as steps of ours.

Each file `traj_data.json` has a plan of high-level actions (`high_pddl`), the openings and closings that carry it out
(`low_actions`), and descriptions by several annotators (`turk_annotations`). It gives one program, described by its
first annotator, and a description for each further one.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import partial
from typing import Any

from hearth.kb.knowledge import Knowledge
from hearth.pipelines.readers.alfred_steps import UnreadableStepError, steps_of
from hearth.pipelines.readers.json_documents import document
from hearth.pipelines.readers.reader_items import Item, record, refused, worker_hash
from hearth.schemas.failures import Code
from hearth.schemas.stage_rows import IngestedRow
from hearth.storage.archives import Place
from hearth.storage.rejects import Reject

NAME = "alfred"
"""This reader's name in ids of records and in the column `origin`."""

KEYS = ("turk_annotations", "plan", "pddl_params")
"""Keys by which a trajectory is recognised."""


def is_trajectory(value: Any) -> bool:
    """Return whether a JSON value is a trajectory of ALFRED."""
    return isinstance(value, dict) and all(isinstance(value.get(key), dict) for key in KEYS)


def scan(path: Place, place: str) -> Iterator[Item]:
    """Yield an item for the plan with its first description, and one for each further description."""
    value = document(path, place)
    if isinstance(value, Reject):
        yield refused(place, value)
        return
    annotations = value["turk_annotations"].get("anns")
    if not isinstance(annotations, list) or not annotations:
        yield refused(place, Reject.of(Code.EMPTY, "a trajectory without a description", file=place,
                                       suggestion="`turk_annotations.anns` lists them"))  # fmt: skip
        return
    scene = value.get("scene")
    kept = {"plan": value["plan"], "scene": scene.get("floor_plan") if isinstance(scene, dict) else None}
    for number, annotation in enumerate(annotations, 1):
        name = f"{NAME}:{place}" if number == 1 else f"{NAME}:{place}:{number}"
        own = kept if number == 1 else {"scene": kept["scene"]}
        yield Item(name, NAME, place, {**own, "annotation": annotation})


def read(item: Item, salt: str, knowledge: Knowledge) -> Iterator[IngestedRow | Reject]:
    """Yield the record of a program with its description, or of a further description.

    The description of a plan that can't be read stays, and the plan alone is refused.
    """
    said = _said(item.value["annotation"])
    if said is None:
        yield Reject.of(Code.BAD_JSON, "a description without text", file=item.place,
                        suggestion="it needs `task_desc` and `high_descs`")  # fmt: skip
        return
    title, description, worker = said
    scene = item.value["scene"] if isinstance(item.value["scene"], str) else None
    annotator = worker_hash(worker, salt) if worker else None
    described = partial(record, item, scene=scene, worker=annotator, platform=NAME)
    plan = item.value.get("plan")
    if plan is None:
        yield described("description", title, description)
        return
    try:
        text = "".join(f"{step}\n" for step in steps_of(plan, knowledge))
    except UnreadableStepError as error:
        yield described("description", title, description)
        yield Reject.of(error.code, str(error), file=item.place, suggestion=error.remedy)
        return
    yield described("program", title, description, text=text, line=0)


def _said(annotation: Any) -> tuple[str, str, str] | None:
    """Return the title, the description and the id of the annotator; None where they are no texts."""
    if not isinstance(annotation, Mapping):
        return None
    title, lines = annotation.get("task_desc"), annotation.get("high_descs")
    if not isinstance(title, str) or not isinstance(lines, list) or not all(isinstance(line, str) for line in lines):
        return None
    worker = annotation.get("assignment_id", "")
    whole = " ".join(" ".join(line.split()) for line in lines)
    return " ".join(title.split()), whole, worker if isinstance(worker, str) else ""
