"""Run the simulation's benchmarks: `python benchmarks/simulation_speed.py`, the same as `pytest benchmarks`."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

if __name__ == "__main__":
    options = ["--benchmark-only", "--benchmark-disable-gc", "--benchmark-columns=median,iqr,rounds", "-q"]
    sys.exit(pytest.main([str(Path(__file__).parent), *options, *sys.argv[1:]]))
