"""Signs that a person did not take part with care, for the researcher to look at; nothing is decided by them."""

from __future__ import annotations

import re
import unicodedata
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from hearth.studies.events import Event
from hearth.studies.study import Study
from hearth.studies.study_progress import Standing

FLAGS: Mapping[str, str] = {
    "attention": "a question with one right answer was answered otherwise",
    "fast": "a trial took less than the study's shortest time",
    "nothing": "a task was ended without a single act",
    "idle": "most ticks of a task were spent waiting",
    "same": "every rating has the same value",
    "repeated": "the same words were written several times",
    "gibberish": "words that are none",
    "long": "an answer is so long that it may be pasted",
    "reopened": "the page of a task was opened again and again: by reloading, going back, or in other tabs",
    "twice": "somebody of the same id at the platform takes part as well",
}
"""The flags, with their meanings."""

MOST_WAITING = 0.5
"""Share of a task's ticks that may be spent waiting."""

FEWEST_TICKS = 10
"""Ticks below which waiting says nothing."""

FEWEST_RATINGS = 4
"""Ratings below which it is no sign that all are the same."""

MOST_CHARACTERS = 1_500
"""Characters of an answer that somebody may have typed."""

MOST_OPENINGS = 3
"""Times that the page of a task is opened by a person who comes back to it now and then."""

FEWEST_VOWELS = 0.15
"""Share of vowels in the letters of words, of any language that is written in Latin letters."""


FEWEST_LETTERS = 10
"""Letters below which the share says nothing, as in "Watch TV"."""


FEWEST_WORDS = 6
"""Words of which no more than half may be the same one."""


def flags(study: Study, standing: Standing, others: Sequence[str] = ()) -> tuple[str, ...]:
    """Return the flags of a person, in the order of `FLAGS`.

    Args:
        study: the design.
        standing: the person, with all events.
        others: the ids that others who take part have at the platform.
    """
    found = {*_trials(study, standing.events), *_answers(study, standing.events)}
    if came(standing).get("person", "") in others and came(standing):
        found.add("twice")
    return tuple(each for each in FLAGS if each in found)


def came(standing: Standing) -> Mapping[str, str]:
    """Return what a person's link from a platform said, with the id as `person`; empty for other people."""
    consent = next((each for each in standing.events if each.kind == "consented"), None)
    found: Mapping[str, str] = consent.data.get("came", {}) if consent else {}
    return found


def _trials(study: Study, events: Sequence[Event]) -> Iterator[str]:
    for event in events:
        if event.kind != "did":
            continue
        if event.data["seconds"] < study.limits.least_seconds:
            yield "fast"
        if event.data.get("opened", 1) > MOST_OPENINGS:
            yield "reopened"
        record = event.data.get("record")
        if record is None:
            continue
        acts = [tick[0] for tick in record["actions"]]
        waited = acts.count(None)
        if waited == len(acts):
            yield "nothing"
        elif len(acts) >= FEWEST_TICKS and waited > MOST_WAITING * len(acts):
            yield "idle"


def _answers(study: Study, events: Sequence[Event]) -> Iterator[str]:
    questions = {each.name: each for each in (*study.questions, *study.exit)}
    ratings: list[int] = []
    texts: Counter[str] = Counter()
    for event in events:
        for name, answer in event.data.get("answers", {}).items():
            question = questions.get(name)
            if question is None:
                continue
            if question.correct is not None and answer != question.correct:
                yield "attention"
            elif question.kind == "scale" and question.correct is None:
                ratings.append(answer)
            elif question.kind == "text":
                texts[answer.strip().casefold()] += 1
                if is_gibberish(answer):
                    yield "gibberish"
                if len(answer) > MOST_CHARACTERS:
                    yield "long"
    if len(ratings) >= FEWEST_RATINGS and len(set(ratings)) == 1:
        yield "same"
    if any(count > 1 and len(text) >= 12 for text, count in texts.items()):
        yield "repeated"


def is_gibberish(text: Any) -> bool:
    """Return whether a text is no words: pictures alone, or in Latin letters mostly one word again, or no vowels."""
    if not any(map(str.isalnum, str(text))) and any(unicodedata.category(each) == "So" for each in str(text)):
        return True
    words = re.findall(r"[a-z']+", str(text).casefold())
    letters = "".join(words).replace("'", "")
    if len(letters) < 5 or len(letters) < 0.5 * len(re.sub(r"\s", "", str(text))):
        return False
    vowels = sum(each in "aeiouy" for each in letters)
    mute = len(letters) >= FEWEST_LETTERS and vowels < FEWEST_VOWELS * len(letters)
    same = max(Counter(words).values(), default=0)
    return mute or (len(words) >= 3 and same == len(words)) or (len(words) >= FEWEST_WORDS and 2 * same > len(words))
