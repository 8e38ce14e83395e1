"""Episodes as a dataset of LeRobot, format 3.0: one Parquet file of frames, with tasks, episodes and statistics.

A frame is a tick. `observation.state` has the poses of both agents, the things in their hands, and the time.
`observation.environment_state` has the places of all visible nodes. `action` is a triple of numbers.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray

from hearth.challenges.episode_arrays import EpisodeArrays, episodes_of
from hearth.challenges.result_files import Results
from hearth.envs.observation_arrays import Arrays
from hearth.kb.knowledge import Knowledge
from hearth.storage.names import inside

VERSION = "v3.0"

FPS = 1
"""A tick has no duration; it counts as a second."""

STATE = ("agents", "hands", "time")
ENVIRONMENT = ("places",)

VECTORS = ("observation.state", "observation.environment_state", "action")
NUMBERS = {
    "next.reward": "float32",
    "next.done": "bool",
    "timestamp": "float32",
    "frame_index": "int64",
    "episode_index": "int64",
    "index": "int64",
    "task_index": "int64",
}

FILE = "chunk-000/file-000.parquet"

Columns = dict[str, NDArray[Any]]


def lerobot(results: Results, out: Path, agent: int, knowledge: Knowledge, limit: int | None = None) -> int:
    """Write an agent's observations, actions and rewards, as `LeRobotDataset(NAME, root=FOLDER)` reads them.

    Return the number of episodes.

    Args:
        results: of a run.
        out: a new or empty folder.
        agent: 0 for the main agent, 1 for its helper.
        knowledge: of the homes.
        limit: the first episodes only.

    Raises:
        HearthError: those of `episode_arrays.arrays_of`.
    """
    tasks: dict[str, int] = {}
    frames: list[Columns] = []
    episodes: list[dict[str, Any]] = []
    begun = 0
    for number, (episode, _) in enumerate(episodes_of(results, agent, knowledge, limit)):
        task = tasks.setdefault(episode.goal, len(tasks))
        frames.append(_frames(episode, number, begun, task))
        ticks = len(episode.actions)
        episodes.append(_row(number, episode.goal, begun, ticks))
        begun += ticks
    columns = {name: np.concatenate([each[name] for each in frames]) for name in frames[0]} if frames else {}
    _write(inside(out, "data") / FILE, columns)
    _episodes(inside(out, "meta") / "episodes" / FILE, episodes)
    numbers = pd.DataFrame({"task_index": list(tasks.values())}, index=list(tasks))
    numbers.to_parquet(inside(out, "meta") / "tasks.parquet")
    _json(inside(out, "meta") / "info.json", _info(columns, len(episodes), len(tasks)))
    _json(inside(out, "meta") / "stats.json", {name: _statistics(values) for name, values in columns.items()})
    return len(episodes)


def _frames(episode: EpisodeArrays, number: int, begun: int, task: int) -> Columns:
    ticks = len(episode.actions)
    seen = episode.observations[:ticks]
    ends = np.arange(ticks) == ticks - 1
    return {
        "observation.state": np.stack([_flat(each, STATE) for each in seen]),
        "observation.environment_state": np.stack([_flat(each, ENVIRONMENT) for each in seen]),
        "action": episode.actions.astype(np.float32),
        "next.reward": episode.rewards,
        "next.done": ends,
        "timestamp": np.arange(ticks, dtype=np.float32) / FPS,
        "frame_index": np.arange(ticks),
        "episode_index": np.full(ticks, number),
        "index": begun + np.arange(ticks),
        "task_index": np.full(ticks, task),
    }


def _flat(arrays: Arrays, names: tuple[str, ...]) -> NDArray[np.float32]:
    return np.concatenate([arrays[name].ravel() for name in names]).astype(np.float32)


def _row(number: int, goal: str, begun: int, ticks: int) -> dict[str, Any]:
    files = {f"{part}/{kind}_index": 0 for part in ("data", "meta/episodes") for kind in ("chunk", "file")}
    span = {"dataset_from_index": begun, "dataset_to_index": begun + ticks}
    return {"episode_index": number, "tasks": [goal], "length": ticks, **files, **span}


def _write(path: Path, columns: Columns) -> None:
    """Write the frames; vectors are lists of one length."""
    path.parent.mkdir(parents=True, exist_ok=True)
    arrays = {}
    for name, values in columns.items():
        flat = pa.array(values.ravel())
        arrays[name] = pa.FixedSizeListArray.from_arrays(flat, values.shape[1]) if values.ndim > 1 else flat
    pq.write_table(pa.table(arrays), path)


def _episodes(path: Path, episodes: list[dict[str, Any]]) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    pq.write_table(pa.Table.from_pylist(episodes), path)


def _info(columns: Columns, episodes: int, tasks: int) -> dict[str, Any]:
    features = {
        name: {"dtype": NUMBERS.get(name, "float32"), "shape": list(values.shape[1:]) or [1], "names": None}
        for name, values in columns.items()
    }
    return {
        "codebase_version": VERSION,
        "robot_type": None,
        "total_episodes": episodes,
        "total_frames": len(columns["index"]) if columns else 0,
        "total_tasks": tasks,
        "chunks_size": 1000,
        "data_files_size_in_mb": 100,
        "video_files_size_in_mb": 200,
        "fps": FPS,
        "splits": {"train": f"0:{episodes}"},
        "data_path": "data/chunk-{chunk_index:03d}/file-{file_index:03d}.parquet",
        "video_path": None,
        "features": features,
    }


def _statistics(values: NDArray[Any]) -> dict[str, Any]:
    columns = values.astype(np.float64).reshape(len(values), -1)
    found = {name: getattr(columns, name)(axis=0).tolist() for name in ("min", "max", "mean", "std")}
    return {**found, "count": [len(values)]}


def _json(path: Path, document: dict[str, Any]) -> None:
    path.write_text(json.dumps(document, indent=2) + "\n", encoding="utf-8")
