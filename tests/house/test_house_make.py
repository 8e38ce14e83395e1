"""The Makefile and the set-up script, with a Python that only writes down what it was asked to do."""

import os
import re
import shutil
import subprocess
from itertools import pairwise
from pathlib import Path

import pytest

from hearth.pipelines.engine.dependencies import files_of
from hearth.pipelines.engine.stages import STAGES
from hearth.version import VERSION

ROOT = Path(__file__).resolve().parents[2]
FOLDERS = (
    "schemas", "storage", "kb", "homes", "simulation", "grounding", "repair", "rendering", "datasets", "pipelines",
    "data_raw",
)  # fmt: skip
FILES = ("Makefile", "setup.sh", "requirements.lock", "pyproject.toml", "version.py", "cli.py")
NAMES = list(STAGES)

PYTHON = """#!/bin/bash
# Stands in for .venv/bin/python: notes each command and, for a stage, writes its manifest.
echo "$@" >> calls
case "$2 $3" in
    "build --only") mkdir -p "$6/$4" && echo "{}" > "$6/$4/manifest.json" ;;
    build*) echo "the funnel" ;;
    doctor*) echo -n "$LACKING" ;;
esac
"""


def empty_copy(source, target):
    """The files of a folder by name and time, without their content: all that make looks at."""
    for path in source.rglob("*"):
        if path.is_file() and "__pycache__" not in path.parts:
            copy = target / path.relative_to(source)
            copy.parent.mkdir(parents=True, exist_ok=True)
            copy.touch()
            os.utime(copy, (1_000_000_000, 1_000_000_000))


