"""`score program` without references, over homes, with bad rows; `score dataset` of a subset."""

from __future__ import annotations

import json

import pytest
from typer.testing import CliRunner

from hearth.cli import app
from hearth.homes.library import names

TV = ["[Walk] <television> (1)", "[SwitchOn] <television> (1)"]
FORMS = {
    "plan.txt": "Task: Watch TV\n1. Walk to the television\n2. Turn on the television\n",
    "program.txt": "Watch TV\n\n\n\n[Walk] <television> (1)\n[SwitchOn] <television> (1)\n",
    "plans.jsonl": json.dumps({"title": "Watch TV", "steps": TV}) + "\n",
    "plans.json": json.dumps([{"title": "Watch TV", "steps": TV}]),
    "plans.csv": "title,program\nWatch TV,1. Walk to the television 2. Turn on the television\n",
    "rows.jsonl": json.dumps({"predicted": TV}) + "\n",
}


@pytest.fixture
def score(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)

    def run(*args):
        return CliRunner().invoke(app, ["score", *args])

    return run


def rows(path, *every):
    path.write_text("".join((each if isinstance(each, str) else json.dumps(each)) + "\n" for each in every))


@pytest.mark.parametrize("form", FORMS)
def test_programs_of_any_form_are_scored(score, tmp_path, form):
    (tmp_path / form).write_text(FORMS[form])
    done = score("program", form, "--home", "maple", "--json")
    assert done.exit_code == 0, done.output
    found = json.loads(done.stdout)
    assert (found["count"], found["unreferenced"]) == (1, 1)
    assert {name: each["mean"] for name, each in found["mean"].items()} == dict.fromkeys(
        ("parsable", "parsable_names", "executable", "executable_filled"), 1
    )


def test_first_failures_by_code_and_lines_that_another_reader_refused(score, tmp_path):
    (tmp_path / "p.txt").write_text(
        "A\n\n\n\n[Fly] <sofa> (1)\n\nB\n\n\n\n[Open] <fridge> (1)\n\nC\n\n\n\n[PutBack] <cup> (1) <cup> (1)\n"
    )
    found = json.loads(score("program", "p.txt", "--home", "maple", "--json").stdout)
    assert found["codes"] == {"NOT_CLOSE": 1, "UNKNOWN_ACTION": 1, "WRONG_ARITY": 1}
    assert [(each["title"], each["code"]) for each in found["scores"]] == [
        ("A", "UNKNOWN_ACTION"), ("B", "NOT_CLOSE"), ("C", "WRONG_ARITY")
    ]  # fmt: skip
    text = score("program", "p.txt", "--home", "maple").stdout
    assert "NOT_CLOSE" in text and "3 predictions without a reference" in text and "lcs" not in text


def test_without_a_home_nothing_is_run_and_the_output_says_so(score, tmp_path):
    (tmp_path / "p.txt").write_text(FORMS["program.txt"])
    done = score("program", "p.txt")
    assert done.exit_code == 0
    assert "executable" not in done.stdout and "--home" in done.stderr


def test_all_homes(score, tmp_path):
    (tmp_path / "p.txt").write_text(FORMS["program.txt"])
    found = json.loads(score("program", "p.txt", "--homes", "all", "--json").stdout)
    assert [each["home"] for each in found["scores"]] == list(names()) and len(names()) == 7
    assert set(found["by"]) == set(names())
    text = score("program", "p.txt", "--homes", "all").stdout
    assert all(name in text for name in names())


def test_a_goal_in_the_row_and_a_mixed_file(score, tmp_path):
    rows(tmp_path / "r.jsonl", {"id": "goal", "predicted": TV, "home": "maple", "goal": "ON(television)"},
         {"id": "held", "predicted": [], "home": "maple", "goal": "CLOSED(fridge)"},
         {"id": "own", "predicted": TV, "home": "maple", "reference": TV})  # fmt: skip
    found = json.loads(score("program", "r.jsonl", "--json").stdout)
    assert (found["count"], found["unreferenced"], found["reached_before"]) == (3, 2, 1)
    assert [each.get("goal") for each in found["scores"]] == [1, None, 1]
    assert [each.get("lcs_step") for each in found["scores"]] == [None, None, 1]
    assert "1 reference; 2 predictions without a reference" in score("program", "r.jsonl").stdout


