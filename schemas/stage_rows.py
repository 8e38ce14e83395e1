"""Rows that the stages pass on; see `row_types` for how they are declared."""

from typing import Annotated, TypedDict

from hearth.schemas.row_types import (
    BindingRow,
    ChangeRow,
    ConditionRow,
    DifferenceRow,
    FailureRow,
    FilmedStepRow,
    GraphRow,
    PerturbationRow,
    PinholeRow,
    QuantityRow,
    RepairRow,
    Seed,
    StepRow,
    TickRow,
    TrackRow,
    VariationRow,
    WarningRow,
)


class NamedRow(TypedDict):
    """The source of a program, with its title, description and declarations."""

    program_id: Annotated[str, "stable id of the program"]
    origin: Annotated[str, "written, crowd, release, text, spoken, records, sketches, scenes, synthetic or augmented"]
    source: Annotated[str, "the source it came from, as named in the manifest"]
    place: Annotated[str, "file inside the source"]
    line: Annotated[int | None, "file line of the text's first line, less one; null where there are no lines"]
    description_id: Annotated[str, "the description it was written for"]
    title: Annotated[str, "name of the activity as written"]
    description: Annotated[str, "what is done, in sentences"]
    scene: Annotated[str | None, "room in which the activity was to start"]
    worker: Annotated[str | None, "salted hash of a crowd worker's id; null where a text was written, not collected"]
    platform: Annotated[str | None, "crowd-sourcing platform; likewise"]
    rooms: Annotated[list[QuantityRow] | None, "rooms declared beside the program"]
    props: Annotated[list[QuantityRow] | None, "objects declared beside the program"]


class _Kind(TypedDict):
    kind: Annotated[str, "program, description where there is no program, sketch, or scene for a graph alone"]


class WrittenGroundingRow(TypedDict):
    """A program as it was grounded in a home."""

    home: Annotated[str, "the home's name"]
    text: Annotated[str, "the program with node ids"]
    start: Annotated[GraphRow | None, "the graph before it, where one came with it"]
    final: Annotated[ChangeRow | None, "what the stored final graph changes"]


class PartRow(TypedDict):
    """The part of a program in a split of its source's own."""

    split: Annotated[str, "name of the split"]
    part: Annotated[
        str | None, "train, validation, test or another part of this split; null where the split has no place for it"
    ]


class IngestedRow(_Kind, NamedRow):
    """Rows that `ingest` reads."""

    style: Annotated[str | None, "the voice in which a text was written, where its source says"]
    text: Annotated[str | None, "the program as collected; null for a description"]
    groundings: Annotated[
        list[WrittenGroundingRow] | None,
        "the program as grounded in a home, with the start graph and what the stored final graph changes",
    ]
    conditions: Annotated[list[ConditionRow] | None, "preconditions that came with the program"]
    keep: Annotated[list[bool] | None, "for each step of the program a sketch is of, whether it is kept"]
    parts: Annotated[list[PartRow] | None, "its parts in splits of its source's own"]
    places: Annotated[
        list[list[int]] | None, "where each line of the text stands in the file, if not in lines of its own"
    ]
    warnings: Annotated[list[WarningRow] | None, "what its reader decided, for the warnings of the program"]


class GroundingRow(TypedDict):
    """A program as it was grounded in a home, checked."""

    home: Annotated[str, "the home's name"]
    steps: Annotated[list[StepRow], "the program's steps"]
    bindings: Annotated[list[BindingRow], "program objects to node ids"]
    start: Annotated[GraphRow | None, "the graph before it, where one came with it"]
    final: Annotated[ChangeRow | None, "what the stored final graph changes"]


class ValidatedRow(NamedRow):
    """Rows that `validate` checked."""

    steps: Annotated[list[StepRow], "the program in canonical names, unbound"]
    groundings: Annotated[list[GroundingRow], "the program as grounded in a home, checked"]
    conditions: Annotated[list[ConditionRow] | None, "preconditions that came with the program"]
    warnings: Annotated[list[WarningRow], "what looks wrong but does not prevent running"]


class RunRow(TypedDict):
    """A run of a program."""

    rules: Annotated[
        str, "named options of the engine: leaves_seat, replay or evolving_graph; others in older datasets"
    ]
    bindings: Annotated[list[BindingRow], "program objects to graph nodes"]
    ticks: Annotated[list[TickRow], "what each tick did and changed"]
    executable: Annotated[bool, "ran to its end; false for originals in perturbed environments in which they fail"]
    failure: Annotated[FailureRow | None, "why it stopped; null when it ran to its end"]


class _Prepared(NamedRow):
    parent_id: Annotated[str | None, "the program it was made from; null for originals"]
    steps: Annotated[list[StepRow], "the program in canonical names, unbound"]
    warnings: Annotated[list[WarningRow], "what looks wrong but does not prevent running"]
    environment_id: Annotated[str, "the environment it runs in"]
    home: Annotated[str, "the home the environment was made from"]
    seed: Annotated[Seed | None, "seed the environment was sampled with; null when it was given"]
    environment: Annotated[DifferenceRow, "what differs from the home"]
    conditions: Annotated[list[ConditionRow], "what had to hold at the start: given, or inferred"]
    execution_id: Annotated[str, "this run of the program"]


class CaseRow(_Prepared, RunRow):
    """A program in an environment, run: what `sample` and `augment` write, and `render` and `publish` read."""

    reproduces: Annotated[bool | None, "ends in the final graph stored with it; null when none was"]
    perturbations: Annotated[
        list[PerturbationRow], "how its environment was perturbed; empty for originals in their own"
    ]
    outcome: Annotated[str | None, "REPAIRED, or why no program came of repairing; null where nothing was perturbed"]
    repairs: Annotated[list[RepairRow], "how it was repaired, or was tried to be"]


