"""The report: what it says is what the dataset says, nothing of it is taken for markup, and a browser opens it."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from pathlib import Path
from urllib.parse import quote

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

import hearth
from hearth.datasets.report.floor_plan_svg import draw
from hearth.datasets.report.report_tables import figures
from hearth.datasets.report.report_writer import write_report
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.graph import Box, Node
from hearth.schemas.tables import TABLES

MILK = "release:batch-1/file1_1"
NASTY = "<script>alert(1)</script><b>"
FILMED = [
    {"tick": tick, "steps": [], "start": start, "end": end, "cameras": [], "visible": None}
    for tick, (start, end) in enumerate([(0.0, 1.0), (1.0, 7.8457), (7.8457, 11.8192)])
]
"""A film's steps: tick 0 is what is before the first of them."""
DRAWN = ("--use-angle=swiftshader", "--enable-unsafe-swiftshader")
"""Chromium draws 3D without a graphics card."""


@pytest.fixture(scope="module")
def ds(made):
    return hearth.load(made.out)


@pytest.fixture(scope="module")
def written(ds, tmp_path_factory):
    folder = tmp_path_factory.mktemp("report") / "out"
    assert write_report(ds, folder) == len(ds)
    return folder


def data(path):
    text = path.read_text()
    return json.loads(text[text.index("(") + 1 : text.rindex(")")])


@pytest.fixture(scope="module")
def stories(written):
    return {each["id"]: each for path in written.glob("data/stories-*.js") for each in data(path)}


@pytest.fixture(scope="module")
def runs(made):
    """The runs of a program that are shown: those that fail too, but in its own environments only."""
    every = hearth.load(made.out, failures=True)
    return lambda name: [run for run in every[name].runs if not run.row["execution_id"].endswith("/original")]


def test_every_program_has_a_row_and_a_story(ds, written, stories, runs):
    rows = data(written / "data/programs.js")
    assert [row[0] for row in rows] == list(ds)
    assert set(stories) == set(ds)
    for row in rows:
        entry = ds[row[0]]
        assert row[1:2] + row[4:7] == [entry.title, len(entry.program.steps), len(runs(row[0])), len(entry.repairs)]


def test_a_story_tells_steps_conditions_and_changes(ds, stories):
    page = stories[MILK]
    assert page["steps"][0] == "[Walk] <kitchen> (1)"
    (run,) = page["runs"]
    assert run["failure"] is None
    assert any(text.startswith("inside(milk 1, fridge 1)") for text in run["conditions"])
    assert len(run["ticks"]) == len(ds[MILK].runs[0].row["ticks"])
    assert any("is OPEN" in change for tick in run["ticks"] for change in tick["changes"])


def test_graphs_before_and_after_are_the_datasets(stories, runs):
    for program_id, page in stories.items():
        for run, mine in zip(runs(program_id), page["runs"], strict=True):
            for graph, drawn in ((run.start, mine["start"]), (run.final, mine["final"])):
                edges = {tuple(edge) for edge in graph.edges}
                assert {tuple(edge) for edge in drawn["edges"]} <= edges
                states = {node.id: sorted(node.states) for node in graph.nodes}
                named = set(run.bindings().values())
                assert {i: found for i, _, found in drawn["nodes"] if i in named} == {i: states[i] for i in named}
                place = {(edge.source, edge.target) for edge in graph.edges if edge.relation == "ON"}
                seen = {(source, target) for source, relation, target in drawn["edges"] if relation == "ON"}
                assert {pair for pair in place if pair[0] in named} <= seen


def test_a_repair_shows_only_what_it_changes(ds, stories):
    repaired = [(ds[name], page) for name, page in stories.items() if page["repairs"]]
    assert repaired
    for entry, page in repaired:
        for row, shown in zip(entry.repairs, page["repairs"], strict=True):
            assert shown["failure"]["code"] == row["failure"]["code"]
            assert len(row["before"]) - len(shown["removed"]) + len(shown["added"]) == len(row["after"])
            assert shown["removed"] or shown["added"]


def test_numbers_have_their_queries(ds, written):
    page = (written / "index.html").read_text()
    found = figures(ds)
    assert {"Where records went", "Repairs by failure and handler", "Splits"} <= {each.title for each in found}
    for each in found:
        assert each.title in page
        assert max(each.bars) == 100
        assert [tuple(row) for row in ds.rows(each.query)[1]] == list(each.rows)


