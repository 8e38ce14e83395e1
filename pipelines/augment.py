"""Stage 4: programs repaired for environments in which some of their preconditions are violated (thesis 5.5.4)."""

from collections.abc import Iterator
from dataclasses import replace
from functools import cache, cached_property, lru_cache

from hearth.datasets.format.case_rows import environment_of, further_states, rerun, run_row
from hearth.datasets.format.row_conversion import (
    condition_rows,
    conditions_of,
    environment_row,
    failure_row,
    program_of,
    step_rows,
)
from hearth.grounding.environments.sampling import Environment
from hearth.grounding.preconditions.conditions import Preconditions
from hearth.pipelines.engine.build_homes import Homes
from hearth.pipelines.engine.settings import Settings
from hearth.pipelines.engine.stage import NOTE, Job, Output, Partition, Plan, Stage, rows_of
from hearth.pipelines.engine.user_overlays import overlays, overlays_used
from hearth.repair.augmentation import Augmented, Options, Pair, augment
from hearth.repair.failure_causes import cause
from hearth.repair.perturbation_strengths import strength
from hearth.repair.repair_loop import successes
from hearth.repair.sketch import ENVIRONMENTS, Keep, inherited, sketch
from hearth.schemas.failures import Code, Failure
from hearth.schemas.literals import CHARACTER
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.schemas.rng import rng
from hearth.schemas.row_types import DifferenceRow, PerturbationRow, RepairRow, Row
from hearth.schemas.stage_rows import CaseRow, SketchRow
from hearth.schemas.syntax import print_step
from hearth.schemas.tables import CASE, SKETCHED
from hearth.simulation.engine import Execution, run
from hearth.simulation.rules import rules_of
from hearth.simulation.world.action_set_3_states import is_wide, wide_start
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World
from hearth.storage.manifest import read_manifest
from hearth.storage.rejects import Reject

ORIGINAL = "original"
"""Key of the counts of originals in perturbed environments; other rows are counted by their number of repairs."""

_DONE = frozenset({Code.DUPLICATE, Code.UNPERTURBED})
"""Reasons to refuse a program that runs and reaches its goal."""


class Context:
    """The resources for processing a record."""

    def __init__(self, settings: Settings, plan: Plan) -> None:
        self.homes = Homes(settings)
        # Homes of the catalog are built in their default state; derived homes keep their stored states.
        self.in_default_state = cache(self.homes.in_catalog)
        self.seed = settings.seed
        rules = rules_of(self.homes.knowledge)
        self.options = Options(settings.variants, settings.tries, settings.strength, rules)
        self.each = _each(settings, plan)
        self.sketched = ""
        self.keep: Keep = ()

    @cached_property
    def _others(self) -> list[Home]:
        return [self.homes.home(name) for name in self.homes.names()[:ENVIRONMENTS]]

    def others(self, name: str) -> list[Home]:
        """Return the homes besides its own in which a program's sketch has to suffice."""
        return [home for home in self._others if home.name != name]

    def options_for(self, record_id: str) -> Options:
        """Return how an execution is augmented; a fractional number of pairs is rounded up or down at random."""
        return replace(self.options, count=_pairs(self.each, self.seed, record_id))


def _pairs(each: float, seed: int, record_id: str) -> int:
    """Return how many environments an execution gets."""
    whole = int(each)
    return whole + (rng(seed, "augment", record_id).random() < each - whole)


def records(job: Job, partition: Partition) -> Iterator[CaseRow]:
    """Yield the executions that get environments, and the first one of each program, which gives its sketch."""
    each, last = _each(job.settings, job.plan), None
    for row in rows_of(job, partition):
        if row["program_id"] != last or _pairs(each, job.settings.seed, row["execution_id"]):
            yield row
        last = row["program_id"]


def _each(settings: Settings, plan: Plan) -> float:
    return float(plan.get("each", settings.variants))


