"""Titles of chats: the request that the last answer is about, whatever was corrected since."""

import re
from collections.abc import Sequence

from hearth.kb.language.asked_titles import asked_title
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


def titled(asked: Sequence[str]) -> dict[str, str]:
    """Return the title of a chat and its description, by the requests in it: a correction is a part of the latter."""
    about = next((n for n in reversed(range(len(asked))) if not n or not _CORRECTS.match(asked[n].strip())), 0)
    first, _, rest = (asked[about] if asked else "").strip().partition("\n")
    said = [each.strip() for each in (rest, *asked[about + 1 :]) if each.strip()]
    return {
        "title": asked_title(TITLE.sub("", first, count=1))[:_LONGEST],
        **({"description": "\n".join(said)} if said else {}),
    }
