"""The form of a source, recognised by its content."""

import itertools
import re
import zipfile
from collections.abc import Iterator
from pathlib import Path, PurePosixPath
from typing import Any, NamedTuple

from hearth.kb.language.plan_lines import plan_line
from hearth.kb.language.program_lines import is_plan
from hearth.pipelines.readers import (
    alfred,
    crowd,
    enclosed_json,
    json_records,
    natural_language_plans,
    program_tables,
    program_text,
    published_dataset,
    records_in_json,
    release,
    scene_graphs,
    sketches,
    text_chats,
    yaml_documents,
)
from hearth.pipelines.readers.json_actions import is_only_action
from hearth.pipelines.readers.json_documents import document, looks_like_json, parsed
from hearth.pipelines.readers.json_elements import entries, kinds
from hearth.pipelines.readers.reader_items import LARGEST_FILE, lines, opened
from hearth.pipelines.readers.relaxed_json import uncommented
from hearth.pipelines.readers.step_lists import is_pair
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.graph_wrappers import graph_in
from hearth.schemas.program_boundaries import TITLE
from hearth.storage.archives import (
    GZIP,
    MOST_MEMBERS,
    UNPACK,
    ZSTD,
    DamagedError,
    Member,
    Place,
    archive,
    members,
    refusal_of,
    size_of,
)
from hearth.storage.files import SERVED, links_not_followed, walk
from hearth.storage.input_files import read_start
from hearth.storage.rejects import Reject, as_text

_MAGIC: dict[bytes, str] = {
    b"\x89PNG": "a PNG picture",
    b"\xff\xd8\xff": "a JPEG picture",
    b"GIF8": "a GIF picture",
    b"BM": "a bitmap picture",
    b"RIFF": "a picture, sound or video",
    b"%PDF": "a PDF document",
    b"PAR1": "a Parquet file",
    b"SQLite": "an SQLite database",
    b"\x7fELF": "a program of this machine",
    b"\xd0\xcf\x11\xe0": "an old Office document",
}

_PACKED = frozenset({".gz", ".zst"})
_TABLES = frozenset({".csv", ".tsv"})
_CODE = frozenset({".py", ".js", ".ts", ".sh", ".lua"})
_JSON = frozenset({".json", ".jsonl", ".ndjson"})
_YAML = frozenset({".yaml", ".yml"})
_TEXT = frozenset({"", ".txt", ".text", ".prog"})
"""Endings of texts that are read as programs even without a step; others, such as notes, need one."""

_NUMBER = re.compile(
    r"\s*\[(?:\d{1,4}|[\d/.-]*,?[ T]?\d{1,2}:\d\d[\d:.]*(?:\s?[ap]m)?|[-+ox*✓✔✕✗✘ ])\]\s+[^\s,\]}]"
    r"|\s*\[+[A-Za-z_][\w .-]*\]+\s*$|\s*\[(?:INFO|DEBUG|WARN)"
)
"""The number of a step in brackets, `[1] Walk to fridge`, or its time, `[09:15] robot: walk to fridge`."""

_COMMENT_LINE = re.compile(r"\s*(?://.*|/\*(?:(?!\*/).)*\*/\s*)$")
"""A line of JSON that is a comment."""

_MARKUP = re.compile(
    r"\s*(?:(?P<HTML><!doctype html|<html\b)|(?P<SVG><svg\b)|(?P<XML><\?xml\b)|(?P<RTF>\{\\rtf))", re.IGNORECASE
)
_STEP_ELEMENT = re.compile(r"<(?:li|step|action|instruction|p|td|task|command)\b[^<>]*>\s*[^\s<]", re.IGNORECASE)
"""A step that HTML or XML marks on a line."""

_ENCLOSED = re.compile(r"\s*(?:[\w *#-]{1,40}:\s*)?[{\[]\s*(?:[\"{\[]|$)")
"""A line of a text on which JSON may begin."""

_LOOKED_AT = 60
_LONGEST = 100_000

FORMS = (
    "a release (zip or folder), a table (CSV), program text, natural-language steps, JSON or JSON Lines of "
    "records, sketches, a scene graph, or a dataset; packed as .zip, .gz or .zst or not"
)


class Recognised(NamedTuple):
    """A file or folder with its reader; or with a refusal, if no reader takes it."""

    path: Place
    inside: str
    reader: str
    refusal: Reject | None = None


def recognise(path: Path, label: str) -> Iterator[Recognised]:
    """One entry for each file or folder of a source that one reader reads whole.

    Raises:
        HearthError: the path is missing, or nothing in it has a known form.
    """
    if not path.exists():
        raise HearthError.of(Code.MISSING_FILE, "no such file or folder", file=str(path))
    if path.is_file():
        yield from _named_file(path, label)
        return
    dataset = next((folder for folder in (path, path / "publish") if published_dataset.names_it(folder)), None)
    if dataset:
        yield Recognised(dataset, label, published_dataset.NAME)
        return
    files = [file.relative_to(path).as_posix() for file in walk(path)]
    if any(map(release.names_it, files)):
        yield Recognised(path, label, release.NAME)
        files = [name for name in files if not release.names_it(name)]
        yield from map(_beside_release, _folder(path, label, files))
        return
    found = list(_folder(path, label, files))
    if all(entry.refusal for entry in found):
        what = [fault.message for entry in found if entry.refusal for fault in entry.refusal.diagnostics]
        kinds = f"; the first is {what[0]}" if what else ""
        message = f"nothing to read among {len(files)} files{kinds}" if found else "an empty folder"
        remedy = f"give {FORMS}"
        if not found and (path / SERVED).is_dir():
            message, remedy = "nothing was accepted yet", "review programs in the room Annotate of `serve` first"
        raise HearthError.of(Code.UNSUPPORTED_FILE, message, file=str(path), suggestion=remedy)
    yield from found


