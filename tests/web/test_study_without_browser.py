"""Programs can take part in a study as docs/studies.md says: its blocks are run as they stand."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest

from hearth.studies.study_file import named
from hearth.studies.study_progress import DONE, STAGES
from hearth.web.store import Store, default_url
from hearth.web.study.expected_posts import TURNS
from hearth.web.study.study_store import conducted
from hearth.web.web_errors import STATUS

PAGE = Path(__file__).resolve().parents[2] / "docs/studies.md"
SECTION = PAGE.read_text("utf-8").split("## Without a browser\n")[1].split("\n## ")[0]
SHOWN = "http://127.0.0.1:8000"


@pytest.mark.skipif(shutil.which("curl") is None, reason="no curl here")
def test_the_blocks_do_what_they_say(serving, module, knowledge, tmp_path):
    followed, folder = module("docs/hooks/documentation_commands.py"), tmp_path / "here"
    folder.mkdir()
    printed, running = "", None
    for language, title, text in followed.blocks(PAGE):
        if title:
            (folder / title).write_text(text, "utf-8")
        elif text not in SECTION:
            continue
        elif text.startswith("hearth serve "):
            options = [str(folder / word) if word.endswith(".yaml") else word for word in text.split()[2:]]
            running = serving(*options, out=tmp_path / "served")
        elif language == "bash":
            assert SHOWN in text
            printed = followed.ran(text.replace(SHOWN, running.address), folder)
        else:
            assert text.strip() == printed.strip()
    store = Store(default_url(tmp_path / "served"))
    conduct = conducted(store, named(str(folder / "tables.yaml")), lambda: knowledge)
    stages = [conduct.standing(person).stage for person in conduct.ledger.streams()]
    store.close()
    assert stages == ["tutorial", DONE]


def test_the_tables_have_every_stage_every_post_and_the_status_of_every_code():
    assert set(STAGES) <= set(re.findall(r"`(\w+)`", "".join(re.findall(r"^\| (`.*?) \|", SECTION, re.M))))
    assert {post for posts in TURNS.values() for post in posts} == set(re.findall(r"POST /study/(\w+)", SECTION))
    listed = re.findall(r"^\| (\d+) \| `(\w+)` \|", SECTION, re.M)
    assert len(listed) == 7 and all(STATUS.get(code, 400) == int(status) for status, code in listed)
