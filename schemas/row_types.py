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

    x: Annotated[float, "metres to the east"]
    y: Annotated[float, "metres up"]
    z: Annotated[float, "metres to the north"]


class BoxRow(TypedDict):
    """A box parallel to the axes."""

    center: Annotated[PointRow, "its middle, metres"]
    size: Annotated[PointRow, "its whole extent, metres"]


class NodeRow(TypedDict):
    """A node of a graph."""

    id: Annotated[int, "number of the node, unique in its graph"]
    class_name: Annotated[str, "class of the object, as in `vocabulary`"]
    category: Annotated[str, "kind of object: Rooms, Furniture, Props, ..."]
    properties: Annotated[list[str], "what may be done with it: CAN_OPEN, GRABBABLE, ..."]
    states: Annotated[list[str], "states that it is in: OPEN, OFF, CLEAN, ..."]
    prefab: Annotated[str | None, "the model that draws it; null without one"]
    box: Annotated[BoxRow | None, "where it is; null where the home has no geometry"]
    yaw: Annotated[float | None, "the way it faces, degrees about the vertical; null where unknown"]


class EdgeRow(TypedDict):
    """An edge of a graph."""

    source: Annotated[int, "node id"]
    relation: Annotated[str, "ON, INSIDE, CLOSE, FACING, BETWEEN, HOLDS_RH or HOLDS_LH"]
    target: Annotated[int, "node id"]


class NodeStateRow(TypedDict):
    """A state that a node is in."""

    node: Annotated[int, "node id"]
    state: Annotated[str, "the state"]


class ChangeRow(TypedDict):
    """What differs between two worlds over the same nodes."""

    added: Annotated[list[EdgeRow], "edges that were not there before"]
    removed: Annotated[list[EdgeRow], "edges that were there before"]
    set_states: Annotated[list[NodeStateRow], "states that nodes came into"]
    cleared_states: Annotated[list[NodeStateRow], "states that nodes were in before"]


class GraphRow(TypedDict):
    """A whole graph; edges column by column, since there are thousands. Only ingest keeps whole graphs."""

    nodes: Annotated[list[NodeRow], "its nodes"]
    sources: Annotated[list[int], "node id of each edge's source"]
    relations: Annotated[list[str], "relation of each edge"]
    targets: Annotated[list[int], "node id of each edge's target"]


class ArgumentRow(TypedDict):
    """An object of a program."""

    name: Annotated[str, "class of the object"]
    instance: Annotated[int, "distinguishes objects of one class in a program, from 1"]


class ConditionRow(TypedDict):
    """A precondition; `step` and `hard` are null where they came with the program."""

    name: Annotated[str, "the condition, a literal's name"]
    objects: Annotated[list[ArgumentRow], "what it is about"]
    step: Annotated[int | None, "the step that needs it, from 0; null where it came with the program"]
    hard: Annotated[bool | None, "whether the step fails without it; null likewise"]


class BindingRow(TypedDict):
    """The node that an object of a program is."""

    name: Annotated[str, "class of the program's object"]
    instance: Annotated[int, "its instance in the program"]
    node: Annotated[int, "node id in the environment"]


class ModifierRow(TypedDict):
    """An adverb of a step."""

    name: Annotated[str, "kind of modifier"]
    value: Annotated[str, "its value"]


class StepRow(TypedDict):
    """A step of a program, unbound."""

    agent: Annotated[int, "who does it, from 0"]
    action: Annotated[str, "name of the action, as in `vocabulary`"]
    objects: Annotated[list[ArgumentRow], "what it is done to, in the order of the action's roles"]
    joins: Annotated[bool, "whether it is done in the same tick as the step before"]
    modifiers: Annotated[list[ModifierRow], "how it is done"]
    line: Annotated[int, "line of the source; 0 where it has none"]


class QuantityRow(TypedDict):
    """A room or an object, declared beside a program."""

    name: Annotated[str, "class of the object, or of the room"]
    quantity: Annotated[int, "how many"]