def process(record: CaseRow, context: Context) -> Iterator[Output]:
    """Yield a row for each repaired program, a reject for each environment that gave none, and a row for the original
    in each environment in which it had to be repaired.

    The program's sketch is added once, however many homes it is in, and each child's sketch is inherited from it.
    """
    options = context.options_for(record["execution_id"])
    program = program_of(record)
    home = context.homes.home(record["home"])
    original = (_conditions(record), rerun(record, context.homes))
    found = augment(program, home, context.seed, record["environment_id"], options, original)
    assert isinstance(found, Augmented), "the original is at hand"
    sketched = [*_sketched(record, program, original, context)]
    yield from sketched
    yield from _outputs(record, found, context)
    if not found.pairs and options.count:
        yield _nothing_to_perturb(record)


def _sketched(
    record: CaseRow, program: Program, original: tuple[Preconditions, Execution], context: Context
) -> Iterator[Output]:
    """Yield the program's sketch, unless the record of another home gave it."""
    name = record["program_id"]
    if name != context.sketched:
        context.sketched = name
        others, knowledge = context.others(record["home"]), context.homes.knowledge
        context.keep = sketch(program, others, knowledge, context.seed, name, original)
        yield "sketches", _sketch(name, "inferred", program, context.keep)


def _outputs(record: CaseRow, found: Augmented, context: Context) -> Iterator[Output]:
    for pair in found.pairs:
        if pair.failure is not None:
            yield _reject(record, pair, pair.failure)
        if pair.attempts:
            yield from _cases(record, pair, context)


def _sketch(program_id: str, origin: str, program: Program, keep: Keep) -> SketchRow:
    steps = [_text(step) for step, kept in zip(program.steps, keep, strict=True) if kept]
    return {"program_id": program_id, "origin": origin, "keep": list(keep), "steps": steps}


def _nothing_to_perturb(record: CaseRow) -> Reject:
    failure = Failure(Code.UNPERTURBED, expected="a precondition that can be perturbed", actual="none")
    return Reject.failed(failure, record["place"], where=f"in {record['home']}")


def _reject(record: CaseRow, pair: Pair, failure: Failure) -> Reject:
    perturbed = "; ".join(map(str, pair.perturbations))
    return Reject.failed(failure, record["place"], where=f"in {record['home']}, where {perturbed}")


def _conditions(record: CaseRow) -> Preconditions:
    """Return the conditions of a row, without those that name objects which the program does not use."""
    keys = {(ref["name"], ref["instance"]) for step in record["steps"] for ref in step["objects"]} | {CHARACTER}
    found = conditions_of(record["conditions"])
    return found.without(*(condition for condition in found if not keys.issuperset(condition.objects)))


def _cases(record: CaseRow, pair: Pair, context: Context) -> Iterator[Output]:
    """Yield the cases of the repaired program, if there is one, and of the original in the same environment.

    The original has the repairs if no program came of them. One that runs there and still was repaired, since it lost
    its goal, has nothing to add to the repaired program.
    """
    program_id = f"{record['program_id']}+{record['home']}.{pair.number}"
    environment_id = f"{program_id}@{record['home']}"
    ids = [f"{environment_id}#{number}" for number in range(len(pair.perturbations))]
    repairs = _repairs(pair, ids)
    original = run(pair.environment.world, pair.environment.program, context.options.rules)
    row: CaseRow = {
        **record,
        "environment_id": environment_id,
        "execution_id": f"{environment_id}/original",
        "seed": context.seed,
        "environment": _environment(pair.environment, record["home"], context),
        "conditions": condition_rows(pair.environment.conditions),
        **run_row(original),
        "reproduces": None,
        "perturbations": _perturbations(pair, ids, repairs),
        "outcome": str(pair.failure.code) if pair.failure else "REPAIRED",
        "repairs": repairs if pair.failure else [],
    }
    if pair.failure is None:
        keep = inherited(context.keep, pair.sources)
        yield "sketches", _sketch(program_id, "inherited", pair.program, keep)
        yield {
            **row,
            "program_id": program_id,
            "origin": "augmented",
            "parent_id": record["program_id"],
            "steps": step_rows(pair.program),
            "warnings": [],
            "execution_id": f"{environment_id}/0",
            **run_row(pair.execution),
            "repairs": repairs,
        }
    if pair.failure is not None or not original.executable:
        yield row


