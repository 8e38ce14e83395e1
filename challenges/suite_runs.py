"""Runs of a suite over processes: resumable, with the same bytes for any number of workers."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from hearth.challenges.episode_agents import NOBODY, Lineup
from hearth.challenges.episodes import Job, Known, Record
from hearth.challenges.parallel_episodes import Spread, here
from hearth.challenges.result_files import Header, Results, first_line, line, read, read_records
from hearth.challenges.task_files import Suite
from hearth.challenges.tasks import Task
from hearth.challenges.watch_stage import inferred
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.goals import Goal
from hearth.schemas.rng import rng
from hearth.storage.chosen_files import followed
from hearth.storage.files import TEMPORARY, commit, need_replaceable
from hearth.storage.input_files import read_lines
from hearth.storage.lock import locked_file
from hearth.storage.parallel import Seen, unseen

INFERRED = {"inferred": "actions", "inferred_states": "states"}
"""The method that reads the demonstration, by the helper's kind of goal (see `agents.demonstration_goals`)."""


def run(
    suite: Suite,
    lineup: Lineup,
    seeds: int,
    out: Path,
    known: Known,
    workers: int = 1,
    seen: Seen = unseen,
    alone: Results | None = None,
    over: Spread | None = None,
) -> Results:
    """Play every task several times, without the helper and with it, and write all that was done.

    The episodes that a stopped run had written are kept; the same call continues from there. Episodes in which an agent
    could not go on are played again by the same call. A user's own agent whose file has changed is another agent: all
    is played anew.

    Args:
        suite: the tasks.
        lineup: the agents that take part.
        seeds: episodes of each task.
        out: the file of results.
        known: gives the knowledge.
        workers: processes.
        seen: called with the number of episodes done.
        alone: results of the same main agent on the same tasks, whose episodes without a helper are taken.
        over: where episodes are played; over the processes of this machine where None.

    Raises:
        HearthError: BAD_ARGUMENT: there are no such agents, or too few tasks for a random goal; UNWRITABLE; LOCKED:
            another run writes the file.
    """
    header = Header(suite, _with_room(suite, lineup.checked()), seeds, code=lineup.code, language=lineup.language)
    out = followed(out) if out.is_symlink() else out
    need_replaceable(out)
    with locked_file(out, "playing episodes"):
        return _played(header, out, known, workers, seen, alone, over or here(workers))


def _played(
    header: Header, out: Path, known: Known, workers: int, seen: Seen, alone: Results | None, over: Spread
) -> Results:
    """Play what the file of results lacks."""
    suite, lineup = header.suite, header.lineup
    before: dict[tuple[str, int, bool], Record] = {}
    if out.exists() and next(read_lines(out), b"") == first_line(header):
        found = read(out)
        if not any(each.end for each in found.records):
            return found
        before = {(each.task, each.seed, each.helped): each for each in found.records if each.end is None}
    partial = out.with_name(f".{out.name}.run{TEMPORARY}")
    kept = _kept(header, partial)
    jobs = _jobs(header, known, workers)[kept:]
    finished = dict(before)
    same = alone is not None and (alone.header.suite, alone.header.lineup.main) == (suite, lineup.main)
    if same and alone:
        finished |= {(each.task, each.seed, False): each for each in alone.records if not each.helped}
    with partial.open("ab") as file:
        if not kept:
            file.truncate(0)
            file.write(first_line(header))
        for done, record in enumerate(_with(finished, jobs, over), kept + 1):
            file.write(line(header, record))
            file.flush()
            seen(done, kept + len(jobs))
    commit(partial, out)
    return read(out)


def _with_room(suite: Suite, lineup: Lineup) -> Lineup:
    """Return a lineup that the tasks have room for.

    Raises:
        HearthError: BAD_ARGUMENT: the tasks are for one agent, and there is a helper.
    """
    if suite.household and lineup.helper != NOBODY:
        message = f"tasks of `{suite.challenge}` are for one agent, and there is a helper `{lineup.helper[:60]}`"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="leave out --helper")
    return lineup


def _kept(header: Header, partial: Path) -> int:
    """Return how many episodes of the same run are in a file that a stopped run left.

    A half-written line is cut off.
    """
    if not partial.exists():
        return 0
    lines = read_lines(partial)
    first = next(lines, b"")
    if first != first_line(header):
        return 0
    kept, length = 0, len(first)
    for each, key in zip(lines, header.keys, strict=False):
        try:
            (record,) = read_records(header, [each.rstrip(b"\n")], partial.name)
        except HearthError:
            break
        if not each.endswith(b"\n") or (record.task, record.seed, record.helped) != key:
            break
        kept, length = kept + 1, length + len(each)
    with partial.open("r+b") as file:
        file.truncate(length)
    return kept


def _jobs(header: Header, known: Known, workers: int) -> list[Job]:
    tasks = {task.id: task for task in header.suite.tasks}
    guessed: dict[str, Goal] = {}
    if (reader := INFERRED.get(header.lineup.goal)) is not None:
        guessed = dict(zip(tasks, inferred(header.suite.tasks, reader, known, workers=workers), strict=True))
    jobs = []
    for key, seed, helped in header.keys:
        asked = helper_goal(header.lineup.goal, tasks[key], seed, header.suite.tasks) if helped else None
        goal = (guessed.get(key) or asked) if helped else None
        jobs.append(Job(tasks[key], seed, header.lineup, helped, goal, known))
    return jobs


def helper_goal(kind: str, task: Task, seed: int, tasks: Sequence[Task]) -> Goal | None:
    """Return the helper's goal, if it need not be inferred; a random goal is that of another of the tasks."""
    if kind == "true":
        return task.goal
    if kind == "none" or kind in INFERRED:
        return None
    others = [each.goal for each in tasks if each.goal != task.goal]
    if not others:
        raise HearthError.of(Code.BAD_ARGUMENT, "a random goal is that of another task, and there is none")
    return rng(task.seed, "random goal", seed).choice(others)


def _with(taken: Mapping[tuple[str, int, bool], Record], jobs: Sequence[Job], over: Spread) -> Iterator[Record]:
    """Yield the episodes in the order of the jobs; those that are there already are not played again."""
    found = [taken.get((job.task.id, job.seed, job.helped)) for job in jobs]
    rest = over([job for job, record in zip(jobs, found, strict=True) if record is None])
    return (record or next(rest) for record in found)
