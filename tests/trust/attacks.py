"""Attacks by strangers' data, and by those who ask: none may write, read or run anything outside, fail badly or hang.

`python tests/trust/attacks.py` prints a table of them and ends with 1 if one works; `--only GROUP` runs some. Each runs
in a folder of its own, beside a guard folder that must stay as it is. A new attack is a row of the functions below.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import shutil
import sys
import tempfile
import time
import zipfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

sys.path[:] = [entry for entry in sys.path if Path(entry or ".").resolve() != Path(__file__).resolve().parents[2]]

from attack import Attack, Ground  # noqa: E402
from attacks_on_beliefs import belief_results  # noqa: E402
from attacks_on_challenges import clients, results, task_files  # noqa: E402
from attacks_on_corpora import corpora  # noqa: E402
from attacks_on_datasets import datasets  # noqa: E402
from attacks_on_episodes import episodes  # noqa: E402
from attacks_on_films import films  # noqa: E402
from attacks_on_knowledge import knowledge  # noqa: E402
from attacks_on_models import checkpoints, kinds  # noqa: E402
from attacks_on_queries import queries  # noqa: E402
from attacks_on_stores import stores  # noqa: E402
from attacks_on_studies import studies  # noqa: E402
from attacks_on_tables import tables  # noqa: E402
from attacks_on_trainings import trainings  # noqa: E402
from attacks_on_ways import ways  # noqa: E402
from attacks_on_web import web  # noqa: E402
from hostile_datasets import rename, replace_texts  # noqa: E402

from hearth.datasets.dataset import Dataset  # noqa: E402
from hearth.schemas.diagnostics import HearthError  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
INPUT = ROOT / "tests/golden/pipelines/input"
SECRET = "the-secret-of-the-guard"
SLOWEST = 20.0
"""Seconds of the processor that an attack may take."""
WAITED = 6
"""The largest ratio of time by the clock to the allowed processor time: other processes are busy, too."""


NAMES = ("../../../../guard/x", "{guard}/x", "..", ".", "..\\..\\guard\\x", "a/../../../../guard/x", "x\0y", "n" * 400)


def exports() -> Iterator[Attack]:
    """Homes, programs and origins with hostile names, in every form of export."""
    from hearth.datasets.export.formats import FORMATS, export

    def write(form: str, name: str, ground: Ground) -> None:
        copy = shutil.copytree(ground.dataset, ground.folder / "dataset")
        name = name.replace("{guard}", str(ground.guard))
        rename(copy, "cabin", name)
        rename(copy, "crowd:P1", f"{name}:{name}")
        export(Dataset.open(copy), form, ground.folder / "a/out")

    for number, name in enumerate(NAMES):
        for form in list(FORMATS)[number % 2 :: 2]:
            yield Attack("export", f"{form}: {name[:40]!a}", lambda ground, f=form, n=name: write(f, n, ground))


def names() -> Iterator[Attack]:
    """Names as archives and stores list them."""
    from hearth.storage.names import file_name, inside
    from hearth.storage.url_fetching import fetched

    def unzip(name: str, ground: Ground) -> Any:
        path = ground.folder / "dataset.zip"
        with zipfile.ZipFile(path, "w") as archive:
            archive.writestr("ds/manifest.json", "{}")
            archive.writestr(f"ds/{name}".replace("{guard}", str(ground.guard)), "x")
        return fetched(f"zip://ds::{path}")

    for name in (*NAMES[:6], "/{guard}/x", "a//../../../guard/x", "./../x", "c:/x", "\\\\host\\x", "..", "tables/.."):
        yield Attack("url", f"zip member {name[:40]!a}", lambda ground, n=name: unzip(n, ground))
    for name in (*NAMES, "", "/", "c:x", "a/..", "\udcff"):
        yield Attack("path", f"inside {name[:40]!a}", lambda ground, n=name: _must_stay(inside, ground, n))
        yield Attack("path", f"file_name {name[:40]!a}", lambda ground, n=name: _must_stay(
            lambda folder, text: folder / file_name(text), ground, n))  # fmt: skip


def _must_stay(make: Callable[[Path, str], Path], ground: Ground, name: str) -> None:
    path = make(ground.folder, name.replace("{guard}", str(ground.guard)))
    path.write_text("x")
    assert path.resolve().is_relative_to(ground.folder.resolve()), path


def inputs() -> Iterator[Attack]:
    """Files that never end or lie elsewhere, where a file is named, and where data names one."""
    from hearth.homes.library import read_graph
    from hearth.kb.loading.load import default
    from hearth.scoring.environments import by_row
    from hearth.scoring.predictions import Pair, read_pairs
    from hearth.storage.input_files import load_yaml, read_input

    def final_graph(path: Path) -> Any:
        return read_graph(path, "final_graph")

    def read(reader: Callable[[Path], Any], name: str, ground: Ground) -> Any:
        return reader(_prepared(ground) / name)

    for reader in (read_input, final_graph, read_pairs, load_yaml):
        for name in ("/dev/zero", "pipe", "zero", ".", "loop", "x\0y"):
            title = f"{reader.__name__} {name!a}"
            yield Attack("file", title, lambda ground, r=reader, n=name: read(r, n, ground))
    places = (
        "/dev/zero",
        "pipe",
        "zero",
        "../guard/secret.csv",
        "/etc/passwd",
        "out/secret.csv",
        "loop",
        ".",
        "..",
        "x\0",
    )
    for name in places:
        yield Attack("reference", f"graph: {name!a}", lambda ground, n=name: by_row(
            _prepared(ground) / "predictions.jsonl", default())(Pair("p", (), (), 1, {"graph": n})))  # fmt: skip


def _prepared(ground: Ground) -> Path:
    os.mkfifo(ground.folder / "pipe")
    for name, target in (("zero", "/dev/zero"), ("out", ground.guard), ("loop", "loop")):
        (ground.folder / name).symlink_to(target)
    return ground.folder


YAML = {
    "aliases": "a0: &a0 [x, x]\n" + "".join(f"a{n}: &a{n} [*a{n - 1}, *a{n - 1}]\n" for n in range(1, 60)),
    "keys": "a0: &a0 {x: 1}\n" + "".join(f"a{n}: &a{n} {{k: *a{n - 1}, l: *a{n - 1}}}\n" for n in range(1, 60)),
    "itself": "rooms: &a [*a]\n",
    "deep": "a: " + "[" * 5_000 + "]" * 5_000,
    "open": "[" * 100_000,
    "many": "[" + "x, " * 200_000 + "]",
    "long": "#" * 5_000_000,
    "python": "!!python/object/apply:os.system ['touch {guard}/x']",
}


def yaml_files() -> Iterator[Attack]:
    """YAML that stands for more than it takes to write, or would call something."""
    from hearth.homes.library import layout_of
    from hearth.kb.loading.load import default
    from hearth.repair.perturbation_strengths import load_strengths
    from hearth.storage.input_files import load_yaml

    def read(reader: Callable[[Path], Any], text: str, ground: Ground) -> None:
        path = ground.folder / "home.yaml"
        path.write_text(text.replace("{guard}", str(ground.guard)))
        reader(path)

    readers = {"home": lambda path: layout_of(path, default()), "strengths": load_strengths, "yaml": load_yaml}
    for kind, reader in readers.items():
        for name, text in YAML.items():
            yield Attack("yaml", f"{kind}: {name}", lambda ground, r=reader, t=text: read(r, t, ground))


PLAN = "home: hut\nheight: {height}\nrooms:\n{rooms}"
ROOM = "- {{name: {name}, class: kitchen, at: [{at}, 0], size: [{size}, 3], furniture: [{things}]}}\n"


def plans() -> Iterator[Attack]:
    """Plans of homes of absurd size."""
    from hearth.homes.library import layout_of
    from hearth.kb.loading.load import default

    def room(name: str = "kitchen", at: str = "0", size: str = "4", things: str = "") -> str:
        return ROOM.format(name=name, at=at, size=size, things=things)

    texts = {
        "wide": room(size="900"), "far": room() + room("other", at="990"), "infinite": room(size=".inf"),
        "not a number": room(size=".nan"), "rooms": "".join(room(f"r{n}", str(n % 90)) for n in range(5_000)),
        "things": room(things=", ".join(["{bench: {wall: west}}"] * 5_000)),
        "unknown things": room(things=", ".join(f"{{bench{n}: {{wall: west}}}}" for n in range(5_000))),
        "on one another": room(things="{bench: {wall: west, on: [" + ", ".join(["plate*60"] * 900) + "]}}"),
        "counted": room(things="cup*99999999999999999999"), "digits": room(size="9" * 5_000),
    }  # fmt: skip
    for name, rooms in texts.items():

        def read(ground: Ground, rooms: str = rooms) -> None:
            path = ground.folder / "home.yaml"
            path.write_text(PLAN.format(height=2.5, rooms=rooms))
            layout_of(path, default())

        yield Attack("plan", name, read)


def archives() -> Iterator[Attack]:
    """Archives as sources of a build."""
    from hearth.pipelines.engine.source_labels import labelled
    from hearth.pipelines.ingest import items, read

    good = "Sleep\nGo to bed.\n\n\n[Walk] <bed> (1)\n[Lie] <bed> (1)\n"

    def write(path: Path, kind: str, ground: Ground) -> None:
        with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
            archive.writestr("good.txt", good)
            if kind == "link":
                link = zipfile.ZipInfo("link.txt")
                link.create_system, link.external_attr = 3, 0o120777 << 16
                archive.writestr(link, str(ground.guard / "secret.csv"))
            elif kind == "bomb":
                archive.writestr("bomb.txt", b"\0" * 300_000_000)
            elif kind == "members":
                for n in range(5_000):
                    archive.writestr(f"{n}/x.txt", "")
            elif kind == "nested":
                archive.write(_zipped(ground.folder / "inner.zip", 8), "inner.zip")
            elif kind == "twice":
                archive.writestr("good.txt", good)
            else:
                archive.writestr(kind.replace("{guard}", str(ground.guard)), good)
        if kind == "good.txt\\broken":
            path.write_bytes(path.read_bytes()[:-30])

    def ingest(kind: str, ground: Ground) -> Any:
        path = ground.folder / "source.zip"
        write(path, kind, ground)
        return [row for _, item in items(labelled([str(path)])) for row in read(item, salt="s")]

    kinds = ("link", "bomb", "members", "nested", "twice", "good.txt\\broken", "a\x1b[2J.txt", "CON.txt")
    for kind in (*NAMES[:6], *kinds):
        yield Attack("archive", f"{kind[:50]!a}", lambda ground, k=kind: ingest(k, ground))


def _zipped(path: Path, depth: int) -> Path:
    """A zip in a zip in a zip."""
    inner = path.with_name(f"{depth}.zip")
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("x.txt", "x" * 1_000)
        if depth:
            archive.write(_zipped(inner, depth - 1), inner.name)
    return path


MARKUP = ("<script>alert(1)</script>", '"><img src=x onerror=alert(1)>', "</title><svg onload=alert(1)>")
ESCAPES = ("\x1b]0;a\x07", "\x1b[2J\x1b[1;1H", "\x9b2J", "\x1bP+q\x1b\\", "a\rb\x08", "\u202ea\u2066", "\x00")


def _renamed(ground: Ground, text: str) -> Path:
    """A copy of the dataset in which titles, descriptions, homes and places are this text."""
    copy: Path = shutil.copytree(ground.dataset, ground.folder / "dataset")
    dataset = Dataset.open(copy)
    query = "SELECT title FROM programs UNION SELECT description FROM programs UNION SELECT place FROM programs"
    olds = {old for (old,) in dataset.rows(query)[1] if old} | {"cabin"}
    replace_texts(copy, dict.fromkeys(olds, text))
    return copy


def reports() -> Iterator[Attack]:
    """Markup in every text that a page shows."""
    from markupsafe import escape

    from hearth.datasets.report.report_writer import write_report

    def write(text: str, ground: Ground) -> None:
        out = ground.folder / "page"
        write_report(Dataset.open(_renamed(ground, text)), out)
        pages = "".join(page.read_text("utf-8") for page in out.rglob("*.html"))
        assert text not in pages and str(escape(text)) in pages

    for text in MARKUP:
        yield Attack("report", text, lambda ground, t=text: write(t, ground))


def terminals() -> Iterator[Attack]:
    """Control characters in data that commands print."""
    from typer.testing import CliRunner

    from hearth.cli import app

    def printed(words: list[str], text: str, ground: Ground) -> None:
        source = ground.folder / "a.txt"
        source.write_text(f"T{text}\nD{text}\n\n\n[Walk] <b{text}ed> (1)\n[Fly{text}] <bed> (1)\n", "utf-8")
        folder = _renamed(ground, text) if "{dataset}" in words else ground.dataset
        filled = [word.format(dataset=folder, file=source) for word in words]
        shown = CliRunner().invoke(app, filled).output
        bad = {c for c in shown if c != "\n" and (ord(c) < 32 or 127 <= ord(c) < 160 or c in "\u202e\u2066")}
        assert shown and not bad, f"it prints {bad!a}"
        assert "error in Hearth" not in shown, shown[-200:]

    commands = (
        ["query", "{dataset}", "SELECT title, description, place FROM programs"], ["check", "{file}"],
        ["run", "{file}", "--home", "maple"], ["diff", "{dataset}", "{dataset}"], ["sketch", "{file}"],
    )  # fmt: skip
    for words in commands:
        for text in ESCAPES:
            yield Attack("terminal", f"{words[0]} {text!a}", lambda ground, w=words, t=text: printed(w, t, ground))


GROUPS = (
    queries, exports, names, inputs, yaml_files, plans, archives, reports, terminals, checkpoints, kinds, trainings,
    task_files, results, belief_results, clients, episodes, films, studies, stores, ways, web, corpora, datasets,
    knowledge, tables,
)  # fmt: skip


def state(folder: Path) -> dict[str, bytes]:
    """Every file of a folder."""
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def outcome(attack: Attack, dataset: Path, before: dict[str, bytes]) -> str:
    """Return the achievement of an attack; "" for nothing."""
    with tempfile.TemporaryDirectory() as made:
        ground = Ground(Path(made) / "own/ground", Path(made) / "guard", dataset)
        ground.folder.mkdir(parents=True)
        ground.guard.mkdir()
        (ground.guard / "secret.csv").write_text(f"a\n{SECRET}\n")
        guard, started, used = state(ground.guard), time.perf_counter(), time.process_time()
        try:
            found = attack.call(ground)
        except HearthError as error:
            found = error.diagnostics
        except Exception as error:
            return f"{type(error).__name__}: {error}"[:100]
        seconds = max(time.process_time() - used, (time.perf_counter() - started) / WAITED)
        if state(ground.guard) != guard or state(dataset) != before:
            return "something was written"
        if SECRET in repr(found):
            return "something was read"
        return f"it took {seconds:.0f} seconds" if seconds > SLOWEST else ""


def prepared_dataset(folder: Path) -> Path:
    """A small dataset of the golden tests' input."""
    from hearth.pipelines.build import build

    sources = [INPUT / "crowd", INPUT / "programs/evening.txt", INPUT / "release"]
    build([str(path) for path in sources], str(folder), homes=("cabin",), homes_folder=str(INPUT / "homes"), pictures=0)
    return folder / "publish"


def main() -> int:
    """Run them all, print the table, and say how many worked."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--only", default="", help="a group")
    options.add_argument("--dataset", type=Path, help="a published dataset to attack a copy of; without, one is built")
    asked = options.parse_args()
    worked = count = 0
    with tempfile.TemporaryDirectory() as made:
        given = asked.dataset
        dataset = Path(shutil.copytree(given, Path(made) / "publish")) if given else prepared_dataset(Path(made))
        before = state(dataset)
        for group in GROUPS:
            for attack in group():
                if asked.only in ("", attack.group):
                    done = outcome(attack, dataset, before)
                    count, worked = count + 1, worked + bool(done)
                    with contextlib.suppress(BrokenPipeError):
                        print(f"{attack.group:10} {attack.name!a:66} {done or 'nothing'}", flush=True)
    print(f"{count} attacks, {worked} worked")
    if not count:
        print(f"no attack is of the group {asked.only!a}; {__file__} without --only prints them all", file=sys.stderr)
        return 2
    return int(worked > 0)


if __name__ == "__main__":
    sys.exit(main())
