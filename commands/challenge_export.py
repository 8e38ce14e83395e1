"""`challenge export`: episodes in the forms that libraries of learning read."""

from pathlib import Path

from hearth.commands import output


def export(
    results: Path,
    form: str = "minari",
    agent: int = 1,
    *,
    out: Path,
    limit: int | None = None,
    as_json: bool = False,
) -> None:
    """Write the episodes of a run for others: arrays for Minari or LeRobot, or chats for fine-tuning.

    Arrays are an agent's observations, actions and rewards in each tick. Chats (`messages`) are OUT/messages.jsonl: a
    line is an episode, with observations of hearth-text/1 as `user` and commands as `assistant`. They are of episodes
    without a helper; of a file of tasks, an expert does each task first.

    \b
    Examples:
      hearth challenge export hp.jsonl --format minari --out hp-minari
      hearth challenge export hp.jsonl --format lerobot --agent 0 --limit 50 --out alice
      hearth challenge export mine.jsonl --format messages --out chats
      hearth challenge export tasks.json --format messages --out expert-chats
    """
    from hearth.challenges.verification import read_whole
    from hearth.interop.episode_export import MESSAGES
    from hearth.interop.episode_export import export as written
    from hearth.kb.loading.load import default

    if form == MESSAGES:
        _chats(results, out, limit, as_json)
        return
    count = written(read_whole(results), form, out, agent, default(), limit)
    document = {"out": out, "format": form, "agent": agent, "episodes": count}
    output.emit(document) if as_json else output.figures(document)


def _chats(source: Path, out: Path, limit: int | None, as_json: bool) -> None:
    """Write chats, and print how many, and why others were left out."""
    from hearth.challenges.result_files import is_results
    from hearth.challenges.task_files import read
    from hearth.challenges.verification import read_whole
    from hearth.interop.episode_export import MESSAGES, export_messages
    from hearth.kb.loading.load import default

    found = read_whole(source) if is_results(source) else read(source)
    done = export_messages(found, out, default(), limit)
    figures = {"out": out, "format": MESSAGES, "episodes": done.episodes, "by_tick": done.by_tick}
    if as_json:
        output.emit({**figures, "left_out": dict(done.left_out)})
        return
    output.figures(figures)
    for reason, number in done.left_out.most_common():
        output.line(f"left out: {output.counted(number, 'episode')}: {reason}")
