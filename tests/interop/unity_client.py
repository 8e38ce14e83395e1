"""A client of the Unity protocol, of our own making: the messages of the published one, by the standard library."""

from __future__ import annotations

import base64
import json
import urllib.request

import numpy as np


class UnityClient:
    """Sends the published client's messages to a server.

    Args:
        address: `http://127.0.0.1:8080`.
        post: what sends a body and returns the reply's body; HTTP if None.
    """

    def __init__(self, address: str = "", post=None) -> None:
        self.address, self._post = address, post or self._over_http

    def _over_http(self, body: bytes) -> bytes:
        headers = {"Content-Type": "application/json"}
        asked = urllib.request.Request(self.address, body, headers)
        with urllib.request.urlopen(asked, timeout=300) as reply:
            return reply.read()

    def ask(self, action: str, numbers=None, texts=None) -> dict:
        """Return the reply to an action."""
        request = {"id": "7.5", "action": action}
        if numbers is not None:
            request["intParams"] = list(numbers)
        if texts is not None:
            request["stringParams"] = [text if isinstance(text, str) else json.dumps(text) for text in texts]
        return json.loads(self._post(json.dumps(request).encode()))

    def reset(self, number=None) -> bool:
        numbers = [] if number is None else [number]
        self.ask("clear", numbers)
        return self.ask("environment", numbers)["success"]

    def add_character(self, resource="Chars/Male1", room="", position=None) -> dict:
        mode = "fix_position" if position else "fix_room" if room else "random"
        x, y, z = position or (0, 0, 0)
        settings = {"character_resource": resource, "mode": mode, "initial_room": room,
                    "character_position": {"x": x, "y": y, "z": z}}  # fmt: skip
        return self.ask("add_character", texts=[settings])

    def graph(self) -> dict:
        return json.loads(self.ask("environment_graph")["message"])

    def expand(self, graph: dict) -> dict:
        settings = {"randomize": False, "random_seed": -1, "animate_character": False, "ignore_obstacles": False,
                    "transfer_transform": True}  # fmt: skip
        return self.ask("expand_scene", texts=[settings, graph])

    def render(self, lines, **settings) -> tuple[bool, dict]:
        given = {"randomize_execution": False, "random_seed": -1, "processing_time_limit": 10, "skip_execution": False,
                 "output_folder": "Output/", "file_name_prefix": "script", "frame_rate": 5, "find_solution": False,
                 "image_synthesis": ["normal"], "save_pose_data": False, "save_scene_states": False,
                 "camera_mode": ["AUTO"], "recording": False, "image_width": 640, "image_height": 480,
                 "time_scale": 1.0, "skip_animation": False, **settings}  # fmt: skip
        reply = self.ask("render_script", texts=[given, *lines])
        try:
            return reply["success"], json.loads(reply["message"])
        except ValueError:
            return reply["success"], reply["message"]

    def images(self, cameras, mode="normal", width=64, height=48):
        """Return pictures as the published client decodes them: blue, green, red."""
        import cv2

        settings = {"mode": mode, "image_width": width, "image_height": height}
        reply = self.ask("camera_image", cameras, [settings])
        assert reply["success"], reply["message"]
        how = cv2.IMREAD_ANYDEPTH + cv2.IMREAD_ANYCOLOR
        return [cv2.imdecode(np.frombuffer(base64.b64decode(each), np.uint8), how) for each in reply["message_list"]]


def ids_of(graph: dict) -> dict[str, int]:
    """Return the first node of each class."""
    found: dict[str, int] = {}
    for node in graph["nodes"]:
        found.setdefault(node["class_name"], node["id"])
    return found


def states(client, name):
    return next(node["states"] for node in client.graph()["nodes"] if node["class_name"] == name)


def relations(client, number):
    return {(e["relation_type"], e["to_id"]) for e in client.graph()["edges"] if e["from_id"] == number}
