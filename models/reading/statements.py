"""Statements: clauses that tell something and ask for nothing, as `my back hurts` and `the sun's strong` do."""

from __future__ import annotations

import re
from functools import lru_cache

from hearth.kb.language.english_lexicon import is_verb, verb_lemmas
from hearth.kb.language.word_tables import lemmas

_SUBJECT = (
    r"(?:the|my|our|your|his|her|its|their|that|this|these|those|a|an|some|all|both|no one|nobody|somebody|someone"
    r"|everybody|everyone|there|here|i|we|you|he|she|it|they|one|two|three|four|five|six|most|many|grandma|grandpa|mum"
    r"|mom|dad|daddy|mummy|[a-z]+(?= (?:and )?(?:[a-z]+ )?(?:is|are|was|were|has|have|stinks|smells|hurts"
    r"|looks|seems|isn't|aren't|will|won't|would)\b))"
)
_AUXILIARY = (
    r"(?:is|are|was|were|am|isn't|aren't|wasn't|weren't|has|have|had|hasn't|haven't|will|won't|would|could|may"
    r"|might|stinks|smells|hurts|aches|looks|seems|feels|can't|cannot|couldn't|didn't|doesn't|don't|does|did|can)"
)
_TELLS = re.compile(
    rf"{_SUBJECT}\b(?: [a-z'-]+){{0,4}}? {_AUXILIARY}\b.*|(?:i|we|you|he|she|it|they)(?:'ll|'ve|'d|'m|'re|'s) .+"
)
_ASKS_WHAT = re.compile(
    r"(?:who|what|when|where|why|how|which|whose|is|are|was|were|do|does|did|has|hasn't|isn't|aren't|haven't)"
    r"(?:'s|'re|'ll|'ve)?\b(?! about ).*|have (?:you|we|they|i)\b.*"
)
_EXCLAIMS = re.compile(
    r"(?:ugh|oh(?: no| dear| my)?|ah|phew|wow|hmm+|gosh|damn|blimey|crikey|oops|whoa|yay|ouch|brr+|yuck|eww?|argh|ahem"
    r"|daddy|dad|mum|mummy|mom|mommy|grandma|grandpa|love|darling|honey|sweetie|mate|buddy|guys|kids|everyone|folks|sir"
    r"|madam|son|there(?: we go| you go)?|right then|come on|what a [a-z]+(?: [a-z]+)*|now|anything"
    r"|whatever|go|hurry|hurry up"
    r"|(?:can't|cannot|couldn't) (?:see|hear|find|sleep|breathe|feel|think|concentrate|wait|move|read)(?: .+)?"
    r"|that's enough(?: .+)?|enough of .+|time for .+|go on|go back|give it (?:a|one|two|five|ten"
    r"|some) (?:minutes?|while|seconds?|time)|almost .+|nearly .+)"
)
_WANTS = re.compile(
    r"\b(?:should|shouldn't|must|mustn't|shall|ought|want|wants|need|needs|needn't|wish|would like"
    r"|would love|'d like|'d love|let's"
    r"|has to|have to|had to|had better|please|could you|would you|can you|will you|belongs?|goes|go|never|not allowed"
    r"|stays?|remains?|forbidden|may not|going to need|gets?|better|allowed)\b"
)
_IS_SO = re.compile(
    r"(?:[a-z]+ ){0,2}[a-z]+'s (?:(?:[a-z]+ly|so|too|very|really|all|still|not|getting|been) )*"
    r"(?P<how>[a-z]+)(?: (?:over|out|off|up|down|again|now|here))?"
)
_IS_AT = re.compile(r"(?:the |my )?[a-z]+(?:'s| is) (?:all )?(?:in|on|at|over|under) (?:my|your|the|our) .+")
_ALLOWS = re.compile(r"you (?:can|may|could)(?: now| then)? [a-z]+")
_FINITE = re.compile(
    r"(?:the|my|our|your|his|her|its|their|that"
    r"|this) (?P<noun>[a-z'-]+)(?: [a-z'-]+)? (?P<verb>[a-z]+s)\b(?! (?:on|in|to)\b).*"
)


FORBIDS = re.compile(
    r"\b(?:nobody|no one|nothing|none)\b.*\b(?:may|can|should|is to|gets to|touches|opens|uses)\b"
    r"|\byou\b.*\b(?:can't|cannot|can not|may not|aren't to|are not to|won't|will not|don't|do not)\b"
    r"|\b(?:can't|cannot|isn't|is not|aren't|are not|not) (?:to )?be (?:[a-z]+ed|on|off|open|touched|used|shut)\b"
    r"|\boff[ -]limits\b|\bforbidden\b|\bdo not\b|\bhands off\b"
)
"""Words of a ban: a clause with them asks for something, even where it looks like a statement."""


@lru_cache(maxsize=4096)
def is_statement(text: str) -> bool:
    """Return whether a clause, in small letters, states something or asks about it, and asks for nothing to be done.

    A clause with a word of wishes or duties, as `should` and `belongs` are, is none.
    """
    if _ALLOWS.match(text):
        return False
    if _EXCLAIMS.fullmatch(text):
        return True
    if _WANTS.search(text) or FORBIDS.search(text):
        return False
    if _ASKS_WHAT.fullmatch(text) or _TELLS.fullmatch(text):
        return True
    if _IS_AT.fullmatch(text):
        return True
    said = _IS_SO.fullmatch(text)
    if said and {"ADJ", "VERB", "ADV"} & set(lemmas(said["how"])):
        return True
    found = _FINITE.fullmatch(text)
    return bool(found) and _is_finite(found["verb"] if found else "")


def _is_finite(word: str) -> bool:
    """Return whether a word is a verb with an ending, as `hurts` is."""
    return is_verb(word) and word not in verb_lemmas(word)
