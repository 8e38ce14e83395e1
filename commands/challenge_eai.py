"""`challenge eai`: the Embodied Agent Interface from its wheels: the table of its models, an audit, our planner."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import typer

from hearth.commands import inputs, output
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

app = typer.Typer(
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode=None,
    help="The Embodied Agent Interface from its wheels: the table of its models, an audit of its goals and verdicts.",
)

SHOWN = ("model", "ability", "measure", "published", "theirs", "ours")


@app.command()
def table(
    wheel: Path,
    models: list[str] | None = None,
    abilities: list[str] | None = None,
    planner: bool = False,
    every: bool = False,
    as_json: bool = False,
) -> None:
    """Print each model's figures from its stored answers: published, by the interface's rules, and by ours.

    A figure by the interface's rules is to lie within a point of the published one. The last lines count them, and name
    those that differ; of subgoals they list the tasks that the interface decides by chance. All fifteen models take
    some minutes. With --planner, Fast Downward plans with each model's operators, which takes a minute or more for each
    model and needs the extra `plan`.

    Get the wheel by `pip download --no-deps virtualhome-eval==0.1.1`.

    \b
    Examples:
      hearth challenge eai table virtualhome_eval-0.1.1-py3-none-any.whl
      hearth challenge eai table virtualhome_eval-0.1.1-py3-none-any.whl --model GPT-4o --ability action_sequencing
    """
    from hearth.interop.eai.model_table import SOURCE
    from hearth.interop.eai.model_table import table as figures
    from hearth.interop.eai.operator_planning import OperatorPlanning
    from hearth.interop.eai.wheel import ABILITIES, Wheel
    from hearth.kb.loading.load import default

    for name in abilities or ():
        if name not in ABILITIES:
            raise typer.BadParameter(f"one of {', '.join(ABILITIES)}", param_hint="--ability")
    read = Wheel(wheel)
    planning = OperatorPlanning(read) if planner else None
    rows = list(figures(read, default(), models or (), abilities or (), planning))
    compared = [row for row in rows if row["agrees"] is not None]
    near = sum(row["agrees"] for row in compared)
    if as_json:
        output.emit({"source": SOURCE, "compared": len(compared), "within_a_point": near, "rows": rows})
        return
    shown = [row for row in rows if every or row["published"] is not None]
    output.table(SHOWN, [["" if row[name] is None else row[name] for name in SHOWN] for row in shown])
    output.line(f"{near} of {len(compared)} figures by the interface's rules lie within a point of the published ones.")
    output.line(f"Published: {SOURCE}.")
    for row in compared:
        if not row["agrees"]:
            output.line(_difference(row))


@app.command()
def audit(
    wheel: Path, models: list[str] | None = None, every: bool = False, out: Path | None = None, as_json: bool = False
) -> None:
    """Count goals and verdicts of the interface that are wrong, and print a program that proves each kind.

    Verdicts are those on the stored answers of the models that are named. With --out all of them go into a page of
    Markdown, each with its proof.

    \b
    Examples:
      hearth challenge eai audit virtualhome_eval-0.1.1-py3-none-any.whl
      hearth challenge eai audit virtualhome_eval-0.1.1-py3-none-any.whl --model mistral-large-2402 --out audit.md
    """
    from hearth.interop.eai.audit import Finding, page_of, wrong_goals, wrong_verdicts
    from hearth.interop.eai.wheel import Wheel
    from hearth.kb.loading.load import default

    read, known = Wheel(wheel), default()
    found: list[Finding] = list(wrong_goals(read, known))
    for model in models or ():
        if model not in read.models("action_sequencing"):
            listed = ", ".join(read.models("action_sequencing")) or "none, as the wheel has no answers"
            raise typer.BadParameter(f"models are {listed}", param_hint="--model")
        found += wrong_verdicts(read, known, model)
    if out is not None:
        from hearth.storage.chosen_files import write

        out.parent.mkdir(parents=True, exist_ok=True)
        write(out, page_of(found).encode())
    if as_json:
        output.emit([finding._asdict() for finding in found])
        return
    kinds: dict[tuple[str, str], list[Finding]] = {}
    for finding in found:
        kinds.setdefault(("goal" if finding.model in ("", "gold") else "verdict", finding.kind), []).append(finding)
    output.table(("of a", "wrong", "number"), [(*kind, len(those)) for kind, those in kinds.items()])
    for (_, kind), those in kinds.items():
        for finding in those if every else those[:1]:
            _say(kind, finding)


@app.command()
def plan(wheel: Path, limit: int | None = None, out: Path | None = None, as_json: bool = False) -> None:
    """Plan for each goal of the interface, run the plans, and print how many run and reach their goal.

    \b
    Examples:
      hearth challenge eai plan virtualhome_eval-0.1.1-py3-none-any.whl
      hearth challenge eai plan virtualhome_eval-0.1.1-py3-none-any.whl --limit 20 --out plans.json
    """
    import time

    from hearth.interop.eai.goal_planner import GoalPlanner
    from hearth.interop.eai.task_worlds import task_world
    from hearth.interop.eai.wheel import Wheel
    from hearth.kb.loading.load import default
    from hearth.schemas.syntax import print_lines

    read, known = Wheel(wheel), default()
    numbers = [number for number, task in read.tasks.items() if not task.empty][:limit]
    rows, seconds = [], 0.0
    for number in numbers:
        there = task_world(read, number, known)
        began = time.perf_counter()
        program, reached = GoalPlanner(there, known).plan()
        seconds += time.perf_counter() - began
        rows.append({"task": number, "reached": reached, "executed": bool(program.steps),
                     "plan": list(print_lines(program))})  # fmt: skip
    success, executed = (sum(bool(row[name]) for row in rows) for name in ("reached", "executed"))
    found: dict[str, Any] = {"tasks": len(rows), "reach_their_goal": success, "run": executed,
             "seconds_a_task": round(seconds / max(len(rows), 1), 3),
             "without_a_plan": [row["task"] for row in rows if not row["reached"]]}  # fmt: skip
    if out is not None:
        output.write(out, rows)
    if as_json:
        output.emit(found)
    else:
        output.figures({**found, "without_a_plan": ", ".join(found["without_a_plan"]) or "none"})


@app.command()
def tasks(count: int = 500, seed: int = 0, *, out: Path, as_json: bool = False) -> None:
    """Write the interface's four tasks for our own homes and programs, with prompts and their fingerprints.

    Each goal is what a program of the corpus changes in a home; the engine proves that it does not hold before and
    holds after. 500 tasks take some minutes.

    \b
    Example:
      hearth challenge eai tasks --count 20 --out own.json
    """
    from collections import Counter

    from hearth.analysis.random_program_home_pairs import pairs
    from hearth.interop.eai.own_tasks import own_task
    from hearth.kb.loading.load import default

    found: dict[str, dict[str, Any]] = {}
    tried = 0
    for execution, home, _ in pairs(inputs.paths([]), default(), seed):
        tried += 1
        task = own_task(execution, home, seed)
        if task is not None:
            found.setdefault(task["id"], task)
        if len(found) >= count:
            break
    output.write(out, list(found.values()))
    homes = Counter(task["home"] for task in found.values())
    listed = ", ".join(f"{name} {number}" for name, number in sorted(homes.items()))
    figures = {"tasks": len(found), "programs_that_ran": tried, "prompts": 4 * len(found), "homes": listed, "out": out}
    if as_json:
        output.emit(figures)
    else:
        output.figures(figures)


@app.command()
def score(file: Path, answers: Path, as_json: bool = False) -> None:
    """Score a model's answers to our own tasks: goals, subgoals, plans and operators.

    ANSWERS has a line of JSON for each answer: {"id": TASK, "ability": NAME, "answer": TEXT}. Goals are scored by
    precision, recall and F1 of their facts, and operators by those of their predicates. Plans are run. Subgoals are
    brought about one after the other. Answers to other tasks or abilities are counted.

    \b
    Example:
      hearth challenge eai score own.json answers.jsonl
    """
    import orjson

    from hearth.interop.eai.own_scores import OwnScores
    from hearth.kb.loading.load import default
    from hearth.storage.input_files import read_input

    try:
        tasks_by_id = {task["id"]: task for task in orjson.loads(read_input(file))}
        rows = [orjson.loads(line) for line in read_input(answers).splitlines() if line.strip()]
        asked = [(tasks_by_id.get(row.get("id")), row) for row in rows]
    except (ValueError, TypeError, KeyError, AttributeError) as error:
        message = f"these are not tasks of `challenge eai tasks`, or not answers to them: {str(error)[:100]}"
        raise HearthError.of(Code.BAD_JSON, message, file=str(file)) from error
    scores = OwnScores()
    for task, row in asked:
        scores.add(task, str(row.get("ability", "")), str(row.get("answer", "")), default())
    if as_json:
        output.emit(scores.figures())
    else:
        output.figures(scores.figures())


def _difference(row: dict[str, Any]) -> str:
    """Return a line about a figure that is not the published one: both, and the tasks that chance decides."""
    said = f"differs: {row['model']}, {row['measure']}: {row['published']} published, {row['theirs']} here"
    if not row.get("by_chance"):
        return said
    why = f"the interface chooses among the parts of `or` by chance, which gives {row['low']} to {row['high']}"
    return f"{said}; {why}; it decides the tasks {', '.join(row['by_chance'])}"


def _say(kind: str, finding: Any) -> None:
    output.line(f"\n{kind}: task {finding.task}, {finding.title}")
    output.line(f"  goal: {finding.goal or 'nothing'}")
    for step in finding.program:
        output.line(f"  {step}")
