"""The worked example of a new action, in a copy of the checkout: the files it touches, and the suite with it."""

from __future__ import annotations

import re
import sys

import pytest
from checkouts import copied, done

PAGE = "docs/examples/new-action.md"
BASH = re.compile(r"^```bash\n(.*?)^```$", re.DOTALL | re.MULTILINE)
TITLED = re.compile(r'^```text title="([^"]+)"\n(.*?)^```$', re.DOTALL | re.MULTILINE)

LEGAL = """
from hearth.kb.loading.load import default
from hearth.schemas.program import ObjectRef, Step
from hearth.simulation.env import Env
from hearth.simulation.world.home import Home
from hearth.homes import library as catalog

env = Env(partial=False)
env.reset(Home.from_graph(catalog.load_graph("maple", default()), "maple", default()))
home = env.world.home
book = next(home.ids[i] for i, name in enumerate(home.classes) if name == "book")
ref = ObjectRef("book", 1, book)
assert Step("Juggle", (ref,)) not in env.legal()
for action in ("Walk", "Grab"):
    assert not env.step({0: Step(action, (ref,))}).failures
assert Step("Juggle", (ref,)) in env.legal()
assert env.legal().objects("Juggle") == (book,)
"""

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def copy(tmp_path_factory):
    """The checkout with the action, committed before it: `git status` says what the page has changed."""
    copy = copied(tmp_path_factory.mktemp("new-action"))
    who = ("-c", "user.name=test", "-c", "user.email=test@example.org")
    done(copy, "git", "init", "-q")
    done(copy, "git", "add", "-A", "-f")
    done(copy, "git", *who, "commit", "-qm", "before")
    text = (copy / PAGE).read_text("utf-8")
    for title, content in TITLED.findall(text):
        (copy / title).write_text(content, "utf-8")
    for script in BASH.findall(text):
        done(copy, "bash", "-euo", "pipefail", "-c", f'hearth() {{ "{sys.executable}" cli.py "$@"; }}\n{script}')
    return copy


def test_it_touches_the_files_that_contributing_names(copy):
    changed = {line[3:] for line in done(copy, "git", "status", "--porcelain").splitlines()} - {"ball.txt"}
    text = (copy / "CONTRIBUTING.md").read_text("utf-8")
    (section,) = re.findall(r"\*\*An action\*\*\n(.*?)\n\n", text, re.DOTALL)
    named = {name for name in re.findall(r"`([^`]+)`", section) if "/" in name or name.endswith(".py")} - {PAGE}
    assert len(changed) == 8
    for file in changed:
        assert any(file == name or (name.endswith("/") and file.startswith(name)) for name in named), file


def test_it_is_legal_where_it_can_be_done(copy):
    done(copy, sys.executable, "-c", LEGAL)


def test_the_whole_suite_is_green_with_it(copy):
    options = ("-q", "-n", "2", "--dist", "loadfile", "-p", "no:cacheprovider", "-m", "not slow and not tools")
    assert " passed" in done(copy, sys.executable, "-m", "pytest", *options)
