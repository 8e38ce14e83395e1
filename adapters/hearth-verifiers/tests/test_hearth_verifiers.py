"""The taskset in verifiers itself: its validator, a run with a local endpoint, rewards of the engine, bad input."""

import json
import os
import subprocess
import sys
from pathlib import Path

import hearth_verifiers
import pytest
import verifiers.v1 as vf

import hearth

sys.path.append(str(Path(__file__).parents[2]))
from chat_endpoint import MILK, endpoint

HOLD = {"home": "maple", "goal": "HOLDS(agent, milk)"}


def command(name, folder, *given, env=None):
    whole = [str(Path(sys.executable).with_name(name)), "hearth-verifiers", *given]
    return subprocess.run(
        whole, check=False, capture_output=True, text=True, cwd=folder, env={**os.environ, **(env or {})}
    )


def test_the_validator_passes(tmp_path):
    for more in (("--taskset.home", "maple", "--taskset.goal", HOLD["goal"]), ("--taskset.tasks", "wah:train:30")):
        done = command("vf-validate", tmp_path, "--no-rich", "--runtime.type", "subprocess", "-n", "4", *more)
        assert done.returncode == 0, done.stdout + done.stderr
    summaries = [json.loads(path.read_text()) for path in tmp_path.rglob("summary.json")]
    assert len(summaries) == 2
    for summary in summaries:
        assert summary["outcomes"]["valid"] == summary["total"] == 4, summary


def evaluated(folder, address, count, turns=6):
    done = command(
        "vf-eval", folder, "--no-push", "--no-rich", "-m", "tiny", "--client.base-url", address,
        "--client.api-key-var", "NO_KEY", "--env.taskset.home", "maple", "--env.taskset.goal", HOLD["goal"],
        "--env.taskset.num-tasks", str(count), "--env.most-turns", str(turns), env={"NO_KEY": "none"},
    )  # fmt: skip
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    (file,) = Path(folder).rglob("traces.jsonl")
    return [trace for line in file.read_text().splitlines() for trace in json.loads(line)["traces"]]


def facts(trace):
    """The reward and the metrics of a trace, and the seed of its task."""
    rewards = {name: value["score"] for name, value in trace["rewards"].items()}
    return trace["task"]["data"]["seed"], rewards, trace["metrics"]


def test_rewards_are_the_engine_s(tmp_path):
    with endpoint() as address:
        found = sorted((facts(trace) for trace in evaluated(tmp_path, address, 5)), key=lambda each: each[0])
    assert [seed for seed, *_ in found] == [0, 1, 2, 3, 4]
    for seed, rewards, metrics in found:
        episode = hearth.TextEpisode(**HOLD)
        turn = episode.reset(seed)
        for command in [*MILK, MILK[-1], MILK[-1]]:
            if not turn.done:
                turn = episode.step(command)
        assert rewards == {"won": float(turn.won)}
        assert {name: metrics[name] for name in ("total", "goal_fraction", "faults", "ticks", "turn")} == {
            name: float(getattr(turn, name)) for name in ("total", "goal_fraction", "faults", "ticks", "turn")
        }
    assert found[4][1] == {"won": 1.0}


def test_seeds_repeat_and_sixty_four_play_at_once(tmp_path):
    with endpoint() as address:
        first, second = (
            sorted((facts(trace)[:2] for trace in evaluated(tmp_path / name, address, 64, 1)), key=lambda each: each[0])
            for name in ("one", "two")
            if not (tmp_path / name).mkdir()
        )
    assert len(first) == 64 and first == second


def test_prompts_repeat():
    config = hearth_verifiers.HearthConfig(id="hearth-verifiers", tasks="wah:train:12", num_tasks=6)
    one, two = ([task.data for task in vf.load_taskset(config)] for _ in range(2))
    assert one == two and len({data.prompt for data in one}) > 3


@pytest.mark.parametrize(
    ("given", "word"),
    [
        (("--taskset.home", "castle", "--taskset.goal", "x"), "UNKNOWN_HOME"),
        (("--taskset.home", "maple"), "BAD_ARGUMENT"),
        (("--taskset.tasks", "wah:nowhere"), "BAD_ARGUMENT"),
        (("--taskset.num-tasks", "many"), "num"),
        (("--taskset.seed", "1"), "seed"),
    ],
)
def test_a_wrong_setting_is_said(tmp_path, given, word):
    done = command("vf-validate", tmp_path, "--no-rich", "--runtime.type", "subprocess", "-n", "1", *given)
    assert done.returncode != 0 and word in done.stdout + done.stderr


def test_odd_answers_end_no_episode(tmp_path):
    with endpoint(["", "{}", "fly", "\x00"]) as address:
        (trace,) = evaluated(tmp_path, address, 1, 4)
    assert not trace.get("errors") and facts(trace)[1] == {"won": 0.0}
    assert facts(trace)[2]["turn"] >= 1
