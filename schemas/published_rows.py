"""Rows of the published tables; every table also has the columns of `VersionsRow`, at its end. See `row_types`."""

from typing import Annotated, TypedDict

from hearth.schemas.row_types import (
    CodeRow,
    ConditionRow,
    DifferenceRow,
    EdgeRow,
    HarmRow,
    Long,
    NodeRow,
    PerturbationRow,
    QuantityRow,
    RepairRow,
    Seed,
    StepRow,
    WarningRow,
)
from hearth.schemas.stage_rows import ClippedRow, DemonstratedRow, FilmedRow, RenderedRow, RunRow


class VersionsRow(TypedDict):
    """The owner of a published row."""

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
    """An environment: a home prepared for a program, as its differences from the home."""

    conditions: list[ConditionRow]


class _Execution(TypedDict):
    execution_id: str
    program_id: str
    environment_id: str
    home: str


class ExecutionRow(_Execution, RunRow):
    """An execution: a program run in an environment, tick by tick."""

    reproduces: bool | None


class HarmfulExecutionRow(ExecutionRow, HarmRow):
    """An execution: a program run in an environment, tick by tick, with the harm that it did."""


class StoredRunRow(ExecutionRow):
    """An execution with its environment."""

    environment: EnvironmentRow


class _Tried(TypedDict):
    program_id: Annotated[str | None, "the repaired program; null where no program came of it"]
    execution_id: Annotated[str | None, "the run of the repaired program"]
    environment_id: Annotated[str | None, "the perturbed environment"]
    parent_id: Annotated[str | None, "the program whose preconditions were perturbed"]
    home: Annotated[str, "the home"]
    outcome: Annotated[str, "REPAIRED, or the code of the failure by which repairing gave no program, such as LOOP"]


class RepairedRow(_Tried, RepairRow):
    """A repair, tried when a program failed in a perturbed environment."""


class PerturbedRow(_Tried, PerturbationRow):
    """A perturbation of the environment of a program, with the failures that it caused."""


class SplitRow(TypedDict):
    """The part that an execution has in a split."""

    split: Annotated[
        str, "activities, held_out_home, homes_1_4, homes_1_5, or one of a source; splits.json says what they mean"
    ]
    execution_id: Annotated[str, "the execution"]
    program_id: Annotated[str, "its program"]
    part: Annotated[
        str | None, "train, validation, test or another part of this split; null where the split has no place for it"
    ]


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
    """The fate of a stage's records: `records_in = records_through + records_rejected`."""

    stage: Annotated[str, "the stage"]
    record: Annotated[str, "what its records are, and what was left out; the rows of other kinds go on as they are"]
    order: Annotated[int, "place in the pipeline, from 0"]
    records_in: Annotated[Long, "records read"]
    records_through: Annotated[Long, "records that gave at least one row"]
    records_rejected: Annotated[Long, "records refused whole"]
    partial_rejects: Annotated[Long, "parts refused of records that went on"]
    rows: Annotated[Long, "rows written"]
    codes: Annotated[list[CodeRow], "why records were refused, commonest first"]
    fuzzy: Annotated[Long, "steps that were read as a typo, or of which words were left out"]
