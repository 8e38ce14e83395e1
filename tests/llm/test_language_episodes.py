"""Episodes of language models: played through a server, stored with their answers, verified without it."""

from __future__ import annotations

import json
import re
from dataclasses import replace

import pytest
from lying_server import serving

from hearth.challenges.episode_agents import Lineup
from hearth.challenges.result_files import line, read
from hearth.challenges.suite_runs import run
from hearth.challenges.task_files import suite
from hearth.challenges.verification import verify
from hearth.envs.text_homes import TextHomes
from hearth.kb.loading.load import default
from hearth.llm.language_settings import Asking, Means
from hearth.schemas.diagnostics import HearthError

ALL = Asking(memory=1_000)


@pytest.fixture(scope="module")
def tasks():
    return suite("household", "valid_seen", limit=3)


@pytest.fixture(scope="module")
def experts(tasks):
    """The commands of an expert for each task, by its instruction."""
    return {task.instruction: list(commands(task)) for task in tasks.tasks}


def commands(task):
    homes = TextHomes([task], worlds=1, expert=True, limit=500)
    _, infos = homes.reset(indices=[0])
    while not infos[0]["won"]:
        yield infos[0]["expert"]
        *_, infos = homes.step([infos[0]["expert"]])


def expert(experts, spoil=()):
    """A model that answers as the expert does; the answers of the numbers in `spoil` are nonsense."""

    def answer(body):
        said = body["messages"][-1]["content"].split("\n")[0].removeprefix("Goal: ")
        turn = sum(message["role"] == "assistant" for message in body["messages"])
        (mine,) = [each for task, each in experts.items() if said.startswith(task[:40])]
        wrong = sum(number < turn for number in spoil)
        return "Fly to the moon 7" if turn in spoil else f"I think.\n{mine[min(turn - wrong, len(mine) - 1)]}"

    return answer


def lineup(url, **asking):
    return Lineup(f"llm:mini@{url}", asking=replace(ALL, **asking))


@pytest.fixture(scope="module")
def results(tasks, experts, tmp_path_factory):
    out = tmp_path_factory.mktemp("episodes") / "mine.jsonl"
    with serving(expert(experts, spoil=(1,))) as (url, asked):
        return out, run(tasks, lineup(url), 1, out, default), asked.asked


def test_a_model_does_the_tasks_and_its_answers_are_kept(results):
    _, found, asked = results
    assert [each.metrics["success"] for each in found.records] == [True] * 3
    for each in found.records:
        turns = each.language["0"]["turns"]
        assert turns[1][1:] == ["Fly to the moon 7", "UNKNOWN_ACTION"] and turns[0][1].startswith("I think.\n")
        assert each.language["0"]["tokens_in"] == 10 * len(turns) and each.language["0"]["tries"] == len(turns)
    assert found.header.language["0"]["model"] == "mini" and found.header.language["0"]["protocol"] == "hearth-text/1"
    assert len(asked) == sum(len(each.language["0"]["turns"]) for each in found.records)


def test_what_was_wrong_is_said_in_the_next_prompt(results):
    prompts = [body["messages"][-1]["content"] for body in results[2]]
    assert sum("Last: refused, you waited. UNKNOWN_ACTION" in prompt for prompt in prompts) == 3


def test_the_episodes_verify_without_the_model(results):
    """The server of the fixture is gone."""
    out, found, _ = results
    assert verify(found, str(out), default) == []


@pytest.mark.parametrize(("temperature", "requests"), [(0.0, 1), (0.7, 5)])
def test_a_model_that_gets_nowhere_is_asked_anew_where_its_answers_are_drawn(tasks, tmp_path, temperature, requests):
    """Without memory the same prompt comes again: its reply is kept and counts once, unless another seed is sent."""
    few = replace(tasks, tasks=tasks.tasks[:1])
    asking = Asking(temperature, memory=0, most_turns=6)
    with serving("Fly") as (url, server):
        found = run(few, Lineup(f"llm:mini@{url}", asking=asking), 1, tmp_path / "x.jsonl", default)
    said = next(iter(found.records)).language["0"]
    assert len(said["turns"]) == 6 and len(server.asked) == 1 + requests, "the first prompt has no `Last:`"
    assert said["tokens_in"] == 10 * len(server.asked) == 10 * said["tries"]
    assert len({body.get("seed") for body in server.asked}) == (1 if temperature == 0 else 6)
    assert verify(found, "x", default) == []


