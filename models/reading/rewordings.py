"""Rewordings: a clause as one or several plainer clauses, as a passive, a light verb or an order of two acts is."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from functools import lru_cache

from hearth.kb.knowledge import Knowledge
from hearth.kb.language.english_lexicon import is_verb, verb_lemmas
from hearth.models.reading.mentions import mentions_in

Clauses = tuple[str, ...]
"""Plainer clauses, in the order in which they are to be done."""

TAKES_TOOL = "grab "
"""The beginning of a clause that takes a tool: a pronoun in the next clause is not the tool."""

_DUTY = (
    r"(?:should|must|shall|(?:still )?(?:has|have) to|(?:still )?needs? to|can|could|may|might|ought to|is to"
    r"|are to|wants? to"
    r"|had better|will have to|'s got to|has got to|have got to|deserves? to|is meant to|are meant to|would like to)"
)
_BETWEEN = r"(?: (?:now|then|all|both|please|also|still|first|afterwards|again|just|really|next))*"
_STATE = (
    r"(?:(?:switched |turned |left |kept |wide |firmly |put )?(?:on|off|open|closed|shut|drawn|running|out"
    r"|going|lit|burning"
    r"|plugged in|unplugged|clean|ajar|opened|away))"
)
_PASSIVE = (
    re.compile(rf"(?P<np>.+?) {_DUTY}{_BETWEEN} (?:be|get){_BETWEEN} (?P<verb>[a-z]+)(?P<rest> .+)?"),
    re.compile(
        rf"(?:could|can|would|may|might|should|must) (?P<np>.+?){_BETWEEN} (?:be"
        rf"|get){_BETWEEN} (?P<verb>[a-z]+)(?P<rest> .+)?"),
    re.compile(
        r"(?P<np>.+?) (?:gets?|is getting|are getting|is being|needs?"
        r"|wants?) (?:to be )?(?P<verb>[a-z]+(?:ed|en|t|ing|d|n))(?P<rest> .+)?"),
    re.compile(
        r"(?:have|get|see|want|need|i want|i need|i would like|i would love|we would like|see that"
        r"|make sure|let) (?P<np>.+?)(?: (?:is"
        r"|are))? (?P<verb>[a-z]+(?:ed|en|t|d|n))(?P<rest> .+)?"),
    re.compile(
        r"(?P<np>.+?) (?:could do with|could use|is due|are due|is in need of|requires?"
        r"|deserves?) (?:some )?(?P<verb>[a-z]+ing)(?P<rest> .+)?"),
    re.compile(r"(?P<np>.+?) (?:is|are) what (?:needs?|wants?) (?P<verb>[a-z]+ing)(?P<rest> .+)?"),
    re.compile(r"(?P<np>.+?),? (?P<verb>[a-z]+(?:ed|en))(?P<rest> .+)?"),
)  # fmt: skip
_CAUSED = re.compile(
    r"^(?:have|get|see|want|need|i want|i need|i would like|i would love|see that|make sure|let|keep|leave) "
)
_UNCHANGED = frozenset({"cut", "put", "set", "shut", "hung", "read"})
_GIVEN = re.compile(
    r"(?:give|do) (?P<np>.+?) (?:a|an|another|some) (?:[a-z]+ ){0,3}(?P<verb>[a-z]+)(?: first| too| then"
    r"| now| as well)?"
)
_NEEDS_ONE = re.compile(
    r"(?P<np>.+?) (?:needs?|could do with|could use|wants?|deserves?|is due|calls for|requires?) (?:a|another|some) "
    r"(?:[a-z]+ ){0,3}(?P<verb>[a-z]+)"
)
_LIGHT = re.compile(
    r"(?:have|take|do|make|enjoy|get in|spend|go for) (?:a|an|another) (?:good |quick |proper |nice |little "
    r"|long |short "
    r"|bit of |brief |small |time |while )*(?P<verb>[a-z]+)(?P<rest> (?!and )(?:(?! and ).)+)?"
)
_SPENT = re.compile(
    r"spend (?:some |a |the |your )?(?:[a-z]+ )*?(?P<verb>(?!evening|morning)[a-z]+ing)\b(?P<rest> .+)?"
)
_DONE = re.compile(
    r"(?:do|get on with|start|finish) (?:some|the|a bit of|a little|your) (?P<verb>[a-z]+ing)\b(?P<rest> .+)?"
)
_SPENT_IN = re.compile(
    r"spend (?:some |a |the )?(?:while|time|bit|moment|evening|hour|minute|afternoon)? ?(?P<place>(?:in|on"
    r"|at) .+?) (?P<verb>[a-z]+ing)"
    r"(?P<rest> .+)?"
)
_TOOL_FIRST = re.compile(
    r"(?:use|using|with|(?:take|get|grab)(?=.+ to )) (?P<np>.+?)(?: to|,)(?: (?:i|you|we|she|he))?"
    r" (?P<clause>(?!and\b|but\b|then\b)[a-z]+(?: .+)?)"
)
_TOOL_LAST = re.compile(r"(?P<clause>.+?) (?:with|using|by using|by means of) (?P<np>.+)")
_TOOL_ON = re.compile(r"use (?P<np>.+?) on (?P<what>.+)")
_BY = re.compile(r".+? by (?P<clause>[a-z]+ing .+)")
_BOTH = re.compile(
    r"(?P<one>[a-z]+(?: (?:off|on|up|down|out))?)(?:,| and| or|, and| and then"
    r"|, then)(?: then)? (?P<other>[a-z]+)(?P<rest> .+)"
)
_WITH_STATE = (
    re.compile(rf"with (?P<state>.+? {_STATE}),? (?P<clause>[a-z]+ .+)"),
    re.compile(rf"(?P<clause>.+?),? (?:with|while|but with|and keep|and have) (?P<state>.+? {_STATE})"),
)
_UNTIL = re.compile(
    r"(?:do not|don't|never|not) (?P<main>.+?) (?:until|till|before|unless) (?:you(?:'ve| have)? "
    r"|having )?(?P<first>.+)"
)
_NOT_UNTIL = re.compile(r"(?P<main>.+?),? (?:but )?not (?:until|before) (?:you(?:'ve| have)? )?(?P<first>.+)")
_BUT_FIRST = re.compile(
    r"(?P<main>.+?),? (?:but|and|only)(?: please)? (?P<first>.+?) (?:first|beforehand|before that|before)"
)
_THE_FIRST = re.compile(r"(?P<main>.+?),? (?:but|and) (?:first|before that|beforehand),? (?P<first>.+)")
_AFTER = re.compile(
    r"(?P<main>.+?),? (?:only |right |just |straight |directly )?(?:after(?! that\b)|once|when|as soon as|now that)"
    r" (?:(?:you have|you've|you are|you're|you|having|have)(?: been| done| finished| are| with"
    r"| already)* )?(?P<first>.+)"
)
_AFTER_PLAIN = re.compile(
    r"(?P<main>.+?),? (?:only )?(?:after(?! that\b)|once|when|as soon as|now that) (?:you |you've )?(?P<first>.+)"
)
_AFTER_YOU = re.compile(r"(?P<main>.+?),? (?:only )?(?:after|once|when|as soon as) you (?P<first>.+)")
_AFTER_FIRST = re.compile(
    r"(?:only |right |just )?(?:after|once|when|as soon as|upon|having)"
    r" (?:(?:you have|you've|you are|you're|you|having|have)(?: been| done| finished| are| with"
    r"| already)* )?(?P<first>.+?), "
    r"(?:then |only then )?(?P<main>.+)"
)
_WITHOUT = re.compile(
    r"(?:do not|don't|never) (?P<main>(?!use\b|touch\b).+?),? without (?:having |first )?(?P<first>.+)"
)
_DONE_TO = re.compile(
    r"(?P<np>.+?) (?:is|are|has been|have been)(?: all| both| properly| neatly)? (?P<verb>[a-z]+(?:ed|en|t))"
)
_BEFORE = re.compile(r"(?P<first>.+?),? (?:just |right |shortly )?before (?:you(?:'ve)? )?(?P<main>.+)")
_BEFORE_FIRST = re.compile(r"(?:just |right |shortly )?before (?:you )?(?P<main>.+?), (?P<first>.+)")
_HAVING = re.compile(r"^(?:you have|you've|you|have|having) ")
_POSTURE = re.compile(
    r"(?P<main>[a-z]+ .+?)(?<! no)(?<! not)(?<! without)(?<! avoid)(?<! stop)(?<! never),? "
    r"(?P<first>(?:sitting|lying|seated)(?: down)? (?:in|on|at) .+)"
)
_WHILE_YOU = re.compile(r"(?P<main>.+?),? (?:while|whilst|as) you (?P<first>[a-z]+ .+)")
_WHILE = re.compile(r"(?P<main>.+?),? (?:while|whilst) (?:you(?:'re| are) )?(?P<first>[a-z]+ing .+)")
_STATE_IN = re.compile(r"(?P<np>.+?) (?P<state>on|off|open|closed|shut|out) in (?P<room>the [a-z]+(?: [a-z]+)?)")
_ROOM_FIRST = re.compile(
    r"(?P<clause>.+?) (?P<near>in(?:to)?|by|near|next to|beside) (?P<room>(?:the|my|your) [a-z]+(?: [a-z]+)?),? "
    r"(?P<to>on|in|onto|into|on top of|inside|next to) (?P<place>.+)"
)
_PREPOSITION = re.compile(
    r"(?:back |straight |right |and |also )*(?P<to>(?:in|into|inside|on|onto|upon|to|over to|next to|beside|by) .+)"
)
_INTO = re.compile(r"into (?:your|my|the|some|a|bed|something) ?.*")
_FRONTED = re.compile(
    r"(?P<np>.+?) (?:i|you|we|he|she|they)(?: (?:just|then|always|usually|also|only|will|can"
    r"|should))* (?P<verb>[a-z]+)(?P<rest> .+)?"
)
_PLACE_FIRST = re.compile(
    r"(?P<place>(?:on|in|into|onto) .+?),? (?:i (?:want|need|would like|put)|we (?:want|need|put)"
    r"|there should be|you put|put|place) (?P<np>.+)"
)
_FROM_FIRST = re.compile(
    r"(?:from|off|out of) (?P<place>.+?),? (?P<verb>take|get|grab|fetch|bring|pick up|remove|collect) (?P<np>.+)"
)
_NONE = re.compile(
    r"no (?P<np>.+?) (?:should|must|may|can|is to|are to|ought to) (?:be|stay|remain|be left) "
    r"(?P<state>on|open|running)(?P<rest> in .+)?"
)
_GO_IN = re.compile(r"(?P<to>in|into|on|onto) (?P<place>.+?) (?:go|goes|with) (?P<np>.+)")
_TO_DO = re.compile(r"(?P<np>.+?) to (?P<verb>wash|clean|fold|put away|tidy|rinse|cut|chop|eat|read|dry|cook)")
_FORGOTTEN = re.compile(
    r"(?:you|we|i|somebody|someone)(?: have|'ve)? (?:forgot|forgotten|still have|still need) to (?P<clause>.+)"
)
_SITTING = re.compile(r"(?P<clause>.+?),? while (?:you are |you're )?(?:sitting|seated)(?: down)?")
_COULD_GO = re.compile(
    r"(?:could|can|should|may|might|would) (?P<np>.+?) (?:go|live|stand|sit)(?P<rest> (?:in|on|into"
    r"|onto|to|back|next) .+)"
)
_OFF_TO = re.compile(r"(?:and )?off (?:to|you go to|we go to) (?P<place>.+)")
_PARTICLE = re.compile(r"(?:back |then |and |straight )*(?P<state>on|off|up|down|open|shut|closed|out)(?: again)?")
_IT_STATE = re.compile(rf"(?:and |but )?(?P<state>{_STATE})(?: again)?")
_THERE = re.compile(r"(?P<clause>.+) (?:on |in |over )?there")
_ITS_PLUG = re.compile(r"(?:pull|take|remove|disconnect)(?: out)? its plug(?: out)?")


def rewordings(known: Knowledge, text: str) -> Iterator[Clauses]:
    """Yield what a clause says in plainer clauses, the likeliest first; none that it is not certain to say."""
    seen: dict[Clauses, None] = {}
    for way in _WAYS:
        for clauses in way(known, text):
            if clauses not in seen and clauses != (text,) and all(clauses):
                seen.setdefault(clauses)
                yield clauses


def orders(text: str) -> Iterator[tuple[str, str]]:
    """Yield a sentence as its earlier and its later part in time, the likeliest first."""
    for pattern in (
        _BUT_FIRST,
        _THE_FIRST,
        _UNTIL,
        _NOT_UNTIL,
        _WITHOUT,
        _AFTER_FIRST,
        _BEFORE_FIRST,
        _AFTER,
        _AFTER_PLAIN,
        _AFTER_YOU,
        _BEFORE,
        _WHILE,
        _WHILE_YOU,
        _POSTURE,
    ):
        if found := pattern.fullmatch(text):
            first, main = (found[part].strip(" ,") for part in ("first", "main"))
            if pattern is _WITHOUT:
                yield f"put on {first}", main  # `don't go out without a hat`
            yield first, main
            if (done := _HAVING.sub("", first)) != first:
                yield done, main


def done_first(known: Knowledge, text: str) -> str:
    """Return `fold the blanket` of `the blanket is folded`, which is to be so before something else; "" for others."""
    found = _DONE_TO.fullmatch(text)
    if not found or not _is_thing(known, found["np"]):
        return ""
    lemmas = [lemma for lemma in verb_lemmas(found["verb"]) if lemma != found["verb"]]
    return f"{lemmas[0]} {found['np']}" if lemmas else ""


def _passive(known: Knowledge, text: str) -> Iterator[Clauses]:
    """Yield `open the curtains` of `the curtains should be opened`, and so on."""
    for pattern in _PASSIVE:
        found = pattern.fullmatch(text)
        if not found or not _is_thing(known, found["np"]):
            continue
        for lemma in _verbs(found["verb"]):
            rest = found["rest"] or ""
            yield (f"{lemma} {found['np']}{rest}",)
            if rest:
                yield (f"{lemma}{rest} {found['np']}",)


def _participle(known: Knowledge, text: str) -> Iterator[Clauses]:
    """Yield `wipe the counter down` of `get the counter wiped down`, and of `the counter wiped down`."""
    plain = _CAUSED.sub("", text)
    found = plain.split(" ")
    for at in range(1, len(found)):
        things, rest = " ".join(found[:at]), " ".join(found[at + 1 :])
        lemmas = [lemma for lemma in verb_lemmas(found[at]) if lemma != found[at] or found[at] in _UNCHANGED]
        if not lemmas or found[at].endswith("ing") or not _is_thing(known, things):
            continue
        for lemma in lemmas:
            yield (f"{lemma} {things} {rest}".strip(),)
            if rest:
                yield (f"{lemma} {rest} {things}",)


def _light(known: Knowledge, text: str) -> Iterator[Clauses]:
    """Yield `rinse the cup` of `give the cup a rinse`, and `look at it` of `have a look at it`."""
    for pattern in (_GIVEN, _NEEDS_ONE):
        found = pattern.fullmatch(text)
        if found and is_verb(found["verb"]) and _is_thing(known, found["np"]):
            yield from ((f"{lemma} {found['np']}",) for lemma in _verbs(found["verb"]))
    if (found := _LIGHT.fullmatch(text)) and is_verb(found["verb"]):
        rest = re.sub(r"^ of ", " ", found["rest"] or "")
        yield from ((f"{lemma}{rest}",) for lemma in _verbs(found["verb"]))
    if found := _DONE.fullmatch(text):
        yield from ((f"{lemma}{found['rest'] or ''}",) for lemma in _verbs(found["verb"]))
    if found := _SPENT_IN.fullmatch(text):
        yield from ((f"{lemma}{found['rest'] or ''} {found['place']}",) for lemma in _verbs(found["verb"]))
    if found := _SPENT.fullmatch(text):
        yield from ((f"{lemma}{found['rest'] or ''}",) for lemma in _verbs(found["verb"]))


def _tool(known: Knowledge, text: str) -> Iterator[Clauses]:
    """Yield `grab the sponge` and `clean the sink` of `clean the sink with the sponge`."""
    if (found := _TOOL_FIRST.fullmatch(text)) and _is_thing(known, found["np"]):
        yield (f"grab {found['np']}", found["clause"])
        yield (f"{found['clause']} {found['np']}",)
        yield (f"{found['clause']} on {found['np']}",)
        yield (found["clause"],)
    if (found := _TOOL_LAST.fullmatch(text)) and _is_thing(known, found["np"]):
        yield (f"grab {found['np']}", found["clause"])
        yield (f"{found['clause']} on {found['np']}",)
        yield (found["clause"], f"add {found['np']}")
    if (found := _TOOL_ON.fullmatch(text)) and _is_thing(known, found["np"]):
        yield (f"grab {found['np']}", f"clean {found['what']}")
    if found := _BY.fullmatch(text):
        yield (found["clause"],)


def _two(known: Knowledge, text: str) -> Iterator[Clauses]:
    """Yield `open it` and `close it` of `open and close it`."""
    found = _BOTH.fullmatch(text)
    if found and is_verb(found["one"].partition(" ")[0]) and is_verb(found["other"]):
        yield (f"{found['one']}{found['rest']}", f"{found['other']}{found['rest']}")


def _with_state(known: Knowledge, text: str) -> Iterator[Clauses]:
    """Yield `the curtains shut` and `watch tv` of `with the curtains shut, watch tv`."""
    for pattern in _WITH_STATE:
        if found := pattern.fullmatch(text):
            yield (*re.split(r",? and ", found["state"]), found["clause"])


def _without_object(known: Knowledge, text: str) -> Iterator[Clauses]:
    """Yield a clause that leaves out the thing spoken of before: `and into the sink`, `then off again`."""
    if _ITS_PLUG.fullmatch(text):
        yield ("unplug it",)
    if found := _OFF_TO.fullmatch(text):
        yield (f"go to {found['place']}",)
    if found := _INTO.fullmatch(text):
        yield (f"get {found[0]}",)
    if found := _PREPOSITION.fullmatch(text):
        yield (f"put it {found['to']}",)
        yield (f"go {found['to']}",)
    if found := _PARTICLE.fullmatch(text):
        yield (f"turn it {found['state']}",)
    if found := _IT_STATE.fullmatch(text):
        yield (f"make sure it is {found['state']}",)
    if found := _THERE.fullmatch(text):
        yield (found["clause"],)
    first, space, rest = text.partition(" ")
    if is_verb(first) and (
        not rest or re.match(r"(?:in|into|on|onto|up|down|off|out|back|away|at|to|under|with)\b", rest)
    ):
        yield (f"{first} it{space}{rest}",)


def _room_last(known: Knowledge, text: str) -> Iterator[Clauses]:
    """Yield `put it on the table in the kitchen` of `put it in the kitchen on the table`."""
    if found := _STATE_IN.fullmatch(text):
        yield (f"{found['np']} in {found['room']} {found['state']}",)
    if (found := _ROOM_FIRST.fullmatch(text)) and _is_thing(known, found["place"]):
        near = "in" if found["near"] == "into" else found["near"]
        yield (f"{found['clause']} {found['to']} {found['place']} {near} {found['room']}",)


def _none_so(known: Knowledge, text: str) -> Iterator[Clauses]:
    """Yield `turn off all lights in the hall` of `no lights should be on in the hall`."""
    if (found := _NONE.fullmatch(text)) and _is_thing(known, found["np"]):
        verb = "close" if found["state"] == "open" else "turn off"
        yield (f"{verb} all {found['np']}{found['rest'] or ''}",)


def _fronted(known: Knowledge, text: str) -> Iterator[Clauses]:
    """Yield `throw the envelope away` of `the envelope I throw away`, and so on."""
    if (found := _FRONTED.fullmatch(text)) and _is_thing(known, found["np"]):
        for lemma in _verbs(found["verb"]):
            yield (f"{lemma} {found['np']}{found['rest'] or ''}",)
    if found := _PLACE_FIRST.fullmatch(text):
        yield (f"put {found['np']} {found['place']}",)
    if (found := _FROM_FIRST.fullmatch(text)) and _is_thing(known, found["place"]):
        yield (f"{found['verb']} {found['np']} from {found['place']}",)
    if (found := _GO_IN.fullmatch(text)) and _is_thing(known, found["place"]):
        yield (f"put {found['np']} {found['to']} {found['place']}",)
    if (found := _TO_DO.fullmatch(text)) and _is_thing(known, found["np"]):
        yield (f"{found['verb']} {found['np']}",)
    if found := _FORGOTTEN.fullmatch(text):
        yield (found["clause"],)
    if found := _SITTING.fullmatch(text):
        yield ("sit down", found["clause"])
    if (found := _COULD_GO.fullmatch(text)) and _is_thing(known, found["np"]):
        yield (f"{found['np']} goes{found['rest']}",)


_WAYS: tuple[Callable[[Knowledge, str], Iterator[Clauses]], ...] = (
    _passive, _fronted, _participle, _tool, _light, _two, _room_last, _with_state, _without_object, _none_so,
)  # fmt: skip


@lru_cache(maxsize=4096)
def _is_thing(known: Knowledge, text: str) -> bool:
    return bool(mentions_in(known, text))


def _verbs(word: str) -> tuple[str, ...]:
    return tuple(dict.fromkeys((*verb_lemmas(word), *((word,) if is_verb(word) else ()))))
