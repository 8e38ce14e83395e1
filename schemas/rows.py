"""A row of every table: what the stages pass on, and what is published.

Nested types are used where a thing belongs to its row. Each column has its meaning beside its type, for dataset cards.
Node ids are those of the environment's graph; steps and ticks count from 0. In a file any column may be null; `| None`
marks those that are. `schemas.tables` makes Arrow schemas of these declarations, column by column.
"""

from collections.abc import Mapping
from typing import Annotated, Any, TypedDict, TypeVar, cast

Row = Mapping[str, Any]
"""A row of whichever table."""

Declared = TypeVar("Declared")


def columns_of(form: type[Declared], row: Row) -> Declared:
    """The columns of a declared row, out of a row that has these and others.

    Raises:
        KeyError: it lacks one.
    """
    return cast("Declared", {name: row[name] for name in form.__annotations__})


# What stands within rows: graphs, changes, steps, failures


class Arrow(str):
    """Name of the Arrow type of a number that is not a 32-bit one."""

    __slots__ = ()


Long = Annotated[int, Arrow("int64")]
Seed = Annotated[int, Arrow("uint64")]


class PointRow(TypedDict):
    """Metres."""

    x: float
    y: float
    z: float


class BoxRow(TypedDict):
    """A box parallel to the axes."""

    center: PointRow
    size: PointRow


class NodeRow(TypedDict):
    """A node of a graph."""

    id: int
    class_name: str
    category: str
    properties: list[str]
    states: list[str]
    prefab: str | None
    box: BoxRow | None
    yaw: float | None


class EdgeRow(TypedDict):
    """An edge of a graph."""

    source: int
    relation: str
    target: int


class NodeStateRow(TypedDict):
    """A state that a node is in."""

    node: int
    state: str


class ChangeRow(TypedDict):
    """What differs between two worlds over the same nodes."""

    added: list[EdgeRow]
    removed: list[EdgeRow]
    set_states: list[NodeStateRow]
    cleared_states: list[NodeStateRow]


class GraphRow(TypedDict):
    """A whole graph; edges column by column, since there are thousands. Only ingest keeps whole graphs."""

    nodes: list[NodeRow]
    sources: list[int]
    relations: list[str]
    targets: list[int]


class ArgumentRow(TypedDict):
    """An object of a program."""

    name: str
    instance: int


class ConditionRow(TypedDict):
    """A precondition; `step` and `hard` are null where they came with the program."""

    name: str
    objects: list[ArgumentRow]
    step: int | None
    hard: bool | None


class BindingRow(TypedDict):
    """The node that an object of a program is."""

    name: str
    instance: int
    node: int


class ModifierRow(TypedDict):
    """An adverb of a step."""

    name: str
    value: str


class StepRow(TypedDict):
    """A step of a program, unbound."""

    agent: int
    action: str
    objects: list[ArgumentRow]
    joins: bool
    modifiers: list[ModifierRow]
    line: int


class QuantityRow(TypedDict):
    """A room or an object that a worker declared."""

    name: str
    quantity: int


class FailureRow(TypedDict):
    """Why an instruction could not be done."""

    code: str
    tick: int
    agent: int
    action: str
    objects: list[int]
    names: list[str]
    expected: str
    actual: str


class WarningRow(TypedDict):
    """A fault that does not stop a program."""

    code: str
    line: int
    column: int
    found: str
    message: str
    suggestion: str


class InstructionRow(TypedDict):
    """Which step an agent does in a tick."""

    agent: int
    step: int


class _Instructed(TypedDict):
    instructions: list[InstructionRow]


class TickRow(_Instructed, ChangeRow):
    """What was done in a tick, and what it changed."""


class _NodesDiffer(TypedDict):
    added_nodes: list[NodeRow]
    removed_nodes: list[int]


class DifferenceRow(_NodesDiffer, ChangeRow):
    """What differs from the home. A removed node takes its edges with it."""


class PerturbationRow(TypedDict):
    """A condition that was dropped or swapped."""

    kind: str
    condition: ConditionRow


class RepairRow(TypedDict):
    """One repair; successful when the failure it is for did not come back at once."""

    attempt: int
    step: int
    failure: FailureRow
    handler: str
    before: list[str]
    after: list[str]
    successful: bool


class PinholeRow(TypedDict):
    """Intrinsics of a camera, pixels."""

    fx: float
    fy: float
    cx: float
    cy: float


class FilmedStepRow(TypedDict):
    """When a film shows a tick."""

    tick: int
    steps: list[str]
    start: float
    end: float
    cameras: list[str]
    visible: float | None


class TrackRow(TypedDict):
    """A film's camera from a picture on."""

    frame: int
    tick: int
    camera: str
    intrinsics: PinholeRow
    pose: list[float]


