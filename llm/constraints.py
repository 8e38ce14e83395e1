"""The ways in which servers take a grammar, and whether an answer keeps to one: many servers ignore what they take."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import Any

import orjson

from hearth.kb.tools.line_grammars import LineGrammar, gbnf, lines_schema, regex
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

SCHEMA = "json_schema"
"""The way that wraps the answer in JSON."""

FIELD = "command"
"""The field of the JSON that holds the answer."""


def schema_fields(schema: Mapping[str, Any]) -> dict[str, Any]:
    """Return the fields of a request that send a JSON schema."""
    return {"response_format": {"type": SCHEMA, SCHEMA: {"name": "answer", "strict": True, "schema": schema}}}


def _schema(grammar: LineGrammar) -> dict[str, Any]:
    return schema_fields(lines_schema(grammar, FIELD))


FORMS: Mapping[str, Callable[[LineGrammar], dict[str, Any]]] = {
    "grammar": lambda grammar: {"grammar": gbnf(grammar)},
    "structured_outputs": lambda grammar: {"structured_outputs": {"grammar": gbnf(grammar)}},
    "guided_grammar": lambda grammar: {"guided_grammar": gbnf(grammar)},
    "ebnf": lambda grammar: {"ebnf": gbnf(grammar)},
    "guided_regex": lambda grammar: {"guided_regex": regex(grammar)},
    "regex": lambda grammar: {"regex": regex(grammar)},
    SCHEMA: _schema,
}
"""The fields of a request that send a grammar: of llama.cpp, of vLLM now and before, of SGLang, of OpenAI.

The first that a server obeys is used.
"""


@lru_cache(maxsize=64)
def _pattern(grammar: LineGrammar) -> re.Pattern[str]:
    return re.compile(regex(grammar))


def keeps(text: str, grammar: LineGrammar, form: str) -> bool:
    """Return whether an answer is of the language of a grammar of single lines."""
    said: Any = text
    if form == SCHEMA:
        try:
            said = orjson.loads(text)
        except orjson.JSONDecodeError:
            return False
        said = said.get(FIELD) if isinstance(said, dict) and len(said) == 1 else None
    return isinstance(said, str) and _pattern(grammar).fullmatch(said.strip()) is not None


def chosen(facts: Mapping[str, Any], where: str) -> str:
    """Return the way that a server obeys.

    Args:
        facts: of a probe: way -> `obeyed`, `ignored` or `refused`.
        where: the server, for the message.

    Raises:
        HearthError: BAD_ARGUMENT: it obeys none. What it answers would be free, and nobody would notice.
    """
    for form in FORMS:
        if facts.get(form) == "obeyed":
            return form
    findings = ", ".join(f"{form} {facts.get(form, 'untried')}" for form in FORMS)
    message = f"{where} obeys no grammar: {findings}"
    raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="leave out constrained, or use llama.cpp or vLLM")
