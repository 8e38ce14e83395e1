"""The lines of a plan as language models write it: Markdown undone, and each line a step, a heading or plain text."""

import html
import re
from collections.abc import Sequence
from typing import NamedTuple

from hearth.kb.language.recognition_knowledge import recognized_cache
from hearth.kb.language.refusals import Refusal
from hearth.kb.language.titles_of_requests import asked_title
from hearth.schemas.program_boundaries import TITLE, is_sentence

_COUNTED = (
    ["one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven", "twelve"],
    ["first", "second", "third", "fourth", "fifth", "sixth", "seventh", "eighth", "ninth", "tenth"],
)
_ONE, _FIRST = ("|".join(words) for words in _COUNTED)
_COUNTS = {word: number for words in _COUNTED for number, word in enumerate(words, 1)}
_NUMBER = (
    rf"(?:(?:step|schritt|paso|étape)\s*#?\s*\d{{1,4}}\s*[.:)\]–—=-]?|[(\[]?\d{{1,4}}\s*[.:)\]]|#\d{{1,3}}[.:)]?"
    rf"|\d{{1,3}}\s+[–—-])(?=\s|\*)|step\s*\d{{1,4}}\s*[=:]|\d{{1,3}}[.)](?=[a-z])"
    rf"|step\s+(?:{_ONE})\s*[.:)–—-]|(?:step\s+)(?:{_FIRST})(?:ly)?\s*[,:](?=\s)"
)
_ITEM = r"\(?(?:[a-z]|[ivx]{2,5})[.)](?=\s)|\d{1,3}(?:\.\d{1,3})+[.:)]?(?=\s)"
"""Letters, roman numerals and `1.2`: the items of a list without a number that counts its steps."""

_NUMBERED = re.compile(
    rf"(?:[-*+•–—]\s+)?(?:(?P<number>{_NUMBER})\s*|(?:{_ITEM})\s+)(?=\S)|[-*+•–—]\s+(?=\S)", re.IGNORECASE
)
_PLAIN = re.compile(r"([ \t]*)(?:[Ss]tep )?(\d{1,4})[.:)] +([A-Za-z][A-Za-z0-9 ,.;()'-]*)")
"""A numbered step of plain words, of which nothing has to be undone."""

_TIME = r"(?:[01]?\d|2[0-3])(?:[:.][0-5]\d(?:\s*[ap]m\b)?|\s?[ap]m\b)"
_MARKER = re.compile(
    r"(?:[\u2190-\u21ff\u2500-\u2604\u2606-\u2617\u2705\u2713-\u2718\u2794-\u27bf\u2b00-\u2bff"
    r"\U0001f446-\U0001f449\U0001f518\U0001f532-\U0001f53d\U0001f7e0-\U0001f7ff·◦‣⁃∙▪]\ufe0f?\s*)+(?=\S)"
    rf"|\\item\b(?:\[[^\]]*\])?\s*(?=\S)|(?:at\s+)?{_TIME}(?:\s*[–—-]\s*{_TIME})?\s*[:–—-]?\s+(?=[a-z])|\+\s+(?=[a-z])|@[\w-]+[:,]?\s+(?=[a-z])",
    re.IGNORECASE,
)
"""Marks before a step without a number: a symbol, LaTeX's `\\item`, a time of day, `Finally,`."""

