"""`serve`: the server where people annotate, play and judge."""

import re
import sys
from collections.abc import Mapping
from ipaddress import IPv4Network, IPv6Network, ip_address, ip_network
from pathlib import Path
from urllib.parse import urlsplit

import typer

from hearth.commands import output
from hearth.commands.inputs import read_knowledge
from hearth.commands.serve_virtualhome import serve_virtualhome
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.optional_libraries import library


def serve(
    port: int | None = None,
    out: Path | None = None,
    store: str = "",
    study: Path | None = None,
    films: Path | None = None,
    public: str = "",
    proxy: str = "",
    host: str = "127.0.0.1",
    lab: str = "",
    text: bool = False,
    tasks: str = "wah:train",
    limit: int = 250,
    worlds: int = 200,
    workers: int = 2,
    kb: Path | None = None,
    virtualhome: bool = False,
    homes: Path | None = None,
    seed: int = 0,
    as_json: bool = False,
) -> None:
    """Serve the rooms for people, and the researcher's desk, on 127.0.0.1 or on --host behind a proxy.

    Everything is kept in DIR, in an embedded database or, with --store, in a PostgreSQL that servers of many machines
    share. `build DIR` reads the contributions that other people accepted. Prints the address and the link to the desk,
    whose token is also in DIR/.server/desk-token. Ctrl-C stops it; accepted contributions are kept, also if it is
    killed.

    With --text there are no rooms: programs create, reset and step worlds in text, over HTTP (docs/hubs.md). Nothing is
    kept. With --public, too, every request must show the desk's token.

    --virtualhome serves scripts of VirtualHome instead: it answers in the place of the Unity program, by the same
    messages, and records into DIR.

    \b
    Examples:
      hearth serve
      hearth serve --study people-alone
      hearth serve --port 8001 --store postgresql://hearth@127.0.0.1/hearth
      hearth serve --public https://homes.example.org --proxy 127.0.0.1
      hearth serve --public https://homes.example.org --host 10.0.0.5 --proxy 10.0.0.2
      hearth serve --text --tasks wah:train
      hearth serve --virtualhome --out recordings
    """
    rooms = {"--store": store, "--study": study, "--films": films, "--public": public, "--proxy": proxy, "--lab": lab}
    _check_kind(virtualhome, {**rooms, "--text": text}, {"--homes": homes, "--seed": seed})
    if virtualhome:
        port = VIRTUALHOME_PORT if port is None else port
        serve_virtualhome(port, out or Path("recordings"), homes, kb, seed, as_json)
        return
    for module in ("starlette", "uvicorn", "websockets", "sqlalchemy"):
        library(module)
    proxy, hosts, host = proxy_of(proxy, public), public_hosts(public), host_of(host, public)
    at, out = (host, ROOMS_PORT if port is None else port), out or Path("collected")
    if text:
        _refuse_options_of_rooms(store, study, films, lab)
        _serve_text(at, out, hosts, proxy, (tasks, limit, worlds, workers), as_json)
        return
    _serve_rooms(at, out, store, (study, films), (public, hosts, proxy, lab_of(lab)), kb, as_json)


def _serve_rooms(
    at: tuple[str, int],
    out: Path,
    store: str,
    files: tuple[Path | None, Path | None],
    by: tuple[str, tuple[str, ...], str, IPv4Network | IPv6Network | None],
    kb: Path | None,
    as_json: bool,
) -> None:
    """Serve the rooms for people until interrupted."""
    from hearth.studies.study_file import named
    from hearth.studies.study_trials import check_helpers
    from hearth.web.application import application
    from hearth.web.desk_access import desk_token
    from hearth.web.serving import listening, run
    from hearth.web.store import Store, default_url
    from hearth.web.study.study_store import has_begun
    from hearth.web.third_party_scripts import REMEDY, THIRD_PARTY, missing

    (study, films), (public, hosts, proxy, lab), (host, port) = files, by, at
    conduct = None if study is None else named(str(study))
    if conduct is not None:
        check_helpers(conduct)
    where = listening(port, host)
    address = _address(host, where.getsockname()[1])
    token = desk_token(out)
    kept = Store(store or default_url(out))
    app = application(kept, read_knowledge(kb), out, token, study, films, hosts, lab=lab)
    if conduct is not None:
        has_begun(kept, conduct)
    for name in missing():
        output.note(f"Without {name}, {THIRD_PARTY[name].purpose}: {REMEDY}.")
    desk = f"{public or address}/desk/enter/{token}"
    lines = f"Hearth answers at {address}\nThe researcher's desk: {desk}"
    output.say(lines, {"address": address, "desk": desk, "out": str(out), "missing": missing()}, as_json)
    sys.stdout.flush()
    run(app, where, proxy)


