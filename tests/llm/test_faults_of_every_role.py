"""The list of bad input, for every role: each fault is typed, nothing is lost, keys are nowhere."""

from __future__ import annotations

import json

import pytest
from lying_server import dripping, endless, gone, half, raw, reply, serving, silent
from typer.testing import CliRunner

from hearth import cli
from hearth.challenges.episode_agents import Lineup
from hearth.challenges.result_files import read
from hearth.challenges.suite_runs import run
from hearth.challenges.task_files import suite
from hearth.challenges.verification import verify
from hearth.kb.loading.load import default
from hearth.llm.embeddings import EndpointVectors
from hearth.llm.endpoint import Endpoint
from hearth.llm.judge import Case, Judge
from hearth.llm.language_planner import LanguagePlanner
from hearth.llm.language_settings import Asking, Means
from hearth.models.interface import Request
from hearth.schemas.diagnostics import HearthError

FAULTS = {
    "a timeout": raw(silent),
    "a reply that never ends": raw(dripping),
    "endless repetition": raw(endless),
    "429 without Retry-After": 429,
    "429 with Retry-After": (429, {"retry-after": "0"}),
    "429 with a long Retry-After": (429, {"retry-after": "9999"}),
    "500": 500,
    "half an answer": raw(half),
    "a closed connection": raw(gone),
    "no JSON": b"{nonsense",
    "other JSON": b'{"hello": [1, 2]}',
    "JSON of another type": b"[1]",
}

CASES = [Case(str(n), f"task {n}", ("Walk kitchen",), True) for n in range(3)]


def asked_of(body):
    """The number in a request, of whichever role."""
    return int((body.get("input") or body["messages"][-1]["content"]).split("task ")[1][0])


def good(body):
    if "input" in body:
        return {"data": [{"embedding": [1.0, asked_of(body)]}], "usage": {"prompt_tokens": 2}}
    return "yes" if "judge" in body["messages"][0]["content"] else "[Grab] <milk> (1)"


def planned(model, knowledge):
    made = LanguagePlanner(model, knowledge)
    found = made.predict([Request(str(n), f"task {n}", "do it") for n in range(3)])
    return [steps is not None for steps in found], [str(code) for code in made.planned.unanswered]


def judged(model, _):
    chair = Judge(model)
    return [each.says is not None for each in chair.judge(CASES)], list(chair.faults)


def embedded(model, _):
    try:
        EndpointVectors(model)([f"task {n}" for n in range(3)])
    except HearthError as error:
        return [False] * 3, [str(error.diagnostics[0].code)]
    return [True] * 3, []


ROLES = {"planner": planned, "judge": judged, "vectors": embedded}


@pytest.mark.parametrize("role", ROLES)
@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_is_typed_and_the_rest_is_kept(role, fault, tmp_path, knowledge):
    """The second of three requests meets the fault; the same again asks for it alone."""
    spoilt = [True]
    means = {"cache": tmp_path / "c", "tries": 2, "seconds": 0.3, "at_once": 1}

    def answer(body):
        return FAULTS[fault] if spoilt[0] and asked_of(body) == 1 else good(body)

    with serving(answer) as (url, server):
        there, codes = ROLES[role](model_at(url, means), knowledge)
        assert codes == ["NO_ANSWER"] and not there[1]
        assert there == ([True, False, True] if role != "vectors" else [False] * 3)
        spoilt[0] = False
        before = len(server.asked)
        assert ROLES[role](model_at(url, means), knowledge) == ([True] * 3, [])
        assert {asked_of(body) for body in server.asked[before:]} <= {1, 2} - ({2} if role != "vectors" else set())


@pytest.fixture(scope="module")
def played():
    """A task for a model that acts, and one for a model that helps."""
    return {"actor": suite("household", "valid_seen", limit=1), "helper": suite("owah", "test", limit=1)}


