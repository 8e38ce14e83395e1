"""`home try`: for each scene graph its names, boxes, faults, and the programs that run there."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from hearth.commands import inputs, output

if TYPE_CHECKING:
    from hearth.analysis.home_trials import HomeTrial

HEADS = ("home", "nodes bound", "boxes used", "laid out", "in each other", "faults", "programs run")


def try_out(
    files: list[Path], programs: int = 10, seed: int = 0, source: list[Path] | None = None, as_json: bool = False
) -> None:
    """Try scene graphs out: names that are known, boxes that are used, faults, and programs of the corpus that run.

    FILES are scene graphs of VirtualHome, or tasks of Watch-And-Help, O-WAH and C-WAH, as JSON or as the published
    pickles; of a file of tasks each home is tried once. Programs are drawn from those whose things the home has. The
    status is 1 if a name is unknown, furniture stands in other furniture, or a program does not run.

    \b
    Example:
      hearth home try TrimmedTestScene1_graph.json test_env_set_help.pik
    """
    from dataclasses import asdict

    from hearth.analysis.home_trials import drawn, tried
    from hearth.interop.virtualhome.task_graphs import task_graphs

    known = inputs.read_knowledge(None)
    chosen = drawn(inputs.paths(source), known, seed)
    trials = [tried(graph, name, chosen, programs, known, seed)
              for file in files for name, graph in task_graphs(file, known)]  # fmt: skip
    if as_json:
        output.emit([asdict(trial) for trial in trials])
    else:
        output.table(HEADS, [trial.row() for trial in trials])
        for trial in trials:
            _details(trial)
    output.status(sum(len(t.unknown) + len(t.in_each_other) + t.programs - t.ran for t in trials), strict=True)


def _details(trial: HomeTrial) -> None:
    for words in (*trial.in_each_other, *(f"unknown class `{name}`" for name in trial.unknown)):
        output.line(f"{trial.home}: {words}")
    for code, count in trial.failures.items():
        output.line(f"{trial.home}: {output.counted(count, 'program')} failed: {code}")
