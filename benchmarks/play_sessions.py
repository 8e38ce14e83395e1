"""People who play at once: the round trip of a decision over the socket, and the server's work for it.

    python benchmarks/play_sessions.py [--sessions 50] [--seconds 30] [--every 1.0] [--helper none]

Every session decides once in `--every` seconds on average, on one server with the embedded store. Printed are median,
95th and 99th percentile in milliseconds, and the server's processor time for a decision, which other work on the
machine hardly changes.
"""

from __future__ import annotations

import argparse
import asyncio
import os
import random
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import orjson
from websockets.asyncio.client import connect

from hearth.kb.loading.load import default
from hearth.web import sessions
from hearth.web.play import start_trial
from hearth.web.play.play_trials import published, trial
from hearth.web.store import Store, default_url

ROOT = Path(__file__).resolve().parents[1]
MOVES = ("[Turnleft]", "[Turnright]", None)


def serve(out: Path, *options: str) -> tuple[subprocess.Popen[str], str]:
    """A server of a folder, and its address."""
    command = [sys.executable, str(ROOT / "cli.py"), "serve", "--port", "0", "--json", "--out", str(out), *options]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    text = ""
    assert process.stdout is not None
    while not text.endswith("\n}\n"):
        text += process.stdout.readline()
    return process, orjson.loads(text)["address"]


def begin(store: Store, number: int, helper: str) -> tuple[str, str]:
    """A session that has begun a game: its token, and the game's id."""
    session = sessions.start(store)
    chosen = trial(published("wah", "test-1", number % 20), default(), helper, seed=number)
    return session.token, store.write(lambda connection: start_trial(connection, session.id, chosen))


async def measure(address: str, games: list[tuple[str, str]], every: float, seconds: float) -> list[float]:
    """The round trips of all sessions, in order of time."""
    until = time.monotonic() + seconds
    found = await asyncio.gather(*(play(address, each, every, until, random.Random(n)) for n, each in enumerate(games)))
    return sorted(each for one in found for each in one)


async def play(address: str, game: tuple[str, str], every: float, until: float, chooser: random.Random) -> list[float]:
    """Decide again and again; the seconds of each round trip."""
    found = []
    token, name = game
    where = f"{address.replace('http', 'ws', 1)}/play/game/{name}/live"
    async with connect(where, additional_headers={"Authorization": f"Bearer {token}"}) as socket:
        await socket.send(orjson.dumps({"type": "hello", "tab": name, "n": 1}).decode())
        state, number = orjson.loads(await socket.recv()), 1
        while time.monotonic() < until and not state["over"]:
            await asyncio.sleep(chooser.uniform(0, 2 * every))
            number += 1
            message = {"type": "act", "tick": state["tick"], "act": chooser.choice(MOVES), "n": number}
            since = time.perf_counter()
            await socket.send(orjson.dumps(message).decode())
            answer = orjson.loads(await socket.recv())
            found.append(time.perf_counter() - since)
            if answer["type"] == "error" and answer["error"]["code"] == "TIMED_OUT":  # busy: it is decided again
                number = answer["next"] - 1
                continue
            assert answer["type"] == "tick", answer
            state = answer
    return found


def processor(process: subprocess.Popen[str]) -> float:
    """Seconds of processor time that a process has taken."""
    fields = Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sessions", type=int, default=50)
    parser.add_argument("--seconds", type=float, default=30.0)
    parser.add_argument("--every", type=float, default=1.0)
    parser.add_argument("--helper", default="none")
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        store = Store(default_url(Path(folder)))
        process, address = serve(Path(folder))
        try:
            games = [begin(store, number, asked.helper) for number in range(asked.sessions)]
            asyncio.run(measure(address, games, asked.every, 3.0))  # homes are read
            before = processor(process)
            found = asyncio.run(measure(address, games, asked.every, asked.seconds))
            work = processor(process) - before
        finally:
            process.kill()
            process.wait()
    share = {
        name: 1000 * found[int(len(found) * part)] for name, part in (("median", 0.5), ("95%", 0.95), ("99%", 0.99))
    }
    shown = ", ".join(f"{name} {value:.1f} ms" for name, value in share.items())
    print(f"{asked.sessions} sessions, {len(found):,} decisions: {shown}")
    print(f"server: {1000 * work / max(1, len(found)):.1f} ms of processor time a decision")
    print(f"load of this machine: {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores")


if __name__ == "__main__":
    main()
