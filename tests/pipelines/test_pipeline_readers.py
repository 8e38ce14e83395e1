"""Readers: what is found in each form, and what a fault costs."""

from __future__ import annotations

import json
import shutil
import zipfile

import pytest

from hearth.datasets.format.ids import current_id
from hearth.pipelines.build import FIRST, corpus
from hearth.pipelines.engine.sources import labelled
from hearth.pipelines.ingest import READERS, items
from hearth.pipelines.readers import crowd
from hearth.pipelines.readers.item import worker_hash
from hearth.pipelines.readers.recognise import recognise
from hearth.schemas.diagnostics import HearthError
from hearth.storage.rejects import Reject

HEADER = "HITId,WorkerId,AssignmentStatus,Input.scene,Answer.title,Answer.description"
PROGRAM = "Watch TV\nFrom the sofa.\n\n[Walk] <television> (1)\n[SwitchOn] <television> (1)\n"
ROOT = "programs_processed_precond_nograb_morepreconds"


def read(*paths):
    """Everything that sources give: rows, and rejects, in order."""
    found = []
    for _, item in items(labelled(map(str, paths))):
        outputs = READERS[item.reader](item, "salt")
        outputs = [outputs] if isinstance(outputs, dict | Reject) else list(outputs)
        found.extend((item.record_id, output) for output in outputs)
    return found


def rows(found):
    return [output for _, output in found if isinstance(output, dict)]


def faults(found):
    return [
        (output.code, output.diagnostics[0].file, output.diagnostics[0].line)
        for _, output in found
        if isinstance(output, Reject)
    ]


# Program text


def test_a_file_may_hold_several_programs(write):
    text = f"{PROGRAM}\n\nSleep\nIn the bed.\n\n[Walk] <bed> (1)\n\n[Lie] <bed> (1)\n"
    first, second = rows(read(write("tv.txt", text)))
    assert (first["program_id"], first["title"], first["description"], first["line"]) == (
        "text:tv.txt",
        "Watch TV",
        "From the sofa.",
        0,
    )
    assert (second["program_id"], second["title"], second["line"]) == ("text:tv.txt#2", "Sleep", 7)
    assert second["text"].count("[") == 2


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", "cp1252"])
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_encodings_and_line_ends_that_editors_write(write, encoding, end):
    program = PROGRAM.replace("sofa", "café’s sofa")
    (row,) = rows(read(write("tv.txt", program.replace("\n", end).encode(encoding))))
    assert row["text"].rstrip("\n") == program.rstrip("\n")


@pytest.mark.parametrize(
    ("name", "data", "code", "line"),
    [
        ("empty", b"", "EMPTY", 0),
        ("blank", b"\n  \n\n", "EMPTY", 0),
        ("nul", b"Watch TV\n\n[Walk] <tv>\x00 (1)\n", "NOT_TEXT", 3),
        ("latin-2", b"Wst\xf3\xb3\xbf\n\n[Walk] <kitchen> (1)\n", "NOT_TEXT", 1),
        ("two encodings", b"Caf\xc3\xa9\n\n[Walk] <caf\xe9> (1)\n", "NOT_TEXT", 3),
        ("long", b"Watch TV\n\n[Walk] <" + b"x" * 10_000_000 + b"> (1)\n", "LINE_TOO_LONG", 3),
    ],
)
def test_a_bad_file_is_a_reject_and_its_neighbours_stay(write, name, data, code, line):
    folder = write("p/b.txt", data).parent
    write("p/a.txt", PROGRAM)
    write("p/c.txt", PROGRAM)
    found = read(folder)
    assert [row["program_id"] for row in rows(found)] == ["text:p/a.txt", "text:p/c.txt"]
    assert faults(found) == [(code, "p/b.txt", line)]


def test_a_bad_program_costs_no_other_program_of_its_file(write):
    text = PROGRAM.encode() + b"\nBroken\x00\n\n[Walk] <bed> (1)\n\n" + PROGRAM.encode()
    found = read(write("tv.txt", text))
    assert [row["program_id"] for row in rows(found)] == ["text:tv.txt", "text:tv.txt#3"]
    assert faults(found) == [("NOT_TEXT", "tv.txt", 7)]


