"""Language models as planners: prompts with similar examples, answers read and counted, runs that go on."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time

import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from grammar_samples import Gbnf, of_schema
from lying_server import reply, serving
from typer.testing import CliRunner

import hearth
from hearth import Endpoint, cli
from hearth.kb.action_grammar import check
from hearth.llm.language_planner import LanguagePlanner
from hearth.llm.language_settings import Asking, Means
from hearth.models.interface import Request
from hearth.models.text_examples import Example
from hearth.schemas.program import Program
from hearth.schemas.syntax import parse_steps

MILK = "[Walk] <kitchen> (1)\n[Grab] <milk> (1)"


def example(title, description, lines):
    steps = tuple(step for line in lines.splitlines() for step in parse_steps(line))
    return Example(title, title, title, description, steps)


EXAMPLES = (
    example(
        "Watch TV", "Turn on the television and watch it.", "[SwitchOn] <television> (1)\n[Watch] <television> (1)"
    ),
    example("Drink milk", "Take the milk out of the fridge and drink it.", "[Grab] <milk> (1)\n[Drink] <milk> (1)"),
    example("Wash hands", "Wash the hands at the sink with soap.", "[Wash] <hands_both> (1)"),
)
FETCH = Request("1", "Fetch milk", "Take the milk from the fridge.")


def planner(url, knowledge, shots=0, **asking):
    return LanguagePlanner(Endpoint(url, "mini", Asking(**asking), Means(tries=2)), knowledge, EXAMPLES, shots)


def test_the_most_similar_examples_come_last(knowledge):
    with serving(MILK) as (url, server):
        assert [step.action for step in planner(url, knowledge, 2).predict([FETCH])[0]] == ["Walk", "Grab"]
    roles = [(message["role"], message["content"]) for message in server.asked[0]["messages"]]
    assert [role for role, _ in roles] == ["system", "user", "assistant", "user", "assistant", "user"]
    assert roles[3][1].startswith("Activity: Drink milk") and roles[4][1] == "[Grab] <milk> (1)\n[Drink] <milk> (1)"
    assert roles[-1][1] == "Activity: Fetch milk\nDescription: Take the milk from the fridge."
    assert "SwitchOn" in roles[0][1] and "{" not in roles[0][1]


def test_no_example_has_the_text_that_is_asked(knowledge):
    own = Request("1", "Drink milk", "Take the milk out of the fridge and drink it.")
    with serving(MILK) as (url, server):
        planner(url, knowledge, 3).predict([own])
    said = [message["content"] for message in server.asked[0]["messages"]]
    assert sum("Drink milk" in text for text in said) == 1 and len(said) == 6


def test_what_is_not_understood_is_counted_and_no_step(knowledge):
    answers = {
        "one": f"Sure! Here is the program:\n```\n{MILK}\n[Zap] <milk> (1)\n```",
        "two": "1. Walk to the kitchen\n2. Grab the milk",
        "three": "I cannot do that.",
        "four": "[Grab] <milk",
    }
    with serving(lambda body: answers[body["messages"][-1]["content"].split()[1]]) as (url, _):
        made = planner(url, knowledge)
        found = made.predict([Request(name, name, name) for name in answers])
    assert [[step.action for step in steps] for steps in found] == [["Walk", "Grab"], ["Walk", "Grab"], [], []]
    counted = made.planned.as_json()
    assert (counted["texts"], counted["steps"]) == (4, 4)
    assert counted["faults"]["UNKNOWN_ACTION"] == 1 and counted["faults"]["EMPTY"] >= 1


def test_a_text_without_an_answer_is_counted(knowledge):
    with serving(lambda body: 400 if "bad" in body["messages"][-1]["content"] else MILK) as (url, _):
        made = planner(url, knowledge)
        found = made.predict([FETCH, Request("2", "bad", "bad")])
    assert found[1] is None and len(found[0]) == 2
    assert made.planned.unanswered == {"NO_ANSWER": 1} and "400" in made.planned.first.message


@pytest.mark.parametrize("form", ["grammar", "json_schema"])
def test_random_weights_under_the_grammar_of_steps_write_programs(knowledge, form):
    from random import Random

    def answer(body):
        rng = Random(json.dumps(body["messages"][-1]))
        if form == "json_schema" and "response_format" in body:
            return json.dumps(of_schema(body["response_format"]["json_schema"]["schema"], rng))
        if form == "grammar" and "grammar" in body:
            return Gbnf(body["grammar"]).sample(rng)
        return "Hello there!"

    with serving(answer) as (url, _):
        made = planner(url, knowledge, constrained=True)
        found = made.predict([Request(str(n), f"text {n}", "x") for n in range(30)])
    assert made.planned.disobeyed == 0
    if form == "grammar":
        assert made.planned.faults == {} and made.planned.warnings == {}
        assert all(check(Program(steps=steps), knowledge)[1] == () for steps in found)
    assert sum(map(len, found)) > 200


# The command, over a dataset


@pytest.fixture(scope="module")
def parted(made, tmp_path_factory):
    """The dataset with every other activity in `test`."""
    import shutil

    folder = shutil.copytree(made.out, tmp_path_factory.mktemp("parted") / "out")
    (path,) = (folder / "publish/splits").glob("*.parquet")
    table = pq.read_table(path)
    activities = dict(hearth.load(made.out).rows("SELECT program_id, activity_id FROM programs")[1])
    order = {name: number for number, name in enumerate(sorted(set(activities.values())))}
    parts = pa.array([("train", "test")[order[activities[row]] % 2] for row in table["program_id"].to_pylist()])
    place = table.schema.get_field_index("part")
    table = table.set_column(place, table.schema.field(place), parts.cast(table.schema.field(place).type))
    pq.write_table(table, path)
    return folder


def call(*words):
    return CliRunner().invoke(cli.app, ["model", *map(str, words)])


def test_predictions_of_a_dataset_are_scored(parted, tmp_path):
    out = tmp_path / "predicted.jsonl"
    with serving(MILK) as (url, server):
        shown = call("predict", f"llm:mini@{url}", parted, "--shots", 1, "--out", out, "--json")
        assert shown.exit_code == 0, shown.output
        facts = json.loads(shown.stdout)
        asked = len(server.asked)
        again = json.loads(call("predict", f"llm:mini@{url}", parted, "--shots", 1, "--out", out, "--json").stdout)
    assert facts["predictions"] == facts["executions"] > 2 and facts["prompt"] == "hearth-planner/1"
    assert asked == facts["texts"] == again["kept"] == len(server.asked) and facts["tokens_in"] == 10 * asked
    rows = [json.loads(line) for line in out.read_text().splitlines()]
    assert rows[0]["predicted"] == MILK.splitlines()
    scored = CliRunner().invoke(cli.app, ["model", "score", str(out), str(parted), "--json"])
    assert scored.exit_code == 0 and json.loads(scored.stdout)["count"] == len(rows)


def test_repaired_predictions_run(parted, tmp_path):
    with serving(MILK) as (url, _):
        shown = call("predict", f"llm:mini@{url}", parted, "--repair", "--out", tmp_path / "r.jsonl", "--json")
    assert shown.exit_code == 0, shown.output
    assert json.loads(shown.stdout)["predictions"] > 2


def test_a_budget_stops_and_a_greater_one_goes_on(parted, tmp_path):
    words = ["predict", "PLACE", parted, "--out", tmp_path / "b.jsonl", "--prices", "1000,1000", "--llm", "at_once=1"]
    words += ["--llm", "most_tokens=2", "--json"]
    with serving(reply(MILK, tokens=(1_000, 2))) as (url, server):
        words[1] = f"llm:mini@{url}"
        little = call(*words, "--budget", "3")
        facts = json.loads(little.stdout)
        assert little.exit_code == 1 and facts["unanswered"]["OVER_BUDGET"] > 0 and facts["cost"] <= 3
        asked = len(server.asked)
        assert asked == facts["texts"] >= 1
        rest = call(*words, "--budget", "1000")
        assert rest.exit_code == 0 and json.loads(rest.stdout)["kept"] == asked


def test_options_that_do_not_fit_are_refused(parted, tmp_path):
    out = tmp_path / "x.jsonl"
    for words, said in (
        (["nearest", "--shots", "2"], "are about language models"),
        (["llm:mini", "--shots", "2", "--split", ""], "examples of the split"),
        (["llm:mini", "--budget", "2"], "a budget needs prices"),
        (["llm:mini@http://u:p@x/v1"], "holds a user or a key"),
    ):
        shown = call("predict", words[0], parted, *words[1:], "--out", out)
        assert shown.exit_code == 1 and said in shown.output, shown.output


def test_a_killed_run_asks_nothing_twice(parted, tmp_path):
    """It is killed while a reply is on its way: that one alone may be asked again."""

    def slow(body):
        time.sleep(0.1)
        return MILK

    with serving(slow) as (url, server):
        words = ["model", "predict", f"llm:mini@{url}", str(parted), "--part", "", "--out", str(tmp_path / "k.jsonl")]
        words += ["--llm", "at_once=1"]
        process = subprocess.Popen([sys.executable, "-m", "hearth.cli", *words], stdout=subprocess.DEVNULL)
        while len(server.asked) < 3 and process.poll() is None:
            time.sleep(0.01)
        os.kill(process.pid, signal.SIGKILL)
        process.wait()
        before = len(server.asked)
        assert not (tmp_path / "k.jsonl").exists()
        facts = json.loads(CliRunner().invoke(cli.app, [*words, "--json"]).stdout)
    assert facts["kept"] >= before - 1 >= 2
    prompts = [json.dumps(body) for body in server.asked]
    assert len(prompts) - len(set(prompts)) <= 1 and len(set(prompts)) == facts["texts"]
