"""Sketches: the steps of a program that an annotator kept as its gist (thesis 4.2), in the release's annotation file.

`prefix` is the name of a program of a release, or the id of one that was written
(`written:P...`) or that a crowd gave (`crowd:P...`).
"""

from collections.abc import Iterator
from itertools import zip_longest

from hearth.pipelines.readers import crowd, release
from hearth.pipelines.readers.crowd import WRITTEN
from hearth.pipelines.readers.json_elements import entries
from hearth.pipelines.readers.reader_items import Item, record, refused
from hearth.schemas.failures import Code
from hearth.schemas.stage_rows import IngestedRow
from hearth.storage.archives import Place
from hearth.storage.rejects import Reject

NAME = "sketches"

COLUMNS = ("answer", "input")
"""Columns of equal length, by which the file is recognised."""


def scan(path: Place, place: str) -> Iterator[Item]:
    """One item for each sketch."""
    columns = [entries(path, place, key) for key in (*COLUMNS, "represent")]
    for number, ((_, keep), (line, given), (_, fits)) in enumerate(zip_longest(*columns, fillvalue=_ABSENT), 1):
        where = f"{place}[{number}]"
        fault = next((value for value in (keep, given) if isinstance(value, Reject)), None)
        if keep is None or given is None:
            message = "not sketches: `answer` and `input` are not lists of one length"
            fault = fault or Reject.of(Code.BAD_JSON, message, file=place, line=line)
        if fault:
            yield refused(where, fault)
            return
        value = {"keep": keep, "input": given, "represent": 1 if fits is None or isinstance(fits, Reject) else fits}
        yield Item(f"{NAME}:{where}", NAME, where, value)


_ABSENT = (0, None)


def read(item: Item) -> IngestedRow | Reject:
    """Return the record of a sketch: its program, a flag for each of its steps, and the steps that the flags keep."""
    keep, given = item.value["keep"], item.value["input"]
    try:
        flags = [bool(flag) for flag in keep]
        text = "".join(f"{step.strip()}\n" for step in given["prog"])
        program_id, title, description = str(given["prefix"]), str(given["title"]), str(given["descr"])
    except (TypeError, KeyError, AttributeError) as error:
        message = f"not a sketch: {type(error).__name__} {error}"
        return Reject.of(Code.BAD_JSON, message, file=item.place, suggestion="it needs title, descr, prog and prefix")
    if not flags:
        return Reject.of(Code.EMPTY, "a sketch without steps", file=item.place)
    if sum(flags) != (count := text.count("\n")):
        message = f"not a sketch: flags set {sum(flags):,}, steps in `prog` {count:,}"
        return Reject.of(Code.BAD_JSON, message, file=item.place, suggestion="set a flag for each step that is kept")
    own = program_id.startswith((f"{WRITTEN}:", f"{crowd.NAME}:"))
    described = program_id if own else f"{release.NAME}:{program_id}"
    return record(item, "sketch", title, description, description_id=described, text=text, line=0, keep=flags)
