"""Actions, derived predicates and repairs, built from their files."""

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

from hearth.kb.action_groups import DECLARED
from hearth.kb.formula import TRUE, And, Effect, Formula, Term, parse_atom, parse_effect, parse_formula
from hearth.kb.knowledge_records import Action, Condition, Consequence, Repair, Requirement
from hearth.kb.loading.entry_shapes import LIST, NAMES, REASONS, TEXT, fits, parts
from hearth.kb.loading.formula_checks import Derived, check_derived, check_literals
from hearth.kb.loading.layers import Layers, check_ids, check_properties, parsed, yaml_entries
from hearth.kb.loading.source_files import Entry, Faults, strings, whole_number
from hearth.schemas.failures import Code
from hearth.schemas.literals import Literal
from hearth.schemas.vocabulary import EVERY_STATE

_REQUIREMENT_KEYS = frozenset({"any", "all", "classes", "contains", "also", "never"})
_ACTION_KEYS = frozenset({"id", "roles", "needs", "before", "effects", "say", "words", "aliases", "calls", "groups",
                          "source", "set", "then", "like", "ticks", "notice", "unless", "besides"})  # fmt: skip
_ACTION_SHAPES = {"needs": LIST, "before": LIST, "effects": LIST, "roles": NAMES, "words": NAMES, "aliases": NAMES,
                  "calls": NAMES, "groups": NAMES, "say": TEXT, "source": TEXT, "then": LIST, "like": TEXT,
                  "notice": TEXT, "unless": LIST, "besides": LIST}  # fmt: skip
_INHERITED = ("groups", "calls")
_REQUIREMENT_SHAPES = dict.fromkeys(("any", "all", "classes", "contains"), NAMES) | {"also": REASONS, "never": REASONS}
_REPAIR_SHAPES = {"on": TEXT, "actions": NAMES, "when": TEXT, "say": TEXT, "source": TEXT}
_REPAIR_KEYS = frozenset({"on", "actions", "when", "say", "source"})


def load_actions(layers: Layers, derived: Derived, faults: Faults) -> dict[str, Action]:
    """Every action by name, in the order of the ids."""
    executed = yaml_entries(layers, "actions.yaml", faults, inherited=_INHERITED)
    written = yaml_entries(layers, "actions_written.yaml", faults, inherited=_INHERITED)
    grammar = yaml_entries(layers, "affordances.yaml", faults)
    for name in [name for name in written if _only_later(executed.get(name))]:
        own, ours = written.pop(name), executed[name]  # an overlay from before set 3 describes what it executes now
        kept = {key: ours.value[key] for key in _LATER_KEYS & ours.value.keys()}
        executed[name] = own._replace(value=kept | own.value) if isinstance(own.value, dict) else own
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
    for name in sorted(executed.keys() & result.keys()):
        check_literals(result[name], derived, entries[name], faults)
        result[name] = replace(result[name], executed=not _only_later(entries[name]))
    return dict(sorted(result.items(), key=lambda item: item[1].id))


_LATER_KEYS = frozenset({"set", "before", "effects", "like", "ticks", "notice"})


def _only_later(entry: Entry | None) -> bool:
    """Return whether sets 1 and 2 know an action and do not execute it."""
    return entry is not None and isinstance(entry.value, dict) and entry.value.get("set") == LATER


LATER = 3
"""The action set that `set: 3` of an entry names: it is the first to execute the action."""


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
    checks = tuple(_conditions(fields.get("before") or (), entry, faults))
    effects = _all_effects(name, fields.get("effects") or (), entry, entries, faults)
    later = _later(name, fields, (checks, effects), entry, entries, faults)
    if _only_later(entry):
        checks, effects = (), ()
    _check_words(name, fields, len(roles), entry, faults)
    return Action(
        name=name,
        id=whole_number(str(fields["id"])) if type(fields.get("id")) is int else -1,
        executed=False,
        roles=roles,
        needs=needs,
        grammar=accepts,
        preconditions=checks,
        effects=effects,
        template=str(fields.get("say") or name),
        words=strings(fields.get("words")),
        aliases=strings(fields.get("aliases")),
        calls=strings(fields.get("calls")),
        groups=_groups(fields.get("groups"), entry, faults),
        source=str(fields.get("source") or "release"),
        later=later,
    )


def _later(
    name: str,
    fields: Mapping[str, Any],
    own: tuple[tuple[Condition, ...], tuple[Effect, ...]],
    at: Entry,
    entries: Mapping[str, Entry],
    faults: Faults,
) -> Consequence | None:
    """Return the additions of set 3: all of an action that it is the first to execute, `then` of another."""
    if fields.get("set") not in (None, LATER):
        faults.at(at, f"`set` of {name} is {fields['set']!r:.40}", f"leave it out, or write `set: {LATER}`")
    ticks = fields.get("ticks", 1)
    if type(ticks) is not int or not 0 < ticks <= MOST_TICKS:
        faults.at(at, f"`ticks` of {name} is {ticks!r:.40}", f"a whole number from 1 to {MOST_TICKS}")
        ticks = 1
    like = str(fields.get("like") or "")
    if like and (like not in entries or not _only_later(at) or _only_later(entries[like])):
        faults.at(at, f"{name} is like `{like:.40}`", "an action that sets 1 and 2 execute")
    more = _all_effects(name, fields.get("then") or (), at, entries, faults)
    unless = tuple(_excuses(name, fields.get("unless") or (), own[0], at, faults))
    besides = tuple(_further_checks(name, fields.get("besides") or (), at, faults))
    if not _only_later(at):
        notice = str(fields.get("notice") or "")
        known = more or unless or besides or "ticks" in fields
        return Consequence(besides, more, "", ticks, notice, unless) if known else None
    return Consequence(own[0], own[1] + more, like, ticks, str(fields.get("notice") or ""))


