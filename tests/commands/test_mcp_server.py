"""`hearth mcp`, by the SDK's own client: over standard streams and HTTP, with sessions and without."""

from __future__ import annotations

import asyncio
import contextlib
import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

import hearth

pytestmark = pytest.mark.tools
mcp = pytest.importorskip("mcp", reason="needs the extra mcp")

import httpx2  # noqa: E402
from mcp.client.client import Client  # noqa: E402
from mcp.client.stdio import StdioServerParameters, stdio_client  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
CLI = [sys.executable, str(ROOT / "cli.py"), "mcp"]
PROGRAM = "Milk\n\n[Walk] <kitchen> (1)\n[Walk] <fridge> (1)\n[Open] <fridge> (1)\n[Grab] <milk> (1)"
TOOLS = ["home", "observe", "act", "check", "run", "repair", "plan", "knowledge"]


def stdio(*options):
    return stdio_client(StdioServerParameters(command=CLI[0], args=[*CLI[1:], *options], cwd=str(ROOT)))


@pytest.fixture(scope="module")
def address(tmp_path_factory):
    command = [
        *CLI,
        "--http",
        "--port",
        "0",
        "--json",
        "--episodes",
        "70",
        "--out",
        str(tmp_path_factory.mktemp("mcp")),
    ]
    server = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=ROOT)
    try:
        yield json.loads("".join(iter(server.stdout.readline, "}\n")) + "}")["address"]
    finally:
        server.terminate()
        server.wait(20)


def asked(work, server, mode="auto"):
    """The result of a coroutine function of a client."""

    async def run():
        async with Client(server, mode=mode) as client:
            return await work(client)

    return asyncio.run(run())


async def called(client, tool, **given):
    """The structured content of an answer, which its text says, too."""
    answer = await client.call_tool(tool, given)
    assert not answer.is_error, answer.content
    assert json.loads(answer.content[0].text) == answer.structured_content
    return answer.structured_content


async def refused(client, tool, **given):
    answer = await client.call_tool(tool, given)
    assert answer.is_error
    return answer.content[0].text


class Searcher:
    """An agent that knows MCP alone: it reads observations, opens what is closed, and brings a thing to a place."""

    def __init__(self, client, thing: str, place: str) -> None:
        self.client, self.thing, self.place = client, thing, place
        self.tried: set[str] = set()

    async def finish(self, most: int = 60, **begin):
        turn = await called(self.client, "home", **begin)
        episode = {"episode": turn["episode"]}
        for _ in range(most):
            if turn["done"]:
                break
            turn = await called(self.client, "act", command=self.command(turn["observation"]), **episode)
        return turn

    def command(self, text: str) -> str:
        seen, do = text.split("\nDo: ")[0], text.split("\nDo: ")[1]
        holding = re.search(r"holding ([^.]*)\.", text)[1]
        if self.thing in holding:
            put = re.search(rf"PutBack {self.thing} \d+, [^;]*?{self.place} \d+", do)
            return put[0].split(" | ")[-1] if put and "|" not in put[0] else self.walk_to_place(text, do)
        if grab := re.search(rf"Grab [^;]*?({self.thing} \d+)", do):
            return f"Grab {grab[1]}"
        if found := re.search(rf"\b{self.thing} \d+", seen.split("\nHere: ")[1]):
            return f"Walk {found[0]}"
        for name in re.findall(r"([a-z_]+ \d+) \(closed\)", seen):
            for verb in ("Walk", "Open"):
                if f"{verb} {name}" not in self.tried:
                    self.tried.add(f"{verb} {name}")
                    return f"{verb} {name}"
        return self.next_room(text)

    def walk_to_place(self, text: str, do: str) -> str:
        place = re.search(rf"{self.place} \d+", text.split("\nHere: ")[1])
        number = re.search(rf"{self.thing} \d+", text)[0]
        if place and f"Walk {place[0]}" in self.tried:
            return f"PutBack {number}, {place[0]}"
        if place:
            self.tried.add(f"Walk {place[0]}")
            return f"Walk {place[0]}"
        return self.next_room(text)

    def next_room(self, text: str) -> str:
        rooms = re.search(r"Other rooms: ([^.]*)\.", text)[1].split(", ")
        fresh = [room for room in rooms if f"Walk {room}" not in self.tried] or rooms
        self.tried.add(f"Walk {fresh[0]}")
        return f"Walk {fresh[0]}"


