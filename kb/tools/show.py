"""Everything known about one object or one action, as plain data for people and machines."""

from typing import Any

from hearth.kb.action_sets import LATEST
from hearth.kb.knowledge import Knowledge
from hearth.kb.knowledge_records import Action, Consequence, ObjectClass, Placement
from hearth.kb.tools.correction_reasons import Reasons


def about_object(knowledge: Knowledge, thing: ObjectClass) -> dict[str, Any]:
    """Return everything about a class; placements and uses, most usual first."""
    name = thing.name
    taken = [[a.name for a in knowledge.actions.values() if knowledge.affords(a.name, n, name)] for n in (0, 1)]
    return {
        "name": name,
        "id": thing.id,
        "gloss": thing.gloss,
        "kind": list(knowledge.ancestors(name)),
        "category": thing.category,
        "same_as": thing.same_as,
        "synonyms": list(thing.synonyms),
        "found_as": list(knowledge.same_class(name)),
        "size": {"width": thing.size[0], "height": thing.size[1], "depth": thing.size[2]},
        "rooms": list(thing.rooms),
        "properties": sorted(thing.properties),
        "states": list(thing.states),
        "default_states": list(knowledge.default_states(name)),
        "seats": knowledge.seat_limit(name) if knowledge.has(name, "SITTABLE") else 0,
        "lies": knowledge.bed_limit(name) if knowledge.has(name, "LIEABLE") else 0,
        "placed": [_placed(p, "relation", "destination") for p in knowledge.placements(name)],
        "holds": [_placed(p, "object", "relation") for p in knowledge.holds(name)],
        "goes_with": _goes_with(knowledge, thing.same_as or name),
        "takes_it_first": taken[0],
        "takes_it_second": taken[1],
        "our_own": _our_own(knowledge, name, taken),
        "source": thing.source,
    }


def about_action(knowledge: Knowledge, action: Action) -> dict[str, Any]:
    """Everything about an action: what it takes, needs and changes, its phrase, its repairs."""
    return {
        "name": action.name,
        "id": action.id,
        "executed": action.executed,
        "executed_by_set_3": knowledge.of_set(LATEST).actions[action.name].executed,
        "said": action.template,
        "words": list(action.words),
        "aliases": list(action.aliases),
        "arguments": [
            {
                "role": role,
                "needs": str(action.needs[position]),
                "grammar": str(action.grammar[position]),
                "classes": sum(knowledge.affords(action.name, position, name) for name in knowledge.objects),
            }
            for position, role in enumerate(action.roles)
        ],
        "before": [
            {"holds": str(check.formula), "else": check.code.value, "option": check.option}
            for check in action.preconditions
        ],
        "effects": [str(effect) for effect in action.effects],
        "set_3": _set_3(action.later),
        "repairs": _repairs(knowledge, action.name),
        "served_by": [a.name for a in knowledge.associations if a.relation == "serves" and a.other == action.name],
        "source": action.source,
    }


def _repairs(knowledge: Knowledge, name: str) -> list[dict[str, str]]:
    """Return the first repair of each check that any action set makes of an action."""
    codes = dict.fromkeys(check.code for check in knowledge.of_set(LATEST).actions[name].preconditions)
    found = [each for code in codes for each in knowledge.repairs_for(code, name)[:1]]
    return [{"on": each.code.value, "when": each.when, "repair": each.say, "source": each.source} for each in found]


def _set_3(later: Consequence | None) -> list[dict[str, str]]:
    """Return the additions of action set 3 to an action: checks, effects, length and the notice of others."""
    if later is None:
        return []
    rows = [("like", later.like, "")] if later.like else []
    rows += [("before", str(check.formula), check.code.value) for check in later.preconditions]
    rows += [("unless", str(check.formula), check.code.value) for check in later.unless]
    rows += [("effect", str(effect), "") for effect in later.effects]
    rows += [("ticks", str(later.ticks), ""), ("notice", later.notice, "")]
    return [{"part": part, "is": text, "else": code} for part, text, code in rows]


def _our_own(knowledge: Knowledge, name: str, taken: list[list[str]]) -> list[dict[str, str]]:
    """Return the affordances that the release's matrix does not hold, each with the reason; of its own classes only."""
    if knowledge.objects[name].source != "release":
        return []
    reasons = Reasons(knowledge)
    cells = ((action, position) for position in (0, 1) for action in taken[position])
    evidence_of = ((action, reasons.cell(action, position, name)) for action, position in cells)
    return [{"action": action, "evidence": evidence} for action, evidence in evidence_of if evidence != "release"]


def _placed(placement: Placement, *ends: str) -> dict[str, Any]:
    """Return a placement, of which only one end needs to be said."""
    columns = (*ends, "room", "weight", "evidence")
    return {("place" if name == "destination" else name): getattr(placement, name) for name in columns}


def _goes_with(knowledge: Knowledge, name: str) -> list[dict[str, Any]]:
    rows = []
    for a in knowledge.associations:
        if name in (a.name, a.other):
            served = a.relation == "serves" and a.name != name
            relation = f"{a.relation} (of it)" if served else a.relation
            other = a.other if a.name == name else a.name
            rows.append({"relation": relation, "other": other, "weight": a.weight, "evidence": a.evidence})
    return sorted(rows, key=lambda row: (-int(str(row["weight"])), str(row["other"])))
