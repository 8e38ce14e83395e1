"""Endpoints against a server that lies: retries, limits, cache, ledger, budget, and keys that stay secret."""

from __future__ import annotations

import sqlite3
import subprocess
import sys
import threading
import time
from email.utils import formatdate

import pytest
from lying_server import dripping, endless, gone, half, raw, reply, serving, silent

from hearth import Endpoint
from hearth.llm.addresses import LOCAL, is_here
from hearth.llm.answer_cache import AnswerCache
from hearth.llm.language_settings import Asking, Means
from hearth.llm.purse import Purse
from hearth.llm.timed_connections import stopped
from hearth.schemas.diagnostics import HearthError

SECRET = "sk-very-secret-9876543210"
HELLO = [{"role": "user", "content": "hello"}]


def test_an_honest_reply(asked):
    with serving("Walk fridge 1") as (url, server):
        found = asked(url).ask(HELLO)
    measured = (found.tokens_in, found.tokens_out, found.counted, found.tries)
    assert (found.text, *measured) == ("Walk fridge 1", 10, 2, True, 1)
    assert server.asked == [{"model": "mini", "messages": HELLO, "max_tokens": 256, "temperature": 0.0}]


@pytest.mark.parametrize("status", [408, 409, 425, 429, 500, 502, 503, 529])
def test_what_passes_is_asked_again_with_longer_waits(asked, waits, status):
    with serving(status, status, "wait") as (url, server):
        model = asked(url)
        assert model.ask(HELLO).tries == 3
    assert len(server.asked) == 3 and waits == [0.5, 1.0]
    assert model.spent.failed == ((str(status), 2),) and model.spent.tries == 3


@pytest.mark.parametrize(("header", "least", "most"), [("7", 7, 7), ("0", 0, 0), (None, 0.5, 0.5), ("soon", 0.5, 0.5)])
def test_a_server_says_how_long_to_wait(asked, waits, header, least, most):
    heads = {} if header is None else {"retry-after": header}
    with serving((429, heads), "wait") as (url, _):
        asked(url).ask(HELLO)
    assert len(waits) == 1 and least <= waits[0] <= most


def test_a_time_to_wait_may_be_a_date(asked, waits):
    with serving((503, {"retry-after": formatdate(time.time() + 20, usegmt=True)}), "wait") as (url, _):
        asked(url).ask(HELLO)
    assert 15 < waits[0] < 21


def test_a_server_that_asks_to_wait_for_an_hour_is_left(asked, waits):
    with serving((429, {"retry-after": "3600"})) as (url, server), pytest.raises(HearthError, match="wait 3600 s"):
        asked(url).ask(HELLO)
    assert len(server.asked) == 1 and waits == []


@pytest.mark.parametrize("status", [400, 401, 403, 404, 422])
def test_what_does_not_pass_is_not_asked_again(asked, status):
    with serving(status, "wait") as (url, server), pytest.raises(HearthError, match=f"NO_ANSWER.*{status}"):
        asked(url).ask(HELLO)
    assert len(server.asked) == 1


BROKEN = {
    "half": raw(half),
    "gone": raw(gone),
    "endless": raw(endless),
    "not JSON": b"<html>busy</html>",
    "empty": b"",
    "no choices": {"choices": []},
    "no message": {"choices": [{"text": "hello"}]},
    "no content": {"choices": [{"message": {"role": "assistant", "content": None}}]},
    "numbers": {"choices": [{"message": {"content": 7}}]},
    "a list": [1, 2],
    "not UTF-8": b'{"choices": [{"message": {"content": "\xff\xfe"}}]}',
}


@pytest.mark.parametrize("name", BROKEN)
def test_a_broken_reply_is_a_try_that_failed(asked, name):
    with serving(BROKEN[name], "wait") as (url, server):
        model = asked(url)
        assert model.ask(HELLO).text == "wait"
    assert len(server.asked) == 2 and len(model.spent.failed) == 1


@pytest.mark.parametrize("name", BROKEN)
def test_a_server_that_never_answers_right_is_typed(asked, name):
    with serving(BROKEN[name]) as (url, server), pytest.raises(HearthError, match=r"NO_ANSWER.*after 2 tries"):
        asked(url, tries=2).ask(HELLO)
    assert len(server.asked) == 2


@pytest.mark.parametrize("deed", [silent, dripping])
def test_no_reply_takes_longer_than_it_may(asked, deed):
    began = time.monotonic()
    with serving(raw(deed)) as (url, _), pytest.raises(HearthError, match="NO_ANSWER"):
        asked(url, tries=1, seconds=0.3).ask(HELLO)
    assert time.monotonic() - began < 3


@pytest.mark.parametrize("name", ["continues", "header lines", "a header line"])
def test_a_head_that_comes_slowly_takes_no_longer_either(asked, name):
    ok = b"HTTP/1.1 200 OK\r\n"
    heads = {"continues": (b"", b"HTTP/1.1 100 Continue\r\n\r\n"), "header lines": (ok, b"x: y\r\n"),
             "a header line": (ok + b"x: ", b"y")}  # fmt: skip

    def slowly(handler):
        first, more = heads[name]
        handler.wfile.write(first)
        for _ in range(200):
            handler.wfile.write(more)
            handler.wfile.flush()
            time.sleep(0.05)

    began = time.monotonic()
    with serving(raw(slowly)) as (url, _), pytest.raises(HearthError, match="NO_ANSWER"):
        asked(url, tries=1, seconds=0.5).ask(HELLO)
    assert time.monotonic() - began < 3


