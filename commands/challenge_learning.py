"""`challenge watch | learn | curves`: goals read from demonstrations, and training of the learned parts of helpers."""

from pathlib import Path

from hearth.commands import output


def watch(
    file: Path,
    source: str = "actions",
    *,
    model: str | None = None,
    rate: float = 1.0,
    workers: int = 0,
    as_json: bool = False,
) -> None:
    """Infer the goals of tasks from their demonstrations, and print precision and recall of predicates with counts.

    \b
    Examples:
      hearth challenge watch test-1.json --from states
      hearth challenge watch test-1.json --from last-frame
      hearth challenge watch test-1.json --rate 0   (clean demonstrations)
    """
    from hearth.agents.demonstration_goals import agreement
    from hearth.challenges.metrics import mean
    from hearth.challenges.task_files import read
    from hearth.challenges.watch_stage import inferred
    from hearth.commands.progress_line import bar
    from hearth.kb.loading.load import default

    suite = read(file)
    with bar("demonstrations") as seen:
        found = list(inferred(suite.tasks, source, default, rate, workers, seen, model))
    each = [agreement(goal, task.goal) for goal, task in zip(found, suite.tasks, strict=True)]
    precision, recall = mean([one.precision for one in each]), mean([one.recall for one in each])
    exact = sum(dict(goal) == dict(task.goal) for goal, task in zip(found, suite.tasks, strict=True))
    figures = {
        "source": source,
        "rate": rate,
        "tasks": len(found),
        "precision": precision.value,
        "precision_se": precision.error,
        "recall": recall.value,
        "recall_se": recall.error,
        "exact": exact / len(found),
    }
    if as_json:
        output.emit(figures)
    else:
        output.figures(figures)


def learn(
    name: str,
    what: str = "goals",
    *,
    out: Path,
    limit: int | None = None,
    rate: float = 1.0,
    epochs: int | None = None,
    seed: int = 0,
    workers: int = 0,
    as_json: bool = False,
) -> None:
    """Train a learned part of helpers, and write a checkpoint: goals, policies or proposals.

    `goals` infers goals from the states of demonstrations, `goals-moments` by the thesis's network. `subgoals` is
    Hybrid's policy and `actions` HRL's second: both imitate the planner on tasks of training, and go on by A2C.

    \b
    Examples:
      hearth challenge learn wah --out build/goal-inference
      hearth challenge watch test-1.json --from states --model build/goal-inference
      hearth challenge learn wah --what subgoals --limit 430 --out build/helping-subgoals
      hearth challenge learn owah --what proposals-small --out build/goal-proposals-small
    """
    from hearth.challenges.household_definition import need_two_agents
    from hearth.challenges.learning import train
    from hearth.commands.progress_line import bar
    from hearth.kb.loading.load import default

    with bar("episodes") as seen, bar("epochs") as passed:
        need_two_agents(name)
        facts = train(name, what, out, default, seed, limit, rate, epochs, workers, seen, passed)
    shown = {"out": out, **{key: value for key, value in facts.items() if not isinstance(value, dict)}}
    if as_json:
        output.emit(shown)
    else:
        output.figures(shown)


def curves(checkpoints: list[Path], *, out: Path, as_json: bool = False) -> None:
    """Draw how trainings went, one line for each checkpoint: seeds of one model belong together.

    \b
    Example:
      hearth challenge curves build/subgoals-0 build/subgoals-1 build/subgoals-2 --out curves.svg
    """
    from hearth.analysis.training_curves import drawn, runs
    from hearth.storage.chosen_files import write

    found = runs(checkpoints)
    write(out, drawn(found).encode())
    rows = [run.row() for run in found]
    if as_json:
        output.emit(rows)
    else:
        output.records(rows)
