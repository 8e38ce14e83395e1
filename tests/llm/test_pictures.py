"""Pictures for models that see: the form in which they are sent, their cost, and models that see none."""

from __future__ import annotations

import json
from base64 import b64decode
from dataclasses import replace

import pytest
from lying_server import reply, serving
from typer.testing import CliRunner

from hearth import cli
from hearth.challenges.episode_agents import Lineup
from hearth.challenges.result_files import first_line, line, read
from hearth.challenges.suite_runs import run
from hearth.challenges.task_files import suite, write
from hearth.challenges.verification import verify
from hearth.kb.loading.load import default
from hearth.llm.agent_eyes import SIZE
from hearth.llm.endpoint import Endpoint
from hearth.llm.language_settings import Asking, Means
from hearth.llm.picture_messages import PICTURE_TOKENS
from hearth.llm.probe import SQUARES, need_sight, probe
from hearth.rendering.film.png import decode
from hearth.schemas.diagnostics import HearthError

PICTURED = Asking(memory=2, most_turns=3, images=True)

COMMANDS = ("Walk kitchen", "Walk bedroom", "wait")


def pictures(body):
    """The data URLs of a request, by the schema of the chat protocol; anything else in a content is an error."""
    found = []
    for message in body["messages"]:
        for part in message["content"] if isinstance(message["content"], list) else ():
            if part["type"] == "text":
                assert isinstance(part["text"], str) and set(part) == {"type", "text"}
            else:
                assert set(part) == {"type", "image_url"} and set(part["image_url"]) == {"url", "detail"}
                assert part["type"] == "image_url" and part["image_url"]["detail"] in ("low", "high", "auto")
                found.append(part["image_url"]["url"])
    return found


def seeing(body):
    """A model that sees: it knows the colours of the probe, and walks in an episode."""
    shown = pictures(body)
    for colour, url in SQUARES.items():
        if url in shown:
            return f"It is {colour}."
    turn = sum(message["role"] == "assistant" for message in body["messages"])
    return COMMANDS[min(turn, 2)] if shown else "Hello"


def lineup(url, asking=PICTURED, **means):
    return Lineup(f"llm:mini@{url}", asking=asking, means=Means(**{"tries": 2, **means}))


@pytest.fixture(scope="module")
def tasks():
    return suite("household", "valid_seen", limit=1)


@pytest.fixture(scope="module")
def results(tasks, tmp_path_factory):
    out = tmp_path_factory.mktemp("pictures") / "mine.jsonl"
    with serving(seeing) as (url, server):
        found = run(tasks, lineup(url), 1, out, default)
        again = run(tasks, lineup(url), 1, out.with_name("again.jsonl"), default)
    return out, found, again, [body for body in server.asked if "colour" not in json.dumps(body)]


def test_each_prompt_has_the_first_person_picture_in_its_last_message(results):
    _, found, _, asked = results
    turns = next(iter(found.records)).language["0"]
    assert turns["pictures"] == 3 == len(turns["turns"]) and found.header.language["0"]["images"] is True
    shown = [pictures(body) for body in asked[:3]]
    assert [len(urls) for urls in shown] == [1, 1, 1] and len({urls[0] for urls in shown}) > 1
    for body, (url,) in zip(asked, shown, strict=False):
        kind, _, data = url.partition(",")
        assert kind == "data:image/png;base64" and isinstance(body["messages"][-1]["content"], list)
        picture = decode(b64decode(data))
        assert picture.shape == (SIZE[1], SIZE[0], 3) and picture.std() > 10, "it shows something"


def test_the_same_episode_has_the_same_pictures(results):
    _, found, again, asked = results
    assert len(asked) == 3, "the second run had the same prompts, to the byte, and their replies were kept"
    one, other = (next(iter(each.records)).language["0"] for each in (found, again))
    assert one["turns"] == other["turns"] and one["asked"] == other["asked"]