class VariationRow(TypedDict):
    """What was drawn by chance for a film."""

    seed: Long
    hour: float
    speed: float
    jitter: float
    scatter: float
    wander: bool


class CodeRow(TypedDict):
    """How many records were refused for a reason."""

    code: str
    count: Long


class ScriptRow(TypedDict):
    """What rows with a program have in common."""

    title: str
    description: str
    steps: list[StepRow]


# What the stages pass on


class NamedRow(TypedDict):
    """Where a program comes from, with its title, description and declarations."""

    program_id: Annotated[str, "stable id of the program"]
    origin: Annotated[str, "crowd, release, text, spoken, records, sketches, scenes, synthetic or augmented"]
    source: Annotated[str, "the source it came from, as named in the manifest"]
    place: Annotated[str, "file and line inside the source"]
    description_id: Annotated[str, "the description it was written for"]
    title: Annotated[str, "name of the activity as written"]
    description: Annotated[str, "what is done, in sentences"]
    scene: Annotated[str | None, "room the worker was shown"]
    worker: Annotated[str | None, "salted hash of the worker's id"]
    platform: Annotated[str | None, "crowd-sourcing platform"]
    rooms: Annotated[list[QuantityRow] | None, "rooms declared by the worker"]
    props: Annotated[list[QuantityRow] | None, "objects declared by the worker"]


class _Kind(TypedDict):
    kind: Annotated[str, "program, description where there is no program, sketch, or scene for a graph alone"]


class WrittenGroundingRow(TypedDict):
    """A program as it was grounded in a home."""

    home: str
    text: str
    start: GraphRow | None
    final: ChangeRow | None


class IngestedRow(_Kind, NamedRow):
    """What `ingest` reads."""

    text: Annotated[str | None, "the program as collected; null for a description"]
    line: Annotated[int | None, "file line of the text's first line, less one"]
    groundings: Annotated[
        list[WrittenGroundingRow] | None,
        "the program as grounded in a home, with the start graph and what the stored final graph changes",
    ]
    conditions: Annotated[list[ConditionRow] | None, "preconditions that came with the program"]
    keep: Annotated[list[bool] | None, "for each step of the program a sketch is of, whether it is kept"]


class GroundingRow(TypedDict):
    """A program as it was grounded in a home, checked."""

    home: str
    steps: list[StepRow]
    bindings: list[BindingRow]
    start: GraphRow | None
    final: ChangeRow | None


class ValidatedRow(NamedRow):
    """What `validate` checked."""

    steps: Annotated[list[StepRow], "the program in canonical names, unbound"]
    groundings: Annotated[list[GroundingRow], "the program as grounded in a home, checked"]
    conditions: Annotated[list[ConditionRow] | None, "preconditions that came with the program"]
    warnings: Annotated[list[WarningRow], "what looks wrong but does not prevent running"]


class RunRow(TypedDict):
    """A run of a program."""

    rules: Annotated[str, "named options of the engine: default or replay"]
    bindings: Annotated[list[BindingRow], "program objects to graph nodes"]
    ticks: Annotated[list[TickRow], "what each tick did and changed"]
    executable: Annotated[bool, "ran to its end"]
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
    perturbations: Annotated[list[PerturbationRow], "which conditions were dropped or swapped"]
    repairs: Annotated[list[RepairRow], "how it was made to run again"]


class _Tried(TypedDict):
    parent_id: str | None
    home: str
    perturbations: list[PerturbationRow]
    outcome: Annotated[str, "REPAIRED, or why no program came of repairing: DUPLICATE, NO_HANDLER, LOOP, ..."]


class TriedRow(_Tried, RepairRow):
    """A repair that gave no program of its own: what `augment` writes besides."""


class SketchRow(TypedDict):
    """The sketch of a program (thesis 5.5.1)."""

    program_id: Annotated[str, "the program"]
    origin: Annotated[str, "people, inferred, or inherited from the program's parent"]
    keep: Annotated[list[bool], "for each step, whether the sketch keeps it"]
    steps: Annotated[list[str], "the kept steps, as text"]


class RenderedRow(TypedDict):
    """A picture."""

    execution_id: Annotated[str, "the execution filmed"]
    tick: Annotated[int, "the number of ticks done before the picture"]
    camera: Annotated[str, "name of the camera"]
    modality: Annotated[str, "rgb, ids, depth, ..."]
    width: Annotated[int, "pixels"]
    height: Annotated[int, "pixels"]
    intrinsics: Annotated[PinholeRow, "pinhole camera, pixels"]
    pose: Annotated[list[float], "camera to world, 4x4 row by row"]
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
    variation: Annotated[VariationRow, "what was drawn by chance: see `rendering.scene.variation`"]
    layout_made: Annotated[bool, "whether the home had no geometry, and was laid out by its relations"]
    file: Annotated[str, "the video, relative to the dataset"]


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


