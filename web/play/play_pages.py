"""The pages of Play: the games to choose from, a game, joining one, and the recorded episode."""

import gzip
from collections.abc import Iterator
from functools import lru_cache
from typing import Any

from starlette.responses import Response

from hearth.challenges.challenge_definition import NAMES, challenge
from hearth.challenges.episode_agents import NOBODY
from hearth.challenges.household import household_task
from hearth.challenges.household_as_challenge import as_task
from hearth.challenges.household_definition import NAME as HOUSEHOLD
from hearth.challenges.household_definition import settings
from hearth.challenges.result_files import MOST_SEEDS
from hearth.challenges.tasks import Task
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.goals import Goal
from hearth.schemas.optional_libraries import library
from hearth.web.phrases import say, thing_name
from hearth.web.play import game_store
from hearth.web.play.game_messages import goal_words, part_words
from hearth.web.play.game_results import as_bytes, results
from hearth.web.play.game_store import Stored
from hearth.web.play.games import Game
from hearth.web.play.live_games import PATIENCE, games
from hearth.web.play.play_trials import INTERFACES, PERSON, Trial, drawable, offered, published, trial
from hearth.web.room_request import Visit, by_browser
from hearth.web.third_party_scripts import missing
from hearth.web.web_errors import WebError

KINDS = {
    "wah": ("With a limited view", "You see only what is around you: things may be in another room, or in a cupboard."),
    "owah": ("With the whole view", "You see everything in the home from the beginning."),
}
"""Headings and explanations of the challenges, for people."""

FIRST_HELPERS = (NOBODY, PERSON, "hp_true", "expected_time", "random")
"""Helpers that the page offers first: all others are for people who compare helpers."""

SHOWN = {"symbolic": "Buttons and a floor plan", "visual": "First person, in 3D", "stream": "First person, pictures"}
"""The interfaces, for people."""

KINDS_SHOWN = {True: "only what is around you", False: "everything"}
"""The two views of a home, whole or not, for people."""

FIRST_TASKS = 20
"""Tasks of each challenge that the page offers; studies choose others."""

FAMILY_SPLIT = "test_seen"
"""Split of the household tasks that the page offers by number; any other task has a field for its id."""


def start_page(visit: Visit) -> Response:
    """Return the games that may be played, and the person's games."""
    return _start_page(visit)


def _start_page(visit: Visit, unknown: str = "") -> Response:
    """Return the page to begin at; with the id of a task that there is not, if one was asked for."""
    mine = visit.web.store.read(lambda connection: game_store.games_of(connection, visit.person))
    people_say = settings()["titles"]
    return visit.page(
        "play/start.html",
        400 if unknown else 200,
        unknown=unknown,
        household=[(number, f"{number + 1}. {people_say[family]}") for number, family in enumerate(_families())],
        challenges=[_offer(name) for name in NAMES],
        interfaces={name: SHOWN[name] for name in drawable()},
        lacking=missing(),
        games=[_line(each) for each in mine[:30] if not each.blind],
    )


def _offer(name: str) -> dict[str, Any]:
    """Return what the form of a challenge offers."""
    can = offered(challenge(name))
    title, about = KINDS[name]
    first = [each for each in FIRST_HELPERS if each in can]
    sees = sorted(KINDS_SHOWN, key=lambda partial: partial is not challenge(name).partial)
    return {
        "name": name,
        "title": title,
        "about": about,
        "tasks": list(_tasks(name)),
        "first": first,
        "more": [each for each in can if each not in first],
        "sees": [("partial" if partial else "full", KINDS_SHOWN[partial]) for partial in sees],
    }


def _families() -> Iterator[str]:
    """Yield the families of the household tasks that are offered; the tasks themselves are made when they are begun."""
    families = settings()["families"]
    yield from (families[number % len(families)] for number in range(FIRST_TASKS))


