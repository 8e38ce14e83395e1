"""`doctor` on machines that lack things."""

import json
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

from hearth import cli
from hearth.commands import doctor

ROOT = Path(__file__).resolve().parents[2]


def call(*arguments):
    return CliRunner().invoke(cli.app, ["doctor", *arguments])


@pytest.fixture
def findings():
    """Return the findings by name, without casting rays or opening videos."""

    def look():
        return {each.what: each for each in (check() for check in doctor.CHECKS) if each}

    return look


@pytest.fixture(autouse=True)
def quick(monkeypatch):
    """Rays and codecs take seconds; one test looks at them."""
    slow = {doctor.rays, doctor.codecs}
    monkeypatch.setattr(doctor, "CHECKS", tuple(check for check in doctor.CHECKS if check not in slow))


def test_everything_is_named_with_its_cost_where_it_lacks(findings):
    found = findings()
    assert {"Python", "libraries", "disk", "cores", "uv", "browser", "fonts", "release sample"} <= set(found)
    assert all(each.cost for each in found.values() if each.state != doctor.OK)


def test_json_says_the_same_as_the_table(findings):
    report = json.loads(call("--json").stdout)
    assert report["broken"] == 0
    assert [each["what"] for each in report["findings"]] == list(findings())
    shown = call().stdout
    assert all(each["what"] in shown for each in report["findings"])


def test_rays_are_really_cast():
    pytest.importorskip("open3d", exc_type=ImportError, reason="open3d or its system libraries are not here")
    assert doctor.rays().state == doctor.OK


def test_video_codecs_are_really_opened():
    finding = doctor.codecs()
    assert finding.state == doctor.OK, finding
    assert "FFV1" in finding.found


def test_a_codec_that_does_not_open_is_missing(monkeypatch):
    monkeypatch.setattr(doctor, "CODECS", {"FFV1": ".mkv", "ZZZZ": ".mp4"})
    finding = doctor.codecs()
    assert (finding.state, finding.cost) == (doctor.MISSING, "no ZZZZ")


def test_missing_system_libraries_are_named_by_package(monkeypatch):
    monkeypatch.setattr(doctor, "LIBRARIES", {"libc.so.6": "libc6", "libnothing.so.9": "libnothing9"})
    assert doctor.missing_libraries() == ["libnothing9"]
    finding = doctor.rays()
    assert finding.state == doctor.MISSING
    assert "apt-get install libnothing9" in finding.cost
    assert call("--libraries").stdout == "libnothing9\n"
    assert json.loads(call("--libraries", "--json").stdout) == ["libnothing9"]


def test_no_missing_library_prints_nothing(monkeypatch):
    monkeypatch.setattr(doctor, "LIBRARIES", {"libc.so.6": "libc6"})
    assert call("--libraries").stdout == ""


def test_a_missing_python_library_is_status_1(monkeypatch):
    monkeypatch.setattr(doctor, "_installed", lambda name: name != "duckdb")
    result = call()
    assert result.exit_code == 1
    assert "without duckdb" in result.stdout and "make setup" in result.stdout


@pytest.mark.parametrize(("variable", "state"), [("", doctor.MISSING), ("here", doctor.OK)])
def test_the_release_sample_is_looked_for_where_the_environment_says(monkeypatch, tmp_path, variable, state):
    monkeypatch.setenv("HEARTH_REAL_DATA", str(tmp_path if variable else tmp_path / "gone"))
    assert doctor.real_data().state == state


def test_without_a_browser_nothing_but_trying_reports_is_lost(monkeypatch):
    monkeypatch.setenv("PATH", "/nowhere")
    assert doctor.browser().state == doctor.MISSING
    assert doctor.uv().state == doctor.MISSING


def test_the_doctor_runs_where_the_libraries_do_not_load():
    """Setting up asks for missing libraries before open3d can be imported."""
    code = "import sys; sys.modules['cv2'] = sys.modules['open3d'] = None\nfrom hearth.commands import doctor\n"
    done = subprocess.run(
        [sys.executable, "-c", code + "print(doctor.missing_libraries())"], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("called", ["cli.py", ".venv/bin/hearth"])
def test_a_copy_that_runs_the_code_of_the_original_is_broken(called, tmp_path, monkeypatch):
    monkeypatch.setattr(sys, "argv", [str(tmp_path / called)])
    assert doctor.folder().state == doctor.OK  # of no checkout
    (tmp_path / "commands").mkdir()
    (tmp_path / "commands/doctor.py").touch()
    found = doctor.folder()
    assert found.state == doctor.BROKEN and found.cost == f"run `make setup` in {tmp_path}"
    assert str(ROOT) in found.found and str(tmp_path) in found.found


def test_a_checkout_that_runs_its_own_code_is_sound(monkeypatch):
    for called in (ROOT / "cli.py", ROOT / ".venv/bin/hearth"):
        monkeypatch.setattr(sys, "argv", [str(called)])
        assert doctor.folder().state == doctor.OK
