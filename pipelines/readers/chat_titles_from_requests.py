"""Titles of chats: the request that the last answer is about, whatever was corrected since."""

import re
from collections.abc import Sequence

from hearth.kb.language.titles_of_requests import asked_title
from hearth.schemas.program_boundaries import TITLE

_LONGEST = 200
_CHANGE = r"(?:fix|change|add|remove|redo|use|make (?:it|that)|shorten|skip|replace|revise|try|continue|do (?:it|that))"
_CORRECTS = re.compile(
    r"(?:no|nope|not|wrong|wait|sorry|actually|almost|hmm+|but|ok|okay|yes|yeah|great|good|nice|perfect|thanks?"
    r"|thank you|and|also"
    r"|instead|rather|again|try again|redo|retry|fix|correct|change|replace|remove|add|skip|repeat|continue"
    r"|go on|revise|shorten|simplify|improve|rewrite|use|do(?: not|n['’]t)|that|this|it|these|those|there|why"
    r"|what about|you (?:forgot|missed|left|did|have|can(?:no|['’])t|should|need|do)|step \d+"
    r"|(?:the )?(?:first|second|third|last|next|previous) (?:step|one|line)|make (?:it|that|this)"
    rf"|(?:can|could|would|will) you (?:also |please )?{_CHANGE}|please (?:{_CHANGE}|do(?: not|n['’]t)))\b",
    re.IGNORECASE,
)
"""The beginning of a request that is about the answer before it."""


_AGREES = (
    r"(?:ok|okay|yes|yeah|yep|great|good|nice|perfect|cool|super|awesome|excellent|wonderful|thanks?|thank you|thx"
    r"|cheers|bye|goodbye|got it|sure|fine|right|alright)"
)
_ACCEPTS = re.compile(
    rf"(?:(?:{_AGREES}|continue|go on|next|and then|and|then|now|what(?:['’]s| is)?|job|work|step|plan|one"
    r"|that(?:['’]s| is)|it(?:['’]s| is)|works?|helps?|looks?|very|so|a lot|much|for|the|your|help|you|all)\b\W*)+",
    re.IGNORECASE,
)
"""A request that takes the answer before it as it is, or asks how that goes on."""

_AFTER_THANKS = re.compile(rf"(?:{_AGREES}\b\W+)+(?:and\s+)?(?:now|next|then)\b\W*", re.IGNORECASE)
"""The words before a new task, which take the last answer as it is."""


def corrects(asked: str) -> bool:
    """Return whether a request is about the answer before it."""
    asked = asked.strip()
    task = _AFTER_THANKS.match(asked)
    return _CORRECTS.match(asked, task.end() if task and task.end() < len(asked) else 0) is not None


def rejects(asked: str) -> bool:
    """Return whether a request asks for another answer to the question before it."""
    return corrects(asked) and not accepts(asked)


def accepts(asked: str) -> bool:
    """Return whether a request takes the answer before it as it is."""
    return _ACCEPTS.fullmatch(asked.strip()) is not None


def titled(asked: Sequence[str]) -> dict[str, str]:
    """Return the title of a chat and its description, by the requests in it: a correction is a part of the latter."""
    about = next((n for n in reversed(range(len(asked))) if not n or not corrects(asked[n])), 0)
    first, _, rest = (asked[about] if asked else "").strip().partition("\n")
    said = [each.strip() for each in (rest, *asked[about + 1 :]) if each.strip()]
    return {
        "title": asked_title(TITLE.sub("", first, count=1))[:_LONGEST],
        **({"description": "\n".join(said)} if said else {}),
    }
