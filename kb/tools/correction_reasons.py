"""The evidence of facts: the reasons of corrections.yaml for differing from the release."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from hearth.kb.knowledge import Knowledge
from hearth.kb.loading.source_files import Faults, read_yaml, strings
from hearth.kb.tools.published_knowledge import Fact

FIELDS: dict[str, tuple[str, ...]] = {
    "properties": ("class", "property"),
    "states": ("class", "state"),
    "placements": ("object", "relation", "destination"),
    "synonyms": ("class", "name"),
    "affordances": ("action", "position", "class"),
}
"""The compared tables, and the parts of their facts."""


def root_of(knowledge: Knowledge, name: str) -> str:
    """Return the class a name means, by the first of its names; the name itself when nothing has it."""
    thing = knowledge.object_class(name)
    return (thing.same_as or thing.name) if thing else name


class Rule:
    """One entry of corrections.yaml: which facts of a table it covers, and the reason."""

    def __init__(self, knowledge: Knowledge, entry: Mapping[str, Any]) -> None:
        self.table = str(entry["table"])
        self.why = str(entry["why"])
        self.in_matrix = entry.get("in_matrix") is True
        self.same = entry.get("same") is True
        self.by = frozenset(strings(entry.get("by")))
        self.besides = frozenset(strings(entry.get("besides")))
        self.parts = {
            name: frozenset(root_of(knowledge, value).lower() for value in strings(entry[name]))
            for name in FIELDS[self.table]
            if name in entry
        }

    def covers(self, fact: Fact) -> bool:
        """Return whether every part of the fact is among those named.

        The properties that a fact rests on are not compared.
        """
        given = dict(zip(FIELDS[self.table], fact, strict=True))
        if self.same and given["object"] != given["destination"]:
            return False
        if self.besides and given["class"] in self.besides:
            return False
        return all(given[name].lower() in values for name, values in self.parts.items())


class Reasons:
    """The reasons for facts we do not hold, and for those that only we hold."""

    def __init__(self, knowledge: Knowledge) -> None:
        entries = read_yaml(Path(__file__).parents[1] / "data/corrections.yaml", Faults())
        self.knowledge = knowledge
        self.renamed: Mapping[str, str] = entries["renamed"].value["states"]
        self._rules: dict[tuple[str, str], list[Rule]] = {}
        for kind in ("removed", "added"):
            for rule in (Rule(knowledge, entry) for entry in entries[kind].value):
                self._rules.setdefault((kind, rule.table), []).append(rule)
        self._given = {
            name.lower(): [
                (rule.parts["property"], rule.why)
                for rule in self._of("added", "properties")
                if name.lower() in rule.parts["class"] and not rule.in_matrix
            ]
            for name in knowledge.objects
        }

    def removed(self, table: str, fact: Fact) -> str:
        """Return why we do not hold the other's fact, or ''."""
        return next((rule.why for rule in self._of("removed", table) if rule.covers(fact)), "")

    def added(self, table: str, fact: Fact) -> str:
        """Return why we hold a fact that the other does not, or ''."""
        if table == "affordances":
            return self._cell(fact)
        why = next((rule.why for rule in self._of("added", table) if rule.covers(fact)), "")
        if table == "states":
            return why or self._state(*fact)
        if table == "placements":
            return why or self._evidence(fact)
        return why or ("ours" if table == "synonyms" else "")

    def cell(self, action: str, position: int, name: str) -> str:
        """Return the evidence that the grammar accepts a class there: the release's matrix, or ours with the reason."""
        if self.knowledge.objects[name].source != "release":
            return f"ours: {name} is not among the release's objects"
        if self.knowledge.actions[action].source != "release":
            return f"ours: {action} is not among the release's actions"
        why = self._cell((action, str(position), name))
        return f"ours: {why}" if why else "release"

    def _of(self, kind: str, table: str) -> list[Rule]:
        return self._rules.get((kind, table), [])

    def _cell(self, fact: Fact) -> str:
        """Return why only we accept a cell: it is named, or rests on properties that only we give the class."""
        action, position, name = fact
        for rule in self._of("added", "affordances"):
            if rule.covers(fact) and (not rule.by or self._rests_on(action, position, name, rule.by)):
                return rule.why
        for added, why in self._given[name.lower()]:
            properties = frozenset(prop.upper() for prop in added)
            if self._rests_on(action, position, name, properties):
                return f"follows from {' and '.join(sorted(properties))}: {why}"
        return ""

    def _rests_on(self, action: str, position: str, name: str, properties: frozenset[str]) -> bool:
        """Return whether the cell would not be accepted without these properties."""
        need = self.knowledge.actions[action].grammar[int(position)]
        thing = self.knowledge.objects[name]
        return not need.accepts(thing.properties - properties, name, thing.category == "Rooms")

    def _state(self, name: str, state: str) -> str:
        group = self.knowledge.state_groups[self.knowledge.group_of(state)]
        given = sorted(group.given_by & self.knowledge.objects[name].properties)
        return f"follows from {given[0]}" if given else f"what may be in one state of {group.name} may be in another"

    def _evidence(self, fact: Fact) -> str:
        rows = (p for p in self.knowledge.placements(fact[0]) if (p.relation, p.destination) == fact[1:])
        return next((f"evidence: {row.evidence}" for row in rows), "")
