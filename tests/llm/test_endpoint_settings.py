"""Keys, names and settings of endpoints, and clients of one's own."""

from __future__ import annotations

import os

import pytest
from lying_server import reply, serving

from hearth import Endpoint
from hearth.llm.addresses import LOCAL, checked_url, key_for, read_name
from hearth.llm.language_settings import Asking, Means, read_settings
from hearth.schemas.diagnostics import HearthError

HELLO = [{"role": "user", "content": "hello"}]


SECRET = "sk-very-secret-9876543210"


@pytest.mark.parametrize(
    "url",
    [
        f"http://user:{SECRET}@127.0.0.1/v1", f"http://{SECRET}@127.0.0.1/v1", f"https://x.org/v1?key={SECRET}",
        f"https://x.org/v1?{SECRET}", f"https://x.org/v1#{SECRET}", f"https://x.org/v1?api-version=1&k={SECRET}",
        f"ftp://x.org/{SECRET}", f"http://x.org:port/{SECRET}", f"http://[{SECRET}", f"file:///{SECRET}",
        f"http://x.org/v1\n{SECRET}",
    ],
)  # fmt: skip
def test_an_address_with_a_key_is_refused_and_not_repeated(url):
    for act in (lambda: checked_url(url), lambda: read_name(f"llm:mini@{url}"), lambda: Endpoint(url, "mini")):
        with pytest.raises(HearthError) as error:
            act()
            raise AssertionError(url)
        assert SECRET not in str(error.value) and SECRET not in repr(error.value.diagnostics)


def test_a_key_goes_to_the_server_and_nowhere_else(asked, tmp_path, monkeypatch, capfd, caplog):
    """The server repeats the key in a reply and in an error."""
    monkeypatch.setenv("HEARTH_LLM_KEY", SECRET)
    file = tmp_path / "c.sqlite"
    refused = {"error": {"message": f"the key {SECRET} may not"}}
    with serving(f"your key is {SECRET}", (403, {}, refused)) as (url, server):
        model = asked(url, cache=file)
        assert model("hello") == "your key is [key]"
        with pytest.raises(HearthError) as error:
            model("again")
    assert [heads["authorization"] for heads in server.heads] == [f"Bearer {SECRET}"] * 2
    model.cache.close()
    seen = [str(error.value), repr(model), *capfd.readouterr(), caplog.text]
    assert "[key]" in seen[0] and not any(SECRET in each for each in seen)
    assert all(SECRET.encode() not in path.read_bytes() for path in tmp_path.iterdir())


@pytest.mark.parametrize("key", ["sk-A\nsk-B", "sk-A\r\nX-Other: sk-B", "sk-A\0sk-B", "sk-Ä", "sk-\u200b", "k" * 5000])
def test_a_key_that_no_header_can_have_is_refused_before_anything_is_sent(asked, tmp_path, monkeypatch, key):
    monkeypatch.setattr(os, "environ", {**os.environ, "HEARTH_LLM_KEY": key, "OTHER": key})
    with serving("hello") as (url, server):
        for more in ({}, {"key": "OTHER"}):
            with pytest.raises(HearthError, match="BAD_ARGUMENT") as error:
                asked(url, cache=tmp_path / "c.sqlite", **more)("hello")
            assert key not in repr(error.value.diagnostics) and "sk-A" not in repr(error.value.diagnostics)
    assert server.asked == [] and not (tmp_path / "c.sqlite").exists()


def test_a_key_with_blanks_around_it_is_the_key(monkeypatch):
    monkeypatch.setenv("HEARTH_LLM_KEY", " sk-A\n")
    assert key_for(LOCAL) == "sk-A"


def test_keys_of_a_host_go_to_that_host_alone(monkeypatch):
    for name in ("HEARTH_LLM_KEY", "OPENAI_API_KEY", "OPENROUTER_API_KEY"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("OPENAI_API_KEY", SECRET)
    assert key_for("https://api.openai.com/v1") == SECRET
    assert key_for("https://api.openai.com.evil.org/v1") == "" and key_for(LOCAL) == ""
    monkeypatch.setenv("MINE", "another")
    assert key_for(LOCAL, "MINE") == "another"


# Names, settings, clients


def test_names(monkeypatch):
    assert read_name("llm:mini@http://host:1/v1/") == ("mini", "http://host:1/v1")
    assert read_name("llm:org/mini:free@https://openrouter.ai/api/v1")[0] == "org/mini:free"
    assert read_name("llm:mini") == ("mini", LOCAL)
    monkeypatch.setenv("HEARTH_LLM_URL", "http://other/v1")
    assert read_name("llm:mini") == ("mini", "http://other/v1")
    for wrong in ("llm:", "llm:@http://x/v1", "llm:a b", "mini@http://x/v1"):
        with pytest.raises(HearthError, match="BAD_ARGUMENT"):
            read_name(wrong)


def test_settings():
    asking, means = read_settings(["temperature=0.5", "memory=0", "constrained=yes", "tries=2"], None, "1,2", 3.0)
    assert asking == Asking(0.5, memory=0, constrained=True) and (means.tries, means.prices, means.budget) == (
        2,
        (1, 2),
        3,
    )
    for wrong in (
        "heat=1",
        "temperature=hot",
        "temperature=nan",
        "memory=-1",
        "tries=0",
        "constrained=perhaps",
        "cache=x",
    ):
        with pytest.raises(HearthError, match="BAD_ARGUMENT"):
            read_settings([wrong])
    with pytest.raises(HearthError, match=r"`one` is no value of the setting `memory`.*whole number from 0 to 10,000"):
        read_settings(["memory=one"])
    for prices in ("1", "1,2,3", "a,b", "-1,2", "nan,1", "inf,1"):
        with pytest.raises(HearthError, match="BAD_ARGUMENT"):
            read_settings([], prices=prices)
    with pytest.raises(HearthError, match="a budget needs prices"):
        read_settings([], budget=1.0)


class OfOpenAI:
    """A client with the shape of that of the package `openai`."""

    class chat:
        class completions:
            @staticmethod
            def create(**body):
                return type("Reply", (), {"model_dump": lambda self: reply(body["messages"][-1]["content"].upper())})()


@pytest.mark.parametrize("client", [lambda messages: messages[-1]["content"].upper(), OfOpenAI()])
def test_a_client_of_ones_own(client):
    assert Endpoint(model="mine", client=client)("wait") == "WAIT"


def test_a_client_that_fails_is_typed():
    def fail(messages):
        raise KeyError("what")

    for client in (fail, lambda messages: None):
        with pytest.raises(HearthError, match="NO_ANSWER: the client gave no reply"):
            Endpoint(model="mine", client=client, means=Means(tries=1))("wait")
