"""An agent for `hearth play` in plain Python: looks for the thing that it is to hold, in every room and cupboard."""

import json
import re
import sys
from typing import Any

tried: set[str] = set()


def choose(wanted: str, legal: list[str], nodes: list[dict[str, Any]]) -> str | None:
    """The first of these that is legal and was not done before; None to wait."""
    closed = [f"(1.{n['id']})" for n in nodes if "CLOSED" in n["states"] and "GRABBABLE" not in n["properties"]]
    rooms = [f"(1.{n['id']})" for n in nodes if n["category"] == "Rooms"]
    thing = [f"<{wanted}>"]
    for action, about in (("Grab", thing), ("Walk", thing), ("Open", closed), ("Walk", closed), ("Walk", rooms)):
        for text in legal:
            if text.startswith(f"[{action}] ") and any(each in text for each in about) and text not in tried:
                tried.add(text)
                return text
    return None


for line in sys.stdin:
    message = json.loads(line)
    if message["type"] == "begin":
        (goal,) = re.findall(r"HOLDS\(agent, (\w+)\)", message["goal"])
    elif message["type"] == "observe":
        act = choose(goal, message["legal"], message["observation"]["graph"]["nodes"])
        print(json.dumps({"tick": message["tick"], "act": act}), flush=True)
