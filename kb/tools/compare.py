"""Our knowledge against another's, fact by fact, with the reason for every deliberate difference.

The other may be a directory of our own files, or of the release's five JSON files (properties_data, object_states,
object_script_placing, class_name_equivalence, affordances), as many as there are.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from hearth.kb.knowledge import Knowledge
from hearth.kb.loading.load import load
from hearth.kb.tools.correction_reasons import FIELDS, Reasons, root_of
from hearth.kb.tools.published_knowledge import Fact, is_release, read_release


class Difference(NamedTuple):
    """A fact one side holds and the other does not.

    Attributes:
        table: one of `FIELDS`.
        fact: its parts.
        kind: `missing` (theirs, not ours) or `added` (ours about a class of theirs).
        why: the reason, from corrections.yaml; empty when there is none.
    """

    table: str
    fact: Fact
    kind: str
    why: str


@dataclass(frozen=True, slots=True)
class Comparison:
    """The differences, and their number.

    Attributes:
        theirs: facts of the other, by table.
        held: how many of them we hold, by table.
        differences: the rest, and our additions, in order.
        cells: for affordances, how many accepted cells of the other come `by rule` and `by exception`, by position.
    """

    theirs: Mapping[str, int]
    held: Mapping[str, int]
    differences: tuple[Difference, ...]
    cells: Mapping[str, Mapping[str, int]]

    def count(self, table: str, kind: str, explained: bool) -> int:
        """Return how many differences of a table are of a kind, with or without a reason."""
        return sum(1 for d in self.differences if d.table == table and d.kind == kind and bool(d.why) == explained)


def compare(knowledge: Knowledge, other: Path) -> Comparison:
    """Compare with the facts in a directory.

    Raises:
        HearthError: the directory holds neither kind of files, or they cannot be read.
    """
    reasons = Reasons(knowledge)
    given = read_release(other) if is_release(other) else facts_of(load(other))
    theirs = {table: {_ours(knowledge, reasons, table, fact) for fact in facts} for table, facts in given.items()}
    theirs["synonyms"] = {(name, other) for name, other in theirs.get("synonyms", ()) if name != other}
    ours = facts_of(knowledge)
    differences: list[Difference] = []
    for table, facts in theirs.items():
        subject = FIELDS[table].index("class" if "class" in FIELDS[table] else "object")
        known = {fact[subject] for fact in facts}
        actions = {fact[0] for fact in facts} if table == "affordances" else None
        added = (
            fact for fact in ours[table] - facts if fact[subject] in known and (actions is None or fact[0] in actions)
        )
        differences += [
            Difference(table, fact, "missing", reasons.removed(table, fact)) for fact in sorted(facts - ours[table])
        ]
        differences += [Difference(table, fact, "added", reasons.added(table, fact)) for fact in sorted(added)]
    return Comparison(
        theirs={table: len(facts) for table, facts in theirs.items()},
        held={table: len(facts & ours[table]) for table, facts in theirs.items()},
        differences=tuple(differences),
        cells=_cells(knowledge, theirs.get("affordances", set())),
    )


def rejection(knowledge: Knowledge) -> float:
    """Return the share of random steps that the grammar rejects: any action that takes objects, with any objects."""
    size = len(knowledge.objects)
    shares = []
    for action in knowledge.actions.values():
        if not action.arity:
            continue
        accepted = 1.0
        for need in action.grammar:
            things = knowledge.objects.values()
            accepted *= sum(need.accepts(o.properties, o.name, o.category == "Rooms") for o in things) / size
        shares.append(1 - accepted)
    return sum(shares) / len(shares)


def facts_of(knowledge: Knowledge) -> dict[str, set[Fact]]:
    """All our facts, by table; a class that is another's second name has them by that one's name."""
    facts: dict[str, set[Fact]] = {table: set() for table in FIELDS}
    for name, thing in knowledge.objects.items():
        root = thing.same_as or name
        facts["properties"].update((root, prop) for prop in thing.properties)
        facts["states"].update((root, state) for state in thing.states)
        facts["synonyms"].update((name, other) for other in knowledge.same_class(name) if other != name)
        facts["placements"].update((p.object, p.relation, p.destination) for p in knowledge.placements(name))
        is_room = thing.category == "Rooms"
        for action in knowledge.actions.values():
            for position, need in enumerate(action.grammar):
                if need.accepts(thing.properties, name, is_room):
                    facts["affordances"].add((action.name, str(position), name))
    return facts


def _ours(knowledge: Knowledge, reasons: Reasons, table: str, fact: Fact) -> Fact:
    """Return the other's fact in our words: our names of classes, actions and states."""
    if table == "affordances":
        action, thing = knowledge.action(fact[0]), knowledge.object_class(fact[2])
        return (action.name if action else fact[0], fact[1], thing.name if thing else fact[2])
    if table == "placements":
        return (root_of(knowledge, fact[0]), fact[1], root_of(knowledge, fact[2]))
    if table == "synonyms":
        thing = knowledge.object_class(fact[0])
        return (thing.name if thing else fact[0], fact[1])
    if table == "states":
        return (root_of(knowledge, fact[0]), reasons.renamed.get(fact[1], fact[1].upper()))
    return (root_of(knowledge, fact[0]), *fact[1:])


def _cells(knowledge: Knowledge, accepted: Iterable[Fact]) -> dict[str, dict[str, int]]:
    """Return how the other's accepted cells come about here: from properties, or from being listed one by one."""
    counts: dict[str, dict[str, int]] = {}
    for action_name, position, class_name in accepted:
        action, thing = knowledge.action(action_name), knowledge.object_class(class_name)
        row = counts.setdefault(position, {"rule": 0, "exception": 0, "refused": 0})
        if action is None or thing is None or int(position) >= action.arity:
            row["refused"] += 1
            continue
        need = action.grammar[int(position)]
        by_rule = need.anything or not need.any_of.isdisjoint(thing.properties)
        by_rule = by_rule or (bool(need.all_of) and need.all_of <= thing.properties)
        taken = need.accepts(thing.properties, thing.name, thing.category == "Rooms")
        row["rule" if taken and by_rule else "exception" if taken else "refused"] += 1
    return counts