_HTML = re.compile(
    r"\s*</?(?:ol|ul|li|p|div|h[1-6]|b|i|strong|em|br|html|body|span|title|head|meta|!doctype)\b[^<>]*>", re.IGNORECASE
)
_NEXT_ITEM = re.compile(r"</(li|step|action|instruction)>\s*<\1\b[^<>]*>", re.IGNORECASE)
_TAGS = re.compile(
    r"</?(?:ol|ul|li|p|div|h[1-6]|b|i|strong|em|br|html|body|span|title|head|meta|!doctype)\b[^<>]*>", re.IGNORECASE
)
_XML_STEP = re.compile(r"\s*<(step|action|instruction)\b[^<>]*>\s*([^<>]*[^<>\s])\s*</\1>\s*", re.IGNORECASE)
_ELEMENT = r"(?:steps?|plans?|tasks?|programs?|actions?|activity|sequence|root)"
_XML_NAMED = re.compile(
    rf"\s*<{_ELEMENT}\b[^<>]*?\b(?:task|title|name|goal)=[\"']([^\"'<>]+)[\"'][^<>]*>\s*",
    re.IGNORECASE,
)
_XML = re.compile(
    rf"\s*</?{_ELEMENT}\b[^<>]*>\s*|\s*<\?xml\b.*|\s*</[A-Za-z][\w:.-]*>\s*|\s*<[A-Za-z][\w:.-]*(?:\s[^<>]*=[^<>]*)?(?<!/)>\s*",
    re.IGNORECASE,
)
_WHOLE = re.compile(
    r"\s*<(plan|steps|actions|program|answer|output|response|result)>(?P<said>.*)</\1>\s*", re.IGNORECASE
)
_LATEX = re.compile(r"\s*\\(?:(?:sub)*section|title|paragraph)\*?\{([^{}]*)\}\s*|\s*\\(?:begin|end)\{\w+\*?\}.*")
_BOLD = re.compile(r"\s*(?:\*\*|__)(?!\s)([^*_:]+)(?:\*\*|__)\s*:?\s*")
_ASIDE = re.compile(
    r"\W*(?:(?:some |a few |helpful |extra |safety )?(?:notes?|tips?|hints?|ingredients?|materials?|tools?|equipment"
    r"|warnings?|summary|explanations?|safety|requirements?|supplies|variations?|what you need|you will need|reasoning"
    r"|assumptions?|preconditions?|remarks?|comments?|instructions|steps|plan|actions?|objects?|goal))\b\W*",
    re.IGNORECASE,
)
"""Headings inside a plan, which are no title."""

_SYMBOLS = re.compile(r"(?:[^\w\s\[\]<>(){}|*+•'\"’“‘…–-])+\s*")
_KEYCAP = str.maketrans({"\ufe0f": "", "\u20e3": "."})
BRACKETED = re.compile(r"(?:<[^<>]*>\s*)?\[\s*[a-z]", re.IGNORECASE)
"""The beginning of a step in the syntax of programs."""

LOOSE = re.compile(r"\s*\[\s*([A-Za-z][A-Za-z _-]*?)\s*\]\s+([A-Za-z][\w .'-]*?)\s*")
"""A step that lacks the marks of its object, `[grab] milk`."""

_DIGITS = re.compile(r"\d+")
_CHECKBOX = re.compile(r"\[[ xX]\]\s+(?:\d{4}-\d\d-\d\d\s+){0,2}(?:@[\w-]+:?\s+)?")

_LAYOUT = re.compile(
    r"\s*(?:`{3}|~{3}|(?:[-*_=]\s*){3,}$|//|<!--.*-->\s*$|@(?:start|end)uml\b|<\|im_start\|>\w*\s*$|(?:BEGIN|START)\s*$)"
)
"""A line that begins or ends a code block, a horizontal rule, or a comment."""

RULE = re.compile(r"\s*(?:[-*_=]\s*){3,}$")
"""A horizontal rule."""

META = re.compile(
    r"(?:scene|author|difficulty|date|version|env(?:ironment)?|id|source|model|category|tags?|duration|rating|level"
    r"|language|seed|explanation|reasoning)\s*:\s*\S",
    re.IGNORECASE,
)
"""Remarks about a program, which are neither its title nor a step."""

_INLINE = re.compile(r"(?:^|(?<=\s))(?:0[.)]\s+\S.*?\s1|1[.)]\s+\S.*?\s2)[.)]\s+\S")
"""The beginning of numbered steps on one line: `Plan: 1. walk to kitchen 2. open fridge`."""

CHAIN = re.compile(r"\s*(?:-{1,3}>|={1,2}>|[→⟶➔➡⇒⟹➜➝])\s*")
"""Separators of the steps of a line: `walk to kitchen -> open fridge`."""

TAGS = re.compile(r"(?:\s+(?:[+@#][a-z][\w-]*|[a-z]{1,10}:\d[\w-]*|pri:[a-z]))+$", re.IGNORECASE)
"""Projects, people, topics and days behind an item of a list, `+home due:2026-11-05`."""

