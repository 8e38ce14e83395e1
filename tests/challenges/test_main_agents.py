"""One's own main agents: a class, a program; an agent that fails is counted apart, tried again, and never a score."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from hearth.challenges.episode_agents import Lineup
from hearth.challenges.result_files import read
from hearth.challenges.suite_runs import run
from hearth.challenges.task_files import suite, write
from hearth.challenges.verification import verify
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

ROOT = Path(__file__).resolve().parents[2]
ONE = suite("wah", "test-1", limit=1)

AGENTS = '''
from pathlib import Path
from hearth.agents.human_like import HumanLike

class Mine(HumanLike):
    """A human-like agent of somebody."""

class Limited:
    """A client of a server that refuses."""
    def reset(self, observation, goal, seed): pass
    def act(self, observation, legal): raise RuntimeError("429 rate limited")

class Once(HumanLike):
    """It fails in its first episode alone."""
    def reset(self, observation, goal, seed):
        mark = Path(__file__).with_name("mark")
        if not mark.exists():
            mark.touch()
            raise ConnectionError("try again")
        super().reset(observation, goal, seed)

class Twice(HumanLike):
    """It fails in both tries of its first episode."""
    def reset(self, observation, goal, seed):
        for name in ("first", "second"):
            mark = Path(__file__).with_name(name)
            if not mark.exists():
                mark.touch()
                raise ConnectionError("try again")
        super().reset(observation, goal, seed)
'''

PROGRAM = """
import json, sys
for line in sys.stdin:
    message = json.loads(line)
    if message["type"] == "observe":
        print(json.dumps({"tick": message["tick"], "act": None}), flush=True)
        if message["tick"] == LAST:
            break
"""


@pytest.fixture
def mine(tmp_path):
    path = tmp_path / "mine.py"
    path.write_text(AGENTS)
    return path


def command_line(*words: str, cwd: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, str(ROOT / "cli.py"), "challenge", *words],
        cwd=cwd, capture_output=True, text=True, timeout=300, check=False,
    )  # fmt: skip


def test_an_own_agent_does_as_ours_does(mine, tmp_path):
    own = run(ONE, Lineup(f"{mine}:Mine"), 1, tmp_path / "own.jsonl", default)
    ours = run(ONE, Lineup("human_like"), 1, tmp_path / "ours.jsonl", default)
    assert [each.actions for each in own.records] == [each.actions for each in ours.records]
    assert own.header.code and not ours.header.code
    assert verify(own, "own.jsonl", default) == []


def test_a_program_acts_and_its_end_is_no_score(tmp_path):
    program = tmp_path / "program.py"
    program.write_text(PROGRAM.replace("LAST", "-1"))
    found = run(ONE, Lineup(f"{sys.executable} {program}"), 1, tmp_path / "p.jsonl", default)
    (record,) = found.records
    assert record.end is None and len(record.actions) == 250 and not record.metrics["success"]
    program.write_text(PROGRAM.replace("LAST", "2"))
    found = run(ONE, Lineup(f"{sys.executable} {program} again"), 1, tmp_path / "q.jsonl", default)
    (record,) = found.unfinished
    assert record.end["code"] == str(Code.DISCONNECTED) and found.finished(False) == {}


def test_what_fails_once_is_played_again(mine, tmp_path):
    found = run(ONE, Lineup(f"{mine}:Once"), 1, tmp_path / "o.jsonl", default)
    assert (tmp_path / "mark").exists() and not found.unfinished
    assert next(iter(found.records)).metrics["success"]


def test_the_same_call_plays_again_only_what_did_not_finish(mine, tmp_path):
    out, lineup = tmp_path / "r.jsonl", Lineup(f"{mine}:Twice")
    assert len(run(ONE, lineup, 2, out, default).unfinished) == 1
    kept = out.read_bytes().splitlines()[2]
    assert not run(ONE, lineup, 2, out, default).unfinished
    assert out.read_bytes().splitlines()[2] == kept and len(read(out).records) == 2


def test_a_failure_is_printed_and_counted_apart(mine, tmp_path):
    write(tmp_path / "t.json", ONE)
    words = ("run", "t.json", "--main", f"{mine}:Limited", "--out", "r.jsonl")
    done = command_line(*words, cwd=tmp_path)
    assert done.returncode == 1, done.stderr
    assert "1 episode not finished, without a score: AGENT_FAILED: RuntimeError: 429 rate limited" in done.stdout
    shown = json.loads(command_line("score", "r.jsonl", "--json", cwd=tmp_path).stdout)
    assert (shown["episodes"], shown["success"], shown["unfinished"][0]["episodes"]) == (0, None, 1)


def test_an_agent_alone_has_a_table_by_goal_set(mine, tmp_path):
    few = suite("wah", "test-1", limit=2)
    write(tmp_path / "t.json", few)
    done = command_line("run", "t.json", "--main", f"{mine}:Mine", "--out", "r.jsonl", "--json", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    shown = json.loads(done.stdout)
    assert [row["tasks"] for row in shown["by_set"]] == [1, 1] and shown["success"] == 1.0
    text = command_line("score", "r.jsonl", cwd=tmp_path).stdout
    assert "speedup" not in text and "goals" in text


@pytest.mark.parametrize("main", ["nobody", "no/such.py:Agent", "no-such-program --x", "", "'open", "mine.py:Nothing"])
def test_what_is_no_agent_is_refused(main):
    with pytest.raises(HearthError) as caught:
        Lineup(main).checked()
    assert caught.value.diagnostics[0].suggestion


@pytest.mark.parametrize("name", ["python -c pass", "mine.py:Mine"])
def test_a_strangers_results_run_no_code(name, tmp_path, mine):
    found = run(ONE, Lineup("oracle"), 1, tmp_path / "r.jsonl", default)
    lines = (tmp_path / "r.jsonl").read_text().replace('"main":"oracle"', f'"main":"{name}"', 1)
    (tmp_path / "s.jsonl").write_text(lines.splitlines()[0] + "\n")
    assert found.records
    with pytest.raises(HearthError, match="results name no code to run"):
        verify(type(found)(read(tmp_path / "s.jsonl").header, found.records), "s.jsonl", default, agents=True)
