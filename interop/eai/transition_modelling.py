"""Transition modelling: PDDL operators of a model compared with the gold ones, predicate by predicate."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, NamedTuple

from hearth.interop.eai.answer_texts import json_answer_of, unfenced
from hearth.interop.eai.goal_interpretation import Counts
from hearth.interop.eai.wheel import RESOURCES, Answer, Wheel

Expression = str | tuple[Any, ...]
"""A literal as text, or an operator with its parts."""

MOST_DEEP = 100
"""Brackets within one another."""


class Operator(NamedTuple):
    """The conditions and effects of an operator, as text."""

    precondition: str
    effect: str


def operators_of(text: str) -> dict[str, Operator]:
    """Return the operators of an answer by name; those that are cut short are left out."""
    parts = _operator_texts(text)
    return {name: Operator(_block(part, ":precondition"), _block(part, ":effect")) for name, part in parts.items()}


def parameters_of(text: str) -> dict[str, str]:
    """Return the parameters of an answer's operators by name, as text."""
    return {name: _block(part, ":parameters") for name, part in _operator_texts(text).items()}


def _operator_texts(text: str) -> dict[str, str]:
    """Return the text of each whole operator of an answer, without its name."""
    found = json_answer_of(text)
    body = _joined(found["output"]) if isinstance(found, dict) and "output" in found else unfenced(text)
    body = re.sub(r"\s+", " ", re.sub(r";.*$", "", body, flags=re.MULTILINE))
    places = list(re.finditer(r"\(:action\s+(\w+)", body))
    ends = [place.start() for place in places[1:]] + [len(body)]
    parts = {place[1]: body[place.end() : end] for place, end in zip(places, ends, strict=False)}
    needed = (":parameters", ":precondition", ":effect")
    return {name: part for name, part in parts.items() if all(word in part for word in needed)}


def _joined(output: Any) -> str:
    """Return the text of an answer's `output`; lines of a list are joined."""
    return " ".join(map(str, output)) if isinstance(output, list) else str(output)


def left_out(text: str) -> bool:
    """Return whether the interface leaves an answer out of its counts: the `output` is JSON, but no text."""
    found = json_answer_of(text)
    return isinstance(found, dict) and not isinstance(found.get("output", ""), str)


def _block(text: str, word: str) -> str:
    """Return the bracketed text after a word; `()` where it is not closed."""
    start = text.find("(", text.find(word))
    depth = 0
    for place in range(start, len(text)) if start >= 0 else ():
        depth += {"(": 1, ")": -1}.get(text[place], 0)
        if depth == 0:
            return text[start : place + 1]
    return "()"


def parts_of(text: str) -> list[Expression]:
    """Return the literals and quantified parts of a condition, without its `and`.

    Raises:
        ValueError: it is not bracketed rightly, or too deep.
    """
    top = whole(text)
    return list(top[1:]) if isinstance(top, tuple) and top[:1] == ("and",) else [] if top == "()" else [top]


def _read(words: Iterator[str], depth: int) -> list[Expression]:
    if depth > MOST_DEEP:
        raise ValueError("too deep")
    found: list[Expression] = []
    for word in words:
        if word == "(":
            inner = _read(words, depth + 1)
            operator = inner[:1] and inner[0] in PARTS
            plain = all(isinstance(each, str) for each in inner)
            found.append(" ".join(map(str, inner)) if plain and not operator else tuple(inner))
        elif word == ")":
            return found
        else:
            found.append(word)
    return found


def predicates_in(expression: Expression) -> Iterator[str]:
    """Yield the predicates of an expression."""
    if isinstance(expression, str):
        if expression:
            yield expression.split(" ")[0]
    elif expression:
        rest = expression[2:] if expression[0] in ("forall", "exists") else expression[1:]
        for part in rest:
            yield from predicates_in(part)


def renamed(expression: Expression) -> Expression:
    """Return an expression whose quantified variables have the names of their places."""
    if isinstance(expression, tuple) and expression[:1] in (("forall",), ("exists",)) and len(expression) == 3:
        name = str(expression[1]).split(" ")[0]
        return expression[0], str(expression[1]).replace(name, "?q"), _with(expression[2], name)
    return expression


def _with(expression: Expression, name: str) -> Expression:
    if isinstance(expression, str):
        return " ".join("?q" if word == name else word for word in expression.split(" "))
    return tuple(_with(part, name) for part in expression)


def compared(found: str, gold: str, known: Mapping[str, str]) -> Counts:
    """Return the predicates of parts that match, that the gold lacks, and that are missing, by ours.

    The order of parts and the names of quantified variables do not matter; each predicate counts once in each set.
    """
    wanted = Counter(map(renamed, parts_of(gold)))
    try:
        given = Counter(map(renamed, parts_of(found)))
    except ValueError:
        given = Counter()
    return _counted((given & wanted, given - wanted, wanted - given), known)


def _counted(sets: Iterable[Iterable[Expression]], known: Mapping[str, str]) -> Counts:
    right, wrong, missed = ({name for part in some for name in predicates_in(part)} - {"()", ""} for some in sets)
    return Counts(len(right), len(wrong & known.keys()), len(missed))


