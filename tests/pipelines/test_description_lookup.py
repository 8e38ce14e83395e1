"""Programs whose description nobody knows, and descriptions that are none, are refused by name."""

import csv
import io

from hearth.pipelines.readers.crowd import DESCRIPTIONS, PROGRAMS

STEPS = "[Walk] <bed> (1)\n[Lie] <bed> (1)\n[Sleep]"


def table(columns, *rows):
    out = io.StringIO()
    writer = csv.writer(out)
    writer.writerow(columns)
    writer.writerows(rows)
    return out.getvalue()


def described(name, text="Go to bed and sleep."):
    return (name, "W1", "Approved", "bedroom", f"Sleep {name}", text)


def written(name, description):
    return (name, "W2", "Approved", description, "Sleep", "Go to bed.", "bedroom*1", "bed*1", STEPS)


def test_a_program_needs_a_description_of_the_first_stage(write, built):
    first = table(DESCRIPTIONS, described("D1"))
    second = table(PROGRAMS, written("P1", "D1"), written("P2", "D9"), written("P3", ""))
    build = built(write("mix/b.csv", second), write("mix/a.csv", first))
    build.run("ingest")
    assert build.codes("ingest") == [("crowd:P2", "UNKNOWN_ID"), ("crowd:P3", "UNKNOWN_ID")]


def test_programs_alone_are_taken_as_they_are(write, built):
    build = built(write("b.csv", table(PROGRAMS, written("P1", "D1"), written("P2", "D9"))))
    build.run("ingest")
    assert build.codes("ingest") == []


def test_a_text_that_is_not_an_activity(write, built):
    rows = (described("D1"), described("D2", "Nice task, thank you. Hope to do more of your tasks."))
    build = built(write("a.csv", table(DESCRIPTIONS, *rows)))
    build.run("ingest")
    assert build.codes("ingest") == [("crowd:D2", "OFF_TOPIC")]


def test_a_replaced_special_block_is_reported(write, built):
    build = built(write("a.txt", "Go\nThe toilet.\n\n[Walk] <toilet> (1)\n[Special] <flush the toilet>\n"))
    build.run("ingest", "validate")
    ((warning,),) = [row["warnings"] for row in build.rows("validate")]
    assert (warning["code"], warning["line"], warning["found"]) == ("SPECIAL_BLOCK", 5, "flush the toilet")