def _environment(environment: Environment, name: str, context: Context) -> DifferenceRow:
    if context.in_default_state(name):
        return environment_of(environment, context.homes.edges(name))
    start = World.start(context.homes.home(name))
    change = environment.world.changes(wide_start(start, 0) if is_wide(environment.world) else start)
    new = {node.id for node in environment.nodes}
    states, (further, _) = dict(environment.states), further_states(environment)
    nodes = (
        replace(node, states=(*states.get(node.id, node.states), *further.get(node.id, ())))
        for node in environment.nodes
    )
    kept = change.where(node=lambda node_id: node_id not in new)
    return environment_row(replace(kept, added_nodes=tuple(nodes)))


def _perturbations(pair: Pair, ids: list[str], repairs: list[RepairRow]) -> list[PerturbationRow]:
    rows: list[PerturbationRow] = []
    for perturbation_id, one in zip(ids, pair.perturbations, strict=True):
        caused = [repair for repair in repairs if repair["perturbation_id"] == perturbation_id]
        rows.append(
            {
                "perturbation_id": perturbation_id,
                "kind": one.kind,
                "dropped": condition_rows(one.dropped),
                "added": condition_rows(one.added),
                "attempts": [repair["attempt"] for repair in caused],
                "failure": caused[0]["failure"] if caused else None,
            }
        )
    return rows


def _repairs(pair: Pair, ids: list[str]) -> list[RepairRow]:
    given_up = pair.failure if pair.failure is not None and pair.failure.code not in _DONE else None
    helped = successes(pair.attempts, given_up)
    rows: list[RepairRow] = []
    for attempt, successful in zip(pair.attempts, helped, strict=True):
        of = cause(pair.perturbations, attempt, pair.environment.program)
        rows.append(
            {
                "perturbation_id": None if of is None else ids[of],
                "attempt": attempt.number,
                "step": attempt.step,
                "failure": failure_row(attempt.failure),
                "handler": attempt.handler,
                "before": _texts(attempt.before),
                "after": _texts(attempt.after),
                "successful": successful,
            }
        )
    return rows


def _texts(steps: tuple[Step, ...]) -> list[str]:
    """Return steps as text, unbound; a step in the same tick as the one before begins with a bar."""
    return list(map(_text, steps))


@lru_cache(maxsize=1 << 14)
def _text(step: Step) -> str:
    objects = tuple(ObjectRef(ref.name, ref.instance) for ref in step.objects)
    return ("| " if step.joins else "") + print_step(Step(step.action, objects, step.agent, False, step.modifiers))


def prepare(settings: Settings) -> Plan:
    """Return the user's overlays, the homes left out, and the number of pairs for each execution."""
    plan = overlays(settings)
    if settings.homes:
        homes = Homes(settings)
        plan["left_out"] = sorted(set(homes.catalog()) - set(homes.names()))
    manifest = read_manifest(settings.folder("sample"))
    if settings.target and manifest is not None:
        each = settings.target * strength(settings.strength).allowance / max(1, manifest.counts.tally["executable"])
        plan["each"] = round(min(each, settings.variants), 4)
    if not _each(settings, plan):
        plan[NOTE] = "no variants were requested: one of each program, for its sketch"
    return plan


def _labels(row: Row) -> tuple[str, ...]:
    if "repairs" not in row:
        return ()
    return (f"{len(row['repairs'])} repairs" if row["origin"] == "augmented" else ORIGINAL,)


STAGE = Stage(
    name="augment",
    tables={"": CASE, "sketches": SKETCHED},
    process=process,
    reads=("sample",),
    settings=("seed", "strength", "variants", "target", "tries", "action_set"),
    open=lambda job: Context(job.settings, job.plan),
    prepare=prepare,
    records=records,
    facts=overlays_used,
    select=lambda record, plan: bool(record["executable"]) and record["home"] not in plan.get("left_out", ()),
    identify=lambda record: str(record["execution_id"]),
    labels=_labels,
)
