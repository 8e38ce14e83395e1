"""A probe of a chat server: which parts of a request it obeys. Servers take fields that they ignore."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

from hearth.kb.tools.line_grammars import line_grammar
from hearth.llm.constraints import FORMS, keeps
from hearth.llm.endpoint import Endpoint
from hearth.llm.picture_messages import pictured
from hearth.llm.replies import Reply, read_reply
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

OBEYED, IGNORED, REFUSED = "obeyed", "ignored", "refused"
"""The findings about a part of a request; `refused` is an error of the server."""

ODD = line_grammar([["zebra ", ("1741", "2853")], ["quartz ", ("39", "58")]])
"""A grammar of answers that no model gives by itself."""

GREETING = "Say hello in one short sentence."
COUNT = "Count from 1 to 200, separated by spaces: 1 2 3 4"

COLOUR = "What colour is this picture? Answer with one word: red, green, blue or yellow."

SQUARES = {
    "red": (
        "data:image/png;base64,"
        "iVBORw0KGgoAAAANSUhEUgAAAEAAAABACAIAAAAlC+aJAAAAT0lEQVR42u3PQQkAAAgEsAtx/ZMZxgi+hcEKLNO+FgEBAQEBAQEB"
        "AQEBAQEBAQEBAQEBAQEBAQEBAQEBAQEBAQEBAQEBAQEBAQEBAQEBAQGBywKqxUDxqh7TUQAAAABJRU5ErkJggg=="
    ),
    "blue": (
        "data:image/png;base64,"
        "iVBORw0KGgoAAAANSUhEUgAAAEAAAABACAIAAAAlC+aJAAAAT0lEQVR42u3PQQkAAAgEsAtx/ZMZxgi+hcEKLO28FgEBAQEBAQEB"
        "AQEBAQEBAQEBAQEBAQEBAQEBAQEBAQEBAQEBAQEBAQEBAQEBAQEBAQGBywKpTkDxtnpV5wAAAABJRU5ErkJggg=="
    ),
}
"""Pictures of one colour."""

IMAGES = "images"
"""The finding about pictures."""

TOOL = {
    "type": "function",
    "function": {
        "name": "act",
        "description": "Do a command in the home.",
        "parameters": {"type": "object", "properties": {"command": {"type": "string"}}, "required": ["command"]},
    },
}


def probe(endpoint: Endpoint) -> dict[str, Any]:
    """Ask a server about twenty short questions, and return which parts of a request it obeys.

    The findings about grammars and pictures are kept in the endpoint's cache, for runs.

    Raises:
        HearthError: NO_ANSWER: it does not answer even a plain question.
    """
    few = _impatient(endpoint)
    plain = _reply(few, GREETING)
    facts: dict[str, Any] = {
        "model": endpoint.model,
        "url": endpoint.url,
        "says": plain.text.strip()[:80],
        "counts_tokens": plain.counted,
        "seconds": plain.seconds,
        "max_tokens": _finding(lambda: _reply(few, COUNT, max_tokens=5), lambda reply: len(reply.text) < 60),
        "stop": _finding(lambda: _reply(few, COUNT, stop=["7"], max_tokens=60), lambda reply: "7" not in reply.text),
        "repeats_itself": _finding(lambda: _reply(few, GREETING), lambda reply: reply.text == plain.text),
        "n": _finding(lambda: _json(few, GREETING, n=2), lambda given: len(given.get("choices", [])) == 2),
        "logprobs": _finding(lambda: _json(few, GREETING, logprobs=True), _has_logprobs),
        "tools": _finding(
            lambda: _json(few, "Open the fridge with number 7.", tools=[TOOL], tool_choice="required"), _calls
        ),
        IMAGES: _sees(few),
    }
    found = {**facts, **_grammars(few)}
    _keep(endpoint, found)
    return found


def grammar_facts(endpoint: Endpoint) -> Mapping[str, Any]:
    """Return which grammars a server obeys, of an earlier probe or of one made now."""

    known = _known(endpoint)
    if any(form not in known for form in FORMS):
        known = {**known, **_grammars(_impatient(endpoint))}
        _keep(endpoint, known)
    return known


def need_sight(endpoint: Endpoint) -> None:
    """Look whether a server's model sees pictures, by an earlier probe or by one made now.

    Raises:
        HearthError: BAD_ARGUMENT: it does not; what it answers would be without them, and nobody would notice.
    """
    known = _known(endpoint)
    if IMAGES not in known:
        known = {**known, IMAGES: _sees(_impatient(endpoint))}
        _keep(endpoint, known)
    if known[IMAGES] != OBEYED:
        how = "refuses pictures" if known[IMAGES] == REFUSED else "does not distinguish a red picture from a blue one"
        message = f"`{endpoint.model}` at {endpoint.where} {how}"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="leave out images, or take a model that sees")


def _known(endpoint: Endpoint) -> Mapping[str, Any]:
    import orjson

    return dict(orjson.loads(endpoint.cache.facts(endpoint.model, endpoint.url) or "{}"))


def _keep(endpoint: Endpoint, found: Mapping[str, Any]) -> None:
    import orjson

    facts = {name: found[name] for name in (*FORMS, IMAGES) if name in found}
    endpoint.cache.put_facts(endpoint.model, endpoint.url, orjson.dumps(facts).decode())


def _impatient(endpoint: Endpoint) -> Endpoint:
    """Return an endpoint of the same server that keeps nothing, and tries twice; a server may fail at a field."""
    means = replace(endpoint.means, tries=2, cache=None, budget=None, offline=False)
    return endpoint.like(
        means, replace(endpoint.asking, temperature=min(endpoint.asking.temperature, 0.0), most_tokens=48)
    )


def _grammars(endpoint: Endpoint) -> dict[str, str]:
    return {
        form: _finding(
            lambda fields=fields: _reply(endpoint, GREETING, **fields(ODD)),  # type: ignore[misc]
            lambda reply, form=form: keeps(reply.text, ODD, form),  # type: ignore[misc]
        )
        for form, fields in FORMS.items()
    }


def _finding(ask: Callable[[], Any], obeys: Callable[[Any], bool]) -> str:
    try:
        return OBEYED if obeys(ask()) else IGNORED
    except HearthError as error:
        if error.diagnostics[0].code is not Code.NO_ANSWER:
            raise
        return REFUSED


def _json(endpoint: Endpoint, question: Any, **more: Any) -> Mapping[str, Any]:
    given = endpoint.exchange([{"role": "user", "content": question}], **more)
    return given if isinstance(given, Mapping) else {}


def _reply(endpoint: Endpoint, question: Any, **more: Any) -> Reply:
    """Return the reply to a question; none of the cache, because a server may answer otherwise the second time."""
    import time

    began = time.monotonic()
    reply = read_reply(_json(endpoint, question, **more), len(str(question)))
    if reply is None:
        raise HearthError.of(Code.NO_ANSWER, f"{endpoint.where} gave JSON without a message")
    return replace(reply, seconds=round(time.monotonic() - began, 3))


def _sees(endpoint: Endpoint) -> str:
    """Return whether the model distinguishes two colours: a server that drops pictures gives the same answer twice."""

    def colours() -> list[str]:
        return [_reply(endpoint, pictured(COLOUR, url)).text.lower() for url in SQUARES.values()]

    return _finding(colours, lambda said: "red" in said[0] and "blue" in said[1] and "red" not in said[1])


def _has_logprobs(given: Mapping[str, Any]) -> bool:
    choices = given.get("choices")
    return (
        isinstance(choices, list)
        and bool(choices)
        and isinstance(choices[0], dict)
        and bool(choices[0].get("logprobs"))
    )


def _calls(given: Mapping[str, Any]) -> bool:
    try:
        return bool(given["choices"][0]["message"]["tool_calls"][0]["function"]["name"] == "act")
    except (KeyError, IndexError, TypeError):
        return False
