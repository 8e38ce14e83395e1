"""An install without extras loads, checks, queries, scores and builds, without pictures."""

from __future__ import annotations

import json
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from hearth.commands import doctor
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.optional_libraries import EXTRAS, library, remedy
from hearth.version import DISTRIBUTION

ROOT = Path(__file__).resolve().parents[2]

PROGRAM = "Watch TV\nSit down.\n\n\n[Walk] <sofa> (1)\n[Sit] <sofa> (1)\n[Watch] <television> (1)\n"

WORK = (
    "check watch.txt",
    "run watch.txt --home maple --sample",
    "build watch.txt --out out --home maple --variants 1 --pictures 1 --videos 1 --workers 1 --strict",
    "query out 'SELECT stage, code, suggestion FROM rejects' --json",
    "query out 'SELECT records_rejected, record FROM ledger ORDER BY \"order\"' --json",
    "verify out --workers 1",
    "score dataset out predictions.jsonl --json",
    "report out --out report",
    "export out --format networkx --out graphs",
    "repair watch.txt --home maple",
    "home show maple --out maple.svg",
    "environment sample watch.txt --home maple --out environment.json",
    "corpus stats watch.txt",
    "kb show fridge",
    "doctor",
)
"""Commands that need no pictures."""

DRAWING = (
    "render-program watch.txt --home maple --out pictures",
    "home show maple --out maple.png",
    "corpus stats watch.txt --out figures",
)
"""Commands that draw, with arguments that get as far as drawing."""

SCRIPT = """
import json, shlex, sys
from pathlib import Path

BLOCKED = {
    "cv2", "dash", "gymnasium", "llvmlite", "matplotlib", "numba", "open3d", "pettingzoo", "PIL", "plotly", "rdflib",
}

class Blocker:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in BLOCKED:
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)

sys.meta_path.insert(0, Blocker())
import hearth
from hearth import cli
from typer.testing import CliRunner

found = {}
for line in json.loads(sys.argv[1]):
    if line.startswith("score"):
        dataset = hearth.load("out")
        runs = [run for name in dataset for run in dataset[name].runs]
        rows = [{"id": run.row["execution_id"], "predicted": ["[Walk] <sofa> (1)"]} for run in runs]
        Path("predictions.jsonl").write_text("".join(json.dumps(row) + "\\n" for row in rows))
    result = CliRunner().invoke(cli.app, shlex.split(line))
    found[line] = [result.exit_code, result.output, result.stdout]
print(json.dumps(found))
"""


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    """Exit status, output and standard output of every command, in a process without libraries for pictures."""
    folder = tmp_path_factory.mktemp("light")
    (folder / "watch.txt").write_text(PROGRAM)
    command = [sys.executable, "-c", SCRIPT, json.dumps([*WORK, *DRAWING])]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


@pytest.mark.parametrize("line", WORK)
def test_commands_without_pictures_work(results, line):
    status, output, _ = results[line]
    assert status == 0, output


@pytest.mark.parametrize("line", DRAWING)
def test_commands_that_draw_report_what_to_install(results, line):
    status, output, _ = results[line]
    assert status == 1
    assert re.search(r"this needs \w+, which is not installed", output), output
    assert "pip install '.[pictures]'" in output and "Traceback" not in output


def test_models_of_texts_and_sketches_need_no_pictures(tmp_path):
    pytest.importorskip("torch")
    lines = [
        "model list",
        "model show mle-composed 'Turn on the TV and sit down' --home maple",
        "model show mle-composed 'Turn on the TV and sit down' --home maple --writer chooser",
    ]
    command = [sys.executable, "-c", SCRIPT, json.dumps(lines)]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert [status for status, *_ in json.loads(done.stdout).values()] == [0, 0, 0], done.stdout