def compared_as_scored(found: str, gold: str, known: Mapping[str, str]) -> Counts:
    """Return the same by the interface's rules.

    They differ in four ways. A single literal never matches one within `and`. Variables are renamed only between parts
    of the same place. A part counts as wrong, though it matches, if no part matches the gold's part of *its* place. An
    answer that is not bracketed rightly, or has another word than `and` before its parts, counts nothing at all.
    """
    try:
        one, other = whole(found), whole(gold)
    except ValueError:
        return Counts()
    if not _well_formed(one):
        return Counts()
    one, other = _aligned(one, other)
    if not (_operator(one) == _operator(other) and _operator(one) in ("and", "or")):
        return _counted(([one], [], []) if _same(one, other) else ([], [one], [other]), known)
    left, right = one[1:], other[1:]
    free, chosen, matched = set(range(len(right))), [], []
    for part in left:
        partners = [number for number in range(len(right)) if _same(part, right[number])]
        matched += [part] if partners else []
        partner = next((number for number in partners if number in free), -1)
        free.discard(partner)
        chosen.append(partner)
    wrong = [part for number, part in enumerate(left) if number not in chosen or chosen[number] == -1]
    return _counted((matched, wrong, [right[number] for number in sorted(free)]), known)


def whole(text: str) -> Expression:
    """Return the one expression of a text.

    Raises:
        ValueError: it is not bracketed rightly, or too deep.
    """
    if text.count("(") != text.count(")"):
        raise ValueError("brackets")
    found = _read(iter(re.findall(r"[()]|[^\s()]+", text)), 0)
    if len(found) != 1:
        raise ValueError("several expressions")
    return found[0] or "()"


PARTS = {"and": None, "or": None, "not": 2, "when": 3, "forall": 3, "exists": 3}
"""Operators with their number of parts, themselves included; None for any number."""


def _well_formed(expression: Expression) -> bool:
    """Return whether each list that holds lists begins with an operator, and has its number of parts."""
    if isinstance(expression, str):
        return True
    head = expression[0] if expression and isinstance(expression[0], str) else ""
    return head in PARTS and PARTS[head] in (None, len(expression)) and all(map(_well_formed, expression[1:]))


def _operator(expression: Expression) -> str:
    return str(expression[0]) if isinstance(expression, tuple) and expression else ""


def _aligned(one: Expression, other: Expression) -> tuple[Expression, Expression]:
    """Return both, of one length, with the quantified variables of parts of one place named alike."""
    if isinstance(one, str) or isinstance(other, str):
        return one, other
    kinds = _operator(one), _operator(other)
    if kinds[0] == kinds[1] and kinds[0] in ("forall", "exists"):
        names = [str(each[1]).split("-")[0].strip() for each in (one, other)]
        return one, _replaced(other, names[1], names[0])
    if not set(kinds) <= {"and", "or"}:
        return one, other
    count = max(len(one), len(other)) - 1
    parts = [(*each[1:], *("()",) * (count + 1 - len(each))) for each in (one, other)]
    pairs = [_aligned(*pair) for pair in zip(*parts, strict=True)]
    return (kinds[0], *(pair[0] for pair in pairs)), (kinds[1], *(pair[1] for pair in pairs))


def _replaced(expression: Expression, old: str, new: str) -> Expression:
    if isinstance(expression, str):
        return expression.replace(old, new) if old else expression
    return tuple(_replaced(part, old, new) for part in expression)


def _same(one: Expression, other: Expression) -> bool:
    """Return whether two parts match; those of `and` within may stand in another order."""
    if isinstance(one, str) or isinstance(other, str):
        return one == other
    if _operator(one) != _operator(other):
        return False
    if _operator(one) in ("and", "or"):
        short, long = sorted((one[1:], other[1:]), key=len)
        rest = list(long)
        for part in short:
            partner = next((each for each in rest if _same(part, each)), None)
            if partner is None:
                return False
            rest.remove(partner)
        return bool(short)
    return len(one) == len(other) and all(_same(a, b) for a, b in zip(one[1:], other[1:], strict=True))


class Operators:
    """The gold operators of a wheel, and which of them each task asks for."""

    def __init__(self, wheel: Wheel) -> None:
        self.asked: Mapping[str, list[str]] = wheel.json(f"{RESOURCES}id2action.json")
        self.known: Mapping[str, str] = wheel.json(f"{RESOURCES}predicates_category.json")
        gold = wheel.json(f"{RESOURCES}gold_action.json")
        self.gold = {name: Operator(row["action_preconditions"], row["action_effects"]) for name, row in gold.items()}

    def judged(self, answer: Answer) -> tuple[Counts, Counts]:
        """Return the counts of an answer by the interface's rules, and by ours, where a missing operator is missed."""
        operators, skipped = operators_of(answer.text), left_out(answer.text)
        theirs = ours = Counts()
        for name in self.asked.get(answer.task, ()):
            gold, found = self.gold[name], operators.get(name)
            for number in range(2):
                text = "()" if found is None else found[number]
                ours = ours.plus(compared(text, gold[number], self.known))
                if found is not None and not skipped:
                    theirs = theirs.plus(compared_as_scored(text, gold[number], self.known))
        return theirs, ours
