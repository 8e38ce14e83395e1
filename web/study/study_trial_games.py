"""The games of a study's trials: begun in the room Play, and recorded in the study when they are over."""

from dataclasses import replace
from typing import Any

import sqlalchemy as sql

from hearth.challenges.result_files import episode_data
from hearth.studies.study_progress import PRACTICE, Conduct, Standing
from hearth.studies.study_trials import job_of, practice_task
from hearth.web import play
from hearth.web.play import game_store
from hearth.web.play.play_trials import Trial, trial
from hearth.web.room_request import Web
from hearth.web.study.study_schema import TRIAL_GAMES

BACK = "/study/"
"""The address that a game's page leads to when the game is over."""


def begun(web: Web, conduct: Conduct, standing: Standing) -> str:
    """Return the game of the trial or practice that a person is at; it is begun if it was not."""
    chosen = _chosen(web, conduct, standing)
    key = {"session": standing.person, "study": conduct.study.name, "number": len(standing.events)}

    def begin(connection: sql.Connection) -> str:
        found = connection.execute(_query(key)).scalar()
        if found is not None:
            return str(found)
        game = play.start_trial(connection, standing.person, chosen, BACK)
        connection.execute(sql.insert(TRIAL_GAMES).values(**key, game=game))
        return game

    return web.store.write(begin)


def is_begun(web: Web, conduct: Conduct, standing: Standing) -> bool:
    """Return whether the game of the trial or practice that a person is at has begun: its time runs on."""
    key = {"session": standing.person, "study": conduct.study.name, "number": len(standing.events)}
    return web.store.read(lambda connection: connection.execute(_query(key)).scalar()) is not None


def _query(key: dict[str, Any]) -> sql.Select[Any]:
    conditions = [TRIAL_GAMES.c[name] == value for name, value in key.items()]
    return sql.select(TRIAL_GAMES.c.game).where(*conditions)


def _chosen(web: Web, conduct: Conduct, standing: Standing) -> Trial:
    """Return the trial as the room Play has it; a practice is alone."""
    study = conduct.study
    seconds = study.limits.minutes * 60
    if standing.stage == PRACTICE:
        task = practice_task(study, standing.number)
        return replace(trial(task, web.known, interface=study.interface), seconds=seconds)
    job = job_of(study, conduct.trial(standing), conduct.known)
    lineup, task = job.lineup, job.task
    plain = trial(task, web.known, interface=study.interface, seed=job.seed)
    goal = lineup.goal if job.helped else "none"
    return Trial(task, lineup.helper, goal, job.helper_goal, study.interface, job.seed, plain.partial, seconds)


def gone_on(web: Web, conduct: Conduct, standing: Standing) -> Standing:
    """Return where a person is once the game of the trial, if it is over, is recorded in the study.

    The duration lasts from the game's beginning to its end, however long the person stays on the page afterwards.
    """
    key = {"session": standing.person, "study": conduct.study.name, "number": len(standing.events)}
    game = web.store.read(lambda connection: connection.execute(_query(key)).scalar())
    if game is None:
        return standing
    record = play.recorded_episode(web.store, web.known, game)
    if record is None:
        return standing
    if standing.stage == PRACTICE:
        return conduct.practised(standing.person)
    data = {**episode_data(record), "actions": [list(tick) for tick in record.actions]}
    stored, decided, opened = web.store.read(
        lambda connection: (
            game_store.stored(connection, game),
            game_store.decisions(connection, game),
            game_store.openings(connection, game),
        )
    )
    ended = (stored.result or {}).get("at") or max((each.at for tick in decided.values() for each in tick), default=0.0)
    times = [round(each.at - stored.created, 2) for tick in decided.values() for each in tick if each.agent == 0]
    return conduct.played(standing.person, data, round(max(0.0, ended - stored.created), 1), times, opened)
