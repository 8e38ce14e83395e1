"""Small tables from YAML files: rooms, limits of seats and beds, states by default, places like tables."""

from collections.abc import Collection, Mapping
from typing import NamedTuple

from hearth.kb.loading.entry_shapes import LIMITS, NAME_LIST, NAMES_BY_NAME, TEXT, fits, parts
from hearth.kb.loading.layers import Layers, yaml_entries
from hearth.kb.loading.source_files import Entry, Faults

_DEFAULTS = ("always", "classes", "properties")
_LIMITED = ("sit", "lie")
_WHOLE = "an entry of yours replaces ours as a whole: copy ours, and change it"


class Tables(NamedTuple):
    """The parts of `tables.yaml`: see the attributes of these names of `Knowledge`."""

    table_like: frozenset[str]
    default_states: Mapping[str, Mapping[str, tuple[str, ...]]]


def load_rooms(layers: Layers, faults: Faults) -> dict[str, str]:
    """Return the rooms that a program may name, each with the one that serves where a home lacks it, or ''."""
    entries = yaml_entries(layers, "rooms.yaml", faults)
    found = {}
    for name, entry in entries.items():
        fields = parts(entry.value, {"stand_in": TEXT}, name, entry, faults)
        found[name] = str(fields.get("stand_in") or "")
        if found[name] and found[name] not in entries:
            faults.at(entry, f"`{found[name]}` is not a room that programs may name", f"one of {', '.join(entries)}")
    return found


def load_limits(layers: Layers, faults: Faults) -> dict[str, Mapping[str, int]]:
    """By `sit` and `lie`: how many things may be on a seat or bed, by class; `default` is of all others."""
    found = {}
    for name, entry in _entries(layers, "limits.yaml", _LIMITED, faults).items():
        if fits(entry.value, LIMITS, name, entry, faults):
            found[name] = entry.value
    return found


def load_tables(layers: Layers, faults: Faults) -> Tables:
    """Return the tables that stages share."""
    entries = _entries(layers, "tables.yaml", Tables._fields, faults)
    like, states = entries.get("table_like"), entries.get("default_states")
    names = like.value if like and fits(like.value, NAME_LIST, "table_like", like, faults) else ()
    shapes = dict.fromkeys(_DEFAULTS, NAMES_BY_NAME)
    given = parts(states.value, shapes, "default_states", states, faults) if states else {}
    for part in given:
        if states and part not in _DEFAULTS:
            faults.at(states, f"`{part}` is not a part of `default_states`", f"its parts are {', '.join(_DEFAULTS)}")
    for part in _DEFAULTS:
        if states and isinstance(states.value, dict) and part not in states.value:
            faults.at(states, f"`default_states` lacks `{part}`", _WHOLE)
    by_default = {
        part: {name: tuple(map(str, each)) for name, each in given[part].items()} for part in _DEFAULTS if part in given
    }
    return Tables(frozenset(map(str, names)), by_default)


def _entries(layers: Layers, file: str, wanted: Collection[str], faults: Faults) -> dict[str, Entry]:
    """Return the entries of a file that are wanted; those that are in no layer are faults, and so are other entries."""
    found = yaml_entries(layers, file, faults)
    for name in wanted:
        if name not in found:
            faults.add(str(next(iter(layers)) / file), 0, f"`{name}` is missing", "copy it from ours")
    for name in sorted(found.keys() - {*wanted}):
        faults.at(found[name], f"`{name}` is not an entry of {file}", f"its entries are {', '.join(wanted)}")
    return {name: entry for name, entry in found.items() if name in wanted}
