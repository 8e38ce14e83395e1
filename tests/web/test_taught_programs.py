"""Programs that the pages teach can run: the tutorial's program, and those that the test of reviewers calls right."""

from __future__ import annotations

import re

import pytest

from hearth.schemas.yaml_limits import packaged
from hearth.web.annotate.live_check import check_draft
from hearth.web.annotate.program_draft import Draft, read_blocks
from hearth.web.annotate.trial_run import homes, run_draft

TAUGHT = packaged("hearth.web.annotate", "tutorial.yaml")
TESTED = packaged("hearth.web.annotate", "qualification.yaml")["questions"]
PROGRAMS = {
    "tutorial": [*TAUGHT["go"], *TAUGHT["do"], *TAUGHT["look"]],
    **{each["title"]: each["steps"] for each in TESTED if each["right"]},
}
ROOMS = ("living_room", "kitchen", "bathroom", "bedroom")


def block(words, known):
    """A step in the words of its block, as the page sends it."""
    for action in sorted(known.actions.values(), key=lambda each: -len(each.template)):
        found = re.fullmatch(re.sub(r"\\\{\d\\\}", "(.+)", re.escape(action.template)), words)
        things = [name.replace(" ", "_") for name in found.groups()] if found else []
        if found and all(known.affords(action.name, slot, name) for slot, name in enumerate(things)):
            return {"action": action.name, "things": [[name, 1] for name in things]}
    raise AssertionError(f"no block is `{words}`")


def draft(steps, known):
    sent = [block(words, known) for words in steps]
    names = dict.fromkeys(name for step in sent for name, _ in step["things"])
    scene = Draft({each: 1 for each in names if each in ROOMS}, {each: 1 for each in names if each not in ROOMS})
    return Draft(scene.rooms, scene.props, read_blocks(sent, scene, known))


@pytest.mark.parametrize("name", PROGRAMS)
def test_what_is_taught_runs_in_every_home(name, knowledge):
    taught = draft(PROGRAMS[name], knowledge)
    assert [each for each in check_draft(taught, name, "", knowledge) if each.fault] == []
    for title in ("Watch TV", "Relax", name):  # the random choices of the home follow from the title
        runs = {home: run_draft(taught, title, home, knowledge) for home in homes()}
        assert {home: run["why"] for home, run in runs.items() if not run["ran"]} == {}


def test_the_tutorial_shows_the_program_that_runs(person):
    page = re.sub(r"<[^>]+>", "", person.get("/annotate/tutorial").text)
    assert all(words in page for words in PROGRAMS["tutorial"]) and TAUGHT["description"] in page
