"""Actions, derived predicates and repairs, built from their files."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from typing import Any

from hearth.kb.formula import (
    BUILT_IN,
    TRUE,
    And,
    Effect,
    Formula,
    Term,
    free,
    parse_atom,
    parse_effect,
    parse_formula,
    predicates,
)
from hearth.kb.groups import DECLARED
from hearth.kb.loading.entry_shapes import LIST, NAMES, REASONS, TEXT, fits, parts
from hearth.kb.loading.layers import Layers, check_ids, check_properties, parsed, yaml_entries
from hearth.kb.loading.source_files import Entry, Faults, strings, whole_number
from hearth.kb.records import Action, Condition, Repair, Requirement
from hearth.schemas.failures import Code
from hearth.schemas.literals import Literal
from hearth.schemas.vocabulary import RELATIONS

_REQUIREMENT_KEYS = frozenset({"any", "all", "classes", "contains", "also", "never"})
_ACTION_KEYS = frozenset({"id", "roles", "needs", "before", "effects", "say", "words", "aliases", "groups", "source"})
_ACTION_SHAPES = {"needs": LIST, "before": LIST, "effects": LIST, "roles": NAMES, "words": NAMES, "aliases": NAMES,
                  "groups": NAMES, "say": TEXT, "source": TEXT}  # fmt: skip
_REQUIREMENT_SHAPES = dict.fromkeys(("any", "all", "classes", "contains"), NAMES) | {"also": REASONS, "never": REASONS}
_REPAIR_SHAPES = {"on": TEXT, "actions": NAMES, "when": TEXT, "say": TEXT, "source": TEXT}
_REPAIR_KEYS = frozenset({"on", "actions", "when", "say", "source"})


def load_actions(layers: Layers, derived: Iterable[str], faults: Faults) -> dict[str, Action]:
    """Every action by name, in the order of the ids."""
    executed = yaml_entries(layers, "actions.yaml", faults, inherited="groups")
    written = yaml_entries(layers, "actions_written.yaml", faults, inherited="groups")
    grammar = yaml_entries(layers, "affordances.yaml", faults)
    for name in sorted(executed.keys() & written.keys()):
        faults.at(written[name], f"`{name}` stands in actions.yaml too", "an action is executed or only written")
    entries = {**written, **executed}
    for name in sorted(grammar.keys() - entries.keys()):
        faults.at(grammar[name], f"`{name}` is not a known action", code=Code.UNKNOWN_ACTION)
    result = {}
    for name, entry in entries.items():
        if isinstance(entry.value, dict):
            result[name] = _action(name, entry, grammar.get(name), entries, faults)
        else:
            faults.at(entry, f"`{name}` is not a mapping", "id, roles, needs, say, ...")
    check_ids({name: (action.id, entries[name]) for name, action in result.items()}, faults)
    known = {*RELATIONS, *BUILT_IN, *derived}
    for name in sorted(executed.keys() & result.keys()):
        _check_literals(result[name], known, entries[name], faults)
        result[name] = replace(result[name], executed=True)
    return dict(sorted(result.items(), key=lambda item: item[1].id))


def _action(name: str, entry: Entry, grammar: Entry | None, entries: Mapping[str, Entry], faults: Faults) -> Action:
    fields = parts(entry.value, _ACTION_SHAPES, name, entry, faults)
    for key in sorted(fields.keys() - _ACTION_KEYS):
        faults.at(entry, f"`{key}` is not part of an action", f"parts are {', '.join(sorted(_ACTION_KEYS))}")
    roles = strings(fields.get("roles"))
    needs = tuple(_requirement(value, entry, faults) for value in fields.get("needs") or ())
    asked = grammar is not None and fits(grammar.value, LIST, name, grammar, faults)
    accepts = (
        tuple(_requirement(value, grammar, faults) for value in grammar.value or ()) if grammar and asked else needs
    )
    if len(needs) != len(roles):
        faults.at(entry, f"{name} has {len(roles)} roles but needs for {len(needs)}", "one need for each role")
    if len(accepts) != len(roles):
        faults.at(grammar or entry, f"{name} takes {len(roles)} objects, not {len(accepts)}", code=Code.WRONG_ARITY)
    return Action(
        name=name,
        id=whole_number(str(fields["id"])) if type(fields.get("id")) is int else -1,
        executed=False,
        roles=roles,
        needs=needs,
        grammar=accepts,
        preconditions=tuple(_conditions(fields.get("before") or (), entry, faults)),
        effects=tuple(_effects(fields.get("effects") or (), entry, entries, faults)),
        template=str(fields.get("say") or name),
        words=strings(fields.get("words")),
        aliases=strings(fields.get("aliases")),
        groups=_groups(fields.get("groups"), entry, faults),
        source=str(fields.get("source") or "release"),
    )


def _groups(value: Any, at: Entry, faults: Faults) -> frozenset[str]:
    names = frozenset(strings(value))
    for unknown in sorted(names - DECLARED.keys()):
        faults.at(at, f"`{unknown}` is not a group of actions", f"groups are {', '.join(DECLARED)}")
    return names


def _requirement(value: Any, at: Entry, faults: Faults) -> Requirement:
    """Read `anything`, `object` or `{any, all, classes, contains, also, never}`."""
    if value in ("anything", "object"):
        return Requirement(anything=True, no_rooms=value == "object")
    if not isinstance(value, dict):
        faults.at(at, f"`{value}` is not a requirement", "anything, object, or a mapping")
        return Requirement()
    value = parts(value, _REQUIREMENT_SHAPES, "a requirement", at, faults)
    for key in sorted(value.keys() - _REQUIREMENT_KEYS):
        faults.at(at, f"`{key}` is not part of a requirement", f"parts are {', '.join(sorted(_REQUIREMENT_KEYS))}")
    return Requirement(
        any_of=check_properties(strings(value.get("any")), at, faults),
        all_of=check_properties(strings(value.get("all")), at, faults),
        classes=frozenset(strings(value.get("classes"))),
        contains=strings(value.get("contains")),
        also=_classes(value.get("also")),
        never=_classes(value.get("never")),
    )


def _classes(value: Any) -> frozenset[str]:
    return frozenset(value if isinstance(value, dict) else strings(value))


def _conditions(rows: Iterable[Any], at: Entry, faults: Faults) -> Iterator[Condition]:
    for row in rows:
        checks = [(code, text) for code, text in row.items() if code != "option"] if isinstance(row, dict) else []
        if len(checks) != 1 or checks[0][0] not in Code.__members__:
            faults.at(at, f"`{row}` is not a check", "write `FAILURE_CODE: formula`")
            continue
        code, text = checks[0]
        formula = parsed(parse_formula, text, at, faults)
        if formula is not None and fits(row.get("option"), TEXT, "option", at, faults):
            yield Condition(formula, Code[code], str(row.get("option") or ""))


def _effects(
    rows: Iterable[Any], at: Entry, entries: Mapping[str, Entry], faults: Faults, within: tuple[str, ...] = ()
) -> Iterator[Effect]:
    """Effects as they stand, and those of the actions that they are like; `within` names the ones being read."""
    for row in rows:
        if isinstance(row, str):
            effect = parsed(parse_effect, row, at, faults)
            if effect is not None:
                yield effect
        elif isinstance(row, dict) and isinstance(like := row.get("like"), str) and like in entries:
            when = parsed(parse_formula, row["when"], at, faults) if "when" in row else TRUE
            if like in within:
                faults.at(at, f"`{like}` is like itself in a circle", "let one of them name its effects")
                continue
            other = entries[like].value
            more = other.get("effects") if isinstance(other, dict) else None
            for effect in _effects(more if isinstance(more, list) else (), at, entries, faults, (*within, like)):
                yield _under(when or TRUE, effect)
        else:
            faults.at(at, f"`{row}` is not an effect", "write a change, or `like: Action`")


def _under(condition: Formula, effect: Effect) -> Effect:
    """The effect, made to depend on one more condition."""
    if condition == TRUE:
        return effect
    both = condition if effect.condition == TRUE else And((condition, effect.condition))
    return Effect(effect.literal, both, effect.variables)


def load_derived(layers: Layers, faults: Faults) -> dict[str, tuple[Literal[Term], Formula]]:
    """Definitions by predicate: `close` -> (close(a, x), its formula)."""
    result = {}
    for head, entry in yaml_entries(layers, "derived.yaml", faults).items():
        atom = parsed(parse_atom, head, entry, faults)
        body = parsed(parse_formula, entry.value, entry, faults)
        if atom is not None and body is not None:
            result[atom.name] = (atom, body)
    return result


def _check_literals(action: Action, known: set[str], at: Entry, faults: Faults) -> None:
    """Note predicates that nothing defines and variables that nothing binds."""
    bound = {"a", *"os"[: action.arity]}
    parts: list[tuple[Formula, set[str]]] = [(condition.formula, bound) for condition in action.preconditions]
    parts += [(part, bound | {*e.variables}) for e in action.effects for part in (e.condition, e.literal.atom)]
    for part, variables in parts:
        for unknown in sorted(predicates(part) - known):
            faults.at(at, f"in `{part}`: nothing says what `{unknown}` is", "see derived.yaml")
        for unbound in sorted(free(part) - variables):
            faults.at(at, f"in `{part}`: `{unbound}` is not an argument of {action.name} and is not bound")


def load_repairs(layers: Layers, actions: Mapping[str, Action], faults: Faults) -> dict[str, Repair]:
    """The repairs by name, in the order of the file: the first that fits is the one to try."""
    result = {}
    for name, entry in yaml_entries(layers, "repairs.yaml", faults).items():
        fields = parts(entry.value, _REPAIR_SHAPES, name, entry, faults)
        for key in sorted(fields.keys() - _REPAIR_KEYS - {"do"}):  # version 0.1 described edits, which nothing read
            faults.at(entry, f"`{key}` is not part of a repair", f"parts are {', '.join(sorted(_REPAIR_KEYS))}")
        if fields.get("on") not in Code.__members__:
            faults.at(entry, f"`{fields.get('on')}` is not a failure code")
            continue
        for unknown in sorted(set(strings(fields.get("actions"))) - actions.keys()):
            faults.at(entry, f"`{unknown}` is not a known action", code=Code.UNKNOWN_ACTION)
        result[name] = Repair(
            name=name,
            code=Code[fields["on"]],
            actions=strings(fields.get("actions")),
            when=str(fields.get("when") or ""),
            say=str(fields.get("say") or ""),
            source=str(fields.get("source") or "ours"),
        )
    return result
