"""The tables of words that libraries ship, read from their files: the libraries' own loading takes 2 s of a processor.

`lemminflect` decodes a hundred thousand rows, and imports models of words that it does not know; a reading asks for
some hundred words. So the tables stay as text, sorted by word as they are, and the rows of a word are looked up in it.
`tests/kb/test_word_tables.py` holds the answers against the library's own.
"""

import gzip
import json
from collections.abc import Iterator, Mapping
from functools import lru_cache
from importlib.util import find_spec
from pathlib import Path

Forms = Mapping[str, tuple[str, ...]]
"""The spellings of a word by part of speech (`NOUN`, `VERB`, ...)."""

_MODALS = {
    "can": ("can", "could"), "may": ("may", "might"), "will": ("will", "would"), "shall": ("shall", "should"),
    "must": ("must",), "ought": ("ought",), "dare": ("dare",),
    "be": ("be", "was", "were", "being", "been", "am", "are", "is"),
}  # fmt: skip
"""The forms of modal verbs and of `be`, which the library does not read from its table."""

_TAGS = {"NOUN": ("NNS",), "VERB": ("VBD", "VBN", "VBG", "VBZ")}
"""The tags of the columns of forms."""


def lemmas(word: str) -> Forms:
    """Return the words of which a word, in small letters, may be a form, by part of speech."""
    found = {}
    for row in _rows("lemma_lu.csv.gz", word):
        _, category, spelt = row.split(",")
        found[category.upper()] = tuple(spelt.lower().split("/"))
    for kind, lemma in _overrides("lemma_overrides.csv").get(word, ()):
        found[kind] = (lemma,)
    return found


def inflected(lemma: str, kind: str) -> tuple[str, ...]:
    """Return the forms of a word in small letters as a noun (`NOUN`) or as a verb (`VERB`), itself among them."""
    if lemma in _MODALS:
        return _MODALS[lemma] if kind == "VERB" else ()
    found: dict[str, tuple[str, ...]] = {}
    for row in _rows("infl_lu.csv.gz", lemma):
        _, category, *forms = row.split(",")
        if category.upper() == kind:
            found = {"": (lemma,), **dict(zip(_TAGS[kind], (tuple(spelt.split("/")) for spelt in forms), strict=False))}
    for tag, form in _overrides("infl_overrides.csv").get(lemma, ()):
        if tag.startswith(kind[0]):
            found[tag] = (form,)
    return tuple(dict.fromkeys(form.lower() for spelt in found.values() for form in spelt if form))


@lru_cache(maxsize=65_536)
def is_everyday(word: str) -> bool:
    """Return whether a word is one of everyday English, as in texts of films: a lexicon lacks many of them."""
    return f"{json.dumps(word, ensure_ascii=False)}:".encode() in _text("spellchecker", "en.json.gz")


def _rows(file: str, word: str) -> Iterator[str]:
    """Yield the rows of a word in a table."""
    text, start = _text("lemminflect", file), f"{word},".encode()
    low, high = 0, len(text)
    while low < high:
        middle = (low + high) // 2
        line = text.rfind(b"\n", 0, middle) + 1
        if text[line : text.index(b",", line)] < start[:-1]:
            low = (text.find(b"\n", middle) + 1) or len(text)
        else:
            high = line
    while word and text.startswith(start, low):
        end = text.index(b"\n", low)
        yield text[low:end].decode()
        low = end + 1


@lru_cache(maxsize=3)
def _text(library: str, file: str) -> bytes:
    return gzip.decompress((_folder(library) / file).read_bytes())


@lru_cache(maxsize=2)
def _overrides(file: str) -> Mapping[str, list[tuple[str, str]]]:
    found: dict[str, list[tuple[str, str]]] = {}
    for row in (_folder("lemminflect") / file).read_text("utf-8").splitlines():
        if row.strip() and not row.startswith("#"):
            word, kind, form = row.strip().split(",")
            found.setdefault(word, []).append((kind, form))
    return found


def _folder(library: str) -> Path:
    """Return the folder of a library's tables, without importing the library."""
    spec = find_spec(library)
    if spec is None or not spec.submodule_search_locations:
        raise ModuleNotFoundError(f"no module named {library!r}", name=library)
    return Path(next(iter(spec.submodule_search_locations)), "resources")