def test_the_episode_verifies_and_a_left_out_picture_is_found(results, tmp_path):
    out = results[0]
    assert verify(read(out), "x", default) == []
    facts = {name: value for name, value in results[1].header.language["0"].items() if name != "images"}
    header = replace(results[1].header, language={"0": facts})
    changed = tmp_path / "changed.jsonl"
    changed.write_bytes(first_line(header) + b"".join(line(header, each) for each in results[1].records))
    (fault,) = verify(read(changed), "x", default)
    assert "agent 0 is another than was recorded" in fault.message


def test_without_pictures_nothing_of_a_file_changes(tasks, tmp_path):
    with serving("wait") as (url, server):
        found = run(tasks, lineup(url, Asking(most_turns=1)), 1, tmp_path / "x.jsonl", default)
    assert "images" not in found.header.language["0"] and b"pictures" not in (tmp_path / "x.jsonl").read_bytes()
    assert isinstance(server.asked[0]["messages"][-1]["content"], str)


@pytest.mark.parametrize(
    ("answer", "finding", "said"),
    [
        (seeing, "obeyed", ""),
        ("Red, I guess.", "ignored", "does not distinguish a red picture from a blue one"),
        ("red or blue", "ignored", "does not distinguish"),
        (lambda body: 400 if pictures(body) else "Hello", "refused", "refuses pictures"),
    ],
)
def test_the_probe_finds_models_that_see_nothing(answer, finding, said):
    with serving(answer) as (url, _):
        model = Endpoint(url, "mini", means=Means(tries=1))
        assert probe(model)["images"] == finding
        if said:
            with pytest.raises(HearthError, match=said):
                need_sight(model)
        else:
            need_sight(model)


def test_a_run_with_pictures_is_refused_where_nobody_sees_them(tasks, tmp_path):
    file, out = tmp_path / "tasks.json", tmp_path / "x.jsonl"
    write(file, tasks)
    with serving(lambda body: 400 if pictures(body) else "wait") as (url, server):
        words = ["challenge", "run", str(file), "--main", f"llm:mini@{url}", "--images", "--out", str(out)]
        shown = CliRunner().invoke(cli.app, words)
    assert shown.exit_code == 1 and "refuses pictures" in shown.output and not out.exists()
    assert all(pictures(body) for body in server.asked), "nothing was asked without pictures instead"


def test_pictures_are_refused_where_no_agent_is_a_model_and_where_texts_alone_are_read(tasks, tmp_path):
    file = tmp_path / "tasks.json"
    write(file, tasks)
    run_words = ["challenge", "run", str(file), "--images", "--out", str(tmp_path / "x.jsonl")]
    judge_words = ["llm", "judge", "llm:mini", str(file), "--llm", "images=yes", "--out", str(tmp_path / "x.jsonl")]
    for words, said in ((run_words, "no agent is one"), (judge_words, "shown no pictures")):
        shown = CliRunner().invoke(cli.app, words)
        assert shown.exit_code == 1 and said in shown.output


def chat(url):
    return [{"role": "user", "content": [{"type": "text", "text": "look"}, {"type": "image_url", "image_url": url}]}]


def test_a_picture_costs_its_tokens_and_not_its_letters():
    """The server counts; where it does not, a picture counts as so many tokens, however long its letters are."""
    large = {"url": "data:image/png;base64," + "A" * 400_000}
    with serving(reply("seen", tokens=(300, 5)), {"choices": [{"message": {"content": "seen"}}]}) as (url, _):
        model = Endpoint(url, "mini", means=Means(prices=(1.0, 1.0), budget=0.02))
        counted, estimated = model.ask(chat(large)), model.ask(chat({**large, "detail": "low"}))
    assert (counted.tokens_in, counted.counted) == (300, True)
    assert not estimated.counted and PICTURE_TOKENS <= estimated.tokens_in < PICTURE_TOKENS + 100


def test_a_budget_counts_pictures_before_they_are_sent():
    with serving("seen") as (url, server):
        model = Endpoint(url, "mini", means=Means(prices=(1.0, 1.0), budget=0.003))
        with pytest.raises(HearthError, match="OVER_BUDGET"):
            model.ask(chat({"url": "data:image/png;base64,AAAA"}))
    assert server.asked == []
