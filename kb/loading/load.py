"""Reading all files into one Knowledge, or one error that lists every fault of all of them."""

from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache
from hashlib import file_digest, sha256
from pathlib import Path

from hearth.kb.knowledge import Knowledge, grouped
from hearth.kb.knowledge_records import Action, ObjectClass, Placement
from hearth.kb.loading.actions import load_actions, load_derived, load_repairs
from hearth.kb.loading.hazard_rows import load_hazards
from hearth.kb.loading.objects import (
    OBJECT_FILES,
    load_aliases,
    load_associations,
    load_objects,
    load_placements,
    load_stand_ins,
)
from hearth.kb.loading.process_rows import load_processes
from hearth.kb.loading.small_tables import load_limits, load_rooms, load_tables
from hearth.kb.loading.source_files import Faults, check_extent
from hearth.kb.spelling import key_of
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code

OURS = Path(__file__).parents[1] / "data"
"""The folder of our own files."""

FILES = (
    "actions.yaml",
    "actions_written.yaml",
    "affordances.yaml",
    "aliases.csv",
    "associations.csv",
    "corrections.yaml",
    "derived.yaml",
    "hazards.yaml",
    "kinds.csv",
    "limits.yaml",
    *OBJECT_FILES,
    "placements.csv",
    "processes.yaml",
    "repairs.yaml",
    "rooms.yaml",
    "stand_ins.csv",
    "states.yaml",
    "tables.yaml",
)
"""Every file the knowledge is read from; another YAML or CSV file in a directory of it is a mistake."""

_LATER = frozenset({"hazards.yaml", "processes.yaml"})
"""Files that complete directories of before do not have: nothing comes by itself then, and nothing is a hazard."""


def load(directory: Path | None = None, overlay: Path | None = None) -> Knowledge:
    """Read the knowledge from `directory` (ours when None), with a user's own files laid over it.

    An entry of the overlay replaces ours of the same name; a placement of weight 0 takes ours away.

    Raises:
        HearthError: every duplicate key, unknown property, unknown object, circle of synonyms and other fault of all
            files, each with file and line.
    """
    layers = [directory or OURS, *([overlay] if overlay else [])]
    faults = Faults()
    for number, layer in enumerate(layers):
        _check_files(layer, number == 0, faults)
    knowledge = None if faults else _read(layers, faults)
    if faults or knowledge is None:
        raise HearthError(_in_reading_order(faults, layers[-1]))
    return knowledge


def _in_reading_order(faults: Faults, given: Path) -> list[Diagnostic]:
    """Sort faults by file and line, those of the folder that was given first: the others follow from them."""
    return sorted(faults, key=lambda fault: (not Path(fault.file).is_relative_to(given), fault.file, fault.line))


@lru_cache(maxsize=1)
def default() -> Knowledge:
    """Our own knowledge, loaded once."""
    return load()


def overlaid(overlay: Path | None) -> Knowledge:
    """Ours with a user's files laid over it, read once a process while these stay as they are; errors as of `load`."""
    return _overlaid(overlay, digest(overlay)) if overlay else default()


@lru_cache(maxsize=8)
def _overlaid(overlay: Path, _: str) -> Knowledge:
    return load(overlay=overlay)


def files_of(directory: Path) -> list[Path]:
    """Return the files of knowledge in a directory, by name."""
    return [path for name in sorted(FILES) if (path := directory / name).is_file()]


def digest(directory: Path | None = None) -> str:
    """SHA-256 of the names and bytes of a directory's files of knowledge; of ours when None."""
    return _digest(directory) if directory else _own_digest()


@lru_cache(maxsize=1)
def _own_digest() -> str:
    return _digest(OURS)


def _digest(directory: Path) -> str:
    found = sha256()
    for path in files_of(directory):
        with path.open("rb") as file:
            found.update(f"{path.name}\0{file_digest(file, 'sha256').hexdigest()}\n".encode())
    return found.hexdigest()


