"""Stage 2: checks programs by the action grammar: syntax, names, arity and affordances."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from typing import NamedTuple

from hearth.datasets.format.row_conversion import binding_rows, graph_of, named, step_rows, warning_row
from hearth.grounding.binding import bind_stored
from hearth.kb import action_grammar
from hearth.kb.knowledge import Knowledge
from hearth.kb.language.numbered_steps import parse_steps
from hearth.kb.language.reading_modes import Fuzzy
from hearth.pipelines.checks import free_text_steps, meaning_checks
from hearth.pipelines.engine.build_context import keep_knowledge, knowledge, knowledge_laid_over, knowledge_used
from hearth.pipelines.engine.stage import Stage
from hearth.pipelines.readers import natural_language_plans, reader_warnings
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code, Failure
from hearth.schemas.program import Program
from hearth.schemas.stage_rows import GroundingRow, IngestedRow, ValidatedRow, WrittenGroundingRow
from hearth.schemas.syntax import parse_program
from hearth.schemas.tables import VALIDATED
from hearth.schemas.text_places import TextPlaces
from hearth.simulation.rules import REPLAY
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World
from hearth.storage.rejects import Reject

FUZZY = "fuzzy"
"""The label of a step that was corrected or shortened; a row is counted once for each."""

Check = Callable[[str, int, str, Knowledge], tuple[Program, tuple[Diagnostic, ...], tuple[Diagnostic, ...]]]
"""`checked`, or `checked_natural_language`."""


class Reading(NamedTuple):
    """The settings of a check: the knowledge, and the allowed distance of plans' steps from known sentences."""

    known: Knowledge
    fuzzy: Fuzzy = Fuzzy.TYPOS
    strict: bool = False


def process(record: IngestedRow, known: Knowledge) -> list[ValidatedRow | Reject]:
    """Check one program, as `process_as` does by default."""
    return process_as(record, Reading(known))


def process_as(record: IngestedRow, reading: Reading) -> list[ValidatedRow | Reject]:
    """Check one program and each of its groundings; a faulty grounding is refused alone."""
    known = reading.known
    natural = partial(checked_natural_language, fuzzy=reading.fuzzy, strict=reading.strict)
    check = natural if record["origin"] == natural_language_plans.NAME else checked
    places = TextPlaces(record["line"] or 0, record["places"] or ())
    program, faults, warnings = check(record["text"] or "", 0, record["place"], known)
    faults, warnings = (tuple(map(places.placed, found)) for found in (faults, warnings))
    program = replace(program, lines=tuple(map(places.line, program.lines)))
    if faults:
        return [Reject(faults)]
    outcomes = [_grounding(grounding, record["place"], known, check) for grounding in record["groundings"] or ()]
    groundings = [outcome for outcome in outcomes if not isinstance(outcome, Reject)]
    titled = replace(
        program, title=record["title"] or program.title, description=record["description"] or program.description
    )
    start = meaning_checks.met_at_start(program, groundings, record["conditions"] or (), known)
    found = [*meaning_checks.findings(titled, known), *meaning_checks.undeclared(titled, record, known), *start]
    read = reader_warnings.diagnostics(record["warnings"], record["place"])
    warnings = (*read, *warnings, *(meaning_checks.diagnostic(each, titled, record["place"]) for each in found))
    row: ValidatedRow = {
        **named(record),
        "title": titled.title,
        "description": titled.description,
        "steps": step_rows(program),
        "groundings": groundings,
        "conditions": record["conditions"],
        "warnings": [warning_row(fault) for fault in warnings],
    }
    return [row, *(outcome for outcome in outcomes if isinstance(outcome, Reject))]


