"""One clause of a request: the acts that it asks for, about things of a home."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence

from hearth.kb.language.noun_phrases import things_in
from hearth.kb.language.pronouns import Mentioned
from hearth.kb.language.reading_modes import Fuzzy
from hearth.kb.language.sentences import asked_steps
from hearth.kb.language.step_understanding import Candidate
from hearth.models.reading.antecedents import DOORS, MANY, Antecedents
from hearth.models.reading.clause_matches import matches, plain_words, variants
from hearth.models.reading.kept_states import BACKWARD, BANNED_PLACE, CHANGES, FURTHER, HANDS_OFF, LEFT_ALONE, STAYS
from hearth.models.reading.mentioned_nodes import Refs, Scene, fits
from hearth.models.reading.mentions import SEVERAL, Mention, mentions_in, refers_back
from hearth.models.reading.request_table import ActTemplate, Pattern, Request, is_slot, number_in, words
from hearth.models.reading.rewordings import TAKES_TOOL, rewordings
from hearth.models.reading.spoken_things import ANY_ACT, NO_ACT, Act, Clause, Spoken, bound, spoken_of, together
from hearth.models.reading.usual_places import usual_place, usual_way
from hearth.schemas.program import ObjectRef

PUT_AWAY = "PutAway"
"""The act of the table that brings a thing to its usual place."""

PUT_TO = "PutTo"
"""The act of the table that puts a thing in or on a place, as is usual for it."""

PUT_NEAR = "PutNear"
"""The act of the table that puts a thing on the furniture of another, or else carries it there."""

CONSUME = "Consume"
"""The act of the table that eats food, and drinks what is a drink alone."""

MOST_WORDS = 60
"""Words of a clause, at most; a longer one is not read."""

DEEPEST = 2
"""Rewordings of a clause within one another, at most."""

_IS = re.compile(r"'s (?=(?:[a-z]+ ?){1,3}$)")
_JOINED = re.compile(r" (?:and|or|nor) ")
_SUBJECT = re.compile(r"(.+?) (?:is|are|was|were|has|have|needs?) .+")
_THERE_IS = re.compile(r"^((?:in|on|at|by|under|next to) .+?) (?:there )?(?:is|are|lies|lie|stands|sits|hangs) (.+)$")
_SPILLED = re.compile(
    r"^.+? (?:spilled|spilt|dropped|knocked over|smeared|splashed|dribbled) .+? "
    r"(?:all over|on to|onto|on|over) (.+)$"
)
_FIRST_WORDS = re.compile(
    r"^(?:(?:first|then|and|next|finally|now|please|off to|over to|so"
    r"|i would like|i want|i need|i could use|give me),? )+"
)
_PLACE_IN_ORDER = re.compile(r" (?:first|second|third|next|last|quick|now)$")
_NEGATION = re.compile(
    r"(?:no(?= [a-z]+ing\b)|do not|don't|dont|never|not|without|avoid|refrain from|no need to|there is no need to"
    r"|instead of|rather than"
    r"|(?:you )?(?:do not|don't|needn't|need not|shouldn't|should not|must not|mustn't) (?:need to|have to)?) ?(.+)"
)
TAKEN_BACK = frozenset({"never mind", "forget it", "scratch that", "cancel that", "on second thought"})
"""Words that take a request back: what is left of it is not known."""

_USE = re.compile(r"(?:using|use|touching) (.+)")
_LEFT_SO = re.compile(r"(?:do not|don't|never) leave .+ (?:on|open|running|plugged in)\b")
"""A state in which a thing is not to be left: it is to be changed."""

_LEFT = re.compile(r"(?:put|leave|place|set|lay|drop|keep|stow|store|stand) ")
_REMINDER = re.compile(r"(?:do not|don't|dont|never) (?:forget|hesitate)")


def unknown_ban(text: str) -> tuple[Act, ...]:
    """Return a ban on something that is not among our acts, in the words of the text."""
    return (Act(NO_ACT, (), text),)


class ClauseReader:
    """The reader of one text's clauses.

    Attributes:
        missing: what the home lacks of the things that were named.
        placed: the places on which things were put so far.
    """

    def __init__(self, scene: Scene) -> None:
        self.scene, self.known = scene, scene.known
        self.antecedents = Antecedents(scene)
        self.missing: dict[str, None] = {}
        self.placed: dict[ObjectRef, Refs] = {}

    def read(self, text: str, spoken: Sequence[Spoken], *, steps: bool = True, depth: int = 0) -> Clause | None:
        """Return what a clause asks for; None where it is not understood.

        Args:
            text: in small letters.
            spoken: the things of the clauses before, the last first.
            steps: also as the reader of programs in words does, and in other words; not for several clauses.
            depth: how often the clause was reworded.
        """
        plain = plain_words(text)
        if not plain or plain in TAKEN_BACK or len(plain.split()) > MOST_WORDS:
            return None
        if _LEFT_SO.match(plain) and (found := self._asked(plain, spoken, steps=False)) is not None:
            return found
        if _LEFT_SO.match(plain) and depth < DEEPEST and (found := self._reworded(plain, spoken, depth, steps)):
            return found
        if (kept := self._kept_so(plain, spoken)) is not None:
            return kept
        if (negated := _NEGATION.fullmatch(plain)) and not _REMINDER.match(plain):
            found = self._asked(negated[1], spoken, steps)
            if found is None:
                return self._untouched(negated[1], spoken, is_ban=True)
            return Clause(forbidden=found.acts, spoken=found.spoken)
        for each in dict.fromkeys((self._placed(plain, spoken), plain)):
            if (found := self._asked(each, spoken, steps)) is not None:
                return found
        if (back := BACKWARD.fullmatch(plain)) and not FURTHER.search(back[2]):
            other = self._banned(back[2], spoken, steps)
            self.scene.avoided = frozenset(ref.name for act in other for ref in act.objects)
            first = self._asked(back[1], spoken, steps)
            self.scene.avoided = frozenset()
            if first:
                return first._replace(forbidden=other)
        return self._reworded(plain, spoken, depth, steps) if depth < DEEPEST else None

    def _kept_so(self, text: str, spoken: Sequence[Spoken]) -> Clause | None:
        """Return the ban of a clause by which things stay as they are: `hands off the stove`."""
        if found := (HANDS_OFF.fullmatch(text) or LEFT_ALONE.fullmatch(text)):
            return self._untouched(found[1], spoken)
        if found := STAYS.fullmatch(text):
            changed = self._asked(f"{CHANGES[found[2]]} {found[1]}", spoken, steps=False)
            return Clause(forbidden=changed.acts, spoken=changed.spoken) if changed else None
        return None

    def _untouched(self, text: str, spoken: Sequence[Spoken], *, is_ban: bool = False) -> Clause | None:
        """Return a ban on any act with some things; None where the words name none."""
        mentions = mentions_in(self.known, text)
        if not mentions or (is_ban and any(each.back for each in mentions)):
            return None
        found = self._asked(f"touch {text}", spoken, steps=False)
        return Clause(forbidden=tuple(act._replace(action=ANY_ACT) for act in found.acts)) if found else None

    def _banned(self, text: str, spoken: Sequence[Spoken], steps: bool) -> tuple[Act, ...]:
        """Return the acts that a ban names; `NO_ACT` where it names none of ours, as in `without a noise`.

        A ban on using a thing is one on any act with it.
        """
        if use := _USE.fullmatch(text):
            touched = self._asked(f"touch {use[1]}", spoken, steps)
            return tuple(act._replace(action=ANY_ACT) for act in touched.acts) if touched else unknown_ban(text)
        if place := BANNED_PLACE.match(text):
            found = self._asked(f"{'sit' if place[1] in ('on', 'in') else 'go'} {text}", spoken, steps)
        else:
            found = self._asked(text, spoken, steps)
        return unknown_ban(text) if found is None else found.acts

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
                if clauses[1:] and each == clauses[0] and each.startswith(TAKES_TOOL):
                    read = read._replace(spoken=tuple(one._replace(is_place=True) for one in read.spoken))
                now = (*read.spoken, *now)
                found = Clause(found.acts + read.acts, found.goals + read.goals, read.spoken + found.spoken,
                               found.forbidden + read.forbidden)  # fmt: skip
            else:
                return found
        return None

    def stated(self, text: str) -> Clause:
        """Return a clause that asks for nothing, with the things that it speaks of."""
        found: list[Spoken] = []
        text = _IS.sub(" is ", text)
        if spilled := _SPILLED.match(text):
            return self.named(spilled[1]) or Clause()
        text = _THERE_IS.sub(r"\2 \1", text)
        if (subject := _SUBJECT.match(text)) and (named := self.named(subject[1])):
            found += named.spoken
        for name in things_in(self.known, text):
            self.scene.speak_of_rooms((name,))
            if refs := self.scene.some((name,), 1):
                found.append(Spoken(refs, "", bool(found) and not _JOINED.search(text)))
        things = [each for each in found if not each.is_place and len(each.refs) == 1]
        if len(things) > 1 and _JOINED.search(text):
            found.append(Spoken(tuple(dict.fromkeys(ref for each in things for ref in each.refs)), ""))  # `them both`
        return Clause(spoken=tuple(found))

    def named(self, text: str) -> Clause | None:
        """Return a part that only names things, of which the next may say more; None where it does not."""
        plain = _PLACE_IN_ORDER.sub("", plain_words(text))
        is_bare = _FIRST_WORDS.sub("", text.strip(" ,.!?")).startswith(plain)
        mentions = mentions_in(self.known, plain)
        refs = [self.scene.things(each, frozenset()) for each in mentions if not each.back]
        if not refs or not all(refs):
            return None
        return Clause(spoken=tuple(Spoken(each, "") for each in refs), named=plain if is_bare else "")

    def _asked(self, text: str, spoken: Sequence[Spoken], steps: bool) -> Clause | None:
        lacking: dict[str, str] = {}
        for variant in variants(text):
            for request, pattern, slots in matches(self.known, variant):
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
                spoken = [each for each in spoken if each.refs not in things.values()]
                things[name] = self.antecedents.referred(
                    needs, "", tuple(sorted(spoken, key=lambda each: not each.is_place))
                )
            if not all(things.values()):
                return None
            made = self._made(way, things, count, text)
            if made is not None:
                acts, named = made
                is_back = {name for name in pattern.needs if slots[name] and refers_back(self.known, slots[name])}
                goals = tuple(each for goal in request.goal for each in bound(goal, things, named))
                spoken = spoken_of(acts, things, way, is_back, named)
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
                refs = self.antecedents.another(needs, spoken)
            elif mention.back:
                refs = self.antecedents.referred(needs, action, spoken, is_many=mention.words in MANY)
                if 0 < mention.count <= len(refs):
                    refs = refs[: mention.count]
                elif mention.count > 0 and refs:
                    refs = self._by_class((refs[0].name,), mention.count)
            elif mention.words in DOORS and (own := self.antecedents.opened(spoken, mention.words)):
                refs = own
            elif own := self.antecedents.meant_before(mention, spoken):
                refs = own if all(fits(self.known, ref.name, needs) for ref in own) else ()
            else:
                refs = self.scene.things(mention, needs, action)
            if not refs and not mention.back and any(fits(self.known, name, needs) for name in mention.classes):
                self.missing.setdefault(mention.words)
            if not refs:
                return ()
            found += [ref for ref in refs if ref not in found]
        return tuple(found)

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
        acts = tuple(act for group in together(bound) for act in self._repeated(group, text))
        return (acts, named) if all(each.action for each in acts) else None

    def _argument(self, names: tuple[str, ...], many: int, things: Mapping[str, Refs], named: dict[str, Refs]) -> Refs:
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
                    place = self.placed.get(objects[1], ()) or self.scene.support(objects[1])
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
                    if act.action == "PutBack" and len(objects) > 1:
                        self.placed[objects[0]] = objects[1:]
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
                return Clause(tuple(acts), (), spoken_of(acts, {}, ()))
        return None

    def _is_afforded(self, meant: Candidate) -> bool:
        return all(self.known.affords(meant.action.name, at, name) for at, name in enumerate(meant.names))

    def _named(self, name: str, number: int, spoken: Sequence[Spoken]) -> ObjectRef | None:
        before = next((ref for each in spoken for ref in each.refs if ref.name == name), None)
        if before is not None and number == 1:
            return before
        refs = self.scene.some((name,), number)
        return refs[number - 1] if refs else None
