"""The lines of a plan as language models write it: Markdown undone, and each line a step, a heading or plain text."""

import re
from collections.abc import Sequence
from typing import NamedTuple

from hearth.schemas.blocks import TITLE, is_sentence

_NUMBER = r"(?:step\s*\d{1,4}\s*[.:)\]–-]?|[(\[]?\d{1,4}\s*[.:)\]])(?=\s|\*)"
_ITEM = r"\(?(?:[a-z]|[ivx]{2,5})[.)](?=\s)|\d{1,3}(?:\.\d{1,3})+[.:)]?(?=\s)"
"""Letters, roman numerals and `1.2`: the items of a list without a number that counts its steps."""

_NUMBERED = re.compile(rf"(?:[-*+•–]\s+)?(?:(?P<number>{_NUMBER})|{_ITEM})\s+(?=\S)|[-*+•–]\s+(?=\S)", re.IGNORECASE)
_PLAIN = re.compile(r"([ \t]*)(?:[Ss]tep )?(\d{1,4})[.:)] +([A-Za-z][A-Za-z0-9 ,.;()'-]*)")
"""A numbered step of plain words, of which nothing has to be undone."""

_SYMBOLS = re.compile(r"(?:[^\w\s\[\]<>(){}|*+•'\"’“‘…–-])+\s*")
_KEYCAP = str.maketrans({"\ufe0f": "", "\u20e3": "."})
_BRACKETED = re.compile(r"(?:<[^<>]*>\s*)?\[\s*[a-z]", re.IGNORECASE)
_DIGITS = re.compile(r"\d+")
_CHECKBOX = re.compile(r"\[[ xX]\]\s+")

_LAYOUT = re.compile(r"\s*(?:`{3}|~{3}|(?:[-*_=]\s*){3,}$|//|<!--.*-->\s*$)")
"""A line that begins or ends a code block, a horizontal rule, or a comment."""

RULE = re.compile(r"\s*(?:[-*_=]\s*){3,}$")
"""A horizontal rule."""

META = re.compile(
    r"(?:scene|author|difficulty|date|version|env(?:ironment)?|id|source|model|category|tags?|duration|rating|level"
    r"|language|seed|explanation|reasoning)\s*:\s*\S",
    re.IGNORECASE,
)
"""What is said about a program, which is neither its title nor a step."""

_INLINE = re.compile(r"(?:^|(?<=\s))(?:0[.)]\s+\S.*?\s1|1[.)]\s+\S.*?\s2)[.)]\s+\S")
"""The beginning of numbered steps on one line: `Plan: 1. walk to kitchen 2. open fridge`."""

CHAIN = re.compile(r"\s*(?:->|=>|→|⟶|➔|➡)\s*")
"""What joins the steps of a line: `walk to kitchen -> open fridge`."""

_QUOTE = re.compile(r"\s*(?:>\s?)+")
_HEADING = re.compile(r"\s*#{1,6}\s+(?=\S)")
_EMPHASIS = re.compile(r"\*{1,3}(?=\S)|(?<=\S)\*{1,3}|`+|(?<!\w)_{1,3}(?=\S)|(?<=\S)_{1,3}(?!\w)")
_ANSWER = re.compile(r"(?:sure|certainly|of course|okay|ok|absolutely|here(?:['’]s| is| are))\b", re.IGNORECASE)
_ASKED = re.compile(r".*\b(?:plan|steps|program|guide|instructions|how)\s+(?:for|to)\s+(\S.*)", re.IGNORECASE)
_USUAL = re.compile(
    r"(?:steps|plan|instructions|program|procedure|method|directions|step-by-step plan):?", re.IGNORECASE
)
"""Headings that every plan may have, and so are not its title."""


_EXPLAINED = re.compile(r" ?[(–—]| - |:(?= |$)|\. (?=[A-Z])")


class PlanLine(NamedTuple):
    """A line without its Markdown.

    Attributes:
        text: the line, or a step's words.
        number: a step's number, 0 if it has none; None if the line is not a step.
        indent: characters before it.
        heading: whether Markdown marks it as a heading, or `Task:` does.
        numbered: whether the line has a number, which may be 0.
    """

    text: str
    number: int | None = None
    indent: int = 0
    heading: bool = False
    numbered: bool = False

    @property
    def bracketed(self) -> bool:
        """Whether it is a step in the syntax of programs, `[Walk] <kitchen> (1)`."""
        return self.number is not None and _BRACKETED.match(self.text) is not None


