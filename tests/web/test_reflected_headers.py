"""No answer has a header of its request in it: addresses are this server's own, whatever a request says."""

from __future__ import annotations

import pytest
from web.people import DESK, Server

from hearth.commands.serve import public_hosts
from hearth.web.security import own_address

PATHS = ("/", "/mine", "/mine/", "/desk", "/desk/", "/desk/enter/", "/come/x/", "/begin/", "/nowhere", "/nowhere/",
         "/static", "/static/", "/fetched/", "/annotate/", "/play/", "/study/", "//evil.example/",
         "/\\evil.example/", "/%0d%0alocation:evil.example/")  # fmt: skip

EVIL = "evil.example:4321"

HEADERS = {
    "x-forwarded-host": EVIL, "x-forwarded-proto": "gopher", "x-forwarded-port": "4321", "x-forwarded-for": EVIL,
    "x-forwarded-server": EVIL, "forwarded": f"host={EVIL};proto=gopher", "x-original-url": f"http://{EVIL}/",
    "x-rewrite-url": f"//{EVIL}", "referer": f"http://{EVIL}/", "origin": f"http://{EVIL}", "x-host": EVIL,
    "x-real-ip": EVIL, "host": "127.0.0.1:4321",
}  # fmt: skip


def whole(answer):
    """All that an answer says."""
    return "\n".join([*(f"{name}: {value}" for name, value in answer.headers.items()), answer.text])


@pytest.mark.parametrize("name", HEADERS)
def test_no_answer_has_a_header_of_its_request_in_it(server, name):
    for client in (server.client(), server.person()):
        for path in PATHS:
            for accept in ("text/html", "application/json"):
                answer = client.get(path, headers={name: HEADERS[name], "accept": accept})
                if name == "host" and path == "/mine" and answer.status_code == 200:
                    continue  # the page with a person's own link, as the person's browser asks for it
                said = whole(answer).replace(path, "")
                assert "4321" not in said and "gopher" not in said, (path, said)
                assert answer.headers.get("location", "/").startswith("/"), path
                assert not answer.headers.get("location", "/").startswith("//"), path


@pytest.mark.parametrize("name", ["host", "origin", "sec-fetch-site"])
def test_a_refusal_does_not_say_what_it_refuses(server, name):
    answer = server.client().post("/begin", headers={name: EVIL})
    assert answer.status_code == 403 and "evil" not in whole(answer)


def test_an_answer_sends_nobody_elsewhere(server):
    for address in ("http://evil.example/", "//evil.example", "/\\evil.example", "javascript:x", "", "a"):
        assert own_address(address) == "/"
    begun = server.client().post("/begin", data={"to": "//evil.example/x"}, headers={"host": "127.0.0.1:4321"})
    assert begun.headers["location"] == "/"
    entered = server.client().post("/desk/enter", data={"token": DESK}, headers={"host": "localhost:4321"})
    assert entered.headers["location"] == "/desk"


HOSTS = {
    "homes.example": True, "homes.example:443": True, "homes.example:8443": False, "homes.example:": False,
    "homes.example.evil": False, "127.0.0.1": True, "127.0.0.1:8000": True, "localhost:1": True, "[::1]:8000": True,
    "127.0.0.1:0": False, "127.0.0.1:99999": False, "127.0.0.1:8000:8000": False, "127.0.0.1:٣": False,
    "a@127.0.0.1": False, "127.0.0.1/x": False, "127.0.0.1#": False, "127.1": False, "": False,
}  # fmt: skip


@pytest.mark.parametrize("host", HOSTS)
def test_only_configured_hosts_are_answered(tmp_path, knowledge, host):
    made = Server(tmp_path / "served", knowledge, hosts=("homes.example",))
    answer = made.client().get("/privacy", headers={b"host": host.encode()})
    made.store.close()
    assert (answer.status_code == 200) is HOSTS[host], answer.text


def test_a_public_address_may_have_a_port(tmp_path, knowledge):
    assert public_hosts("https://homes.example:8443") == ("homes.example:8443",)
    assert public_hosts("https://homes.example:443") == public_hosts("https://homes.example") == ("homes.example",)
    made = Server(tmp_path / "served", knowledge, hosts=public_hosts("https://homes.example:8443"))
    found = [made.client().get("/privacy", headers={"host": f"homes.example{port}"}) for port in (":8443", "", ":1")]
    made.store.close()
    assert [answer.status_code for answer in found] == [200, 403, 403]
