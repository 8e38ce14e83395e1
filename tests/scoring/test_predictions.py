import json

import pyarrow as pa
import pytest
from pyarrow import parquet

from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code
from hearth.schemas.program import ObjectRef, Step
from hearth.scoring.line_sequences import read
from hearth.scoring.prediction_rows import has_predictions, rows_of, source_of
from hearth.scoring.predictions import Pair, read_pairs
from hearth.scoring.refused_rows import SHOWN, FirstFaults

WALK = read(["[Walk] <sofa> (1)"])


def row(name, predicted="[Walk] <sofa> (1)", **more):
    return {"id": name, "predicted": predicted, "reference": ["[Walk] <sofa> (1)"], **more}


@pytest.fixture
def write(tmp_path):
    def lines(*rows, name="p.jsonl"):
        path = tmp_path / name
        texts = (each if isinstance(each, str) else json.dumps(each) for each in rows)
        path.write_text("".join(f"{text}\n" for text in texts))
        return path

    return lines


def faults(path, *args):
    with pytest.raises(HearthError) as caught:
        read_pairs(path, *args)
    return [(fault.code, fault.line, fault.message, fault.suggestion) for fault in caught.value.diagnostics]


def test_texts_lists_and_missing_predictions(write):
    pairs = read_pairs(write(row("a", activity="sit"), "", row(7, ["[Walk] <sofa> (1)"]), row("c", None), row("d", [])))
    assert pairs == [
        Pair("a", WALK, WALK, 1),
        Pair("7", WALK, WALK, 3),
        Pair("c", None, WALK, 4),
        Pair("d", (), WALK, 5),
    ]
    assert pairs[0].more == {"activity": "sit"}


def test_parquet_whatever_its_name(tmp_path):
    path = tmp_path / "predictions"
    step = {"action": "Walk", "agent": 0, "objects": [{"name": "sofa", "instance": 1}]}
    columns = {"id": [1, 2], "predicted": [[step], None], "reference": ["[Walk] <sofa> (1)"] * 2}
    parquet.write_table(pa.table(columns), path)
    assert read_pairs(path) == [Pair("1", WALK, WALK, 1), Pair("2", None, WALK, 2)]


def test_references_apart(write):
    references = write({"id": "b", "reference": "[Walk] <sofa> (1)"}, {"id": "a", "reference": ""}, name="r.jsonl")
    pairs = read_pairs(write({"id": "a", "predicted": "[Walk] <sofa> (1)"}), references)
    assert pairs == [Pair("b", None, WALK), Pair("a", WALK, (), 1)]


def test_references_given_as_programs(write):
    assert read_pairs(write({"id": "a", "predicted": ""}), {"a": "[Walk] <sofa> (1)"}) == [Pair("a", (), WALK, 1)]


def test_every_fault_is_reported_with_its_line(write):
    path = write(
        row("a"),
        '{"id": "b", "predicted"',
        "[1, 2]",
        {"id": "c", "predicted": "x"},
        row("a"),
        row(True),
        row("d", 3),
        row("e", ["[Walk] <sofa> (1)", {"objects": []}]),
    )
    assert faults(path) == [
        (Code.BAD_JSON, 2, "unexpected end of data", "one JSON object a line"),
        (Code.BAD_TABLE, 3, "a list, not an object", "one JSON object a line"),
        (Code.BAD_TABLE, 4, "no `reference`", "every row needs id, predicted, reference"),
        (Code.DUPLICATE, 5, "a second row of id `a`; the first is line 1", "keep one row an id"),
        (Code.BAD_TABLE, 6, "`id` is True", "a text or a whole number"),
        (Code.BAD_TABLE, 7, "`predicted` of id `d` is int, not a program", "a text, or a list of steps"),
        (Code.BAD_TABLE, 8, "`predicted` of id `e` is list, not a program", "a text, or a list of steps"),
    ]


def test_an_unknown_id_is_named_with_the_nearest(write):
    path = write({"id": "watch_tv2", "predicted": ""}, {"id": "zzz", "predicted": ""})
    assert faults(path, {"watch_tv": "", "read": ""}) == [
        (Code.UNKNOWN_ID, 1, "no reference has the id `watch_tv2`", "did you mean `watch_tv`?"),
        (Code.UNKNOWN_ID, 2, "no reference has the id `zzz`", "ids are those of the references, as `watch_tv`"),
    ]