@pytest.mark.parametrize("how", ["stdio", "http", "http-session"])
def test_an_agent_that_knows_mcp_alone_finishes_a_task(how, address):
    server, mode = (stdio(), "auto") if how == "stdio" else (address, "legacy" if how == "http-session" else "auto")

    async def work(client):
        return await Searcher(client, "milk", "table").finish(name="maple", goal="ON(milk, table)", seed=4)

    turn = asked(work, server, mode)
    assert turn["won"] and turn["done"] and turn["goal_fraction"] == 1.0


def test_a_strict_client_gets_structured_content_of_the_declared_form(address):
    async def work(client):
        tools = (await client.list_tools()).tools
        assert [tool.name for tool in tools] == TOOLS
        assert all(tool.output_schema and tool.description and tool.input_schema for tool in tools)
        home = hearth.TextHome("maple", "HOLDS(agent, milk)")
        text, _ = home.reset(4)
        turn = await called(client, "home", name="maple", goal="HOLDS(agent, milk)", seed=4)
        assert turn["observation"] == text and turn["instructions"] == home.instructions
        turn = await called(client, "act", command="Walk kitchen", episode=turn["episode"])
        text, reward, *_ = home.step("Walk kitchen")
        assert (turn["observation"], turn["reward"]) == (text, reward)
        assert await called(client, "observe", episode=turn["episode"]) == turn

    asked(work, address)


def test_tools_about_programs(address):
    async def work(client):
        good = await called(client, "check", program=PROGRAM)
        assert good["valid"] and len(good["steps"]) == 4
        bad = await called(client, "check", program=PROGRAM + "\n[Flie] <milk> (1)")
        assert not bad["valid"] and bad["faults"][0]["code"] == "UNKNOWN_ACTION" and bad["faults"][0]["line"] == 7
        words = await called(client, "check", program="1. Walk to the kitchen\n2. Open the fridge")
        assert words["valid"] and words["steps"][0].startswith("[Walk] <kitchen>")
        ran = await called(client, "run", program=PROGRAM, home="maple")
        assert ran["executable"] and ran["changes"] and ran["failure"] is None
        failed = await called(client, "run", program=PROGRAM.replace("[Open] <fridge> (1)\n", ""), home="maple")
        assert not failed["executable"] and failed["failure"]["code"] and failed["failure"]["step"] == 3
        repaired = await called(client, "repair", program=PROGRAM, home="maple", seed=3)
        assert repaired["pairs"][0]["repaired"]
        plan = await called(client, "plan", home="maple", goal="ON(milk, table)", seed=4)
        assert plan["reached"] and plan["commands"]
        turn = await called(client, "home", name="maple", goal="ON(milk, table)", seed=4)
        for command in plan["commands"]:
            turn = await called(client, "act", command=command, episode=turn["episode"])
        assert turn["won"]
        assert (await called(client, "knowledge", name="fridge"))["kind"] == "object"
        assert (await called(client, "knowledge", name="Open"))["kind"] == "action"

    asked(work, address)


