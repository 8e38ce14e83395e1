"""Episodes over processes of this machine, or over a dask cluster; either gives the same records in the same order."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager, nullcontext
from typing import Any

from hearth.challenges.agent_descendants import none_left
from hearth.challenges.behavior_counts import Columns
from hearth.challenges.challenge_definition import challenge
from hearth.challenges.episode_agents import is_own
from hearth.challenges.episodes import Job, Record, played, start_of
from hearth.challenges.metrics import outcome
from hearth.llm.timed_connections import asking
from hearth.pipelines.engine.dask_engine import DaskEngine
from hearth.pipelines.engine.engines import engine as made
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.simulation.world.digest import digest
from hearth.storage.parallel import spread

Spread = Callable[[Sequence[Job]], Iterator[Record]]
"""Plays jobs and yields their records in order."""


def here(workers: int) -> Spread:
    """Over processes of this machine; an episode whose process dies is played alone, and ends with a code if it dies
    again.

    Episodes with a class of others are never played in this process, which the class could end.
    """

    def results(jobs: Sequence[Job]) -> Iterator[Record]:
        if jobs and jobs[0].lineup.language and not jobs[0].lineup.own:
            yield from _in_threads(jobs, workers)
            return
        apart = any(job.lineup.own for job in jobs)
        with none_left() if apart else nullcontext():
            yield from _over_processes(jobs, workers, apart)

    return results


def _over_processes(jobs: Sequence[Job], workers: int, apart: bool) -> Iterator[Record]:
    done = 0
    while done < len(jobs):
        try:
            for record in spread(played, jobs[done:], workers, apart=apart):
                yield record
                done += 1
        except BrokenProcessPool:
            yield _alone(jobs[done])
            done += 1
        except HearthError:
            raise
        except Exception:
            if not apart:
                raise
            yield _alone(jobs[done])  # in a process that another episode has not changed
            done += 1


def _in_threads(jobs: Sequence[Job], workers: int) -> Iterator[Record]:
    """Play episodes of language models in threads, which mostly wait: they share a cache, a budget and connections."""
    rest = deque(jobs)
    with ThreadPoolExecutor(workers) as pool, asking(pool):
        waiting = deque(pool.submit(played, rest.popleft()) for _ in range(min(2 * workers, len(rest))))
        while waiting:
            record = waiting.popleft().result()
            if rest:
                waiting.append(pool.submit(played, rest.popleft()))
            yield record


@contextmanager
def spread_over(engine: str, workers: int = 1, scheduler: str = "") -> Iterator[Spread]:
    """Yield where episodes are played; a cluster that is started for them ends with them.

    Args:
        engine: `local` or `dask`.
        workers: processes.
        scheduler: address of a running cluster, for `dask`.

    Raises:
        HearthError: those of `pipelines.engine.engines.engine`; MISSING_FILE: dask lacks, or does not answer.
    """
    chosen = made(engine, workers, scheduler)
    if not isinstance(chosen, DaskEngine):
        yield here(workers)
        return
    with chosen:
        yield on_cluster(chosen.client)


def on_cluster(client: Any) -> Spread:
    """Over the workers of a dask cluster, which must have Hearth and the same extras; an episode that kills several of
    them ends with a code.

    Args:
        client: of the cluster (`pipelines.engine.dask_engine.DaskEngine.client`).
    """

    def results(jobs: Sequence[Job]) -> Iterator[Record]:
        from distributed.scheduler import KilledWorker

        futures = client.map(played, jobs, pure=False)
        for job, future in zip(jobs, futures, strict=True):
            try:
                yield future.result()
            except KilledWorker:
                yield _ended(job)

    return results


def _alone(job: Job) -> Record:
    try:
        (record,) = spread(played, [job], 1, apart=True)
    except BrokenProcessPool:
        return _ended(job)
    except HearthError:
        raise
    except Exception as error:
        if not job.lineup.own:
            raise
        return _ended(job, f"its process, which it shares with us, failed by {type(error).__name__}")
    return record


def _ended(job: Job, message: str = "its process ended") -> Record:
    """Return the record of an episode whose process ends."""
    which, knowledge = challenge(job.task.challenge), job.known()
    number = 0 if is_own(job.lineup.main) or not job.helped else 1
    end = {"agent": number, "code": str(Code.AGENT_FAILED), "message": message}
    goal = None if job.helper_goal is None else which.grammar.written(job.helper_goal)
    start = start_of(job.task, knowledge, None if job.helped else 1)
    metrics = outcome(which, False, 0, Columns()).as_json()
    return Record(job.task.id, job.seed, job.helped, goal, (), digest(start), metrics, end)
