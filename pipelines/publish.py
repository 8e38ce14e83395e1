"""Stage 6: the published tables. An execution that its published row does not reproduce is refused."""

from collections.abc import Iterable, Iterator

from hearth.datasets.format.cases import difference_on_replay
from hearth.datasets.format.ids import STAMP, activity_id, split_of
from hearth.pipelines.engine.build_homes import Homes
from hearth.pipelines.engine.context import knowledge_used, overlays
from hearth.pipelines.engine.final_tables import finish
from hearth.pipelines.engine.stage import Stage
from hearth.schemas.failures import Code
from hearth.schemas.rows import CaseRow, EnvironmentRow, ExecutionRow, ProgramRow, RepairedRow, Row, columns_of
from hearth.schemas.tables import TABLES
from hearth.storage.rejects import Reject

PER_CASE = ("programs", "environments", "executions", "repairs")
"""Tables whose rows come from one case each; the others need all cases."""

GATHER = 2_048
"""Cases published in one file: a query opens every file's footer, so files should be few."""


class Context:
    """Homes, the seed, and the program published last: a program in several homes is one row."""

    def __init__(self, homes: Homes, seed: int) -> None:
        self.homes, self.seed = homes, seed
        self.last = ""


def process(case: CaseRow, context: Context) -> Iterable[tuple[str, Row]] | Reject:
    """The rows of one case, if replaying it gives the same execution."""
    difference = difference_on_replay(case, context.homes)
    if difference:
        return Reject.of(Code.REPLAY_DIFFERS, difference, file=case["place"], found=case["execution_id"])
    return _rows(case, context)


def _rows(case: CaseRow, context: Context) -> Iterator[tuple[str, Row]]:
    if case["program_id"] != context.last:
        context.last = case["program_id"]
        yield "programs", {**program_row(case, context.seed), **STAMP}
    yield "environments", {**columns_of(EnvironmentRow, {**case, **case["environment"]}), **STAMP}
    yield "executions", {**columns_of(ExecutionRow, case), **STAMP}
    for repair in case["repairs"]:
        # The repairs that the program came of.
        yield "repairs", {**columns_of(RepairedRow, {**case, "outcome": "REPAIRED", **repair}), **STAMP}


def program_row(case: CaseRow, seed: int) -> ProgramRow:
    """The program of a case; its activity and the build's seed decide its split."""
    activity = activity_id(case["title"])
    return columns_of(ProgramRow, {**case, "activity_id": activity, "split": split_of(activity, seed)})


STAGE = Stage(
    name="publish",
    tables={name: TABLES[name] for name in PER_CASE},
    process=process,
    reads=("sample", "augment"),
    needs=("ingest", "validate", "render"),
    settings=("seed",),
    open=lambda job: Context(Homes(job.settings), job.settings.seed),
    prepare=overlays,
    gather=GATHER,
    exchanged=True,
    identify=lambda case: str(case["execution_id"]),
    finish=finish,
    facts=knowledge_used,
)