def checked(
    text: str, before: int, place: str, known: Knowledge
) -> tuple[Program, tuple[Diagnostic, ...], tuple[Diagnostic, ...]]:
    """Return a program in canonical names, its faults, and its warnings.

    Args:
        text: the program as written.
        before: lines of the file before it.
        place: the file, for diagnostics.
        known: the grammar.
    """
    expanded = free_text_steps.expand(text, before)
    source = expanded.text.split("\n")
    written, faults = parse_program(expanded.text, place)
    program, wrong = action_grammar.check(written.numbered(), known, place, source)
    faults = (*faults, *wrong)
    if not faults:
        faults = action_grammar.affordances(program, known, place, source)
    if not faults:
        faults = tuple(
            meaning_checks.diagnostic(each, program, place, source)
            for each in meaning_checks.contradictions(program, known)
        )
    faults = tuple(sorted((expanded.placed(fault) for fault in faults), key=lambda f: (f.line, f.column)))
    lines = tuple(expanded.original(line) for line in program.lines)
    program = replace(program, lines=lines)
    if faults:
        return program, faults, ()
    unexecuted = (
        meaning_checks.diagnostic(each, program, place) for each in meaning_checks.never_executed(program, known)
    )
    return program, (), (*_replaced(expanded, place), *unexecuted)


def _replaced(expanded: free_text_steps.Expanded, place: str) -> Iterator[Diagnostic]:
    for line, text in expanded.replaced:
        message = "a special block, replaced by the steps that the special-blocks file gives for it"
        yield Diagnostic(Code.SPECIAL_BLOCK, message, place, line, found=text[:200])


def checked_natural_language(
    text: str, before: int, place: str, known: Knowledge, fuzzy: Fuzzy = Fuzzy.TYPOS, *, strict: bool = False
) -> tuple[Program, tuple[Diagnostic, ...], tuple[Diagnostic, ...]]:
    """`checked` for natural-language steps; a fuzzy match is a warning, or with `strict` a fault."""
    parse = parse_steps(text, before, place, known, fuzzy)
    faults = (
        parse.faults or (parse.warnings if strict else ()) or action_grammar.affordances(parse.program, known, place)
    )
    if faults:
        return parse.program, faults, ()
    # Natural language loses instances: two lamps may look like one switched on twice, so this is only a warning.
    found = (*meaning_checks.never_executed(parse.program, known), *meaning_checks.contradictions(parse.program, known))
    return (
        parse.program,
        (),
        (*parse.warnings, *(meaning_checks.diagnostic(each, parse.program, place) for each in found)),
    )


def _grounding(grounding: WrittenGroundingRow, place: str, known: Knowledge, check: Check) -> GroundingRow | Reject:
    program, faults, _ = check(grounding["text"], 0, f"{place} in {grounding['home']}", known)
    unbound = [ref for ref in program.objects() if ref.node is None]
    if grounding["start"] and unbound and not faults:
        try:
            home = Home.from_graph(graph_of(grounding["start"]), grounding["home"], known)
            found = bind_stored(program, World.start(home), REPLAY)
        except HearthError as error:
            return Reject.because(error.diagnostics, place)
        if isinstance(found, Failure):
            return Reject.failed(found, place, where=f"in {grounding['home']}")
        program = found.apply(program)
    unbound = [ref for ref in program.objects() if ref.node is None]
    if not faults and unbound:
        message = f"`{unbound[0].name}` ({unbound[0].instance}) is not bound to a node"
        faults = (Diagnostic(Code.UNBOUND, message, place, suggestion="write (1.319) for node 319"),)
    if faults:
        return Reject(faults)
    return {
        "home": grounding["home"],
        "steps": step_rows(program),
        "bindings": binding_rows(program),
        "start": grounding["start"],
        "final": grounding["final"],
    }


STAGE = Stage(
    name="validate",
    tables={"": VALIDATED},
    process=process_as,
    reads=("ingest",),
    settings=("fuzzy", "strict", "action_set"),
    open=lambda job: Reading(knowledge(job.settings), Fuzzy(job.settings.fuzzy), job.settings.strict),
    prepare=knowledge_laid_over,
    begin=keep_knowledge,
    labels=lambda row: [FUZZY for each in row["warnings"] if each["code"] == Code.FUZZY_MATCH],
    facts=knowledge_used,
    # Descriptions without a program go on to `publish` as they are.
    select=lambda record, plan: bool(record["kind"] == "program"),
)