def _tasks(name: str) -> Iterator[tuple[int, str]]:
    which = challenge(name)
    split = "test-1" if "test-1" in which.splits else "test"
    for number in range(FIRST_TASKS):
        task = published(name, split, number)
        yield number, f"{number + 1}. {', '.join(which.grammar.sets[each].asked for each in task.sets)}"


def _line(each: Stored) -> dict[str, Any]:
    over = each.result is not None
    state = (
        ("goal reached" if each.result and each.result["success"] else "goal not reached") if over else "not finished"
    )
    return {
        "id": each.id,
        "over": over,
        "title": each.trial.title,
        "helper": say("helpers", each.trial.helper),
        "state": state,
    }


def new(visit: Visit) -> Response:
    """Begin a game as the form says."""
    partial = {"": None, "partial": True, "full": False}.get(visit.field("sees", 20))
    try:
        task = _chosen(visit)
    except HearthError:
        if not (by_browser(visit.request) and visit.field("id", 60)):
            raise
        return _start_page(visit, visit.field("id", 60))
    interface = visit.field("interface", 20) or INTERFACES[0]
    chosen = trial(
        task, visit.web.known, visit.field("helper", 40) or "none", interface, _episode(visit, task.id), partial
    )
    return visit.go(f"/play/game/{begin(visit, chosen)}")


def _chosen(visit: Visit) -> Task:
    """Return the task of the form: by its number, or a household task by its id."""
    name, number = visit.field("challenge", 20), visit.field("task", 6)
    if name == HOUSEHOLD and (task_id := visit.field("id", 60).strip()):
        return as_task(household_task(task_id, knowledge=visit.web.known))
    if name not in (*NAMES, HOUSEHOLD) or not number.isdecimal():
        raise WebError(Code.BAD_ARGUMENT, "task", "a challenge and the number of a task", f"{name} {number}"[:60])
    split = FAMILY_SPLIT if name == HOUSEHOLD else "test-1" if "test-1" in challenge(name).splits else "test"
    return published(name, split, int(number))


def _episode(visit: Visit, task: str) -> int:
    """Return the number of the next episode of a task in this store."""
    return visit.web.store.read(lambda connection: game_store.played_before(connection, task)) % MOST_SEEDS


def begin(visit: Visit, chosen: Trial) -> str:
    """Begin a game of the session that asks; its id."""
    return visit.web.store.write(lambda connection: game_store.begin(connection, visit.person, chosen))


def game_page(visit: Visit) -> Response:
    """Return the page of a game, by its interface."""
    live, number = games(visit.web.store, visit.web.known).find(visit.part("game"), visit.person)
    game = live.game
    home = game.start.home
    wanted = game.goals[0] or Goal()
    goal = [f"{goal_words(literal, home)}: {count}" for literal, count in wanted]
    goal += [part_words(part, home) for part in wanted.parts]
    return visit.page(
        "play/game.html",
        game=live.stored.id,
        interface=game.trial.interface,
        title=", ".join(map(thing_name, game.trial.title.split(", "))),
        instruction=game.trial.instruction if number == 0 else "",
        goal=goal if number == 0 else [],
        two=len(game.trial.people) > 1,
        studied=live.stored.blind,
    )


def join_page(visit: Visit) -> Response:
    """Ask a person with an invitation whether to join; a person of the game goes on with it, and a third is refused."""
    code = visit.part("code")
    game, people = visit.web.store.read(lambda connection: game_store.invited(connection, code))
    if visit.person in people:
        return visit.go(f"/play/game/{game}")
    full = len(people) > 1
    return visit.page("play/join.html", code=code, full=full, patience=int(PATIENCE))


def join(visit: Visit) -> Response:
    """Take the second seat of a game."""
    code = visit.part("code")
    try:
        game = visit.web.store.write(lambda connection: game_store.join(connection, visit.person, code))
    except WebError as fault:
        if fault.code is not Code.LOCKED or not by_browser(visit.request):
            raise
        return visit.page("play/join.html", 409, code=code, full=True, patience=int(PATIENCE))
    return visit.go(f"/play/game/{game}")