def test_a_stop_ends_requests_and_waits_of_other_threads(asked):
    with serving(raw(silent)) as (url, _):
        model = Endpoint(url, "mini", Asking(), Means(tries=4, seconds=50.0))
        found = []

        def ask():
            try:
                model.ask(HELLO)
            except HearthError as error:
                found.append(error)

        thread = threading.Thread(target=ask, daemon=True)
        thread.start()
        time.sleep(0.3)
        began = time.monotonic()
        with stopped():
            thread.join(5)
        assert len(found) == 1 and time.monotonic() - began < 2


@pytest.mark.parametrize(
    ("url", "here"),
    [("http://127.0.0.1:1/v1", True), ("http://[::1]/v1", True), ("http://localhost/v1", True),
     ("http://127.0.0.1.evil.org/v1", False), ("http://localhost.evil.org", False), ("https://api.openai.com", False)],
)  # fmt: skip
def test_addresses_of_this_machine(url, here):
    assert is_here(url) == here


def test_a_server_of_this_machine_is_asked_without_a_proxy(asked, monkeypatch):
    from hearth.llm import endpoint

    monkeypatch.setenv("HEARTH_LLM_KEY", SECRET)
    for name in ("NO_PROXY", "no_proxy"):
        monkeypatch.delenv(name, raising=False)
    with serving("of the proxy") as (proxy, spy), serving("of the server") as (url, _):
        for name in ("HTTP_PROXY", "http_proxy", "ALL_PROXY", "all_proxy"):
            monkeypatch.setenv(name, proxy.removesuffix("/v1"))
        endpoint._http.cache_clear()
        try:
            assert asked(url)("hello") == "of the server" and not spy.asked
        finally:
            endpoint._http.cache_clear()


def test_nobody_listens(asked):
    with serving("wait") as (url, _):
        pass
    with pytest.raises(HearthError, match=r"NO_ANSWER.*ConnectError") as raised:
        asked(url, tries=2).ask(HELLO)
    assert "hearth llm serve" in raised.value.diagnostics[0].suggestion


@pytest.mark.parametrize("status", [401, 403])
def test_a_key_that_is_refused_is_named_by_its_variable(asked, status):
    with serving(status) as (url, _), pytest.raises(HearthError, match=str(status)) as raised:
        asked(url).ask(HELLO)
    assert "HEARTH_LLM_KEY" in raised.value.diagnostics[0].suggestion


def test_a_budget_names_what_is_kept_for_replies_under_way():
    purse = Purse(Means(prices=(0.0, 1e6), budget=2.0))
    said = r"0\.0000 .* spent, 1\.0000 kept .*, .* cost 2\.0000"
    with purse.holding(0, 1), pytest.raises(HearthError, match=said), purse.holding(0, 2):
        pass


def test_redirections_are_not_followed(asked):
    with serving("wait") as (other, reached):
        with (
            serving((307, {"location": f"{other}/chat/completions"})) as (url, _),
            pytest.raises(HearthError, match="307"),
        ):
            asked(url).ask(HELLO)
        assert reached.asked == []


def test_a_tool_call_is_a_reply_and_thoughts_in_parts_are_joined(asked):
    call = {"type": "function", "function": {"name": "act", "arguments": '{"command": "Walk fridge 1"}'}}
    with serving(
        {"choices": [{"message": {"content": None, "tool_calls": [call]}}]},
        {"choices": [{"message": {"content": [{"type": "text", "text": "Walk "}, {"text": "fridge 1"}, {"x": 1}]}}]},
    ) as (url, _):
        model = asked(url)
        one, two = model.ask(HELLO), model.ask([*HELLO, *HELLO])
    assert '"command' in one.text and two.text == "Walk fridge 1"
    assert not one.counted and one.tokens_in > 0, "tokens are estimated where a server does not count"


@pytest.mark.parametrize("usage", [None, {}, {"prompt_tokens": -5, "completion_tokens": "many"}, 7])
def test_wrong_counts_are_estimated(asked, usage):
    with serving({**reply("wait"), "usage": usage}) as (url, _):
        found = asked(url).ask(HELLO)
    assert not found.counted and found.tokens_in > 5 and found.tokens_out == 1


def test_a_reply_that_was_cut_says_so(asked):
    with serving(reply("Walk fri", finish_reason="length")) as (url, _):
        assert asked(url).ask(HELLO).cut


def test_servers_that_want_the_other_name_of_the_length_get_it(asked):
    refused = {"error": {"message": "Use 'max_completion_tokens' instead."}}
    with serving((400, {}, refused), "wait") as (url, server):
        assert asked(url).ask(HELLO).text == "wait"
    assert "max_completion_tokens" in server.asked[1] and "max_tokens" not in server.asked[1]