def lab_of(text: str) -> IPv4Network | IPv6Network | None:
    """Return the network behind which many participants sit; None where none is given.

    Raises:
        typer.BadParameter: it is neither an address nor a network.
    """
    try:
        return ip_network(text) if text else None
    except ValueError:
        message = f"`{text[:60]}` is not an IP address or a network, such as 10.1.0.0/16"
        raise typer.BadParameter(message, param_hint="--lab") from None


def _check_kind(virtualhome: bool, of_rooms: Mapping[str, object], of_unity: Mapping[str, object]) -> None:
    """Refuse options of the other server."""
    wrong = [name for name, value in (of_rooms if virtualhome else of_unity).items() if value]
    if wrong:
        where = "without --virtualhome" if virtualhome else "with --virtualhome"
        raise typer.BadParameter(f"it has an effect only {where}", param_hint=wrong[0])


ROOMS_PORT = 8000
"""The usual port of the rooms."""

VIRTUALHOME_PORT = 8080
"""The port at which clients of VirtualHome ask."""


def _address(host: str, port: int) -> str:
    """Return the address of a server, as browsers have it."""
    return f"http://{f'[{host}]' if ':' in host else host}:{port}"


def _refuse_options_of_rooms(*given: object) -> None:
    """Refuse options of the rooms, which `--text` does not open."""
    if any(given):
        message = "--store, --study, --films and --lab are of the rooms for people"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="leave out --text, or these")


def _serve_text(
    at: tuple[str, int], out: Path, hosts: tuple[str, ...], proxy: str, play: tuple[str, int, int, int], as_json: bool
) -> None:
    """Serve worlds in text until interrupted."""
    from hearth.challenges.text_episode import text_tasks
    from hearth.web.desk_access import desk_token
    from hearth.web.serving import listening, run
    from hearth.web.text.open_worlds import Offered
    from hearth.web.text.text_door import TextDoor, text_application

    tasks, limit, worlds, workers = play
    text_tasks(tasks)  # a source that is wrong is said before anybody asks
    token = desk_token(out) if hosts else ""
    door = TextDoor(Offered(tasks, limit), workers, worlds)
    host, port = at
    where = listening(port, host)
    address = _address(host, where.getsockname()[1])
    lines = f"Hearth plays in text at {address}"
    lines += f"\nEvery request shows the token in {out}/.server/desk-token" if token else ""
    output.say(lines, {"address": address, "tasks": tasks, "worlds": worlds, "token": bool(token)}, as_json)
    sys.stdout.flush()
    run(text_application(door, hosts, token), where, proxy)


_PUBLIC = re.compile(r"https://(?:[A-Za-z0-9](?:[A-Za-z0-9.-]*[A-Za-z0-9])?|\[[0-9A-Fa-f:.]+\])(?::[0-9]{1,5})?")
"""A public address: a name as browsers send it, and a port. Links and headers are made of it."""


def public_hosts(public: str) -> tuple[str, ...]:
    """Return the name in a public address, with its port if it is not that of https.

    Raises:
        HearthError: BAD_ARGUMENT.
    """
    if not public:
        return ()
    try:
        found = urlsplit(public)
        name, port = found.hostname, found.port
    except ValueError:
        name, port = "", None
    if not name or port == 0 or not _PUBLIC.fullmatch(public):
        message = f"`{public[:100]}` is not an address: a name, without a path"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="https://NAME or https://NAME:PORT")
    name = f"[{name}]" if ":" in name else name  # as browsers ask for an address of IPv6
    return (f"{name}:{port}" if port not in (None, 443) else name,)


def host_of(given: str, public: str) -> str:
    """Return the address of this machine to listen on.

    Raises:
        HearthError: BAD_ARGUMENT: it is not an IP address; or other machines reach it, and people do not come by the
            https of a proxy, so that what they send could be read on its way.
    """
    try:
        found = ip_address(given)
    except ValueError:
        message = f"`{given[:60]}` is not an IP address of this machine"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="--host 127.0.0.1, or 0.0.0.0 for all") from None
    if not found.is_loopback and not public:
        message = f"other machines reach {found} without https"
        remedy = "name the proxy's address: --public https://NAME --proxy ADDRESS"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion=remedy)
    return str(found)


def proxy_of(given: str, public: str) -> str:
    """Return the address of the proxy, as sockets have it.

    Raises:
        HearthError: BAD_ARGUMENT: it is not an IP address; or people come by a proxy of which none is given, so that
            limits by address would count all of them as one.
    """
    if not given and not public:
        return ""
    try:
        return str(ip_address(given))
    except ValueError:
        remedy = "--proxy 127.0.0.1 for a proxy on this machine"
        message = f"`{given[:60]}` is not the IP address of a proxy" if given else "people who come by --public share"
        message += "" if given else " the address of the proxy, which --proxy has to name"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion=remedy) from None
