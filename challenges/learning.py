"""Training of the learned parts of helpers, and the resulting checkpoints."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from hearth.challenges.episodes import Known
from hearth.models.interface import Training
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.parallel import Seen, unseen

PROPOSALS = {"proposals": "train", "proposals-small": "train-small"}
"""The split that goal proposals are learned from, by subject of training."""

GOALS = {"goals": "things", "goals-moments": "moments"}
"""The shape of the network that infers goals, by subject of training."""

WHAT = (*GOALS, "subgoals", "actions", *PROPOSALS)
"""The subjects of training."""

PASSES = 12
"""Over the demonstrations, where goals are learnt."""


def train(
    name: str,
    what: str,
    out: Path,
    known: Known,
    seed: int = 0,
    limit: int | None = None,
    rate: float = 1.0,
    epochs: int | None = None,
    workers: int = 1,
    seen: Seen = unseen,
    trained: Seen = unseen,
) -> Mapping[str, Any]:
    """Train, and write a checkpoint; how it was trained. One that was stopped is continued.

    Args:
        name: of the challenge.
        what: the subject, one of `WHAT`.
        out: the checkpoint's folder.
        known: gives the knowledge.
        seed: of all that is drawn.
        limit: the first demonstrations, or tasks, only.
        rate: of habits in demonstrations of goals (see `demonstration_episodes.Wish`).
        epochs: passes over demonstrations, or epochs of practice; as they come where None.
        workers: processes that play episodes.
        seen, trained: report progress: episodes and epochs done.

    Raises:
        HearthError: BAD_ARGUMENT: nothing of that name is learnt; MISSING_FILE: the extra `models` is not installed.
    """
    import shutil

    from hearth.models.checkpoint import save
    from hearth.models.fit_model import STATE

    if what not in WHAT:
        raise HearthError.of(Code.BAD_ARGUMENT, f"nobody learns `{what[:40]}`", suggestion=", ".join(WHAT))
    found: Any
    if what in GOALS:
        from hearth.challenges import learning_to_watch

        how = Training(seed=seed, epochs=epochs or PASSES, patience=0, folder=out / STATE)
        found = learning_to_watch.learn(name, known, how, limit, rate, workers, seen, trained, GOALS[what])
    elif what in PROPOSALS:
        from hearth.challenges import learning_to_propose

        how = Training(seed, epochs or 300, rate=learning_to_propose.RATE, patience=0, halve_after=0,
                       folder=out / STATE)  # fmt: skip
        found = learning_to_propose.learn(name, PROPOSALS[what], known, how, limit, workers, seen, trained)
    else:
        from hearth.challenges import learning_to_help

        effort = learning_to_help.EFFORTS[what]
        effort = effort if epochs is None else replace(effort, epochs=epochs)
        how = Training(seed=seed, folder=out / STATE)
        found = learning_to_help.learn(name, what, known, how, effort, limit, workers, seen, trained)
    save(found.checkpoint(), out)
    shutil.rmtree(out / STATE, ignore_errors=True)
    facts: Mapping[str, Any] = found.facts
    return facts
