"""`serve --virtualhome`: the server that takes the place of VirtualHome's Unity program."""

from __future__ import annotations

import sys
from pathlib import Path

from hearth.commands import output
from hearth.commands.inputs import read_knowledge
from hearth.schemas.optional_libraries import library


def serve_virtualhome(port: int, out: Path, homes: Path | None, kb: Path | None, seed: int, as_json: bool) -> None:
    """Answer clients of VirtualHome's Unity program until interrupted."""
    for module in ("starlette", "uvicorn"):
        library(module)
    from hearth.interop.virtualhome.protocol_actions import ACTIONS, Simulator
    from hearth.interop.virtualhome.script_recordings import Recordings
    from hearth.interop.virtualhome.unity_scene import Homes, UnityScene
    from hearth.web.serving import listening, run
    from hearth.web.unity_protocol import unity_application

    where = listening(port)
    address = f"http://127.0.0.1:{where.getsockname()[1]}"
    known = Homes.of_library(read_knowledge(kb), homes)
    app = unity_application(Simulator(UnityScene(known, seed), Recordings(out)))
    listed = ", ".join(f"{number} {name}" for number, name in enumerate(known.names))
    lines = f"Hearth answers clients of VirtualHome at {address}\nEnvironments: {listed}\nRecordings go into {out}"
    facts = {"address": address, "environments": list(known.names), "out": str(out), "actions": list(ACTIONS)}
    output.say(lines, facts, as_json)
    sys.stdout.flush()
    run(app, where)
