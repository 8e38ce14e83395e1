"""An endpoint: a language model of a server that speaks the chat protocol of OpenAI, with a cache and a budget."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from hashlib import blake2b
from typing import Any
from urllib.parse import urlsplit

from hearth.llm.addresses import checked_url, is_here, key_for, read_name, without_key
from hearth.llm.answer_cache import AnswerCache, Spent
from hearth.llm.language_settings import Asking, Means
from hearth.llm.picture_messages import PICTURE_TOKENS, pictures_in, without_pictures
from hearth.llm.purse import Purse
from hearth.llm.replies import CHARACTERS, Reply, read_reply
from hearth.llm.requests_with_retries import Failed, post, with_retries
from hearth.llm.timed_connections import client, pause
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

Message = Mapping[str, Any]
"""A message of a chat: `role` and `content`."""

Client = Callable[[Sequence[Message]], str]
"""A client of one's own: it gets the messages and returns the reply; or an object as that of the package `openai`."""

OWN = "client:"
"""The address of a model that is asked through a client of one's own."""

CHAT = "chat/completions"
"""The path of chats behind a server's address."""

LONGER = "max_completion_tokens"
"""The other name of `max_tokens`, which some servers insist on."""


class Endpoint:
    """A language model of a server.

    Args:
        url: the server's address, such as `http://127.0.0.1:8080/v1`; without a key.
        model: the model's name at the server.
        asking: the settings that change what it is asked.
        means: tries, times, cache, prices, budget.
        client: asks instead of the server at `url`.

    Attributes:
        sent: requests made since it was created; replies of the cache need none.

    Raises:
        HearthError: BAD_ARGUMENT: the address holds a key, or is none; the errors of `AnswerCache`; MISSING_FILE: the
            extra `llm` is not installed.

    Examples:
        >>> model = hearth.Endpoint(model="parrot", client=lambda messages: messages[-1]["content"])
        >>> model("Walk fridge 142")
        'Walk fridge 142'
    """

    def __init__(
        self,
        url: str = "",
        model: str = "",
        asking: Asking | None = None,
        means: Means | None = None,
        *,
        client: Client | Any = None,
        sleep: Callable[[float], None] = pause,
    ) -> None:
        self.url = OWN if client is not None else checked_url(url)
        self.model, self.asking, self.means = model, asking or Asking(), means or Means()
        self._client, self._sleep = client, sleep
        self._key = "" if client is not None else key_for(self.url, self.means.key)
        self._room = threading.BoundedSemaphore(self.means.at_once)
        self.cache = AnswerCache(self.means.cache)
        spent = self.cache.spent(model)
        self.purse = Purse(self.means, self.means.cost(spent.tokens_in, spent.tokens_out))
        self.sent = 0
        self._length = "max_tokens"

    def __repr__(self) -> str:
        return f"Endpoint({self.model!r} at {self.where})"

    @property
    def where(self) -> str:
        """Return the server's host, for messages."""
        return "the client" if self._client is not None else urlsplit(self.url).netloc

    @property
    def spent(self) -> Spent:
        """Return the sums of the ledger; those of a cache that is kept include earlier runs."""
        return self.cache.spent(self.model)

    def spending(self) -> str:
        """Return the tokens and the cost until now, in words for a progress line."""
        spent = self.spent
        cost = f", {self.purse.spent:.4f} spent" if self.means.prices else ""
        return f"{spent.tokens_in + spent.tokens_out:,} tokens{cost}"

    def __call__(self, prompt: str) -> str:
        """Return the reply to a single prompt, as text agents ask."""
        return self.ask([{"role": "user", "content": prompt}]).text

    def ask(self, messages: Sequence[Message], seed: int = 0, **more: Any) -> Reply:
        """Return the reply to a chat, of the cache if it was asked before.

        Args:
            messages: the chat.
            seed: of the model's choices; nothing is sent of it at temperature 0.
            more: further fields of the request, such as a constraint.

        Raises:
            HearthError: NO_ANSWER: no try brought a reply; OVER_BUDGET; DAMAGED_FILE and UNWRITABLE of the cache.
        """
        body = self._body(messages, seed, more)
        size = _size(messages)
        return self.kept_or_asked(body, size, self.asking.most_tokens, lambda: self._asked(body, size))

    def exchange(self, messages: Sequence[Message], **more: Any) -> Any:
        """Return the JSON of a reply as the server wrote it; nothing is kept, and the budget is not asked.

        Raises:
            HearthError: NO_ANSWER.
        """
        once = self._through_client if self._client is not None else self._through_server
        body = self._body(messages, 0, more)
        return with_retries(lambda: once(body), self.means.tries, self.where, self._count_failed, self._sleep).data

    def like(self, means: Means, asking: Asking) -> Endpoint:
        """Return another endpoint of the same server."""
        url = "" if self._client is not None else self.url
        return Endpoint(url, self.model, asking, means, client=self._client, sleep=self._sleep)

    def _body(self, messages: Sequence[Message], seed: int, more: Mapping[str, Any]) -> dict[str, Any]:
        asking = self.asking
        body: dict[str, Any] = {"model": self.model, "messages": list(messages), "max_tokens": asking.most_tokens}
        if asking.temperature >= 0:
            body["temperature"] = asking.temperature
        if asking.temperature > 0:
            body["seed"] = seed % 2**31
        return {**body, **more}

    def _digest(self, body: Mapping[str, Any]) -> str:
        return blake2b(_dumped([self.url, body]), digest_size=20).hexdigest()

    def _asked(self, body: dict[str, Any], size: int) -> Reply:
        once = self._through_client if self._client is not None else self._through_server
        return self.tried(lambda: self._read(once(body), size))

    def _count_failed(self, reason: str) -> None:
        self.cache.failed(self.model, reason)

    def _read(self, given: Any, size: int) -> Reply:
        reply = read_reply(given, size)
        if reply is None:
            raise Failed("no choice", "JSON without a message")
        return reply

    def _through_server(self, body: dict[str, Any]) -> Any:
        """Return the JSON of one chat request to the server; errors as of `send`."""
        given = dict(body)
        given[self._length] = given.pop("max_tokens")
        try:
            return self.send(CHAT, given)
        except Failed as error:
            if error.reason == "400" and LONGER in error.said and self._length != LONGER:
                self._length, error.again, error.wait = LONGER, True, 0.0
            raise

    def send(self, path: str, body: Mapping[str, Any]) -> Any:
        """Return the JSON of one request to the server, as it wrote it.

        Args:
            path: behind the address, such as `chat/completions`.
            body: of the request.

        Raises:
            Failed: there is none.
        """
        import orjson

        headers = {"content-type": "application/json", "accept": "application/json"}
        if self._key:
            headers["authorization"] = f"Bearer {self._key}"
        base, mark, query = self.url.partition("?")
        url = f"{base.rstrip('/')}/{path}{mark}{query}"
        self.sent += 1
        try:
            return orjson.loads(post(_http(is_here(self.url)), url, _dumped(body), headers, self.means.seconds))
        except orjson.JSONDecodeError:
            raise Failed("not JSON", "the reply is not JSON") from None
        except Failed as error:
            error.said = without_key(error.said, self._key)
            raise

    def kept_or_asked(self, body: Mapping[str, Any], size: int, most: int, ask: Callable[[], Reply]) -> Reply:
        """Return the reply that is kept for a request, or ask for it, pay, and keep it.

        Args:
            body: the request, by which the reply is known.
            size: characters of the prompt.
            most: tokens of the reply, at most.
            ask: asks the server.

        Raises:
            HearthError: NO_ANSWER; OVER_BUDGET; DAMAGED_FILE and UNWRITABLE of the cache.
        """
        key = self._digest(body)
        if (kept := self.cache.get(key)) is not None:
            return kept
        if self.means.offline:
            message = f"the cache has no reply of `{self.model}` to this prompt"
            raise HearthError.of(Code.NO_ANSWER, message, suggestion="ask the server: leave out offline")
        with self._room, self.purse.holding(size, most):
            reply = ask()
            self.purse.pay(reply)
        self.cache.put(key, self.model, reply)
        return reply

    def tried(self, once: Callable[[], Any]) -> Reply:
        """Return the reply that `once` brings, after as many tries as it may take, with its time and without the key.

        Raises:
            HearthError: NO_ANSWER.
        """
        began = time.monotonic()
        found = with_retries(once, self.means.tries, self.where, self._count_failed, self._sleep)
        reply: Reply = found.data
        text = without_key(reply.text, self._key)
        return replace(reply, text=text, seconds=round(time.monotonic() - began, 3), tries=found.tries)

    def _through_client(self, body: dict[str, Any]) -> Any:
        """Return the reply of a client of one's own, as servers write it.

        Raises:
            Failed: whatever it raises.
        """
        self.sent += 1
        try:
            if hasattr(self._client, "chat"):
                found = self._client.chat.completions.create(**body)
                return found if isinstance(found, Mapping) else found.model_dump()
            text = self._client(body["messages"])
        except Exception as error:
            raise Failed(type(error).__name__, str(error)) from error
        if not isinstance(text, str):
            raise Failed("not text", f"it returned {type(text).__name__}, not text", again=False)
        return {"choices": [{"message": {"content": text}}]}


