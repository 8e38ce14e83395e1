"""Hazards, read from `hazards.yaml`."""

from __future__ import annotations

from hearth.kb.formula import free, parse_formula
from hearth.kb.knowledge_records import Hazard
from hearth.kb.loading.entry_shapes import TEXT, parts
from hearth.kb.loading.formula_checks import Derived, check_formula
from hearth.kb.loading.layers import Layers, parsed, yaml_entries
from hearth.kb.loading.process_rows import MOST_TICKS
from hearth.kb.loading.source_files import Entry, Faults

_SHAPES = {"while": TEXT, "say": TEXT, "source": TEXT}
_FLAGS = ("alone", "asleep", "unused")
_KEYS = ("while", *_FLAGS, "after", "severity", "say", "source")


def load_hazards(layers: Layers, derived: Derived, faults: Faults) -> dict[str, Hazard]:
    """Return the hazards by name, in the order of the file."""
    entries = yaml_entries(layers, "hazards.yaml", faults)
    found = (_hazard(name, entry, derived, faults) for name, entry in entries.items())
    return {hazard.name: hazard for hazard in found if hazard is not None}


def _hazard(name: str, entry: Entry, derived: Derived, faults: Faults) -> Hazard | None:
    fields = parts(entry.value, _SHAPES, name, entry, faults)
    for key in sorted(fields.keys() - {*_KEYS}):
        faults.at(entry, f"`{key}` is not part of a hazard", f"parts are {', '.join(_KEYS)}")
    missing = [key for key in ("while", "severity", "say") if fields.get(key) in (None, "")]
    if missing:
        faults.at(entry, f"the hazard `{name}` lacks `{missing[0]}`", "while, severity and say")
        return None
    condition = parsed(parse_formula, fields["while"], entry, faults)
    if condition is None:
        return None
    check_formula(condition, {"x", "y"}, name, derived, entry, faults, len(free(condition)))
    if "x" not in free(condition):
        faults.at(entry, f"`{condition}` says nothing of x", "name the dangerous thing x, and a second one y")
    for key in _FLAGS:
        if type(fields.get(key, False)) is not bool:
            faults.at(entry, f"`{key}` of {name} is {fields[key]!r:.40}", "true or false")
    after, severity = fields.get("after", 0), fields["severity"]
    if type(after) is not int or not 0 <= after <= MOST_TICKS:
        faults.at(entry, f"`after` of {name} is {after!r:.40}", f"a number of ticks to {MOST_TICKS}")
        return None
    if type(severity) is not int or not 1 <= severity <= 3:
        faults.at(entry, f"`severity` of {name} is {severity!r:.40}", "1 waste, 2 damage, 3 fire or injury")
        return None
    say = str(fields["say"])
    if not _is_sentence(say, "y" in free(condition)):
        faults.at(entry, f"`say` of {name} is {say!r:.60}", "a sentence with {x}, and {y} where the row names a y")
        return None
    alone, asleep, unused = (fields.get(key) is True for key in _FLAGS)
    return Hazard(name, condition, alone, asleep, unused, after, severity, say, str(fields.get("source") or ""))


def _is_sentence(text: str, second: bool) -> bool:
    """Return whether a text has places for the things, and for nothing else."""
    rest = text.replace("{x}", "").replace("{y}", "") if second else text.replace("{x}", "")
    return "{x}" in text and not {*rest} & {*"{}"}
