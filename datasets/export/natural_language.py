"""`nl`: programs as sentences, for people and for language models."""

from pathlib import Path
from typing import Any

import orjson

from hearth.datasets.dataset import Dataset
from hearth.datasets.export.program_batches import Wanted, programs, write
from hearth.datasets.format.row_conversion import program_of
from hearth.kb.knowledge import Knowledge
from hearth.kb.language.step_phrases import say
from hearth.schemas.program import Program
from hearth.schemas.published_rows import ProgramRow

ASKED = "How do you do this at home? Answer with one step a line."


def sentences(program: Program, knowledge: Knowledge) -> list[str]:
    """Return each step as a natural-language sentence without instances: `Put cup on table`."""
    actions = knowledge.actions
    return [say(actions[step.action], [ref.name for ref in step.objects]) for step in program.steps]


def numbered(program: Program, knowledge: Knowledge) -> str:
    """Return a program in the prompt format of planning papers: `Task: ...` and `Step 1: ...`."""
    steps = (f"Step {number}: {text}" for number, text in enumerate(sentences(program, knowledge), 1))
    return "\n".join((f"Task: {program.title}", *steps))


def nl(dataset: Dataset, to: Path, wanted: Wanted) -> int:
    """Three files: `steps.jsonl` (id, title, description, natural-language steps), `chat.jsonl` (pairs of user and
    assistant for instruction tuning) and `examples.json` (a list of numbered texts, the format of planning papers).

    Returns:
        Number of programs.
    """
    knowledge = dataset.knowledge
    steps, chat, examples = [], [], []
    for row in programs(dataset, wanted):
        program = program_of(row)
        texts = sentences(program, knowledge)
        known = {"program_id": row["program_id"], "split": row["split"], "title": row["title"]}
        steps.append(orjson.dumps({**known, "description": row["description"], "steps": texts}))
        chat.append(orjson.dumps(_pair(row, texts)))
        examples.append(numbered(program, knowledge))
    write(to / "steps.jsonl", b"".join(line + b"\n" for line in steps))
    write(to / "chat.jsonl", b"".join(line + b"\n" for line in chat))
    write(to / "examples.json", orjson.dumps(examples, option=orjson.OPT_INDENT_2 | orjson.OPT_APPEND_NEWLINE))
    return len(steps)


def _pair(row: ProgramRow, texts: list[str]) -> dict[str, Any]:
    question = "\n".join(part for part in (ASKED, "", row["title"], row["description"]) if part is not None).strip()
    answer = "\n".join(f"{number}. {text}" for number, text in enumerate(texts, 1))
    messages = [{"role": "user", "content": question}, {"role": "assistant", "content": answer}]
    return {"program_id": row["program_id"], "split": row["split"], "messages": messages}
