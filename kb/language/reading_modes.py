"""Modes of reading: how far a sentence may be from one that Hearth knows and still be read."""

from enum import StrEnum


class Fuzzy(StrEnum):
    """The accepted distance of a sentence from a known one.

    Attributes:
        OFF: not at all: templates, synonyms, inflections and usual phrasings; nothing is left out or corrected.
        TYPOS: misspelled words are corrected, and adverbs, durations, tools and purposes at the end are left out; each
            with a FUZZY_MATCH. A word that is English is never corrected.
        LOOSE: as TYPOS; then the step whose spelling is nearest to the sentence, as Hearth 0.2 read. It may be wrong.
    """

    OFF = "off"
    TYPOS = "typos"
    LOOSE = "loose"