class FailureRow(TypedDict):
    """Why an instruction could not be done."""

    code: Annotated[str, "why, a failure of `vocabulary`"]
    tick: Annotated[int, "the tick, from 0"]
    agent: Annotated[int, "whose instruction it was"]
    action: Annotated[str, "name of the action"]
    objects: Annotated[list[int], "node ids of its objects"]
    names: Annotated[list[str], "classes of its objects"]
    expected: Annotated[str, "what had to hold"]
    actual: Annotated[str, "what held instead"]


class WarningRow(TypedDict):
    """A fault that does not stop a program."""

    code: Annotated[str, "kind of fault"]
    line: Annotated[int, "line of the source, from 1"]
    column: Annotated[int, "column, from 1; 0 when unknown"]
    found: Annotated[str, "the words in question"]
    message: Annotated[str, "the fault"]
    suggestion: Annotated[str, "the remedy, if one is known"]


class InstructionRow(TypedDict):
    """Which step an agent does in a tick."""

    agent: Annotated[int, "who"]
    step: Annotated[int, "the program's step, from 0"]


class _Instructed(TypedDict):
    instructions: Annotated[list[InstructionRow], "which steps were done in it"]


class TickRow(_Instructed, ChangeRow):
    """What was done in a tick, and what it changed."""


class _NodesDiffer(TypedDict):
    added_nodes: Annotated[list[NodeRow], "nodes that the home does not have"]
    removed_nodes: Annotated[list[int], "ids of the home's nodes that are not there; their edges are not there either"]


class DifferenceRow(_NodesDiffer, ChangeRow):
    """What differs from the home. A removed node takes its edges with it."""


class PerturbationRow(TypedDict):
    """A change of the preconditions that an environment was made for."""

    perturbation_id: Annotated[str, "the environment and the perturbation's number, from 0"]
    kind: Annotated[str, "container, door, dirty, ...: see `repair.perturb`"]
    dropped: Annotated[list[ConditionRow] | None, "preconditions that no longer hold; null before format 2"]
    added: Annotated[list[ConditionRow] | None, "conditions that hold instead; null before format 2"]
    attempts: Annotated[list[int] | None, "the repairs of its failures, by their `attempt`; null before format 2"]
    failure: Annotated[FailureRow | None, "the first failure that it caused; null where it caused none"]


class RepairRow(TypedDict):
    """One repair; successful when the failure it is for did not come back at once."""

    perturbation_id: Annotated[str | None, "the perturbation that its failure comes of; null where that is unclear"]
    attempt: Annotated[int, "number of the repair of its program, from 0"]
    step: Annotated[int, "the step that failed, from 0"]
    failure: Annotated[FailureRow, "why it failed"]
    handler: Annotated[str, "name of the repair, or of the handler that gave up"]
    before: Annotated[list[str], "the steps of the program before it, as text"]
    after: Annotated[list[str], "the steps after it; empty where nothing could be done"]
    successful: Annotated[bool, "whether the failure did not come back at once"]


class PinholeRow(TypedDict):
    """Intrinsics of a camera, pixels."""

    fx: Annotated[float, "focal length, horizontally"]
    fy: Annotated[float, "focal length, vertically"]
    cx: Annotated[float, "principal point, from the left"]
    cy: Annotated[float, "principal point, from above"]


class FilmedStepRow(TypedDict):
    """When a film shows a tick."""

    tick: Annotated[int, "the tick, from 0"]
    steps: Annotated[list[str], "its steps, as text"]
    start: Annotated[float, "seconds from the film's start"]
    end: Annotated[float, "seconds likewise"]
    cameras: Annotated[list[str], "cameras that show it"]
    visible: Annotated[float | None, "share of the objects it names that are seen; null where it names none"]


class TrackRow(TypedDict):
    """A film's camera from a picture on."""

    frame: Annotated[int, "first picture of this camera, from 0"]
    tick: Annotated[int, "the tick that it shows"]
    camera: Annotated[str, "name of the camera"]
    intrinsics: Annotated[PinholeRow, "of the camera, pixels"]
    pose: Annotated[list[float], "camera to world, 4x4 row by row"]


class VariationRow(TypedDict):
    """What was drawn by chance for a film."""

    seed: Annotated[Long, "of the chances below"]
    hour: Annotated[float, "time of day"]
    speed: Annotated[float, "factor of the characters' speed"]
    jitter: Annotated[float, "greatest offset of cameras, metres"]
    scatter: Annotated[float, "greatest offset of small things, metres"]
    wander: Annotated[bool, "whether characters begin at a random spot of their room"]


