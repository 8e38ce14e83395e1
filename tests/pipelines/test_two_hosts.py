"""Workers that share nothing but a network and a folder build the same bytes."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

SCRIPT = Path(__file__).resolve().parents[2] / "benchmarks/two_hosts.py"


@pytest.mark.tools
def test_two_workers_in_network_namespaces_build_the_same_bytes(module):
    pytest.importorskip("distributed")
    hosts = module("benchmarks/two_hosts.py")
    if reason := hosts.permitted():
        pytest.skip(reason)
    command = [sys.executable, SCRIPT, "--limit", "20"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=900, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "host-1 at tcp://10.77.0.2" in done.stdout
    assert "host-2 at tcp://10.77.0.3" in done.stdout
    assert "0 files differ" in done.stdout
