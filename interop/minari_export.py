"""Episodes as a dataset of Minari (Farama): observations T + 1, actions, rewards, terminations, truncations."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from hearth.challenges.episode_arrays import EpisodeArrays, episodes_of
from hearth.challenges.result_files import Results
from hearth.kb.knowledge import Knowledge
from hearth.schemas.optional_libraries import library
from hearth.version import DISTRIBUTION, VERSION


def minari(results: Results, out: Path, agent: int, knowledge: Knowledge, limit: int | None = None) -> int:
    """Write an agent's observations, actions and rewards, as `minari.MinariDataset(FOLDER)` reads them.

    Return the number of episodes.

    Args:
        results: of a run.
        out: a new or empty folder.
        agent: 0 for the main agent, 1 for its helper.
        knowledge: of the homes.
        limit: the first episodes only.

    Raises:
        HearthError: MISSING_FILE: Minari is not installed; those of `episode_arrays.arrays_of`.
    """
    storages, buffers = library("minari.dataset.minari_storage"), library("minari.data_collector.episode_buffer")
    storage, count = None, 0
    for episode, session in episodes_of(results, agent, knowledge, limit):
        if storage is None:
            observed = library("gymnasium.spaces").Dict(session.encoder.spaces())
            storage = storages.MinariStorage.new(out, observed, session.action_space(), data_format="hdf5")
        storage.update_episodes([_buffer(buffers.EpisodeBuffer, episode, count)])
        count += 1
    if storage is not None:
        header = results.header
        about = f"{header.suite.challenge} {header.suite.split}: {header.lineup.helper} helps {header.lineup.main}"
        storage.update_metadata(
            {
                "dataset_id": f"hearth/{header.suite.challenge}-{header.lineup.helper.replace(':', '-')}-v0",
                "minari_version": library("minari").__version__,
                "algorithm_name": header.lineup.helper if agent else header.lineup.main,
                "description": about,
                "requirements": [f"{DISTRIBUTION}=={VERSION}"],
            }
        )
    return count


def _buffer(kind: type, episode: EpisodeArrays, number: int) -> object:
    ticks = len(episode.actions)
    ends = np.arange(ticks) == ticks - 1
    stacked = {name: np.stack([each[name] for each in episode.observations]) for name in episode.observations[0]}
    return kind(
        id=number,
        seed=episode.seed,
        options={"task": episode.task},
        observations=stacked,
        actions=episode.actions,
        rewards=episode.rewards.tolist(),
        terminations=(ends & episode.success).tolist(),
        truncations=(ends & (not episode.success)).tolist(),
    )