def test_a_bad_row_never_stops_the_file(score, tmp_path):
    good = {"predicted": TV, "home": "maple"}
    rows(tmp_path / "r.jsonl", {"id": 1, **good}, "{", {"id": 2}, {"id": 3, **good, "home": "mapel"},
         {"id": 4, **good, "goal": "SHINY(cup)"}, {"id": 5, **good, "predicted": 3}, {"id": 1, **good},
         {"id": 6, **good, "home": "mapel"}, {"id": 7, **good})  # fmt: skip
    done = score("program", "r.jsonl", "--json")
    found = json.loads(done.stdout)
    assert done.exit_code == 1
    assert [each["id"] for each in found["scores"]] == ["1", "4", "7"]  # of 4, the goal alone is refused
    assert found["rejected"] + found["count"] == 9
    assert {fault["line"] for fault in found["rejects"]} >= {2, 3, 6, 7}
    assert "(and 1 more row: line 8)" in done.stderr and done.stderr.count("mapel") <= 2
    text = score("program", "r.jsonl").stdout
    assert "6 rows refused" in text and "1 goal that can't be read" in text


@pytest.mark.parametrize("command", ["lcs", "program"])
def test_steps_without_instances_are_steps(score, tmp_path, command):
    rows(tmp_path / "r.jsonl", {"id": "a", "predicted": ["[plugin] <phone>"], "reference": ["[grab] <phone>"]},
         {"id": "b", "predicted": ["[plugin] <phone>"], "reference": ["[grab] <phone> (1)"]},
         {"id": "c", "predicted": ["[walk] <phone> (1)", "[grab] <phone>"],
          "reference": ["[walk] <phone> (1)", "[grab] <phone> (1)"]},
         {"id": "d", "predicted": "[putback] <cup> <table> (2)",
          "reference": "[PutBack] <cup> (1) <table> (2)"})  # fmt: skip
    done = score(command, "r.jsonl", "--json")
    assert done.exit_code == 0, done.output
    start = "lcs_" if command == "program" else ""
    found = [
        [each[f"{start}{of}"] for of in ("step", "action", "object")] for each in json.loads(done.stdout)["scores"]
    ]
    assert found == [[0, 0, 1], [0, 0, 1], [1, 1, 1], [1, 1, 1]]


def test_an_empty_answer_is_neither_executable_nor_parsable(score, tmp_path):
    rows(tmp_path / "r.jsonl", {"id": "a", "predicted": [], "home": "maple", "reference": TV},
         {"id": "b", "predicted": "", "home": "maple", "reference": TV})  # fmt: skip
    found = json.loads(score("program", "r.jsonl", "--json").stdout)
    assert found["empty"] == 2
    for name in ("executable", "parsable", "parsable_names", "goal", "goal_fraction"):
        assert found["mean"][name]["mean"] == 0, name


@pytest.mark.parametrize(
    ("goal", "code"),
    [("ON(unicorn, table)", "UNKNOWN_OBJECT"), ("OPEN(fridge", "SYNTAX"), ({"goals": 1}, "BAD_JSON"), ("", "SYNTAX")],
)
def test_a_goal_that_cannot_be_read_is_a_fault_of_the_goal_alone(score, tmp_path, goal, code):
    whole = {"predicted": TV, "home": "maple"}
    rows(tmp_path / "r.jsonl", {"id": "a", **whole, "goal": goal}, {"id": "b", **whole, "goal": "ON(tv)"})
    result = score("program", "r.jsonl", "--json")
    assert result.exit_code == 1
    found = json.loads(result.stdout)
    first, second = found["scores"]
    assert (first["goal_fault"], second["goal_fault"]) == (code, None)
    assert first["executable"] == second["executable"] == 1 and "goal" not in first
    assert (found["count"], found["unread_goals"], found["rejected"]) == (2, 1, 0)
    assert [each["code"] for each in found["rejects"]] == [code]
    text = score("program", "r.jsonl")
    assert "1 goal that can't be read, left out of `goal`" in text.stdout and "refused" not in text.stdout
    assert "goal of `a`, row 1" in text.stderr


def test_a_failed_program_reaches_no_goal(score, tmp_path):
    put = ["[Walk] <remote_control> (1)", "[Grab] <remote_control> (1)", "[Walk] <bedroom> (1)",
           "[PutBack] <remote_control> (1) <bedroom> (1)"]  # fmt: skip
    rows(tmp_path / "r.jsonl", {"id": "a", "predicted": [*put, *TV], "home": "maple", "reference": TV})
    (found,) = json.loads(score("program", "r.jsonl", "--rules", "replay", "--json").stdout)["scores"]
    assert (found["executable"], found["goal"], found["goal_whole"], found["failed_line"]) == (0, 0, 0, 4)