def test_halves_of_characters_do_no_harm(asked, tmp_path):
    with serving(rb'{"choices": [{"message": {"content": "wait \ud83d"}}]}') as (url, _):
        try:
            text = asked(url, tries=1, cache=tmp_path / "c.sqlite").ask(HELLO).text
        except HearthError as error:  # a reader of JSON that refuses them is as good
            assert "NO_ANSWER" in str(error)
        else:
            text.encode()


# The cache, and what is stored


def test_nothing_is_asked_twice(asked, tmp_path):
    file = tmp_path / "kept.sqlite"
    with serving("one", "two", "three") as (url, server):
        first = asked(url, cache=file).ask(HELLO)
        again = asked(url, cache=file)
        assert again.ask(HELLO).text == "one" and again.sent == 0
        assert again.ask(HELLO, temperature=1.0).text == "two"
        assert asked(url, cache=file, asking=Asking(temperature=0.5)).ask(HELLO, seed=1).text == "three"
    assert len(server.asked) == 3 and not first.kept
    offline = asked(url, cache=file, offline=True)
    assert offline.ask(HELLO).kept
    with pytest.raises(HearthError, match="the cache has no reply"):
        offline.ask([{"role": "user", "content": "something else"}])


def test_a_prompt_asked_at_the_same_time_by_many_threads(asked, tmp_path):
    lock, now, most = threading.Lock(), [0], [0]

    def busy(body):
        with lock:
            now[0] += 1
            most[0] = max(most[0], now[0])
        time.sleep(0.02)
        with lock:
            now[0] -= 1
        return body["messages"][0]["content"]

    with serving(busy) as (url, _):
        model = asked(url, at_once=3, cache=tmp_path / "c.sqlite")
        said = {}
        threads = [threading.Thread(target=lambda n=n: said.update({n: model(f"prompt {n}")})) for n in range(20)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    assert said == {n: f"prompt {n}" for n in range(20)} and most[0] <= 3
    assert model.spent.replies == 20


@pytest.mark.parametrize("data", [b"not a database at all", b"SQLite format 3\0" + b"x" * 4096])
def test_a_cache_that_is_something_else_is_refused(tmp_path, data):
    file = tmp_path / "other.sqlite"
    file.write_bytes(data)
    with pytest.raises(HearthError) as error:
        Endpoint(LOCAL, "mini", means=Means(cache=file))
    assert str(error.value.diagnostics[0].code) in ("DAMAGED_FILE", "UNWRITABLE") and file.read_bytes() == data


def test_a_database_of_somebody_else_is_left_alone(tmp_path):
    file = tmp_path / "other.sqlite"
    with sqlite3.connect(file) as other:
        other.execute("CREATE TABLE answers (x)")
    with pytest.raises(HearthError, match="a database of something else"):
        Endpoint(LOCAL, "mini", means=Means(cache=file))


def test_the_budget_is_kept(asked, tmp_path):
    """Prices are of a million tokens: a reply here costs 10 * 1 + 2 * 5 = 20 millionths."""
    means = {"prices": (1.0, 5.0), "cache": tmp_path / "c.sqlite"}
    asking = Asking(most_tokens=2)
    with serving("wait") as (url, server):
        model = asked(url, asking=asking, budget=100e-6, **means)
        with pytest.raises(HearthError, match="OVER_BUDGET"):
            for number in range(100):
                model(f"prompt {number}")
        assert model.purse.spent <= 100e-6 and len(server.asked) == model.spent.replies > 1
        more = asked(url, asking=asking, budget=200e-6, **means)
        assert more.purse.spent == pytest.approx(20e-6 * len(server.asked))
        number = len(server.asked)
        assert more("prompt 0") == "wait" and len(server.asked) == number, "what is kept costs nothing"
        more("one more")
    assert len(server.asked) == number + 1


def test_threads_that_begin_together_share_an_endpoint(tmp_path):
    """Two endpoints would not share a budget, and would lock each other out of the file."""
    from hearth.llm.endpoint import endpoint_of

    found, start = [], threading.Barrier(8)

    def begin():
        start.wait()
        found.append(endpoint_of("llm:mini", Asking(), Means(cache=tmp_path / "shared.sqlite")))

    threads = [threading.Thread(target=begin) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(found) == 8 and len(set(map(id, found))) == 1


def test_processes_that_begin_together_share_a_cache(tmp_path):
    code = (
        "import sys; from pathlib import Path; from hearth.llm.answer_cache import AnswerCache\n"
        "from hearth.llm.replies import Reply\n"
        "cache = AnswerCache(Path(sys.argv[1]))\n"
        "[cache.put(f'{sys.argv[2]}-{n}', 'mini', Reply('x')) for n in range(20)]"
    )
    words = [sys.executable, "-c", code, str(tmp_path / "shared.sqlite")]
    running = [subprocess.Popen([*words, str(n)]) for n in range(4)]
    assert [process.wait() for process in running] == [0] * 4
    assert AnswerCache(tmp_path / "shared.sqlite").spent("mini").replies == 80


# Keys
