"""Openings: what stands before the verb of a sentence and asks for no other step, and courtesies at its end."""

import re

_SUBJECT = r"(?:i|you|he|she|we|they|(?:the|a|our|my|your) (?:robot|agent|person|user|character|human)|one)"
_DUTY = (
    r"(?:should|shall|must|will|would|(?:need|needs|needed) to|ha(?:s|ve|d) to|wants? to|ought to"
    r"|(?:am|is|are|was|were) (?:going|supposed|asked) to)"
)
_TENSE = r"(?:am|is|are|was|were)(?= [a-z]+ing\b)|(?:has|have|had)(?! (?:a|an|the|some|my|your|his|her|it)\b)"
_ORDER = "(?: (?:then|now|also|next|first))?"
_OPENINGS = (
    r"(?:(?:i|we) would|(?:i|we)['’]d) like (?:you )?to|(?:i |we )?want you to",
    r"(?:yesterday|last|this) (?:evening|morning|afternoon|night)|after a (?:while|bit|moment|minute)",
    r"(?:yesterday|today|tonight|this (?:morning|afternoon|evening)|in the (?:morning|afternoon|evening))(?=,? )",
    r"(?:could|can|would|will) you(?: mind| be so kind as to)?|if you (?:don['’]t|do not|wouldn['’]t) mind(?=,)",
    r"(?:(?:hey|hi|hello|ok|okay) )?(?:robot|bot|alexa|siri|jarvis)\s*,|(?:um+|uh+|oh|you know)(?= |,)",
    rf"{_SUBJECT}(?:['’](?:ll|m|re|s|ve|d))?{_ORDER}(?: (?:{_DUTY}|{_TENSE})){{0,2}}{_ORDER}",
    r"let (?:me|us|him|her|the (?:robot|agent|person))|let['’]s",
    r"(?:(?:make|be) (?:sure|certain)|ensure|see to it)(?: that)? (?:you|we)(?! (?:do not|don['’]t|never|are|have)\b)"
    r"(?= )|(?:it is|it['’]s) (?:important|necessary|best|good) to"
    r"|(?:the|your) (?:next|first|last|final) thing(?: to do)? is to",
    r"(?:you|we)(?:['’]ll| will)? want to",
    r"go ahead and|make (?:sure|certain) to|be sure to|remember to|(?:don['’]t|do not|never) forget to"
    r"|(?:proceed|try|start|begin|continue|attempt) to(?! (?:the|a|an|your|my|his|her|our|their)\b)"
    r"|(?:i |we )?need you to"
    r"|(?:start|begin|continue|keep|finish)(?= [a-z]+ing\b)|go (?:and )?(?=(?:get|grab|fetch|take|find|pick|bring)\b)"
    r"|(?:it is|it['’]s) time to|(?:the|your) next step is to"
    r"|(?:er+m?|yeah|yep|yes|well|alright|right)(?= then\b|,)|(?:er+m?|yeah)(?= )"
    r"|(?:start|begin|continue) (?:off )?by|your (?:next )?(?:job|task) is to",
    r"(?:first|second|third|fourth|fifth|sixth|last|final)(?:ly)?(?: of all)?\s*[,:]",
    r"(?:firstly|secondly|thirdly|fourthly|fifthly|lastly|finally)",
    r"after (?:that|this|which)|once (?:that is )?done|from there|at last|in the end",
    r"as a (?:first|next|last|final) step",
    r"then|next|first|now|please|kindly|just|simply|maybe|perhaps|and|afterwards|also|ok|okay|so",
)
_OPENING = re.compile(rf"(?:{'|'.join(_OPENINGS)})(?:\b|(?<=[,:]))[\s,]*", re.IGNORECASE)
_CLOSING = re.compile(
    r"(?:[\s,]+(?:please|thanks|thank you|too|as well|already|right away|at once|would you|will you"
    r"|love|dear|mate|darling|(?<!the )(?<!some )(?<!with )(?<!of )honey"
    r"|if you (?:can|please|would|like)|if possible|for me))+$",
    re.IGNORECASE,
)
_FILLED = re.compile(r",\s+(?:you know|i mean|um+|uh+|like),\s+", re.IGNORECASE)
_MARKS = re.compile(r"[^\w\s)\]>'’\"”%?]+$")
_FIRST = frozenset(
    [
        *("i", "you", "he", "she", "we", "they", "one", "the", "a", "our", "my", "your"),
        *("yesterday", "today", "tonight", "this", "if", "maybe", "perhaps"),
        *("hey", "hi", "hello", "robot", "bot", "alexa", "siri", "jarvis", "um", "umm", "uh", "uhh", "oh"),
        *("could", "can", "would", "will", "want", "let", "go", "make", "be", "remember", "start", "begin"),
        *("first", "second", "third", "fourth", "fifth", "sixth", "last", "final"),
        *("firstly", "secondly", "thirdly", "fourthly", "fifthly", "lastly", "finally"),
        *(
            "do",
            "don",
            "never",
            "proceed",
            "try",
            "continue",
            "attempt",
            "it",
            "er",
            "err",
            "erm",
            "yeah",
            "yep",
            "yes",
            "well",
        ),
        *("alright", "right"),
        *("keep", "finish"),
        *("ensure", "see", "need"),
        *("after", "once", "from", "at", "in", "as", "then", "next", "now", "please", "kindly", "just", "simply"),
        *("and", "afterwards", "also", "ok", "okay", "so"),
    ]
)
"""First words of openings; most sentences begin with none of them."""

_WORD = re.compile(r"[A-Za-z]+")


def verb_phrase(sentence: str) -> str:
    """Return a sentence from its verb on: without subject, duty, tense, courtesy and words of order.

    `Then you should open the fridge, please!` is `open the fridge`. A possibility ("you can open it") is not a duty.
    """
    text = _MARKS.sub("", _FILLED.sub(" ", sentence.strip())).rstrip()
    opening = _opening(text)
    while opening and opening < len(text):
        text = text[opening:]
        opening = _opening(text)
    if text.endswith("?") and len(text) < len(sentence.strip()):
        text = text.rstrip("? ")
    if text[-1:].isalpha() and (closing := _CLOSING.search(text)) and closing.start():
        return text[: closing.start()]
    return text


def _opening(text: str) -> int:
    """Return where the opening at the beginning of a text ends; 0 where it has none."""
    word = _WORD.match(text)
    if not word or word[0].lower() not in _FIRST:
        return 0
    found = _OPENING.match(text)
    return found.end() if found else 0
