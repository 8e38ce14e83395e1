"""Every published task of testing is played by the socket, verifies when it is done again, and can be filmed."""

from __future__ import annotations

import pytest
from web.playing import Player, alone, begun

from hearth.analysis.episode_figure import ticks_of
from hearth.challenges.episode_executions import execution_of
from hearth.challenges.published_tasks import tasks
from hearth.challenges.result_files import read
from hearth.challenges.verification import verify
from hearth.homes.library import load_graph
from hearth.kb.loading.load import default
from hearth.rendering.film.execution_keyframes import keyframes


@pytest.mark.slow
def test_all_tasks_are_played_by_the_socket(server, person, tmp_path):
    reached = []
    for task in tasks("wah", "test-1"):
        game = begun(server, person, task)
        with Player(person, game) as player:
            for act, text in alone(task):
                assert player.patient_act(text)["type"] == "tick", f"{task.id}: {act}"
        file = tmp_path / f"{task.id}.jsonl"
        file.write_bytes(person.get(f"/play/game/{game}/episode.jsonl").content)
        found = read(file)
        assert verify(found, task.id, default) == []
        reached.append(next(iter(found.records)).metrics["success"])
        start, ticks = ticks_of(task, next(iter(found.records)), default())
        assert len(execution_of(start, ticks, task.id).worlds) == len(ticks) + 1, "a film has a picture of each tick"
    assert len(reached) == 100
    assert sum(reached) >= 95, "people see what the agent sees, and the agent reaches nearly all"


def test_an_episode_is_filmed_step_by_step(server, person, tmp_path):
    task = tasks("wah", "test-1", limit=1)[0]
    game = begun(server, person, task, "hp_true")
    with Player(person, game) as player:
        for act in ("[Turnleft]", None, "[Turnright]"):
            player.act(act)
        player.ask({"type": "finish"})
    file = tmp_path / "episode.jsonl"
    file.write_bytes(person.get(f"/play/game/{game}/episode.jsonl").content)
    start, ticks = ticks_of(task, next(iter(read(file).records)), default())
    execution = execution_of(start, ticks, task.id)
    assert len(execution.worlds) == 4
    assert [len(steps) for steps in execution.program.ticks()] == [2, 1, 2], "in the second tick only the helper acts"
    shown = list(keyframes(execution, load_graph(task.home, default()), default()))
    assert len(shown) == 4 and len(shown[0].actors) == 2
    assert shown[1].actors[0].yaw != shown[0].actors[0].yaw