def test_a_line_beyond_all_bounds_is_reported(write):
    ((_, reject),) = read(write("a.txt", "Walk\n\n[Walk] <" + "x" * 3_000_000 + "> (1)\n"))
    assert "more than 10,000 characters" in reject.diagnostics[0].message


# Crowd-sourcing batches


def batch(*lines, header=HEADER):
    return "\n".join([header, *lines]) + "\n"


def answer(number, title="Sleep", description="Go to bed.", worker="W1", status="Approved"):
    return f"D{number},{worker},{status},bedroom,{title},{description}"


def test_descriptions(write):
    first, second = rows(read(write("d.csv", batch(answer(1), answer(2, '"Sleep, well"', '"Lie ""down"".\nSleep."')))))
    assert first["program_id"] == first["description_id"] == "crowd:D1"
    assert (first["kind"], first["scene"], first["title"]) == ("description", "bedroom", "Sleep")
    assert (second["title"], second["description"]) == ("Sleep, well", 'Lie "down".\nSleep.')


def test_worker_ids_are_hashed_with_a_salt(write):
    (row, other) = rows(read(write("d.csv", batch(answer(1, worker="A3JJEUH4TV6UC"), answer(2, worker="B")))))
    assert "A3JJEUH4TV6UC" not in str(row)
    assert row["worker"] != other["worker"]
    ((_, item),) = items(labelled([str(write("e.csv", batch(answer(1))))]))
    assert crowd.read(item, "one")["worker"] != crowd.read(item, "two")["worker"]


@pytest.mark.parametrize("delimiter", [",", ";", "\t"])
@pytest.mark.parametrize("mark", ["", "\ufeff"])
def test_marks_and_separators(write, delimiter, mark):
    text = mark + batch(answer(1), answer(2, worker="W2")).replace(",", delimiter)
    assert [row["title"] for row in rows(read(write("d.csv", text)))] == ["Sleep", "Sleep"]


@pytest.mark.parametrize("column", ["WorkerId", "Answer.description", "AssignmentStatus"])
def test_a_missing_column_is_named(write, column):
    header = HEADER.replace(column, "Other")
    ((_, reject),) = read(write("d.csv", batch(answer(1), header=header)))
    assert reject.code == "BAD_TABLE"
    assert f"lacks the column `{column}`" in reject.diagnostics[0].message


def test_answers_that_are_not_used(write):
    lines = [
        answer(1, status="Rejected"),
        answer(2, description=""),
        answer(3),
        answer(4),
        answer(3, title="Other"),
        answer(5, worker="W2"),
    ]
    found = read(write("d.csv", batch(*lines)))
    assert [row["program_id"] for row in rows(found)] == ["crowd:D3", "crowd:D5"]
    assert faults(found) == [
        ("REJECTED_ANSWER", "d.csv", 2),
        ("EMPTY", "d.csv", 3),
        ("DUPLICATE", "d.csv", 5),  # the same answer of the same worker
        ("DUPLICATE", "d.csv", 6),  # the same id
    ]


@pytest.mark.parametrize(
    "bad",
    ['D9,W1,Approved,bedroom,"Sleep,Go to bed.', "D9,W1,Approved,bedroom", "D9,W1,Approved,bedroom,a,b,c,d"],
)
def test_a_broken_row_costs_no_other_row(write, bad):
    several = answer(3, description='"Lie down.\nSleep.\nWake up."')
    found = read(write("d.csv", batch(answer(1), bad, several, answer(4, worker="W2"))))
    assert [row["program_id"] for row in rows(found)] == ["crowd:D1", "crowd:D3", "crowd:D4"]
    assert faults(found) == [("BAD_TABLE", "d.csv", 3)]


def test_a_row_that_is_not_text_costs_no_other_row(write):
    data = batch(answer(1), answer(2, "Caf\xe9\xff"), answer(3, worker="W2")).encode("latin-1")
    found = read(write("d.csv", data))
    assert [row["program_id"] for row in rows(found)] == ["crowd:D1", "crowd:D3"]
    assert faults(found) == [("NOT_TEXT", "d.csv", 3)]


