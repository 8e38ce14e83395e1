"""The columns of every table, as Arrow schemas: what the stages pass on, and what is published.

Nested types are used where a thing belongs to its row. Every column says what it means in its field's metadata
(`comment`), which dataset cards read. Node ids are those of the environment's graph; steps and ticks count from 0.
"""

from __future__ import annotations

from typing import Final

import pyarrow as pa


def _column(name: str, kind: pa.DataType, comment: str) -> pa.Field:
    return pa.field(name, kind, metadata={"comment": comment})


def _struct(**fields: pa.DataType) -> pa.DataType:
    return pa.struct(list(fields.items()))


TEXT: Final = pa.string()
TEXTS: Final = pa.list_(TEXT)
COUNT: Final = pa.int32()
NODE_ID: Final = pa.int32()

POINT: Final = _struct(x=pa.float64(), y=pa.float64(), z=pa.float64())
BOX: Final = _struct(center=POINT, size=POINT)
NODE: Final = _struct(
    id=NODE_ID, class_name=TEXT, category=TEXT, properties=TEXTS, states=TEXTS, prefab=TEXT, box=BOX, yaw=pa.float64()
)
EDGE: Final = _struct(source=NODE_ID, relation=TEXT, target=NODE_ID)
NODE_STATE: Final = _struct(node=NODE_ID, state=TEXT)
EDGES: Final = pa.list_(EDGE)
NODE_STATES: Final = pa.list_(NODE_STATE)
CHANGE: Final = _struct(added=EDGES, removed=EDGES, set_states=NODE_STATES, cleared_states=NODE_STATES)
"""What differs between two worlds over the same nodes."""

GRAPH: Final = _struct(
    nodes=pa.list_(NODE), sources=pa.list_(NODE_ID), relations=pa.list_(TEXT), targets=pa.list_(NODE_ID)
)
"""A whole graph; edges column by column, since there are thousands. Only ingest keeps whole graphs."""

ARGUMENT: Final = _struct(name=TEXT, instance=COUNT)
CONDITION: Final = _struct(name=TEXT, objects=pa.list_(ARGUMENT), step=COUNT, hard=pa.bool_())
"""A precondition; `step` and `hard` are null where they came with the program."""
BINDING: Final = _struct(name=TEXT, instance=COUNT, node=NODE_ID)
STEP: Final = _struct(
    agent=COUNT,
    action=TEXT,
    objects=pa.list_(ARGUMENT),
    joins=pa.bool_(),
    modifiers=pa.list_(_struct(name=TEXT, value=TEXT)),
    line=COUNT,
)
QUANTITY: Final = _struct(name=TEXT, quantity=COUNT)
FAILURE: Final = _struct(
    code=TEXT,
    tick=COUNT,
    agent=COUNT,
    action=TEXT,
    objects=pa.list_(NODE_ID),
    names=TEXTS,
    expected=TEXT,
    actual=TEXT,
)
WARNING: Final = _struct(code=TEXT, line=COUNT, column=COUNT, found=TEXT, message=TEXT, suggestion=TEXT)
TICK: Final = _struct(
    instructions=pa.list_(_struct(agent=COUNT, step=COUNT)),
    added=EDGES,
    removed=EDGES,
    set_states=NODE_STATES,
    cleared_states=NODE_STATES,
)
ENVIRONMENT: Final = _struct(
    added_nodes=pa.list_(NODE),
    removed_nodes=pa.list_(NODE_ID),
    added=EDGES,
    removed=EDGES,
    set_states=NODE_STATES,
    cleared_states=NODE_STATES,
)
"""What differs from the home. A removed node takes its edges with it."""

PERTURBATION: Final = _struct(kind=TEXT, condition=CONDITION)
REPAIR: Final = _struct(
    attempt=COUNT,
    step=COUNT,
    failure=FAILURE,
    handler=TEXT,
    before=TEXTS,
    after=TEXTS,
    successful=pa.bool_(),
)
"""One repair; successful when the failure it is for did not come back at once."""

# What the stages pass on