class CodeRow(TypedDict):
    """How many records were refused for a reason."""

    code: Annotated[str, "why"]
    count: Annotated[Long, "how many records"]


class ScriptRow(TypedDict):
    """What rows with a program have in common."""

    title: Annotated[str, "name of the activity"]
    description: Annotated[str, "what is done, in sentences"]
    steps: Annotated[list[StepRow], "the program"]


# What the stages pass on


class NamedRow(TypedDict):
    """Where a program comes from, with its title, description and declarations."""

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
    part: Annotated[str | None, "train, validation, test...; null where the split has no place for it"]


class IngestedRow(_Kind, NamedRow):
    """What `ingest` reads."""

    style: Annotated[str | None, "the voice in which a text was written, where its source says"]
    text: Annotated[str | None, "the program as collected; null for a description"]
    groundings: Annotated[
        list[WrittenGroundingRow] | None,
        "the program as grounded in a home, with the start graph and what the stored final graph changes",
    ]
    conditions: Annotated[list[ConditionRow] | None, "preconditions that came with the program"]
    keep: Annotated[list[bool] | None, "for each step of the program a sketch is of, whether it is kept"]
    parts: Annotated[list[PartRow] | None, "its parts in splits of its source's own"]


class GroundingRow(TypedDict):
    """A program as it was grounded in a home, checked."""

    home: Annotated[str, "the home's name"]
    steps: Annotated[list[StepRow], "the program's steps"]
    bindings: Annotated[list[BindingRow], "program objects to node ids"]
    start: Annotated[GraphRow | None, "the graph before it, where one came with it"]
    final: Annotated[ChangeRow | None, "what the stored final graph changes"]


class ValidatedRow(NamedRow):
    """What `validate` checked."""

    steps: Annotated[list[StepRow], "the program in canonical names, unbound"]
    groundings: Annotated[list[GroundingRow], "the program as grounded in a home, checked"]
    conditions: Annotated[list[ConditionRow] | None, "preconditions that came with the program"]
    warnings: Annotated[list[WarningRow], "what looks wrong but does not prevent running"]


class RunRow(TypedDict):
    """A run of a program."""

    rules: Annotated[str, "named options of the engine: made_bed or replay; default in older datasets"]
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


class ClippedRow(TypedDict):
    """Two seconds of a film, and what is done in their middle."""

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
    pose: Annotated[list[float], "camera to world, 4x4 row by row"]
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


# What is published; every table also has the columns of `VersionsRow`, at its end


class VersionsRow(TypedDict):
    """What a published row belongs to."""

    action_set: Annotated[str, "the meaning of actions it was run with"]
    dataset_version: Annotated[str, "the dataset it belongs to"]


class ActivityRow(TypedDict):
    """An activity: what is done at home, by its title."""

    activity_id: Annotated[str, "the title in lower case, words joined by underscores"]
    title: Annotated[str, "the commonest spelling"]
    scenes: Annotated[list[str], "rooms in which its descriptions were to start"]
    descriptions: Annotated[int, "how many descriptions"]
    programs: Annotated[int, "how many programs, augmented ones included"]


class DescriptionRow(TypedDict):
    """A description: an account of an activity in sentences."""

    description_id: Annotated[str, "stable id"]
    activity_id: Annotated[str, "the activity described"]
    title: str
    description: str
    scene: str | None
    origin: str
    source: str
    worker: str | None
    platform: str | None
    style: str | None
    programs: Annotated[int, "how many programs were written for it"]


class ProgramRow(TypedDict):
    """A program: an activity as steps, with its description and origin; augmented ones name their parent."""

    program_id: str
    activity_id: Annotated[str, "the activity it carries out"]
    description_id: str
    parent_id: str | None
    origin: str
    source: str
    place: Annotated[
        str, "file and line inside the source, as `file:line`; without a line for entries of lists and tables"
    ]
    title: str
    description: str
    split: Annotated[str | None, "its part in the split `activities`; null where a near duplicate is in a later part"]
    steps: list[StepRow]
    rooms: list[QuantityRow] | None
    props: list[QuantityRow] | None
    worker: str | None
    platform: str | None
    warnings: list[WarningRow]


