"""Plain lines without numbers or bullets: which of them ask for a step, and which is the title."""

import re
from collections.abc import Sequence
from functools import lru_cache

from hearth.kb.knowledge import Knowledge
from hearth.kb.language.english_lexicon import is_noun, is_verb
from hearth.kb.language.operator_step_syntax import operator_step
from hearth.kb.language.plan_lines import CHAIN, PlanLine
from hearth.kb.language.recognition_knowledge import recognition, recognized_cache
from hearth.kb.language.step_phrases import parses
from hearth.kb.language.title_marks import goes_there, is_gerund
from hearth.kb.language.typos import near_words
from hearth.schemas.program_boundaries import is_sentence

_SUBJECT = r"(?:i|you|he|she|we|they|the (?:robot|person|agent|character|man|woman|child|user))"
_NO_MANNER = (
    "only|early|family|reply|apply|supply|fly|assembly|usually|normally|generally|typically|basically|actually|really"
    "|probably|rarely|commonly|sadly|unfortunately"
)
"""Words in -ly that do not say how a step is done."""

_LEAD = re.compile(
    rf"(?:(?:please|(?:i|we) (?:need|want) you to"
    rf"|(?:first|second|third|fourth|fifth|sixth|seventh|eighth|ninth|tenth)(?:ly)?(?= ?,)"
    rf"|first|then|next|now|finally|lastly|afterwards?|meanwhile|and|also|just|kindly|after (?:that|this)"
    rf"|(?:(?:hey|hi|hello|ok|okay) )?(?:robot|bot|alexa|siri|jarvis)(?= ?,)|um+|uh+|oh"
    r"|yesterday|today|tonight|this (?:morning|afternoon|evening)|in the (?:morning|afternoon|evening)"
    rf"|(?:(?:over|back|down|up|out) )?(?:in|on|at|from) (?:the|my|your|our) [a-z]+(?: [a-z]+)?(?=,)"
    rf"|er+m?|yeah|yep|well|right|alright|okay|ok|so|great|good|you know"
    rf"|at last|(?:could|would|can|will) you(?: mind| be so kind as to)?|if you don['’]t mind(?= ?,)"
    rf"|i['’]d like you to|let['’]s|do not forget to"
    rf"|{_SUBJECT}(?: (?:should|must|can|will|(?:need|have|has|needs)(?: to)?|['’]ll|then|now|first|also))*"
    rf"|(?!{_NO_MANNER})[a-z]{{3,}}ly)\b[\s,:]*)+",
    re.IGNORECASE,
)
_WORD = re.compile(r"[A-Za-z][A-Za-z'’-]*")
_NO_ACT = frozenset((
    "be", "is", "are", "was", "were", "been", "can", "could", "may", "might", "must", "shall", "should", "will",
    "would", "need", "needs", "make", "sure", "note", "remember", "ensure", "mind", "beware", "try", "keep", "hope",
    "let", "thank", "sorry", "like", "enjoy", "it", "this", "that", "these", "those", "there", "here", "no", "not",
    "we",
))  # fmt: skip
"""Beginnings of explanations, such as `Make sure`, `Note`, `It is`, though some are verbs."""

_STRONG = re.compile(rf"{CHAIN.pattern}|\s*(?:>>|;)\s*|\s+>\s+|,?\s+(?:and\s+)?then\s+", re.IGNORECASE)
"""Separators of steps in a line, and nothing else."""

_LOOSE = tuple(map(re.compile, (r"\s+/{1,2}\s+", r"\s*[•·∧|]\s*", r"\s+&&\s+", r"\s+[-–—]{1,2}\s+")))
"""Separators of steps in a line, but only where each part is one."""

_WEAK = re.compile(r"\s*,\s*(?:and\s+)?(?:finally\s+)?|\s+(?:and|&{1,2}|\+)\s+(?:finally\s+)?", re.IGNORECASE)
_SENTENCES = re.compile(r"(?<=[a-z)][.!])\s+(?=[A-Z])")
_WHOLE = 2 / 3


