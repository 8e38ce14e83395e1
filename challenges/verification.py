"""The verification of results: every episode is replayed, and every metric computed again."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from itertools import groupby, islice, zip_longest
from pathlib import Path
from typing import Any

from hearth.agents.agent_registry import MAIN
from hearth.challenges.challenge_definition import challenge
from hearth.challenges.episode_agents import Lineup
from hearth.challenges.episodes import Job, Known, Record, again, played
from hearth.challenges.language_replay import answers_differ
from hearth.challenges.result_files import Results, read
from hearth.challenges.tasks import Task
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code
from hearth.storage.parallel import Seen, spread, unseen

MOST_AT_ONCE = 40
"""Episodes of a task that one process replays before it reports its findings."""


@dataclass(frozen=True)
class Check:
    """Episodes of one task that are to be replayed.

    Attributes:
        task: theirs.
        records: the episodes.
        known: gives the knowledge.
        jobs: to be played anew, so that the agents' choices are compared, too; empty otherwise.
        language: the language models that took part, as the results describe them.
    """

    task: Task
    records: tuple[Record, ...]
    known: Known
    jobs: tuple[Job, ...] = ()
    language: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)


def read_whole(path: Path) -> Results:
    """Return the results of a file that has the episodes which its first line says, whatever was done in them.

    Raises:
        HearthError: those of `result_files.read`; DAMAGED_FILE: it has others.
    """
    found = read(path)
    for fault in _missing(found):
        remedy = "run it again, or fetch the file again"
        raise HearthError.of(Code.DAMAGED_FILE, fault, file=str(path), suggestion=remedy)
    return found


def verify(
    results: Results, file: str, known: Known, workers: int = 1, agents: bool = False, seen: Seen = unseen
) -> list[Diagnostic]:
    """Return the episodes that are not as recorded; empty where all are.

    Args:
        results: as read; reading has compared each line with its digest.
        file: their name in faults.
        known: gives the knowledge.
        workers: processes.
        agents: also let the agents play each episode anew, and compare their actions.
        seen: called with the number of episodes done.
    """
    found = [Diagnostic(Code.REPLAY_DIFFERS, fault, file) for fault in _missing(results)]
    if found:
        return found
    checks, done = _checks(results, known, agents), 0
    for number, faults in spread(differences, checks, workers):
        done += number
        seen(done, len(results.records))
        found += [Diagnostic(Code.REPLAY_DIFFERS, fault, file) for fault in faults]
    return found


def _missing(results: Results) -> Iterator[str]:
    keys, here = results.header.each_key(), ((each.task, each.seed, each.helped) for each in results.records)
    if any(one != other for one, other in zip_longest(here, keys)):
        wanted = results.header.count
        yield f"{len(results.records):,} episodes, not {wanted:,}: one of each task, seed and kind, in order"


def _checks(results: Results, known: Known, agents: bool) -> Iterator[Check]:
    header = results.header
    tasks = {task.id: task for task in header.suite.tasks}
    grammar = challenge(header.suite.challenge).grammar
    if agents:  # a file of results, perhaps a stranger's, names no code that is run
        _need_ours(header.lineup)
    lineup = header.lineup.checked() if agents else header.lineup
    for name, group in groupby(results.records, lambda each: each.task):
        while records := tuple(islice(group, MOST_AT_ONCE)):
            jobs = []
            for each in records if agents else ():
                goal = None if each.helper_goal is None else grammar.read(each.helper_goal)
                jobs.append(Job(tasks[name], each.seed, lineup, each.helped, goal, known))
            yield Check(tasks[name], records, known, tuple(jobs), header.language)


def _need_ours(lineup: Lineup) -> None:
    """Refuse a lineup with an agent that is not one of ours.

    Raises:
        HearthError: BAD_ARGUMENT.
    """
    foreign = {"helper": lineup.helper if ":" in lineup.helper else "", "main agent": lineup.main}
    if lineup.main in MAIN:
        foreign["main agent"] = ""
    for role, name in foreign.items():
        if name:
            message = f"the {role} `{name[:60]}` is not one of ours, and results name no code to run"
            raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="verify without --agents")


def differences(check: Check) -> tuple[int, list[str]]:
    """Return how many episodes of a task were replayed, and the differences."""
    found = []
    # Those without a helper first, then those with one: their starts differ.
    for number, record in sorted(enumerate(check.records), key=lambda pair: pair[1].helped):
        where = f"{record.task}, seed {record.seed}, {'helped' if record.helped else 'alone'}"
        try:
            outcome, final = again(check.task, record, check.known())
        except HearthError as error:
            found.append(f"{where}: {error.diagnostics[0].message}")
            continue
        metrics = outcome.as_json()
        wrong = [name for name in {**metrics, **record.metrics} if metrics.get(name) != record.metrics.get(name)]
        if wrong:
            name = wrong[0]
            found.append(f"{where}: {name} is {metrics.get(name)}, and {record.metrics.get(name)} was recorded")
        elif final != record.final:
            found.append(f"{where}: the last world is another than was recorded")
        elif fault := answers_differ(check.task, record, check.language, check.known()):
            found.append(f"{where}: {fault}")
        elif check.jobs and played(check.jobs[number]) != record:
            found.append(f"{where}: the agents do something else")
    return len(check.records), found