class SketchRow(TypedDict):
    """The sketch of a program (thesis 5.5.1)."""

    program_id: Annotated[str, "the program"]
    origin: Annotated[
        str,
        "people, written (by a corpus's reader), inferred, or inherited from the parent's inferred one; "
        "people_parent, written_parent: what an augmented program inherits of an annotation",
    ]
    keep: Annotated[list[bool], "for each step, whether the sketch keeps it"]
    steps: Annotated[list[str], "the kept steps, as text"]


class RenderedRow(TypedDict):
    """A picture."""

    execution_id: Annotated[str, "the execution filmed"]
    tick: Annotated[int, "the number of ticks done before the picture"]
    camera: Annotated[str, "name of the camera"]
    modality: Annotated[str, "rgb (colours) or instance_ids (the mask of instances)"]
    width: Annotated[int, "pixels"]
    height: Annotated[int, "pixels"]
    intrinsics: Annotated[PinholeRow, "pinhole camera, pixels"]
    pose: Annotated[list[float], "camera (x right, y up, z forward) to world (x east, y up, z north), 4x4 row by row"]
    start_time: Annotated[float | None, "seconds from the start of the execution; null for pictures between ticks"]
    end_time: Annotated[float | None, "the same"]
    layout_made: Annotated[bool, "whether the home had no geometry, and was laid out by its relations"]
    file: Annotated[str, "picture or video, relative to the dataset"]


class FilmedRow(TypedDict):
    """A film."""

    execution_id: Annotated[str, "the execution filmed"]
    camera: Annotated[str, "auto (chosen by what it sees), top, first, third, or the name of one that stays"]
    width: Annotated[int, "pixels"]
    height: Annotated[int, "pixels"]
    fps: Annotated[float, "pictures a second"]
    frames: Annotated[int, "pictures"]
    seconds: Annotated[float, "how long it is"]
    steps: Annotated[
        list[FilmedStepRow],
        "when each tick is shown, seconds; by which cameras; the share of the objects it names that are seen",
    ]
    track: Annotated[
        list[TrackRow],
        "camera of the pictures from this one on: intrinsics, and pose from camera to world, 4x4 row by row",
    ]
    variation: Annotated[VariationRow, "what was drawn by chance"]
    layout_made: Annotated[bool, "whether the home had no geometry, and was laid out by its relations"]
    file: Annotated[str, "the video, relative to the dataset"]


class ClippedRow(TypedDict):
    """Two seconds of a film, and the act in their middle."""

    execution_id: Annotated[str, "the execution filmed"]
    number: Annotated[int, "of the clip in its film, from 0"]
    part: Annotated[str, "train, validation or test; all clips of a program are in one"]
    kind: Annotated[str, "whether its home is seen in training: seen, validation or unseen"]
    tick: Annotated[int, "the tick in its middle, from 1"]
    action: Annotated[str, "of that tick's step"]
    objects: Annotated[list[str], "classes of that step's objects"]
    first: Annotated[int, "its first frame in the film, from 0"]
    frames: Annotated[int, "how many it has"]
    fps: Annotated[float, "frames a second"]
    width: Annotated[int, "pixels"]
    height: Annotated[int, "pixels"]
    camera: Annotated[str, "of the frame in its middle"]
    modalities: Annotated[list[str], "arrays of the file: class_ids (as in `vocabulary`), rgb, depth (millimetres)"]
    file: Annotated[str, "the film's arrays (.npz), each (frames of the film, height, width), relative to the dataset"]


class DemonstratedRow(TypedDict):
    """A picture from above of an execution, as it is after a tick (thesis 5.4.3)."""

    execution_id: Annotated[str, "the execution filmed"]
    tick: Annotated[int, "the number of ticks done before the picture; 0 before the first"]
    index: Annotated[int, "its place in the arrays of the file, from 0"]
    width: Annotated[int, "pixels"]
    height: Annotated[int, "pixels"]
    intrinsics: Annotated[PinholeRow, "pinhole camera, pixels"]
    pose: Annotated[list[float], "camera (x right, y up, z forward) to world (x east, y up, z north), 4x4 row by row"]
    layout_made: Annotated[bool, "whether the home had no geometry, and was laid out by its relations"]
    file: Annotated[
        str,
        "arrays (.npz), relative to the dataset: class_ids (pictures, height, width), as in `vocabulary`; rgb_changes "
        "(pictures, height, width, 3), colours: each picture less the one before, modulo 256",
    ]


class RejectRow(TypedDict):
    """A fault of a record that was refused."""

    stage: Annotated[str, "which stage refused it"]
    record_id: Annotated[str, "the record, or the file when no records could be distinguished"]
    code: Annotated[str, "why"]
    file: Annotated[str, "source and file inside it"]
    line: Annotated[int, "from 1; 0 when it concerns the whole file"]
    column: Annotated[int, "from 1; 0 when unknown"]
    found: Annotated[str, "the offending words"]
    message: Annotated[str, "the fault"]
    suggestion: Annotated[str, "the remedy, if one is known"]
    partial: Annotated[bool, "only a part of the record was refused; the rest went on"]
    fault: Annotated[int, "number of the fault within the record, from 0; the first one is what it counts under"]


class RejectedRow(RejectRow):
    """The same, as a stage keeps it."""

    partition: Annotated[int, "partition of the stage that held it"]
