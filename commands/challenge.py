"""`challenge`: tasks in which agents help a partner, runs of agents on them, and their scores."""

from pathlib import Path

import typer

from hearth.commands import (
    challenge_checks,
    challenge_eai,
    challenge_export,
    challenge_household,
    challenge_infer_and_people,
    challenge_learning,
    challenge_output,
    challenge_pictures,
    output,
)
from hearth.commands.challenge_film import film
from hearth.commands.shared_options import LanguageOptions

USUAL_SEEDS = 5
"""Episodes of each task of a table, where no number is given."""

app = typer.Typer(
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode=None,
    help="Help somebody at home: tasks of Watch-And-Help and Online Watch-And-Help, agents, and their scores.",
)


app.add_typer(challenge_eai.app, name="eai")


USUAL_SPLITS = {"owah": "test", "owah_consequences": "test", "owah_bodies": "test", "household": "valid_seen"}
"""The splits of `tasks` where none is named and there is no `test-1`."""


@app.command()
def tasks(
    name: str,
    split: str = "",
    *,
    out: Path | None = None,
    seed: int | None = None,
    limit: int | None = None,
    workers: int = 0,
    as_json: bool = False,
) -> None:
    """Write the tasks of a challenge: the published ones, or, with a seed, others of the same kind.

    Of `household`, also print instructions and goals; its splits are train, valid_seen, valid_unseen, valid_words,
    test_seen and test_unseen, and a few hundred tasks take a minute.

    \b
    Examples:
      hearth challenge tasks wah --split test-1 --out test-1.json
      hearth challenge tasks wah --split train --seed 7 --limit 20 --out mine.json
      hearth challenge tasks household --split train --limit 5
    """
    split = split or USUAL_SPLITS.get(name, "test-1")
    if name == challenge_household.HOUSEHOLD:
        challenge_household.print_tasks(split, out, seed or 0, limit, workers, as_json)
        return
    from hearth.challenges.published_tasks import PUBLISHED
    from hearth.challenges.task_files import suite, write

    found = suite(name, split, PUBLISHED if seed is None else seed, limit)
    if out is not None:
        write(out, found)
    homes = sorted({task.home for task in found.tasks})
    document = {
        "challenge": name,
        "split": split,
        "tasks": len(found.tasks),
        "goals": len({task.goal for task in found.tasks}),
        "homes": ", ".join(homes),
        "digest": found.digest,
        "out": out,
    }
    if as_json:
        output.emit(document)
    else:
        output.figures(document)


@app.command("run")
def run_tasks(
    file: Path,
    main: str = "human_like",
    helper: str = "none",
    goal: str = "",
    seeds: int = 1,
    *,
    out: Path,
    seconds: float = 30.0,
    proposals: str = "",
    workers: int = 0,
    engine: str = "local",
    scheduler: str = "",
    models: LanguageOptions = LanguageOptions(),
    images: bool = False,
    as_json: bool = False,
) -> None:
    """Let an agent do tasks alone and with a helper, and write all that they did.

    The agent that acts (--main) is one of ours, your own as FILE.py:CLASS, or the command of a program that reads and
    writes lines (docs/examples/agents.md). A run that was stopped goes on where it was; episodes in which an agent
    could not go on are no scores: they are played once more, counted apart, and the status is 1. Helpers: none, random,
    hp, hp_true, hp_timed, hp_random, oracle_b, oracle_ab, ..., or an agent of your own, as FILE.py:CLASS. Either may be
    a language model, llm:MODEL@URL (docs/language-models.md); its replies are kept in --cache.

    \b
    Examples:
      hearth challenge run test-1.json --main "node agent.js" --out node.jsonl
      hearth challenge run test-1.json --helper hp --goal true --seeds 5 --out hp.jsonl
      hearth challenge run test-1.json --main mine.py:Agent --helper mine.py:Helper --out mine.jsonl --json
      hearth challenge run tasks.json --main llm:MODEL@URL --prices 0.15,0.60 --budget 2 --out model.jsonl -j 16
      hearth challenge run owah.json --helper llm:smollm2 --llm memory=4 --out helped.jsonl
      hearth challenge run owah.json --helper nopa --proposals gpn --engine dask --scheduler tcp://a:8786 --out n.jsonl
    """
    from hearth.challenges.episode_agents import Lineup
    from hearth.challenges.language_agents import need_models, spending
    from hearth.challenges.parallel_episodes import spread_over
    from hearth.challenges.suite_runs import run
    from hearth.challenges.task_files import read
    from hearth.commands.progress_line import bar
    from hearth.kb.loading.load import default

    suite = read(file)
    helper = f"{helper}_{proposals}" if proposals not in ("", "exact") else helper
    asking, means = models.settings(out, (main, helper), *(["images"] if images else ()))
    lineup = Lineup(main, helper, goal, seconds, asking, means)
    need_models(lineup.names, engine, given=models.given or images)
    with (
        bar("episodes", lambda: spending(lineup.names, asking, means)) as seen,
        spread_over(engine, workers, scheduler) as over,
    ):
        found = run(suite, lineup, seeds, out, default, workers, seen, over=over)
    challenge_output.print_results(found, as_json)
    challenge_output.note_requests(lineup)
    output.status(len(found.unfinished), strict=True)