def is_order(text: str) -> bool:
    """Return whether words below a step ask for one more, and do not say how it is done."""
    return _PLAIN.fullmatch(text) is not None and is_like_step(text) and not _HOW.match(text)


_FIRST_OF_DUTY = re.compile(
    r"(?:make|be|ensure|see|remember|do|don|never|try|want|need|it|the|your|am|are|let)\b", re.IGNORECASE
)
_DUTY = re.compile(
    r"(?:(?:(?:make|be) (?:sure|certain)|ensure|see to it)(?: that)? (?:you|we)|(?:make|be) (?:sure|certain) to"
    r"|remember to|(?:do not|don['’]t|never) forget to|(?:try|want|need|(?:am|are) going) to|let us"
    r"|(?:want|need) you to|it(?:['’]s| is) (?:important|necessary|best|good|time) to"
    r"|(?:the|your) (?:next|first|last|final) (?:thing|step|task|job)(?: to do)? is to)\s+"
    r"(?!(?:do not|don['’]t|never|not|are|have)\b)(?=[a-z])",
    re.IGNORECASE,
)
"""Words that ask for the step behind them, `Make sure you close the fridge`."""

_PLAIN = re.compile(r"[\w,.'’-]+(?: [\w,.'’-]+){0,8}")
_HOW = re.compile(
    r"(?:use|using|set|check|repeat|continue|allow|leave|avoid|wait|hold|choose|consider|look for"
    r"|make sure|be sure|ensure|remember|try)\b",
    re.IGNORECASE,
)


@recognized_cache(maxsize=65_536)
def is_like_step(text: str) -> bool:
    """Return whether words begin as a step does, with a verb that somebody does or is asked to do."""
    lead = _LEAD.match(text)
    word = _WORD.match(text, lead.end() if lead and lead.end() < len(text) else 0)
    if not word:
        return False
    if _FIRST_OF_DUTY.match(word[0]) and (duty := _DUTY.match(text, word.start())):
        return is_like_step(text[duty.end() :])
    first, second = word[0].lower(), text[word.end() :].split(maxsplit=1)[:1]
    if first == "make" and second != ["sure"]:
        return True
    return first not in _NO_ACT and (is_verb(first) or _is_ours(first) or _is_misspelled_verb(first))


def _is_ours(word: str) -> bool:
    """Return whether a word begins an action as Hearth says it, which the lexicon may not have as a verb: `texts`."""
    return not _beginnings(recognition()).isdisjoint((word, word.removesuffix("s")))


@lru_cache(maxsize=8)
def _beginnings(known: Knowledge) -> frozenset[str]:
    """Return the words with which actions begin."""
    said = (words for action in known.actions.values() for words in (action.template, *action.words))
    return frozenset(words.split()[0].lower() for words in said)


def _is_misspelled_verb(word: str) -> bool:
    """Return whether a word that English lacks is near a verb of actions."""
    if len(word) < _SHORTEST or is_noun(word) or not word.isascii():
        return False
    return any(map(_is_ours, near_words(recognition(), word)))


_SHORTEST = 4


def chained(text: str) -> list[str]:
    """Return the steps of a line that joins several; none where it does not."""
    strong = chained_strongly(text)
    if strong:
        return strong
    weak = [part for part in _WEAK.split(text) if part.strip()]
    is_chain = len(weak) > 2 and all(" " in part.strip() for part in weak[:-1]) and _are_steps(weak)
    return weak if is_chain else []


def chained_strongly(text: str) -> list[str]:
    """Return the steps that `->`, `;` or `then` join, or `/` and `|` if all are; none where nothing does."""
    parts = [part for part in _STRONG.split(text) if part.strip()]
    if len(parts) > 1 and _are_steps(parts):
        return parts
    return next((found for joint in _LOOSE if (found := _joined_by(joint, text))), [])