def test_the_page_has_no_control_characters(ds, written, monkeypatch):
    from hearth.datasets.report import report_writer

    monkeypatch.setitem(ds.manifest, "version", "1\x1b[31m\u202e")
    page = report_writer._page(ds, 1)
    assert "1[31m" in page and "\x1b" not in page and "\u202e" not in page


def test_the_page_needs_no_network(written):
    for path in (written / "index.html", written / "style.css", written / "app.js", written / "page.js"):
        text = path.read_text().replace("http://www.w3.org/2000/svg", "")
        assert not re.search(r"https?://|//cdn|@import|fetch\(", text), path.name
    assert "innerHTML" not in (written / "page.js").read_text() + (written / "app.js").read_text()


def test_a_plan_escapes_names_and_needs_boxes():
    box = Box((1.0, 1.0, 1.0), (2.0, 2.0, 2.0))
    drawn = draw((Node(1, NASTY, "Rooms", (), (), None, box, None),))
    assert "<script>" not in drawn
    assert "&lt;script&gt;" in drawn
    assert draw((Node(1, "kitchen", "Rooms", (), (), None, None, None),)) == ""


def test_a_plan_names_furniture_over_what_stands_on_it_and_no_name_is_on_another():
    def piece(number, name, center, size):
        return Node(number, name, "Furniture", (), (), None, Box(center, size), None)

    room = Node(1, "kitchen", "Rooms", (), (), None, Box((0.0, 1.2, 0.0), (6.0, 2.4, 6.0)), None)
    table, tray = (
        piece(2, "table", (0.0, 0.4, 0.0), (2.0, 0.8, 1.0)),
        piece(3, "tray", (0.0, 0.9, 0.0), (0.6, 0.1, 0.6)),
    )
    bed, box = piece(4, "bed", (2.0, 0.3, -2.0), (1.0, 0.6, 2.0)), piece(5, "box", (-2.0, 0.1, -2.0), (0.3, 0.2, 0.3))
    names = re.findall(r'class="named"[^>]*>([^<]*)<', draw((room, table, tray, bed, box)))
    assert names == ["table", "bed"]
    assert "tray" in re.findall(r'class="named"[^>]*>([^<]*)<', draw((room, tray, bed)))
    carpet = piece(6, "carpet", (0.0, 0.01, 0.0), (3.0, 0.02, 3.0))
    assert "carpet" not in re.findall(r'class="named"[^>]*>([^<]*)<', draw((room, carpet, table)))
    assert "carpet" in re.findall(r'class="named"[^>]*>([^<]*)<', draw((room, carpet)))
    assert 'transform="rotate(-90 2.00 2.00)"' in draw((room, bed))


@pytest.fixture(scope="module")
def pictured(made, ds, tmp_path_factory):
    """A report of a dataset with a picture of one program and a film of another, and their ids."""
    folder = shutil.copytree(made.out / "publish", tmp_path_factory.mktemp("pictured") / "dataset")
    programs = [name for name in ds if ds[name].runs][:2]
    runs = [ds[name].runs[0].row["execution_id"] for name in programs]
    for name in ("one.png", "late.png", "above.png", "film.webm"):
        (folder / name).write_bytes(name.encode())
    frame = {field.name: None for field in TABLES["frames"]} | {"modality": "rgb", "execution_id": runs[0]}
    looks = ((0, "auto", "one.png"), (5, "top", "above.png"), (5, "auto", "late.png"))
    rows = [{**frame, "tick": tick, "camera": camera, "file": file} for tick, camera, file in looks]
    pq.write_table(pa.Table.from_pylist(rows, TABLES["frames"]), folder / "frames/part-00000.parquet")
    film = {field.name: None for field in TABLES["videos"]}
    film |= {"execution_id": runs[1], "file": "film.webm", "steps": FILMED}
    (folder / "videos").mkdir(exist_ok=True)
    pq.write_table(pa.Table.from_pylist([film], TABLES["videos"]), folder / "videos/part-00000.parquet")
    write_report(hearth.load(folder), folder.parent / "report")
    return folder.parent / "report", programs