def record(visit: Visit) -> Response:
    """Return the episode as a file of results, for `challenge verify`, `score`, `film` and `build`."""
    live, _ = games(visit.web.store, visit.web.known).find(visit.part("game"), visit.person)
    if live.stored.blind:
        raise WebError(Code.NOT_ALLOWED, "episode", "a game that is not of a study", "its helper is not to be known")
    with live.lock:
        (found,) = results([live.sync()]).values()
    return _file(as_bytes(found), f"{live.game.trial.task.id}.jsonl")


def _file(data: bytes, name: str) -> Response:
    headers = {"Content-Disposition": f'attachment; filename="{name}"'}
    return Response(data, media_type="application/x-ndjson", headers=headers)


def home_file(visit: Visit) -> Response:
    """Return a home in 3D as all games of a challenge have it, as glTF."""
    name, home = visit.part("challenge"), visit.part("home")
    if name not in (*NAMES, HOUSEHOLD):
        raise WebError(Code.UNKNOWN_ID, "challenge", " or ".join((*NAMES, HOUSEHOLD)), name[:40])
    library("trimesh")
    from hearth.web.play.game_scene_3d import base_file

    file = base_file(name, home, visit.web.known, visit.web.out / "homes")
    if "gzip" not in visit.request.headers.get("accept-encoding", ""):
        return _model(file)
    answer = _model(_compressed(file))
    answer.headers["Content-Encoding"], answer.headers["Vary"] = "gzip", "Accept-Encoding"
    return answer


@lru_cache(maxsize=8)
def _compressed(data: bytes) -> bytes:
    """Return a home's file compressed: a fifth of it goes over the network, at once for the next who asks."""
    return gzip.compress(data, 6)


def model_file(visit: Visit) -> Response:
    """Return a model of a game that its home's file lacks, as glTF."""
    live, number = games(visit.web.store, visit.web.known).find(visit.part("game"), visit.person)
    with live.lock:
        return _model(live.drawn(visit.web.known, number).model(visit.part("key")))


def _model(data: bytes) -> Response:
    # The address depends on the file's contents, so that a browser need not ask for it again.
    return Response(
        data, media_type="model/gltf-binary", headers={"Cache-Control": "private, max-age=604800, immutable"}
    )


def desk_page(visit: Visit) -> Response:
    """Return the games of everybody, for researchers."""
    every = visit.web.store.read(game_store.all_games)
    kinds: dict[tuple[str, str, str, str], list[Stored]] = {}
    for each in every:
        kinds.setdefault(_kind(each), []).append(each)
    rows = [(kind, len(some), sum(each.result is not None for each in some)) for kind, some in kinds.items()]
    return visit.page("play/desk.html", rows=rows)


def _kind(game: Stored) -> tuple[str, str, str, str]:
    task = game.trial.task
    return task.challenge, task.split, game.trial.helper, game.trial.goal


def desk_results(visit: Visit) -> Response:
    """Return the games of a kind that are over, as a file of results."""
    asked = tuple(visit.field(name, 60) for name in ("challenge", "split", "helper", "goal"))
    every = [each for each in visit.web.store.read(game_store.all_games) if each.result is not None]
    found = results(_done(visit, [each for each in every if _kind(each) == asked]))
    if asked not in found:
        raise WebError(Code.UNKNOWN_ID, "kind", "a kind of which games are over", " ".join(asked)[:80])
    return _file(as_bytes(found[asked]), f"{'-'.join(asked)}.jsonl")


def _done(visit: Visit, some: list[Stored]) -> Iterator[Game]:
    known = games(visit.web.store, visit.web.known)
    for each in some:
        live = known.open(each.id)
        with live.lock:
            yield live.sync()
