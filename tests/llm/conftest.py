"""An endpoint of a server that a test starts, and its waits."""

from __future__ import annotations

import pytest

from hearth import Endpoint
from hearth.llm.language_settings import Asking, Means


@pytest.fixture
def waits():
    return []


@pytest.fixture
def asked(waits):
    """Returns an endpoint of a server's address; its waits are recorded and take no time."""

    def make(url, *, asking=None, **means):
        return Endpoint(
            url, "mini", asking or Asking(), Means(**{"tries": 4, "seconds": 5.0, **means}), sleep=waits.append
        )

    return make
