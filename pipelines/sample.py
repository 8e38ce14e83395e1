"""Stage 3: every program in an environment where it runs: sampled from a home, or stored with the program."""

from collections import Counter
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

import pyarrow.parquet as pq

from hearth.datasets.format.case_rows import difference_of, environment_of, run_row
from hearth.datasets.format.home_inference import common, write_home
from hearth.datasets.format.row_conversion import bindings_of, change_of, condition_rows, graph_of, named, program_of
from hearth.grounding.environments.sampling import sample
from hearth.grounding.preconditions.conditions import Preconditions
from hearth.grounding.preconditions.precondition_inference import infer
from hearth.kb.action_sets import USUAL
from hearth.kb.knowledge import Knowledge
from hearth.pipelines.engine.build_homes import Homes
from hearth.pipelines.engine.settings import DERIVED, Settings
from hearth.pipelines.engine.stage import Job, Plan, Stage
from hearth.pipelines.engine.user_overlays import keep_homes, overlays, overlays_used
from hearth.schemas.failures import Failure
from hearth.schemas.program import Program
from hearth.schemas.rng import rng
from hearth.schemas.row_types import ConditionRow, DifferenceRow, GraphRow
from hearth.schemas.stage_rows import CaseRow, GroundingRow, RunRow, ValidatedRow
from hearth.schemas.tables import CASE
from hearth.simulation.engine import run
from hearth.simulation.rules import REPLAY, RULES, Rules, rules_of
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World
from hearth.storage.manifest import read_manifest
from hearth.storage.names import inside
from hearth.storage.partitions import read_rows
from hearth.storage.rejects import Reject

SHARED_BY = 32
"""Start graphs that are compared to derive a home of which only environments are stored."""


class Context(NamedTuple):
    """The resources for processing a record."""

    homes: Homes
    names: tuple[str, ...]
    seed: int
    each: int = 0


def process(record: ValidatedRow, context: Context) -> Iterator[CaseRow | Reject]:
    """One case for each stored start graph of a program, or else for each home."""
    stored = [(grounding, grounding["start"]) for grounding in record["groundings"] if grounding["start"]]
    if stored:
        return (_stored(record, grounding, start, context) for grounding, start in stored)
    program = program_of(record)
    known = context.homes.knowledge
    conditions = infer(program, known, rules_of(known))
    if isinstance(conditions, Failure):
        return iter([failed(conditions, program, record["place"], f"in {name}") for name in context.names[:1]])
    names = _chosen(record["program_id"], context)
    return _once([_sampled(record, program, conditions, name, context) for name in names])


def _chosen(program_id: str, context: Context) -> tuple[str, ...]:
    """Return all homes, or `each` of them drawn for the program, in the homes' order."""
    if not 0 < context.each < len(context.names):
        return context.names
    drawn = rng(context.seed, "homes", program_id).sample(context.names, context.each)
    return tuple(name for name in context.names if name in drawn)


def _once(outputs: list[CaseRow | Reject]) -> Iterator[CaseRow | Reject]:
    """Yield the outputs; if all of them fail, each code and line is reported once."""
    reported: set[tuple[str, int]] = set()
    fails = all(isinstance(output, Reject) for output in outputs)
    for output in outputs:
        if isinstance(output, Reject) and fails:
            fault = output.diagnostics[0]
            if (fault.code, fault.line) in reported:
                continue
            reported.add((fault.code, fault.line))
        yield output


def _sampled(
    record: ValidatedRow, program: Program, conditions: Preconditions, name: str, context: Context
) -> CaseRow | Reject:
    rules = rules_of(context.homes.knowledge)
    drawn = sample(program, context.homes.home(name), context.seed, record["program_id"], conditions, rules=rules)
    if isinstance(drawn, Failure):
        return failed(drawn, program, record["place"], f"in {name}")
    environment, execution = drawn
    differs = environment_of(environment, context.homes.edges(name))
    conditions = environment.conditions
    return _case(record, name, differs, condition_rows(conditions), run_row(execution), seed=context.seed)


def failed(failure: Failure, program: Program, place: str, where: str = "") -> Reject:
    """Return a reject for a program that does not run, at the line of the failing step."""
    steps = [number for number, tick in enumerate(program.ticks()) for _ in tick]
    step = steps.index(failure.tick) if failure.tick in steps else 0
    return Reject.failed(failure, place, program.line(step), where)


