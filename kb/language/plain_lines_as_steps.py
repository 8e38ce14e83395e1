"""Plain lines that are steps where no line of a text has a mark: the lines below a title, or the sentences of prose."""

import re

from hearth.kb.language.forms.form import Placed
from hearth.kb.language.plan_lines import META, PlanLine
from hearth.kb.language.prose import Sentence, goes_on, is_farewell, is_greeting, is_prose, sentences_of
from hearth.kb.language.step_like_lines import (
    are_steps,
    chained,
    is_like_step,
    is_sure_step,
    is_title,
    reads_as_step,
    sentences,
)
from hearth.kb.language.title_marks import doubted
from hearth.schemas.program_boundaries import is_sentence

_SIGNED = 3
"""Lines below the end of a letter that are not its name any more."""


def marked(placed: list[Placed]) -> list[Placed]:
    """Mark the plain lines that are steps, where no line of the text has a mark."""
    if any(line.number is not None for _, line in placed):
        return placed
    plain = [n for n, (_, line) in enumerate(placed) if line.text and _is_plain(line)]
    named = next((n for n, (_, line) in enumerate(placed) if line.heading and not _is_plain(line)), -1)
    is_titled, plain = named >= 0, [n for n in plain if n > named]
    plain = _without_greetings(placed, plain)
    if plain and not is_titled:
        top, texts = plain[0], [placed[n].line.text for n in plain]
        is_apart = top + 1 < len(placed) and not placed[top + 1].line.text
        is_titled = is_title(texts[0], texts[1:], is_apart) and not (texts[1:] and goes_on(texts[0], texts[1]))
        plain = _without_description(placed, plain[1:]) if is_titled else plain
    prose = [(n, placed[n].line.text) for n in plain]
    if is_prose(prose):
        return _as_sentences(placed, plain, sentences_of(prose))
    texts = [_after_label(placed[n].line.text) for n in plain]
    is_below_title = is_titled and len(texts) == 1 and _is_order(texts[0], placed[plain[0]])
    if not (are_steps(texts) or is_below_title or _is_only_step(placed, texts)):
        return placed
    for n, why in doubted(placed, plain):
        placed = [*placed[:n], Placed(placed[n].row, placed[n].line._replace(why=why)), *placed[n + 1 :]]
    steps = {n for n, text in zip(plain, texts, strict=True) if is_like_step(text) or chained(text)}
    return [part for n, each in enumerate(placed) for part in (_steps_on(each) if n in steps else [each])]


def _without_description(placed: list[Placed], plain: list[int]) -> list[int]:
    """Leave out sentences between a title and a blank line, where the lines below that are none: they describe."""
    gaps = (n for n in range(1, len(plain)) if any(not placed[k].line.text for k in range(plain[n - 1], plain[n])))
    gap = next(gaps, 0)
    above, below = ([placed[n].line.text for n in part] for part in (plain[:gap], plain[gap:]))
    describes = len(below) > 1 and all(map(is_sentence, above)) and not any(map(is_sentence, below))
    return plain[gap:] if describes else plain


def _without_greetings(placed: list[Placed], plain: list[int]) -> list[int]:
    """Leave out how a letter begins, and how it ends with the name below."""
    end = next((n for n in plain if n and is_farewell(placed[n].line.text)), len(placed))
    is_end = sum(n > end for n in plain) < _SIGNED
    return [n for n in plain if not is_greeting(placed[n].line.text) and (n < end or not is_end)]


def _as_sentences(placed: list[Placed], plain: list[int], parts: list[Sentence]) -> list[Placed]:
    """Return lines of prose as its sentences, which are steps."""
    found: list[Placed] = []
    for n, each in enumerate(placed):
        here = [sentence.text for sentence in parts if sentence.row == n]
        found += [Placed(each.row, PlanLine(text, 0, prose=True)) for text in here]
        found += [] if here or n in plain or is_greeting(each.line.text) else [each]
    return found


def _is_plain(line: PlanLine) -> bool:
    """Return whether a line without a mark may be a step: titles may not, but `Plan: walk to sofa` may be."""
    return not META.match(line.text) and (not line.heading or _LABEL.match(line.text) is not None)


_LABEL = re.compile(
    r"(?:plan|steps|answer|actions?|action sequence|sequence|procedure|instructions|method|solution|program)\s*[:=]\s*",
    re.IGNORECASE,
)
"""Words before the steps of a line, `Plan: walk to sofa; sit on sofa`."""


def _after_label(text: str) -> str:
    return _LABEL.sub("", text, count=1)


def _is_order(text: str, placed: Placed) -> bool:
    """Return whether the one line below a title is a step, and not its description."""
    return text != placed.line.text or (is_like_step(text) and (not is_sentence(text) or reads_as_step(text)))


def _is_only_step(placed: list[Placed], texts: list[str]) -> bool:
    """Return whether the only line of a text is a step, `Grab the milk`, and not a title whose steps are missing."""
    return len(texts) == sum(bool(line.text) for _, line in placed) == 1 and is_sure_step(texts[0])


def _steps_on(placed: Placed) -> list[Placed]:
    """Return a line as steps: the sentences of prose, else the whole line."""
    text = _after_label(placed.line.text)
    parts = sentences(text)
    return [Placed(placed.row, PlanLine(part, 0, prose=len(parts) > 1, why=placed.line.why)) for part in parts]