def test_programs_of_the_second_stage(write):
    header = ",".join([*crowd.PROGRAMS, "Platform"])
    line = 'P1,W1,Approved,D1,Watch TV,Watch it.,living room*1,"Remote Control*2, television","[Walk] <tv> (1)\n",AMT'
    (row,) = rows(read(write("p.csv", batch(line, header=header))))
    assert (row["kind"], row["program_id"], row["description_id"]) == ("program", "crowd:P1", "crowd:D1")
    assert row["rooms"] == [{"name": "living_room", "quantity": 1}]
    assert row["props"] == [{"name": "remote_control", "quantity": 2}, {"name": "television", "quantity": 1}]
    assert (row["platform"], row["line"], row["place"]) == ("AMT", 1, "p.csv")
    assert (row["origin"], row["style"], len(row["worker"])) == ("crowd", None, 16)


WRITTEN = f"Origin,Writer,Style,{HEADER.replace('WorkerId,', '')}"


def test_what_says_that_it_is_written_has_no_worker(write):
    text = batch(f"written,w1,terse,{answer(1, worker='x').replace(',x', '')}", header=WRITTEN)
    programs = ",".join(["Origin", *crowd.PROGRAMS, "Platform"])
    line = 'written,P1,W1,Approved,D1,Sleep,Go to bed.,bedroom*1,bed*1,"[Lie] <bed> (1)",AMT'
    described, program = rows(read(write("d.csv", text), write("p.csv", batch(line, header=programs))))
    for row in (described, program):
        assert (row["origin"], row["description_id"]) == ("written", "written:D1")
        assert (row["worker"], row["platform"]) == (None, None)
    assert (described["style"], program["program_id"], program["style"]) == ("terse", "written:P1", None)


def test_an_answer_of_an_unknown_origin_is_refused_alone(write):
    lines = [f"{origin},w1,,{answer(n).replace(',W1', '')}" for n, origin in enumerate(("", "writen", "crowd"), 1)]
    found = read(write("d.csv", batch(*lines, header=WRITTEN)))
    assert [row["program_id"] for row in rows(found)] == ["crowd:D1", "crowd:D3"]
    assert faults(found) == [("BAD_TABLE", "d.csv", 3)]
    assert "an origin that no answer has: `writen`" in found[1][1].diagnostics[0].message


def test_the_embedded_corpus_says_that_it_is_written():
    found = rows(read(*corpus()))
    assert len(found) > 800
    assert {(row["worker"], row["platform"]) for row in found} == {(None, None)}
    assert {(row["kind"], row["origin"]) for row in found} == {
        ("program", "written"), ("description", "written"), ("sketch", "sketches")
    }  # fmt: skip
    first = rows(read(*corpus(FIRST)))
    assert all(current_id(row["program_id"].replace("written:", "crowd:")) == row["program_id"] for row in first)


def test_records_of_the_embedded_corpus_as_version_0_1_had_them(write):
    old = {"program_id": "crowd:3P0001A2SM5", "description_id": "crowd:3D0001FLP5E", "origin": "crowd", "worker": "x",
           "platform": "AMT", "title": "Sleep", "steps": ["[Lie] <bed> (1)"]}  # fmt: skip
    theirs = {**old, "program_id": "crowd:P1", "description_id": "crowd:3D0001FLP5EXX"}
    ours, others = rows(read(write("a.jsonl", f"{json.dumps(old)}\n{json.dumps(theirs)}\n")))
    assert (ours["program_id"], ours["description_id"]) == ("written:3P0001A2SM5", "written:3D0001FLP5E")
    assert (ours["origin"], ours["worker"], ours["platform"]) == ("written", None, None)
    assert (others["program_id"], others["description_id"]) == ("crowd:P1", "crowd:3D0001FLP5EXX")
    assert (others["origin"], others["worker"], others["platform"]) == ("crowd", worker_hash("x", "salt"), "AMT")


def test_parts_in_splits_of_a_source(write):
    sleep = {"title": "Sleep", "steps": ["[Lie] <bed> (1)"]}
    given = [
        {"pairs": "test", "tasks": None},
        {"activities": "test"},
        {"pairs": "../x"},
        {"a b": "test"},
        {f"s{n}": "test" for n in range(21)},
        ["pairs"],
        {},
    ]
    text = "".join(json.dumps({**sleep, "program_id": f"p{n}", "splits": each}) + "\n" for n, each in enumerate(given))
    found = read(write("a.jsonl", text))
    parts = {row["program_id"]: row["parts"] for row in rows(found)}
    wanted = [{"split": "pairs", "part": "test"}, {"split": "tasks", "part": None}]
    assert parts == {"p0": wanted, **dict.fromkeys(f"p{n}" for n in range(1, 7))}
    assert [line for _, _, line in faults(found)] == [2, 3, 4, 5]


