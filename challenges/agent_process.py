"""Starting and ending the program of an agent of others: its environment, and the processes that end with it.

On Linux all that the program started ends with it, processes in sessions of their own too (`agent_supervisor`). On
other systems only its group of processes ends: one that leaves the group goes on there.
"""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from hearth.challenges import agent_supervisor

GIVEN = frozenset({
    "PATH", "HOME", "USER", "LOGNAME", "SHELL", "LANG", "LANGUAGE", "TZ", "TERM", "TMPDIR", "TEMP", "TMP",
    "PYTHONPATH", "PYTHONHASHSEED", "PYTHONUNBUFFERED", "PYTHONIOENCODING", "PYTHONUTF8", "VIRTUAL_ENV", "CONDA_PREFIX",
    "LD_LIBRARY_PATH", "DYLD_LIBRARY_PATH", "JAVA_HOME", "NODE_PATH", "GOPATH", "CUDA_VISIBLE_DEVICES",
    "OMP_NUM_THREADS", "NUMBA_CACHE_DIR", "SYSTEMROOT", "WINDIR", "COMSPEC", "PATHEXT", "APPDATA", "LOCALAPPDATA",
    "USERPROFILE", "PROGRAMDATA", "NUMBER_OF_PROCESSORS",
})  # fmt: skip
"""Variables of the environment that an agent gets, with `LC_...`: keys, tokens and salts are none of them.

What else an agent needs stands in its command: `env KEY=... python agent.py`.
"""


def environment(given: Mapping[str, str] | None = None) -> dict[str, str]:
    """Return the environment of an agent: what `GIVEN` allows of this process's."""
    own = os.environ if given is None else given
    return {name: value for name, value in own.items() if name.upper() in GIVEN or name.startswith("LC_")}


def start(argv: Sequence[str]) -> subprocess.Popen[bytes]:
    """Start a program with pipes to its standard input, output and error, in a session of its own.

    Raises:
        OSError: it cannot be started.
        ValueError: an argument holds a character that none may.
    """
    if sys.platform != "linux":
        return _popen(list(argv))
    reads, writes = os.pipe()
    try:
        script = str(Path(agent_supervisor.__file__))
        process = _popen([sys.executable, "-I", "-S", script, str(writes), *argv], pass_fds=(writes,))
        os.close(writes)
        writes = -1
        fault = os.read(reads, 20)
    finally:
        os.close(reads)
        if writes >= 0:
            os.close(writes)
    if fault:
        _close(process)
        raise OSError(int(fault), os.strerror(int(fault)), argv[0])
    return process


def _popen(words: list[str], pass_fds: tuple[int, ...] = ()) -> subprocess.Popen[bytes]:
    pipe = subprocess.PIPE
    return subprocess.Popen(
        words,
        stdin=pipe,
        stdout=pipe,
        stderr=pipe,
        bufsize=0,
        start_new_session=True,
        env=environment(),
        pass_fds=pass_fds,
    )


def _close(process: subprocess.Popen[bytes]) -> None:
    process.wait()
    for pipe in (process.stdin, process.stdout, process.stderr):
        if pipe is not None:
            pipe.close()


def end(process: subprocess.Popen[bytes], patience: float) -> None:
    """Wait some seconds for the end of a program, then end it, and all that it started."""
    for step in (None, *_ENDS):
        if step is not None:
            with contextlib.suppress(ProcessLookupError, PermissionError):
                step(process)
        with contextlib.suppress(subprocess.TimeoutExpired):
            # The supervisor itself waits before it ends what it supervises.
            process.wait(patience if step is None else patience + 2 * agent_supervisor.PATIENCE)
            break
    if os.name != "nt":
        with contextlib.suppress(ProcessLookupError, PermissionError):
            os.killpg(process.pid, signal.SIGKILL)  # those that outlived a program that ended by itself


def _ends() -> tuple[Callable[[subprocess.Popen[bytes]], None], ...]:
    """Return the calls that end a process: politely, then at once with its group, where processes have groups."""
    if os.name == "nt":
        return subprocess.Popen.terminate, subprocess.Popen.kill
    if sys.platform == "linux":
        return (subprocess.Popen.terminate, lambda process: os.killpg(process.pid, signal.SIGKILL))
    return tuple(lambda process, by=by: os.killpg(process.pid, by) for by in (signal.SIGTERM, signal.SIGKILL))


_ENDS = _ends()
