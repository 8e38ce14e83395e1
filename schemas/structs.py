"""The structs within rows of tables: graphs, changes, steps, failures; declared as `schemas.rows` declares the rows."""

from typing import Annotated, TypedDict


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
