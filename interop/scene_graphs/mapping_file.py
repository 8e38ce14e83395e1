"""A user's mapping file: names, words and units of a scene graph, laid over those that Hearth knows."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from hearth.interop.scene_graphs.shape import QUATERNIONS, UPWARDS, Shape, by_word, usual
from hearth.kb.knowledge import Knowledge
from hearth.kb.spelling import key_of
from hearth.schemas import located_yaml
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.text_decoding import decode
from hearth.schemas.yaml_fields import Faults, fields, one_of, reads
from hearth.storage.input_files import read_input

_mapping = reads("a mapping", lambda value: isinstance(value, Mapping))


def read_mapping(path: Path, knowledge: Knowledge) -> Shape:
    """Return the shape that a mapping file describes: its names come before ours.

    Raises:
        HearthError: MISSING_FILE, SYNTAX or UNKNOWN_OBJECT, with the line of each fault.
    """
    text = decode(read_input(path), str(path))
    if not isinstance(text, str):
        raise HearthError(text)
    faults = Faults(str(path))
    entry = fields(located_yaml.read(text, str(path)), _KEYS, "a mapping of scene graphs", faults)
    shape = _laid_over(usual(), entry, faults)
    for label, name in shape.classes.items():
        if name is not None and knowledge.object_class(name) is None:
            near = knowledge.suggest(name)
            hint = f"did you mean `{near[0]}`?" if near else "`hearth kb find WORD` looks for classes"
            line = located_yaml.line_of(name)
            faults.add(Code.UNKNOWN_OBJECT, f"`{label}` is mapped to `{name}`, which is no class", line, hint)
    if faults:
        raise HearthError(faults.underlined(text))
    return shape


_KEYS: Mapping[str, Callable[[Any], Any]] = {
    "fields": _mapping,
    "edges": _mapping,
    "relations": _mapping,
    "classes": _mapping,
    "up": one_of(*UPWARDS),
    "quaternion": one_of(*QUATERNIONS),
    "scale": reads("metres of a unit, such as 0.01", lambda value: isinstance(value, float) and 1e-6 < value < 1e3),
}


def _laid_over(shape: Shape, entry: Mapping[str, Any], faults: Faults) -> Shape:
    return replace(
        shape,
        fields=_names(shape.fields, entry.get("fields", {}), "fields", faults),
        edges=_names(shape.edges, entry.get("edges", {}), "edges", faults),
        relations={**shape.relations, **by_word(_lists(entry.get("relations", {}), "relations", faults))},
        classes={**shape.classes, **{key_of(str(label)): name for label, name in entry.get("classes", {}).items()}},
        up=entry.get("up", shape.up),
        quaternion=entry.get("quaternion", shape.quaternion),
        scale=float(entry.get("scale", shape.scale)),
    )


def _names(known: Mapping[str, tuple[str, ...]], given: Mapping[str, Any], part: str, faults: Faults) -> Any:
    found = dict(known)
    for key, names in _lists(given, part, faults).items():
        if key not in known:
            line = given.at(key) if isinstance(given, located_yaml.Mapping) else 0
            faults.add(Code.SYNTAX, f"`{key}` is not part of `{part}`", line, f"known are {', '.join(known)}")
            continue
        own = tuple(_field_key(str(name)) for name in names)
        found[key] = (*own, *(name for name in known[key] if name not in own))
    return found


def _lists(given: Mapping[str, Any], part: str, faults: Faults) -> dict[str, list[Any]]:
    """Return the words of each key; a single word is a list of one."""
    found = {}
    for key, value in given.items():
        words = [value] if isinstance(value, str) else value
        if not isinstance(words, list) or not all(isinstance(word, str) for word in words):
            line = given.at(key) if isinstance(given, located_yaml.Mapping) else 0
            faults.add(Code.SYNTAX, f"`{key}` of `{part}` is neither a word nor a list of words", line)
            continue
        found[key] = words
    return found


def _field_key(name: str) -> str:
    return key_of(name.replace(".", ""))