def test_rows_name_a_late_picture_that_is_not_from_above(pictured):
    report, (one, other) = pictured
    rows = {row[0]: row[8:] for row in data(report / "data/programs.js")}
    assert rows.pop(other) == ["", 2]
    picture, kind = rows.pop(one)
    assert kind == 1
    assert (report / picture).read_bytes() == b"late.png"
    assert set(map(tuple, rows.values())) == {("", 0)}


@pytest.mark.skipif(shutil.which("node") is None, reason="node is not installed")
def test_a_films_player_shows_the_step_that_the_film_shows(pictured):
    report, (_, other) = pictured
    shown = [each for path in report.glob("data/stories-*.js") for each in data(path) if each["id"] == other]
    (film,) = (run["film"] for run in shown[0]["runs"] if run["film"])
    moments = [0, 0.5, 1, 0.9999999, 4.4, 7.8457, 9, 30]
    asked = f"[{moments}.map((at) => HEARTH.filming.tickAt({json.dumps(film)}, at)),"
    asked += f" [0, 1, 2].map((tick) => HEARTH.filming.startOf({json.dumps(film)}, tick))]"
    page = f"globalThis.HEARTH = {{}};\n{(report / 'page.js').read_text()}\nconsole.log(JSON.stringify({asked}));"
    said = subprocess.run(["node", "-"], input=page, capture_output=True, text=True, check=True, timeout=60).stdout
    assert json.loads(said) == [[0, 0, 1, 1, 1, 2, 2, 2], [0, 1, 7.8457]]


@pytest.mark.slow
@pytest.mark.parametrize("width", [1280, 390])
def test_a_browser_lists_only_programs_with_pictures(pictured, browser, width):
    report, programs = pictured
    page = browser.new_page(viewport={"width": width, "height": 800})
    page.goto((report / "index.html").as_uri())
    page.wait_for_selector(".row")
    assert page.locator("#strip .look").count() == 1
    page.check("#pictured")
    page.wait_for_function("document.querySelectorAll('.row').length === 2")
    shown = {row.get_attribute("href") for row in page.locator(".row").all()}
    assert shown == {f"#/program/{quote(name, safe='')}" for name in programs}
    assert page.evaluate("document.documentElement.scrollWidth") == width


def test_it_does_not_write_over_something_else(ds, tmp_path):
    (tmp_path / "mine.txt").write_text("precious")
    with pytest.raises(HearthError, match="something else"):
        write_report(ds, tmp_path)


@pytest.mark.parametrize("name", ["index.html", "data/programs.js", "../../stolen.png", "link.png", "{}/secret.png"])
def test_a_picture_replaces_no_page_and_comes_from_nowhere_else(made, tmp_path, name):
    folder = shutil.copytree(made.out / "publish", tmp_path / "dataset")
    for path in (tmp_path / "secret.png", folder / "index.html", tmp_path / "stolen.png", folder / "good.png"):
        path.write_bytes(b"theirs")
    (folder / "data").mkdir()
    (folder / "data/programs.js").write_bytes(b"theirs")
    (folder / "link.png").symlink_to(tmp_path / "secret.png")
    frame = {field.name: None for field in TABLES["frames"]} | {"modality": "rgb", "execution_id": "e", "tick": 0}
    rows = [{**frame, "camera": "top", "file": file} for file in (name.format(tmp_path), "good.png")]
    pq.write_table(pa.Table.from_pylist(rows, TABLES["frames"]), folder / "frames/part-00000.parquet")
    write_report(hearth.load(folder), tmp_path / "report")
    copied = [path.relative_to(tmp_path / "report") for path in (tmp_path / "report").rglob("*") if path.is_file()
              and path.read_bytes() == b"theirs"]  # fmt: skip
    assert copied == [Path("pictures/0.png")]


@pytest.fixture
def browser():
    playwright = pytest.importorskip(
        "playwright.sync_api", reason="playwright is not installed: pip install playwright"
    )
    path = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if path is None:
        pytest.skip("no Chromium here: apt-get install chromium")
    with playwright.sync_playwright() as running:
        started = running.chromium.launch(executable_path=path, args=["--no-sandbox", *DRAWN])
        yield started
        started.close()


