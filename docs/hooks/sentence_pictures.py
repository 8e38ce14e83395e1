"""The page "Thirty sentences": `python docs/hooks/sentence_pictures.py` writes docs/sentences.md and its pictures.

The sentences are of another author (tests/models/everyday_unseen*.jsonl). None was picked by hand: eighteen
instructions at equal steps of the file, six other wordings at equal steps of those whose goal is not reached, three
descriptions, and three requests that no home can do.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from hearth.analysis.everyday_instructions import Row, asking, homes_for, rows_of, start_without, tried
from hearth.analysis.step_gallery import picture_of
from hearth.challenges.household_definition import home_named
from hearth.homes.library import load_graph
from hearth.kb.action_sets import LATEST
from hearth.kb.loading.load import default
from hearth.models.model_registry import restore
from hearth.rendering.film.execution_keyframes import trajectory_of
from hearth.rendering.film.png import encode
from hearth.rendering.scene.home_geometry import with_geometry
from hearth.schemas.goals import Goal
from hearth.schemas.syntax import print_step
from hearth.simulation.engine import Execution
from hearth.simulation.goal_text import read_goal

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs/sentences.md"
PICTURES = ROOT / "docs/pictures/sentences"
FILES = ROOT / "tests/models"
SIZE = (240, 180)

ABOUT = """\
# Thirty sentences

Sentences of an author who had not seen the reader, and the programs that `hearth model show` writes for them: good and
bad. A command picked them, not a person (`python docs/hooks/sentence_pictures.py`): eighteen instructions at equal
steps of `tests/models/everyday_unseen.jsonl`, six other wordings whose goal is not reached, three descriptions, and
three requests that no home can do. The picture shows the home after the last step. A sentence has a goal that its
author wrote; whether it is reached stands below the program. [Models](models.md#what-a-person-says) has the figures.
"""


class Said(NamedTuple):
    """A sentence to show: its row, its words, and the home."""

    row: Row
    text: str
    home: str


def spread(rows: Sequence[Any], count: int) -> list[Any]:
    """Return rows at equal steps."""
    return [rows[n * len(rows) // count] for n in range(min(count, len(rows)))]


def sentences(asked: Any) -> Iterator[Said]:
    """Yield the thirty."""
    rows = rows_of(FILES / "everyday_unseen.jsonl")
    yield from (Said(row, row.instruction, homes_for(row)[0]) for row in spread(rows, 18))
    others = [Said(row, text, homes_for(row)[0]) for row in rows for text in row.wordings]
    missed = [each for each in others if not tried(each.row, each.text, each.home, asked).reached]
    yield from spread(missed, 6)
    for name in ("long", "impossible"):
        some = spread(rows_of(FILES / f"everyday_unseen_{name}.jsonl"), 3)
        yield from (Said(row, row.instruction, homes_for(row)[0]) for row in some)


def picture(ran: Execution, home: str) -> bytes:
    """Return a picture of the home after the last step."""
    known = default().of_set(LATEST)
    graph = with_geometry(load_graph(home, known), home, known).graph
    trajectory = trajectory_of(ran, graph, known)
    image: bytes = encode(picture_of(trajectory, trajectory.keyframes[-1], graph, SIZE)[0])
    return image


def plain(step: str) -> str:
    """Return a step without the numbers of nodes."""
    return re.sub(r" \((\d+)\.\d+\)", r" (\1)", step)


def section(number: int, said: Said, asked: Any) -> str:
    """Return what the page says of a sentence; its picture is written."""
    goal = read_goal(said.row.goal, home_named(said.home, default().of_set(LATEST))) if said.row.goal else Goal()
    execution, note = asked(said.text, start_without(goal, said.home, said.row.id))
    lines = [f"## {number}. In {said.home}", "", f"> {said.text}", ""]
    if execution is None:
        return "\n".join([*lines, f"**No program**: {note}", ""])
    steps = "\n".join(plain(print_step(step)) for step in execution.program.steps)
    found = tried(said.row, said.text, said.home, asked)
    name = f"{number:02}.png"
    (PICTURES / name).write_bytes(picture(execution, said.home))
    verdict = "reached" if found.reached else "**not reached**"
    lines += [f"![After the last step](pictures/sentences/{name})", "", "```", steps, "```", ""]
    lines += [f"The goal is {verdict}: `{said.row.goal}`" if said.row.goal else "**It should be refused.**", ""]
    lines += [f"Not understood: {note}", ""] if note else []
    return "\n".join(lines)


def main() -> None:
    """Write the page and its pictures."""
    PICTURES.mkdir(parents=True, exist_ok=True)
    asked = asking(restore("reader")[1])
    parts = [section(number, said, asked) for number, said in enumerate(sentences(asked), 1)]
    PAGE.write_text("\n".join([ABOUT, *parts]), encoding="utf-8")
    print(json.dumps({"sentences": len(parts), "page": PAGE.name}))


if __name__ == "__main__":
    main()
