"""A dataset says by which strength it was augmented, and a strength sets options that nobody chose."""

from __future__ import annotations

import pytest
from typer.testing import CliRunner

import hearth
from hearth import cli
from hearth.analysis.augmentation_results import figures
from hearth.datasets.report.report_writer import write_report
from hearth.pipelines.engine.option_presets import tiered
from hearth.pipelines.engine.settings import Settings
from hearth.repair.perturbation_strengths import STRENGTHS_FILE, load_strengths
from hearth.schemas.diagnostics import HearthError
from hearth.storage.files import read_json

PLAIN = {"homes_each": 0, "variants": 3, "target": 0}
STRENGTHS = load_strengths(STRENGTHS_FILE)
WATCH = "Watch TV\n\n\n[Walk] <television> (1)\n[SwitchOn] <television> (1)\n[Walk] <couch> (1)\n[Sit] <couch> (1)\n"


@pytest.fixture(scope="module", params=STRENGTHS)
def dataset(request, build_folder, tmp_path_factory):
    folder = tmp_path_factory.mktemp(request.param)
    (folder / "watch.txt").write_text(WATCH + "[Watch] <television> (1)\n")
    options = {"homes_folder": None, "homes": ("maple",), "variants": 6, "strength": request.param}
    made = build_folder(folder / "out", [folder / "watch.txt"], **options).run_all()
    return request.param, made.out / "publish"


def test_manifest_card_croissant_report_and_command_name_it(dataset, tmp_path):
    name, folder = dataset
    write_report(hearth.load(folder), tmp_path / "report")
    assert read_json(folder / "manifest.json")["strength"] == figures(folder)["strength"] == name
    texts = [folder / "README.md", folder / "croissant.json", tmp_path / "report/index.html"]
    for text in (path.read_text() for path in texts):
        assert [other for other in STRENGTHS if f"--strength {other}" in text] == [name]
    shown = CliRunner().invoke(cli.app, ["augmented", str(folder)]).output
    assert shown.startswith(f"Augmented by the strength `{name}`.\n")


def test_nothing_of_it_is_unknown_to_verify(dataset):
    done = CliRunner().invoke(cli.app, ["verify", str(dataset[1]), "--strict", "-j", "1"])
    assert done.exit_code == 0, done.output


def test_publishing_alone_names_the_strength_that_augmented(dataset, build_folder):
    name, folder = dataset
    alone = build_folder(folder.parent, [folder.parent.parent / "watch.txt"], homes_folder=None, homes=("maple",))
    alone.run("publish")
    assert read_json(folder / "manifest.json")["strength"] == name


@pytest.mark.parametrize("name", STRENGTHS)
def test_every_option_of_a_strength_is_one_of_a_build(name):
    assert Settings((), "out", **tiered("", {**PLAIN, "strength": name}, []))


def test_the_thesis_draws_twenty_environments_of_each_program_in_one_home():
    thesis = {**PLAIN, "strength": "thesis"}
    found = tiered("", thesis, [])
    assert (found["variants"], found["homes_each"]) == (20, 1)
    assert tiered("", {**thesis, "variants": 4}, ["variants"])["variants"] == 4, "what was chosen goes first"
    full = tiered("full", thesis, [])
    assert (full["variants"], full["homes_each"], full["target"]) == (6, 2, 30_000), "and then the tier"
    assert tiered("", {**PLAIN, "strength": "mild"}, []) == {**PLAIN, "strength": "mild"}


@pytest.mark.parametrize("command", ["build", "augment", "repair"])
def test_an_unknown_strength_is_refused_with_the_known_ones(command, tmp_path):
    (tmp_path / "watch.txt").write_text(WATCH)
    where = [str(tmp_path / "watch.txt")] if command == "repair" else ["--out", str(tmp_path / "out")]
    done = CliRunner().invoke(cli.app, [command, *where, "--strength", "brutal"])
    assert done.exit_code == 2 and "strengths are mild, thesis" in done.output
    with pytest.raises(HearthError, match="unknown strength `brutal`"):
        hearth.build([str(tmp_path / "watch.txt")], str(tmp_path / "out"), strength="brutal")
    assert not (tmp_path / "out").exists(), "nothing was done before"


def test_the_commands_take_a_strength_with_its_options(monkeypatch, tmp_path):
    from hearth.commands import build

    found = {}
    monkeypatch.setattr(build, "_run", lambda context, only, chosen: found.update({only: chosen}))
    for command in ("build", "augment"):
        done = CliRunner().invoke(cli.app, [command, "--strength", "thesis", "--out", str(tmp_path)])
        assert done.exit_code == 0, done.output
    assert [found[only]["variants"] for only in (None, "augment")] == [20, 20]
    assert found[None]["homes_each"] == 1


def test_the_library_takes_a_strength_with_its_options(monkeypatch, tmp_path):
    from hearth.pipelines import build

    asked = []
    monkeypatch.setattr(build, "Settings", lambda *args, **options: asked.append(options) or Settings(*args, **options))
    (tmp_path / "watch.txt").write_text(WATCH)
    home = {"homes": ("maple",), "pictures": 0}
    hearth.build([str(tmp_path / "watch.txt")], str(tmp_path / "out"), strength="thesis", variants=2, **home)
    assert (asked[0]["variants"], asked[0]["homes_each"], asked[0]["strength"]) == (2, 1, "thesis")