# What is published; every table also has the columns of `VersionsRow`, at its end


class VersionsRow(TypedDict):
    """What a published row belongs to."""

    action_set: Annotated[str, "the meaning of actions it was run with"]
    dataset_version: Annotated[str, "the dataset it belongs to"]


class ActivityRow(TypedDict):
    """A row of `activities`."""

    activity_id: Annotated[str, "the title in lower case, words joined by underscores"]
    title: Annotated[str, "the commonest spelling"]
    scenes: Annotated[list[str], "rooms its workers were shown"]
    descriptions: Annotated[int, "how many descriptions"]
    programs: Annotated[int, "how many programs, augmented ones included"]


class DescriptionRow(TypedDict):
    """A row of `descriptions`."""

    description_id: Annotated[str, "stable id"]
    activity_id: Annotated[str, "the activity described"]
    title: str
    description: str
    scene: str | None
    origin: str
    source: str
    worker: str | None
    platform: str | None
    programs: Annotated[int, "how many programs were written for it"]


class ProgramRow(TypedDict):
    """A row of `programs`."""

    program_id: str
    activity_id: Annotated[str, "the activity it carries out"]
    description_id: str
    parent_id: str | None
    origin: str
    source: str
    place: str
    title: str
    description: str
    split: Annotated[str, "train or test, by activity; `splits` leaves out of train what nearly equals a test"]
    steps: list[StepRow]
    rooms: list[QuantityRow] | None
    props: list[QuantityRow] | None
    worker: str | None
    platform: str | None
    warnings: list[WarningRow]


class HomeRow(TypedDict):
    """A row of `homes`."""

    home: Annotated[str, "its name"]
    origin: Annotated[str, "catalog, or derived from what the stored start graphs share"]
    rooms: Annotated[list[str], "classes of its rooms"]
    nodes: Annotated[int, "how many nodes"]
    edges: Annotated[int, "how many edges"]
    has_geometry: Annotated[bool, "every room has a box"]


class _InHome(TypedDict):
    home: Annotated[str, "the home"]


class HomeNodeRow(_InHome, NodeRow):
    """A row of `home_nodes`."""


class HomeEdgeRow(_InHome, EdgeRow):
    """A row of `home_edges`."""


class _PreparedFor(TypedDict):
    environment_id: str
    home: str
    seed: Seed | None
    program_id: Annotated[str, "the program it was prepared for"]


class EnvironmentRow(_PreparedFor, DifferenceRow):
    """A row of `environments`."""

    conditions: list[ConditionRow]


class _Execution(TypedDict):
    execution_id: str
    program_id: str
    environment_id: str
    home: str


class ExecutionRow(_Execution, RunRow):
    """A row of `executions`."""

    reproduces: bool | None


class StoredRunRow(ExecutionRow):
    """An execution with its environment."""

    environment: EnvironmentRow


class _RepairOf(TypedDict):
    program_id: Annotated[str | None, "the repaired program; null where no program came of it"]
    execution_id: str | None
    environment_id: str | None


class RepairedRow(_RepairOf, TriedRow):
    """A row of `repairs`."""


class SplitRow(TypedDict):
    """A row of `splits`."""

    split: Annotated[str, "activities, homes_1_4 or homes_1_5; splits.json says what they mean"]
    execution_id: Annotated[str, "the execution"]
    program_id: Annotated[str, "its program"]
    part: Annotated[str, "train, validation, test...; none where the split has no place for it"]


class FrameRow(RenderedRow):
    """A row of `frames`."""

    home: Annotated[str, "where it was filmed"]


class VideoRow(FilmedRow):
    """A row of `videos`."""

    home: Annotated[str, "where it was filmed"]


class NameRow(TypedDict):
    """A row of `vocabulary`."""

    kind: Annotated[str, "action, class, state, property, relation, edge_type or failure"]
    id: Annotated[int, "stable number within its kind"]
    name: Annotated[str, "canonical name"]
    arity: Annotated[int | None, "number of objects; actions only"]
    simulated: Annotated[bool | None, "whether the engine executes it; actions only"]


class LedgerRow(TypedDict):
    """A row of `ledger`: `records_in = records_through + records_rejected`."""

    stage: Annotated[str, "the stage"]
    order: Annotated[int, "place in the pipeline, from 0"]
    records_in: Annotated[Long, "records read"]
    records_through: Annotated[Long, "records that gave at least one row"]
    records_rejected: Annotated[Long, "records refused whole"]
    partial_rejects: Annotated[Long, "parts refused of records that went on"]
    rows: Annotated[Long, "rows written"]
    codes: Annotated[list[CodeRow], "why records were refused, commonest first"]
