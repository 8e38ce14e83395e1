"""Settings of language models in a run: those that change what is asked, and the means by which it is asked."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any

from hearth.llm.addresses import is_model
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

TRUTHS = {"true": True, "yes": True, "1": True, "false": False, "no": False, "0": False}
"""Spellings of a true or false setting."""

BOUNDS = {
    "temperature": (-1, 10),
    "most_tokens": (1, 1_000_000),
    "memory": (0, 10_000),
    "most_turns": (1, 10_000),
    "seconds": (0.01, 86_400),
    "tries": (1, 100),
    "at_once": (1, 1_000),
}
"""The smallest and the largest value of settings that are numbers."""

MILLION = 1_000_000


@dataclass(frozen=True)
class Asking:
    """The settings that change what a language model is asked; results name them.

    Attributes:
        temperature: of its choices; at -1 none is sent, for servers that refuse one.
        most_tokens: of a reply.
        memory: earlier turns of the episode that it is shown again; 0 for none.
        most_turns: answers in an episode, at most; after them the agent waits until time is over.
        constrained: whether a grammar of the legal commands is sent, where the server obeys one.
        images: whether the model is shown what the agent sees, a picture in each prompt's last message.
    """

    temperature: float = 0.0
    most_tokens: int = 256
    memory: int = 8
    most_turns: int = 80
    constrained: bool = False
    images: bool = False

    def as_json(self) -> dict[str, Any]:
        """Return the settings as results have them; of pictures nothing where there are none, as in older results."""
        return {name: value for name, value in asdict(self).items() if name != "images" or value}


@dataclass(frozen=True)
class Means:
    """The means by which a language model is asked; they change no answer.

    Attributes:
        seconds: that one request may take.
        tries: requests for one reply, at most.
        at_once: requests at the same time.
        offline: whether only the cache answers.
        key: the environment variable with the server's key; "" for the usual ones.
        cache: the file of replies; in memory where None.
        prices: of a million tokens of prompts and of replies.
        budget: the most that all replies in the cache may cost; None for no limit.
        given: endpoints that stand for names, from Python.
    """

    seconds: float = 120.0
    tries: int = 6
    at_once: int = 8
    offline: bool = False
    key: str = ""
    cache: Path | None = None
    prices: tuple[float, float] | None = None
    budget: float | None = None
    given: tuple[tuple[str, Any], ...] = ()

    def cost(self, tokens_in: int, tokens_out: int) -> float:
        """Return what tokens cost; 0 where no prices are given."""
        per_in, per_out = self.prices or (0.0, 0.0)
        return (tokens_in * per_in + tokens_out * per_out) / MILLION


_FREE = ("seconds", "tries", "at_once", "offline", "key")
"""The means that `NAME=VALUE` sets; the others have options of their own."""


def read_settings(
    changed: Sequence[str], cache: Path | None = None, prices: str = "", budget: float | None = None
) -> tuple[Asking, Means]:
    """Return the settings of a command line.

    Args:
        changed: `NAME=VALUE`, of either kind.
        cache: the file of replies.
        prices: `IN,OUT`, of a million tokens each.
        budget: in the money of the prices.

    Raises:
        HearthError: BAD_ARGUMENT: an unknown setting, a value that does not fit, a budget without prices.
    """
    kinds = {each.name: type(each.default) for each in fields(Asking)}
    kinds |= {each.name: type(each.default) for each in fields(Means) if each.name in _FREE}
    values: dict[str, Any] = {}
    for text in changed:
        name, _, value = text.partition("=")
        values[name] = _value(name, value, kinds)
    both = _prices(prices)
    if budget is not None and both is None:
        remedy = "--prices IN,OUT, of a million tokens of prompts and of replies"
        raise HearthError.of(Code.BAD_ARGUMENT, "a budget needs prices", suggestion=remedy)
    asking = {each.name: values[each.name] for each in fields(Asking) if each.name in values}
    means = {name: values[name] for name in _FREE if name in values}
    return Asking(**asking), Means(**means, cache=cache, prices=both, budget=budget)


def kept_next_to(out: Path, names: Sequence[str]) -> Path | None:
    """Return the usual file of replies for an output; None where none of the names is that of a language model."""
    return out.with_name(f"{out.name}.replies.sqlite") if any(map(is_model, names)) else None


def _value(name: str, value: str, kinds: dict[str, type]) -> Any:
    """Return the value of a setting by its type; errors as of `read_settings`."""
    kind = kinds.get(name)
    if kind is None:
        message = f"`{name[:40]}` is not a setting of language models"
        remedy = f"--llm takes {', '.join(f'{each}=...' for each in kinds)}"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion=remedy)
    try:
        found = TRUTHS[value.lower()] if kind is bool else kind(value)
        least, most = BOUNDS.get(name, (found, found))
        if not least <= found <= most:
            raise ValueError
    except (ValueError, KeyError):
        message = f"`{value[:40]}` is no value of the setting `{name}` of language models"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion=_values(name, kind)) from None
    return found


def _values(name: str, kind: type) -> str:
    """Return which values a setting takes, for a message."""
    if kind is bool:
        return f"{name}=yes or {name}=no"
    least, most = BOUNDS[name]
    return f"a {'whole ' if kind is int else ''}number from {least:,} to {most:,}"


def _prices(text: str) -> tuple[float, float] | None:
    if not text:
        return None
    try:
        per_in, per_out = (float(each) for each in text.split(","))
        if not (0 <= per_in < MILLION and 0 <= per_out < MILLION):
            raise ValueError
    except ValueError:
        message = f"`{text[:40]}` are not the prices of a million tokens of prompts and of replies"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="--prices 0.15,0.60") from None
    return per_in, per_out
