"""One clause of a request: the acts that it asks for, about things of a home."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from functools import lru_cache
from typing import NamedTuple

from hearth.kb.knowledge import Knowledge
from hearth.kb.language.english_lexicon import is_verb, verb_lemmas
from hearth.kb.language.noun_phrases import things_in
from hearth.kb.language.pronouns import Mentioned
from hearth.kb.language.reading_modes import Fuzzy
from hearth.kb.language.sentences import asked_steps
from hearth.kb.language.step_understanding import Candidate
from hearth.models.reading.mentions import SEVERAL, Mention, mentions_in
from hearth.models.reading.request_table import ActTemplate, Pattern, Request, is_slot, number_in, requests, words
from hearth.models.reading.rewordings import rewordings
from hearth.models.reading.scene import Refs, Scene, fits
from hearth.models.reading.usual_places import usual_place, usual_way
from hearth.schemas.literals import Literal, Name
from hearth.schemas.program import ObjectRef

PUT_AWAY = "PutAway"
"""The act of the table that brings a thing to its usual place."""

PUT_TO = "PutTo"
"""The act of the table that puts a thing in or on a place, as is usual for it."""

PUT_NEAR = "PutNear"
"""The act of the table that puts a thing on what another stands on, or else carries it there."""

CONSUME = "Consume"
"""The act of the table that eats food, and drinks what is a drink alone."""

DEEPEST = 2
"""Rewordings of a clause within one another, at most."""

_CLOSE = "Close"
_DOORS = frozenset({"the door", "the doors", "its door", "the lid", "door"})
_HAS_DOOR = ("CAN_OPEN", "CONTAINERS")
_OPENS = frozenset({"CAN_OPEN", "HAS_SWITCH"})
_NEGATION = re.compile(
    r"(?:do not|don't|dont|never|not|without|avoid|refrain from|no need to|there is no need to|instead of|rather than"
    r"|(?:you )?(?:do not|don't|needn't|need not|shouldn't|should not|must not|mustn't) (?:need to|have to)?) ?(.+)"
)
_WHERE = re.compile(r"(?:to|on|in|into|near|by|over|up|out|and|back|home|online|outside|through|around|for|down|inside|next|stand|close to)\b")
_LEFT = re.compile(r"(?:put|leave|place|set|lay|drop|keep|stow|store|stand) ")
_REMINDER = re.compile(r"(?:do not|don't|dont|never) (?:forget|hesitate)")
_BACKWARD = re.compile(r"(.+?),? (?:without|instead of|rather than|but not|and not|but don't(?! forget)|but do not(?! forget)|and don't(?! forget)|but never|as long as you (?:don't|do not)"
    r"|provided you (?:don't|do not)|so long as you (?:don't|do not)) ((?:[a-z]+ing|[a-z]+) .+)"
)


class Act(NamedTuple):
    """Something to do.

    Attributes:
        action: its name.
        objects: its things.
        words: the clause that asks for it.
        optional: whether it is left out where it cannot be done.
    """

    action: str
    objects: Refs
    words: str
    optional: bool = False


class Spoken(NamedTuple):
    """Things that were spoken of together.

    Attributes:
        refs: the things.
        action: what was done with them first.
        is_place: whether they were the place of others.
    """

    refs: Refs
    action: str
    is_place: bool = False


class Clause(NamedTuple):
    """A clause that is understood.

    Attributes:
        acts: that it asks for.
        goals: what is to hold at the end besides.
        spoken: its things, the last first.
        forbidden: acts that are not to be done.
    """

    acts: tuple[Act, ...] = ()
    goals: tuple[Literal[Name], ...] = ()
    spoken: tuple[Spoken, ...] = ()
    forbidden: tuple[Act, ...] = ()


class ClauseReader:
    """The reader of one text's clauses.

    Attributes:
        missing: what the home lacks of the things that were named.
    """

    def __init__(self, scene: Scene) -> None:
        self.scene, self.known = scene, scene.known
        self.missing: dict[str, None] = {}

    def read(self, text: str, spoken: Sequence[Spoken], *, steps: bool = True, depth: int = 0) -> Clause | None:
        """Return what a clause asks for; None where it is not understood.

        Args:
            text: in small letters.
            spoken: the things of the clauses before, the last first.
            steps: also as the reader of programs in words does, and in other words; not for several clauses.
            depth: how often the clause was reworded.
        """
        plain = plain_words(text)
        if not plain:
            return None
        if (negated := _NEGATION.fullmatch(plain)) and not _REMINDER.match(plain):
            found = self._asked(negated[1], spoken, steps)
            return Clause(forbidden=found.acts, spoken=found.spoken) if found else None
        plain = self._placed(plain, spoken)
        if (found := self._asked(plain, spoken, steps)) is not None:
            return found
        if back := _BACKWARD.fullmatch(plain):
            first, other = (self._asked(back[n], spoken, steps) for n in (1, 2))
            if first:
                return first._replace(forbidden=other.acts if other else ())
        return self._reworded(plain, spoken, depth, steps) if depth < DEEPEST else None

    def _placed(self, text: str, spoken: Sequence[Spoken]) -> str:
        """Return a clause with the name of the place that its `there` stands for."""
        if not text.endswith(" there"):
            return text
        for each in spoken:
            name = each.refs[0].name.replace("_", " ")
            if self.known.is_room(each.refs[0].name):
                return f"{text.removesuffix(' there')} in the {name}"
            if each.is_place and _LEFT.match(text):
                way = usual_way(self.known, each.refs[0], each.refs[0])
                return f"{text.removesuffix(' there')} {'in' if way == 'PutIn' else 'on'} the {name}"
        return text

    def _reworded(self, text: str, spoken: Sequence[Spoken], depth: int, steps: bool) -> Clause | None:
        """Return what a clause asks for in other words."""
        for clauses in rewordings(self.known, text):
            found, now = Clause(), tuple(spoken)
            for each in clauses:
                read = self.read(each, now, steps=steps, depth=depth + 1)
                if read is None:
                    break
                now = (*read.spoken, *now)
                found = Clause(found.acts + read.acts, found.goals + read.goals, read.spoken + found.spoken,
                               found.forbidden + read.forbidden)  # fmt: skip
            else:
                return found
        return None

    def told(self, text: str) -> Clause:
        """Return a clause that asks for nothing, with the things that it speaks of."""
        found = []
        for name in things_in(self.known, text):
            if refs := self.scene.some((name,), 1):
                found.append(Spoken(refs, "", bool(found)))
        return Clause(spoken=tuple(found))

    def named(self, text: str) -> Clause | None:
        """Return a part that only names things, of which the next may say more; None where it is no name."""
        mentions = mentions_in(self.known, plain_words(text))
        refs = [self.scene.things(each, frozenset()) for each in mentions if not each.back]
        return Clause(spoken=tuple(Spoken(each, "") for each in refs)) if refs and all(refs) else None

    def _asked(self, text: str, spoken: Sequence[Spoken], steps: bool) -> Clause | None:
        lacking: dict[str, str] = {}
        for variant in variants(text):
            for request, pattern, slots in _matches(self.known, variant):
                before = len(self.missing)
                if lacking and {**slots} != lacking:
                    continue  # the home lacks a thing: the words do not mean others for that
                found = self._meant(request, pattern, slots, text, spoken)
                if found is not None:
                    return found
                if len(self.missing) > before:
                    lacking = {**slots}
        return self._by_steps(text, spoken) if steps else None

    def _meant(
        self, request: Request, pattern: Pattern, slots: Mapping[str, str], text: str, spoken: Sequence[Spoken]
    ) -> Clause | None:
        """Return what a request means here; None where a slot names nothing that fits."""
        count = number_in(slots.get("n", "")) or 1
        for way in request.ways:
            things: dict[str, Refs] = {}
            for name, needs in pattern.needs.items():
                if not slots[name]:
                    continue
                first = next((act.action for act in way if name in act.slots), "")
                things[name] = self._things(slots[name], needs, first, spoken)
            for name, needs in request.it.items():
                things[name] = self._referred(needs, "", tuple(sorted(spoken, key=lambda each: not each.is_place)))
            if not all(things.values()):
                return None
            made = self._made(way, things, count, text)
            if made is not None:
                acts, named = made
                is_back = {name for name in pattern.needs if slots[name] and _is_back(self.known, slots[name])}
                goals = tuple(each for goal in request.goal for each in _bound(goal, things, named))
                spoken = _spoken(acts, things, way, is_back, named)
                return Clause(acts, goals, (*spoken, *self._places(slots.values())))
        return None

    def _places(self, texts: Iterable[str]) -> Iterator[Spoken]:
        """Yield the furniture in or on which things are said to be."""
        for mention in (each for text in texts if text for each in mentions_in(self.known, text)):
            for _, names in mention.places:
                if refs := self.scene.some(names, 1):
                    yield Spoken(refs, "", True)

    def _things(self, text: str, needs: frozenset[str], action: str, spoken: Sequence[Spoken]) -> Refs:
        found: list[ObjectRef] = []
        for mention in mentions_in(self.known, text):
            if mention.another:
                refs = self._another(needs, spoken)
            elif mention.back:
                refs = self._referred(needs, action, spoken)
            elif mention.words in _DOORS and (own := self._opened(spoken)):
                refs = own
            else:
                refs = self.scene.things(mention, needs, action)
            if not refs and not mention.back and any(fits(self.known, name, needs) for name in mention.classes):
                self.missing.setdefault(mention.words)
            if not refs:
                return ()
            found += [ref for ref in refs if ref not in found]
        return tuple(found)

    def _another(self, needs: frozenset[str], spoken: Sequence[Spoken]) -> Refs:
        groups = [each.refs for each in spoken if not each.is_place]
        refs = next((each for each in groups if all(fits(self.known, ref.name, needs) for ref in each)), ())
        taken = {ref.node for each in spoken for ref in each.refs if ref.node is not None}
        return self.scene.others(refs, taken) if refs else ()

    def _opened(self, spoken: Sequence[Spoken]) -> Refs:
        """Return the furniture that was spoken of last, where it has a door of its own."""
        last = spoken[0].refs if spoken and (spoken[0].is_place or spoken[0].action == "Open") else ()
        return last if all(self.known.has(ref.name, need) for ref in last for need in _HAS_DOOR) else ()

    def _referred(self, needs: frozenset[str], action: str, spoken: Sequence[Spoken]) -> Refs:
        """Return the things of words before that `it` or `them` stands for."""
        groups = list(spoken)
        if action == _CLOSE:
            groups.sort(key=lambda each: (each.action != "Open", not each.is_place))
        elif needs.isdisjoint(_OPENS):
            groups.sort(key=lambda each: each.is_place)
        return next((each.refs for each in groups if all(fits(self.known, ref.name, needs) for ref in each.refs)), ())

    def _made(
        self, way: Sequence[ActTemplate], things: Mapping[str, Refs], count: int, text: str
    ) -> tuple[tuple[Act, ...], dict[str, Refs]] | None:
        """Return the acts of a way, and the things of classes that it names; None where the home lacks one."""
        named: dict[str, Refs] = {}
        bound: list[tuple[ActTemplate, list[Refs]]] = []
        for act in way:
            refs = [self._argument(names, many or count, things, named) for names, many in act.arguments]
            if all(refs):
                bound += [(act, refs)] * act.times
            elif not act.optional:
                return None
        acts = tuple(act for group in _together(bound) for act in self._repeated(group, text))
        return (acts, named) if all(each.action for each in acts) else None

    def _argument(
        self, names: tuple[str, ...], many: int, things: Mapping[str, Refs], named: dict[str, Refs]
    ) -> Refs:
        if "/" in names[0]:
            name, _, slot = names[0].partition("/")
            rooms = tuple(ref.name for ref in things.get(slot, ()))
            return self.scene.things(Mention(name, (name,), 1, (("INSIDE", rooms),)), frozenset())
        if names[0].endswith("@"):
            return self.scene.contents(things.get(names[0][0], ()))
        if is_slot(names[0]):
            return things.get(names[0], ())
        key = "|".join(names)
        given = (refs for refs in things.values() if refs and all(ref.name in names for ref in refs))
        if key not in named or len(named[key]) != max(many, 1):
            found = next(given, ()) or self._by_class(names, many)
            if not found:
                return ()
            named[key] = found
            named.setdefault(names[0], found)
        return named[key]

    def _by_class(self, names: tuple[str, ...], many: int) -> Refs:
        table = words().things
        classes = tuple(each for name in names for each in (table[name] if name not in self.known.objects else (name,)))
        if many == SEVERAL:
            return self.scene.things(Mention(names[0], classes, SEVERAL, is_group=True), frozenset())
        return self.scene.some(classes, many)

    def _repeated(self, group: Sequence[tuple[ActTemplate, list[Refs]]], text: str) -> Iterator[Act]:
        """Yield acts that follow each other with each of their things in turn."""
        times = max((len(refs) for _, several in group for refs in several), default=1)
        for n in range(times):
            for act, several in group:
                objects = tuple(refs[n % len(refs)] for refs in several)
                if act.action == PUT_AWAY:
                    action, place = usual_place(self.scene, objects[0])
                    yield Act(action, (objects[0], *place), text)
                elif act.action == PUT_NEAR:
                    place = self.scene.support(objects[1])
                    if place:
                        yield Act("PutBack", (objects[0], *place), text)
                    else:
                        yield Act("Grab", objects[:1], text)
                        yield Act("Walk", objects[1:], text)
                elif act.action == CONSUME:
                    yield Act("Eat" if self.known.has(objects[0].name, "EATABLE") else "Drink", objects, text)
                elif act.action == PUT_TO:
                    yield Act(usual_way(self.known, *objects), objects, text)
                else:
                    yield Act(self._fitting(act.action, objects), objects, text, act.optional)

    def _fitting(self, action: str, objects: Refs) -> str:
        """Return an act, or that of putting in where nothing is put on a place, as a sink."""
        is_on = action == "PutBack" and len(objects) > 1
        if is_on and not self.known.affords("PutBack", 1, objects[1].name):
            return "PutIn" if self.known.affords("PutIn", 1, objects[1].name) else action
        return action

    def _by_steps(self, text: str, spoken: Sequence[Spoken]) -> Clause | None:
        """Return what the reader of programs in words understands; None where it understands nothing."""
        said = tuple(Mentioned(each.action, tuple(ref.name for ref in each.refs[:1])) for each in spoken)
        for fuzzy in (Fuzzy.OFF, Fuzzy.TYPOS):
            acts: list[Act] = []
            for asked in asked_steps(self.known, text, said, fuzzy):
                if asked.left_out or not self._is_afforded(asked.meant):
                    return None
                refs = tuple(self._named(name, asked.instance if not at else 1, spoken)
                             for at, name in enumerate(asked.meant.names))  # fmt: skip
                if not all(refs):
                    self.missing.update(dict.fromkeys(asked.meant.names))
                    return None
                acts.append(Act(asked.meant.action.name, tuple(ref for ref in refs if ref), text))
            if acts:
                return Clause(tuple(acts), (), _spoken(acts, {}, ()))
        return None

    def _is_afforded(self, meant: Candidate) -> bool:
        return all(self.known.affords(meant.action.name, at, name) for at, name in enumerate(meant.names))

    def _named(self, name: str, number: int, spoken: Sequence[Spoken]) -> ObjectRef | None:
        before = next((ref for each in spoken for ref in each.refs if ref.name == name), None)
        if before is not None and number == 1:
            return before
        refs = self.scene.some((name,), number)
        return refs[number - 1] if refs else None


def _together(bound: Sequence[tuple[ActTemplate, list[Refs]]]) -> Iterator[list[tuple[ActTemplate, list[Refs]]]]:
    """Yield the acts that are done with each of several things in turn, as grabbing and putting down are."""
    group: list[tuple[ActTemplate, list[Refs]]] = []
    for act, refs in bound:
        many = [each for each in refs if len(each) > 1]
        if group and many and many[0] in group[-1][1] and len(many[0]) > 1:
            group.append((act, refs))
            continue
        if group:
            yield group
        group = [(act, refs)]
    if group:
        yield group


def _bound(goal: Literal[str], things: Mapping[str, Refs], named: Mapping[str, Refs]) -> Iterator[Literal[Name]]:
    (term,) = goal.terms
    refs = things.get(term) or named.get(term, ())
    yield from (Literal(goal.name, (ref.node if ref.node is not None else ref.name,), goal.negated) for ref in refs)


def _is_back(known: Knowledge, text: str) -> bool:
    return all(each.back for each in mentions_in(known, text))


def _spoken(
    acts: Sequence[Act],
    things: Mapping[str, Refs],
    way: Sequence[ActTemplate],
    is_back: Collection[str] = (),
    named: Mapping[str, Refs] = {},
) -> tuple[Spoken, ...]:
    """Return the things of acts, the last first; of a table's row, those of its slots, and then of its classes.

    What a pronoun stood for comes first: the next one stands for the same.
    """
    if not things:
        return tuple(Spoken((ref,), act.action, at > 0) for act in reversed(acts) for at, ref in enumerate(act.objects))
    found = []
    for name, refs in things.items():
        uses = [(act.action, at) for act in way for at, (names, _) in enumerate(act.arguments) if names == (name,)]
        is_place = (bool(uses) and uses[0][1] > 0) or name in "pd"
        found.append(Spoken(refs, uses[0][0] if uses else "", is_place and name not in is_back))
    found.sort(key=lambda each: any(things[name] == each.refs for name in is_back))
    others = (Spoken(refs, "", True) for refs in dict.fromkeys(named.values()) if refs not in things.values())
    return (*reversed(found), *others)


@lru_cache(maxsize=4096)
def _matches(known: Knowledge, text: str) -> tuple[tuple[Request, Pattern, Mapping[str, str]], ...]:
    """Return the requests that a clause may be, with the words of their slots: those whose things are of their kind."""
    found = []
    for request in requests():
        for pattern in request.patterns:
            match = pattern.pattern.fullmatch(text)
            if match and all(
                match[name] is None or _may_be(known, match[name], needs, is_one=name == "p")
                for name, needs in pattern.needs.items()
            ):
                found.append((request, pattern, match.groupdict("")))
    return tuple(found)


def _may_be(known: Knowledge, text: str, needs: frozenset[str], *, is_one: bool) -> bool:
    mentions = mentions_in(known, text)
    return 0 < len(mentions) <= (1 if is_one else len(mentions)) and all(
        each.back or any(fits(known, name, needs) for name in each.classes) for each in mentions
    )


@lru_cache(maxsize=4096)
def plain_words(text: str) -> str:
    """Return a clause without courtesy, and without openings such as `could you`."""
    table = words()
    text = " ".join(table.courtesy.sub(" ", text.lower()).split()).strip(" ,;:.!?-\"")
    while (found := table.openings.match(text)) and found.end():
        text = text[found.end() :].strip(" ,")
    first, _, rest = text.partition(" ")
    if first == "go" and rest and is_verb(rest.partition(" ")[0]) and not _WHERE.match(rest):
        text = rest
    return re.sub(r" +([,;])", r"\1", text)


@lru_cache(maxsize=4096)
def variants(text: str) -> tuple[str, ...]:
    """Return the wordings of a clause: with its verb in the base form, and without endings that change nothing."""
    found: dict[str, None] = {}
    for each in _shortened(text):
        found.setdefault(each)
        for base in _based(each):
            found.setdefault(base)
    return tuple(found)


def _shortened(text: str) -> Iterator[str]:
    yield text
    shorter = [text]
    for _ in range(3):
        found = [left for each in shorter for pattern in words().endings if (left := pattern.sub("", each)) != each]
        shorter = [each.strip(" ,") for each in dict.fromkeys(found) if each.strip(" ,")]
        yield from shorter


def _based(text: str) -> Iterator[str]:
    first, space, rest = text.partition(" ")
    for lemma in verb_lemmas(first):
        if lemma != first:
            yield f"{lemma}{space}{rest}"


__all__ = ["Act", "Clause", "ClauseReader", "Spoken", "plain_words", "variants"]
