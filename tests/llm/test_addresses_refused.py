"""Addresses and keys of language models that are refused before anything is asked."""

from __future__ import annotations

import pytest

from hearth.llm.addresses import key_for, read_name
from hearth.schemas.diagnostics import HearthError


@pytest.mark.parametrize("name", ["llm:gpt@127.0.0.1:9/v1", "llm:gpt@localhost", "llm:gpt@api.example.org"])
def test_an_address_without_http_is_refused(name):
    with pytest.raises(HearthError, match="BAD_ARGUMENT"):
        read_name(name)


def test_a_key_s_variable_that_is_not_set_is_refused_and_not_repeated():
    with pytest.raises(HearthError) as raised:
        key_for("http://127.0.0.1:9/v1", "sk-secret")
    assert "sk-secret" not in str(raised.value)
