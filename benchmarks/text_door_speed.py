"""`hearth serve --text` under load: requests a second, and the times of their answers.

    python benchmarks/text_door_speed.py                       200 worlds, 1,000 requests a second, 20 s
    python benchmarks/text_door_speed.py --steps-only          every request is a step
    python benchmarks/text_door_speed.py --rate 0              as fast as the answers come

Each world has a client with a connection of its own. A client steps, observes, steps, asks for the admissible
commands, and so on; commands are drawn from those that are legal. Requests are sent at the times of the rate, whether
or not others were answered; a time counts from there, so that waiting for the connection counts, too. The clients are a
process on the same machine, whose processor seconds are printed next to the server's.
"""

from __future__ import annotations

import argparse
import asyncio
import os
import random
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import orjson

ROOT = Path(__file__).resolve().parents[1]
WITHIN_MS = 10.0
"""Milliseconds within which 95 % of the requests are to be answered."""


class Client:
    """A client with one world and one connection."""

    def __init__(self, port: int, seed: int) -> None:
        self._port, self._seed, self._random = port, seed, random.Random(seed)
        self._turn = 0
        self.failed = 0

    async def begin(self) -> None:
        """Create and reset the world."""
        await self.connect()
        self._world = (await self._ask("POST", "/create", {}))["id"]
        await self._ask("POST", "/reset", {"id": self._world, "seed": self._seed})
        self._legal = (await self._ask("GET", f"/admissible?id={self._world}"))["admissible"]

    async def connect(self) -> None:
        """Open a connection; the server has ended one that was quiet while others began."""
        self._in, self._out = await asyncio.open_connection("127.0.0.1", self._port)

    async def _ask(self, method: str, address: str, body: dict | None = None):
        data = b"" if body is None else orjson.dumps(body)
        head = f"{method} {address} HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: {len(data)}\r\n\r\n"
        self._out.write(head.encode() + data)
        answer = await self._in.readuntil(b"\r\n\r\n")
        length = int(answer.lower().split(b"content-length:")[1].split(b"\r\n")[0])
        value = orjson.loads(await self._in.readexactly(length))
        self.failed += not answer.startswith(b"HTTP/1.1 200")
        return value

    async def request(self, steps_only: bool) -> None:
        """Make the next request."""
        self._turn += 1
        kind = 0 if steps_only else self._turn % 4
        if kind == 1:
            await self._ask("GET", f"/observe?id={self._world}")
        elif kind == 3:
            self._legal = (await self._ask("GET", f"/admissible?id={self._world}"))["admissible"] or ["wait"]
        else:
            command = self._random.choice(self._legal)
            turn = await self._ask("POST", "/step", {"id": self._world, "action": command})
            if turn.get("done"):
                await self._ask("POST", "/reset", {"id": self._world, "seed": self._seed})


async def load(clients: list[Client], rate: float, seconds: float, steps_only: bool) -> tuple[list[float], float]:
    """Return the milliseconds of all requests, and the seconds that they took."""
    times: list[float] = []
    began = time.perf_counter()
    gap = len(clients) / rate if rate else 0.0

    async def play(number: int, client: Client) -> None:
        due = began + gap * number / len(clients)
        while due < began + seconds:
            await asyncio.sleep(max(0.0, due - time.perf_counter()))
            since = due if rate else time.perf_counter()
            await client.request(steps_only)
            times.append(1000 * (time.perf_counter() - since))
            due = due + gap if rate else time.perf_counter()

    await asyncio.gather(*[play(number, client) for number, client in enumerate(clients)])
    return times, time.perf_counter() - began


def processor(pid: int) -> float:
    """Return the processor seconds of a process and of all that it started."""
    ticks, total, children = os.sysconf("SC_CLK_TCK"), 0.0, [pid]
    while children:
        each = children.pop()
        try:
            fields = Path(f"/proc/{each}/stat").read_text().rpartition(")")[2].split()
            children += map(int, Path(f"/proc/{each}/task/{each}/children").read_text().split())
        except OSError:
            continue
        total += (int(fields[11]) + int(fields[12])) / ticks
    return total


async def measure(given: argparse.Namespace, port: int, pid: int) -> bool:
    """Print the figures; return whether they are as wanted."""
    clients = [Client(port, seed) for seed in range(given.worlds)]
    for client in clients:
        await client.begin()
    await asyncio.gather(*[client.connect() for client in clients])
    await load(clients, given.rate, min(5.0, given.seconds), given.steps_only)  # words and ways are learned
    busy, own = processor(pid), time.process_time()
    times, took = await load(clients, given.rate, given.seconds, given.steps_only)
    busy, own = processor(pid) - busy, time.process_time() - own
    times.sort()
    at = {part: times[int(part / 100 * (len(times) - 1))] for part in (50, 95, 99)}
    print(f"{len(times):,} requests of {given.worlds} worlds in {took:.1f} s: {len(times) / took:,.0f} a second")
    print("answered within " + ", ".join(f"{value:.1f} ms ({part} %)" for part, value in at.items()))
    within = sum(each <= WITHIN_MS for each in times) / len(times)
    print(f"{within:.1%} within {WITHIN_MS:g} ms; {sum(client.failed for client in clients)} refused")
    load_of = ", ".join(f"{each:.1f}" for each in os.getloadavg())
    print(f"processor: server {busy / took:.2f} cores, clients {own / took:.2f}; load of the machine {load_of}")
    return within >= 0.95


def main() -> int:
    """Serve, and measure."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--worlds", type=int, default=200)
    parser.add_argument("--rate", type=float, default=1000.0)
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--steps-only", action="store_true")
    given = parser.parse_args()
    resource.setrlimit(resource.RLIMIT_NOFILE, (min(4096, resource.getrlimit(resource.RLIMIT_NOFILE)[1]),) * 2)
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, str(ROOT / "cli.py"), "serve", "--text", "--port", "0", "--json", "--out", folder]
        command += ["--worlds", str(given.worlds), "--workers", str(given.workers)]
        server = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        try:
            said = "".join(iter(server.stdout.readline, "}\n")) + "}"
            port = int(orjson.loads(said)["address"].rpartition(":")[2])
            return 0 if asyncio.run(measure(given, port, server.pid)) else 1
        finally:
            server.terminate()
            server.wait()


if __name__ == "__main__":
    sys.exit(main())
