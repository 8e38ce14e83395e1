"""The page of the published tables and its diagram, made from their schemas and comments."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]


def tables() -> str:
    """The published tables with their keys, columns and nested fields; the other views; the macros."""
    from hearth.datasets.format.card import columns
    from hearth.schemas.tables import CONSEQUENCE_TABLES, KEYS, comment_of

    lines = ["# Tables", "", *TABLES_ABOUT, "", "![Every table, its key and what it refers to](pictures/tables.svg)"]
    for table, schema in CONSEQUENCE_TABLES.items():
        keys = ", ".join(f"`{name}`" for name in KEYS[table])
        refers = "".join(f" `{own}` refers to `{other}`." for own, other in _references(table).items())
        lines += ["", f"## {table}", "", comment_of(schema), "", f"Key: {keys}.{refers}", "", *columns(schema)]
    views, macros = _commented()
    for view, (about, *names) in views.items():
        lines += ["", f"## {view}", "", f"A view. {about}", "", "| column | meaning |", "|---|---|"]
        lines += [f"| `{name}` | {meaning} |" for name, meaning in names]
    lines += ["", "## Macros", "", "| macro | meaning |", "|---|---|"]
    return "\n".join([*lines, *(f"| `{call}` | {about} |" for call, about in macros)]) + "\n"


TABLES_ABOUT = (
    "Parquet, typed and nested. `catalog.duckdb` has a view of every table, further views, and macros. Open it",
    "by its path, from any folder: `duckdb mine/publish/catalog.duckdb`. All that stands here is in it as comments:",
    "",
    "```sql",
    "SELECT column_name, comment FROM duckdb_columns() WHERE table_name = 'programs';",
    "```",
    "",
    "`python docs/hooks/pages.py` writes this page and its diagram, in which the columns of keys are underlined.",
)


def _references(table: str) -> dict[str, str]:
    """Column -> the table and column that it refers to."""
    from hearth.schemas.tables import REFERENCES

    return {own: f"{other}.{key}" for name, own, other, key in REFERENCES if name == table}


def _commented() -> tuple[dict[str, list[Any]], list[tuple[str, str]]]:
    """The views that are no tables, each with its meaning and (column, meaning); the macros as (call, meaning)."""
    from hearth.datasets.format.catalog import statements

    text = (ROOT / "datasets/format/comments.sql").read_text("utf-8")
    views: dict[str, list[Any]] = {}
    macros = []
    for kind, name, about in re.findall(r"^COMMENT ON (VIEW|COLUMN|MACRO(?: TABLE)?) (\S+) IS '(.*)';$", text, re.M):
        view, _, column = name.partition(".")
        meaning = about.replace("''", "'").replace("|", "\\|").replace("<", "&lt;")
        if kind == "VIEW":
            views[view] = [meaning]
        elif kind == "COLUMN":
            views[view].append((column, meaning))
        else:
            (taken,) = re.findall(rf"CREATE MACRO {name}\((.*?)\)", statements())
            macros.append((f"{name}({taken})", meaning))
    return views, macros


LINE, WIDTH, GAP = 18, 210, 60
"""Pixels of the diagram: height of a line, width of a table, space between columns of tables."""


def diagram() -> str:
    """The keys of all tables, as SVG: a table is right of those that it refers to."""
    from hearth.schemas.tables import KEYS, TABLES

    refers = {table: _references(table) for table in TABLES}

    def level(table: str) -> int:
        others = {other.partition(".")[0] for other in refers[table].values()} - {table}
        return max((1 + level(other) for other in others), default=0)

    shown = {table: list(dict.fromkeys((*KEYS[table], *refers[table]))) for table in TABLES}
    levels = {table: level(table) for table in TABLES}
    bottom = dict.fromkeys(levels.values(), 20)
    place: dict[str, tuple[int, int]] = {}
    for table, names in shown.items():
        column = levels[table]
        place[table] = (20 + column * (WIDTH + GAP), bottom[column])
        bottom[column] += LINE * (len(names) + 1) + 30
    boxes, lines = [], []
    for table, (x, y) in place.items():
        names = shown[table]
        boxes.append(f'<rect x="{x}" y="{y}" width="{WIDTH}" height="{LINE * (len(names) + 1) + 6}" rx="4"/>')
        boxes.append(f'<text x="{x + 8}" y="{y + 15}" class="table">{table}</text>')
        for number, name in enumerate(names, 1):
            down = y + 15 + LINE * number
            boxes.append(f'<text x="{x + 8}" y="{down}" class="{"key" if name in KEYS[table] else ""}">{name}</text>')
            other, _, key = refers[table].get(name, "").partition(".")
            if other:
                boxes.append(f'<text x="{x + WIDTH - 8}" y="{down}" class="other">{other}</text>')
            if other and other != table:
                left, top = place[other][0] + WIDTH, place[other][1] + 10 + LINE * (1 + shown[other].index(key))
                middle = (left + x) / 2
                lines.append(f'<path d="M{x},{down - 5} C{middle:g},{down - 5} {middle:g},{top} {left},{top}"/>')
    size = max(x for x, _ in place.values()) + WIDTH + 20, max(bottom.values())
    return "\n".join((
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {size[0]} {size[1]}">',
        "<style>text{font:12px sans-serif;fill:#222}.table{font-weight:bold}"
        ".key{text-decoration:underline}.other{fill:#a65;text-anchor:end}rect{fill:#fff;stroke:#777}"
        "path{fill:none;stroke:#a65}</style>",
        f'<rect width="{size[0]}" height="{size[1]}" style="fill:#f6f4f0;stroke:none"/>',
        *lines, *boxes, "</svg>\n",
    ))  # fmt: skip