def _stored(record: ValidatedRow, grounding: GroundingRow, start: GraphRow, context: Context) -> CaseRow:
    """Return a case in the environment stored with the program, run by the release's rules."""
    name = grounding["home"]
    bound: ValidatedRow = {**record, "steps": grounding["steps"]}
    program = program_of(bound, bindings_of(grounding["bindings"]))
    world = World.start(Home.from_graph(graph_of(start), name, context.homes.knowledge))
    execution = run(world, program, RULES["replay"])
    reproduces = None
    if grounding["final"]:
        reproduces = execution.executable and execution.final.changes(world) == change_of(grounding["final"])
    differs = difference_of(world, context.homes.home(name), context.homes.edges(name))
    conditions = record["conditions"] or _inferred(program, context.homes.knowledge.of_set(USUAL), REPLAY)
    return _case(bound, name, differs, conditions, run_row(execution), reproduces=reproduces)


def _inferred(program: Program, knowledge: Knowledge, rules: Rules) -> list[ConditionRow]:
    found = infer(program.unbound(), knowledge, rules)
    return [] if isinstance(found, Failure) else condition_rows(found)


def _case(
    record: ValidatedRow,
    home: str,
    environment: DifferenceRow,
    conditions: list[ConditionRow],
    execution: RunRow,
    *,
    seed: int | None = None,
    reproduces: bool | None = None,
) -> CaseRow:
    environment_id = f"{record['program_id']}@{home}"
    return {
        **named(record),
        "parent_id": None,
        "steps": record["steps"],
        "warnings": record["warnings"],
        "environment_id": environment_id,
        "home": home,
        "seed": seed,
        "environment": environment,
        "conditions": conditions,
        "execution_id": f"{environment_id}/0",
        **execution,
        "reproduces": reproduces,
        "perturbations": [],
        "outcome": None,
        "repairs": [],
    }


def prepare(settings: Settings) -> Plan:
    """Return the homes to sample in, and the parts from which the other homes of stored start graphs are derived."""
    homes = Homes(settings)
    parts = {name: [digest for digest, _ in found] for name, found in _parts_by_home(settings, homes).items()}
    return {**overlays(settings), "homes": list(homes.names()), "derived": parts}


def _parts_by_home(settings: Settings, homes: Homes) -> dict[str, list[tuple[str, Path]]]:
    """Return for each home outside the catalog the first parts (digest, path) with enough start graphs of it."""
    manifest = read_manifest(settings.folder("validate"))
    assert manifest is not None
    found: dict[str, list[tuple[str, Path]]] = {}
    graphs: Counter[str] = Counter()
    for part in manifest.parts:
        (file,) = part["files"]
        column = pq.ParquetFile(manifest.folder / file).read(columns=["groundings.list.element.home"])["groundings"]
        here = Counter(grounding["home"] for row in column.to_pylist() for grounding in row or ())
        for name in sorted(here):
            if graphs[name] < SHARED_BY and not homes.in_catalog(name):
                entry = (manifest.content["files"][file]["sha256"], manifest.folder / file)
                found.setdefault(name, []).append(entry)
                graphs[name] += here[name]
    return found


def begin(job: Job) -> None:
    """Keep the user's homes, and write those that are derived from stored start graphs."""
    keep_homes(job)
    folder = job.folder / DERIVED
    folder.mkdir(exist_ok=True)
    derived = _parts_by_home(job.settings, Homes(job.settings))
    for stale in folder.iterdir():
        if stale.stem not in derived:
            stale.unlink()
    for name, parts in derived.items():
        write_home(inside(folder, f"{name}.json"), common(_starts(name, (path for _, path in parts))))


def _starts(name: str, parts: Iterable[Path]) -> Iterator[GraphRow]:
    count = 0
    for path in parts:
        for row in read_rows(path, ["groundings"]):
            for grounding in row["groundings"]:
                if grounding["home"] == name and grounding["start"] and count < SHARED_BY:
                    count += 1
                    yield grounding["start"]


def open_homes(job: Job) -> Context:
    """Homes, built when first used."""
    return Context(Homes(job.settings), tuple(job.plan["homes"]), job.settings.seed, job.settings.homes_each)


STAGE = Stage(
    name="sample",
    tables={"": CASE},
    process=process,
    reads=("validate",),
    settings=("seed", "homes_each", "action_set"),
    open=open_homes,
    prepare=prepare,
    facts=overlays_used,
    begin=begin,
    labels=lambda row: ("executable" if row["executable"] else "not executable",),
    share=64,
)
