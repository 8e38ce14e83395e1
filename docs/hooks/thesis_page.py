"""The page "What the thesis says, what we measure": `docs/thesis.md`, made from `docs/thesis.yaml`.

python docs/hooks/thesis_page.py                          # write the page
python docs/hooks/thesis_page.py "table 3.1" "text 3.4"   # run their commands, store what they print, write the page
python docs/hooks/thesis_page.py "table 5.2" --printed data_out/tables/5.2.json      # store what a night has printed
"""

from __future__ import annotations

import argparse
import json
import os
import shlex
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from datetime import date
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import yaml

ROOT = Path(__file__).resolve().parents[2]
SOURCE = ROOT / "docs/thesis.yaml"
PAGE = ROOT / "docs/thesis.md"

STATES = {
    "measured": "numbers next to ours",
    "made": "a command makes ours",
    "part": "some of it",
    "missing": "not yet",
    "design": "an overview, an architecture or a setting: where ours stands",
}
"""States of a figure of ours, and their meanings."""

NONE = "not yet"

ABOUT = """\
# What the thesis says, what we measure

Every table and figure of the thesis [*VirtualHome*](corpus.md), and its counterpart in Hearth. The command below each
of our numbers prints it; the day and the commit of the measurement stand next to it.
Our corpus, homes and engine differ from the thesis's, so a number that is equal is a sign, and no proof.

`docs/thesis.yaml` has the numbers; `python docs/hooks/thesis_page.py "table 3.1"` measures an item again."""


def load() -> list[dict[str, Any]]:
    """The chapters."""
    return list(yaml.safe_load(SOURCE.read_text("utf-8"))["chapters"])


def items(chapters: Sequence[dict[str, Any]]) -> Iterator[dict[str, Any]]:
    """The items of all chapters."""
    for chapter in chapters:
        yield from chapter["items"]


def page(chapters: Sequence[dict[str, Any]] | None = None) -> str:
    """The page."""
    chapters = chapters or load()
    lines = [ABOUT, "", "| chapter |" + "".join(f" {name} |" for name in STATES), "|---" * (len(STATES) + 1) + "|"]
    for chapter in chapters:
        counts = Counter(item["state"] for item in chapter["items"])
        numbers = "".join(f" {counts[name] or ''} |" for name in STATES)
        lines.append(f"| [{_title(chapter)}](#{_title(chapter).lower().replace(' ', '-').replace(':', '')}) |{numbers}")
    lines += ["", "".join(f"- *{name}*: {about}\n" for name, about in STATES.items()).rstrip()]
    for chapter in chapters:
        lines += ["", f"## {_title(chapter)}"]
        for item in chapter["items"]:
            lines += ["", *_item(item)]
    return "\n".join(lines) + "\n"


def _title(chapter: dict[str, Any]) -> str:
    number = chapter["chapter"]
    return f"{'Chapter' if number.isdigit() else 'Appendix'} {number}: {chapter['title']}"


def _item(item: dict[str, Any]) -> Iterator[str]:
    """The lines of an item: what it shows, its numbers, its commands."""
    yield f"### {item['item'][0].upper()}{item['item'][1:]}"
    yield ""
    yield f"*{item['state']}*. {item['about']}."
    rows = item.get("rows", ())
    if rows:
        when = item.get("measured", {})
        yield from ("", f"| | thesis | {', '.join(('ours', *map(str, when.values())))} |", "|---|---|---|")
        for row in rows:
            yield f"| {row['what']} | {row['thesis']} | {row['ours'] or NONE} |"
    if item.get("commands"):
        yield from ("", "```bash", *item["commands"], "```")
    if item.get("note"):
        yield from ("", item["note"])


def value_at(document: Any, place: str) -> Any:
    """Return the value at a place of a JSON document: names and numbers by `/`.

    `key=value` finds an entry of a list, and `key=value&key=value` one that has both.

    Raises:
        LookupError: there is nothing.
    """
    for part in place.split("/"):
        if isinstance(document, dict):
            document = document[part]
        elif "=" in part:
            wanted = [each.partition("=")[::2] for each in part.split("&")]
            found = [each for each in document if all(_field(each, key) == value for key, value in wanted)]
            if not found:
                raise LookupError(f"{part} of {place}")
            document = found[0]
        else:
            document = document[int(part)]
    return document


def _field(entry: Any, key: str) -> str:
    return str(entry[int(key) if isinstance(entry, list) else key])


def shown(value: Any) -> str:
    """A number as the page has it; a mean with its interval."""
    if isinstance(value, dict):
        return f"{shown(value['mean'])} ({shown(value['low'])}-{shown(value['high'])})"
    if isinstance(value, list):
        return f"{shown(value[0])} ({shown(value[1])}-{shown(value[2])})"
    if isinstance(value, int):
        return f"{value:,}"
    if abs(value) < 1:
        return f"{value:.3f}".replace("0.", ".", 1)
    return f"{value:.2f}" if abs(value) < 10 else f"{value:.1f}" if abs(value) < 100 else f"{value:,.0f}"


def printed(item: dict[str, Any], data: Path) -> Any:
    """The JSON of an item's last command; they run in an empty folder that has `data_out` and `data_raw`."""
    with TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "data_out").symlink_to(data.resolve())
        (folder / "data_raw").symlink_to(ROOT / "data_raw")
        for command in item["commands"]:
            if not command.startswith("hearth "):
                raise SystemExit(f"run `{command}`, and give what it wrote by --printed FILE")
            last = command == item["commands"][-1]
            words = [sys.executable, str(ROOT / "cli.py"), *shlex.split(command)[1:], *(["--json"] if last else [])]
            done = subprocess.run(words, cwd=folder, stdout=subprocess.PIPE, check=True, env=os.environ)
    return json.loads(done.stdout)


def fill(item: dict[str, Any], document: Any) -> None:
    """Write what a command printed into the item's rows; a row's `at` is one place, or a list of them."""
    for row in item["rows"]:
        if places := row.get("at"):
            each = [places] if isinstance(places, str) else places
            row["ours"] = ", ".join(shown(value_at(document, place)) for place in each)
    head = subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=ROOT, capture_output=True, text=True, check=True)
    item["measured"] = {"date": date.today().isoformat(), "commit": head.stdout.strip()}


def store(chapters: Sequence[dict[str, Any]]) -> None:
    """Write the data, under the comments that it begins with."""
    about = [line for line in SOURCE.read_text("utf-8").splitlines() if line.startswith("#")]
    text = yaml.safe_dump(
        {"chapters": list(chapters)}, sort_keys=False, allow_unicode=True, width=1000, default_flow_style=None
    )
    SOURCE.write_text("\n".join([*about, text]), "utf-8")


def main() -> None:
    """Measure the items of those names, if any, and write the page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("items", nargs="*", help="`table 5.2`")
    parser.add_argument("--printed", type=Path, metavar="FILE", help="what the item's last command printed with --json")
    asked = parser.parse_args()
    chapters = load()
    for item in items(chapters):
        if item["item"] in asked.items:
            known = asked.printed and json.loads(asked.printed.read_text("utf-8"))
            fill(item, known or printed(item, Path(os.environ.get("HEARTH_DATA_OUT", ROOT / "data_out"))))
            store(chapters)
            print(item["item"], ", ".join(f"{row['what']}: {row['ours']}" for row in item["rows"]))
    PAGE.write_text(page(chapters), "utf-8")


if __name__ == "__main__":
    main()
