"""Runs of agents on tasks: what is written, that it can be verified, and what becomes of agents that fail."""

from __future__ import annotations

import json
import os
import time
from dataclasses import replace
from pathlib import Path

import pytest

from hearth.challenges import episodes, parallel_episodes
from hearth.challenges.challenge_definition import challenge
from hearth.challenges.episode_agents import Lineup
from hearth.challenges.episode_loop import Player, play
from hearth.challenges.episodes import Job, again, played
from hearth.challenges.result_files import line, read
from hearth.challenges.suite_runs import run
from hearth.challenges.task_files import suite
from hearth.challenges.verification import verify
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.program import ObjectRef, Step
from hearth.simulation.goals import Progress
from hearth.storage.input_files import read_lines

WAH = challenge("wah")
FEW = suite("wah", "test-1", limit=2)
HP = Lineup("human_like", "hp", "true").checked()


def job(helper="random", number=0, seed=0, seconds=30.0, goal=""):
    task = FEW.tasks[number]
    lineup = Lineup("human_like", helper, goal, seconds).checked()
    return Job(task, seed, lineup, helper != "none", task.goal, default)


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    out = tmp_path_factory.mktemp("runs") / "hp.jsonl"
    return out, run(FEW, HP, 2, out, default)


def test_all_episodes_are_there_and_can_be_done_again(results):
    out, found = results
    assert len(found.records) == 2 * 2 * 2
    assert all(record.metrics["success"] for record in found.records)
    assert verify(found, str(out), default) == []
    assert verify(found, str(out), default, agents=True) == []


def test_the_same_bytes_for_any_number_of_workers(results, tmp_path):
    run(FEW, HP, 2, tmp_path / "two.jsonl", default, workers=2)
    assert (tmp_path / "two.jsonl").read_bytes() == results[0].read_bytes()


def test_two_runs_into_one_file_at_once_do_not_destroy_it(results, tmp_path):
    out, second = tmp_path / "one.jsonl", []

    def meanwhile(done, total):
        with pytest.raises(HearthError) as caught:
            run(FEW, HP, 2, out, default)
        second.append(caught.value.diagnostics[0])

    run(FEW, HP, 2, out, default, seen=meanwhile)
    assert out.read_bytes() == results[0].read_bytes()
    assert {each.code for each in second} == {Code.LOCKED} and "another file" in second[0].suggestion
    assert [each.name for each in tmp_path.iterdir()] == ["one.jsonl"]


def test_a_run_goes_through_a_link_and_into_no_pipe(results, tmp_path):
    (tmp_path / "link.jsonl").symlink_to("real.jsonl")
    run(FEW, HP, 2, tmp_path / "link.jsonl", default)
    assert (tmp_path / "real.jsonl").read_bytes() == results[0].read_bytes() and (tmp_path / "link.jsonl").is_symlink()
    os.mkfifo(tmp_path / "pipe.jsonl")
    with pytest.raises(HearthError, match="UNWRITABLE"):
        run(FEW, HP, 2, tmp_path / "pipe.jsonl", default)
    assert (tmp_path / "pipe.jsonl").is_fifo()


@pytest.mark.tools
def test_the_same_bytes_on_a_dask_cluster(results, tmp_path):
    pytest.importorskip("distributed")
    with parallel_episodes.spread_over("dask", 2) as over:
        run(FEW, HP, 2, tmp_path / "dask.jsonl", default, over=over)
    assert (tmp_path / "dask.jsonl").read_bytes() == results[0].read_bytes()


def test_an_unknown_engine_is_refused():
    with pytest.raises(HearthError, match="unknown engine"), parallel_episodes.spread_over("spark"):
        pass


@pytest.mark.parametrize("cut", [0.0, 0.35, 0.9])
def test_a_stopped_run_goes_on(results, tmp_path, monkeypatch, cut):
    out, data = tmp_path / "on.jsonl", results[0].read_bytes()
    (tmp_path / f".{out.name}.run.tmp").write_bytes(data[: int(len(data) * cut)])
    done = []
    monkeypatch.setattr(parallel_episodes, "played", lambda job: done.append(job) or played(job))
    run(FEW, HP, 2, out, default)
    assert out.read_bytes() == data
    assert len(done) == 8 - data[: int(len(data) * cut)].count(b"\n") + (cut > 0)


def test_what_another_run_left_is_not_taken(results, tmp_path):
    out = tmp_path / "other.jsonl"
    (tmp_path / f".{out.name}.run.tmp").write_bytes(results[0].read_bytes())
    found = run(FEW, Lineup("human_like", "none"), 1, out, default)
    assert [record.helped for record in found.records] == [False, False]


def lines(path):
    return path.read_bytes().splitlines(keepends=True)


def changed(results, tmp_path, change, signed):
    """The file with a changed episode; `signed` by who knows how lines are signed."""
    out, found = results
    some = lines(out)
    data = json.loads(some[2])
    change(data)
    if signed:
        data.pop("digest")
        record = replace(list(found.records)[1], **{**data, "actions": tuple(map(tuple, data["actions"]))})
        some[2] = line(found.header, record)
    else:
        some[2] = json.dumps(data).encode() + b"\n"
    path = tmp_path / "changed.jsonl"
    path.write_bytes(b"".join(some))
    return path


