"""Strange input to commands and to the library: what is wrong is said, never where in our code it broke."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pyarrow.parquet as pq
import pytest
from typer.testing import CliRunner

import hearth
from hearth.cli import STOPPED, TERMINATED, app
from hearth.datasets.dataset import Dataset
from hearth.pipelines.engine.dask_engine import DaskEngine
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.graph import from_release
from hearth.schemas.numbers import number_of, stored
from hearth.storage.lock import locked

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def run():
    def call(*arguments, status=0):
        result = CliRunner().invoke(app, list(map(str, arguments)))
        assert result.exception is None or isinstance(result.exception, SystemExit), result.exception
        assert result.exit_code == status, result.output
        return result.output

    return call


@pytest.mark.parametrize(
    ("question", "shown", "value"),
    [
        ("TIMESTAMPTZ '2026-01-02 03:04:05+00'", "2026-01-02", "2026-01-02"),
        ("[TIMESTAMPTZ '2026-01-02 03:04:05+00']", "2026-01-02", "2026-01-02"),
        ("INTERVAL 3 DAY", "3 days", "3 days"),
        ("1.5::DECIMAL(10, 2)", "1.5", "1.5"),
        (
            "170141183460469231731687303715884105727::HUGEINT",
            "170141183460469231731687303715884105727",
            "1701411834604692317",
        ),
        ("[{'a': 2::HUGEINT * 9223372036854775807}]", "18446744073709551614", "18446744073709551614"),
        ("'a'::BLOB", "a", "a"),
        ("MAP {1: TIMESTAMPTZ '2026-01-02 03:04:05+00'}", "2026-01-02", "2026-01-02"),
        ("'5874897-01-01'::DATE", "5874897", "5874897"),
    ],
)
def test_values_of_every_kind(run, made, question, shown, value):
    assert shown in run("query", made.out, f"SELECT {question} AS found")
    assert value in str(json.loads(run("query", made.out, f"SELECT {question} AS found", "--json"))[0]["found"])


def test_now_is_answered(run, made):
    assert len(run("query", made.out, "SELECT now() AS a, 1 AS a").splitlines()) == 2


def test_control_characters_do_not_reach_the_terminal(run, made):
    question = "SELECT chr(27) || '[31mred' || chr(7) || chr(155) || chr(8238) || 'é' AS \"a\x1b]0;b\""
    output = run("query", made.out, question)
    assert "\\x1b[31mred\\x07\\x9b\\u202eé" in output and "a\\x1b]0;b" in output
    assert not {"\x1b", "\x07", "\x9b", "\u202e"} & {*output}
    assert json.loads(run("query", made.out, question, "--json")) == [{"a\x1b]0;b": "\x1b[31mred\x07\x9b\u202eé"}]
    said = run("query", made.out, "SELECT error(chr(27) || '[2J')", status=1)
    assert "\x1b" not in said and "\\x1b[2J" in said


@pytest.mark.parametrize("number", ["²", "9" * 5_000, str(2**64), "-1", "1_0", "٣", "", "1.5"])
def test_numbers_of_nodes_that_are_none(run, number):
    for option, text in (("--move", f"144:on:{number}"), ("--move", f"{number}:on:144"), ("--set", f"{number}:OPEN"),
                         ("--add", f"cup:on:{number}")):  # fmt: skip
        output = run("home", "edit", "maple", option, text, "--out", "x.json", status=1)
        assert "is not a node id" in output and len(output) < 500


def test_which_texts_are_numbers():
    assert [number_of(text) for text in ("0", "12", str(2**31 - 1), str(2**31), "²", "", "1" * 5000)] == [
        0, 12, 2**31 - 1, None, None, None, None,
    ]  # fmt: skip
    assert stored("7") == 7
    for value in (2**31, -(2**31), 1e300, float("inf")):
        with pytest.raises(ValueError, match="32 bits"):
            stored(value)


ROOM = {"id": 1, "class_name": "kitchen", "category": "Rooms"}
PERSON = {"id": 2, "class_name": "character", "category": "Characters"}
CUP = {"id": 3, "class_name": "cup", "category": "Props"}


def edge(source, relation, target):
    return {"from_id": source, "relation_type": relation, "to_id": target}


def graph(**changed):
    return {"nodes": [ROOM, PERSON, {**CUP, **changed}], "edges": [edge(2, "INSIDE", 1)]}


BAD_GRAPHS = {
    **{f"id {value!r}": graph(id=value) for value in (2**64 - 1, 2**62, 2**31, -(2**40), 1e30, "9" * 30, None, [3])},
    **{f"class {value!r}": graph(class_name=value) for value in (None, 7, ["cup"], {"cup": 1})},
    **{f"states {value!r}": graph(states=value) for value in ("OPEN", 5, [1], [None], [["OPEN"]])},
    **{f"properties {value!r}": graph(properties=value) for value in ("GRABBABLE", 5, [{}])},
    **{f"other {name}": graph(**{name: value}) for name, value in
       (("prefab_name", 7), ("yaw", "north"), ("yaw", True), ("category", 4), ("bounding_box", 7),
        ("bounding_box", {"center": [1, 2], "size": [1, 2, 3]}))},
    **{f"edge {wrong!r}": {**graph(), "edges": [edge(2, "INSIDE", 1), edge(*wrong)]} for wrong in
       (("3", "INSIDE", 1), (3, 7, 1), (3, None, 1), ([1], "ON", 1), (3, "ON", 2**64 - 1), (3.5, "ON", 1), (3, [], 1),
        (True, "ON", 1))},
    "nodes are an object": {"nodes": {"a": 1}, "edges": []},
    "nodes are a number": {"nodes": 5, "edges": []},
    "edges are a number": {"nodes": [ROOM], "edges": 7},
    "a node is a number": {"nodes": [1, 2], "edges": []},
}  # fmt: skip


@pytest.mark.parametrize("name", BAD_GRAPHS)
def test_graphs_of_mixed_types_are_refused_with_a_reason(run, built, write, name):
    path = write("scene.json", json.dumps(BAD_GRAPHS[name]))
    made = built(path)
    made.run("ingest")
    assert [code for _, code in made.codes("ingest")] == ["BAD_GRAPH"]
    for command in (("lint", path), ("show", path), ("convert", path, path.with_name("x.json"))):
        run("home", *command, status=1)
    with pytest.raises(HearthError):
        from_release(BAD_GRAPHS[name])


ODD_GRAPHS = {
    "only a room": {"nodes": [ROOM], "edges": []},
    "nothing": {"nodes": [], "edges": []},
    "nobody": {"nodes": [ROOM, CUP], "edges": [edge(3, "INSIDE", 1)]},
    "inside itself": {**graph(), "edges": [edge(3, "INSIDE", 3), edge(1, "INSIDE", 3), edge(3, "INSIDE", 1)]},
    "one id twice": {"nodes": [ROOM, PERSON, CUP, CUP], "edges": []},
    "escapes": graph(class_name="\x1b[31mcup"),
}


@pytest.mark.parametrize("name", ODD_GRAPHS)
def test_odd_graphs_are_read_or_refused(tmp_path, name):
    path, program = tmp_path / "scene.json", tmp_path / "p.txt"
    path.write_text(json.dumps(ODD_GRAPHS[name]))
    program.write_text("Drink\nTea.\n\n\n[Walk] <kitchen> (1)\n[Walk] <cup> (1)\n[Grab] <cup> (1)\n")
    for command in (("home", "lint", path), ("home", "show", path), ("run", program, "--graph", path),
                    ("home", "edit", path, "--add", "cup:on:1"), ("home", "stats", path)):  # fmt: skip
        result = CliRunner().invoke(app, list(map(str, command)))
        assert result.exception is None or isinstance(result.exception, HearthError | SystemExit), result.exception
        assert result.exit_code in (0, 1, 2) and "\x1b" not in result.output


def test_a_graph_in_which_nobody_is_says_so(run, tmp_path):
    (tmp_path / "room.json").write_text(json.dumps(ODD_GRAPHS["only a room"]))
    (tmp_path / "p.txt").write_text("Go\nThere.\n\n\n[Walk] <kitchen> (1)\n")
    printed = run("run", tmp_path / "p.txt", "--graph", tmp_path / "room.json", status=1)
    assert "error[BAD_GRAPH]: nobody is in the home `room`" in printed


@pytest.mark.parametrize("odd", ["\u2028", "\u2029", "\f", "\v", "\x1c", "\x85"])
def test_only_line_ends_end_lines(run, tmp_path, odd):
    path = tmp_path / "p.txt"
    text = f"Sit{odd}down\nOn it.{odd}\n\n\n[Walk] <sofa> (1)\n[Sit] <sofaa> (1)\n[Nonsense] <sofa> (1)\n"
    path.write_text(text, newline="")
    output = run("check", path, status=1)
    assert f"{path}:6:" in output and f"{path}:7:" in output and "[Sit] <sofaa>" in output
    run("check", "--fix", path, status=1)
    assert path.read_bytes().decode() == text.replace("<sofaa>", "<sofa>")


def test_dask_that_is_not_installed_is_named(monkeypatch):
    for name in ("dask", "distributed", "distributed.scheduler"):
        monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(HearthError, match=r"pip install '\.\[dask\]'"):
        next(DaskEngine(2).run(None, iter(()), None))


@pytest.fixture
def copy(made, tmp_path):
    return shutil.copytree(made.out / "publish", tmp_path / "copy")


READINGS = {
    "its ids": list,
    "its length": len,
    "a program": lambda ds: ds["crowd:P1"].program,
    "a graph": lambda ds: [run.final for run in ds["crowd:P1"].runs],
    "a table": lambda ds: ds.programs,
    "a question": lambda ds: ds.rows("SELECT * FROM programs JOIN executions USING (program_id)"),
    "its knowledge": lambda ds: ds.knowledge,
    "arrays": lambda ds: ds.to_tensors(["crowd:P1"]),
}

DAMAGES = {
    "cut short": lambda path: path.write_bytes(path.read_bytes()[:-100]),
    "other bytes": lambda path: path.write_bytes(b"PAR1" + bytes(len(path.read_bytes()) - 8) + b"PAR1"),
    "empty": lambda path: path.write_bytes(b""),
    "text": lambda path: path.write_text("program_id,steps\n"),
    "other columns": lambda path: pq.write_table(pq.ParquetFile(path).read().select(["program_id"]), path),
    "bytes in the middle": lambda path: path.write_bytes(
        (data := path.read_bytes())[: len(data) // 3] + bytes(200) + data[len(data) // 3 + 200 :]
    ),
    "gone": lambda path: path.unlink(),
}


@pytest.mark.parametrize("table", ["programs", "executions", "environments"])
@pytest.mark.parametrize("damage", DAMAGES)
def test_damaged_tables_raise_our_error_only(copy, damage, table):
    ways = dict(READINGS)
    for path in (copy / table).glob("*.parquet"):
        DAMAGES[damage](path)
    raised = 0
    for read in ways.values():
        try:
            read(hearth.load(copy))
        except HearthError as error:
            raised += 1
            assert error.diagnostics[0].message
    assert raised


@pytest.mark.parametrize("content", ["[]", '{"stage": "publish"}', '{"stage": "publish", "format": "x", "files": 1}',
                                     '{"stage": "publish", "format": 2, "files": []}'])  # fmt: skip
def test_manifests_that_are_none(copy, content):
    (copy / "manifest.json").write_text(content)
    with pytest.raises(HearthError):
        len(hearth.load(copy))


STARTING = """
import sys, time
from pathlib import Path
from hearth.storage.parallel import spread

