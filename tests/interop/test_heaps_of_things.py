"""Files of things in heaps are refused before edges between all of them are made."""

from __future__ import annotations

import json
import random

import numpy as np
import pytest
from typer.testing import CliRunner

from hearth import cli
from hearth.homes.plans.home_shell import Thing
from hearth.homes.relations import CLOSE_WITHIN, _near, _swept, close, gaps, many_close
from hearth.interop.scene_graphs import completion
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.graph import Box


def boxes(count, wide, seed=1):
    drawn = random.Random(seed)
    spot = lambda: tuple(round(drawn.uniform(0, wide), 2) for _ in range(3))  # noqa: E731
    return [Box(spot(), tuple(drawn.choice((0.0, 0.2, 0.5, 3.0)) for _ in range(3))) for _ in range(count)]


@pytest.mark.parametrize(("count", "wide"), [(0, 1), (1, 1), (2, 1), (40, 1), (200, 6), (300, 30)])
def test_boxes_that_are_compared_side_by_side_have_the_pairs_of_all(count, wide):
    found = boxes(count, wide)
    if not found:
        assert list(_swept(found)) == []
        return
    assert sorted(map(tuple, _near(found).tolist())) == sorted(_swept(found))
    near = gaps(found, found) <= CLOSE_WITHIN + 1e-9
    assert np.count_nonzero(near) - count == len(list(_swept(found)))


def heap(count, wide):
    return [Thing(f"chair.{k}", "chair", "kitchen", box, 0.0, "floor") for k, box in enumerate(boxes(count, wide))]


def test_the_count_is_that_of_the_edges_and_ends_early():
    few = heap(60, 4)
    assert many_close(few, 10**9) == len(close(few))
    assert 100 < many_close(heap(5_000, 1), 100) < 20_000


def scene(path, count, wide):
    drawn = random.Random(1)
    spot = lambda: {"x": drawn.random() * wide, "y": drawn.random() * wide, "z": 0.5}  # noqa: E731
    size = {"x": 0.5, "y": 0.5, "z": 1}
    path.write_text(json.dumps({"objects": [
        {"uid": f"o{k}", "label": "chair", "room": "kitchen", "pose": {"position": spot()}, "dimensions": size}
        for k in range(count)]}))  # fmt: skip
    return path


@pytest.mark.parametrize("count", [500, 2_000])
def test_a_heap_is_refused_with_its_figures(tmp_path, count):
    words = ["home", "convert", str(scene(tmp_path / "s.json", count, 1.0)), str(tmp_path / "o.json"), "--fill"]
    result = CliRunner().invoke(cli.app, [*words, "--json"])
    (fault,) = json.loads(result.stdout)["errors"]
    assert fault["code"] == "FILE_TOO_LARGE" and f"{count:,} things" in fault["message"]
    assert "meters" in fault["suggestion"] and not (tmp_path / "o.json").exists()


def test_things_that_all_look_at_one_another_are_refused(monkeypatch):
    monkeypatch.setattr(completion, "MOST_LOOKS", 100)
    with pytest.raises(HearthError, match="FILE_TOO_LARGE"):
        completion._need_few_near(heap(12, 300), frozenset({"chair"}))
    completion._need_few_near(heap(12, 300), frozenset())
