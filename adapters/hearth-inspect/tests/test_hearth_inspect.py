"""The task in Inspect AI itself: its mock, a local endpoint, rewards of the engine, seeds, many at once, bad input."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from hearth_inspect import household
from inspect_ai import eval as inspect_eval
from inspect_ai.log import read_eval_log
from inspect_ai.model import ModelOutput, get_model

import hearth

sys.path.append(str(Path(__file__).parents[2]))
from chat_endpoint import MILK, endpoint

COMMAND = """
import sys
from inspect_ai._cli.main import main
from inspect_ai.model import _model

_model.count_text_tokens = lambda text: len(text) // 4
main()
"""
"""The command `inspect`; what counts tokens would fetch a table from the network, even for the mock."""

HOLD = {"home": "maple", "goal": "HOLDS(agent, milk)"}


def of_engine(commands, seed, limit=250):
    episode = hearth.TextEpisode(**HOLD, limit=limit)
    turn = episode.reset(seed)
    for command in commands:
        if not turn.done:
            turn = episode.step(command)
    return turn


def scripted(commands):
    """The mock, which answers by the number of its earlier answers; it counts tokens without a network."""

    def answer(messages, tools, choice, config):
        turn = sum(message.role == "assistant" for message in messages)
        return ModelOutput.from_content("mockllm/model", commands[min(turn, len(commands) - 1)])

    model = get_model("mockllm/model", custom_outputs=answer)

    async def counted(text):
        return len(str(text)) // 4

    model.api.count_text_tokens = counted
    return model


def run(folder, commands=MILK, **given):
    given = {**HOLD, "turns": 6, **given}
    (log,) = inspect_eval(household(**given), model=scripted(commands), log_dir=str(folder), display="none")
    assert log.status == "success", log.error
    return [(sample.id, sample.scores["reached"].value) for sample in log.samples]


def test_scores_are_the_engine_s(tmp_path):
    scores = dict(run(tmp_path, episodes=5))
    for seed in range(5):
        turn, score = of_engine([*MILK, MILK[-1], MILK[-1]], seed), scores[f"seed-{seed}"]
        assert {name: getattr(turn, name) for name in score} == score
    assert scores["seed-4"]["won"] == 1.0


def test_seeds_repeat_and_sixty_four_play_at_once(tmp_path):
    first = sorted(run(tmp_path / "one", episodes=64, turns=2), key=lambda each: each[0])
    assert len(first) == 64
    assert first == sorted(run(tmp_path / "two", episodes=64, turns=2), key=lambda each: each[0])


def test_the_command_with_the_mock_and_with_a_local_endpoint(tmp_path):
    command = [sys.executable, "-c", COMMAND, "eval", "hearth_inspect/household", "--display", "none"]
    command += ["-T", "home=maple", "-T", f"goal={HOLD['goal']}", "-T", "episodes=5", "-T", "turns=6"]
    with endpoint() as address:
        env = {**os.environ, "LOCAL_API_KEY": "none", "LOCAL_BASE_URL": address}
        for model in ("mockllm/model", "openai-api/local/tiny"):
            folder = tmp_path / model.partition("/")[0]
            done = subprocess.run([*command, "--model", model, "--log-dir", str(folder)], check=False, env=env,
                                  capture_output=True, text=True, cwd=tmp_path)  # fmt: skip
            assert done.returncode == 0, done.stdout + done.stderr
            log = read_eval_log(str(next(folder.glob("*.eval"))))
            assert log.status == "success" and len(log.samples) == 5
            won = {sample.id: sample.scores["reached"].value["won"] for sample in log.samples}
            assert won["seed-4"] == (model != "mockllm/model")


@pytest.mark.parametrize(
    ("given", "code"),
    [
        ({"home": "castle", "goal": "HOLDS(agent, milk)"}, "UNKNOWN_HOME"),
        ({"home": "maple"}, "BAD_ARGUMENT"),
        ({"home": "maple", "goal": "HOLDS("}, "SYNTAX"),
        ({"tasks": "wah:nowhere"}, "BAD_ARGUMENT"),
    ],
)
def test_a_task_that_is_asked_for_wrongly_is_refused_before_the_first_sample(given, code):
    with pytest.raises(hearth.HearthError, match=code):
        household(**given)


def test_the_command_says_what_is_wrong(tmp_path):
    command = [str(Path(sys.executable).with_name("inspect")), "eval", "hearth_inspect/household", "--display", "none",
               "-T", "home=castle", "-T", "goal=x", "--model", "mockllm/model", "--log-dir", str(tmp_path)]  # fmt: skip
    done = subprocess.run(command, check=False, capture_output=True, text=True, cwd=tmp_path)
    assert done.returncode != 0 and "UNKNOWN_HOME" in done.stdout + done.stderr


def test_answers_after_the_end_and_odd_ones_end_no_sample(tmp_path):
    scores = dict(run(tmp_path, ["", "{}", "fly " * 9_000, "\0"], episodes=2, turns=4, limit=10))
    assert [score["faults"] for score in scores.values()] == [4.0, 4.0]
    over = dict(run(tmp_path, ["wait"], episodes=2, turns=50, limit=3))
    assert [score["turn"] for score in over.values()] == [3.0, 3.0]
