"""Stage 4: programs repaired for environments in which something they rely on is otherwise (thesis 5.5.4)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import cached_property, lru_cache
from typing import Any

from hearth.grounding.conditions import CHARACTER, Preconditions
from hearth.grounding.perturbing import Chances, Perturbation
from hearth.grounding.sampling import Environment
from hearth.pipelines.augmenting import Augmented, Options, Pair, augment, default_chances
from hearth.pipelines.cases import environment_of, rerun, run_row
from hearth.pipelines.parts import Row
from hearth.pipelines.rejects import Reject
from hearth.pipelines.repairing import Attempt
from hearth.pipelines.rows import (
    change_row,
    condition_rows,
    conditions_of,
    failure_row,
    node_row,
    program_of,
    step_rows,
)
from hearth.pipelines.settings import Settings
from hearth.pipelines.stage import Job, Record, Stage
from hearth.pipelines.surroundings import USES, Homes, overlays
from hearth.schemas.failures import Code, Failure
from hearth.schemas.program import ObjectRef, Step
from hearth.schemas.syntax import print_step
from hearth.schemas.tables import CASE
from hearth.simulation.change import Change
from hearth.simulation.world import World

THESIS = 0.7
"""The probability of perturbing a precondition (thesis 5.5.4), to which augment.yaml's are relative."""

_KEPT = ("source", "place", "description_id", "title", "description", "scene", "worker", "platform", "rooms", "props")


class Context:
    """What a record is processed with."""

    def __init__(self, settings: Settings) -> None:
        self.homes = Homes(settings)
        self.seed = settings.seed
        chances = scaled(default_chances(), settings.probability / THESIS)
        self.options = Options(settings.variants, settings.tries, chances)

    @cached_property
    def at_rest(self) -> dict[str, bool]:
        """Whether environments of a home are told by what differs from it at rest, by the home's name."""
        return {}

    def is_at_rest(self, name: str) -> bool:
        """Whether a home is given at rest: the catalog's are, derived ones are as they were found."""
        if name not in self.at_rest:
            self.at_rest[name] = self.homes.in_catalog(name)
        return self.at_rest[name]


def scaled(chances: Chances, factor: float) -> Chances:
    """Every probability multiplied, none above 1."""
    return replace(chances, kinds={kind: min(1.0, chance * factor) for kind, chance in chances.kinds.items()})


def process(record: Record, context: Context) -> Iterator[Row | Reject] | Reject:
    """A row for every repaired program; a reject for every environment that gave none."""
    program = program_of(record)
    home = context.homes.home(record["home"])
    original = (_conditions(record), rerun(record, context.homes))
    found = augment(program, home, context.seed, record["environment_id"], context.options, original)
    assert isinstance(found, Augmented), "the original is at hand"
    return _outputs(record, found, context) if found.pairs else _nothing_to_perturb(record)


def _outputs(record: Record, found: Augmented, context: Context) -> Iterator[Row | Reject]:
    for pair in found.pairs:
        yield _row(record, pair, context) if pair.failure is None else _reject(record, pair, pair.failure)


def _nothing_to_perturb(record: Record) -> Reject:
    failure = Failure(Code.UNPERTURBED, expected="something the program relies on", actual="nothing")
    return Reject.failed(failure, f"{record['place']} in {record['home']}")


def _reject(record: Record, pair: Pair, failure: Failure) -> Reject:
    told = "; ".join(map(str, pair.perturbations))
    return Reject.failed(failure, f"{record['place']} in {record['home']}, where {told}")


def _conditions(record: Record) -> Preconditions:
    """The conditions of a row, those left out that name what the program does not."""
    keys = {(ref["name"], ref["instance"]) for step in record["steps"] for ref in step["objects"]} | {CHARACTER}
    found = conditions_of(record["conditions"])
    return found.without(*(condition for condition in found if not keys.issuperset(condition.objects)))


def _row(record: Record, pair: Pair, context: Context) -> Row:
    home = record["home"]
    program_id = f"{record['program_id']}+{home}.{pair.number}"
    environment_id = f"{program_id}@{home}"
    return {
        **{name: record[name] for name in _KEPT},
        "program_id": program_id,
        "origin": "augmented",
        "parent_id": record["program_id"],
        "steps": step_rows(pair.program),
        "warnings": [],
        "environment_id": environment_id,
        "execution_id": f"{environment_id}/0",
        "home": home,
        "seed": context.seed,
        "environment": _environment(pair.environment, home, context),
        "conditions": condition_rows(pair.environment.conditions),
        **run_row(pair.execution, "default"),
        "perturbations": [_perturbation(one) for one in pair.perturbations],
        "repairs": [_repair(attempt) for attempt in pair.attempts],
    }


def _environment(environment: Environment, name: str, context: Context) -> Row:
    if context.is_at_rest(name):
        return environment_of(environment, context.homes.edges(name))
    change = environment.world.changes(World.start(context.homes.home(name)))
    new = {node.id for node in environment.nodes}
    states = dict(environment.states)
    nodes = [node_row(replace(node, states=tuple(states.get(node.id, node.states)))) for node in environment.nodes]
    kept = Change(
        change.added,
        change.removed,
        tuple(pair for pair in change.set_states if pair[0] not in new),
        tuple(pair for pair in change.cleared_states if pair[0] not in new),
    )
    return {"added_nodes": nodes, "removed_nodes": [], **change_row(kept)}


def _perturbation(perturbation: Perturbation) -> Row:
    return {"kind": perturbation.kind, "condition": condition_rows([perturbation.about])[0]}


def _repair(attempt: Attempt) -> Row:
    return {
        "attempt": attempt.number,
        "step": attempt.step,
        "failure": failure_row(attempt.failure),
        "handler": attempt.handler,
        "before": _texts(attempt.before),
        "after": _texts(attempt.after),
    }


def _texts(steps: tuple[Step, ...]) -> list[str]:
    """Steps as text, unbound; what is done in the tick of the step before begins with a bar."""
    return list(map(_text, steps))


@lru_cache(maxsize=1 << 14)
def _text(step: Step) -> str:
    objects = tuple(ObjectRef(ref.name, ref.instance) for ref in step.objects)
    return ("| " if step.joins else "") + print_step(Step(step.action, objects, step.agent, False, step.modifiers))


def open_context(job: Job) -> Context:
    """Homes, built when first asked for, and how to augment."""
    return Context(job.settings)


def prepare(settings: Settings) -> dict[str, Any]:
    """What the user laid over our knowledge and homes."""
    return overlays(settings)


STAGE = Stage(
    name="augment",
    tables={"": CASE},
    process=process,
    reads=("sample",),
    uses=(
        *USES,
        "grounding",
        "pipelines/augment.py",
        "pipelines/augment.yaml",
        "pipelines/augmenting.py",
        "pipelines/canonical.py",
        "pipelines/cases.py",
        "pipelines/handlers",
        "pipelines/repairing.py",
    ),
    settings=("seed", "probability", "variants", "tries"),
    open=open_context,
    prepare=prepare,
    select=lambda record, plan: bool(record["executable"]),
    identify=lambda record: str(record["execution_id"]),
    tally=lambda row: f"{len(row['repairs'])} repairs",
)
