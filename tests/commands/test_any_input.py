"""`check`, `run`, `repair` and `render-program` read what `build` reads."""

from __future__ import annotations

import gzip
import json
import zipfile

import pytest
from typer.testing import CliRunner

from hearth.cli import app

PLAN = "Sure! Here is how to watch TV:\n\n## Watch TV\n1. **Walk to the TV**\n2. Calibrate it\n3. Turn on the TV\n"
STEPS = ["[Walk] <television> (1)", "[SwitchOn] <television> (1)"]
TEXT = "Watch TV\nFrom the sofa.\n\n" + "\n".join(STEPS) + "\n"
RECORD = {"title": "Watch TV", "steps": STEPS}


def call(*arguments, status=0, **options):
    result = CliRunner().invoke(app, [str(argument) for argument in arguments], **options)
    assert result.exit_code == status, result.output
    return result


def zipped(data):
    import io

    out = io.BytesIO()
    with zipfile.ZipFile(out, "w") as archive:
        archive.writestr("deep/a.txt", data)
    return out.getvalue()


FORMS = {
    "plan.md": PLAN.replace("2. Calibrate it\n", "").encode(),
    "a.json": json.dumps(RECORD).encode(),
    "list.json": json.dumps(["Task: TV\nStep 1: Walk to TV\nStep 2: Turn on TV", "Task: Nap\nStep 1: Sleep"]).encode(),
    "a.jsonl": f"{json.dumps(RECORD)}\n{json.dumps(RECORD)}\n".encode(),
    "a.csv": b"Task;Text;Plan\nWatch TV;Words.;\"1. Walk to TV\n2. Turn on TV\"\n",
    "a.zip": zipped(TEXT),
    "a.txt.gz": gzip.compress(TEXT.encode()),
    "wide.txt": TEXT.encode("utf-16"),
}  # fmt: skip


@pytest.mark.parametrize("name", FORMS)
def test_every_form_is_checked_and_run(tmp_path, name):
    file = tmp_path / name
    file.write_bytes(FORMS[name])
    checked = json.loads(call("check", file, "--json").stdout)
    assert checked["faults"] == 0 and checked["files"][0]["steps"] in (2, 3, 4)
    found = json.loads(call("run", file, "--home", "maple", "--json").stdout)
    assert [step.partition("]")[0] for step in found["steps"]] == ["[Walk", "[SwitchOn"] and found["executable"]


def test_a_folder_is_a_source_and_a_file_is_no_home(tmp_path):
    for name in ("a.txt", "b.txt"):
        (tmp_path / name).write_text(TEXT.replace("Watch", name))
    assert call("check", tmp_path).stdout.startswith("1 source, 2 programs, 4 steps")
    assert call("check", tmp_path / "a.txt").stdout.startswith("1 file, 1 program")
    refused = call("run", tmp_path / "a.txt", "--home", "scene.json", status=2)
    assert "there is no file of that name; homes are" in refused.output


def test_a_program_with_a_bad_step_is_run_only_when_that_is_asked_for(tmp_path):
    file = tmp_path / "plan.md"
    file.write_text(PLAN)
    refused = call("run", file, status=1)
    assert not refused.stdout and "error[NOT_UNDERSTOOD]" in refused.stderr and "plan.md:5:4" in refused.stderr
    assert "Nothing was run; `--skip-faults` leaves these lines out and runs the 2 other steps." in refused.stderr
    skipped = call("run", file, "--skip-faults", "--json", status=1)
    found = json.loads(skipped.stdout)
    assert len(found["steps"]) == 2 and found["executable"]
    assert [(fault["line"], fault["code"]) for fault in found["skipped"]] == [(5, "NOT_UNDERSTOOD")]
    assert "warning[NOT_UNDERSTOOD]" in skipped.stderr and "1 line" in skipped.stderr
    assert "1 program, 2 steps: 1 fault" in call("check", file, status=1).output
    file.write_text(TEXT.replace("[SwitchOn]", "[Fly] <television> (1)\n[SwitchOn]"))
    assert len(json.loads(call("run", file, "--skip-faults", "--json", status=1).stdout)["steps"]) == 2
    for strict in ((), ("--strict",)):
        assert "UNKNOWN_ACTION" in call("run", file, *strict, status=1).output
    assert "leave one of the two out" in call("run", file, "--strict", "--skip-faults", status=2).output


def test_a_repeated_plan_is_no_fault(tmp_path):
    file = tmp_path / "list.json"
    file.write_text(json.dumps(["Task: Nap\nStep 1: Walk to bed\nStep 2: Sleep"] * 3))
    assert "1 program, 2 steps: no faults" in call("check", file).output
    assert "2 warnings" in call("check", file, "--lint").output


def test_all_plans_of_the_papers_are_checked_and_run(real_data):
    file = real_data / "language_planner_examples.json"
    found = json.loads(call("check", file, "--no-affordances", "--json").stdout)
    assert (found["faults"], found["files"][0]["programs"], found["files"][0]["steps"]) == (0, 574, 5_969)
    ran = call("run", file, "--program", 2, "--sample", "--json")
    assert json.loads(ran.stdout)["executable"]


def test_a_program_of_several_is_chosen(tmp_path):
    file = tmp_path / "two.txt"
    file.write_text(f"{TEXT}\nNap\n\n[Walk] <bed> (1)\n")
    first, second = call("run", file), call("run", file, "--program", 2)
    assert first.stdout.startswith("Watch TV, in") and "further programs" in first.stderr
    assert second.stdout.startswith("Nap, in") and not second.stderr
    assert "it holds 2 programs" in call("run", file, "--program", 3, status=1).output


def test_repair_and_pictures_read_plans(tmp_path):
    pytest.importorskip("cv2")
    file = tmp_path / "plan.md"
    file.write_text(PLAN)
    assert json.loads(call("repair", file, "--json").stdout)["pairs"][0]["original"][0].startswith("[Walk]")
    out = tmp_path / "out"
    made = call("render-program", file, "--out", out, "--width", 32, "--modalities", "rgb", "--json")
    assert json.loads(made.stdout)["program"] == "Watch TV" and (out / "sheet.png").exists()
    call("render-program", file, "--out", out, "--strict", status=1)


def test_an_input_without_programs_says_so(tmp_path):
    file = tmp_path / "a.json"
    file.write_text(json.dumps({"title": "Nap", "description": "Lie down."}))
    assert "no program in it" in call("run", file, status=1).output


def test_standard_input_may_be_of_any_form():
    assert "1 program, 2 steps" in call("check", "-", input=json.dumps(RECORD)).output
    assert "--> standard input:5:4" in call("check", "-", input=PLAN, status=1).output
