"""The published client of VirtualHome, where it is installed, against `hearth serve --virtualhome`."""

from __future__ import annotations

import collections.abc
import copy
import importlib
import json
import subprocess
import sys
from pathlib import Path
from urllib.parse import urlsplit

import numpy as np
import pytest

from tests.interop.test_unity_protocol import DEMO, with_cat
from tests.interop.unity_client import ids_of

ROOT = Path(__file__).resolve().parents[2]
PLACES = ("virtualhome.simulation.unity_simulator.comm_unity", "simulation.unity_simulator.comm_unity")


def published():
    """The published module, or a reason why there is none."""
    for name in PLACES:
        try:
            return importlib.import_module(name)
        except ImportError as error:
            reason = f"the published client is not installed: {error}"
    pytest.skip(reason)


@pytest.mark.slow
def test_the_published_client_runs_the_demo(tmp_path, monkeypatch):
    module = published()
    monkeypatch.setattr(np, "fromstring", np.frombuffer)  # it decodes by the former, which NumPy 2.3 removed
    monkeypatch.setattr(collections, "Iterable", collections.abc.Iterable, raising=False)  # gone since Python 3.10
    command = [sys.executable, str(ROOT / "cli.py"), "serve", "--virtualhome", "--port", "0", "--json", "--out",
               str(tmp_path / "out")]  # fmt: skip
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=ROOT) as process:
        try:
            text = ""
            while not text.endswith("}\n") or text.count("{") != text.count("}"):
                line = process.stdout.readline()
                assert line, "the server ended"
                text += line
            port = str(urlsplit(json.loads(text)["address"]).port)
            demo(module.UnityCommunication(port=port, timeout_wait=300))
        finally:
            process.terminate()
    assert len(list((tmp_path / "out" / "relax" / "0").glob("Action_*_0_normal.png"))) > 20


def demo(comm):
    """The steps of the published notebook."""
    assert comm.check_connection() and comm.reset(4)
    assert comm.add_character("chars/Female2", initial_room="kitchen")
    assert comm.add_character("Chars/Male1", initial_room="livingroom")
    done, graph = comm.environment_graph()
    assert done and comm.expand_scene(graph)[0]
    assert comm.expand_scene(with_cat(copy.deepcopy(graph)))[0]
    lines = DEMO.format(**ids_of(graph)).split("\n")
    assert comm.check(lines)[0]
    done, told = comm.render_script(lines, recording=True, file_name_prefix="relax", image_width=64, image_height=48,
                                    frame_rate=2, camera_mode=["PERSON_FROM_BACK"])  # fmt: skip
    assert done and told["0"]["message"] == "Success", told
    count = comm.camera_count()[1]
    for mode in ("normal", "seg_inst", "seg_class", "depth", "flow"):
        done, (picture,) = comm.camera_image([count - 13], mode, image_width=64, image_height=48)
        assert done and picture.shape == (48, 64, 3)
    assert len(comm.camera_data([0])[1]) == 1 and comm.instance_colors()[0] and comm.character_cameras()[0]
    assert comm.add_camera([3, 1.8, 1], [20, 0, 0])[0] and comm.get_visible_objects(0)[0]
    assert comm.set_time(hours=21) and comm.remove_terrain() and not comm.activate_physics()
    assert comm.procedural_generation(1)[0] and comm.point_cloud()[0]
