"""Language models as agents of episodes: how results describe them, and their answers as results keep them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from hearth.agents.protocol import Agent
from hearth.envs.text_protocol_settings import protocol
from hearth.llm.actor import Actor
from hearth.llm.addresses import is_model, read_name
from hearth.llm.agent_eyes import Eyes
from hearth.llm.endpoint import endpoint_of
from hearth.llm.language_settings import BOUNDS, Asking, Means
from hearth.llm.legal_commands import form_of
from hearth.llm.probe import need_sight
from hearth.llm.prompt_pages import page
from hearth.llm.turns import is_transcript
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.optional_libraries import lacking, remedy

WAITING = 86_400.0
"""Seconds that a language model's agent may take for a tick: each request has its own limit."""

AGENTS = ("0", "1")
"""The numbers of agents, as keys of JSON."""

COUNTED = ("memory", "most_turns")
"""The settings by which recorded answers are read again."""

MOST_DESCRIBED = 40
"""Facts about a language model in a file of results, at most."""


def need_model(name: str) -> None:
    """Look whether a language model's name can be used.

    Raises:
        HearthError: BAD_ARGUMENT: it is no name, or its address holds a key; MISSING_FILE: the extra `llm` is lacking.
    """
    read_name(name)
    if lacking("llm"):
        message = "language models are asked by httpx2, which is not installed"
        raise HearthError.of(Code.MISSING_FILE, message, suggestion=remedy("llm"))


def need_models(names: Sequence[str], engine: str, *, given: bool) -> None:
    """Look whether a run has the language models that its options are about.

    Args:
        names: of its agents.
        engine: where it is played.
        given: whether options of language models are given.

    Raises:
        HearthError: BAD_ARGUMENT: none of the agents is a language model, or the run is on a cluster, whose machines do
            not share a cache and a budget.
    """
    some = any(map(is_model, names))
    if given and not some:
        message = "--llm, --images, --cache, --prices and --budget are about language models, and no agent is one"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="name an agent llm:MODEL@URL")
    if some and engine != "local":
        message = "language models are asked from one machine, which has the cache and the budget"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="leave out --engine")


def described(name: str, number: int, asking: Asking, means: Means) -> dict[str, Any]:
    """Return a language model as results describe it: with everything that decides what it is asked."""
    model, url = read_name(name)
    url = dict(means.given)[name].url if name in dict(means.given) else url
    words, prompt = protocol(), page("helper" if number else "actor")
    prices = {} if means.prices is None else {"price_in": means.prices[0], "price_out": means.prices[1]}
    return {
        "model": model,
        "url": url,
        "protocol": words.name,
        "protocol_fingerprint": words.fingerprint,
        "prompt": prompt.name,
        "prompt_fingerprint": prompt.fingerprint,
        **asking.as_json(),
        **prices,
    }


def player_of(name: str, asking: Asking, means: Means, instruction: str, messages: bool, number: int) -> Agent:
    """Return a new agent that a language model decides for."""
    endpoint = endpoint_of(name, asking, means)
    form = form_of(endpoint) if asking.constrained else ""
    if asking.images:
        need_sight(endpoint)
    return Actor(endpoint.ask, asking, instruction, messages, number, form, Eyes if asking.images else None)


def spending(names: Sequence[str], asking: Asking, means: Means) -> str:
    """Return the tokens and the cost of a run's language models until now, for a progress line; "" for none."""
    return ", ".join(endpoint_of(name, asking, means).spending() for name in names if is_model(name))


def requests_sent(names: Sequence[str], asking: Asking, means: Means) -> int:
    """Return how many requests this process has made for the language models of a run; kept replies need none."""
    return sum(endpoint_of(name, asking, means).sent for name in names if is_model(name))


def transcripts(players: Sequence[Any]) -> dict[str, Any] | None:
    """Return the answers of the language models among the guarded agents of an episode; None where there are none."""
    agents = [getattr(player.agent, "agent", None) for player in players]
    found = {str(n): agent.transcript.as_json() for n, agent in enumerate(agents) if isinstance(agent, Actor)}
    return found or None


def is_described(given: Any) -> bool:
    """Return whether a value of JSON, perhaps a stranger's, describes language models by their numbers."""
    return isinstance(given, dict) and set(given) <= set(AGENTS) and all(map(_is_one, given.values()))


def _is_one(given: Any) -> bool:
    return (
        isinstance(given, dict)
        and len(given) <= MOST_DESCRIBED
        and all(isinstance(value, (str, int, float, bool)) and len(str(value)) < 500 for value in given.values())
        and {"model", "protocol_fingerprint", "prompt_fingerprint", *COUNTED} <= set(given)
        and all(type(given[name]) is int and BOUNDS[name][0] <= given[name] <= BOUNDS[name][1] for name in COUNTED)
        and all(type(given.get(name, 0)) in (int, float) for name in ("price_in", "price_out"))
    )


def are_transcripts(given: Any) -> bool:
    """Return whether a value of JSON, perhaps a stranger's, is what `transcripts` returns."""
    return isinstance(given, dict) and set(given) <= set(AGENTS) and all(map(is_transcript, given.values()))


def same_words(facts: Mapping[str, Any], number: int) -> bool:
    """Return whether the prompts of a described model are still written with the same words."""
    prompt = page("helper" if number else "actor")
    return (facts["protocol_fingerprint"], facts["prompt_fingerprint"]) == (
        protocol().fingerprint,
        prompt.fingerprint,
    )