@app.command()
def score(results: Path, *, as_json: bool = False) -> None:
    """Print the metrics of a run: means over tasks with standard errors.

    \b
    Example:
      hearth challenge score hp.jsonl --json
    """
    from hearth.challenges.verification import read_whole

    found = read_whole(results)
    challenge_output.print_results(found, as_json)
    output.status(len(found.unfinished), strict=True)


@app.command()
def build(
    name: str,
    results: list[Path] | None = None,
    *,
    out: Path,
    limit: int | None = None,
    rate: float = 1.0,
    workers: int = 0,
    as_json: bool = False,
) -> None:
    """Publish all tasks of a challenge and their demonstrations, and the episodes of runs, as tables for `query`.

    Of `household`, the demonstrations are what experts did; with runs and without --limit, the tasks are those of the
    runs, because all 12,500 take hours to draw.

    \b
    Examples:
      hearth challenge build wah --out data_out/wah
      hearth challenge build wah hp.jsonl random.jsonl --out data_out/wah
      hearth challenge build household mine.jsonl --out data_out/household
      hearth query data_out/wah "SELECT helper, avg(length) FROM episodes GROUP BY helper"
    """
    from hearth.challenges.challenge_dataset import publish
    from hearth.challenges.verification import read_whole
    from hearth.commands.progress_line import bar
    from hearth.kb.loading.load import default

    runs = [read_whole(path) for path in results or ()]
    with bar("demonstrations") as seen:
        counts = publish(out, name, default, runs, limit, rate, workers, seen)
    if as_json:
        output.emit({"out": out, **counts})
    else:
        output.figures({"out": out, **counts})


for _before in (
    challenge_learning.watch,
    challenge_learning.learn,
    challenge_learning.curves,
    challenge_pictures.stats,
    film,
    challenge_pictures.show,
):
    app.command()(_before)


@app.command()
def table(
    name: str,
    split: str = "",
    seeds: int | None = None,
    *,
    out: Path,
    particles: bool = False,
    by_set: bool = False,
    limit: int | None = None,
    workers: int = 0,
    as_json: bool = False,
) -> None:
    """Run all methods of the thesis's figure 6-5 or 7-3 on the same tasks, and print and draw them next to its text.

    Results in the folder are kept. Intervals are of 95 %; t, p and effect compare lengths with those of the main agent
    alone, task by task. Of `household`, the reference agents do the first ten tasks of each split (--limit), and the
    rows are by split and family.

    \b
    Examples:
      hearth challenge table wah --out data_out/challenges/wah
      hearth challenge table owah --seeds 3 --out data_out/challenges/owah
      hearth challenge table owah --seeds 3 --out data_out/challenges/owah --by-set     (figure 7-6a)
      hearth challenge table owah --seeds 3 --out data_out/challenges/owah --particles  (figure C-5)
      hearth challenge table household --out data_out/challenges/household
    """
    if name == challenge_household.HOUSEHOLD:
        challenge_household.print_table(split, seeds or 1, out, limit, workers, as_json)
        return
    from hearth.analysis.challenge_table import TABLES, figure, methods, rows
    from hearth.challenges.task_files import suite
    from hearth.commands.challenge_infer_and_people import print_by_set
    from hearth.commands.progress_line import bar
    from hearth.kb.loading.load import default
    from hearth.storage.names import inside

    which = f"{name}-particles" if particles else name
    chosen = suite(name, split or TABLES.get(which, {}).get("split", ""), limit=limit)
    with bar("episodes") as seen:
        found = rows(list(methods(chosen, seeds or USUAL_SEEDS, out, default, workers, lambda _: seen, which)))
    inside(out, f"figure-{TABLES[which]['figure']}.svg").write_text(figure(found), encoding="utf-8")
    if as_json:
        output.emit(found)
        return
    if by_set:
        print_by_set(found)
        return
    shown = ("success", "speedup", "saving", "reward", "conflict_episodes", "needless_episodes")
    cells = [
        [
            row["method"],
            *(f"{row[each]:.2f} ± {row[f'{each}_ci']:.2f}" if each in row else "" for each in shown),
            *(row.get(each) for each in ("t", "p", "effect", "thesis")),
        ]
        for row in found
    ]
    output.table(("method", *(each.replace("_", " ") for each in shown), "t", "p", "effect", "thesis"), cells)


for _command in (
    challenge_checks.verify,
    challenge_checks.board,
    challenge_checks.solvable,
    challenge_export.export,
    challenge_infer_and_people.infer,
    challenge_infer_and_people.people,
):
    app.command()(_command)
