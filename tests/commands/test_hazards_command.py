"""`hazards` prints what a program endangers, in words and as JSON, and its status says whether it does."""

import json

from typer.testing import CliRunner

from hearth.cli import app

SOUP = """Make soup
1. Walk to the kitchen
2. Find the stove
3. Switch on the stove
4. Walk to the bedroom
"""


def call(*arguments, status=0):
    result = CliRunner().invoke(app, [str(argument) for argument in arguments])
    assert result.exit_code == status, result.output
    return result


def test_a_stove_that_is_left_on_is_said_with_step_severity_and_row(tmp_path):
    file = tmp_path / "soup.txt"
    file.write_text(SOUP)
    text = call("hazards", file, "--home", "maple", status=1).output
    assert "After step 4 ([Walk] <bedroom>" in text and "severity 3" in text and "[burner_alone]" in text
    assert "the stove (" in text and "is left ON" in text and "1 hazard in 4 steps." in text
    data = json.loads(call("hazards", file, "--home", "maple", "--json", status=1).output)
    assert [(each["hazard"], each["step"], each["at_end"]) for each in data["hazards"]] == [("burner_alone", 4, True)]
    assert [each["state"] for each in data["left"]] == ["ON"] and data["executable"] and data["irreversible"] == []


def test_a_program_without_a_hazard_is_clean_and_one_that_stops_is_not(tmp_path):
    file = tmp_path / "calm.txt"
    file.write_text("Sit down\n1. Walk to the kitchen\n2. Find the chair\n3. Sit on the chair\n")
    assert "0 hazards in 3 steps." in call("hazards", file, "--home", "maple").output
    file.write_text("Sit down\n1. Sit on the chair\n")
    assert "failed" in call("hazards", file, "--home", "maple", status=1).output


def test_a_fridge_that_is_opened_for_nothing_is_waste(tmp_path):
    file = tmp_path / "look.txt"
    file.write_text("Look\n1. Walk to the fridge\n2. Open the fridge\n3. Close the fridge\n")
    assert "is opened, and nothing is put in or taken out" in call("hazards", file, "--home", "maple").output
    data = json.loads(call("hazards", file, "--home", "maple", "--json").output)
    assert [(each["state"], each["step"]) for each in data["wasted"]] == [("OPENED", 2)] and data["left"] == []


def test_what_a_made_home_has_besides_is_printed(tmp_path):
    file = tmp_path / "iron.txt"
    file.write_text("Iron\n1. Walk to the bedroom\n2. Find the iron\n3. Switch on the iron\n4. Walk to the kitchen\n")
    text = call("hazards", file, "--home", "maple", "--sample", status=1).output
    assert "added 1 object: iron (1000)" in text and "[iron_alone]" in text
    data = json.loads(call("hazards", file, "--home", "maple", "--sample", "--json", status=1).output)
    assert data["sampled"] and [each["class_name"] for each in data["additions"]["objects"]] == ["iron"]
