"""The recipes of docs/serving.md for nginx and Caddy, tried on this machine: pages, sockets, links and addresses."""

from __future__ import annotations

import http.client
import re
import shutil
import socket as sockets
import ssl
import subprocess
import time
from pathlib import Path
from urllib.parse import urlencode

import orjson
import pytest
from web.people import ROOT
from websockets.sync.client import connect

pytestmark = pytest.mark.tools

NAME = "homes.example.org"
PUBLIC = f"https://{NAME}"

TRUSTING = ssl._create_unverified_context()  # the certificates are made here


def recipe(heading):
    text = (ROOT / "docs/serving.md").read_text("utf-8")
    return re.search(rf"## {heading}\n\n```\w*\n(.*?)```", text, re.DOTALL)[1]


def free_port():
    with sockets.socket() as found:
        found.bind(("127.0.0.1", 0))
        return found.getsockname()[1]


def replaced(text, *pairs):
    for old, new in pairs:
        assert old in text, f"the recipe has no {old}"
        text = text.replace(old, new)
    return text


def nginx(folder: Path, port: int, behind: str):
    """The recipe within the frame that a distribution has around it."""
    key, certificate = folder / "key.pem", folder / "certificate.pem"
    made = ["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "2", "-subj", f"/CN={NAME}"]
    subprocess.run([*made, "-keyout", key, "-out", certificate], check=True, capture_output=True)
    site = replaced(
        recipe("nginx"), ("listen 443 ssl", f"listen 127.0.0.1:{port} ssl"), ("127.0.0.1:8000", behind),
        (f"/etc/letsencrypt/live/{NAME}/fullchain.pem", str(certificate)),
        (f"/etc/letsencrypt/live/{NAME}/privkey.pem", str(key)),
    )  # fmt: skip
    kept = "".join(
        f"{kind}_temp_path {folder}/{kind};\n" for kind in ("client_body", "proxy", "fastcgi", "uwsgi", "scgi")
    )
    settings = f"pid {folder}/pid;\nerror_log {folder}/errors;\nevents {{}}\nhttp {{\naccess_log off;\n{kept}{site}}}\n"
    (folder / "nginx.conf").write_text(settings)
    return ["nginx", "-c", str(folder / "nginx.conf"), "-g", "daemon off;"]


def caddy(folder: Path, port: int, behind: str):
    site = replaced(recipe("Caddy"), (f"{NAME} {{", f"{PUBLIC}:{port} {{\n  tls internal"), ("127.0.0.1:8000", behind))
    frame = ("admin off", f"storage file_system {folder}/kept", "skip_install_trust", "auto_https disable_redirects")
    (folder / "Caddyfile").write_text("{\n" + "".join(f"  {line}\n" for line in frame) + "}\n" + site)
    return ["caddy", "run", "--config", str(folder / "Caddyfile"), "--adapter", "caddyfile"]


@pytest.fixture(params=[nginx, caddy], ids=lambda each: each.__name__)
def port(request, serving, tmp_path):
    """The port of a proxy that stands before a server."""
    if shutil.which(request.param.__name__) is None:
        pytest.skip(f"no {request.param.__name__} here: apt-get install {request.param.__name__}")
    behind = serving("--public", PUBLIC, "--proxy", "127.0.0.1").address.removeprefix("http://")
    found = free_port()
    running = subprocess.Popen(
        request.param(tmp_path, found, behind), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    try:
        until = time.monotonic() + 60
        while True:
            try:
                assert asked(found, "GET", "/").status == 200
                break
            except (OSError, http.client.HTTPException):
                assert time.monotonic() < until and running.poll() is None, "the proxy does not start"
                time.sleep(0.5)
        yield found
    finally:
        running.terminate()
        running.wait()


class Named(http.client.HTTPSConnection):
    """A connection to a port of this machine under the public name."""

    def connect(self):
        http.client.HTTPConnection.connect(self)
        self.sock = TRUSTING.wrap_socket(self.sock, server_hostname=NAME)


def asked(port, method, path, form=None, sender="127.0.0.1", **headers):
    connection = Named("127.0.0.1", port, timeout=30, source_address=(sender, 0))
    body = None if form is None else urlencode(form)
    kind = {} if form is None else {"Content-Type": "application/x-www-form-urlencoded", "Origin": PUBLIC}
    connection.request(method, path, body, {"Host": NAME, "Accept": "text/html", **kind, **headers})
    answer = connection.getresponse()
    answer.text = answer.read().decode("utf-8", "replace")
    return answer


def session(port, **more):
    answer = asked(port, "POST", "/begin", {}, **more)
    return answer, (answer.getheader("Set-Cookie") or "").partition(";")[0]


def test_pages_links_and_sockets_pass_through(port):
    answer, cookie = session(port)
    assert answer.status == 303 and "secure" in answer.getheader("Set-Cookie").lower()
    link = re.search(rf'value="({PUBLIC}/come/[^"]+)"', asked(port, "GET", "/mine", Cookie=cookie).text)[1]
    came = asked(port, "GET", link.removeprefix(PUBLIC))
    assert (came.status, came.getheader("Location")) == (303, "/come")
    game = asked(port, "POST", "/play/new", {"challenge": "wah", "task": "0"}, Cookie=cookie).getheader("Location")
    plain = sockets.create_connection(("127.0.0.1", port))
    with connect(f"wss://{NAME}{game}/live", sock=plain, ssl=TRUSTING, server_hostname=NAME,
                 additional_headers={"Cookie": cookie, "Origin": PUBLIC}) as socket:  # fmt: skip
        for number, message in enumerate(({"type": "hello", "tab": "a"}, {"type": "act", "tick": 0, "act": None}), 1):
            socket.send(orjson.dumps({**message, "n": number}).decode())
            state = orjson.loads(socket.recv(60))
        assert state["tick"] == 1


def test_scripts_are_compressed_and_the_desk_is_closed(port):
    script = asked(port, "GET", "/static/play/game.js", **{"Accept-Encoding": "gzip"})
    assert script.status == 200 and script.getheader("Content-Encoding") == "gzip"
    assert asked(port, "GET", "/desk/study/").status == 403


def test_an_address_that_is_forged_is_not_believed(port):
    """Sessions are limited by address: who begins many under made-up ones is refused, and others are not."""
    answers = [session(port, **{"X-Forwarded-For": f"10.0.0.{number}"})[0].status for number in range(40)]
    assert 429 in answers
    assert session(port, sender="127.0.0.2")[0].status == 303