_NAMED = [
    _column("program_id", TEXT, "stable id of the program"),
    _column("origin", TEXT, "crowd, release, text, spoken, records, sketches, scenes, synthetic or augmented"),
    _column("source", TEXT, "the source it came from, as named in the manifest"),
    _column("place", TEXT, "file and line inside the source"),
    _column("description_id", TEXT, "the description it was written for"),
    _column("title", TEXT, "name of the activity as written"),
    _column("description", TEXT, "what is done, in words"),
    _column("scene", TEXT, "room the worker was shown"),
    _column("worker", TEXT, "salted hash of the worker's id"),
    _column("platform", TEXT, "crowd-sourcing platform"),
    _column("rooms", pa.list_(QUANTITY), "rooms declared by the worker"),
    _column("props", pa.list_(QUANTITY), "objects declared by the worker"),
]

INGESTED: Final = pa.schema(
    [
        _column("kind", TEXT, "program, description where only words were given, sketch, or scene for a graph alone"),
        *_NAMED,
        _column("text", TEXT, "the program as collected; null for a description"),
        _column("line", COUNT, "file line of the text's first line, less one"),
        _column(
            "groundings",
            pa.list_(_struct(home=TEXT, text=TEXT, start=GRAPH, final=CHANGE)),
            "the program as grounded in a home, with the start graph and what the stored final graph changes",
        ),
        _column("conditions", pa.list_(CONDITION), "preconditions that came with the program"),
        _column("keep", pa.list_(pa.bool_()), "for each step of the program a sketch is of, whether it is kept"),
    ]
)

VALIDATED: Final = pa.schema(
    [
        *_NAMED,
        _column("steps", pa.list_(STEP), "the program in canonical names, unbound"),
        _column(
            "groundings",
            pa.list_(_struct(home=TEXT, steps=pa.list_(STEP), bindings=pa.list_(BINDING), start=GRAPH, final=CHANGE)),
            "the program as grounded in a home, checked",
        ),
        _column("conditions", pa.list_(CONDITION), "preconditions that came with the program"),
        _column("warnings", pa.list_(WARNING), "what looks wrong but does not prevent running"),
    ]
)

CASE: Final = pa.schema(
    [
        *_NAMED,
        _column("parent_id", TEXT, "the program it was made from; null for originals"),
        _column("steps", pa.list_(STEP), "the program in canonical names, unbound"),
        _column("warnings", pa.list_(WARNING), "what looks wrong but does not prevent running"),
        _column("environment_id", TEXT, "the environment it runs in"),
        _column("home", TEXT, "the home the environment was made from"),
        _column("seed", pa.uint64(), "seed the environment was sampled with; null when it was given"),
        _column("environment", ENVIRONMENT, "what differs from the home"),
        _column("conditions", pa.list_(CONDITION), "what had to hold at the start: given, or inferred"),
        _column("execution_id", TEXT, "this run of the program"),
        _column("rules", TEXT, "named options of the engine: default or replay"),
        _column("bindings", pa.list_(BINDING), "program objects to graph nodes"),
        _column("ticks", pa.list_(TICK), "what each tick did and changed"),
        _column("executable", pa.bool_(), "ran to its end"),
        _column("failure", FAILURE, "why it stopped; null when it ran to its end"),
        _column("reproduces", pa.bool_(), "ends in the final graph stored with it; null when none was"),
        _column("perturbations", pa.list_(PERTURBATION), "which conditions were dropped or swapped"),
        _column("repairs", pa.list_(REPAIR), "how it was made to run again"),
    ]
)
"""A program in an environment, run: what sample and augment write, and render and publish read."""

_TRIED = [
    *[CASE.field(name) for name in ("parent_id", "home", "perturbations")],
    _column("outcome", TEXT, "REPAIRED, or why no program came of repairing: DUPLICATE, NO_HANDLER, LOOP, ..."),
    *[_column(field.name, field.type, f"repair: {field.name}") for field in REPAIR],
]

TRIED: Final = pa.schema(_TRIED)
"""Repairs that gave no program of their own: what augment writes besides."""

SKETCHED: Final = pa.schema(
    [
        _column("program_id", TEXT, "the program"),
        _column("origin", TEXT, "people, inferred, or inherited from the program's parent"),
        _column("keep", pa.list_(pa.bool_()), "for each step, whether the sketch keeps it"),
        _column("steps", TEXTS, "the kept steps, as text"),
    ]
)
"""Sketches (thesis 5.5.1)."""