def _excuses(
    name: str, rows: Iterable[Any], own: tuple[Condition, ...], at: Entry, faults: Faults
) -> Iterator[Condition]:
    """Yield what lets checks pass in set 3: a state of the first object, which a mask reads from one row."""
    for found in _conditions(rows, at, faults):
        literal = found.formula
        if _only_later(at) or found.code not in {check.code for check in own}:
            faults.at(at, f"`unless` of {name}: sets 1 and 2 make no check {found.code}", "name one of its checks")
        elif isinstance(literal, Literal) and _is_state_of_first(literal):
            yield found
        else:
            faults.at(at, f"`unless` of {name} is `{literal}`", "write `FAILURE_CODE: state(o, STATE)`")


def _further_checks(name: str, rows: Iterable[Any], at: Entry, faults: Faults) -> Iterator[Condition]:
    """Yield the checks that set 3 makes besides: the first object is not in a state."""
    for found in _conditions(rows, at, faults):
        literal = found.formula
        if _only_later(at):
            faults.at(at, f"`besides` of {name}: set 3 makes all its checks", "write them under `before`")
        elif isinstance(literal, Literal) and literal.negated and _is_state_of_first(literal.atom):
            yield found
        else:
            faults.at(at, f"`besides` of {name} is `{literal}`", "write `FAILURE_CODE: not state(o, STATE)`")


def _is_state_of_first(literal: Literal[Term]) -> bool:
    named = literal.name == "state" and not literal.negated and literal.terms[0].name == "o"
    return named and literal.terms[-1].name in EVERY_STATE


MOST_TICKS = 100
"""Of an act: nobody waits longer for one step."""


def _check_words(name: str, fields: Mapping[str, Any], arity: int, at: Entry, faults: Faults) -> None:
    """Note braces in words that are not `{0}` and `{1}`, each object once: phrases are made, and read, by these."""
    template = str(fields.get("say") or name)
    said = _PLACES.findall(template)
    wanted = [f"{{{place}}}" for place in range(arity)]
    if len(set(said)) < len(said) or not {*said} <= {*wanted} or _BRACE.search(_PLACES.sub("", template)):
        remedy = f"words with {' and '.join(wanted)}, each once" if wanted else "words"
        faults.at(at, f"`say` of {name} is `{template[:60]}`", remedy)
    for words in strings(fields.get("words")):
        if _BRACE.search(words):
            faults.at(at, f"words of {name} are `{words[:60]}`", "words alone")


_PLACES, _BRACE = re.compile(r"\{[0-9]\}"), re.compile(r"[{}]")


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


MOST_EFFECTS = 1_000
"""Of an action, with those of the actions that it is like: a few that are each like another twice are billions."""


@dataclass(slots=True)
class _Left:
    """The number of an action's effects that may still be read."""

    rows: int = MOST_EFFECTS


def _all_effects(
    name: str, rows: Iterable[Any], at: Entry, entries: Mapping[str, Entry], faults: Faults
) -> tuple[Effect, ...]:
    left = _Left()
    effects = tuple(_effects(rows, at, entries, faults, left))
    if left.rows < 0:
        message = f"{name} has more than {MOST_EFFECTS:,} effects, with those of the actions that it is like"
        faults.at(at, message, "name the changes themselves")
    return effects


def _effects(
    rows: Iterable[Any],
    at: Entry,
    entries: Mapping[str, Entry],
    faults: Faults,
    left: _Left,
    within: tuple[str, ...] = (),
) -> Iterator[Effect]:
    """Effects as they stand, and those of the actions that they are like; `within` names the ones being read."""
    for row in rows:
        left.rows -= 1
        if left.rows < 0:
            return
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
            for effect in _effects(more if isinstance(more, list) else (), at, entries, faults, left, (*within, like)):
                yield _under(when or TRUE, effect)
        else:
            faults.at(at, f"`{row}` is not an effect", "write a change, or `like: Action`")


def _under(condition: Formula, effect: Effect) -> Effect:
    """Return the effect, made to depend on one more condition."""
    if condition == TRUE:
        return effect
    both = condition if effect.condition == TRUE else And((condition, effect.condition))
    return Effect(effect.literal, both, effect.variables)


def load_derived(layers: Layers, faults: Faults) -> dict[str, tuple[Literal[Term], Formula]]:
    """Definitions by predicate: `close` -> (close(a, x), its formula)."""
    result, entries = {}, {}
    for head, entry in yaml_entries(layers, "derived.yaml", faults).items():
        atom = parsed(parse_atom, head, entry, faults)
        body = parsed(parse_formula, entry.value, entry, faults)
        if atom is not None and body is not None:
            result[atom.name], entries[atom.name] = (atom, body), entry
    check_derived(result, entries, faults)
    return result


def load_repairs(layers: Layers, actions: Mapping[str, Action], faults: Faults) -> dict[str, Repair]:
    """Return the repairs by name, in the order of the file: the first that fits is the one to try."""
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