def changed(results, tmp_path, change):
    """The file with a changed episode, signed by whoever knows how lines are signed."""
    out, found, _ = results
    some = out.read_bytes().splitlines(keepends=True)
    data = json.loads(some[2])
    data.pop("digest")
    change(data["language"]["0"], data)
    record = list(found.records)[1]
    some[2] = line(
        found.header, replace(record, **{"language": None, **data, "actions": tuple(map(tuple, data["actions"]))})
    )
    path = tmp_path / "changed.jsonl"
    path.write_bytes(b"".join(some))
    return path


def another_answer(said, _):
    said["turns"][2][1] = "wait"


def a_fault_less(said, _):
    said["turns"][1][2] = None


def a_turn_less(said, _):
    said["turns"].pop()


def a_turn_more(said, _):
    said["turns"].append([400, "wait", None])


def another_wording(said, _):
    said["turns"][0][1] = said["turns"][0][1].replace("I think.", "I know.")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (another_answer, "agent 0 answered `wait`, and did"),
        (a_fault_less, "a fault of an answer"),
        (a_turn_less, "only .* answers are recorded"),
        (a_turn_more, "1 answers more than it gave"),
        (another_wording, "a prompt of agent 0 is another"),
        (lambda said, data: data.pop("language"), "not the answers of the language models"),
    ],
)
def test_a_changed_answer_is_found(results, tmp_path, change, message):
    path = changed(results, tmp_path, change)
    (fault,) = verify(read(path), str(path), default)
    assert re.search(message, fault.message), fault.message


@pytest.mark.parametrize(
    "change",
    [
        lambda said: said["0"].update(memory="many"), lambda said: said["0"].update(memory=-1),
        lambda said: said["0"].update(most_turns=True), lambda said: said["0"].update(price_in="free"),
        lambda said: said.update({"7": {}}), lambda said: said["0"].pop("protocol_fingerprint"),
        lambda said: said["0"].update(model=["x"]), lambda said: said["0"].update(model="x" * 9_000),
    ],
)  # fmt: skip
def test_a_header_of_somebody_else_is_read_with_care(results, tmp_path, change):
    some = results[0].read_bytes().splitlines(keepends=True)
    header = json.loads(some[0])
    change(header["agents"]["language"])
    path = tmp_path / "header.jsonl"
    path.write_bytes(b"".join([json.dumps(header).encode() + b"\n", *some[1:]]))
    with pytest.raises(HearthError, match="BAD_JSON"):
        read(path)


def test_a_prompt_of_other_words_is_said(results, tmp_path):
    """An episode of another protocol cannot be read again by this one."""
    from hearth.challenges.result_files import first_line

    found = results[1]
    described = {"0": {**found.header.language["0"], "prompt_fingerprint": "0" * 16}}
    header = replace(found.header, language=described)
    path = tmp_path / "other.jsonl"
    path.write_bytes(first_line(header) + b"".join(line(header, each) for each in found.records))
    faults = verify(read(path), str(path), default)
    assert len(faults) == 3 and "another protocol" in faults[0].message


def test_a_changed_line_is_damage(results, tmp_path):
    path = tmp_path / "damaged.jsonl"
    path.write_bytes(results[0].read_bytes().replace(b"I think.", b"I knew..", 1))
    with pytest.raises(HearthError, match="DAMAGED_FILE"):
        list(read(path).records)


def test_a_second_run_asks_nothing(tasks, experts, tmp_path):
    means = Means(cache=tmp_path / "kept.sqlite")
    with serving(expert(experts)) as (url, asked):
        one = run(tasks, replace(lineup(url), means=means), 1, tmp_path / "one.jsonl", default)
        number = len(asked.asked)
        again = run(tasks, replace(lineup(url), means=replace(means, tries=2)), 1, tmp_path / "two.jsonl", default)
        assert len(asked.asked) == number > 10
    assert list(again.records) == list(one.records)