RENDERED: Final = pa.schema(
    [
        _column("execution_id", TEXT, "the execution filmed"),
        _column("tick", COUNT, "the world after so many ticks"),
        _column("camera", TEXT, "name of the camera"),
        _column("modality", TEXT, "rgb, ids, depth, ..."),
        _column("width", COUNT, "pixels"),
        _column("height", COUNT, "pixels"),
        _column(
            "intrinsics",
            _struct(fx=pa.float64(), fy=pa.float64(), cx=pa.float64(), cy=pa.float64()),
            "pinhole camera, pixels",
        ),
        _column("pose", pa.list_(pa.float64()), "camera to world, 4x4 row by row"),
        _column("start_time", pa.float64(), "seconds from the start of the execution; null for pictures between ticks"),
        _column("end_time", pa.float64(), "the same"),
        _column("layout_made", pa.bool_(), "whether the home had no geometry, and was laid out by its relations"),
        _column("file", TEXT, "picture or video, relative to the dataset"),
    ]
)

_PINHOLE = _struct(fx=pa.float64(), fy=pa.float64(), cx=pa.float64(), cy=pa.float64())

FILMED: Final = pa.schema(
    [
        _column("execution_id", TEXT, "the execution filmed"),
        _column("camera", TEXT, "auto (chosen by what it sees), top, first, third, or the name of one that stays"),
        _column("width", COUNT, "pixels"),
        _column("height", COUNT, "pixels"),
        _column("fps", pa.float64(), "pictures a second"),
        _column("frames", COUNT, "pictures"),
        _column("seconds", pa.float64(), "how long it is"),
        _column(
            "steps",
            pa.list_(
                _struct(
                    tick=COUNT,
                    steps=TEXTS,
                    start=pa.float64(),
                    end=pa.float64(),
                    cameras=TEXTS,
                    visible=pa.float64(),
                )
            ),
            "when each tick is shown, seconds; by which cameras; the share of the objects it names that are seen",
        ),
        _column(
            "track",
            pa.list_(_struct(frame=COUNT, tick=COUNT, camera=TEXT, intrinsics=_PINHOLE, pose=pa.list_(pa.float64()))),
            "camera of the pictures from this one on: intrinsics, and pose from camera to world, 4x4 row by row",
        ),
        _column(
            "variation",
            _struct(
                seed=pa.int64(),
                hour=pa.float64(),
                speed=pa.float64(),
                jitter=pa.float64(),
                scatter=pa.float64(),
                wander=pa.bool_(),
            ),
            "what was drawn by chance: see `rendering.variation`",
        ),
        _column("layout_made", pa.bool_(), "whether the home had no geometry, and was laid out by its relations"),
        _column("file", TEXT, "the video, relative to the dataset"),
    ]
)

REJECTED: Final = pa.schema(
    [
        _column("stage", TEXT, "which stage refused it"),
        _column("record_id", TEXT, "the record, or the file when nothing in it could be told apart"),
        _column("code", TEXT, "why"),
        _column("file", TEXT, "source and file inside it"),
        _column("line", COUNT, "from 1; 0 when it concerns the whole file"),
        _column("column", COUNT, "from 1; 0 when unknown"),
        _column("found", TEXT, "the offending words"),
        _column("message", TEXT, "the fault"),
        _column("suggestion", TEXT, "the remedy, if one is known"),
        _column("partial", pa.bool_(), "only a part of the record was refused; the rest went on"),
        _column("fault", COUNT, "number of the fault within the record, from 0; the first one is what it counts under"),
        _column("partition", COUNT, "partition of the stage that held it"),
    ]
)

# What is published

_VERSIONS = [
    _column("action_set", TEXT, "the meaning of actions it was run with"),
    _column("dataset_version", TEXT, "the dataset it belongs to"),
]


def _published(*columns: pa.Field) -> pa.Schema:
    return pa.schema([*columns, *_VERSIONS])


def _of(schema: pa.Schema, *names: str) -> list[pa.Field]:
    return [schema.field(name) for name in names]