_LABELLED = re.compile(
    r"^(?!task|title|goal|plan|step)[A-Za-z]{1,12}(?: [A-Za-z]{1,12})?:\s+(?=[01][.)]\s+\S)", re.IGNORECASE
)
"""The name of the speaker before the first step of a list: `Robot: 1. walk to desk`."""

_QUOTE = re.compile(r"\s*(?:>\s?)+")
COMMENT = re.compile(r"\s+(?://|#)\s+\S.*$")
"""A remark behind a step, after `//` or `#`."""

_HEADING = re.compile(r"\s*#{1,6}\s+(?=\S)")
_EMPHASIS = re.compile(r"<br\s*/?>|\*{1,3}(?=\S)|(?<=\S)\*{1,3}|`+|(?<!\w)_{1,3}(?=\S)|(?<=\S)_{1,3}(?!\w)")
_ANSWER = re.compile(
    r"(?:sure|certainly|of course|okay|ok|absolutely|here(?:['’]s| is| are| you go| we go))\b", re.IGNORECASE
)
_ASKED = re.compile(r".*\b(?:plan|steps|program|guide|instructions|how)\s+(?:for|to)\s*:?\s+(\S.*)", re.IGNORECASE)
_USUAL = re.compile(
    r"(?:steps|plan|instructions|program|procedure|method|directions|step-by-step plan):?", re.IGNORECASE
)
"""Headings that every plan may have, and so are not its title."""


_EXPLAINED = re.compile(r" ?[(–—]| - |:(?= |$)|\. (?=[A-Z])")


_PROMPT = re.compile(r"^\s*(?:>>>|In \[\d+\]:)\s+")
_UNSEEN = re.compile(
    r"\x1b\[[0-9;]*[A-Za-z]|\[/?INST\]|</?s>|<\|im_start\|>(?=\S+\s+\S)|<\|(?!im_start)[a-z_]+\|>|[\u200b\u200c\u2060\ufeff\u00ad]"
)
"""Colors of terminals, marks of chats between texts, and characters without width."""

_HTML_ROW = re.compile(r"\s*(?:<t(?:able|body|head)\b[^>]*>\s*)*<tr\b[^>]*>\s*<t[dh]\b", re.IGNORECASE)
_HTML_CELLS = re.compile(r"(?:\s*</?(?:table|tbody|thead|tr|td|th)\b[^>]*>)+\s*", re.IGNORECASE)
_HTML_TABLE = re.compile(r"\s*(?:</?(?:table|tbody|thead|tr)\b[^>]*>\s*)+", re.IGNORECASE)
_ENTITY = re.compile(r"&(?:[a-z]+|#\d+|#x[0-9a-f]+);", re.IGNORECASE)
_WIDE = str.maketrans({chr(0xFF01 + n): chr(0x21 + n) for n in range(94)})
_CIRCLED = {chr(0x2460 + n): f"{n + 1}. " for n in range(20)}
_ODD = re.compile(r">>> |\[/?INST|</?s>|<\||<t|</t|[&\x1b\u2460-\u2473\uff01-\uff5e\u200b\u200c\u2060\ufeff\u00ad]")


def cleaned(raw: str) -> str:
    """Return a line without what no reader sees, and with entities, wide and circled characters as usual ones."""
    if not _ODD.search(raw):
        return raw
    if _HTML_ROW.match(raw):
        raw = _HTML_CELLS.sub("|", raw)
    elif _HTML_TABLE.fullmatch(raw):
        return ""
    text = _PROMPT.sub("", _UNSEEN.sub("", raw), count=1)
    text = _ENTITY.sub(lambda found: " ".join(html.unescape(found[0]).split()) or " ", text) if "&" in text else text
    text = text.translate(_WIDE)
    first = text.lstrip()[:1]
    return text.replace(first, _CIRCLED[first], 1) if first in _CIRCLED else text


class PlanLine(NamedTuple):
    """A line without its Markdown.

    Attributes:
        text: the line, or a step's words.
        number: a step's number, 0 if it has none; None if the line is not a step.
        indent: characters before it.
        heading: whether Markdown marks it as a heading, or `Task:` does.
        numbered: whether the line has a number, which may be 0.
        prose: whether it is a sentence of several on a line, which nothing marks as a step.
        why: why it is refused, and with it the plan.
    """

    text: str
    number: int | None = None
    indent: int = 0
    heading: bool = False
    numbered: bool = False
    prose: bool = False
    why: Refusal | None = None

    @property
    def bracketed(self) -> bool:
        """Return whether it is a step in the syntax of programs, `[Walk] <kitchen> (1)`."""
        return self.number is not None and BRACKETED.match(self.text) is not None


