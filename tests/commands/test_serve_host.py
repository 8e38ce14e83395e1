"""The address at which the server answers: this machine's own, or another behind a proxy that speaks https."""

from __future__ import annotations

import pytest

from hearth.commands.serve import host_of
from hearth.schemas.diagnostics import HearthError

PUBLIC = "https://homes.example.org"


@pytest.mark.parametrize("given", ["127.0.0.1", "127.0.0.2", "::1"])
def test_this_machine_needs_no_proxy(given):
    assert host_of(given, "") == given


@pytest.mark.parametrize("given", ["0.0.0.0", "10.0.0.5", "::"])
def test_others_reach_it_by_https_alone(given):
    with pytest.raises(HearthError, match="without https"):
        host_of(given, "")
    assert host_of(given, PUBLIC) == given


@pytest.mark.parametrize("given", ["", "localhost", "10.0.0", "10.0.0.5:80", "homes.example.org"])
def test_what_is_no_address_is_refused(given):
    with pytest.raises(HearthError, match="not an IP address"):
        host_of(given, PUBLIC)


def test_a_server_listens_there():
    pytest.importorskip("uvicorn")
    from hearth.web.serving import listening

    with listening(0, "127.0.0.2") as made:
        assert made.getsockname()[0] == "127.0.0.2"