_OF_PEOPLE = frozenset({crowd.NAME, scene_graphs.NAME, sketches.NAME, program_tables.NAME})
"""Readers that know their files by layouts of their own: these are read next to a release, too."""


def _beside_release(found: Recognised) -> Recognised:
    """Refuse a file next to a release: texts and JSON there are about the release, and no programs."""
    if found.refusal or found.reader in _OF_PEOPLE:
        return found
    message, remedy = "a file next to a release: only the release is read", "name the file as a source of its own"
    return found._replace(
        reader="", refusal=Reject.of(Code.UNSUPPORTED_FILE, message, file=found.inside, suggestion=remedy)
    )


def _folder(path: Path, label: str, names: list[str]) -> Iterator[Recognised]:
    for name in names:
        yield from _file(path / name, f"{label}/{as_text(name)}")
    for link in links_not_followed(path):
        place = f"{label}/{as_text(link.relative_to(path).as_posix())}"
        message, remedy = "a link to a folder or out of this one: it is not followed", "name its target as a source"
        reject = Reject.of(Code.UNSUPPORTED_FILE, message, file=place, suggestion=remedy)
        yield Recognised(link, place, "", reject)


def _named_file(path: Path, label: str) -> Iterator[Recognised]:
    """Yield a source that is a file: if nothing in it can be read, that is an error, not a reject."""
    found = list(_file(path, label))
    refused = [entry.refusal for entry in found if entry.refusal]
    if len(refused) == len(found) and path.stat().st_size:
        raise HearthError(fault.at(str(path)) for refusal in refused[:1] for fault in refusal.diagnostics)
    yield from found


def _file(path: Path, place: str) -> Iterator[Recognised]:
    start = read_start(path, 8)
    if start.startswith(b"PK"):
        yield from _archive(path, place)
        return
    kind = next((kind for magic, kind in _MAGIC.items() if start.startswith(magic)), None)
    yield _refused(path, place, kind) if kind else _text(path, place)


def _text(path: Place, place: str) -> Recognised:
    """Return the form of a text, packed or not, by its first lines."""
    try:
        return _by_first_lines(path, place)
    except DamagedError as error:
        return Recognised(path, place, "", Reject.because(error.diagnostics, place))


def _by_first_lines(path: Place, place: str) -> Recognised:
    suffix = _suffix(path)
    whole = [line for line, _ in itertools.islice(lines(path), _LOOKED_AT) if line.strip()]
    if suffix in _JSON:
        whole = list(itertools.dropwhile(_COMMENT_LINE.match, whole))
    first = [line[:_LONGEST] for line in whole]
    line = first[0] if first else ""
    line = uncommented(line) if suffix in _JSON else line
    if markup := _MARKUP.match(line):
        if any(map(_STEP_ELEMENT.search, first)) and is_plan(first):
            return Recognised(path, place, natural_language_plans.NAME)
        return _refused(path, place, f"{markup.lastgroup}, in which no plans are read: save it as plain text or CSV")
    if crowd.header_of(line[:10_000]):
        return Recognised(path, place, crowd.NAME)
    if looks_like_json(line) and not _NUMBER.match(line):
        return _json(path, place, whole)
    may_be_table = suffix not in _CODE and line.lstrip()[:1] != "|"
    if (suffix in _TABLES and first) or (may_be_table and program_tables.names_it(line[:10_000])):
        return Recognised(path, place, program_tables.NAME)
    if suffix in _JSON and first:
        return _refused(path, place, "a JSON file that holds neither an object nor a list", Code.BAD_JSON)
    if suffix in _YAML and yaml_documents.holds_programs(path, place):
        return Recognised(path, place, yaml_documents.NAME)
    if suffix in _YAML:
        return _refused(path, place, "a YAML file, which holds no programs")
    if reader := _reader_of_words(path, first):
        return Recognised(path, place, reader)
    if any(map(_ENCLOSED.match, first)) and enclosed_json.holds_programs(path, place):
        return Recognised(path, place, enclosed_json.NAME)
    if suffix not in _TEXT | _JSON | _TABLES and not any(plan_line(line).bracketed for line in first):
        return _refused(path, place, "a text without a step")
    return Recognised(path, place, program_text.NAME)


def _reader_of_words(path: Place, first: list[str]) -> str:
    """Return the reader of a text whose steps are words; empty where they are not."""
    if text_chats.is_chat(path, first):
        return text_chats.NAME
    return natural_language_plans.NAME if first and is_plan(first) else ""


