"""A player for tests: it plays by a socket what an agent of ours did alone."""

from __future__ import annotations

import time

import orjson

from hearth.challenges.episode_agents import Lineup
from hearth.challenges.episode_loop import Playing
from hearth.challenges.episodes import Job, played
from hearth.envs.json_observations import instruction_text
from hearth.kb.loading.load import default
from hearth.web.play import start_trial
from hearth.web.play.games import Game
from hearth.web.play.play_trials import trial
from hearth.web.sessions import find


def session_of(server, person):
    return find(server.store, person.cookies["hearth"]).id


def begun(server, person, task, helper="none", **options):
    """A game of a person; its id."""
    chosen = trial(task, default(), helper, **options)
    return server.store.write(lambda connection: start_trial(connection, session_of(server, person), chosen))


def connected(person, game):
    cookie = f"hearth={person.cookies['hearth']}"
    return person.websocket_connect(f"ws://127.0.0.1/play/game/{game}/live", headers={"cookie": cookie})


class Player:
    """Somebody at the socket of a game."""

    def __init__(self, person, game, tab="a"):
        self.person, self.game, self.tab = person, game, tab
        self.n = 0

    def __enter__(self):
        self.socket = connected(self.person, self.game)
        self.socket.__enter__()
        self.state = self.ask({"type": "hello", "tab": self.tab})
        return self

    def __exit__(self, *error):
        self.socket.__exit__(*error)

    def ask(self, message):
        self.n += 1
        self.socket.send_text(orjson.dumps({**message, "n": self.n}).decode())
        return self.receive()

    def receive(self):
        found = orjson.loads(self.socket.receive_text())
        if found["type"] == "error":
            self.n = found["next"] - 1
        else:
            self.state = found
        return found

    def receive_after_pause(self):
        """The answer to a turn, after a pause that the limit of messages a second asks for."""
        time.sleep(0.1)
        return self.act("[Turnleft]")

    def patient_act(self, act):
        """The answer to an act, sent again where it was too fast for a person."""
        while (found := self.act(act))["type"] == "error" and found["error"]["code"] == "TOO_FAST":
            time.sleep(0.2)
        return found

    def act(self, act, tick=None):
        return self.ask({"type": "act", "tick": self.state["tick"] if tick is None else tick, "act": act})


def alone(task):
    """Yield the actions of a human-like agent in a task alone, as texts that a page sends."""
    record = played(Job(task, 0, Lineup(), False, None, default))
    game = Game(trial(task, default()), default())
    playing: Playing = game.playing
    for (act,) in record.actions:
        step = None if act is None else next(each for each in playing.legal(0) if _same(each, act))
        yield act, None if step is None else instruction_text(step)
        playing.step({0: step})


def _same(step, act):
    return " ".join([step.action, *(str(ref.node) for ref in step.objects)]) == act