class HomeRow(TypedDict):
    """A home that environments are made from."""

    home: Annotated[str, "its name"]
    origin: Annotated[str, "catalog, or derived from what the stored start graphs share"]
    rooms: Annotated[list[str], "classes of its rooms"]
    nodes: Annotated[int, "how many nodes"]
    edges: Annotated[int, "how many edges"]
    has_geometry: Annotated[bool, "every room has a box"]


class _InHome(TypedDict):
    home: Annotated[str, "the home"]


class HomeNodeRow(_InHome, NodeRow):
    """A node of a home's graph: a room, a thing, a character, or a part of the building."""


class HomeEdgeRow(_InHome, EdgeRow):
    """An edge of a home's graph."""


class _PreparedFor(TypedDict):
    environment_id: str
    home: str
    seed: Seed | None
    program_id: Annotated[str, "the program it was prepared for"]


class EnvironmentRow(_PreparedFor, DifferenceRow):
    """An environment: a home prepared for a program, as what differs from the home."""

    conditions: list[ConditionRow]


class _Execution(TypedDict):
    execution_id: str
    program_id: str
    environment_id: str
    home: str


class ExecutionRow(_Execution, RunRow):
    """An execution: a program run in an environment, tick by tick."""

    reproduces: bool | None


class StoredRunRow(ExecutionRow):
    """An execution with its environment."""

    environment: EnvironmentRow


class _Tried(TypedDict):
    program_id: Annotated[str | None, "the repaired program; null where no program came of it"]
    execution_id: Annotated[str | None, "the run of the repaired program"]
    environment_id: Annotated[str | None, "the perturbed environment"]
    parent_id: Annotated[str | None, "the program whose preconditions were perturbed"]
    home: Annotated[str, "the home"]
    outcome: Annotated[str, "REPAIRED, or why no program came of repairing: DUPLICATE, NO_HANDLER, LOOP, ..."]


class RepairedRow(_Tried, RepairRow):
    """A repair, tried when a program failed in a perturbed environment."""


class PerturbedRow(_Tried, PerturbationRow):
    """A perturbation of the environment of a program, with what it caused."""


class SplitRow(TypedDict):
    """The part that an execution has in a split."""

    split: Annotated[
        str, "activities, held_out_home, homes_1_4, homes_1_5, or one of a source; splits.json says what they mean"
    ]
    execution_id: Annotated[str, "the execution"]
    program_id: Annotated[str, "its program"]
    part: Annotated[str | None, "train, validation, test...; null where the split has no place for it"]


class FrameRow(RenderedRow):
    """A picture of an execution."""

    home: Annotated[str, "where it was filmed"]


class VideoRow(FilmedRow):
    """A film of an execution."""

    home: Annotated[str, "where it was filmed"]


class ClipRow(ClippedRow):
    """A clip of an execution's film."""

    home: Annotated[str, "where it was filmed"]


class DemonstrationFrameRow(DemonstratedRow):
    """A picture from above of an execution, with class masks: what models of demonstrations see."""

    home: Annotated[str, "where it was filmed"]


class NameRow(TypedDict):
    """A name with its stable number."""

    kind: Annotated[str, "action, class, state, property, relation, edge_type or failure"]
    id: Annotated[int, "stable number within its kind"]
    name: Annotated[str, "canonical name"]
    arity: Annotated[int | None, "number of objects; actions only"]
    simulated: Annotated[bool | None, "whether the engine executes it; actions only"]


class LedgerRow(TypedDict):
    """What became of a stage's records: `records_in = records_through + records_rejected`."""

    stage: Annotated[str, "the stage"]
    record: Annotated[str, "what its records are; the rows of other kinds go on as they are"]
    order: Annotated[int, "place in the pipeline, from 0"]
    records_in: Annotated[Long, "records read"]
    records_through: Annotated[Long, "records that gave at least one row"]
    records_rejected: Annotated[Long, "records refused whole"]
    partial_rejects: Annotated[Long, "parts refused of records that went on"]
    rows: Annotated[Long, "rows written"]
    codes: Annotated[list[CodeRow], "why records were refused, commonest first"]
