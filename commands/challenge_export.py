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
    """Write an agent's observations, actions and rewards in each tick of a run, for Minari or LeRobot.

    \b
    Examples:
      hearth challenge export hp.jsonl --format minari --out hp-minari
      hearth challenge export hp.jsonl --format lerobot --agent 0 --limit 50 --out alice
    """
    from hearth.challenges.verification import read_whole
    from hearth.interop.episode_export import export as written
    from hearth.kb.loading.load import default

    count = written(read_whole(results), form, out, agent, default(), limit)
    document = {"out": out, "format": form, "agent": agent, "episodes": count}
    output.emit(document) if as_json else output.figures(document)