@pytest.mark.slow
@pytest.mark.parametrize(("scheme", "width"), [("light", 1280), ("dark", 390)])
def test_a_browser_searches_opens_and_plays(written, browser, scheme, width):
    page = browser.new_context(viewport={"width": width, "height": 800}, color_scheme=scheme).new_page()
    faults = []
    page.on("console", lambda said: faults.append(said.text) if said.type in ("error", "warning") else None)
    page.on("pageerror", lambda error: faults.append(str(error)))
    page.on("request", lambda asked: faults.append(asked.url) if not asked.url.startswith(("file:", "data:")) else None)
    page.goto((written / "index.html").as_uri())
    page.wait_for_selector(".row")
    page.fill("#search", "fetch milk file1_1")
    assert page.text_content("#found").startswith("4 of ")
    page.click(".row")
    page.wait_for_selector("ol.steps li")
    assert page.text_content("ol.steps li:first-child") == "[Walk] <kitchen> (1)"
    page.click("button.play")
    page.wait_for_selector("ol.steps li.now")
    page.click("nav a:nth-child(2)")
    page.wait_for_selector("#numbers .figure")
    page.click("nav a:nth-child(1)")
    page.fill("#search", "")
    page.click("button[data-column=steps]")
    lengths = [int(text) for text in page.locator(".row .number:nth-child(5)").all_text_contents()]
    assert lengths == sorted(lengths, reverse=True)
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    dark = page.evaluate("matchMedia('(prefers-color-scheme: dark)').matches")
    assert dark == (scheme == "dark")
    assert faults == []


@pytest.fixture(scope="module")
def replayed(ds, tmp_path_factory):
    """A report in which three runs play in 3D."""
    folder = tmp_path_factory.mktemp("replayed") / "out"
    write_report(ds, folder, replays=3)
    return folder


def _inside(path):
    text = path.read_text()
    return json.loads(f"[{text[text.index('(') + 1 : text.rindex(')')]}]")


@pytest.mark.slow
def test_runs_play_in_3d(ds, replayed):
    places = data(replayed / "data/played.js")
    assert 0 < len(places) <= 3
    rows = {run.row["execution_id"]: run.row for name in ds for run in ds[name].runs}
    for name, (home, own) in places.items():
        kind, number, value = _inside(replayed / f"data/replay-{own}.js")
        assert (kind, number) == ("replay", own)
        assert len(value["ticks"]) == len(rows[name]["ticks"]) + 1
        kind, number, value = _inside(replayed / f"data/home-{home}.js")
        assert (kind, number) == ("home", home)
        assert len(value["things"]) > 10


@pytest.mark.slow
def test_a_browser_plays_a_run_in_3d(ds, replayed, browser):
    page = browser.new_page()
    faults = []
    page.on("pageerror", lambda error: faults.append(str(error)))
    ran = next(iter(data(replayed / "data/played.js")))
    (name,) = (each for each in ds if any(run.row["execution_id"] == ran for run in ds[each].runs))
    page.goto(f"{(replayed / 'index.html').as_uri()}#/program/{quote(name, safe='')}")
    page.select_option("select", label=ran.rpartition("@")[2].partition("/")[0])
    page.click("button.deep")
    page.wait_for_selector("canvas.replay[data-ready]", timeout=60_000)
    page.click("text=›")
    assert page.locator("canvas.replay").get_attribute("data-tick") == "1"
    assert len(set(page.locator("canvas.replay").screenshot())) > 100
    assert faults == []


@pytest.mark.slow
def test_thirty_thousand_rows_and_markup_in_titles(written, browser, tmp_path):
    folder = shutil.copytree(written, tmp_path / "many")
    rows = [[f"p{number}", NASTY, "crowd", "train", number % 30, 7, 0, "", "", 0] for number in range(30_000)]
    (folder / "data/programs.js").write_text(f"HEARTH.programs({json.dumps(rows)});")
    page = browser.new_page()
    alerts = []
    page.on("dialog", lambda dialog: alerts.append(dialog.message))
    page.goto((folder / "index.html").as_uri())
    page.wait_for_selector(".row")
    assert page.locator(".row").count() < 100
    assert page.text_content(".row .keep") == NASTY
    page.evaluate("document.getElementById('scroll').scrollTop = 1e9")
    page.wait_for_function("[...document.querySelectorAll('.row')].at(-1).href.endsWith('p9999')")
    assert alerts == []