def plan_line(raw: str) -> PlanLine:
    """Read a line; one of layout alone, or a heading such as `Steps:`, is empty."""
    return _short_line(raw) if len(raw) <= _SHORT else _line(raw)


_SHORT = 200
"""Characters of a line that is remembered: a file is read several times, and plans say the same again and again."""


@recognized_cache(maxsize=16_384)
def _short_line(raw: str) -> PlanLine:
    return _line(raw)


def _line(raw: str) -> PlanLine:
    plain = _PLAIN.fullmatch(raw)
    if plain:  # as most lines are: without what Markdown could mean
        return PlanLine(" ".join(plain[3].split()), int(plain[2]), len(plain[1]), numbered=True)
    raw = cleaned(raw)
    if _LAYOUT.match(raw):
        return PlanLine("")
    quote = _QUOTE.match(raw)
    line = raw[quote.end() :] if quote else raw
    if line.lstrip().startswith(("<", "\\")):
        line = _unmarked_up(line)
    indent = len(line) - len(line.lstrip())
    marked = _HEADING.match(line)
    text = " ".join(_EMPHASIS.sub("", line[marked.end() :].rstrip("# ") if marked else line).split())
    text = text.translate(_KEYCAP)
    text = _LABELLED.sub("", text, count=1)
    marker = _MARKER.match(text) if not marked else None
    text = text[marker.end() :] if marker else text
    step = _NUMBERED.match(text)
    symbols = _SYMBOLS.match(text) if not step else None
    text = text[symbols.end() :] if symbols else text
    step = step or _NUMBERED.match(text)
    if step and TITLE.match(text[step.end() :]) and not step["number"]:
        return PlanLine(text[step.end() :], None, indent, True)
    if marker and not step:
        return PlanLine(_CHECKBOX.sub("", text, count=1), 0, indent)
    if step:
        words = _unquoted(TAGS.sub("", COMMENT.sub("", _CHECKBOX.sub("", text[step.end() :], count=1))))
        digits = _DIGITS.search(step["number"] or "")
        number = (
            int(digits[0])
            if digits
            else _COUNTS.get((step["number"] or "").lower().strip(" .,:step").removesuffix("ly"), 0)
        )
        is_numbered = step["number"] is not None
        return PlanLine(words, number, indent, marked is not None, is_numbered)
    box = _CHECKBOX.match(text)
    if box:
        return PlanLine(text[box.end() :], 0, indent)
    if _USUAL.fullmatch(text):
        return PlanLine("")
    inline = _INLINE.search(text)
    if inline:
        first = text[inline.start() :]
        return PlanLine(first[2:].lstrip(), int(first[0]), indent, numbered=True)
    if not marked and not BRACKETED.match(text) and CHAIN.search(text):
        return PlanLine(TITLE.sub("", text, count=1), 0, indent)
    is_bold = _BOLD.fullmatch(line) is not None and _ASIDE.fullmatch(text) is None and not is_sentence(text)
    heading = marked is not None or TITLE.match(text) is not None or is_bold
    return PlanLine(text, 0 if BRACKETED.match(text) else None, indent, heading)


def _unquoted(words: str) -> str:
    """Return a step without the quotation marks around it."""
    whole = words.rstrip(".,;")
    is_quoted = whole[:1] in _OPENING and whole[-1:] in _CLOSING and len(whole) > 2
    return whole[1:-1].strip() if is_quoted and not any(mark in whole[1:-1] for mark in '"“”') else words


_OPENING, _CLOSING = tuple("\"'“‘«„"), tuple("\"'”’»“")