def wait(data):
    data["actions"][0] = [None, None]


def shorten(data):
    data["actions"] = data["actions"][:-1]


def lengthen(data):
    data["actions"].append([None, None])


def boast(data):
    data["metrics"]["length"] = 1


def calm(data):
    data["metrics"]["false_beliefs"] += 1


def reseed(data):
    data["seed"] += 1


def cheat(data):
    data["actions"][0] = ["SwitchOff 1 2 3 4", "Fly 7"]


CHANGES = [wait, shorten, lengthen, boast, calm, reseed, cheat]


@pytest.mark.parametrize("change", CHANGES)
def test_a_changed_file_is_found(results, tmp_path, change):
    with pytest.raises(HearthError) as raised:
        read(changed(results, tmp_path, change, signed=False))
    assert (raised.value.diagnostics[0].code, raised.value.diagnostics[0].line) == (Code.DAMAGED_FILE, 3)


@pytest.mark.parametrize("change", CHANGES)
def test_a_false_claim_is_found_though_it_is_signed(results, tmp_path, change):
    path = changed(results, tmp_path, change, signed=True)
    assert verify(read(path), str(path), default)


def test_an_episode_that_is_left_out_is_found(results, tmp_path):
    path = tmp_path / "less.jsonl"
    path.write_bytes(b"".join(lines(results[0])[:-1]))
    assert verify(read(path), str(path), default)


def test_a_changed_goal_of_the_helper_is_found_by_its_agents(results):
    out, found = results
    other = WAH.grammar.written(FEW.tasks[1].goal)
    records = [replace(each, helper_goal=other) if each.helped else each for each in found.records]
    assert verify(replace(found, records=tuple(records)), str(out), default, agents=True)


def test_seeds_differ():
    """The published search set its generators to 1 at every reset, so that five seeds were hardly five episodes."""
    actions = [played(job("random", seed=seed)).actions for seed in range(4)]
    assert len(set(actions)) == 4


def test_the_same_seed_gives_the_same_episode_whatever_was_played_before():
    first = played(job("random", seed=1))
    played(job("random", number=1, seed=3))
    assert played(job("random", seed=1)) == first


class Dreamer:
    """Believes that it has reached its goal: it waits, and changes its own copy of everything."""

    def reset(self, observation, goal, seed):
        self.goal = goal

    def act(self, observation, legal):
        return None


def test_progress_is_counted_in_the_real_world_only(knowledge):
    task = FEW.tasks[0]
    start = task.start(knowledge, 1)
    goal = task.goal_in(start.home)
    done = play(start, goal, [Player(Dreamer(), goal)], 0, limit=5)
    assert not done.success
    assert done.progress[-1] == Progress.start(goal, done.env.world)


AGENTS = '''
import os, sys, time
from hearth.schemas.program import ObjectRef, Step

class Base:
    def reset(self, observation, goal, seed):
        self.me = observation.agent
    def act(self, observation, legal):
        return self.answer(observation, legal) if observation.tick == 3 else None

class Crash(Base):
    def answer(self, observation, legal):
        return {}["nothing"]

class Quit(Base):
    def answer(self, observation, legal):
        sys.exit("enough")

class Deep(Base):
    def answer(self, observation, legal):
        return self.answer(observation, legal)

class Hang(Base):
    def answer(self, observation, legal):
        time.sleep(60)

class Word(Base):
    def answer(self, observation, legal):
        return "[Open] <fridge> (1)"

class Broken(Base):
    def answer(self, observation, legal):
        return Step("Open", None)

class Never(Base):
    def reset(self, observation, goal, seed):
        raise ValueError("not today")

class Die(Base):
    def answer(self, observation, legal):
        os._exit(3)

class Cheat(Base):
    """Names what it does not see, what there is not, actions that nobody may try, and others' hands."""
    def act(self, observation, legal):
        home = observation.world.home
        unseen = next(i for i in home.ids if not observation.sees(i))
        tries = [Step("Walktowards", (ObjectRef("x", 0, unseen),)), Step("Grab", (ObjectRef("x", 0, 10**6),)),
                 Step("Find", (ObjectRef("x", 0, home.ids[0]),)), Step("Open", ())]
        return tries[observation.tick % 4]
'''


@pytest.fixture(scope="module")
def mine(tmp_path_factory):
    path = tmp_path_factory.mktemp("agents") / "mine.py"
    path.write_text(AGENTS)
    return path