def _suffix(path: Place) -> str:
    """Return the ending of a file's name, without that of a packed file."""
    suffixes = PurePosixPath(str(getattr(path, "name", path))).suffixes
    return next((part.lower() for part in reversed(suffixes) if part.lower() not in _PACKED), "")


def _json(path: Place, place: str, first: list[str]) -> Recognised:
    """Return the form of a JSON file.

    JSON Lines if the first line is a whole value and others follow, else a document.
    """
    is_value = not isinstance(parsed(first[0], place, 1), Reject)
    if is_value and (len(first) > 1 or size_of(path) > LARGEST_FILE):
        return Recognised(path, place, json_records.NAME)
    if first[0].lstrip().startswith("["):
        reader = _form_of_list(path, place)
    elif all(found == "[" for found in map(kinds(path).get, sketches.COLUMNS)):
        reader = sketches.NAME
    else:
        value = document(path, place)
        if isinstance(value, Reject):
            return Recognised(path, place, "", value)
        reader = _form_of(value)
    return Recognised(path, place, reader) if reader else _refused(path, place, "JSON of an unknown form")


def _form_of_list(path: Place, place: str) -> str:
    """Return the reader of a list, by its first entry that can be read; an empty list is a list of records.

    Texts of one line and actions are the steps of one program, other texts a plan each.
    """
    for _, value in entries(path, place):
        if isinstance(value, str):
            return TEXTS if "\n" in value.strip() or TITLE.match(value) else DOCUMENT
        if is_only_action(value) or is_pair(value):
            return DOCUMENT
        if not isinstance(value, Reject):
            return LISTED if isinstance(value, (dict, list)) else ""
    return LISTED


def _form_of(value: Any) -> str:
    if not isinstance(value, dict):
        return ""
    if alfred.is_trajectory(value):
        return alfred.NAME
    return scene_graphs.NAME if graph_in(value) is not None and not records_in_json.is_record(value, {}) else DOCUMENT


TEXTS = "spoken list"
LISTED = "records list"
DOCUMENT = "records document"
"""Readers that scan another form and then read records as `plans` or `ours` do."""


def _archive(path: Path, place: str) -> Iterator[Recognised]:
    try:
        infos = members(archive(path))
    except HearthError as error:
        yield Recognised(path, place, "", Reject(tuple(fault.at(place) for fault in error.diagnostics)))
        return
    if any(info.filename == "[Content_Types].xml" for info in infos):
        yield _refused(path, place, "an Office document: save a sheet as CSV, a text as plain text")
        return
    is_release = any(release.names_it(info.filename) for info in infos)
    if is_release:
        yield Recognised(path, place, release.NAME)
    others = [info for info in infos if not release.names_it(info.filename) and not _is_hidden(info.filename)]
    if len(others) > MOST_MEMBERS:
        message = f"an archive of {len(others):,} files: at most {MOST_MEMBERS:,} are read where they are"
        yield Recognised(path, place, "", Reject.of(Code.FILE_TOO_LARGE, message, file=place, suggestion=UNPACK))
        return
    found = [_member(path, info, f"{place}/{as_text(info.filename)}") for info in others]
    if is_release:
        yield from map(_beside_release, found)
        return
    if not all(entry.refusal and entry.refusal.code == Code.UNSUPPORTED_FILE for entry in found):
        yield from found
        return
    example = f", for example `{infos[0].filename}`" if infos else ""
    message = f"an archive of {len(infos)} files without any of the release's folders or other data{example}"
    suggestion = f"it needs one of the folders {', '.join(sorted(release.FOLDERS))}, or .csv, .json, .jsonl or .txt"
    yield Recognised(path, place, "", Reject.of(Code.BAD_ARCHIVE, message, file=place, suggestion=suggestion))


def _is_hidden(name: str) -> bool:
    return any(part.startswith((".", "__MACOSX")) and part != ".." for part in PurePosixPath(name).parts)


def _member(path: Path, info: zipfile.ZipInfo, place: str) -> Recognised:
    refusal = refusal_of(info, place)
    if refusal:
        return Recognised(path, place, "", refusal)
    member = Member(path, info.filename)
    try:
        with opened(member) as (file, _):
            start = file.peek(8)[:8]  # type: ignore[attr-defined]
    except (HearthError, OSError, RuntimeError, NotImplementedError) as error:
        reject = Reject.of(Code.BAD_ARCHIVE, f"can't be unpacked: {error}", file=place, suggestion="download it again")
        return Recognised(path, place, "", reject)
    kind = next((kind for magic, kind in _MAGIC.items() if start.startswith(magic)), None)
    if start.startswith((b"PK", GZIP, ZSTD)):
        kind = "a packed file inside an archive"
    return _refused(member, place, kind) if kind else _text(member, place)


def _refused(path: Place, place: str, kind: str, code: Code = Code.UNSUPPORTED_FILE) -> Recognised:
    return Recognised(path, place, "", Reject.of(code, kind, file=place, suggestion=f"give {FORMS}"))
