"""Attacks by results of helpers that infer goals: what they believed is followed, printed and drawn."""

from __future__ import annotations

import json
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

from attack import Attack, Ground
from attacks_on_challenges import BAD, _filled, _read, _resigned, _signed, _with

from hearth.challenges import result_files
from hearth.challenges import task_files as files
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError


@cache
def watched() -> tuple[dict[str, Any], dict[str, Any]]:
    """A file of results with the first ticks of an episode, in which a helper infers the goal."""
    from dataclasses import replace

    from hearth.challenges.episode_agents import Lineup
    from hearth.challenges.episodes import Job, played

    suite = files.suite("owah", "test", limit=1)
    lineup = Lineup("human_like", "nopa", "none")
    header = result_files.Header(suite, lineup, 1, episodes=((suite.tasks[0].id, 0, True),))
    record = played(Job(suite.tasks[0], 0, lineup, True, None, default))
    record = replace(record, actions=record.actions[:2], end={"code": "TIMED_OUT", "agent": 0})
    first, second = result_files.first_line(header), result_files.line(header, record)
    return json.loads(first), json.loads(second)


def believed(path: Path) -> Any:
    """Return the helper's beliefs, as they are printed and drawn."""
    from hearth.analysis.episode_figure import episode_of, narrated, ticks_of
    from hearth.analysis.goal_belief_figure import drawn
    from hearth.analysis.online_inference import calibration
    from hearth.challenges.helper_beliefs import beliefs

    found = result_files.read(path)
    task = found.header.suite.tasks[0].id
    one, record = episode_of(found, str(path), task, 0, alone=False)
    actions = list(narrated(ticks_of(one, record, default())[1]))
    seen = beliefs(one, record, found.header.lineup.helper, default())
    picture = drawn(seen, actions)
    assert "<script" not in picture and "\x1b" not in picture
    return picture, calibration([seen])


def belief_results() -> Iterator[Attack]:
    """Results whose digests fit, with other tasks, goals, helpers and actions."""
    first, second = watched()
    task = ("suite", "tasks", 0)
    goals: tuple[Any, ...] = ({"ON(plate, kitchentable)": 1}, {"INSIDE(cup, fridge)": 9}, {"ON(plate, stove)": 0}, {})
    yield Attack("beliefs", "as it is", lambda ground: _whole(ground, first, second))
    changes: list[tuple[str, dict[str, Any], dict[str, Any]]] = []
    for helper in ("none", "human_like", "expected_time", "nopa\x1b[2J", "os:system", "same_goal"):
        changes.append((f"helper {helper!a}", _with(first, ("agents", "helper"), helper), second))
    for place in ("goal", "home", "sets", "seed"):
        for bad in (*(goals if place == "goal" else ()), "maple", ["x"], 7, *BAD[:6]):
            changes.append((f"{place} = {bad!r:.30}", _with(first, (*task, place), bad), second))
    for actions in ([], [[]], [[None, None]], [[None]], [[None] * 9], [["[Sleep]", "[Sleep]"]], [["x\x1b[2J", None]]):
        changes.append((f"actions {actions!r:.30}", first, _with(second, ("actions",), actions)))
    for goal in (None, {}, {"ON(plate, kitchentable)": 1}, {"x": []}):
        changes.append((f"asked for {goal!r:.30}", first, _with(second, ("helper_goal",), goal)))
    for name, head, episode in changes:
        yield Attack("beliefs", name, lambda ground, h=head, e=episode: _followed(ground, h, e))


def _whole(ground: Ground, first: dict[str, Any], second: dict[str, Any]) -> None:
    """Check that the results are read and drawn as long as nothing is changed."""
    try:
        assert "polyline" in _followed(ground, first, second)[0]
    except HearthError as error:
        raise AssertionError(str(error)) from error


def _followed(ground: Ground, first: dict[str, Any], second: dict[str, Any]) -> Any:
    head = {**first, "suite": _signed(first["suite"])}
    lines = _resigned(head, second)
    return _read(believed, "\n".join(json.dumps(_filled(each, ground)) for each in lines), ground)
