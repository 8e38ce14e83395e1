"""Servers that obey, ignore or refuse grammars: the probe finds out, and runs send only what is obeyed."""

from __future__ import annotations

import json
from random import Random

import pytest
from grammar_samples import Gbnf, of_schema
from lying_server import serving
from typer.testing import CliRunner

from hearth import Endpoint, cli
from hearth.challenges.episode_agents import Lineup
from hearth.challenges.result_files import read
from hearth.challenges.suite_runs import run
from hearth.challenges.task_files import suite
from hearth.challenges.verification import verify
from hearth.kb.loading.load import default
from hearth.llm.constraints import FORMS, chosen, keeps
from hearth.llm.language_settings import Asking, Means
from hearth.llm.probe import ODD, grammar_facts, probe
from hearth.schemas.diagnostics import HearthError


def obeying(*names, seed=0):
    """A server that obeys some ways to send a grammar: it answers at random within it."""

    def answer(body):
        rng = Random(str((seed, len(body["messages"]), body["messages"][-1]["content"])))
        for name in names:
            if name == "json_schema" and "response_format" in body:
                value = of_schema(body["response_format"]["json_schema"]["schema"], rng)
                return json.dumps(value)
            text = body.get(name)
            text = text["grammar"] if isinstance(text, dict) else text
            if text and "regex" not in name:
                return Gbnf(text).sample(rng)
        return "Hello there, how are you?"

    return answer


@pytest.mark.parametrize("name", ["grammar", "structured_outputs", "guided_grammar", "ebnf", "json_schema"])
def test_the_probe_finds_what_is_obeyed(name):
    with serving(obeying(name)) as (url, server):
        model = Endpoint(url, "mini")
        found = probe(model)
    assert [form for form in FORMS if found[form] == "obeyed"] == [name] == [chosen(found, "x")]
    assert found["counts_tokens"] and found["repeats_itself"] == "obeyed" and found["n"] == "ignored"
    number = len(server.asked)
    assert grammar_facts(model)[name] == "obeyed" and len(server.asked) == number, "it is asked once"


def test_a_server_that_refuses_fields():
    def strict(body):
        return (400, {}, {"error": {"message": "unknown field"}}) if set(body) & set(FORMS) else "Hello"

    with serving(strict) as (url, _):
        found = probe(Endpoint(url, "mini"))
    assert found["grammar"] == "refused" and found["json_schema"] == "ignored"
    with pytest.raises(HearthError, match="obeys no grammar: grammar refused"):
        chosen(found, "the server")


def test_a_server_that_does_not_answer_is_an_error():
    with serving(404) as (url, _), pytest.raises(HearthError, match="NO_ANSWER"):
        probe(Endpoint(url, "mini"))


def test_answers_are_held_against_the_grammar():
    assert keeps("zebra 1741", ODD, "grammar") and not keeps("zebra 1742", ODD, "grammar")
    assert keeps('{"command": "quartz 58"}', ODD, "json_schema")
    for wrong in ('{"command": "zebra"}', '{"command": 7}', '{"x": "quartz 58"}', "quartz 58", "[1]", ""):
        assert not keeps(wrong, ODD, "json_schema"), wrong


@pytest.fixture(scope="module")
def tasks():
    return suite("household", "valid_seen", limit=2)


def constrained(url, **means):
    return Lineup(f"llm:mini@{url}", asking=Asking(constrained=True, most_turns=60), means=Means(**means))


@pytest.mark.parametrize("name", ["grammar", "json_schema"])
def test_random_weights_under_the_grammar_write_legal_commands_alone(tasks, tmp_path, name):
    with serving(obeying(name)) as (url, _):
        found = run(tasks, constrained(url), 1, tmp_path / "x.jsonl", default)
    for record in found.records:
        said = record.language["0"]
        assert said["constraint"] == name and said["disobeyed"] == 0 and len(said["turns"]) == 60
        assert [turn for turn in said["turns"] if turn[2]] == []
    assert verify(read(tmp_path / "x.jsonl"), "x", default) == []


def test_a_server_that_obeys_at_first_and_then_ignores_is_counted(tasks, tmp_path):
    once = obeying("grammar")

    def later(body):
        return once(body) if "zebra" in body.get("grammar", "") else "I would rather not."

    with serving(later) as (url, _):
        found = run(tasks, constrained(url), 1, tmp_path / "x.jsonl", default)
    said = next(iter(found.records)).language["0"]
    assert said["disobeyed"] == len(said["turns"]) == 60 and {turn[2] for turn in said["turns"]} == {"UNKNOWN_ACTION"}


def test_a_run_is_refused_where_no_grammar_is_obeyed(tasks, tmp_path):
    with serving("Hello") as (url, _), pytest.raises(HearthError, match="obeys no grammar"):
        run(tasks, constrained(url), 1, tmp_path / "x.jsonl", default)


def test_the_command(tmp_path):
    with serving(obeying("grammar")) as (url, _):
        shown = CliRunner().invoke(
            cli.app, ["llm", "probe", f"llm:mini@{url}", "--cache", str(tmp_path / "c"), "--json"]
        )
        kept = Endpoint(url, "mini", means=Means(cache=tmp_path / "c"))
    assert shown.exit_code == 0 and '"grammar": "obeyed"' in shown.output
    assert kept.cache.facts("mini", url) is not None


def test_serving_without_the_packages_says_what_to_install(monkeypatch):
    monkeypatch.setattr("hearth.llm.local_server.SERVER", "no_such_package_of_a_server")
    shown = CliRunner().invoke(cli.app, ["llm", "serve"])
    assert shown.exit_code == 1 and "pip install xllamacpp" in shown.output and "vLLM" in shown.output
    monkeypatch.setattr("hearth.llm.local_server.SERVER", "json")
    shown = CliRunner().invoke(cli.app, ["llm", "serve", "no-such-file.gguf"])
    assert shown.exit_code == 1 and "there is no file" in shown.output