def _check_files(layer: Path, complete: bool, faults: Faults) -> None:
    if not layer.is_dir():
        faults.add(str(layer), 0, "is not a directory of knowledge files", code=Code.MISSING_FILE)
        return
    present = {path.name for path in layer.iterdir() if path.suffix in (".yaml", ".yml", ".csv")}
    for name in () if layer == OURS else sorted(present & set(FILES)):
        check_extent(layer / name, faults)
    for name in sorted(present - set(FILES)):
        faults.add(str(layer / name), 0, "is not one of the knowledge's files", f"they are {', '.join(FILES)}")
    for name in FILES if complete else ():
        if name not in present | _LATER:
            faults.add(str(layer / name), 0, "is missing", "or lay your files over ours", Code.MISSING_FILE)


def _read(layers: list[Path], faults: Faults) -> Knowledge | None:
    objects, groups, kinds = load_objects(layers, faults)
    aliases = load_aliases(layers, objects, faults)
    stand_ins = load_stand_ins(layers, objects.keys() | aliases.keys(), faults)
    placements = load_placements(layers, objects, faults)
    derived = load_derived(layers, faults)
    actions = load_actions(layers, derived, faults)
    associations = load_associations(layers, objects, actions, faults)
    repairs = load_repairs(layers, actions, faults)
    processes = load_processes(layers, derived, groups, faults)
    hazards = load_hazards(layers, derived, faults)
    stand_in, limits, tables = load_rooms(layers, faults), load_limits(layers, faults), load_tables(layers, faults)
    if faults:
        return None
    named = _with_synonyms(objects, aliases)
    spellings = _object_spellings(named, aliases, faults)
    return Knowledge(
        actions=actions,
        objects=named,
        rooms=tuple(sorted(stand_in)),
        state_groups=groups,
        table_like=tables.table_like,
        defaults=tables.default_states,
        derived=derived,
        kinds=kinds,
        associations=associations,
        repairs=repairs,
        processes=processes,
        hazards=hazards,
        _action_names=_action_spellings(actions),
        _object_names=spellings,
        _aliases={name: thing.synonyms for name, thing in named.items() if thing.synonyms},
        _stand_ins={**stand_ins, **{name: _serving(name, stand_in) for name in stand_in}},
        _placements=_by_weight(placements, 0),
        _held=_by_weight(placements, 2),
        _limits=limits,
    )


def _serving(name: str, stand_in: Mapping[str, str]) -> tuple[str, ...]:
    """Return the rooms that serve as a room where a home lacks it, nearest first."""
    found = [name]
    while (other := stand_in[found[-1]] or name) not in found:
        found.append(other)
    return tuple(found[1:])


def _action_spellings(actions: Mapping[str, Action]) -> dict[str, Action]:
    names = {key_of(alias): action for action in actions.values() for alias in action.aliases}
    names.update((key_of(name), action) for name, action in actions.items())
    return {**names, **actions, **{name.upper(): action for name, action in actions.items()}}


def _object_spellings(
    objects: Mapping[str, ObjectClass], aliases: Mapping[str, str], faults: Faults
) -> dict[str, ObjectClass]:
    """Every spelling without its separators -> class; a spelling that may mean two classes is a fault."""
    names: dict[str, ObjectClass] = {}
    meant = [*((name, name) for name in objects), *aliases.items()]
    for spelling, target in meant:
        thing = objects[target]
        other = names.setdefault(key_of(spelling), thing)
        if (other.same_as or other.name) != (thing.same_as or thing.name):
            faults.add("", 0, f"`{spelling}` may mean `{other.name}` or `{target}`", "let each name mean one class")
    return names


def _with_synonyms(objects: Mapping[str, ObjectClass], aliases: Mapping[str, str]) -> dict[str, ObjectClass]:
    own = grouped((name, alias) for alias, name in aliases.items())
    return {name: replace(thing, synonyms=own[name]) if name in own else thing for name, thing in objects.items()}


def _by_weight(placements: list[Placement], column: int) -> dict[str, tuple[Placement, ...]]:
    return grouped((str(each[column]), each) for each in sorted(placements, key=lambda each: -each.weight))