@pytest.mark.parametrize("how", ["stdio", "http", "http-session"])
def test_bad_input_is_an_error_of_the_tool_and_never_ends_the_server(how, address):
    server, mode = (stdio(), "auto") if how == "stdio" else (address, "legacy" if how == "http-session" else "auto")

    async def work(client):
        assert "OUT_OF_ORDER" in await refused(client, "observe")
        assert "UNKNOWN_ID" in await refused(client, "act", command="wait", episode="nobody's")
        assert "UNKNOWN_HOME" in await refused(client, "home", name="../etc", goal="x")
        assert "BAD_ARGUMENT" in await refused(client, "home", name="maple")
        assert "BAD_ARGUMENT" in await refused(client, "home", seed=-1)
        assert "seed" in await refused(client, "home", seed="many")
        assert "command" in await refused(client, "act")
        assert "FILE_TOO_LARGE" in await refused(client, "check", program="x" * 30_000)
        assert "UNKNOWN_HOME" in await refused(client, "run", program=PROGRAM, home="castle")
        assert await refused(client, "run", program="hello", home="maple")
        assert "UNKNOWN_OBJECT" in await refused(client, "knowledge", name="warp drive")
        assert await refused(client, "plan", home="maple", goal="ON(")
        with contextlib.suppress(mcp.MCPError):
            assert (await client.call_tool("fly", {})).is_error
        turn = await called(client, "home", seed=1)
        episode = {"episode": turn["episode"]}
        turn = await called(client, "act", command="fly to the moon", **episode)
        assert turn["fault"]["code"] and turn["fault"]["remedy"] and turn["turn"] == 1

    asked(work, server, mode)


def test_after_the_end_a_command_is_refused_and_a_new_episode_begins():
    async def work(client):
        await called(client, "home", name="maple", goal="HOLDS(agent, milk)", seed=4)
        await called(client, "act", command="wait")
        assert (await called(client, "act", command="wait"))["done"]
        assert "OUT_OF_ORDER" in await refused(client, "act", command="wait")
        assert (await called(client, "home", seed=2))["turn"] == 0
        assert [tool.name for tool in (await client.list_tools()).tools] == ["home", "act"]

    asked(work, stdio("--limit", "2", "--only", "home,act"))


def test_clients_do_not_meet_unless_one_has_the_other_s_name(address):
    async def work(first):
        turn = await called(first, "home", seed=1)
        async with Client(address, mode="legacy") as second:
            assert "OUT_OF_ORDER" in await refused(second, "observe")
            await called(second, "home", seed=2)
            assert await called(first, "observe") == {**turn, "instructions": ""}
            assert (await called(second, "observe", episode=turn["episode"]))["episode"] == turn["episode"]

    asked(work, address, "legacy")


def test_seeds_repeat_and_sixty_four_play_at_once(address):
    async def play(seed):
        async with Client(address) as client:
            turn = await called(client, "home", name="maple", goal="HOLDS(agent, milk)", seed=seed)
            after = await called(client, "act", command="Walk kitchen", episode=turn["episode"])
            return {**after, "episode": ""}

    async def run():
        return await asyncio.gather(*[play(seed) for seed in (*range(32), *range(32))])

    found = asyncio.run(run())
    assert found[:32] == found[32:]


def test_the_doors_of_http_are_those_of_the_other_rooms(address):
    ask = {"jsonrpc": "2.0", "id": 1, "method": "tools/list"}
    for headers in ({"host": "evil.example"}, {"origin": "https://evil.example"}, {"sec-fetch-site": "cross-site"}):
        assert httpx2.post(address, json=ask, headers=headers).status_code == 403
    assert (
        httpx2.post(address, content=b"{", headers={"accept": "application/json, text/event-stream"}).status_code >= 400
    )
    large = httpx2.post(address, content=b"x" * 300_000, headers={"content-type": "application/json"})
    assert large.status_code == 413


@pytest.mark.parametrize("options", [("--only", "fly"), ("--tasks", "wah:nowhere")])
def test_the_command_refuses_what_it_cannot_serve(options):
    done = subprocess.run([*CLI, *options], check=False, capture_output=True, text=True, cwd=ROOT, timeout=60)
    assert done.returncode in (1, 2) and "Traceback" not in done.stderr