def test_equal_faults_are_one_with_a_count(write):
    found = faults(write(*({"id": n} for n in range(63))))
    message = "no `predicted`, `reference` (and 62 more rows: lines 2, 3, 4, 5, 6, ...)"
    assert [fault[:3] for fault in found] == [(Code.BAD_TABLE, 1, message)]


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        (
            [row("a"), row("a"), row("b"), row("b")],
            "a second row of id `a`; the first is line 1 (and 1 more row: line 4)",
        ),
        ([row("a", 3), row("b"), row("c", 4)], "`predicted` of id `a` is int, not a program (and 1 more row: line 3)"),
        ([[1], [2], [3]], "a list, not an object (and 2 more rows: lines 2, 3)"),
    ],
)
def test_faults_that_differ_in_their_row_alone_are_equal(write, rows, message):
    assert [fault[2] for fault in faults(write(*rows))] == [message]


def test_a_bad_row_is_left_out_and_the_rest_is_read(write):
    rejects = FirstFaults()
    path = write(row("a"), "{", row("b", 3), row("a"), {"id": "c"}, row("d"))
    assert [pair.id for pair in read_pairs(path, rejects=rejects)] == ["a", "d"]
    assert (rejects.rows, sorted(fault.line for fault in rejects)) == (4, [2, 3, 4, 5])
    assert 2 + rejects.rows == 6  # rows in = rows out + rejects


def test_a_bad_row_of_a_known_id_is_a_missing_prediction(write):
    rejects, known = FirstFaults(), {"a": "[Walk] <sofa> (1)", "b": "[Walk] <sofa> (1)"}
    path = write({"id": "a", "predicted": 3}, {"id": "b", "predicted": "[Walk] <sofa> (1)"})
    assert read_pairs(path, known, rejects=rejects) == [Pair("a", None, WALK), Pair("b", WALK, WALK, 2)]
    assert rejects.rows == 1
    with pytest.raises(HearthError, match="is int"):
        read_pairs(write({"id": "a", "predicted": 3}), known, rejects=FirstFaults())


def test_rows_without_a_reference_or_an_id(write):
    path = write({"predicted": "[Walk] <sofa> (1)"}, row("b"), {"id": "c", "predicted": None, "reference": None})
    assert read_pairs(path, alone=True) == [
        Pair("1", WALK, (), 1, referenced=False),
        Pair("b", WALK, WALK, 2),
        Pair("c", None, (), 3, referenced=False),
    ]


@pytest.mark.parametrize(
    ("text", "rows"),
    [
        ('{"id": 1, "predicted": ""}', True),
        ('\n{\n{"id": 1, "reference": ""}', True),
        ("PAR1", True),
        ("1. Walk to sofa\n2. Sit", False),
        ('{"title": "TV", "steps": ["Walk to sofa"]}', False),
        ("", False),
    ],
)
def test_files_with_predictions_are_distinguished_from_programs(tmp_path, text, rows):
    (tmp_path / "f").write_text(text)
    assert has_predictions(tmp_path / "f") is rows


@pytest.mark.parametrize(
    ("data", "code"),
    [
        (b"", Code.EMPTY),
        (b"\n \n", Code.EMPTY),
        (b"\x89PNG\r\n\x1a\n\x00", Code.NOT_TEXT),
        (b"{\x00}", Code.NOT_TEXT),
        (b"PAR1 and no more", Code.BAD_TABLE),
        (b"[Walk] <sofa> (1)", Code.BAD_JSON),
    ],
)
def test_what_is_no_predictions_file(tmp_path, data, code):
    path = tmp_path / "p.jsonl"
    path.write_bytes(data)
    assert [fault[0] for fault in faults(path)] == [code]


def test_no_file_and_a_folder(tmp_path):
    assert [fault[0] for fault in faults(tmp_path / "none.jsonl")] == [Code.MISSING_FILE]
    assert [fault[0] for fault in faults(tmp_path)] == [Code.UNSUPPORTED_FILE]


def test_a_parquet_file_without_a_column(tmp_path):
    path = tmp_path / "p.parquet"
    parquet.write_table(pa.table({"id": ["a"], "prediction": ["x"]}), path)
    ((code, line, message, suggestion),) = faults(path)
    assert (code, line, message) == (Code.BAD_TABLE, 0, "no column `predicted`, `reference`")
    assert suggestion == "its columns are id, prediction"


def test_windows_and_utf16_files(tmp_path):
    for encoding in ("utf-16", "utf-8-sig"):
        path = tmp_path / encoding
        path.write_bytes((json.dumps(row("ä", None), ensure_ascii=False) + "\r\n").encode(encoding))
        assert read_pairs(path) == [Pair("ä", None, WALK, 1)]


def test_a_huge_line_is_one_line_that_does_not_parse(write):
    ((_, predicted, *_),) = [(p.id, p.predicted) for p in read_pairs(write(row("a", "[Walk] " + "x" * 10_000_000)))]
    assert len(predicted) == 1
    assert isinstance(predicted[0], str)