# The release


def zipped(folder, path):
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for file in sorted(folder.rglob("*")):
            if file.is_file():
                archive.write(file, file.relative_to(folder).as_posix())
    return path


def test_zip_and_folder_give_the_same(release, tmp_path):
    one = rows(read(zipped(release, tmp_path / "release.zip")))
    two = rows(read(release))
    for row in (*one, *two):
        row.pop("place")
    assert one == two
    assert [row["program_id"] for row in one] == [
        "release:batch-1/file1_1",
        "release:batch-1/file1_2",
        "release:batch-2/file7_1",
    ]


def test_what_belongs_to_a_program_of_the_release(release):
    row = rows(read(release))[0]
    (grounding,) = row["groundings"]
    assert (row["title"], row["description_id"]) == ("Fetch milk", "release:batch-1/file1")
    assert grounding["home"] == "cottage"
    assert row["text"].endswith("[PutBack] <milk> (1) <table> (1)\n")
    assert (24, "ON", 20) in grounding["final"]["added"]
    assert (24, "INSIDE", 23) in grounding["final"]["removed"]
    objects = [{"name": "milk", "instance": 1}, {"name": "fridge", "instance": 1}]
    assert {"name": "inside", "objects": objects, "step": None, "hard": None} in row["conditions"]
    assert len(grounding["start"]["sources"]) > 30


@pytest.mark.parametrize("gone", ["withoutconds", "init_and_final_graphs", "executable_programs", "initstate"])
def test_any_folder_may_be_missing(release, gone):
    shutil.rmtree(release / ROOT / gone)
    found = read(release)
    assert len(rows(found)) == 3
    starts = [grounding["start"] is not None for row in rows(found) for grounding in row["groundings"]]
    expected = {"init_and_final_graphs": [False] * 3, "executable_programs": []}
    assert starts == expected.get(gone, [True] * 3)
    # Graphs are of no use without a program that says which of their nodes it means.
    assert len(faults(found)) == (3 if gone == "executable_programs" else 0)


def test_graphs_without_any_program_are_rejected(release):
    shutil.rmtree(release / ROOT / "withoutconds")
    shutil.rmtree(release / ROOT / "executable_programs")
    found = read(release)
    assert [code for code, _, _ in faults(found)] == ["MISSING_FILE"] * 3


def test_both_spellings_of_the_graphs_folder(release):
    expected = rows(read(release))
    (release / ROOT / "init_and_final_graphs").rename(release / ROOT / "init_and_final_graph")
    assert [row["groundings"] for row in rows(read(release))] == [row["groundings"] for row in expected]


def test_the_text_is_taken_from_the_grounded_program_where_there_is_no_other(release):
    expected = [row["text"].lower().replace(" ", "") for row in rows(read(release))]
    shutil.rmtree(release / ROOT / "withoutconds")
    assert [row["text"].lower().replace(" ", "") for row in rows(read(release))] == expected


@pytest.mark.parametrize(
    ("content", "code"),
    [
        (b"{", "BAD_JSON"),
        (b"[]", "BAD_GRAPH"),
        (b'{"init_graph": {"nodes": [{"id": 1}], "edges": []}}', "BAD_GRAPH"),
        (b'{"init_graph": {"nodes": [], "edges": [{"from_id": "a", "relation_type": "ON", "to_id": 2}]}}', "BAD_GRAPH"),
    ],
)
def test_a_bad_graph_costs_its_own_grounding(release, content, code):
    path = release / ROOT / "init_and_final_graphs/cottage_graph/batch-1/file1_2.json"
    path.write_bytes(content)
    found = read(release)
    assert [len(row["groundings"]) for row in rows(found)] == [1, 0, 1]
    assert faults(found)[0][:2] == (code, f"release/{path.relative_to(release).as_posix()}")


