"""A dataset built by workers that reach each other only through a network, as two hosts do: is it the same?

    python benchmarks/two_hosts.py [SOURCE ...] [--hosts 2] [--limit 200]

Each worker is in a network namespace of its own, with its own loopback and address, joined by a bridge to that of the
scheduler and the build; they share the folder, as hosts do that mount one. All of it lies in a namespace that ends with
the run, so the machine's own network is not touched. Prints the partitions that each host did, and the files that
differ from a build by one process (the status is then 1). Needs Linux, `ip`, the right to make namespaces, and dask.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path

from killed_builds import differing

ROOT = Path(__file__).resolve().parents[1]
SOURCES = (ROOT / "data_raw/crowd/descriptions.csv", ROOT / "data_raw/crowd/programs.csv")
SCHEDULER = "10.77.0.1"
PORT = 8786
INSIDE = "HEARTH_INSIDE_NAMESPACE"


def permitted() -> str:
    """Return the reason why namespaces cannot be made here; nothing if they can."""
    if not shutil.which("unshare") or not shutil.which("ip"):
        return "`unshare` or `ip` is not installed"
    tried = "ip link add try0 type bridge && mount -t tmpfs none /run && ip netns add try"
    command = ["unshare", "--net", "--mount", "sh", "-c", tried]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    return "" if done.returncode == 0 else f"network namespaces are not permitted: {done.stderr.strip()}"


def ip(*words: object) -> None:
    """Change the network of this namespace."""
    subprocess.run(["ip", *map(str, words)], check=True, capture_output=True)


def joined(number: int) -> list[str]:
    """Make namespaces with a worker's address each, on one bridge with this one; returns their names."""
    subprocess.run(["mount", "-t", "tmpfs", "none", "/run"], check=True)
    ip("link", "set", "lo", "up")
    ip("link", "add", "hosts", "type", "bridge")
    ip("address", "add", f"{SCHEDULER}/24", "dev", "hosts")
    ip("link", "set", "hosts", "up")
    names = [f"host-{n}" for n in range(1, number + 1)]
    for n, name in enumerate(names, 2):
        ip("netns", "add", name)
        ip("link", "add", f"cable-{n}", "type", "veth", "peer", "name", "eth0", "netns", name)
        ip("link", "set", f"cable-{n}", "master", "hosts", "up")
        ip("-n", name, "link", "set", "lo", "up")
        ip("-n", name, "address", "add", f"10.77.0.{n}/24", "dev", "eth0")
        ip("-n", name, "link", "set", "eth0", "up")
    return names


@contextlib.contextmanager
def cluster(names: Sequence[str], folder: Path) -> Iterator[str]:
    """A dask scheduler here and a worker in each namespace; yields the scheduler's address."""
    from distributed import Client

    python = [sys.executable, "-m", "dask"]
    address = f"tcp://{SCHEDULER}:{PORT}"
    commands = [[*python, "scheduler", "--host", SCHEDULER, "--port", str(PORT), "--no-dashboard"]]
    for name in names:
        options = ["--nthreads", "1", "--no-nanny", "--no-dashboard", "--local-directory", str(folder / name)]
        commands.append(["ip", "netns", "exec", name, *python, "worker", address, "--name", name, *options])
    with contextlib.ExitStack() as stack:
        for command in commands:
            process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            stack.callback(process.wait)
            stack.callback(process.terminate)
        with Client(address, timeout=60) as client:
            client.wait_for_workers(len(names), timeout=60)
        yield address


def done_by(address: str) -> dict[str, tuple[str, int]]:
    """Worker -> its address and the number of tasks that it did."""
    from distributed import Client

    with Client(address, timeout=60) as client:
        found: dict[str, int] = client.run(_executed)
        names = {worker: info["name"] for worker, info in client.scheduler_info(n_workers=-1)["workers"].items()}
    return {names[worker]: (worker, number) for worker, number in found.items()}


def _executed(dask_worker: object) -> int:
    return int(dask_worker.state.executed_count)  # type: ignore[attr-defined]


def built(sources: Sequence[str], out: Path, *more: str) -> None:
    """Build a dataset.

    Raises:
        CalledProcessError: it failed.
    """
    command = [sys.executable, str(ROOT / "cli.py"), "build", *sources, "--out", str(out), "--pictures", "0",
               "--videos", "0", *more]  # fmt: skip
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def compared(sources: Sequence[str], hosts: int, limit: int) -> int:
    """Build over the network and by one process; 1 if a file differs or a host did nothing."""
    more = ("--limit", str(limit)) if limit else ()
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        with cluster(joined(hosts), folder) as address:
            built(sources, folder / "network", *more, "--engine", "dask", "--scheduler", address)
            found = done_by(address)
        built(sources, folder / "alone", *more, "--workers", "1")
        wrong = differing(folder / "alone", folder / "network")
    for name, (worker, number) in sorted(found.items()):
        print(f"{name} at {worker}: {number} partitions")
    print(f"{len(wrong)} files differ from the build by one process", *wrong)
    return int(bool(wrong) or len(found) < hosts or not all(number for _, number in found.values()))


def main() -> int:
    """Do it in a namespace."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sources", nargs="*", default=[str(source) for source in SOURCES], metavar="SOURCE")
    parser.add_argument("--hosts", type=int, default=2, metavar="N")
    parser.add_argument("--limit", type=int, default=200, metavar="N", help="of the sources' descriptions; 0: all")
    asked = parser.parse_args()
    if INSIDE in os.environ:
        return compared(asked.sources, asked.hosts, asked.limit)
    if reason := permitted():
        raise SystemExit(reason)
    command = ["unshare", "--net", "--mount", sys.executable, *sys.argv]
    return subprocess.run(command, env={**os.environ, INSIDE: "1"}, check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
