"""Tiers are other options by a name."""

from __future__ import annotations

import pytest

from hearth.pipelines.engine.settings import Settings
from hearth.pipelines.engine.tiers import TIERS, tiered
from hearth.schemas.diagnostics import HearthError

PLAIN = {"seed": 0, "limit": None, "homes_each": 0, "variants": 3, "target": 0, "pictures": 3, "videos": 1}


def test_a_tier_says_what_nobody_chose():
    found = tiered("full", {**PLAIN, "target": 500}, ["target"])
    assert found == {**PLAIN, "homes_each": 2, "variants": 6, "target": 500, "pictures": 0, "videos": 0}
    assert tiered("", PLAIN, []) == PLAIN


def test_only_frames_has_pictures_and_only_mini_is_cut():
    found = {name: tiered(name, PLAIN, []) for name in TIERS}
    assert [name for name, options in found.items() if options["pictures"]] == ["frames"]
    assert [name for name, options in found.items() if options["limit"]] == ["mini"]


@pytest.mark.parametrize("name", TIERS)
def test_every_option_is_one_of_a_build(name):
    assert Settings((), "out", **tiered(name, PLAIN, []))


def test_an_unknown_tier():
    with pytest.raises(HearthError, match="unknown tier `huge`") as caught:
        tiered("huge", PLAIN, [])
    assert caught.value.diagnostics[0].suggestion == "tiers are mini, full, frames"


def test_the_command_takes_a_tier_and_what_was_chosen_goes_first(monkeypatch, tmp_path):
    from typer.testing import CliRunner

    from hearth import cli
    from hearth.commands import build

    found = {}
    monkeypatch.setattr(build, "_run", lambda context, only, chosen: found.update(chosen))
    done = CliRunner().invoke(cli.app, ["build", "--tier", "frames", "--videos", "2", "--out", str(tmp_path)])
    assert done.exit_code == 0
    assert (found["pictures"], found["videos"], found["homes_each"]) == (200, 2, 1)
