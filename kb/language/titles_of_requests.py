"""Titles of requests: the task for which a plan is asked."""

import re

_ASKED_FOR = re.compile(
    r"(?:(?:please|hi|hello|hey|(?:can|could|would|will)\s+you|i(?:\s+would|['’]d)\s+like(?:\s+you\s+to)?|i\s+want\s+you\s+to)"
    r"\s*,?\s+)*(?:(?:write|give|make|create|generate|produce|provide|list|show|i\s+need|i\s+want)\b[^:]{0,40})?"
    r"\b(?:plan|steps|program|instructions|guide|action\s+sequence)\s+(?:for|to)\s*:?\s+[\"'“]?(\S.*?)[\"'”.!?:]*",
    re.IGNORECASE,
)


def asked_title(line: str) -> str:
    """Return the title of a request, `Make tea` of `Write a plan for: Make tea`; else the line itself."""
    asked = _ASKED_FOR.fullmatch(line.strip())
    return asked[1] if asked else line
