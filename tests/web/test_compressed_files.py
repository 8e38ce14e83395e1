"""Files of the pages are sent compressed and kept by browsers; pages, which have secrets, are not compressed."""

from __future__ import annotations

import gzip

import pytest
from web.playing import Player, begun

from hearth.web.play.play_trials import published

PACKED = {"accept-encoding": "gzip"}


@pytest.mark.parametrize("path", ["/static/style.css", "/static/play/game.js"])
def test_scripts_are_compressed_and_asked_for_only_when_they_changed(server, path):
    client = server.client()
    first = client.get(path, headers=PACKED)
    assert first.headers["content-encoding"] == "gzip" and first.headers["cache-control"] == "no-cache"
    assert "default-src 'none'" in first.headers["content-security-policy"]
    again = client.get(path, headers={**PACKED, "if-none-match": first.headers["etag"]})
    assert again.status_code == 304 and again.content == b""
    assert "content-encoding" not in client.get(path, headers={"accept-encoding": "identity"}).headers


def test_pages_are_not_compressed(person):
    for path in ("/", "/mine", "/play/"):
        answer = person.get(path, headers=PACKED)
        assert "content-encoding" not in answer.headers and answer.headers["cache-control"] == "no-store"


def test_a_home_in_3d_is_small_on_the_network(server, person):
    pytest.importorskip("trimesh")
    game = begun(server, person, published("wah", "test-1", 0), interface="visual")
    with Player(person, game) as player:
        address = player.state["drawn"]["base"]
    with person.stream("GET", address, headers=PACKED) as answer:
        packed = b"".join(answer.iter_raw())
    whole = person.get(address, headers={"accept-encoding": "identity"}).content
    assert gzip.decompress(packed) == whole and whole[:4] == b"glTF"
    assert len(packed) < 2_500_000 and len(packed) < len(whole) / 2