time.sleep(float(sys.argv[2]) if __name__ != "__main__" else 0)  # workers take a while to start

def work(name):
    time.sleep(600)

if __name__ == "__main__":
    Path(sys.argv[1]).touch()
    try:
        list(spread(work, ["a", "b", "c"], 3))
    except KeyboardInterrupt:
        print("stopped")
"""


@pytest.mark.usefixtures("interruptible")
@pytest.mark.parametrize("after", [0.3, 0.8, 1.5])
def test_an_interrupt_while_workers_start_prints_no_traceback(tmp_path, after):
    script, ready = tmp_path / "starting.py", tmp_path / "ready"
    script.write_text(STARTING)
    command = [sys.executable, str(script), str(ready), "1.0"]
    build = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True)
    while not ready.exists():
        time.sleep(0.02)
    time.sleep(after)
    os.killpg(build.pid, signal.SIGINT)
    out, err = build.communicate(timeout=60)
    assert out == "stopped\n" and err == ""


@pytest.mark.usefixtures("interruptible")
@pytest.mark.parametrize(("number", "status"), [(signal.SIGTERM, TERMINATED), (signal.SIGINT, STOPPED)])
def test_a_build_that_is_asked_to_end_says_what_to_do(tmp_path, number, status):
    command = [sys.executable, str(ROOT / "cli.py"), "build", "--out", str(tmp_path / "out"), "--workers", "2"]
    build = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    while not list(tmp_path.glob("out/sample/**/*.parquet")) and build.poll() is None:
        time.sleep(0.05)
    build.send_signal(number)
    _, err = build.communicate(timeout=60)
    assert build.returncode == status
    assert "the same command" in err and "Traceback" not in err
    assert (tmp_path / "out/.lock").read_text() == f"{build.pid}\n"
    with locked(tmp_path / "out"):  # the number of a process that has ended keeps nobody out
        pass


def test_a_question_to_a_damaged_table_names_the_damage(copy):
    (copy / "programs/part-00000.train.parquet").write_bytes(b"x")
    with pytest.raises(HearthError) as error:
        Dataset.open(copy).rows("SELECT count(*) FROM programs")
    assert error.value.diagnostics[0].code is Code.DAMAGED_FILE
    with pytest.raises(HearthError) as error:
        Dataset.open(copy).rows("SELECT nothing FROM homes")
    assert error.value.diagnostics[0].code is Code.BAD_ARGUMENT