def plan_line(raw: str) -> PlanLine:
    """Read a line; one of layout alone, or a heading such as `Steps:`, is empty."""
    plain = _PLAIN.fullmatch(raw)
    if plain:  # as most lines are: without what Markdown could mean
        return PlanLine(" ".join(plain[3].split()), int(plain[2]), len(plain[1]), numbered=True)
    if _LAYOUT.match(raw):
        return PlanLine("")
    quote = _QUOTE.match(raw)
    line = raw[quote.end() :] if quote else raw
    indent = len(line) - len(line.lstrip())
    marked = _HEADING.match(line)
    text = " ".join(_EMPHASIS.sub("", line[marked.end() :].rstrip("# ") if marked else line).split())
    symbols = _SYMBOLS.match(text := text.translate(_KEYCAP))
    text = text[symbols.end() :] if symbols else text
    step = _NUMBERED.match(text)
    if step:
        words = _CHECKBOX.sub("", text[step.end() :], count=1)
        digits = _DIGITS.search(step["number"] or "")
        return PlanLine(words, int(digits[0]) if digits else 0, indent, marked is not None, digits is not None)
    if _USUAL.fullmatch(text):
        return PlanLine("")
    inline = _INLINE.search(text)
    if inline:
        first = text[inline.start() :]
        return PlanLine(first[2:].lstrip(), int(first[0]), indent, numbered=True)
    if not marked and not _BRACKETED.match(text) and CHAIN.search(text):
        return PlanLine(TITLE.sub("", text, count=1), 0, indent)
    heading = marked is not None or TITLE.match(text) is not None
    return PlanLine(text, 0 if _BRACKETED.match(text) else None, indent, heading)


def unexplained(words: str) -> str:
    """Return a step's words without the explanation behind them, `Walk to fridge` of `Walk to fridge: it hums`."""
    return _EXPLAINED.split(words, 1)[0]


class Header(NamedTuple):
    """The text above the steps."""

    title: str
    description: str


def header_of(lines: Sequence[PlanLine]) -> Header:
    """Return title and description: the lines before the first step.

    The title is the line after `Task:`, else the first heading, else the first line that is not a sentence, else the
    first; lines before it belong to no description. `Here is my plan:` is not a title.
    """
    is_ordered = ordered(lines)
    first = next((number for number, line in enumerate(lines) if is_step(line, is_ordered)), len(lines))
    found = [line for line in lines[:first] if line.text]
    ranks = [
        (TITLE.match(line.text) is None, not line.heading, bool(META.match(line.text)), is_sentence(line.text), number)
        for number, line in enumerate(found)
    ]
    if not ranks:
        return Header("", "")
    at = min(ranks)[-1]
    line, named = found[at].text, TITLE.match(found[at].text)
    asked = _ASKED.match(line)
    title = line[named.end() :] if named else line
    if not named and META.match(line):
        return Header("", "\n".join(line.text for line in found))
    if not named and _ANSWER.match(line) and (asked or line.endswith((":", "!"))):
        title = asked[1].rstrip(" :.!") if asked else ""
    return Header(title, "\n".join(line.text for line in found[at + 1 :]))


def level_of(raw: str) -> int:
    """Return the level of a heading: 1 for `# Title`, 2 for `## Title`; 1 for `Task:`, wherever it stands."""
    marked = _HEADING.match(raw)
    if not marked or TITLE.match(raw[marked.end() :]):
        return 1
    return raw[: marked.end()].count("#")


def is_answer(line: PlanLine) -> bool:
    """Return whether a line begins a chat's answer, as `Sure! Here is a plan:`."""
    return _ANSWER.match(line.text) is not None


def ordered(lines: Sequence[PlanLine]) -> bool:
    """Whether a plan has numbered steps; its bullets then only explain them."""
    return any(line.numbered for line in lines)


def is_step(line: PlanLine, is_ordered: bool) -> bool:
    """Whether a line is a step of its own in a plan that is numbered or not."""
    return (line.numbered or line.bracketed) if is_ordered else line.number is not None


def is_plan(lines: Sequence[str]) -> bool:
    """Whether a text's first lines are a plan: numbered or bulleted steps, or a program among Markdown."""
    found = list(map(plan_line, lines))
    if any(line.number == 0 and _BRACKETED.match(raw.strip()) for line, raw in zip(found, lines, strict=True)):
        return any(_LAYOUT.match(raw) or _HEADING.match(raw) for raw in lines)
    steps = sum(line.number is not None for line in found)
    return steps > 1 or (steps == 1 and TITLE.match(lines[0]) is not None)
