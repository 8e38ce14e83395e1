"""Mutation testing: ten places of a copy are broken, one at a time: `python benchmarks/mutations.py`.

Prints for each whether the tests of its room failed. The status is 1 if they passed for any of them.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[1]
APART = (".*", "*.egg-info", "__pycache__", "build", "dist", "data_out")


class Mutation(NamedTuple):
    """A line that is made wrong, and the tests that should notice."""

    file: str
    right: str
    wrong: str
    tests: str


MUTATIONS = (
    Mutation("simulation/actions/hands.py", "reachable, free_hand, _nobody_else", "reachable, _nobody_else",
             "tests/simulation"),
    Mutation("simulation/actions/hands.py", "agent.inside & ~bit", "agent.inside", "tests/simulation"),
    Mutation("simulation/actions/appliances.py", "not_in_state(ON, Code.IS_ON)",
             "not_in_state(OFF, Code.IS_ON)", "tests/simulation"),
    Mutation("simulation/world/edge_rows.py", "row = 0 if gone >> i & 1 else row & ~gone", "row = row & ~gone",
             "tests/simulation"),
    Mutation("simulation/engine.py", "if isinstance(result, World) and now is not world:", "if False:",
             "tests/simulation tests/grounding/test_two_agents.py"),
    Mutation("repair/handlers/appliances.py", 'context.does("SwitchOff", context.object())',
             'context.does("SwitchOn", context.object())', "tests/repair"),
    Mutation("repair/handlers/appliances.py", 'return walked_to(context, "inside_closed", container, opened)',
             'return walked_to(context, "inside_closed", container)', "tests/repair"),
    Mutation("repair/repair_trimming.py", 'return _last_walk(steps, number, walks) == step.objects and',
             "return False and", "tests/repair"),
    Mutation("scoring/metrics/lcs.py", "longest = max(len(a), len(b))",
             "longest = min(len(a), len(b))", "tests/scoring"),
    Mutation("scoring/metrics/graph_f1.py", "return cls(states.prf(), relations.prf(), (states + relations).prf()",
             "return cls(states.prf(), states.prf(), (states + relations).prf()", "tests/scoring"),
)  # fmt: skip


def noticed(copy: Path, mutation: Mutation) -> bool:
    """Return whether the tests fail while the copy has the fault."""
    file = copy / mutation.file
    text = file.read_text("utf-8")
    if text.count(mutation.right) < 1:
        raise SystemExit(f"{mutation.file} has no `{mutation.right}` any more: name another place in MUTATIONS")
    file.write_text(text.replace(mutation.right, mutation.wrong, 1), "utf-8")
    try:
        return not passes(copy, mutation.tests)
    finally:
        file.write_text(text, "utf-8")


def passes(copy: Path, tests: str) -> bool:
    """Return whether the quick tests of some folders pass, with the package taken from the copy."""
    place = copy.parent
    code = (
        f"import sys; sys.path.insert(0, {str(place)!r}); import pytest; "
        f"sys.exit(pytest.main(['-x', '-q', '-p', 'no:cacheprovider', '-m', 'not slow', *{tests.split()!r}]))"
    )
    environment = {**os.environ, "PYTHONPATH": str(place), "PYTHONDONTWRITEBYTECODE": "1"}
    done = subprocess.run([sys.executable, "-c", code], cwd=copy, env=environment, capture_output=True, check=False)
    return done.returncode == 0


def main() -> int:
    """Break each place in turn."""
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder, "site/hearth")
        shutil.copytree(ROOT, copy, ignore=shutil.ignore_patterns(*APART))
        broken = [tests for tests in sorted({m.tests for m in MUTATIONS}) if not passes(copy, tests)]
        if broken:
            print(f"the tests fail as they are: {', '.join(broken)}")
            return 1
        found = 0
        for mutation in MUTATIONS:
            seen = noticed(copy, mutation)
            found += seen
            print(f"{'noticed' if seen else 'MISSED ':8} {mutation.file}: {mutation.right}", flush=True)
    print(f"{found} of {len(MUTATIONS)} faults noticed")
    return 0 if found == len(MUTATIONS) else 1


if __name__ == "__main__":
    sys.exit(main())
