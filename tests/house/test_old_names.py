"""Modules of 0.2 can still be imported: each module by its old name, each with the public names it had.

`tests/golden/names-0.2.json` has them, as commit 48db19ba defines them; it is never refreshed.
"""

from __future__ import annotations

import ast
import json
import subprocess
import sys
import warnings
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path

import pytest

from hearth.old_names import modules

MODULES = modules()
ROOT = Path(__file__).resolve().parents[2]
NAMES = {
    module: names.split() for module, names in json.loads((ROOT / "tests/golden/names-0.2.json").read_text()).items()
}
GONE = {
    "kb.language.plan_lines": {"header"},  # `header_of(lines)`, of lines that are read already
    "pipelines.readers.ours": {"is_record"},  # in `records_in_json`
    "rendering.cameras.sight": {"unobstructed"},
    "schemas.libraries": {"SET_UP"},
    "scoring.dataset_scores": {"read_line"},  # `scoring.line_reader`
    "scoring.metrics.goals": {"SIGNATURE", "signature_of"},  # each score's signature has a version of its own
    "scoring.signature": {"VERSION"},
    "web.store": {"TRIES"},  # a store that is locked says so after `web.deadlines`
}
"""Names that have no successor of the same meaning."""


@pytest.mark.parametrize("room", sorted({module.partition(".")[0] for module in NAMES}))
def test_every_module_of_0_2_has_its_names(room):
    lost = {}
    for module in (name for name in NAMES if name.partition(".")[0] == room):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DeprecationWarning)
            try:
                found = import_module(f"hearth.{module}")
            except ImportError as error:
                if error.name in ("torch", "safetensors", "gymnasium", "pettingzoo"):
                    continue
                raise
        lost[module] = {name for name in NAMES[module] if not hasattr(found, name)}
    assert {module: names for module, names in lost.items() if names - GONE.get(module, set())} == {}


@pytest.mark.parametrize("old", MODULES)
def test_an_old_name_is_the_module_of_today(old):
    for name in (f"hearth.{old}", f"hearth.{MODULES[old]}"):
        sys.modules.pop(name, None) if name.endswith(old) else import_module(name)
    with pytest.warns(DeprecationWarning, match=f"hearth.{old} is now hearth.{MODULES[old]}") as found:
        assert import_module(f"hearth.{old}") is import_module(f"hearth.{MODULES[old]}")
    assert import_module(f"hearth.{MODULES[old]}").__spec__.name == f"hearth.{MODULES[old]}"
    assert len(found) == 1


def test_the_table_has_modules_that_moved_and_no_others():
    for old, new in MODULES.items():
        assert old in NAMES and new not in MODULES
        assert find_spec(f"hearth.{new}").submodule_search_locations is None, "a package would be imported twice"
        assert not (ROOT / f"{old.replace('.', '/')}.py").exists()


def test_a_module_that_never_was_is_not_found():
    with pytest.raises(ModuleNotFoundError, match=r"No module named 'hearth.challenges.never'"):
        import_module("hearth.challenges.never")


def test_the_warning_points_at_the_import():
    code = "import hearth\nfrom hearth.challenges import slots\nfrom hearth.challenges.slots import Slots\n"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stderr == "<string>:2: DeprecationWarning: hearth.challenges.slots is now hearth.envs.node_slots\n"


def test_a_script_runs_by_its_old_name():
    command = [sys.executable, "-W", "error::DeprecationWarning", "-m", "hearth.challenges.slots"]
    assert (
        "is now hearth.envs.node_slots" in subprocess.run(command, capture_output=True, text=True, check=False).stderr
    )
    subprocess.run([sys.executable, *command[3:]], check=True)


def test_no_file_of_ours_imports_an_old_name():
    listed = subprocess.run(["git", "ls-files", "*.py"], cwd=ROOT, capture_output=True, text=True, check=True)
    old = {f"hearth.{name}" for name in MODULES}
    for path in (ROOT / name for name in listed.stdout.split() if (ROOT / name).exists()):
        nodes = [
            node for node in ast.walk(ast.parse(path.read_text())) if isinstance(node, ast.Import | ast.ImportFrom)
        ]
        named = {alias.name for node in nodes if isinstance(node, ast.Import) for alias in node.names}
        froms = [node for node in nodes if isinstance(node, ast.ImportFrom) and node.module]
        named |= {name for node in froms for name in (node.module, *(f"{node.module}.{a.name}" for a in node.names))}
        assert not named & old, path