def _unmarked_up(line: str) -> str:
    """Return a line of LaTeX or HTML as Markdown; `<char0> [Walk] ...` is neither."""
    line = _NEXT_ITEM.sub("; ", line)
    if whole := _WHOLE.fullmatch(line):
        return whole["said"].strip()
    if step := _XML_STEP.fullmatch(line):
        return f"- {step[2]}"
    if named := _XML_NAMED.fullmatch(line):
        return f"# {named[1]}"
    if _XML.fullmatch(line):
        return ""
    latex = _LATEX.fullmatch(line)
    if latex:
        return f"# {latex[1]}" if latex[1] else ""
    if not _HTML.match(line):
        return line
    text = _TAGS.sub("", line).strip()
    if re.match(r"\s*<(?:h[1-6]|title)\b", line, re.IGNORECASE):
        return f"# {text}"
    return f"- {text}" if text and re.search(r"<li\b", line, re.IGNORECASE) else text


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
    first; the others are the description. `Here is my plan:` is neither.
    """
    is_ordered = ordered(lines)
    first = next((number for number, line in enumerate(lines) if is_step(line, is_ordered)), len(lines))
    found = tuple(line for line in lines[:first] if line.text)
    return _short_header(found) if sum(len(line.text) for line in found) <= _SHORT else _header(found)


def _header(found: tuple[PlanLine, ...]) -> Header:
    """Return title and description in the lines above the steps."""
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
    above = [line.text for line in found[:at] if not is_said_around(line.text) and not META.match(line.text)]
    title = title if named else asked_title(ROLE.sub("", title, count=1))
    return Header(title, "\n".join([*above, *(line.text for line in found[at + 1 :])]))


_short_header = recognized_cache(maxsize=16_384)(_header)


ROLE = re.compile(r"(?:subject|re|human|user|request|prompt)\s*:\s+(?=\S)", re.IGNORECASE)
"""The word for the person with a request, or for the subject of a letter, before a title."""


def is_aside(text: str) -> bool:
    """Return whether a heading stands inside a plan, as `Tips:`, and names none."""
    return _ASIDE.fullmatch(text) is not None


_OF_BOLD = 7
"""The level of a title in bold, below those of headings."""


def level_of(raw: str) -> int:
    """Return the level of a heading: 1 for `# Title`, 2 for `## Title`; 1 for `Task:`, wherever it stands."""
    if _BOLD.fullmatch(raw):
        return _OF_BOLD
    marked = _HEADING.match(raw)
    if not marked or TITLE.match(raw[marked.end() :]):
        return 1
    return raw[: marked.end()].count("#")


_AROUND = re.compile(
    r"(?:i hope|hope|enjoy|let me know|feel free|would you|do you|is there|good luck|that['’]s (?:it|all)|and that"
    r"|you(?:['’]re| are| have| now)|now you|note that|please note|thanks?|thank you|the (?:plan|task) is|done)\b",
    re.IGNORECASE,
)


def is_said_around(text: str) -> bool:
    """Return whether a line is what a chat says around a plan, as `I hope this helps!`, or a heading inside it."""
    return _AROUND.match(text) is not None or _ANSWER.match(text) is not None or is_aside(text)


def is_answer(line: PlanLine) -> bool:
    """Return whether a line begins a chat's answer, as `Sure! Here is a plan:`."""
    return _ANSWER.match(line.text) is not None


def ordered(lines: Sequence[PlanLine]) -> bool:
    """Return whether a plan has numbered steps; its bullets then only explain them."""
    return any(line.numbered for line in lines)


def is_step(line: PlanLine, is_ordered: bool) -> bool:
    """Return whether a line is a step of its own in a plan that is numbered or not."""
    return (line.numbered or line.bracketed) if is_ordered else line.number is not None


def is_plan(lines: Sequence[str]) -> bool:
    """Return whether a text's first lines are a plan: numbered or bulleted steps, or a program among Markdown."""
    found = list(map(plan_line, lines))
    pairs = zip(found, lines, strict=True)
    written = [raw for line, raw in pairs if line.number == 0 and line.bracketed and BRACKETED.match(raw.strip())]
    if written:
        return all(map(LOOSE.fullmatch, written)) or any(_LAYOUT.match(raw) or _HEADING.match(raw) for raw in lines)
    steps = sum(line.number is not None for line in found)
    last = next((line for line in reversed(found) if line.text), None)
    is_titled = TITLE.match(lines[0]) is not None or (last is not None and last.numbered and found[0].number is None)
    return steps > 1 or (steps == 1 and is_titled)
