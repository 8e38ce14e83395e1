"""Builds on full disks, by two writers at once, and under readers: `python benchmarks/disturbed_builds.py [--times 8]`.

Each build is compared byte for byte with an undisturbed one; `killed_builds.py` does the same for builds that are
killed. Disks are small file systems in memory, or, where this user may not mount any, limits on the size of a file. The
status is 1 if a file differs, a build fails without saying why, no writer gets to its end, or a reader finds no
dataset.
"""

from __future__ import annotations

import argparse
import resource
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from killed_builds import CLI, contents, differing

INPUT = CLI.parent / "tests/golden/pipelines/input"
SOURCES = [str(INPUT / name) for name in ("crowd", "programs/evening.txt", "release")]
OPTIONS = ["--homes", str(INPUT / "homes"), "--home", "cabin", "--pictures", "1", "--videos", "0"]

READER = """
import sys
from pathlib import Path
import hearth
opened, failed = 0, []
Path(sys.argv[3]).touch()
while not Path(sys.argv[2]).exists():
    try:
        ds = hearth.load(sys.argv[1])
        ds[next(iter(ds))].runs[0].final
    except Exception as error:
        failed.append(repr(error))
    opened += 1
print(opened, *failed, sep="\\n")
"""

Faults = list[str]


def started(out: Path, *words: str, largest: int = 0) -> subprocess.Popen[str]:
    """Start a build into a folder; `largest` limits the bytes of a file."""
    command = [sys.executable, str(CLI), *(words or ("build", *SOURCES, *OPTIONS)), "--out", str(out)]
    build = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if largest:
        resource.prlimit(build.pid, resource.RLIMIT_FSIZE, (largest, largest))
    return build


def ended(build: subprocess.Popen[str], code: str, faults: Faults) -> bool:
    """Return whether a build got to its end; another end must name the code, without a traceback."""
    printed = build.communicate()[1]
    if build.returncode and (f"error[{code}]" not in printed or "Traceback" in printed or "error in Hearth" in printed):
        faults.append(f"status {build.returncode}: {printed[-300:]}")
    return build.returncode == 0


def _quiet(command: list[str]) -> int:
    return subprocess.run(command, stderr=subprocess.DEVNULL, check=False).returncode


@contextmanager
def small_disk(folder: Path) -> Iterator[bool]:
    """Mount a file system in memory on a folder; False where this is not permitted."""
    folder.mkdir()
    command = ["mount", "-t", "tmpfs", "-o", "size=1m", "tmpfs", str(folder)]
    mounted = shutil.which("mount") is not None and not _quiet(command)
    try:
        yield mounted
    finally:
        if mounted:
            subprocess.run(["umount", "-l", str(folder)], check=True)


def full_disks(folder: Path, whole: Path, times: int, faults: Faults) -> str:
    """Build on a disk with room for a part of the build, then for a larger part, and at last for all."""
    size, stopped = sum(map(len, contents(whole).values())), 0
    disk = folder / "disk"
    with small_disk(disk) as mounted:
        for step in range(1, times + 1):
            room = size * step // times
            if mounted:
                subprocess.run(["mount", "-o", f"remount,size={room + 4096}", str(disk)], check=True)
                build = started(disk / "out")
            else:
                largest = max(map(len, contents(whole).values())) * step // times
                build = started(disk / "out", largest=largest)
            stopped += not ended(build, "UNWRITABLE", faults)
        if mounted:
            subprocess.run(["mount", "-o", f"remount,size={size * 20}", str(disk)], check=True)
        if not ended(started(disk / "out"), "", faults):
            faults.append("the build with enough room did not end")
        faults += differing(whole, disk / "out")
    return f"{stopped} of {times} builds stopped by a full {'disk' if mounted else 'file'}, the next got to its end"


def two_writers(folder: Path, whole: Path, times: int, faults: Faults) -> str:
    """Two builds start in one folder at the same moment: at least one ends, another says that it is locked out."""
    locked = 0
    for number in range(times):
        out = folder / f"both{number}"
        builds = [started(out), started(out)]
        done = [ended(build, "LOCKED", faults) for build in builds]
        locked += done.count(False)
        faults += ["none of two writers ended"] if not any(done) else differing(whole, out)
    return f"{times} pairs of writers, {locked} locked out"


def readers(folder: Path, whole: Path, times: int, faults: Faults) -> str:
    """Eight processes open the dataset again and again while it is replaced."""
    out, done = shutil.copytree(whole, folder / "read"), folder / "done"
    ready = [folder / f"ready{number}" for number in range(8)]
    asked = [[sys.executable, "-c", READER, str(out), str(done), str(path)] for path in ready]
    processes = [subprocess.Popen(one, stdout=subprocess.PIPE, text=True) for one in asked]
    while not all(path.exists() for path in ready):
        if any(process.poll() is not None for process in processes):
            raise SystemExit("a reader could not start")
    for seed in range(1, times + 1):
        if not ended(started(out, "publish", "--seed", str(seed)), "", faults):
            faults.append("the dataset could not be published again")
    done.touch()
    opened = 0
    for process in processes:
        number, *failed = process.communicate()[0].splitlines()
        opened += int(number)
        faults += failed
    return f"{times} replacements under 8 readers, opened {opened:,} times"


def main() -> int:
    """Disturb builds and report."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--times", type=int, default=8, help="disks, pairs of writers, and replacements")
    times, worst = parser.parse_args().times, 0
    with tempfile.TemporaryDirectory() as made:
        folder, whole = Path(made), Path(made) / "undisturbed"
        if not ended(started(whole), "", []):
            raise SystemExit("the undisturbed build failed")
        for disturb in (full_disks, two_writers, readers):
            faults: Faults = []
            print(f"{disturb(folder, whole, times, faults)}: {len(faults)} faults", *faults, sep="\n", flush=True)
            worst = max(worst, len(faults))
    return int(worst > 0)


if __name__ == "__main__":
    sys.exit(main())
