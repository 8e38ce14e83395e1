"""People who play while strangers hold half-open connections: the round trip of a decision, with and without them.

    python benchmarks/half_open.py [--connections 1000] [--sessions 50] [--seconds 60]

Strangers open connections and say nothing, or a part of a request; each that the server ends is opened again at once.
Printed are the round trips of the people, and how many connections were open at once and how long one lasted.
"""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from urllib.parse import urlsplit

from play_sessions import begin, measure, processor, serve

from hearth.web.store import Store, default_url

HALVES = (
    b"",
    b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nX-",
    b"POST /begin HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/x-www-form-urlencoded\r\n"
    b"Content-Length: 999\r\n\r\na=",
)
"""Requests of strangers: none, a part of the headers, a part of a body."""

WITHIN_MS = 100.0
"""Milliseconds within which 95 % of the decisions are to be answered."""


class Strangers:
    """Half-open connections to a server, each opened again once it was ended; in a process of their own."""

    def __init__(self, port: int) -> None:
        self._port = port
        self.open, self.longest = 0, 0.0

    async def hold(self, number: int) -> None:
        """Hold one connection after another."""
        await asyncio.sleep(number / 400)  # not all at one moment
        while True:
            with contextlib.suppress(OSError):
                reader, writer = await asyncio.open_connection("127.0.0.1", self._port)
                since = time.monotonic()
                self.open += 1
                writer.write(HALVES[number % len(HALVES)])
                with contextlib.suppress(OSError):
                    while await reader.read(4096):
                        pass
                self.open -= 1
                self.longest = max(self.longest, time.monotonic() - since)
                writer.close()
            await asyncio.sleep(0.05)

    async def run(self, number: int) -> None:
        """Hold this number of connections; print every second how many are open, and how long the longest lasted."""
        held = [asyncio.create_task(self.hold(each)) for each in range(number)]
        while held:
            await asyncio.sleep(1)
            print(self.open, round(self.longest, 1), flush=True)


def besieged(address: str, games: list[tuple[str, str]], connections: int, seconds: float) -> list[float]:
    """Return the round trips while strangers hold connections; print what became of these."""
    command = [sys.executable, __file__, "--port", str(urlsplit(address).port), "--connections", str(connections)]
    with tempfile.TemporaryFile("w+") as said:
        strangers = subprocess.Popen(command, stdout=said)
        time.sleep(connections / 400 + 3)
        found = asyncio.run(measure(address, games, 1.0, seconds))
        strangers.kill()
        strangers.wait()
        said.seek(0)
        lines = [line.split() for line in said][3:]
    counts = sorted(int(count) for count, _ in lines)
    print(f"half-open at once: median {counts[len(counts) // 2]:,}, at most {counts[-1]:,}", end="; ")
    print(f"the longest lasted {lines[-1][1]} s")
    return found


def shown(found: list[float]) -> str:
    """Return the shares of round trips, in milliseconds."""
    parts = (("median", 0.5), ("95%", 0.95), ("99%", 0.99))
    return ", ".join(f"{name} {1000 * found[int(len(found) * part)]:.1f} ms" for name, part in parts)


def main() -> None:
    """Measure and print; exit with 1 if decisions take too long."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--connections", type=int, default=1_000)
    parser.add_argument("--sessions", type=int, default=50)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--port", type=int, default=0, help=argparse.SUPPRESS)
    asked = parser.parse_args()
    if asked.port:
        asyncio.run(Strangers(asked.port).run(asked.connections))
        return
    with tempfile.TemporaryDirectory() as folder:
        store = Store(default_url(Path(folder)))
        process, address = serve(Path(folder))
        try:
            games = [begin(store, number, "none") for number in range(asked.sessions)]
            asyncio.run(measure(address, games, 1.0, 3.0))  # homes are read
            calm = asyncio.run(measure(address, games, 1.0, min(10.0, asked.seconds)))
            before = processor(process)
            found = besieged(address, games, asked.connections, asked.seconds)
            work = (processor(process) - before) / asked.seconds
        finally:
            process.kill()
            process.wait()
    print(f"{asked.sessions} people alone, {len(calm):,} decisions: {shown(calm)}")
    print(f"{asked.sessions} people beside {asked.connections:,} half-open, {len(found):,} decisions: {shown(found)}")
    print(f"the server took {work:.0%} of a core meanwhile")
    print(f"load of this machine: {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores")
    raise SystemExit(1000 * found[int(len(found) * 0.95)] >= WITHIN_MS)


if __name__ == "__main__":
    main()
