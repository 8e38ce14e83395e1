"""The chat server of transformers, with a tiny model that is made for it: random weights, and nothing is fetched."""

from __future__ import annotations

import os
import socket
import subprocess
import time
from contextlib import contextmanager
from pathlib import Path
from urllib.error import URLError
from urllib.request import urlopen

ROOT = Path(__file__).resolve().parents[1]
ENVIRONMENT = ROOT / ".venv/transformers/bin"
MADE_BY = "`make .venv/transformers/.ready`"

TINY = "tiny"
"""The name of the model at the server, which is that of its folder."""

PATIENCE = 300.0
"""Seconds in which the server begins to answer; libraries are compiled at the first start."""


def is_installed():
    """Return whether the environment of the server and torch are installed."""
    return (ENVIRONMENT.parent / ".ready").exists()


@contextmanager
def transformers_server(folder):
    """Yield the model's name and the server's address; the model is written to the folder."""
    variables = {**os.environ, "HF_HUB_OFFLINE": "1", "OMP_NUM_THREADS": "1", "HF_HOME": str(folder / "hub")}
    made = [ENVIRONMENT / "python", ROOT / "tests/tiny_transformer.py", folder / TINY]
    subprocess.run(made, env=variables, check=True, timeout=PATIENCE, capture_output=True)
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    words = ["serve", TINY, "--device", "cpu", "--host", "127.0.0.1", "--port", str(port)]
    with (folder / "log").open("wb") as log:
        server = subprocess.Popen(
            [ENVIRONMENT / "transformers", *words], cwd=folder, env=variables, stdout=log, stderr=log
        )
    try:
        _wait(server, f"http://127.0.0.1:{port}/health", folder / "log")
        yield TINY, f"http://127.0.0.1:{port}/v1"
    finally:
        server.terminate()
        server.wait(30)


def _wait(server, address, log):
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        assert server.poll() is None, log.read_text()
        try:
            with urlopen(address, timeout=5):
                return
        except (URLError, TimeoutError, ConnectionError):
            time.sleep(0.2)
    raise AssertionError(f"the server does not answer: {log.read_text()}")
