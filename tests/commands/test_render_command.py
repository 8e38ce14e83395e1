"""`render-program` and `render-sheet`, through typer's runner."""

import json
import re

import pytest

pytest.importorskip("open3d")

from typer.testing import CliRunner

from hearth.cli import app
from hearth.commands.render import _height, _shown
from hearth.rendering.film import png


@pytest.mark.slow
def test_a_program_becomes_pictures_and_a_contact_sheet(tmp_path):
    file = tmp_path / "sit.txt"
    file.write_text("Sit\nRest\n\n\n[Walk] <couch> (1)\n[Sit] <couch> (1)\n")
    result = CliRunner().invoke(app, ["render-program", str(file), "--out", str(tmp_path / "out"), "--width", "64"])
    assert result.exit_code == 0, result.output
    names = sorted(path.name for path in (tmp_path / "out").iterdir())
    assert len(names) == 3 * 2 * 2 + 1
    assert "002.auto.instance_ids.png" in names
    assert png.decode((tmp_path / "out/001.top.rgb.png").read_bytes()).shape == (48, 64, 3)
    assert png.decode((tmp_path / "out/sheet.png").read_bytes()).shape[1] > 3 * 64
    assert re.search(r"shows the person in [0-3] of 3 pictures, and all objects of [0-2] of the 2 steps", result.output)


@pytest.mark.parametrize("wrong", [["--modalities", "smell"], ["--mode", "video", "--cameras", "nowhere"],
                                   ["--mode", "video", "--cameras", "third.3"]])  # fmt: skip
def test_a_refused_film_leaves_no_folder(tmp_path, wrong):
    (tmp_path / "sit.txt").write_text("Sit\nRest\n\n\n[Walk] <couch> (1)\n")
    words = ["render-program", str(tmp_path / "sit.txt"), "--out", str(tmp_path / "out"), "--width", "64", *wrong]
    result = CliRunner().invoke(app, words)
    assert result.exit_code == 1 and not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("shows", "line"),
    [
        ((6, 3, 4, 3), "the person in 3 of 6 pictures, and all objects of 3 of the 4 steps with any."),
        ((2, 0, 0, 0), "the person in 0 of 2 pictures."),
    ],
)
def test_the_line_counts_what_the_pictures_show_not_steps_without_objects(shows, line):
    names = ("pictures", "with_person", "steps_with_objects", "with_all_objects")
    assert _shown(dict(zip(names, shows, strict=True))) == f"The contact sheet shows {line}"


@pytest.mark.slow
def test_a_program_becomes_a_video_that_a_page_plays(tmp_path):
    file = tmp_path / "sit.txt"
    file.write_text("Sit\nRest\n\n\n[Walk] <couch> (1)\n[Sit] <couch> (1)\n")
    command = [
        "render-program",
        str(file),
        "--out",
        str(tmp_path / "out"),
        "--width",
        "48",
        "--mode",
        "video",
        "--fps",
        "5",
    ]
    result = CliRunner().invoke(app, [*command, "--cameras", "top", "--json"])
    assert result.exit_code == 0, result.output
    found = json.loads(result.stdout)
    (video,) = found["videos"]
    assert found["pictures"] == video["frames"]
    assert [step["tick"] for step in video["steps"]] == [0, 1, 2]
    names = {path.name for path in (tmp_path / "out").iterdir()}
    assert names == {"top.webm", "top.mp4", "top.html", "steps.json", "sheet.png"}
    assert "top.webm" in (tmp_path / "out/top.html").read_text()
    refused = CliRunner().invoke(app, [*command, "--cameras", "attic"])
    assert refused.exit_code != 0


@pytest.mark.parametrize(
    ("options", "named"),
    [
        ("--cameras top,nonsense", "--cameras"),
        ("--fps 30", "--fps"),
        ("--vary", "--vary"),
        ("--mode video --vary --hour 22", "--hour"),
        ("--mode video --width 331", "--width"),
    ],
)
def test_options_without_effect_are_refused(tmp_path, options, named):
    file = tmp_path / "sit.txt"
    file.write_text("Sit\nRest\n\n\n[Sit] <couch> (1)\n")
    result = CliRunner().invoke(app, ["render-program", str(file), "--out", str(tmp_path / "out"), *options.split()])
    assert result.exit_code == 2 and named in result.output
    assert not (tmp_path / "out").exists()


def test_videos_have_an_even_height():
    assert [_height(width, "video") for width in (320, 330, 46)] == [240, 246, 34]
    assert _height(330, "snapshots") == 247
