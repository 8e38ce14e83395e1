"""`challenge film`: an episode as a film."""

from pathlib import Path

from hearth.commands import output
from hearth.rendering.film.film_rate import FILM_RATE


def film(
    results: Path,
    task: str,
    episode: int = 0,
    *,
    out: Path,
    alone: bool = False,
    view: str = "auto",
    width: int = 320,
    fps: float = FILM_RATE,
    as_json: bool = False,
) -> None:
    """Film an episode of a task, of agents or of people, with a page that plays it step by step.

    \b
    Examples:
      hearth challenge film hp.jsonl wah-test-1-0003 --out film
      hearth challenge film episode.jsonl wah-test-1-0003 --view first --out film
    """
    from hearth.analysis.episode_figure import episode_of, ticks_of
    from hearth.challenges.episode_executions import execution_of
    from hearth.challenges.verification import read_whole
    from hearth.homes.library import load_graph
    from hearth.kb.loading.load import default
    from hearth.rendering.film.execution_keyframes import trajectory_of
    from hearth.rendering.film.player import page
    from hearth.rendering.film.video import record as filmed

    known, found = default(), read_whole(results)
    one, record = episode_of(found, str(results), task, episode, alone)
    start, ticks = ticks_of(one, record, known)
    home = load_graph(one.home, known)
    trajectory = trajectory_of(execution_of(start, ticks, task), home, known)
    out.mkdir(parents=True, exist_ok=True)
    done = filmed(trajectory, home, out, view, size=(width, width * 3 // 4), fps=fps)
    files = [path.name for path in done.files]
    (out / "index.html").write_text(page(f"{task}: {one.goal}", files, done.steps), encoding="utf-8")
    document = {
        "task": task,
        "ticks": len(ticks),
        "frames": done.frames,
        "files": files,
        "page": str(out / "index.html"),
    }
    output.say(f"{done.frames} pictures of {len(ticks)} ticks; open {document['page']}", document, as_json)
