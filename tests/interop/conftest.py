"""A server of VirtualHome's protocol in maple, and a client of it."""

from __future__ import annotations

import json

import pytest

from hearth.interop.virtualhome.protocol_actions import Simulator
from hearth.interop.virtualhome.script_recordings import Recordings
from hearth.interop.virtualhome.unity_scene import Homes, UnityScene
from hearth.web.unity_protocol import UnityServer
from tests.interop.unity_client import UnityClient

MAPLE = 4


@pytest.fixture(scope="module")
def homes(knowledge):
    return Homes.of_library(knowledge)


@pytest.fixture
def server(homes, tmp_path):
    return UnityServer(Simulator(UnityScene(homes), Recordings(tmp_path / "out")))


@pytest.fixture
def client(server):
    made = UnityClient(post=lambda body: json.dumps(server.answer(body)).encode())
    assert made.reset(MAPLE)
    return made
