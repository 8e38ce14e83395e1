"""The page for people who come from VirtualHome: each of its ten scripts runs, and all old ones find the server."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.interop.test_published_unity_client import published

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs/virtualhome.md"
SCRIPTS = 10


@pytest.fixture(scope="module")
def follower(module):
    return module("docs/hooks/documentation_commands.py")


def sections(follower):
    """The fenced blocks of each of the ten scripts."""
    text = PAGE.read_text("utf-8").split("## The ten commonest scripts")[1].split("\n## ")[0]
    return [follower.FENCE.findall(part) for part in text.split("\n### ")[1:]]


def test_ten_scripts_stand_side_by_side(follower):
    found = sections(follower)
    assert len(found) == SCRIPTS
    for blocks in found[:-1]:
        titles = [title for _, title, _ in blocks]
        assert any(title.endswith(("_unity.py", "_old.py")) for title in titles)
        assert any(title.endswith("_hearth.py") or not title for title in titles)


@pytest.mark.slow
def test_the_new_scripts_run(follower, tmp_path):
    folder = tmp_path / "here"
    folder.mkdir()
    for blocks in sections(follower):
        for language, title, text in blocks:
            if title:
                (folder / title).write_text(text)
            if title.endswith("_hearth.py"):
                follower.ran(f"python {title}", folder)
            elif language == "bash":
                follower.ran(text, folder)
    assert list((folder / "film").rglob("*.mp4")) and (folder / "data_out").is_dir()


@pytest.mark.slow
def test_the_old_scripts_find_the_server(follower, tmp_path):
    module = published()
    client = Path(module.__file__).parents[2]
    paths = os.pathsep.join([str(client.parent), str(client / "simulation"), os.environ.get("PYTHONPATH", "")])
    command = [sys.executable, str(ROOT / "cli.py"), "serve", "--virtualhome", "--port", "0", "--json", "--out",
               str(tmp_path)]  # fmt: skip
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=ROOT) as process:
        try:
            text = ""
            while not text.endswith("}\n") or text.count("{") != text.count("}"):
                text += process.stdout.readline()
            port = json.loads(text)["address"].rpartition(":")[2].strip("/")
            for blocks in sections(follower):
                for _, title, script in blocks:
                    if title.endswith(("_unity.py", "_old.py")):
                        here = script.replace("timeout_wait=300", f'timeout_wait=300, port="{port}"')
                        subprocess.run(
                            [sys.executable, "-c", here], check=True, env={**os.environ, "PYTHONPATH": paths}
                        )
        finally:
            process.terminate()
