"""`challenge stats | show`: the starts of tasks, and the actions of an episode, printed and drawn."""

from pathlib import Path

from hearth.commands import challenge_infer_and_people, output


def stats(file: Path, *, out: Path | None = None, as_json: bool = False) -> None:
    """Print where things and agents are when tasks start, and draw it as the thesis's figures B-4 and B-5.

    \b
    Example:
      hearth challenge stats test-1.json --out figures
    """
    from hearth.analysis.object_distribution import heat_map
    from hearth.analysis.start_place_distributions import starts
    from hearth.challenges.task_files import read
    from hearth.kb.loading.load import default
    from hearth.storage.names import inside

    found = starts(read(file), default())
    if out is not None:
        out.mkdir(parents=True, exist_ok=True)
        for name, counts, title in (
            ("starts", found.everything, "Where all things are (figure B-4)"),
            ("wanted", found.wanted, "Where wanted things are (figure B-5)"),
        ):
            some = {kind: each for kind, each in counts.items() if each.total()}
            inside(out, f"{name}.svg").write_text(heat_map(some, title), encoding="utf-8")
    if as_json:
        output.emit(found._asdict())
        return
    for kind, places in found.everything.items():
        shown = ", ".join(f"{place} {number / places.total():.0%}" for place, number in places.most_common(6))
        mean = sum(number * tasks for number, tasks in found.numbers[kind].items()) / found.numbers[kind].total()
        output.line(f"{kind:12} {mean:.2f} a task: {shown}")
    rooms = ", ".join(f"{room} {number / found.agents.total():.0%}" for room, number in found.agents.most_common())
    output.line(f"agents start in {rooms}")


def show(
    results: Path,
    task: str,
    episode: int = 0,
    *,
    alone: bool = False,
    belief: bool = False,
    out: Path | None = None,
    goal_beliefs: Path | None = None,
    as_json: bool = False,
) -> None:
    """Show the agents' actions in an episode.

    Draw their ways on the floor plan as in the thesis's figure 6-6, and the helper's beliefs about the goal as in
    figure 7-4.

    An episode with a helper is drawn next to that of the main agent alone. With --belief the drawing shows the places
    where the main agent believes wanted things to be, over time (figure B-3).

    \b
    Examples:
      hearth challenge show nopa.jsonl owah-test-0003 --goal-beliefs beliefs.svg
      hearth challenge show hp.jsonl wah-test-1-0003 --out figure.png
      hearth challenge show hp.jsonl wah-test-1-0003 --belief --out belief.svg
    """
    from hearth.analysis import location_belief_figure
    from hearth.analysis.episode_figure import episode_of, furniture, narrated, panels_of, ticks_of
    from hearth.challenges.verification import read_whole
    from hearth.homes import side_by_side_floor_plans
    from hearth.homes.library import load_layout
    from hearth.kb.loading.load import default
    from hearth.storage.chosen_files import write

    found, known = read_whole(results), default()
    one, record = episode_of(found, str(results), task, episode, alone)
    start, ticks = ticks_of(one, record, known)
    if belief:
        beliefs = location_belief_figure.followed(one, start, ticks)
        if out is not None:
            write(out, location_belief_figure.drawn(beliefs).encode())
        output.emit(beliefs) if as_json else output.records([each.row() for each in beliefs])
        return
    if out is not None:
        panels = panels_of(found, one, record, known)
        side_by_side_floor_plans.write(load_layout(one.home, known), out, panels, furniture(one, start))
    if goal_beliefs is not None:
        challenge_infer_and_people.draw_beliefs(
            goal_beliefs, one, record, found.header.lineup.helper, list(narrated(ticks))
        )
    rows = [dict(zip(("tick", "agent", "instruction", "failure"), row, strict=True)) for row in narrated(ticks)]
    if as_json:
        output.emit({"task": task, "home": one.home, "goal": str(one.goal), **record.metrics, "instructions": rows})
        return
    output.line(f"{task} in {one.home}: {one.goal}\n")
    output.records(rows)
    reached = "reached" if record.metrics["success"] else "not reached"
    output.line(f"\n{reached} after {record.metrics['ticks']} ticks")
