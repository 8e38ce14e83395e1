"""Stage 6: the tables people load. Every execution is run again from what is published of it, or refused."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from hearth.pipelines.cases import difference_on_replay
from hearth.pipelines.library import Homes
from hearth.pipelines.naming import STAMP, activity_id, split_of
from hearth.pipelines.parts import Row
from hearth.pipelines.publishing import finish
from hearth.pipelines.rejects import Reject
from hearth.pipelines.stage import Job, Record, Stage
from hearth.pipelines.surroundings import knowledge_used, overlays
from hearth.schemas.failures import Code
from hearth.schemas.tables import ENVIRONMENT, REPAIR, TABLES

PER_CASE = ("programs", "environments", "executions", "repairs")
"""Tables whose rows come from one case each; the others need all of them."""

GATHER = 2_048
"""Cases published in one file: whoever asks for one opens every file's footer, so that there should be few."""

_SHARED = {
    "programs": ("program_id", "description_id", "parent_id", "origin", "source", "place", "title", "description",
                 "steps", "rooms", "props", "worker", "platform", "warnings"),
    "environments": ("environment_id", "home", "seed", "program_id", "conditions"),
    "executions": ("execution_id", "program_id", "environment_id", "home", "rules", "bindings", "ticks",
                   "executable", "failure", "reproduces"),
    "repairs": ("program_id", "parent_id", "execution_id", "environment_id", "home", "perturbations"),
}  # fmt: skip


class Context:
    """Homes, the seed, and which program was published last: one in several homes is one row."""

    def __init__(self, homes: Homes, seed: int) -> None:
        self.homes, self.seed = homes, seed
        self.last = ""


def process(case: Record, context: Context) -> Iterable[tuple[str, Row]] | Reject:
    """The rows of one case, if running it again gives what it says."""
    difference = difference_on_replay(case, context.homes)
    if difference:
        return Reject.of(Code.REPLAY_DIFFERS, difference, file=case["place"], found=case["execution_id"])
    return _rows(case, context)


def _rows(case: Record, context: Context) -> Iterator[tuple[str, Row]]:
    if case["program_id"] != context.last:
        context.last = case["program_id"]
        activity = activity_id(case["title"])
        told = {"activity_id": activity, "split": split_of(activity, context.seed)}
        yield "programs", {**_shared("programs", case), **told}
    differs = {field.name: case["environment"][field.name] for field in ENVIRONMENT}
    yield "environments", {**_shared("environments", case), **differs}
    yield "executions", _shared("executions", case)
    for repair in case["repairs"]:
        yield (
            "repairs",
            {**_shared("repairs", case), "outcome": "REPAIRED", **{field.name: repair[field.name] for field in REPAIR}},
        )


def _shared(table: str, case: Record) -> Row:
    return {**{name: case[name] for name in _SHARED[table]}, **STAMP}


def open_context(job: Job) -> Context:
    """Homes, built when first asked for."""
    return Context(Homes(job.settings), job.settings.seed)


STAGE = Stage(
    name="publish",
    tables={name: TABLES[name] for name in PER_CASE},
    process=process,
    reads=("sample", "augment"),
    needs=("ingest", "validate", "render"),
    settings=("seed",),
    open=open_context,
    prepare=overlays,
    gather=GATHER,
    identify=lambda case: str(case["execution_id"]),
    finish=finish,
    facts=knowledge_used,
)
