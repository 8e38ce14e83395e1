"""Episodes for Minari and LeRobot: read by Minari itself, and as LeRobot's format 3.0 has them."""

from __future__ import annotations

import json

import numpy as np
import pandas as pd
import pyarrow.parquet as pq
import pytest

from hearth.challenges.episode_agents import Lineup
from hearth.challenges.episode_arrays import episodes_of
from hearth.challenges.suite_runs import run
from hearth.challenges.task_files import suite
from hearth.interop.episode_export import FORMATS, export
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    folder = tmp_path_factory.mktemp("run")
    return run(suite("owah", "train-small", 5, 2), Lineup(helper="nopa"), 1, folder / "nopa.jsonl", default)


@pytest.fixture(scope="module")
def episodes(results):
    return [episode for episode, _ in episodes_of(results, 1, default())]


def test_arrays_have_one_observation_more_than_ticks(results, episodes):
    lengths = [record.metrics["ticks"] for record in results.records if record.helped]
    assert [len(each.actions) for each in episodes] == lengths
    assert all(len(each.observations) == len(each.actions) + 1 == len(each.rewards) + 1 for each in episodes)
    assert episodes[0].rewards[-1] > 0.9 and episodes[0].success
    waited = [texts[1] is None for texts in next(r for r in results.records if r.helped).actions]
    assert [not any(triple) for triple in episodes[0].actions.tolist()] == waited


def test_who_was_not_told_the_goal_does_not_see_it(results, episodes):
    assert not any(each["goal"].any() for each in episodes[0].observations)
    main = next(episodes_of(results, 0, default()))[0]
    assert main.observations[0]["goal"].any()


def test_minari_reads_what_was_written(results, episodes, tmp_path):
    library = pytest.importorskip("minari")
    assert export(results, "minari", tmp_path / "out", 1, default()) == len(episodes)
    found = library.MinariDataset(tmp_path / "out")
    assert found.total_episodes == len(episodes) and found.total_steps == sum(len(e.actions) for e in episodes)
    for one, episode in zip(found.iterate_episodes(), episodes, strict=True):
        assert np.array_equal(one.actions, episode.actions) and np.allclose(one.rewards, episode.rewards)
        assert found.observation_space.keys() == one.observations.keys()
        for name, values in one.observations.items():
            assert np.array_equal(values, np.stack([each[name] for each in episode.observations]))
        assert one.terminations.tolist() == [False] * (len(one.actions) - 1) + [True] and not one.truncations.any()


def test_lerobot_has_frames_tasks_episodes_and_statistics(results, episodes, tmp_path):
    assert export(results, "lerobot", tmp_path / "out", 1, default()) == len(episodes)
    frames = pq.read_table(tmp_path / "out/data/chunk-000/file-000.parquet").to_pandas()
    info = json.loads((tmp_path / "out/meta/info.json").read_text())
    rows = pq.read_table(tmp_path / "out/meta/episodes/chunk-000/file-000.parquet").to_pylist()
    tasks = pd.read_parquet(tmp_path / "out/meta/tasks.parquet")
    assert (info["codebase_version"], info["total_episodes"]) == ("v3.0", len(episodes))
    assert set(frames) == set(info["features"]) and len(frames) == info["total_frames"]
    for row, episode in zip(rows, episodes, strict=True):
        part = frames[row["dataset_from_index"] : row["dataset_to_index"]]
        assert np.array_equal(np.stack(part["action"]), episode.actions)
        assert part["next.done"].tolist() == [False] * (len(part) - 1) + [True]
        assert tasks.index[part["task_index"].iloc[0]] == row["tasks"][0] == episode.goal
    assert frames["index"].tolist() == list(range(len(frames)))
    for name, feature in info["features"].items():
        assert np.stack(frames[name]).reshape(len(frames), -1).shape[1] == feature["shape"][0]
    stats = json.loads((tmp_path / "out/meta/stats.json").read_text())
    assert stats["next.reward"]["max"] == [pytest.approx(frames["next.reward"].max())]


def test_an_unknown_form_and_a_full_folder_are_refused(results, tmp_path):
    with pytest.raises(HearthError) as raised:
        export(results, "rlds", tmp_path / "out", 1, default())
    assert raised.value.diagnostics[0].code is Code.UNSUPPORTED_FILE
    (tmp_path / "file").write_text("")
    for form in FORMATS:
        with pytest.raises(HearthError) as raised:
            export(results, form, tmp_path, 1, default())
        assert raised.value.diagnostics[0].code is Code.UNWRITABLE
    with pytest.raises(HearthError):
        list(episodes_of(results, 2, default()))