TABLES: Final[dict[str, pa.Schema]] = {
    "activities": _published(
        _column("activity_id", TEXT, "the title in lower case, words joined by underscores"),
        _column("title", TEXT, "the commonest spelling"),
        _column("scenes", TEXTS, "rooms it was told for"),
        _column("descriptions", COUNT, "how many descriptions"),
        _column("programs", COUNT, "how many programs, augmented ones included"),
    ),
    "descriptions": _published(
        _column("description_id", TEXT, "stable id"),
        _column("activity_id", TEXT, "the activity described"),
        *_of(INGESTED, "title", "description", "scene", "origin", "source", "worker", "platform"),
        _column("programs", COUNT, "how many programs were written for it"),
    ),
    "programs": _published(
        _column("program_id", TEXT, "stable id of the program"),
        _column("activity_id", TEXT, "the activity it carries out"),
        *_of(CASE, "description_id", "parent_id", "origin", "source", "place", "title", "description"),
        _column("split", TEXT, "train or test, by activity; `splits` leaves out of train what nearly equals a test"),
        *_of(CASE, "steps", "rooms", "props", "worker", "platform", "warnings"),
    ),
    "homes": _published(
        _column("home", TEXT, "its name"),
        _column("origin", TEXT, "catalog, or derived from what the stored start graphs share"),
        _column("rooms", TEXTS, "classes of its rooms"),
        _column("nodes", COUNT, "how many nodes"),
        _column("edges", COUNT, "how many edges"),
        _column("has_geometry", pa.bool_(), "every room has a box"),
    ),
    "home_nodes": _published(
        _column("home", TEXT, "the home"),
        *[_column(field.name, field.type, f"node: {field.name}") for field in NODE],
    ),
    "home_edges": _published(
        _column("home", TEXT, "the home"),
        *[_column(field.name, field.type, f"edge: {field.name}") for field in EDGE],
    ),
    "environments": _published(
        *_of(CASE, "environment_id", "home", "seed"),
        _column("program_id", TEXT, "the program it was prepared for"),
        *[_column(field.name, field.type, f"differs from the home: {field.name}") for field in ENVIRONMENT],
        *_of(CASE, "conditions"),
    ),
    "executions": _published(
        *_of(CASE, "execution_id", "program_id", "environment_id", "home", "rules", "bindings", "ticks"),
        *_of(CASE, "executable", "failure", "reproduces"),
    ),
    "repairs": _published(
        _column("program_id", TEXT, "the repaired program; null where no program came of it"),
        *_of(CASE, "execution_id", "environment_id"),
        *_TRIED,
    ),
    "splits": _published(
        _column("split", TEXT, "activities, homes_1_4 or homes_1_5; splits.json says what they mean"),
        _column("execution_id", TEXT, "the execution"),
        _column("program_id", TEXT, "its program"),
        _column("part", TEXT, "train, validation, test...; none where the split has no place for it"),
    ),
    "sketches": _published(*SKETCHED),
    "frames": _published(*RENDERED, _column("home", TEXT, "where it was filmed")),
    "videos": _published(*FILMED, _column("home", TEXT, "where it was filmed")),
    "vocabulary": _published(
        _column("kind", TEXT, "action, class, state, property, relation, edge_type or failure"),
        _column("id", COUNT, "stable number within its kind"),
        _column("name", TEXT, "canonical name"),
        _column("arity", COUNT, "number of objects; actions only"),
        _column("simulated", pa.bool_(), "whether the engine executes it; actions only"),
    ),
    "rejects": _published(*_of(REJECTED, *[name for name in REJECTED.names if name != "partition"])),
    "ledger": _published(
        _column("stage", TEXT, "the stage"),
        _column("order", COUNT, "place in the pipeline, from 0"),
        _column("records_in", pa.int64(), "records read"),
        _column("records_through", pa.int64(), "records that gave at least one row"),
        _column("records_rejected", pa.int64(), "records refused whole"),
        _column("partial_rejects", pa.int64(), "parts refused of records that went on"),
        _column("rows", pa.int64(), "rows written"),
        _column("codes", pa.list_(_struct(code=TEXT, count=pa.int64())), "why records were refused, commonest first"),
    ),
}
"""Published tables by name. `records_in = records_through + records_rejected` in every row of the ledger."""