def executable(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    path.chmod(0o755)


@pytest.fixture(scope="module")
def template(tmp_path_factory):
    """A tree that looks like the project to make, set up and not yet built."""
    tmp_path = tmp_path_factory.mktemp("tree")
    for folder in FOLDERS:
        empty_copy(ROOT / folder, tmp_path / folder)
    for file in FILES:
        shutil.copy(ROOT / file, tmp_path / file)
        os.utime(tmp_path / file, (1_000_000_000, 1_000_000_000))
    executable(tmp_path / ".venv/bin/python", PYTHON)
    (tmp_path / ".venv/.ready").touch()
    return tmp_path


@pytest.fixture
def tree(template):
    """The same, with nothing built and nothing newer than anything else."""
    shutil.rmtree(template / "data_out", ignore_errors=True)
    for path in template.rglob("*"):
        if path.is_file() and ".venv" not in path.parts:
            os.utime(path, (1_000_000_000, 1_000_000_000))
    return template


@pytest.fixture
def built(tree):
    """The same with all stages built, in order, long ago."""
    for number, name in enumerate(NAMES):
        path = tree / f"data_out/{name}/manifest.json"
        path.parent.mkdir(parents=True)
        path.touch()
        os.utime(path, (1_500_000_000 + number, 1_500_000_000 + number))
    return tree


def make(tree, *arguments, **environment):
    """Run make; its output, and the stages it ran."""
    calls = tree / "calls"
    calls.unlink(missing_ok=True)
    variables = {**os.environ, "MAKEFLAGS": "", "MAKELEVEL": "", **environment}
    done = subprocess.run(
        ["make", *arguments], cwd=tree, env=variables, capture_output=True, text=True, check=False, timeout=60
    )
    assert done.returncode == 0, done.stderr
    lines = calls.read_text().splitlines() if calls.exists() else []
    return done.stdout, [line.split()[3] for line in lines if line.split()[1:3] == ["build", "--only"]]


def touch(path):
    os.utime(path, (1_600_000_000, 1_600_000_000))


@pytest.mark.parametrize(("made_in", "again"), [("", False), ("{tree}", False), ("/home/somebody/hearth", True)])
def test_make_sets_up_again_in_a_copy(tree, made_in, again):
    ready = tree / ".venv/.ready"
    ready.write_text(f"{made_in.format(tree=tree)}\n" if made_in else "")
    shown, _ = make(tree, "--dry-run", "setup")
    ready.write_text("")
    assert ("setup.sh" in shown) == again


def test_make_runs_all_stages_in_order_ends_with_the_funnel_and_then_does_nothing(tree):
    shown, ran = make(tree)
    assert ran == NAMES
    assert shown.endswith("the funnel\n")
    shown, ran = make(tree)
    assert ran == []
    assert "Nothing to be done" in shown


@pytest.mark.parametrize(
    ("raw", "first"),
    [
        ("data_raw/crowd/programs.csv", "ingest"),
        ("data_raw/crowd/descriptions.csv", "ingest"),
        ("data_raw/homes/maple.yaml", "sample"),
        ("kb/data/actions.yaml", "ingest"),
        ("rendering/models/looks.yaml", "render"),
        ("pipelines/publish.py", "publish"),
        ("setup.sh", None),
    ],
)
def test_touching_a_file_rebuilds_only_what_follows_from_it(built, raw, first):
    touch(built / raw)
    assert make(built)[1] == (NAMES[NAMES.index(first) :] if first else [])


def test_a_missing_stage_is_built_again_with_what_follows(built):
    (built / "data_out/augment/manifest.json").unlink()
    assert make(built)[1] == ["augment", "render", "publish"]


@pytest.mark.parametrize(("target", "tables"), [("tables", "4.4 4.5 5.2 5.3 5.4"), ("film-tables", "4.2 4.3 4.3b 4.6")])
def test_tables_are_made_that_a_target_names_and_no_others(built, target, tables):
    shown, _ = make(built, "-n", target)
    assert re.findall(r"--table (\S+)", shown) == tables.split()


@pytest.fixture(scope="module")
def prerequisites(template):
    """Return the prerequisites of each stage's manifest, its own or through earlier stages, as make has them."""
    done = subprocess.run(["make", "-pn"], cwd=template, capture_output=True, text=True, check=False, timeout=60)
    rules = dict(line.split(":", 1) for line in done.stdout.splitlines() if line.startswith("data_out/"))
    found, before = {}, set()
    for name in NAMES:
        before = before | set(rules[f"data_out/{name}/manifest.json"].split())
        found[name] = before
    return found


@pytest.mark.parametrize("name", NAMES)
def test_a_stage_depends_on_all_that_it_imports(prerequisites, name):
    assert files_of(f"hearth.pipelines.{name}") <= prerequisites[name]


def test_a_stage_by_its_name_stops_there(tree):
    assert make(tree, "sample")[1] == NAMES[:3]


def test_full_is_built_by_each_strength(tree):
    make(tree, "full")
    calls = [line.split() for line in (tree / "calls").read_text().splitlines()]
    assert calls[0][1:3] == ["corpus", "synthesize"]
    made = [dict(pairwise(call)) for call in calls if call[1] == "build"]
    assert [(call["--strength"], call["--tier"]) for call in made] == [("mild", "full"), ("thesis", "full")]
    assert [call["--out"] for call in made] == ["data_out/full", "data_out/full-thesis"]


def test_clean_removes_what_was_built_and_nothing_else(tree):
    make(tree, "OUT=data_out")
    (tree / "data_out/mine.txt").touch()
    make(tree, "clean")
    assert [path.name for path in (tree / "data_out").iterdir()] == ["mine.txt"]
    assert (tree / ".venv/bin/python").exists() and (tree / "data_raw/crowd/programs.csv").exists()


def test_help_explains_every_target(tree):
    shown, _ = make(tree, "help")
    phony = next(line for line in (ROOT / "Makefile").read_text().splitlines() if line.startswith(".PHONY"))
    for target in phony.split()[1:]:
        if target != "$(STAGES)":
            assert f"  {target} " in shown, target


def test_continuous_integration_runs_what_a_contributor_runs():
    lines = [line for line in (ROOT / ".ci/run").read_text().splitlines() if line and not line.startswith("#")]
    assert lines[-1] == "exec make test"


SYSTEM_PYTHON = """#!/bin/bash
# Stands in for python3: a version that fits, and an empty virtual environment.
if [ "$1" = "-m" ] && [ "$2" = "venv" ]; then
    mkdir -p .venv/bin && cp fake .venv/bin/python
fi
"""


@pytest.fixture
def bare(tmp_path):
    """A tree that is not set up, on a machine with a `python3`, and an `id` that says who one is."""
    tree = tmp_path
    for file in ("setup.sh", "requirements.lock"):
        shutil.copy(ROOT / file, tree / file)
    executable(tree / "fake", PYTHON)
    executable(tree / "bin/python3", SYSTEM_PYTHON)
    executable(tree / "bin/id", "#!/bin/sh\necho $USER_ID\n")
    executable(tree / "bin/apt-get", "#!/bin/sh\necho apt-get $* >> calls\n")
    for tool in ("bash", "sh", "cp", "mkdir", "touch", "rm", "tr", "dirname", "env", "timeout", "cat"):
        (tree / "bin" / tool).symlink_to(shutil.which(tool))
    return tree


def set_up(tree, **environment):
    variables = {"PATH": str(tree / "bin"), "HOME": str(tree), "USER_ID": "1000", "LACKING": "", **environment}
    done = subprocess.run(
        ["bash", "setup.sh"], cwd=tree, env=variables, capture_output=True, text=True, check=False, timeout=60
    )
    return done, (tree / "calls").read_text() if (tree / "calls").exists() else ""


def test_set_up_uses_pip_and_the_lock(bare):
    done, calls = set_up(bare)
    assert done.returncode == 0, done.stderr
    assert "--no-deps --require-hashes -r requirements.lock" in calls and "--no-deps --no-build-isolation -e ." in calls
    assert (bare / ".venv/.ready").exists()
    assert "apt-get" not in calls + done.stderr


def test_set_up_begins_anew_in_a_copy(bare):
    """Its `.venv` has the commands of the folder that it was copied from."""
    set_up(bare)
    assert (bare / ".venv/.ready").read_text() == f"{bare}\n"
    (bare / ".venv/of_the_original").touch()
    set_up(bare)
    assert (bare / ".venv/of_the_original").exists()
    (bare / ".venv/.ready").write_text("/home/somebody/hearth\n")
    done, _ = set_up(bare)
    assert "it was set up in /home/somebody/hearth" in done.stderr
    assert not (bare / ".venv/of_the_original").exists()
    assert (bare / ".venv/.ready").read_text() == f"{bare}\n"


@pytest.mark.parametrize("tool", ["pip", "uv and pip"])
def test_set_up_ends_where_a_hash_does_not_fit(bare, tool):
    """Nothing else is installed in place of the lock, and the tree does not count as set up."""
    refusing = PYTHON.replace(
        "#!/bin/bash\n", '#!/bin/bash\ncase "$*" in *requirements.lock*) echo "$*" >> calls; exit 1;; esac\n'
    )
    assert refusing != PYTHON
    executable(bare / "fake", refusing)
    if tool != "pip":
        executable(bare / "bin/uv", "#!/bin/sh\necho uv $* >> calls\nexit 1\n")
    done, calls = set_up(bare)
    assert done.returncode == 1
    assert "does not fit its hash" in done.stderr
    assert not (bare / ".venv/.ready").exists()
    assert " -e " not in calls


def test_nothing_is_installed_without_a_hash():
    """In `setup.sh`, the image and the workflow, every file of an index has a hash; ours is installed alone."""
    for name in ("setup.sh", "Containerfile", ".github/workflows/ci.yml"):
        for line in (ROOT / name).read_text().replace("\\\n", " ").splitlines():
            for words in re.findall(r"(?:pip install|with_uv|with_pip) ([^&|]*)", line.partition("#")[0]):
                shown = "say " in line or '"$@"' in line
                assert shown or "--require-hashes" in words or "--no-deps" in words, (name, line)


def test_actions_are_pinned_by_their_commit():
    text = (ROOT / ".github/workflows/ci.yml").read_text()
    used = re.findall(r"uses: (\S+)", text)
    assert used and all(re.fullmatch(r"[\w/-]+@[0-9a-f]{40}", each) for each in used)


def test_set_up_prefers_uv(bare):
    executable(bare / "bin/uv", "#!/bin/sh\necho uv $* >> calls\nmkdir -p .venv/bin && cp fake .venv/bin/python\n")
    done, calls = set_up(bare)
    assert done.returncode == 0, done.stderr
    assert "uv venv" in calls and "uv pip install" in calls and "-m pip" not in calls


def test_set_up_falls_back_on_pip_where_uv_fails(bare):
    executable(bare / "bin/uv", "#!/bin/sh\nexit 1\n")
    done, calls = set_up(bare)
    assert done.returncode == 0, done.stderr
    assert "-m pip install" in calls


def test_set_up_prints_the_one_line_to_run_where_it_may_not_install_libraries(bare):
    done, calls = set_up(bare, LACKING="libgl1\nlibegl1\n")
    assert done.returncode == 0, done.stderr
    assert "sudo apt-get install libgl1 libegl1" in done.stderr
    assert "apt-get" not in calls
    assert (bare / ".venv/.ready").exists()


def test_set_up_installs_libraries_where_it_may(bare):
    done, calls = set_up(bare, LACKING="libgl1\nlibegl1\n", USER_ID="0")
    assert done.returncode == 0, done.stderr
    assert "apt-get install -y -qq --no-install-recommends libgl1 libegl1" in calls
    assert "sudo" not in done.stderr


def test_set_up_goes_on_when_apt_fails(bare):
    executable(bare / "bin/apt-get", "#!/bin/sh\nexit 100\n")
    done, _ = set_up(bare, LACKING="libgl1\n", USER_ID="0")
    assert done.returncode == 0
    assert "sudo apt-get install libgl1" in done.stderr


def test_set_up_says_which_python_is_needed(bare):
    executable(bare / "bin/python3", "#!/bin/sh\nexit 1\n")
    done, _ = set_up(bare)
    assert done.returncode == 1
    assert "Python 3.11 to 3.14" in done.stderr
    assert not (bare / ".venv/.ready").exists()


def test_set_up_says_what_debian_leaves_out(bare):
    executable(
        bare / "bin/python3",
        '#!/bin/bash\n[ "$2" = venv ] && exit 1\n[[ "$2" == *print* ]] && echo python3.11-venv\nexit 0\n',
    )
    done, _ = set_up(bare)
    assert done.returncode == 1
    assert "sudo apt-get install python3.11-venv" in done.stderr
    assert not (bare / ".venv").exists()


def test_the_citation_and_the_change_log_name_this_version():
    assert f"\nversion: {VERSION}\n" in (ROOT / "CITATION.cff").read_text()
    assert f"\n## {VERSION} " in (ROOT / "CHANGELOG.md").read_text()


def test_every_library_of_the_locks_has_a_line_on_the_page_of_licences(module):
    made = module("docs/hooks/licences.py")
    text = made.PAGE.read_text("utf-8")
    for lock in made.LOCKS:
        names = made.locked(lock)
        lost = [name for name in names if not re.search(rf"^\| {re.escape(name)} \| \S", text, re.M)]
        assert len(names) > 40 and not lost, "write it with: make licences"


@pytest.mark.parametrize("file", ["requirements.lock", "requirements-tools.lock", "requirements-transformers.lock"])
def test_the_lock_pins_everything_with_hashes_and_says_nothing_of_where_it_came_from(file):
    text = (ROOT / file).read_text()
    assert "://" not in text and "@" not in text
    pins = text.replace("\\\n", "").splitlines()
    pins = [line for line in pins if not line.startswith("#")]
    assert len(pins) > 40
    for line in pins:
        found = re.fullmatch(r"[\w.\[\]-]+==[\w.!+]+(?: ; [^-]+?)?((?: +--hash=sha256:[0-9a-f]{64})+) *", line)
        assert found, line[:80]