def _joined_by(joint: re.Pattern[str], text: str) -> list[str]:
    parts = [part for part in joint.split(text) if part.strip()]
    fewest = 3 if joint is _LOOSE[-1] else 2  # what stands behind one dash may explain
    return parts if len(parts) >= fewest and all(map(_is_whole, parts)) else []


def _is_whole(part: str) -> bool:
    alone = recognition().action(part.strip())
    is_act = alone is not None and alone.arity == 0
    return is_act or (" " in part and is_like_step(part)) or bool(operator_step(part))


def clauses(text: str) -> list[str]:
    """Return the parts of a line at all that may join steps, where each begins as a step does; else none."""
    parts = [part for piece in sentences(text) for strong in _STRONG.split(piece) for part in _WEAK.split(strong)]
    parts = [part.strip() for part in parts if part.strip()]
    return parts if len(parts) > 1 and all(map(is_like_step, parts)) else []


def sentences(text: str) -> list[str]:
    """Return the sentences of a line."""
    return _SENTENCES.split(text)


def are_steps(texts: Sequence[str]) -> bool:
    """Return whether lines without marks are steps: two of three at least begin as one does, or join several."""
    like = sum(is_like_step(text) or bool(chained(text)) for text in texts)
    joined = any(
        len(sentences(text)) > 1 or len(parts := chained(text)) > 2 or (parts and text[-1] != ".") for text in texts
    )
    return like >= _WHOLE * len(texts) and (like > 1 or (like == 1 and joined))


def is_title(text: str, below: Sequence[str], is_apart: bool) -> bool:
    """Return whether the first of some plain lines is their title, and no step.

    Args:
        text: the line.
        below: the lines below it, which are steps.
        is_apart: whether a blank line stands below it.
    """
    if not below or chained(text) or len(text) > 80 or _are_sentences_of_steps(text):
        return False
    if len(below) == 1 and is_like_step(text):
        return len(sentences(below[0])) > 1 or bool(chained(below[0])) or _is_above_one(text, below[0], is_apart)
    if goes_there(text, below):
        return False
    if is_gerund(text) and not all(map(is_gerund, below)):
        return True
    if is_apart or text.endswith(":") or not is_like_step(text) or (" " not in text and is_noun(text.lower())):
        return True
    ends = sum(line.endswith((".", "!")) for line in below)
    if ends >= _WHOLE * len(below):
        return not is_sentence(text)
    return len(below) > 1 and text[:1].isupper() and all(line[:1].islower() for line in below)


def _are_sentences_of_steps(text: str) -> bool:
    parts = sentences(text)
    return len(parts) > 1 and all(map(is_like_step, parts))


_FEW = 4


def names_task(line: PlanLine) -> bool:
    """Return whether a plain line is a short order, as titles of tasks are: `Do the dishes`."""
    text = line.text
    is_short = len(text.split()) <= _FEW and not is_sentence(text)
    return is_short and line.number is None and not line.heading and (is_like_step(text) or is_gerund(text))


def _is_above_one(text: str, below: str, is_apart: bool) -> bool:
    """Return whether a line that asks for something is the title of one step: it ends as none does, or means none."""
    if is_sentence(text) or not reads_as_step(below):
        return False
    return not reads_as_step(text) or (is_apart and is_sentence(below))


@recognized_cache(maxsize=4096)
def reads_as_step(text: str) -> bool:
    """Return whether a line reads exactly as a step about known things."""
    known = recognition()
    return any(all(map(known.object_class, names)) for _, names in parses(known, text))


def is_sure_step(text: str) -> bool:
    """Return whether a line alone is a step, `Grab the milk`, or several, `Put the milk in the fridge and close it`."""
    first, *more = _AND.split(text)
    return reads_as_step(text) or (bool(more) and reads_as_step(first) and all(map(is_like_step, more)))


_AND = re.compile(r",? (?:and then|and|then) ", re.IGNORECASE)


def _are_steps(parts: Sequence[str]) -> bool:
    return sum(map(is_like_step, parts)) >= _WHOLE * len(parts)
