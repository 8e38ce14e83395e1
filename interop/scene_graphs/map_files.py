"""Scene graphs in YAML, as maps of robots are written, and in URDF, as scenes of iGibson are."""

from __future__ import annotations

from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.input_files import load_yaml, read_input

MAPS = frozenset({".yaml", ".yml", ".urdf", ".xml"})
"""Endings of files that are read as maps and are not JSON."""


def map_of(path: Path) -> Any:
    """Return the value of a file in YAML or URDF.

    Raises:
        HearthError: SYNTAX: it is not written so; FILE_TOO_LARGE, MISSING_FILE.
    """
    if path.suffix in (".yaml", ".yml"):
        return load_yaml(path)
    text = read_input(path)
    if b"<!DOCTYPE" in text or b"<!ENTITY" in text:  # entities may grow without bound
        raise HearthError.of(
            Code.SYNTAX, "XML with a document type", file=str(path), suggestion="leave `<!DOCTYPE` out"
        )
    try:
        root = ElementTree.fromstring(text)
    except ElementTree.ParseError as error:
        raise HearthError.of(Code.SYNTAX, f"not XML: {error}", file=str(path)) from error
    return {root.tag: {tag: [_plain(each) for each in root.findall(tag)] for tag in ("link", "joint")}}


def _plain(element: ElementTree.Element) -> dict[str, Any]:
    """Return the attributes of an element, and those of its children by their tags."""
    return {**{child.tag: dict(child.attrib) for child in element}, **element.attrib}
