"""`rdf`: programs, their steps and the knowledge of actions and objects, as Turtle."""

from collections.abc import Iterator
from pathlib import Path
from urllib.parse import quote

from hearth.datasets.dataset import Dataset
from hearth.datasets.export.program_batches import Wanted, programs
from hearth.kb.knowledge import Knowledge
from hearth.schemas.published_rows import ProgramRow

PREFIX = "https://hearth.invalid/terms#"

_HEAD = f"""@prefix h: <{PREFIX}> .
@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .
@prefix xsd: <http://www.w3.org/2001/XMLSchema#> .

"""


def rdf(dataset: Dataset, to: Path, wanted: Wanted) -> int:
    """`programs.ttl` and `knowledge.ttl`.

    Returns:
        Number of programs.
    """
    to.mkdir(parents=True, exist_ok=True)
    number = 0
    with (to / "programs.ttl").open("w", encoding="utf-8", newline="\n") as file:
        file.write(_HEAD)
        for number, row in enumerate(programs(dataset, wanted), 1):  # noqa: B007 - the last number is the count
            file.writelines(f"{line}\n" for line in _program(row))
    with (to / "knowledge.ttl").open("w", encoding="utf-8", newline="\n") as file:
        file.write(_HEAD)
        file.writelines(f"{line}\n" for line in _knowledge(dataset.knowledge))
    return number


def _program(row: ProgramRow) -> Iterator[str]:
    me = iri("program", row["program_id"])
    yield f"{me} a h:Program ; rdfs:label {text(row['title'])} ; rdfs:comment {text(row['description'])} ;"
    yield f"  h:activity {iri('activity', row['activity_id'])} ; h:origin {text(row['origin'])} ;"
    if row["parent_id"] is not None:
        yield f"  h:parent {iri('program', row['parent_id'])} ;"
    yield f"  h:split {text(row['split'])} ; h:steps {len(row['steps'])} ."
    for number, step in enumerate(row["steps"]):
        place = iri("program", f"{row['program_id']}#{number}")
        objects = "".join(
            f" ; h:{role} [ h:class {iri('class', ref['name'])} ; h:instance {int(ref['instance'])} ]"
            for role, ref in zip(("object", "second"), step["objects"], strict=False)
        )
        yield f"{me} h:step {place} ."
        yield f"{place} a h:Step ; h:number {number} ; h:action {iri('action', step['action'])}{objects} ."


def _knowledge(knowledge: Knowledge) -> Iterator[str]:
    for action in knowledge.actions.values():
        executed = str(action.executed).lower()
        yield f"{iri('action', action.name)} a h:Action ; rdfs:label {text(action.name)} ;"
        yield f"  h:arity {action.arity} ; h:executed {executed} ; rdfs:comment {text(action.template)} ."
    for thing in knowledge.objects.values():
        me = iri("class", thing.name)
        yield f"{me} a h:Class ; rdfs:label {text(thing.name.replace('_', ' '))} ."
        yield from (f"{me} h:property h:{prop} ." for prop in sorted(thing.properties))
        yield from (
            f"{me} h:found [ h:relation h:{place.relation} ; h:place {iri('class', place.destination)} ] ."
            for place in knowledge.placements(thing.name)
        )


def iri(kind: str, name: str) -> str:
    """Return a valid identifier for any name."""
    return f"<{PREFIX.rstrip('#')}/{kind}/{quote(name, safe='')}>"


_ESCAPES = str.maketrans({"\\": "\\\\", '"': '\\"', "\n": "\\n", "\r": "\\r", "\t": "\\t", "\f": "\\f", "\b": "\\b"})


def text(value: str | None) -> str:
    """Return a literal, without the control characters that Turtle forbids."""
    cleaned = "".join(char for char in value or "" if char >= " " or char in "\n\r\t")
    return f'"{cleaned.translate(_ESCAPES)}"'
