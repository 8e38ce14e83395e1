"""Who says so, and why: the reasons of corrections.yaml for differing from the release."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from hearth.kb.knowledge import Knowledge
from hearth.kb.reading import Faults, read_yaml, strings

Fact = tuple[str, ...]
"""Names; what they mean depends on the table."""

FIELDS: dict[str, tuple[str, ...]] = {
    "properties": ("class", "property"),
    "states": ("class", "state"),
    "placements": ("object", "relation", "destination"),
    "synonyms": ("class", "name"),
    "affordances": ("action", "position", "class"),
}
"""The tables that are compared, and what the parts of their facts are."""


def root_of(knowledge: Knowledge, name: str) -> str:
    """The class a name means, by the first of its names; the name itself when nothing has it."""
    thing = knowledge.object_class(name)
    return (thing.same_as or thing.name) if thing else name


class Reasons:
    """The reasons of corrections.yaml for facts we do not hold, and for those that only we hold."""

    def __init__(self, knowledge: Knowledge) -> None:
        entries = read_yaml(Path(__file__).parent / "corrections.yaml", Faults())
        self.knowledge = knowledge
        self.renamed: Mapping[str, str] = entries["renamed"].value["states"]
        self.rules: dict[str, list[Mapping[str, Any]]] = {kind: entries[kind].value for kind in ("gone", "added")}

    def gone(self, table: str, fact: Fact) -> str:
        """Why we do not hold the other's fact, or ''."""
        parts = dict(zip(FIELDS[table], fact, strict=True))
        return next((str(rule["why"]) for rule in self._of("gone", table) if self._covers(rule, parts)), "")

    def added(self, table: str, fact: Fact) -> str:
        """Why we hold a fact that the other does not, or ''."""
        parts = dict(zip(FIELDS[table], fact, strict=True))
        why = next((str(rule["why"]) for rule in self._of("added", table) if self._covers(rule, parts)), "")
        if why or table == "properties":
            return why
        if table == "affordances":
            return next(
                (self._from(rule) for rule in self._of("added", "properties") if self._follows(rule, parts)), ""
            )
        if table == "states":
            return self._given(parts)
        return "ours" if table == "synonyms" else self._evidence(fact)

    def cell(self, action: str, position: int, name: str) -> str:
        """Who says that the grammar takes a class there: the release's matrix, or we, with the reason."""
        thing = self.knowledge.objects[name]
        if thing.source != "release":
            return f"ours: {name} is not among the release's objects"
        if self.knowledge.actions[action].source != "release":
            return f"ours: {action} is not among the release's actions"
        why = self.added("affordances", (action, str(position), name))
        return f"ours: {why}" if why else "release"

    def _of(self, kind: str, table: str) -> Iterator[Mapping[str, Any]]:
        return (rule for rule in self.rules[kind] if rule["table"] == table)

    def _covers(self, rule: Mapping[str, Any], parts: Mapping[str, str]) -> bool:
        if rule.get("same") and parts["object"] != parts["destination"]:
            return False
        for name, value in parts.items():
            if name in rule and value.lower() not in {root_of(self.knowledge, n).lower() for n in strings(rule[name])}:
                return False
        if "property" in rule and "property" not in parts:
            thing = self.knowledge.object_class(parts["class"])
            return thing is not None and not thing.properties.isdisjoint(strings(rule["property"]))
        return True

    def _follows(self, rule: Mapping[str, Any], parts: Mapping[str, str]) -> bool:
        """Whether the cell is accepted because of a property that was added."""
        need = self.knowledge.actions[parts["action"]].grammar[int(parts["position"])]
        return root_of(self.knowledge, parts["class"]) in strings(rule["class"]) and not need.any_of.isdisjoint(
            strings(rule["property"])
        )

    @staticmethod
    def _from(rule: Mapping[str, Any]) -> str:
        return f"follows from {' and '.join(strings(rule['property']))}: {rule['why']}"

    def _given(self, parts: Mapping[str, str]) -> str:
        group = self.knowledge.state_groups[self.knowledge.group_of(parts["state"])]
        thing = self.knowledge.objects[parts["class"]]
        given = sorted(group.given_by & thing.properties)
        return f"follows from {given[0]}" if given else f"what may be in one state of {group.name} may be in another"

    def _evidence(self, fact: Fact) -> str:
        rows = (p for p in self.knowledge.placements(fact[0]) if (p.relation, p.destination) == fact[1:])
        return next((f"evidence: {row.evidence}" for row in rows), "")