def test_a_subset_of_a_dataset(score, tmp_path, made):
    import hearth

    ds = hearth.load(made.out)
    ids = [name for (name,) in ds.rows("SELECT execution_id FROM executions WHERE executable ORDER BY 1")[1]]
    rows(tmp_path / "p.jsonl", {"id": ids[0], "predicted": []}, {"id": "nobody", "predicted": []})
    every = score("dataset", str(made.out), "p.jsonl", "--json")
    assert every.exit_code == 1 and "no reference has the id `nobody`" in every.stderr
    assert "have no prediction and count as 0" in every.stderr and "--only-given" in every.stderr
    given = score("dataset", str(made.out), "p.jsonl", "--only-given", "--json")
    found = json.loads(given.stdout)
    assert (found["count"], found["missing"], found["rejected"]) == (1, 0, 1)
    assert "count as 0" not in given.stderr
    query = """SELECT count(*) FROM executions JOIN programs USING (program_id)
        WHERE executable AND parent_id IS NULL"""
    ((originals,),) = ds.rows(query)[1]
    rows(tmp_path / "q.jsonl", {"id": ids[0], "predicted": []})
    found = json.loads(score("dataset", str(made.out), "q.jsonl", "--originals", "--json").stdout)
    assert found["count"] == originals < len(ids)


def test_predictions_for_other_executions_than_those_asked_for(score, tmp_path, made):
    import hearth

    query = """SELECT min(execution_id) FROM executions JOIN programs USING (program_id)
        WHERE executable AND parent_id IS NOT NULL"""
    ((augmented,),) = hearth.load(made.out).rows(query)[1]
    rows(tmp_path / "p.jsonl", {"id": augmented, "predicted": []})
    done = score("dataset", str(made.out), "p.jsonl", "--originals", "--only-given")
    assert done.exit_code == 1 and "no prediction is of an execution that is asked for" in done.output


LOOPS = {
    "a count": ("for i in range(2):", ["fridge", "fridge"]),
    "a list": ('for x in ["fridge", "microwave"]:', ["fridge", "microwave"]),
}


@pytest.mark.parametrize("kind", LOOPS)
def test_steps_of_a_loop_are_scored_as_they_run(score, tmp_path, kind):
    head, names_of = LOOPS[kind]
    thing = "x" if kind == "a list" else '"fridge"'
    code = f"{head}\n    walk({thing})\n    open({thing})\n    close({thing})\n"
    steps = [f"[{act}] <{name}> (1)" for name in names_of for act in ("Walk", "Open", "Close")]
    (tmp_path / "plan.py").write_text(code)
    rows(tmp_path / "rows.jsonl", {"id": "a", "home": "maple", "predicted": code, "reference": "\n".join(steps)})
    alone = json.loads(score("program", "plan.py", "--home", "maple", "--json").stdout)
    assert (alone["codes"], alone["mean"]["executable"]["mean"]) == ({}, 1)
    with_reference = json.loads(score("program", "rows.jsonl", "--json").stdout)["scores"][0]
    assert (with_reference["lcs_step"], with_reference["executable"]) == (1, 1)


def test_a_refused_line_of_a_loop_stands_once_at_its_place(score, tmp_path):
    (tmp_path / "plan.py").write_text('for i in range(2):\n    walk("fridge")\n    fly("fridge")\nopen("fridge")\n')
    found = json.loads(score("program", "plan.py", "--home", "maple", "--json").stdout)
    assert (found["count"], found["codes"]) == (1, {"UNKNOWN_ACTION": 1})


@pytest.mark.parametrize("blank", ['""', "[]", "null", '" "'])
def test_a_blank_plan_of_a_record_is_an_empty_prediction(score, tmp_path, blank):
    """One rule for rows with and without references: it counts in the means as a program that can't be parsed."""
    rows = f'[{{"id": "1", "plan": {blank}}}, {{"id": "2", "plan": ["Walk to the fridge"]}}]'
    (tmp_path / "a.json").write_text(rows)
    found = json.loads(score("program", "a.json", "--json").stdout)
    assert (found["count"], found["empty"], found["mean"]["parsable"]["mean"]) == (2, 1, 0.5)
