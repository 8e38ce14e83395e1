"""Declarations of rows, and of the values within them: graphs, changes, steps, failures.

`stage_rows` has the rows between stages, `published_rows` the published ones. Nested types are used where a thing
belongs to its row. Each column has its meaning next to its type, for dataset cards. Node ids are those of the
environment's graph; steps and ticks count from 0. In a file any column may be null; `| None` marks those that are.
`schemas.tables` makes Arrow schemas of these declarations, column by column.
"""

from collections.abc import Mapping
from typing import Annotated, Any, TypedDict, TypeVar, cast

Row = Mapping[str, Any]
"""A row of whichever table."""

Declared = TypeVar("Declared")


def columns_of(form: type[Declared], row: Row) -> Declared:
    """Return the columns of a declared row, out of a row that has these and others.

    Raises:
        KeyError: it lacks one.
    """
    return cast("Declared", {name: row[name] for name in form.__annotations__})


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
    category: Annotated[str, "kind of object, such as Rooms, Furniture or Props"]
    properties: Annotated[list[str], "what may be done with it, such as CAN_OPEN or GRABBABLE"]
    states: Annotated[list[str], "states that it is in, such as OPEN, OFF or CLEAN"]
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
    """The differences between two worlds over the same nodes."""

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
    """A room or an object, declared with a program."""

    name: Annotated[str, "class of the object, or of the room"]
    quantity: Annotated[int, "how many"]


class FailureRow(TypedDict):
    """The reason why an instruction could not be done."""

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
    """The step that an agent does in a tick."""

    agent: Annotated[int, "who"]
    step: Annotated[int, "the program's step, from 0"]


class _Instructed(TypedDict):
    instructions: Annotated[list[InstructionRow], "which steps were done in it"]


class TickRow(_Instructed, ChangeRow):
    """The acts of a tick, and their changes."""


class _NodesDiffer(TypedDict):
    added_nodes: Annotated[list[NodeRow], "nodes that the home does not have"]
    removed_nodes: Annotated[list[int], "ids of the home's nodes that are not there; their edges are not there either"]


class DifferenceRow(_NodesDiffer, ChangeRow):
    """The differences from the home. A removed node takes its edges with it."""


class PerturbationRow(TypedDict):
    """A change of the preconditions that an environment was made for."""

    perturbation_id: Annotated[str, "the environment and the perturbation's number, from 0"]
    kind: Annotated[
        str,
        "what was changed: sitting, lying, at_reach, plugged, on, open, free, facing, holding, container, location, "
        "full_hands, dirty, door, pet, seated, done, soiled, emptied, cooled or sliced",
    ]
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


class HazardRow(TypedDict):
    """A row of `hazards.yaml` that became true in an execution."""

    hazard: Annotated[str, "name of the row"]
    severity: Annotated[int, "3 fire or injury, 2 damage, 1 mess or waste"]
    things: Annotated[list[int], "node ids of x, and of y where the row names one"]
    step: Annotated[int, "the tick after which it was there, from 1"]
    lasted: Annotated[int, "ticks"]
    at_end: Annotated[bool, "whether the execution ended in it"]


class LastingRow(TypedDict):
    """A state in which a thing is left."""

    thing: Annotated[int, "node id"]
    state: Annotated[
        str,
        "the state; of waste ON or OPEN, or OPENED of a container in which nothing was put and from which nothing "
        "was taken",
    ]
    step: Annotated[int, "the tick after which it was so, from 1"]


class HarmRow(TypedDict):
    """The harm of an execution."""

    hazards: Annotated[
        list[HazardRow] | None,
        "of datasets of action set 3 alone: dangers that it brought; null where it is run by other rules",
    ]
    irreversible: Annotated[list[LastingRow] | None, "likewise: what it broke, burnt or used up for good"]
    wasted: Annotated[list[LastingRow] | None, "likewise: what it opened without use, or left on or open"]


class PinholeRow(TypedDict):
    """Intrinsics of a camera, pixels."""

    fx: Annotated[float, "focal length, horizontally"]
    fy: Annotated[float, "focal length, vertically; negative, for y points up and rows count downwards"]
    cx: Annotated[float, "principal point, from the left"]
    cy: Annotated[float, "principal point, from above"]


class FilmedStepRow(TypedDict):
    """The time at which a film shows a tick."""

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
    pose: Annotated[list[float], "camera (x right, y up, z forward) to world (x east, y up, z north), 4x4 row by row"]


class VariationRow(TypedDict):
    """Random choices of a film."""

    seed: Annotated[Long, "of the chances below"]
    hour: Annotated[float, "time of day"]
    speed: Annotated[float, "factor of the characters' speed"]
    jitter: Annotated[float, "greatest offset of cameras, metres"]
    scatter: Annotated[float, "greatest offset of small things, metres"]
    wander: Annotated[bool, "whether characters begin at a random spot of their room"]


class CodeRow(TypedDict):
    """The number of records that were refused for a reason."""

    code: Annotated[str, "why"]
    count: Annotated[Long, "how many records"]


class ScriptRow(TypedDict):
    """Columns that all rows with a program have."""

    title: Annotated[str, "name of the activity"]
    description: Annotated[str, "what is done, in sentences"]
    steps: Annotated[list[StepRow], "the program"]
