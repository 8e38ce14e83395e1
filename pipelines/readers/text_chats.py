"""Chats as plain text, `User: ...` above `Assistant: ...`, in which requests correct answers: the last answer counts.

They are read as chats in JSON are, by the same rules. A text in which no request corrects an answer has other readers.
"""

import re
from collections.abc import Iterable, Iterator, Sequence
from typing import Any, NamedTuple

from hearth.kb.language.plan_lines import RULE, plan_line
from hearth.pipelines.readers import json_records
from hearth.pipelines.readers.chat_titles_from_requests import corrects, rejects
from hearth.pipelines.readers.model_outputs import holds_orders
from hearth.pipelines.readers.reader_items import Item, lines
from hearth.pipelines.readers.texts_with_positions import text_at
from hearth.schemas.program_boundaries import TITLE
from hearth.storage.archives import Place, size_of

NAME = "text chats"

LARGEST = 4_000_000
"""Bytes of a text at most in which chats are looked for."""

_ASKS = (
    r"user|human|q(?:uestion)?\s?\d{0,3}|you|me|customer|client|owner|operator|person|prompt|instruction|request"
    r"|participant|speaker 1"
)
_ANSWERS = (
    r"assistant|ai(?: assistant)?|a(?:nswer)?\s?\d{0,3}|bot|chatbot|robot|agent|model|planner|helper|response|reply"
    r"|(?:chat)?gpt(?:[ -][\w.]{1,8})?|llm|claude|gemini|llama|copilot|mistral|speaker 2"
)
_SPEAKER = rf"(?:(?P<asks>{_ASKS})|(?P<answers>{_ANSWERS})|(?P<system>system))"
_LABEL = re.compile(
    rf"[\s>]*(?:[-*•]\s+)?(?:\[[\d:. apm]{{4,12}}\]\s*)?"
    rf"(?:(?:\#{{1,6}}\s*|[*_]{{1,3}}|\[|<\|im_start\|>)?{_SPEAKER}(?:\s+said|\s*\([^()\n]{{1,30}}\))?[*_\]]{{0,3}}\s*:[*_]{{0,3}}"
    rf"|(?:\#{{1,6}}\s*|\*\*|<\|im_start\|>){_SPEAKER.replace('P<', 'P<only_')}(?:\*\*)?\s*$)[^\S\n]*",
    re.IGNORECASE,
)
"""The name of a speaker at the beginning of a line, with a colon, or alone where a mark stands before it."""

_END = re.compile(r"\s*<\|im_end\|>\s*$")


class _Row(NamedTuple):
    """A line of a turn: its number, the speaker before its text, and the text."""

    number: int
    speaker: str
    text: str


class _Turn(NamedTuple):
    """The words of a speaker, on lines that may all begin with the name of the speaker."""

    role: str
    rows: list[_Row]

    @property
    def line(self) -> int:
        """Return the number of the first line."""
        return self.rows[0].number if self.rows else 1

    def message(self) -> dict[str, Any]:
        """Return the turn as a message of a chat, whose text knows its place."""
        said = [n for n, row in enumerate(self.rows) if row.text.strip() and (not n or not RULE.match(row.text))]
        if not said:
            return {"role": self.role, "content": ""}
        first, *others = self.rows[said[0] : said[-1] + 1]
        text = "\n".join([first.text, *(row.text for row in others)])
        raw = "\n".join([first.text, *(row.speaker + row.text for row in others)])
        speakers = sorted({row.speaker for row in others if row.speaker})
        unit = f"\n(?:{'|'.join(map(re.escape, reversed(speakers)))})?" if speakers else ""
        return {"role": self.role, "content": text_at(text, first.number, len(first.speaker) + 1, raw, unit)}


def is_chat(path: Place, first: Sequence[str]) -> bool:
    """Return whether a text is a chat in which a request corrects an answer, or whose answers begin with a number.

    Args:
        path: the text.
        first: its first lines, by which most texts are known to be none.
    """
    return _may_be_chat(first) and size_of(path) <= LARGEST and _is_chat(_turns(line for line, _ in lines(path)))


def _may_be_chat(first: Sequence[str]) -> bool:
    return {"user", "assistant"} <= {_role(found) for line in first if (found := _LABEL.match(line))}


def _is_chat(turns: Iterable[_Turn]) -> bool:
    spoken = [turn for turn in turns if turn.role not in ("system", "above")]
    messages = [turn.message() for turn in spoken]
    if [turn.role for turn in spoken[:2]] != ["user", "assistant"] or holds_orders(messages):
        return False
    asked = [str(each["content"]) for at, each in enumerate(messages) if each["role"] == "user" and at]
    numbered = [turn for turn in spoken if turn.role == "assistant" and plan_line(turn.rows[0].text).numbered]
    return any(map(rejects, asked)) or len(numbered) > 1


def scan(path: Place, place: str) -> Iterator[Item]:
    """Yield the item of each chat: one begins with a request that is about no answer before it."""
    yield from _items((line for line, _ in lines(path)), place)


def items_in(text: str) -> list[Item]:
    """Return the items of the chats in a text; empty for a text of another kind."""
    rows = text.split("\n")
    return [*_items(rows, "")] if _may_be_chat(rows) and _is_chat(_turns(rows)) else []


def _items(rows: Iterable[str], place: str) -> Iterator[Item]:
    for line, chat in _chats(rows):
        yield from json_records.items(chat, place, line, f"{place}:{line}", {})


def _chats(rows: Iterable[str]) -> Iterator[tuple[int, dict[str, Any]]]:
    chat: list[_Turn] = []
    for turn in _turns(rows):
        is_answered = any(each.role == "assistant" for each in chat)
        if turn.role == "user" and is_answered and not corrects(str(turn.message()["content"])):
            yield chat[0].line, _record(chat)
            chat = []
        chat.append(turn)
    if chat:
        yield chat[0].line, _record(chat)


def _record(chat: Sequence[_Turn]) -> dict[str, Any]:
    """Return a chat as a record, with the title that stands above its first turn."""
    above = [text for turn in chat if turn.role == "above" for _, _, text in turn.rows]
    title = next((TITLE.sub("", line.text, count=1) for line in map(plan_line, above) if TITLE.match(line.text)), "")
    messages = [turn.message() for turn in chat if turn.role != "above"]
    return {"title": title, "messages": messages} if title else {"messages": messages}


def _turns(rows: Iterable[str]) -> Iterator[_Turn]:
    """Yield the turns of a text; the lines above the first are one, too."""
    turn = _Turn("above", [])
    for number, line in enumerate(rows, 1):
        found = _LABEL.match(line)
        role = _role(found) if found else turn.role
        if role != turn.role:
            if turn.role != "above" or any(row.text.strip() for row in turn.rows):
                yield turn
            turn = _Turn(role, [])
        at = found.end() if found else 0
        turn.rows.append(_Row(number, line[:at], _END.sub("", line[at:])))
    yield turn


def _role(found: re.Match[str]) -> str:
    if found["asks"] or found["only_asks"]:
        return "user"
    return "assistant" if found["answers"] or found["only_answers"] else "system"
