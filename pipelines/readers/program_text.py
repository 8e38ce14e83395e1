"""Program text: a title, a description, then one step a line; several programs in a file."""

import re
from collections.abc import Iterator

from hearth.pipelines.readers.reader_items import Item, fault_of, pieces, record, refused
from hearth.pipelines.readers.text_blocks import LONGEST_PROGRAM, Block, blocks
from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.failures import Code
from hearth.schemas.stage_rows import IngestedRow
from hearth.schemas.syntax import MAX_LINE
from hearth.schemas.text_decoding import western
from hearth.storage.archives import Place, size_of
from hearth.storage.rejects import Reject

NAME = "text"


_FIRST_STEP = re.compile(r"^[^\S\n]*+[\[<(|]", re.MULTILINE)


def scan(path: Place, place: str) -> Iterator[Item]:
    """One item for each program of a file.

    `hearth.schemas.program_boundaries` decides where the next program begins. A title without steps is a record.
    """
    number = 0
    for number, block in enumerate(blocks(pieces(path)), 1):
        yield _item(block, f"{NAME}:{place}#{number}" if number > 1 else f"{NAME}:{place}", place)
    if not number:
        reason = "nothing to read" if size_of(path) else "an empty file"
        suggestion = "write a title, a blank line, then one [Step] a line"
        yield refused(place, Reject.of(Code.EMPTY, reason, file=place, suggestion=suggestion))


def _item(block: Block, record_id: str, place: str) -> Item:
    first, text, cut = block.first, western(block.text), block.cut
    fault = fault_of(text, place, first)
    if fault is None and (cut or len(text) > MAX_LINE):
        fault = _too_long(block, place)
    if fault:
        return refused(place, Reject((fault,)), record_id, first)
    return Item(record_id, NAME, place, {"text": text if text.endswith("\n") else text + "\n", "line": first - 1})


def _too_long(block: Block, place: str) -> Diagnostic | None:
    """Return the fault of a line, or else of a program, that is too long."""
    for number, line in enumerate(block.text.split("\n"), block.first):
        if len(line) > MAX_LINE:
            length = f"more than {MAX_LINE:,}" if block.cut else f"{len(line):,}"
            message, found, suggestion = f"a line of {length} characters", line[:60], f"at most {MAX_LINE:,}"
            return Diagnostic(
                Code.LINE_TOO_LONG, message, place, number, 1, len(found), found, suggestion, source=line[:200]
            )
    if not block.cut:
        return None
    message = f"a program of more than {LONGEST_PROGRAM:,} characters"
    return Diagnostic(Code.LINE_TOO_LONG, message, place, block.first, suggestion="begin each program with its title")


def header(text: str) -> tuple[str, str]:
    """Title and description of a program's text: the lines before its first step."""
    first = _FIRST_STEP.search(text)
    found = [line for raw in text[: first.start() if first else len(text)].split("\n") if (line := raw.strip())]
    return (found[0] if found else "", "\n".join(found[1:]))


def read(item: Item) -> IngestedRow:
    """Return the record of an item."""
    title, description = header(item.value["text"])
    return record(item, "program", title, description, text=item.value["text"], line=item.value["line"])
