"""Random texts of grammars, as a language model with random weights would write them under constraint."""

from __future__ import annotations

import json
import re
from functools import lru_cache

import pytest

_TOKEN = re.compile(r'\s*(?:("(?:[^"\\]|\\.)*")|([A-Za-z][\w-]*)|(\{\d+,\d+\})|([|()]))')


class Gbnf:
    """A plain reader of the part of GBNF that ours use; `sample` draws a text."""

    def __init__(self, text):
        self.rules = {}
        for line in text.splitlines():
            name, _, body = line.partition(" ::= ")
            self.rules[name] = self.choice(_TOKEN.findall(body))

    def choice(self, tokens):
        """Read alternatives up to a bracket that closes, and take them off the list."""
        found = [[]]
        while tokens:
            text, name, repeat, mark = tokens.pop(0)
            if mark == ")":
                break
            if mark == "|":
                found.append([])
            elif mark == "(":
                found[-1].append(self.choice(tokens))
            elif repeat:
                least, most = map(int, repeat[1:-1].split(","))
                found[-1].append(("repeat", found[-1].pop(), least, most))
            else:
                found[-1].append(json.loads(text) if text else ("rule", name))
        return ("choice", found)

    def sample(self, rng, at=("rule", "root")):
        if isinstance(at, str):
            return at
        kind, *rest = at
        if kind == "rule":
            return self.sample(rng, self.rules[rest[0]])
        if kind == "repeat":
            return "".join(self.sample(rng, rest[0]) for _ in range(rng.randint(rest[1], rest[2])))
        return "".join(self.sample(rng, part) for part in rng.choice(rest[0]))


def of_schema(schema, rng, at=None):
    """Draw a value of the part of JSON schema that ours use."""
    at = schema if at is None else at
    if "$ref" in at:
        return of_schema(schema, rng, schema["$defs"][at["$ref"].rpartition("/")[2]])
    if "enum" in at:
        return rng.choice(at["enum"])
    if "anyOf" in at:
        return of_schema(schema, rng, rng.choice(at["anyOf"]))
    if at["type"] == "array":
        return [of_schema(schema, rng, at["items"]) for _ in range(rng.randint(at["minItems"], at["maxItems"]))]
    return {name: of_schema(schema, rng, value) for name, value in at["properties"].items()}


def by_bytes(form, text, rng, longest=4000):
    """Draw a text byte by byte under llguidance: every byte that the grammar allows is equally likely."""
    pytest.importorskip("llguidance", reason="the package llguidance is not installed")
    matcher = matcher_of(form, text).deep_copy()
    found = bytearray()
    while not matcher.is_stopped() and len(found) < longest:
        mask = matcher.compute_bitmask()
        allowed = [n for n in range(256) if mask[n >> 3] >> (n & 7) & 1]
        if not allowed or (matcher.is_accepting() and rng.random() < 0.3):
            break
        found.append(rng.choice(allowed))
        assert matcher.consume_token(found[-1]), matcher.get_error()
    assert matcher.is_accepting(), (found[-80:], matcher.get_error())
    return found.decode()


@lru_cache(maxsize=4)
def matcher_of(form, text):
    """A matcher over single bytes."""
    import llguidance

    grammar = llguidance.LLMatcher.grammar_from_lark(text) if form == "lark" else llguidance.grammar_from(form, text)
    matcher = llguidance.LLMatcher(llguidance.LLTokenizer("byte"), grammar)
    assert not matcher.get_error(), matcher.get_error()
    return matcher