def _size(messages: Sequence[Message]) -> int:
    """Return the characters of a prompt, a picture as many as its tokens have: its own say nothing of its price."""
    return len(_dumped(without_pictures(messages))) + CHARACTERS * PICTURE_TOKENS * pictures_in(messages)


def _dumped(value: Any) -> bytes:
    """Return the JSON of a value, with sorted keys: equal values have equal bytes."""
    import orjson

    return orjson.dumps(value, option=orjson.OPT_SORT_KEYS)


@lru_cache(maxsize=2)
def _http(here: bool) -> Any:
    """Return the client for all servers of this process; redirections are not followed.

    Proxies of the environment are used, but not for servers of this machine.
    """
    return client(follow_redirects=False, trust_env=not here)


_OPENING = threading.Lock()
"""Threads that ask for an endpoint at the same time get one: two would not share a budget."""


def endpoint_of(name: str, asking: Asking, means: Means) -> Endpoint:
    """Return the endpoint of `llm:MODEL@URL`, one for all episodes of a process; errors as of `Endpoint`."""
    with _OPENING:
        return _endpoint_of(name, asking, means)


@lru_cache(maxsize=16)
def _endpoint_of(name: str, asking: Asking, means: Means) -> Endpoint:
    for other, given in means.given:
        if other == name:
            found: Endpoint = given
            return found
    model, url = read_name(name)
    return Endpoint(url, model, asking, means)