@pytest.mark.parametrize("role", ["actor", "helper"])
@pytest.mark.parametrize("fault", FAULTS)
def test_an_episode_that_meets_a_fault_ends_with_its_code_and_the_same_command_goes_on(role, fault, tmp_path, played):
    """The second of three requests meets the fault; the same again asks from there."""
    out, spoilt, asking = tmp_path / "x.jsonl", [True], Asking(most_turns=3)
    means = Means(cache=tmp_path / "c", tries=1, seconds=2.0)

    def answer(body):
        asked[0] += 1
        return FAULTS[fault] if spoilt[0] and asked[0] == 2 else "wait"

    asked = [0]
    with serving(answer) as (url, _):
        name = f"llm:mini@{url}"
        which = (name,) if role == "actor" else ("human_like", name, "none")
        found = list(run(played[role], Lineup(*which, asking=asking, means=means), 1, out, default).records)
        assert found[-1].end["code"] == "NO_ANSWER" and len(found[-1].language[SEATS[role]]["turns"]) == 1
        assert verify(read(out), "x", default) == []
        spoilt[0] = False
        found = list(run(played[role], Lineup(*which, asking=asking, means=means), 1, out, default).records)
        assert found[-1].end is None and len(found[-1].language[SEATS[role]]["turns"]) == 3
    assert asked[0] == 4 and verify(read(out), "x", default) == []


SEATS = {"actor": "0", "helper": "1"}


def model_at(url, means):
    return Endpoint(url, "mini", Asking(most_tokens=8), Means(**means), sleep=lambda seconds: None)


def test_a_budget_leaves_cases_without_a_verdict_and_a_greater_one_goes_on(tmp_path):
    means = {"cache": tmp_path / "c", "prices": (0.0, 1e5), "at_once": 1}
    with serving(reply("yes", tokens=(5, 2))) as (url, server):
        few = Judge(Endpoint(url, "mini", Asking(most_tokens=2), Means(budget=0.5, **means)))
        assert [each.says for each in few.judge(CASES)] == [True, True, None] and few.faults == {"OVER_BUDGET": 1}
        more = Judge(Endpoint(url, "mini", Asking(most_tokens=2), Means(budget=9.0, **means)))
        assert [each.says for each in more.judge(CASES)] == [True] * 3 and len(server.asked) == 3


SECRET = "sk-secret-of-a-role-42424242"


def test_keys_are_in_no_verdict_vector_or_error(tmp_path, monkeypatch, made):
    """The server repeats the key in every answer and error."""
    monkeypatch.setenv("HEARTH_LLM_KEY", SECRET)
    predicted, shown = tmp_path / "predicted.jsonl", []
    with serving(f"[Grab] <milk> (1) {SECRET}") as (url, server), serving((403, {}, {"error": SECRET})) as (bad, _):
        for words in (
            ["model", "predict", f"llm:mini@{url}", made.out, "--part", "train", "--limit", "2", "--out", predicted],
            ["llm", "judge", f"llm:mini@{url}", predicted, "--dataset", made.out, "--out", tmp_path / "j.jsonl"],
            ["llm", "judge", f"llm:mini@{bad}", predicted, "--dataset", made.out, "--out", tmp_path / "k.jsonl"],
            ["llm", "judge", f"llm:mini@http://x/v1?k={SECRET}", predicted, "--out", tmp_path / "l.jsonl"],
            ["model", "retrieval", made.out, "--embed", f"llm:mini@http://{SECRET}@x/v1"],
            ["model", "retrieval", made.out, "--embed", f"llm:mini@{bad}", "--cache", tmp_path / "c"],
        ):
            result = CliRunner().invoke(cli.app, [*map(str, words)])
            shown.append(result.output + result.stderr + repr(result.exception))
    assert server.heads and all(heads["authorization"] == f"Bearer {SECRET}" for heads in server.heads)
    assert not [text for text in shown if SECRET in text] and "holds a user or a key" in shown[4]
    files = [path for path in tmp_path.rglob("*") if path.is_file()]
    assert len(files) >= 4 and not [path for path in files if SECRET.encode() in path.read_bytes()]
    if (tmp_path / "j.jsonl").exists() and (rows := (tmp_path / "j.jsonl").read_text().splitlines()):
        assert all("[key]" in json.loads(row)["answer"] for row in rows)