def test_a_step_of_a_table_may_be_another_agents():
    step = {"action": "Walk", "agent": 1, "objects": [{"name": "sofa", "instance": 2, "node": 7}], "joins": True}
    assert source_of([step]) == [Step("Walk", (ObjectRef("sofa", 2, 7),), 1, True)]
    assert source_of([{"action": "Walk", "objects": None}]) == [Step("Walk", ())]
    assert source_of([{"objects": []}]) is None


def test_a_table_may_name_its_rows_otherwise(tmp_path):
    path = tmp_path / "p.parquet"
    parquet.write_table(pa.table({"program": ["p1"], "predicted": ["x"]}), path)
    found = rows_of(path, ("id", "predicted"), FirstFaults(), lambda row: [f"{row['program']}@{n}" for n in (1, 2)])
    assert sorted(each.id for each in found) == ["p1@1", "p1@2"]
    with pytest.raises(HearthError, match="no column `id`"):
        list(rows_of(path, ("id", "predicted"), FirstFaults()))


def test_of_many_faults_the_first_of_each_kind_are_kept_and_the_others_counted():
    found = FirstFaults()
    assert not found
    words = ("".join(chr(97 + int(digit)) for digit in str(n)) for n in range(1_000))
    found.extend(Diagnostic(Code.BAD_TABLE, word, "f", n) for n, word in enumerate(words))
    found.append(Diagnostic(Code.DUPLICATE, "again", "f", 7))
    assert found.rows == 1_001 and len(found._groups) == SHOWN + 1
    assert [fault.message for fault in found][-3:] == ["bj", "again", f"and {1_000 - SHOWN} more of this kind"]


@pytest.mark.parametrize("step", [{"action": ["x"], "objects": []}, {"action": "Walk", "objects": [{"name": 3}]}])
def test_steps_whose_names_are_no_texts(write, step):
    ((code, line, _, _),) = faults(write({"id": "a", "predicted": [step], "reference": "[Walk] <sofa> (1)"}))
    assert (code, line) == ("BAD_TABLE", 1)


def test_what_more_there_is_of_a_kind_names_the_file_of_that_kind():
    from hearth.schemas.diagnostics import Diagnostic
    from hearth.schemas.failures import Code

    found = FirstFaults()
    found.append(Diagnostic(Code.BAD_JSON, "x", "one.jsonl"))
    found.extend(Diagnostic(Code.UNKNOWN_ID, "y" * n, "other.jsonl") for n in range(SHOWN + 5))
    assert [each.file for each in found][-1] == "other.jsonl"


def test_a_row_without_a_prediction_for_several_runs(write):
    path = write({"program": "a"}, {"program": "b", "predicted": "[Walk] <sofa> (1)"})
    found = FirstFaults()
    kept = list(rows_of(path, ("id", "predicted"), found, lambda row: [f"{row['program']}@{n}" for n in (1, 2)]))
    assert [row.id for row in kept] == ["b@2", "b@1"] or [row.id for row in kept] == ["b@1", "b@2"]
    assert [each.line for each in found] == [1]


@pytest.mark.parametrize("node", [[1], "x", 1.5])
def test_nodes_that_are_no_numbers(write, node):
    step = {"action": "Walk", "objects": [{"name": "sofa", "instance": 1, "node": node}]}
    ((code, line, _, _),) = faults(write({"id": "a", "predicted": [step], "reference": "[Walk] <sofa> (1)"}))
    assert (code, line) == ("BAD_TABLE", 1)


def test_rows_under_two_versions_of_an_id_are_two_rows_of_it(write):
    old, new = "crowd:3D0001ABCDE@maple", "written:3D0001ABCDE@maple"
    path = write({"id": old, "predicted": ""}, {"id": new, "predicted": "[Walk] <sofa> (1)"})
    assert faults(path, {new: "[Walk] <sofa> (1)"}) == [
        (Code.DUPLICATE, 2, f"a second row of id `{new}`; the first is line 1", "keep one row an id")
    ]


@pytest.mark.parametrize("column", ["id", "graph", "x"])
def test_a_table_with_a_date_that_no_calendar_has(tmp_path, column):
    columns = {"id": ["a"], "predicted": ["[Sleep]"], "reference": ["[Sleep]"]}
    columns[column] = pa.array([2**40], pa.timestamp("s"))
    parquet.write_table(pa.table(columns), tmp_path / "p.parquet")
    ((code, *_),) = faults(tmp_path / "p.parquet")
    assert code == Code.BAD_TABLE


def test_a_small_table_of_millions_of_rows(tmp_path):
    columns = dict.fromkeys(("id", "predicted", "reference"), pa.nulls(3_000_000, pa.string()))
    parquet.write_table(pa.table(columns), tmp_path / "p.parquet")
    ((code, *_),) = faults(tmp_path / "p.parquet")
    assert code == Code.FILE_TOO_LARGE
