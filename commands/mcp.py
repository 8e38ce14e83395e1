"""`mcp`: the server of the Model Context Protocol, for agents that know nothing but MCP."""

import sys
from pathlib import Path

from hearth.commands import output
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.optional_libraries import library


def mcp(
    http: bool = False,
    port: int = 8000,
    tasks: str = "wah:train",
    limit: int = 250,
    episodes: int = 200,
    only: str = "",
    out: Path = Path("collected"),
    public: str = "",
    proxy: str = "",
    as_json: bool = False,
) -> None:
    """Serve a home to agents over the Model Context Protocol, on standard input and output, or over HTTP.

    A session is an episode. The tools are home, observe and act, for an episode; check, run, repair and plan, for
    programs; and knowledge. With --http it answers at /mcp on 127.0.0.1; with --public, too, every request must show
    the token that is in DIR/.server/desk-token. Needs the extra `mcp`.

    \b
    Examples:
      hearth mcp
      hearth mcp --only home,observe,act --tasks wah:test-1
      hearth mcp --http --port 8001
    """
    library("mcp")
    from hearth.challenges.text_episode import text_tasks
    from hearth.commands.mcp_server import TOOLS, mcp_server

    chosen = tuple(only.split(",")) if only else TOOLS
    if unknown := [name for name in chosen if name not in TOOLS]:
        message = f"there is no tool `{unknown[0][:40]}`"
        raise HearthError.of(Code.UNKNOWN_ID, message, suggestion=", ".join(TOOLS))
    text_tasks(tasks)  # a source that is wrong is said before anybody asks
    server = mcp_server(tasks, limit, episodes, chosen, alone=not http)
    if http:
        _serve(server, port, episodes, out, public, proxy, as_json)
    else:
        server.run("stdio")


def _serve(server: object, port: int, episodes: int, out: Path, public: str, proxy: str, as_json: bool) -> None:
    """Answer over HTTP until interrupted."""
    for module in ("starlette", "uvicorn", "websockets", "sqlalchemy"):
        library(module)
    from hearth.commands.mcp_server import http_application
    from hearth.commands.serve import proxy_of, public_hosts
    from hearth.web.desk_access import desk_token
    from hearth.web.security import Security
    from hearth.web.serving import listening, run
    from hearth.web.token_gate import TokenGate

    proxy, hosts = proxy_of(proxy, public), public_hosts(public)
    app = http_application(server, episodes)
    if hosts:
        app = TokenGate(app, desk_token(out))
    where = listening(port)
    address = f"http://127.0.0.1:{where.getsockname()[1]}/mcp"
    lines = f"Hearth speaks MCP at {address}"
    lines += f"\nEvery request shows the token in {out}/.server/desk-token" if hosts else ""
    output.say(lines, {"address": address, "token": bool(hosts)}, as_json)
    sys.stdout.flush()
    run(Security(app, hosts), where, proxy)
