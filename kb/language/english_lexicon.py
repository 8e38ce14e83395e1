"""Lexicon: which words are English, which are verbs or nouns, and their lemmas; and the language of a text.

Three small libraries ship what is asked, and none fetches anything at run time:

* `lemminflect` (1 MB) has the SPECIALIST Lexicon: every form of a word with its part of speech and lemma. WordNet, by
  `wn` or `nltk`, has the parts of speech but must be downloaded; `wordfreq` and `simplemma` have no parts of speech.
* `pyspellchecker` (7 MB) has the words of everyday English that a lexicon of the language lacks, such as `fridge`.
* `py3langid` (5 MB) names the language of a text in a millisecond; `simplemma` takes seconds.

Their tables are read by the first sentence that is not understood word by word (see `word_tables`).
"""

from collections.abc import Sequence
from functools import lru_cache

from hearth.kb.language import word_tables

_LANGUAGES = {
    "ar": "Arabic", "cs": "Czech", "da": "Danish", "de": "German", "el": "Greek", "en": "English", "es": "Spanish",
    "fi": "Finnish", "fr": "French", "he": "Hebrew", "hi": "Hindi", "hu": "Hungarian", "id": "Indonesian",
    "it": "Italian", "ja": "Japanese", "ko": "Korean", "nl": "Dutch", "no": "Norwegian", "pl": "Polish",
    "pt": "Portuguese", "ro": "Romanian", "ru": "Russian", "sv": "Swedish", "tr": "Turkish", "uk": "Ukrainian",
    "vi": "Vietnamese", "zh": "Chinese",
}  # fmt: skip
_ENGLISH_SHARE = 0.5
_FEWEST_WORDS = 4


def is_english(word: str) -> bool:
    """Return whether a word, in small letters, is an English one."""
    return bool(_lemmas(word)) or word_tables.is_everyday(word)


def is_verb(word: str) -> bool:
    """Return whether a word may be a form of an English verb."""
    return "VERB" in _lemmas(word)


def is_noun(word: str) -> bool:
    """Return whether a word may be a form of an English noun."""
    return "NOUN" in _lemmas(word)


def verb_lemmas(word: str) -> tuple[str, ...]:
    """Return the verbs of which a word may be a form: `left` is one of `leave`."""
    return _lemmas(word).get("VERB", ())


def inflections(lemma: str) -> tuple[str, ...]:
    """Return the forms of a word as a verb and as a noun: `grabs`, `grabbing`, `grabbed` of `grab`."""
    kinds = [kind for kind in ("VERB", "NOUN") if kind in _lemmas(lemma)]
    return tuple(dict.fromkeys(form for kind in kinds for form in word_tables.inflected(lemma, kind)))


def noun_lemmas(word: str) -> tuple[str, ...]:
    """Return the nouns of which a word may be a form: `knives` is one of `knife`."""
    return _lemmas(word).get("NOUN", ())


def foreign_language(lines: Sequence[str]) -> str | None:
    """Return the English name of the language of some lines; None if it is English or uncertain."""
    words = [word.strip(".,;:!?()\"'").lower() for line in lines for word in line.replace("_", " ").split()]
    words = [word for word in words if word.isalpha()]
    if len(words) < _FEWEST_WORDS and all(map(str.isascii, words)):
        return None
    if not words or sum(map(is_english, words)) > _ENGLISH_SHARE * len(words):
        return None
    import py3langid

    code = py3langid.classify("\n".join(lines))[0]
    return None if code == "en" else _LANGUAGES.get(code)


@lru_cache(maxsize=65_536)
def _lemmas(word: str) -> word_tables.Forms:
    return word_tables.lemmas(word.lower())