@pytest.mark.parametrize(
    ("name", "code", "tick"),
    [
        ("Crash", Code.AGENT_FAILED, 3),
        ("Quit", Code.AGENT_FAILED, 3),
        ("Deep", Code.AGENT_FAILED, 3),
        ("Hang", Code.TIMED_OUT, 3),
        ("Word", Code.BAD_ARGUMENT, 3),
        ("Broken", Code.AGENT_FAILED, 3),
        ("Never", Code.AGENT_FAILED, 0),
    ],
)
def test_an_agent_that_fails_ends_its_episode_with_a_code(mine, name, code, tick, knowledge):
    began = time.monotonic()
    record = played(job(f"{mine}:{name}", seconds=0.3))
    assert time.monotonic() - began < 20
    assert record.end["code"] == str(code)
    assert record.end["agent"] == 1
    assert record.end["message"]
    assert len(record.actions) == tick
    assert not record.metrics["success"]
    assert (record.metrics["length"], record.metrics["reward"]) == (WAH.ticks, -1.0)
    outcome, final = again(FEW.tasks[0], record, knowledge)
    assert (outcome.as_json(), final) == (record.metrics, record.final)


def test_a_run_goes_on_after_an_agent_that_fails(mine, tmp_path):
    found = run(FEW, Lineup("human_like", f"{mine}:Crash"), 1, tmp_path / "c.jsonl", default)
    assert [bool(each.end) for each in found.records] == [False, True, False, True]
    assert verify(found, "c.jsonl", default) == []


@pytest.mark.slow
def test_a_run_goes_on_after_an_agent_that_ends_its_process(mine, tmp_path):
    found = run(FEW, Lineup("human_like", f"{mine}:Die"), 1, tmp_path / "d.jsonl", default, workers=2)
    assert [each.end and each.end["code"] for each in found.records] == [None, "AGENT_FAILED", None, "AGENT_FAILED"]


def test_what_is_not_seen_or_not_allowed_is_not_tried(mine):
    record = played(job(f"{mine}:Cheat"))
    tried = {actions[1] for actions in record.actions}
    assert tried <= {None, "Open"}
    assert record.metrics["success"]


@pytest.mark.parametrize(
    "lineup",
    [Lineup("nobody"), Lineup(helper="nobody"), Lineup(goal="wild"), Lineup(helper="no/such.py:Agent")],
)
def test_unknown_agents_are_refused(lineup):
    with pytest.raises(HearthError):
        lineup.checked()


def test_instructions_are_read_strictly(knowledge):
    home = FEW.tasks[0].start(knowledge).home
    allowed = WAH.allowed(knowledge)
    node = home.ids[5]
    found = episodes.read_instruction(f"Open {node}", 1, home, allowed)
    assert found == Step("Open", (ObjectRef(home.classes[5], 0, node),), 1)
    for text in ("", "Open x", f"Open  {node}", "Open 999999", f"Find {node}", f"Open {node}\n", "Open ٣"):
        with pytest.raises(HearthError):
            episodes.read_instruction(text, 0, home, allowed)


def test_the_helper_of_the_page_is_as_printed_and_helps(tmp_path):
    root = Path(__file__).resolve().parents[2] / "docs/examples"
    code = (root / "my_helper.py").read_text()
    assert f"```python\n{code}```" in (root / "helper.md").read_text()
    assert len(code.splitlines()) <= 30
    found = run(FEW, Lineup(helper=f"{root / 'my_helper.py'}:Helper"), 1, tmp_path / "mine.jsonl", default)
    assert all(record.metrics["success"] for record in found.records)
    assert verify(found, "mine.jsonl", default) == []


def test_a_file_of_results_names_no_code_that_is_run(results, tmp_path):
    """Results are of strangers: with --agents only agents of ours play again."""
    ran = tmp_path / "ran"
    (tmp_path / "evil.py").write_text(f"open({str(ran)!r}, 'w').close()")
    _, found = results
    lineup = replace(found.header.lineup, helper=f"{tmp_path / 'evil.py'}:Helper")
    strange = replace(found, header=replace(found.header, lineup=lineup))
    with pytest.raises(HearthError, match="BAD_ARGUMENT"):
        verify(strange, "strange.jsonl", default, agents=True)
    assert not ran.exists()


@pytest.mark.parametrize("metrics", [{}, {"success": 1}, {"success": "yes"}])
def test_an_episode_without_all_its_metrics_is_none(results, tmp_path, metrics):
    path = changed(results, tmp_path, lambda data: data.update(metrics=metrics), signed=True)
    with pytest.raises(HearthError, match="not an episode"):
        read(path)


def test_a_file_of_more_than_fits_in_memory(results, monkeypatch):
    """Each line is read for itself: it may not be long, the file may."""
    out, found = results
    longest = max(len(each) for each in lines(out))
    monkeypatch.setattr(read_lines, "__defaults__", (longest,))
    assert list(read(out).records) == list(found.records)
    monkeypatch.setattr(read_lines, "__defaults__", (longest - 1,))
    with pytest.raises(HearthError) as raised:
        read(out)
    assert raised.value.diagnostics[0].code == Code.FILE_TOO_LARGE


def test_a_file_that_lost_its_end_while_it_was_read(results, tmp_path):
    path = tmp_path / "short.jsonl"
    path.write_bytes(results[0].read_bytes())
    found = read(path)
    path.write_bytes(b"".join(lines(path)[:-1]))
    assert [fault.code for fault in verify(found, str(path), default)] == [Code.REPLAY_DIFFERS]