def test_a_build_without_pictures_refuses_nothing_and_records_that_they_are_left_out(results):
    build, rejects, ledger = (results[line] for line in WORK if line.startswith(("build", "query")))
    assert "pictures are left out: cv2, matplotlib, numba, open3d not installed" in build[1]
    assert "pip install '.[pictures]'" in build[1]
    assert not json.loads(rejects[2])
    rows = json.loads(ledger[2])
    assert [row["records_rejected"] for row in rows] == [0] * 6
    assert rows[4]["record"].endswith("1 left out: cv2, matplotlib, numba, open3d not installed")


def test_the_doctor_lists_the_missing_extra(results):
    assert "without cv2, matplotlib, numba, open3d" in " ".join(results["doctor"][1].split())


def test_a_library_of_no_extra_is_a_fault_of_ours():
    with pytest.raises(ModuleNotFoundError):
        library("no_such_library")


def test_a_missing_library_of_an_extra_is_named(monkeypatch):
    for name in ("fsspec", "fsspec.core"):  # torch brings it
        monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(HearthError, match=r"this needs fsspec, which.*pip install '\.\[remote\]'"):
        library("fsspec.core")


def test_a_wheel_says_its_own_name(monkeypatch, tmp_path):
    assert "'.[pictures]'" in remedy("pictures")
    monkeypatch.setattr("hearth.schemas.optional_libraries.CHECKOUT", tmp_path / "pyproject.toml")
    assert remedy("pictures") == "run `pip install 'hearth-home-programs[pictures]'`"


@pytest.mark.parametrize("module", ["parallel", "single"])
def test_without_their_libraries_the_environments_say_what_to_install(module):
    names = ("gymnasium", "pettingzoo")
    code = f"import sys\nsys.modules.update(dict.fromkeys({names}))\nimport hearth.challenges.{module}"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert re.search(r"this needs \w+, which is not installed", done.stderr)
    assert "run `make setup` in a checkout, else `pip install '.[agents]'`" in done.stderr


def test_an_environment_of_one_learner_needs_no_pettingzoo():
    pytest.importorskip("gymnasium", reason="the extra `agents` is not installed")
    code = "import sys\nsys.modules['pettingzoo'] = None\nimport hearth.envs.gymnasium_env"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_extras_are_those_of_the_package():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    assert set(EXTRAS) <= set(project["optional-dependencies"])
    base = " ".join(project["dependencies"])
    assert not [line for line in project["optional-dependencies"]["pictures"] if re.split(r"[><=;]", line)[0] in base]


def test_the_setup_installs_what_pictures_and_environments_need():
    locked = (ROOT / "requirements.lock").read_text()
    assert all(f"{name}==" in locked for name in ("open3d-cpu", "opencv-python-headless", "numba", "matplotlib"))
    assert all(f"{name}==" in locked for name in ("gymnasium", "pettingzoo"))
    assert ".[agents,pictures,web,test]" in (ROOT / "setup.sh").read_text()


def test_no_text_installs_the_package_of_somebody_else():
    """`hearth` on the Python index is not ours."""
    assert tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["name"] == DISTRIBUTION
    files = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True).stdout.split()
    wrong = re.compile(r"(pip3?|uv|pipx|poetry|conda)\s+(install|add)\b[^`\n]*?(?<![\w./-])hearth(?!-home-programs)\b")
    texts = {path: path.read_text("utf-8", "replace") for name in files if (path := ROOT / name).is_file()}
    found = [path for path, text in texts.items() if path != Path(__file__).resolve() and wrong.search(text)]
    assert wrong.search("pip install 'hearth[dask]'") and wrong.search("pip install hearth")
    assert not wrong.search(f"pip install {DISTRIBUTION}") and not wrong.search("cd hearth; pip install .")
    assert not found


def test_versions_are_looked_up_by_import_not_by_distribution(monkeypatch):
    """A checkout that was set up under another name of the distribution keeps working."""
    asked = []
    monkeypatch.setattr(doctor.importlib.metadata, "packages_distributions", lambda: {"hearth": ["any-name"]})
    monkeypatch.setattr(doctor.importlib.metadata, "requires", lambda name: asked.append(name) or ["numpy>=1"])
    assert doctor.packages().state == doctor.OK
    assert asked == ["any-name"]
