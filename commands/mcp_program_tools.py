"""The tools of an MCP server about programs and knowledge: plain texts in, documents of declared fields out."""

from __future__ import annotations

from typing import Any

import orjson
from typing_extensions import TypedDict

from hearth.challenges.text_episode import checked_seed, home_named, home_opening
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code, Failure
from hearth.schemas.program import Program

MOST_PROGRAM = 20_000
"""Characters of a program."""

MOST_STEPS = 100
"""Steps of a program."""

MOST_PLAN = 250
"""Ticks of a plan."""


class Fault(TypedDict):
    """A fault of a line, or of a word in it."""

    line: int
    code: str
    message: str
    remedy: str


class CheckResult(TypedDict):
    """The steps that were understood, and the faults of the others."""

    valid: bool
    steps: list[str]
    faults: list[Fault]
    warnings: list[Fault]


class RunResult(TypedDict):
    """A run in a home: whether all steps could be done, the failure of the first that could not, and all changes."""

    home: str
    executable: bool
    steps: list[str]
    failure: dict[str, Any] | None
    changes: list[dict[str, Any]]


class RepairResult(TypedDict):
    """The repairs of a program whose preconditions were perturbed."""

    home: str
    seed: int
    goal: list[str]
    pairs: list[dict[str, Any]]


class PlanResult(TypedDict):
    """Commands that reach a goal, found with sight of the whole home."""

    home: str
    goal: str
    reached: bool
    ticks: int
    commands: list[str]


class KnowledgeResult(TypedDict):
    """Facts about an object or an action."""

    kind: str
    facts: dict[str, Any]


def check(program: str) -> CheckResult:
    """Return the faults of a program."""
    found, faults, warnings = _read(program)
    return CheckResult(
        valid=bool(found.steps) and not faults,
        steps=_lines(found),
        faults=[_fault(each) for each in faults],
        warnings=[_fault(each) for each in warnings],
    )


def run(program: str, home: str, seed: int) -> RunResult:
    """Return the run of a program in a home as it is.

    Raises:
        HearthError: UNKNOWN_HOME; the faults of the program.
    """
    from hearth.commands.run_output import Outcome, document
    from hearth.grounding.grounded_run import as_given_or_sampled
    from hearth.simulation.rules import DEFAULT

    found, place = _whole(program), home_named(home)
    trial, _ = as_given_or_sampled(found, place, checked_seed(seed), False, DEFAULT)
    whole = _plain(document(Outcome(found, place, trial), False))
    return RunResult(
        home=home,
        executable=whole["executable"],
        steps=whole["steps"],
        failure=whole["failure"],
        changes=whole["changes"],
    )


def repair(program: str, home: str, seed: int) -> RepairResult:
    """Return the repairs of a program in a perturbed home.

    Raises:
        HearthError: UNKNOWN_HOME; the faults of the program; PRECONDITIONS that no start of the home meets.
    """
    from hearth.commands.repair import repairs_document
    from hearth.repair.augmentation import Options, augment
    from hearth.schemas.failure_words import in_program

    found, place = _whole(program), home_named(home)
    made = augment(found, place, checked_seed(seed), found.title, Options(1))
    if isinstance(made, Failure):
        message = f"the program does not run in {home}: {in_program(made, found)}"
        raise HearthError.of(made.code, message, suggestion="see `run` for the step")
    whole = _plain(repairs_document(made))
    return RepairResult(home=home, seed=seed, goal=whole["goal"], pairs=whole["pairs"])


def plan(home: str, goal: str, seed: int) -> PlanResult:
    """Return the commands of an agent that sees the whole home.

    Raises:
        HearthError: UNKNOWN_HOME, BAD_ARGUMENT, the faults of a goal's text.
    """
    from hearth.envs.text_homes import TextHome

    world = TextHome(home_opening(home, goal), expert=True, limit=MOST_PLAN)
    _, info = world.reset(checked_seed(seed))
    commands: list[str] = []
    while not info["won"] and info["ticks"] < MOST_PLAN:
        commands.append(info["expert"])
        _, _, terminated, truncated, info = world.step(commands[-1])
        if terminated or truncated:
            break
    return PlanResult(home=home, goal=goal, reached=info["won"], ticks=info["ticks"], commands=commands)


def knowledge(name: str) -> KnowledgeResult:
    """Return the facts about an object or an action.

    Raises:
        HearthError: UNKNOWN_ID with similar names.
    """
    from hearth.kb.tools.find import unknown
    from hearth.kb.tools.show import about_action, about_object

    known = default()
    thing, action = known.object_class(name[:100]), known.action(name[:100])
    if thing is not None:
        return KnowledgeResult(kind="object", facts=_plain(about_object(known, thing)))
    if action is not None:
        return KnowledgeResult(kind="action", facts=_plain(about_action(known, action)))
    raise HearthError(unknown(known, name[:100], "object"))


def _whole(text: str) -> Program:
    """Return a program without faults.

    Raises:
        HearthError: its faults.
    """
    found, faults, _ = _read(text)
    if faults or not found.steps:
        raise HearthError(faults or [Diagnostic(Code.EMPTY, "no steps", suggestion="[Walk] <kitchen> (1)")])
    return found


def _read(text: str) -> tuple[Program, list[Diagnostic], list[Diagnostic]]:
    """Return a program in any form of text, its faults and its warnings.

    Raises:
        HearthError: FILE_TOO_LARGE.
    """
    from hearth.kb.action_grammar import check as grammar
    from hearth.kb.language.program_lines import is_plan
    from hearth.pipelines.readers.plans_in_words import parse_steps
    from hearth.schemas.syntax import parse_program

    if len(text) > MOST_PROGRAM:
        raise HearthError.of(Code.FILE_TOO_LARGE, f"a program of more than {MOST_PROGRAM:,} characters")
    lines = text.split("\n")
    if is_plan(lines):
        plan = parse_steps(text)
        found, faults, warnings = plan.program, list(plan.faults), list(plan.warnings)
    else:
        parsed, wrong = parse_program(text)
        found, more = grammar(parsed, default(), source=lines)
        faults, warnings = [*wrong, *more], []
    if len(found.steps) > MOST_STEPS:
        raise HearthError.of(Code.FILE_TOO_LARGE, f"a program of more than {MOST_STEPS} steps")
    return found, faults, warnings


def _lines(program: Program) -> list[str]:
    from hearth.schemas.syntax import print_step

    return [print_step(step) for step in program.steps]


def _fault(found: Diagnostic) -> Fault:
    return Fault(line=found.line, code=str(found.code), message=found.message, remedy=found.suggestion)


def _plain(value: Any) -> Any:
    """Return a document in values that JSON has."""
    return orjson.loads(orjson.dumps(value, default=str, option=orjson.OPT_NON_STR_KEYS | orjson.OPT_SERIALIZE_NUMPY))