def test_a_damaged_member_costs_its_own_program(release, tmp_path):
    path = zipped(release, tmp_path / "release.zip")
    with zipfile.ZipFile(path) as archive:
        info = archive.getinfo(f"{ROOT}/withoutconds/batch-1/file1_2.txt")
    data = bytearray(path.read_bytes())
    start = info.header_offset + 30 + len(info.filename)
    data[start : start + 12] = b"\xff" * 12
    path.write_bytes(data)
    found = read(path)
    assert [row["program_id"][-7:] for row in rows(found)] == ["file1_1", "file7_1"]
    assert [code for code, _, _ in faults(found)] == ["BAD_ARCHIVE"]


def test_a_truncated_archive_is_an_error(release, tmp_path):
    path = zipped(release, tmp_path / "release.zip")
    path.write_bytes(path.read_bytes()[:-200])
    with pytest.raises(HearthError, match=r"BAD_ARCHIVE.*truncated"):
        read(path)


def test_a_truncated_archive_among_others_is_a_reject(release, tmp_path, write):
    path = write("mix/release.zip", b"")
    zipped(release, path)
    path.write_bytes(path.read_bytes()[:-200])
    write("mix/tv.txt", PROGRAM)
    found = read(path.parent)
    assert len(rows(found)) == 1
    assert faults(found)[0][0] == "BAD_ARCHIVE"


def test_a_member_that_claims_too_much_is_not_unpacked(release, tmp_path, monkeypatch):
    from hearth.pipelines.readers import release as reader

    monkeypatch.setattr(reader, "LARGEST_FILE", 1_000)
    found = read(zipped(release, tmp_path / "release.zip"))
    assert {code for code, _, _ in faults(found)} == {"FILE_TOO_LARGE"}


# Recognising


def test_an_archive_without_the_releases_folders(tmp_path):
    path = tmp_path / "other.zip"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("photos/cat.jpg", b"")
    with pytest.raises(HearthError, match=r"without any of the release's folders.*photos/cat\.jpg"):
        read(path)


def test_a_folder_of_pictures(write):
    write("pictures/a.png", b"\x89PNG\r\n\x1a\n")
    folder = write("pictures/b.jpg", b"\xff\xd8\xff\xe0").parent
    with pytest.raises(HearthError, match="nothing to read among 2 files; the first is a PNG picture"):
        read(folder)


def test_a_picture_among_programs_is_a_reject(write):
    write("mix/a.png", b"\x89PNG\r\n\x1a\n")
    folder = write("mix/b.txt", PROGRAM).parent
    found = read(folder)
    assert len(rows(found)) == 1
    assert faults(found) == [("UNSUPPORTED_FILE", "mix/a.png", 0)]


def test_names_do_not_matter(write, release, tmp_path):
    path = zipped(release, write("release.txt", b""))
    assert next(recognise(path, "x")).reader == "release"
    assert next(recognise(write("batch.txt", batch(answer(1))), "x")).reader == "crowd"
    assert next(recognise(write("program.csv.old", PROGRAM), "x")).reader == "text"


def test_sources_that_share_a_name_are_distinguished(write):
    found = read(write("one/tv.txt", PROGRAM), write("two/tv.txt", PROGRAM))
    assert [row["program_id"] for row in rows(found)] == ["text:tv.txt", "text:tv.txt~2"]


def test_missing_sources_are_all_named(tmp_path):
    with pytest.raises(HearthError, match=r"one.*\n.*two"):
        read(tmp_path / "one", tmp_path / "two")


def test_a_link_that_leaves_the_folder_is_not_followed(write, tmp_path):
    secret = tmp_path / "secret.txt"
    secret.write_text(PROGRAM)
    folder = write("p/a.txt", PROGRAM).parent
    (folder / "b.txt").symlink_to(secret)
    assert [row["program_id"] for row in rows(read(folder))] == ["text:p/a.txt"]


def test_a_title_without_steps_is_a_record_of_its_own(write):
    first, second = rows(read(write("two.txt", f"Ironing\nIron a shirt.\n\n\n{PROGRAM}")))
    assert (first["title"], second["title"], second["line"]) == ("Ironing", "Watch TV", 4)
    assert "[" not in first["text"] and second["text"].count("[") == 2


def test_a_limit_counts_programs(write, built):
    write("a.csv", batch(*(answer(number, worker=f"W{number}") for number in range(5))))
    folder = write("z.txt", "\n".join([PROGRAM] * 4)).parent
    limited = built(folder, limit=3)
    limited.run("ingest")
    assert [row["kind"] for row in limited.rows("ingest")] == ["description"] * 3 + ["program"] * 3
