"""Lines in which people correct themselves as they speak: `walk to the kitchen, no wait, to the bathroom`.

Which of the things is meant is for people to say, so the whole line is refused.
"""

import re

_HINT = re.compile(
    r"no\b|not\b|rather|better|wait|scratch|mean|mind|correction|second thought|strike that|make that", re.IGNORECASE
)
_CORRECTS = re.compile(
    r"\b(?:no,? wait|wait,? no|(?:scratch|strike) that|i (?:meant?|mean to say)\b|never ?mind|on second thoughts?"
    r"|correction\b|or (?:rather|better)|(?:sorry|oops|actually|or),? (?:no|not that)\b|make that (?:the|a|an)\b)"
    r"|(?:^|[.!?;:–—-]|\s-)\s*no(?:,|,? (?:the|not|that|it|i)\b)",
    re.IGNORECASE,
)


def corrects_itself(line: str) -> bool:
    """Return whether a line takes back words that it said before."""
    return _HINT.search(line) is not None and _CORRECTS.search(line) is not None
