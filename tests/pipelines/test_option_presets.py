"""Tiers are other options by a name."""

from __future__ import annotations

from pathlib import Path

import pytest

from hearth.pipelines.engine.option_presets import TIERS, tiered
from hearth.pipelines.engine.settings import Settings
from hearth.schemas.diagnostics import HearthError

PLAIN = {"seed": 0, "limit": None, "homes_each": 0, "variants": 3, "target": 0, "pictures": 3, "videos": 1}


def test_a_tier_says_what_nobody_chose():
    found = tiered("full", {**PLAIN, "target": 500}, ["target"])
    assert found == {**PLAIN, "homes_each": 2, "variants": 6, "target": 500, "pictures": 0, "videos": 0}
    assert tiered("", PLAIN, []) == PLAIN


def test_who_wants_no_pictures_wants_no_films():
    assert tiered("", {**PLAIN, "pictures": 0}, ["pictures"])["videos"] == 0
    assert tiered("", {**PLAIN, "pictures": 0}, ["pictures", "videos"])["videos"] == 1
    assert tiered("", {**PLAIN, "pictures": 2}, ["pictures"])["videos"] == 1


def test_mini_and_full_have_no_pictures_and_only_mini_is_cut():
    found = {name: tiered(name, PLAIN, []) for name in TIERS}
    assert [name for name, options in found.items() if not options["pictures"]] == ["mini", "full", "clips", "demos"]
    assert [name for name, options in found.items() if options["limit"]] == ["mini"]


@pytest.mark.parametrize("name", TIERS)
def test_every_option_is_one_of_a_build(name):
    assert Settings((), "out", **tiered(name, PLAIN, []))


def test_an_unknown_tier():
    with pytest.raises(HearthError, match="unknown tier `huge`") as caught:
        tiered("huge", PLAIN, [])
    assert caught.value.diagnostics[0].suggestion == "tiers are standard, first, mini, full, frames, clips, demos"


def test_the_command_takes_a_tier_and_what_was_chosen_goes_first(monkeypatch, tmp_path):
    from typer.testing import CliRunner

    from hearth import cli
    from hearth.commands import build

    found = {}
    monkeypatch.setattr(build, "_run", lambda context, only, chosen: found.update(chosen))
    done = CliRunner().invoke(cli.app, ["build", "--tier", "frames", "--videos", "2", "--out", str(tmp_path)])
    assert done.exit_code == 0
    assert (found["pictures"], found["videos"], found["homes_each"]) == (200, 2, 1)


@pytest.mark.parametrize(
    ("words", "tier"),
    [((), "standard"), (("--tier", "first"), "first"), (("mine.csv",), ""), (("--tier", "mini"), "mini")],
)
def test_the_embedded_corpus_has_a_tier_of_its_own(monkeypatch, tmp_path, words, tier):
    from typer.testing import CliRunner

    from hearth import cli
    from hearth.commands import build

    asked = []
    monkeypatch.setattr(build, "_tiered", lambda context, tier: asked.append(tier) or {})
    monkeypatch.setattr(build, "_run", lambda context, only, chosen: None)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.csv").touch()
    assert CliRunner().invoke(cli.app, ["build", *words, "--out", "out"]).exit_code == 0
    assert asked == [tier]


def test_the_first_part_is_what_earlier_versions_built(monkeypatch, tmp_path):
    from hearth.commands import build
    from hearth.pipelines import build as pipeline

    given = []
    monkeypatch.setattr(
        pipeline, "build", lambda paths, out, **_: given.append([Path(path).parent.name for path in paths])
    )
    for tier in ("first", "standard"):
        build._built(None, {"out": tmp_path, "tier": tier})
    assert given == [["crowd", "crowd"], []]
