"""The grammar of an agent's legal commands, as the text protocol has them, in the form that a server obeys."""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import Any

from hearth.envs.answer_forms import WALK
from hearth.envs.text_protocol_settings import Protocol
from hearth.llm.constraints import FORMS, chosen, keeps
from hearth.llm.endpoint import Endpoint
from hearth.llm.probe import grammar_facts
from hearth.simulation.actions.legal import Legal
from hearth.simulation.actions.legal_grammar import legal_grammar

PLAIN_WALK = "Walk"
"""The word for the walk in commands, whichever action it stands for."""

_PROBING = threading.Lock()


def form_of(endpoint: Endpoint) -> str:
    """Return the way in which a server obeys a grammar; it is probed once for all episodes.

    Raises:
        HearthError: BAD_ARGUMENT: it obeys none; as of `grammar_facts`.
    """
    with _PROBING:
        return _probed(endpoint)


@lru_cache(maxsize=16)
def _probed(endpoint: Endpoint) -> str:
    return chosen(grammar_facts(endpoint), endpoint.where)


def command_names(legal: Legal, words: Protocol) -> dict[str, str]:
    """Return the actions that a command may have, each with its word: all that the protocol lists, and the walk."""
    walk = WALK if WALK in legal.masks else PLAIN_WALK
    listed = (name for name in sorted(legal.masks) if name not in words.hidden and name.lower() not in words.walks)
    return {walk: PLAIN_WALK, **{name: name for name in listed}}


def constraint(form: str, legal: Legal, words: Protocol) -> tuple[Mapping[str, Any], Callable[[str], bool]]:
    """Return the fields of a request that allow legal commands only, and whether an answer keeps to them."""
    grammar = legal_grammar(legal.home, legal.masks, command_names(legal, words), wait=True)
    return FORMS[form](grammar), lambda text: keeps(text, grammar, form)
