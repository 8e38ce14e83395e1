"""`kill -9` of the server while somebody plays: `python benchmarks/play_kills.py [--times 20] [--helper hp_true]`.

A person decides as fast as answers come; at a random moment the server is killed, and another goes on with the same
folder. Every decision that was answered must be there then, and the recorded episode must verify; else the status is 1.
"""

from __future__ import annotations

import argparse
import random
import sys
import tempfile
import threading
from pathlib import Path

import orjson
from play_sessions import MOVES, begin, serve
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from hearth.challenges.verification import verify
from hearth.kb.loading.load import default
from hearth.web.play import game_store
from hearth.web.play.game_results import results
from hearth.web.play.live_games import LiveGame
from hearth.web.store import Store, default_url


def play_until_killed(address: str, token: str, game: str, chooser: random.Random) -> tuple[int, int]:
    """The tick from which the game went on, and the number of the last that was answered."""
    where = f"{address.replace('http', 'ws', 1)}/play/game/{game}/live"
    began = tick = -1
    try:
        with connect(where, additional_headers={"Authorization": f"Bearer {token}"}) as socket:
            socket.send(orjson.dumps({"type": "hello", "tab": game, "n": 1}).decode())
            began = tick = orjson.loads(socket.recv())["tick"]
            number = 1
            while True:
                number += 1
                act = {"type": "act", "tick": tick, "act": chooser.choice(MOVES), "n": number}
                socket.send(orjson.dumps(act).decode())
                tick = orjson.loads(socket.recv())["tick"]
    except (ConnectionClosed, OSError):
        return began, tick


def main() -> None:
    """Kill, go on, compare, print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--times", type=int, default=20)
    parser.add_argument("--helper", default="hp_true")
    asked = parser.parse_args()
    chooser, lost, answered = random.Random(0), 0, 0
    with tempfile.TemporaryDirectory() as folder:
        store = Store(default_url(Path(folder)))
        token, game = begin(store, 0, asked.helper)
        for number in range(asked.times):
            process, address = serve(Path(folder))
            threading.Timer(chooser.uniform(0.5, 3.0), process.kill).start()
            began, last = play_until_killed(address, token, game, chooser)
            process.wait()
            if began < 0:
                continue
            lost += max(0, answered - began)
            answered = last
            if last >= 200:
                token, game = begin(store, number + 1, asked.helper)
                answered = 0
        live = LiveGame(store, store.read(lambda connection: game_store.stored(connection, game)), default())
        (found,) = results([live.sync()]).values()
        faults = verify(found, "episode", default)
        lost += max(0, answered - live.game.tick)
    print(
        f"{asked.times} kills: {lost} accepted decisions lost; done again, the last episode differs {len(faults)} times"
    )
    sys.exit(bool(lost or faults))


if __name__ == "__main__":
    main()
