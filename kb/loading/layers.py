"""The files of one directory laid over another's: a later layer's entry replaces an earlier one's of the same name."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from difflib import get_close_matches
from pathlib import Path
from typing import TypeVar

from hearth.kb.loading.source_files import Entry, Faults, read_csv, read_yaml
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.vocabulary import PROPERTIES

Layers = Iterable[Path]
"""Directories, ours first."""

Keyed = Mapping[tuple[str, ...], Entry]
"""Identifying cells -> a row of a table, its value the cells."""

T = TypeVar("T")


def yaml_entries(layers: Layers, name: str, faults: Faults, inherited: tuple[str, ...] = ()) -> dict[str, Entry]:
    """Return the top-level entries of a YAML file, over all layers.

    An entry replaces the one below it, but for the parts `inherited`, which it takes over where it does not name them.
    """
    result: dict[str, Entry] = {}
    for layer in layers:
        if (layer / name).exists():
            for key, entry in read_yaml(layer / name, faults).items():
                below = result.get(key)
                parts = below.value if below is not None and isinstance(below.value, dict) else {}
                kept = {part: parts[part] for part in inherited if part in parts}
                is_laid = kept and isinstance(entry.value, dict)
                result[key] = entry._replace(value={**kept, **entry.value}) if is_laid else entry
    return result


def csv_rows(
    layers: Layers, names: Iterable[str], columns: tuple[str, ...], key: tuple[int, ...], faults: Faults
) -> Keyed:
    """Return the rows of some CSV files by the cells that identify them, over all layers.

    Two of one layer are a fault.
    """
    result: dict[tuple[str, ...], Entry] = {}
    for layer in layers:
        own: dict[tuple[str, ...], Entry] = {}
        for path in (layer / name for name in names):
            if not path.exists():
                continue
            file = str(path)
            for cells, line in read_csv(path, columns, faults):
                entry = Entry(cells, file, line)
                first = own.setdefault(tuple([cells[column] for column in key]), entry)
                if first is not entry:
                    words = ", ".join(cells[column] for column in key if cells[column])
                    faults.at(entry, f"`{words}` stands twice, first in {first.file}:{first.line}", "keep one of them")
        result.update(own)
    return result


def parsed(parser: Callable[[str], T], text: object, at: Entry, faults: Faults) -> T | None:
    """Return the parser's value for the text; None when it fails, its faults noted with their place."""
    try:
        return parser(str(text))
    except HearthError as error:
        faults.extend(replace(fault, file=at.file, line=at.line) for fault in error.diagnostics)
        return None


def check_properties(names: Iterable[str], at: Entry, faults: Faults) -> frozenset[str]:
    """Return the names as a set, noting each that the vocabulary does not have with the nearest that it has."""
    given = frozenset(names)
    for name in sorted(given - _KNOWN_PROPERTIES):
        near = get_close_matches(name.upper(), PROPERTIES, 1, 0.5)
        faults.at(at, f"`{name}` is not a known property", f"did you mean `{near[0]}`?" if near else "")
    return given


def check_ids(owners: Mapping[str, tuple[int, Entry]], faults: Faults) -> None:
    """Ids are whole numbers and never shared: they are published."""
    taken: dict[int, str] = {}
    for name, (number, at) in owners.items():
        if number < 0:
            faults.at(at, f"`{name}` has no id", "give it a number that is not in use")
        elif number in taken:
            faults.at(at, f"`{name}` has the id {number} of `{taken[number]}`", "give it a number that is not in use")
        taken.setdefault(number, name)


def cycles(links: Mapping[str, str]) -> list[str]:
    """Return the names from which following the links never ends."""
    endless = []
    for name in links:
        seen = {name}
        target = links[name]
        while target in links and target not in seen:
            seen.add(target)
            target = links[target]
        if target in seen:
            endless.append(name)
    return endless


_KNOWN_PROPERTIES = frozenset(PROPERTIES)
