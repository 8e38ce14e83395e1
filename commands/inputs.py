"""Inputs of several commands: knowledge, a program file, a home, the paths of sources."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from hearth.kb.language.reading_modes import Fuzzy
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code

if TYPE_CHECKING:
    from hearth.kb.knowledge import Knowledge
    from hearth.schemas.goals import Goal
    from hearth.schemas.program import Program
    from hearth.schemas.stage_rows import IngestedRow, WrittenGroundingRow
    from hearth.simulation.rules import Rules
    from hearth.simulation.world.home import Home
    from hearth.storage.rejects import Reject


def paths(sources: Sequence[Path] | None) -> list[str]:
    """Return the paths of the sources, or of the embedded corpus if there are none."""
    from hearth.pipelines.build import corpus

    return [str(path) for path in sources or corpus()]


def read_knowledge(
    overlay: Path | None, name: str = "", graph: Path | None = None, homes: Path | None = None
) -> Knowledge:
    """Our knowledge, with a user's own files laid over it, and with the classes of the graph that a program is for.

    Args:
        overlay: a folder of files of knowledge.
        name, graph, homes: the home, as for `read_home`; without a name and a graph the knowledge stays as it is.

    Raises:
        HearthError: every fault of the user's files, or of the graph.
    """
    from hearth.kb.loading.load import overlaid

    known = overlaid(overlay)
    return _with_classes(known, name, graph, homes) if name or graph else known


def _with_classes(known: Knowledge, name: str, graph: Path | None, homes: Path | None) -> Knowledge:
    from hearth.homes import library
    from hearth.kb.knowledge_with_graph_classes import with_classes

    graph = graph or library.given_file(name)
    found = library.graph_of(graph, known) if graph is not None else library.load_graph(name, known, homes)
    return with_classes(known, found.nodes)


class Given(NamedTuple):
    """One program of an input: names canonical, faulty steps left out, faults and warnings by line, its own home.

    Its sources are the steps whose line says from where a thing is taken, each with the class of that place.
    """

    program: Program
    place: str
    faults: tuple[Diagnostic, ...]
    warnings: tuple[Diagnostic, ...] = ()
    grounding: WrittenGroundingRow | None = None
    sources: tuple[tuple[int, str], ...] = ()

    def at_home(
        self, name: str, graph: Path | None, homes: Path | None, known: Knowledge
    ) -> tuple[Program, Home, bool]:
        """Return the program, where it takes place, and whether that is the graph that came with it, to which it is
        bound.

        Raises:
            HearthError: UNKNOWN_HOME, or a fault of a graph.
        """
        from hearth.datasets.format.row_conversion import graph_of
        from hearth.grounding.binding import Binding, bind_stored
        from hearth.simulation.world.home import Home
        from hearth.simulation.world.world import World

        if name or graph or not self.grounding or not self.grounding["start"]:
            place = read_home(name or DEFAULT_HOME, graph, homes, known)
            return _of_home(self.program, place, self.place), place, False
        place = Home.from_graph(graph_of(self.grounding["start"]), self.grounding["home"], known)
        found = bind_stored(self.program, World.start(place))
        return found.apply(self.program) if isinstance(found, Binding) else self.program, place, True


def _of_home(program: Program, home: Home, file: str) -> Program:
    """Return the program with the nodes of the home that it names; says which, and which the home lacks.

    Raises:
        HearthError: UNBOUND: a node that it names is a thing of another class.
    """
    from hearth.commands import output
    from hearth.grounding.node_ids import read_ids

    found = read_ids(program, home, file)
    if found.faults:
        raise HearthError(found.faults)
    if found.named:
        shown = (f"<{ref.name}> to node {ref.node} ({home.classes[home.index[ref.node or 0]]})" for ref in found.named)
        output.note(f"By their numbers these are bound: {_some(shown, len(found.named))}.")
    if found.lacking:
        shown = (f"{ref.node} (<{ref.name}>)" for ref in found.lacking)
        count = output.counted(len(found.lacking), "node")
        output.note(
            f"{home.name} lacks {count} that the program names: {_some(shown, len(found.lacking))}; bound anew."
        )
    return found.program


def _some(names: Iterable[str], count: int) -> str:
    """Return the first names of a list, and how many more there are."""
    rest = count - MOST_NAMED
    return ", ".join(islice(names, MOST_NAMED)) + (f" and {rest} more" if rest > 0 else "")


MOST_NAMED = 6
"""Objects of a program that a note names."""

DEFAULT_HOME = "maple"


def read_program(file: Path, known: Knowledge) -> Program:
    """Return the first program of an input; see `read_given`."""
    return read_given(file, known).program


def read_given(
    file: Path, known: Knowledge, number: int = 1, strict: bool = False, columns: str = "", fuzzy: Fuzzy = Fuzzy.TYPOS
) -> Given:
    """Return a program of an input of any form that `build` reads; a faulty step is left out, with a warning on stderr.

    Args:
        file: a file or folder; `-` is standard input.
        known: the grammar.
        number: which of its programs, from 1.
        strict: refuse a program with a faulty step, or one that was corrected or shortened.
        columns: of a table, or keys of JSON, as in `title=Task,program=Plan`.
        fuzzy: how far the steps of plans may be from sentences that are known.

    Raises:
        HearthError: every fault of a program without a step that can be used, or of an input without a program.
    """
    from hearth.commands import output
    from hearth.commands.grouped_faults import in_order

    given = choose_given(file, known, number, columns, fuzzy)
    fuzzy_steps = [each for each in given.warnings if each.code == Code.FUZZY_MATCH]
    if strict and fuzzy_steps:
        raise HearthError([*given.faults, *fuzzy_steps])
    if given.faults and (strict or not given.program.steps):
        raise HearthError(given.faults)
    output.report(in_order((*given.faults, *given.warnings)), kind="warning")
    if given.faults:
        lines = output.counted(len({fault.line for fault in given.faults}), "line")
        output.note(f"Left out: {lines}; with `--strict` such a program is refused.")
    return given


def choose_given(file: Path, known: Knowledge, number: int = 1, columns: str = "", fuzzy: Fuzzy = Fuzzy.TYPOS) -> Given:
    """Return a program of an input with its faults; nothing is said of them yet. See `read_given`.

    Raises:
        HearthError: the input has no such program, or cannot be read.
    """
    from hearth.commands import output
    from hearth.kb.language.recognition_knowledge import recognizing
    from hearth.storage.input_files import placed
    from hearth.storage.rejects import Reject

    refused: list[Diagnostic] = []
    programs: list[Given] = []
    with placed(file) as path, recognizing(known):
        for found in read_programs(path, known, name_of(file), columns, fuzzy):
            if isinstance(found, Reject):
                refused += found.diagnostics
            else:
                programs.append(found)
            if len(programs) > number:
                output.note(f"{file} holds further programs; this is number {number}, `--program N` takes another")
                break
    if len(programs) < number:
        message = f"it holds {output.counted(len(programs), 'program')}" if programs else "no program in it"
        raise HearthError(refused or HearthError.of(Code.EMPTY, message, file=str(file)).diagnostics)
    return programs[number - 1]


def read_programs(
    path: Path, known: Knowledge, name: str, columns: str = "", fuzzy: Fuzzy = Fuzzy.TYPOS
) -> Iterator[Given | Reject]:
    """Yield the programs of a file or folder that is called `name` in diagnostics, and rejects for the rest.

    Raises:
        HearthError: nothing in it can be read.
    """
    from hearth.commands import output
    from hearth.pipelines import ingest
    from hearth.pipelines.readers.field_columns import FieldColumns, read_columns, shown
    from hearth.pipelines.readers.reader_items import Source
    from hearth.storage.rejects import Reject

    tables: dict[str, FieldColumns] = {}
    described: list[IngestedRow] = []
    for _, item in ingest.items([Source(name, path)], read_columns(columns), tables):
        for place in [place for place, found in tables.items() if found]:
            columns_of = tables.pop(place)
            if not getattr(columns_of, "is_ours", False):
                output.note(shown(place, columns_of))
        for row in ingest.read(item):
            if isinstance(row, Reject):
                yield row
            elif row["kind"] == "program":
                yield _given(row, known, fuzzy)
            elif row["kind"] == "description":
                described.append({**row, "text": None})
    if described:
        _note_described(described)


def _note_described(rows: Sequence[IngestedRow]) -> None:
    """Say which records have a description and no plan: they are read, and nothing of them is checked."""
    from hearth.commands import output

    places = (f"{row['place']}:{row['line'] + 1}" if row["line"] is not None else row["place"] for row in rows)
    output.note(f"{output.counted(len(rows), 'description')} without a plan: {_some(places, len(rows))}.")


def name_of(file: Path) -> str:
    """Return the name of a file in diagnostics."""
    return "standard input" if str(file) == "-" else str(file)


def _given(row: IngestedRow, known: Knowledge, fuzzy: Fuzzy) -> Given:
    from hearth.kb import action_grammar
    from hearth.kb.language.named_sources import sources_of_steps
    from hearth.kb.language.numbered_steps import parse_steps
    from hearth.pipelines.readers import natural_language_plans
    from hearth.pipelines.readers.reader_warnings import diagnostics
    from hearth.schemas.syntax import parse_program
    from hearth.schemas.text_places import TextPlaces

    text, place = row["text"] or "", row["place"]
    places = TextPlaces(row["line"] or 0, row["places"] or ())
    own = next(iter(row["groundings"] or ()), None)
    if row["origin"] == natural_language_plans.NAME:
        steps = parse_steps(text, 0, place, known, fuzzy)
        lines = tuple(map(places.line, steps.program.lines))
        faults, warnings = (tuple(map(places.placed, found)) for found in steps[1:])
        warnings = (*diagnostics(row["warnings"], place), *warnings)
        sources = sources_of_steps(known, steps.program, text.split("\n"))
        return Given(_titled(replace(steps.program, lines=lines), row), place, faults, warnings, own, sources)
    written, syntax = parse_program(text, place)
    program, wrong = action_grammar.check(written, known, place, text.split("\n"))
    bad = {fault.line for fault in wrong}
    kept = [number for number, line in enumerate(program.lines) if line not in bad]
    steps_kept, lines = tuple(program.steps[n] for n in kept), tuple(places.line(program.lines[n]) for n in kept)
    moved = sorted((places.placed(fault) for fault in (*syntax, *wrong)), key=lambda f: f.line)
    warned = diagnostics(row["warnings"], place)
    return Given(_titled(replace(program, steps=steps_kept, lines=lines), row), place, tuple(moved), warned, own)


def _titled(program: Program, row: IngestedRow) -> Program:
    title, description = row["title"] or program.title, row["description"] or program.description
    return replace(program, title=title, description=description)


def read_home(name: str, graph: Path | None, homes: Path | None, known: Knowledge) -> Home:
    """Return the home of that name, or that of a graph file; a name that is the path of a file is that file.

    A note says which nodes the knowledge had to complete.

    Raises:
        HearthError: UNKNOWN_HOME, or a fault of the file.
    """
    from hearth.homes import library
    from hearth.simulation.world.home import Home

    graph = graph or library.given_file(name)
    note_filled(library.filled_nodes(graph or name, known, homes))
    if graph is not None:
        return Home.from_graph(library.graph_of(graph, known), graph.stem, known)
    return Home.from_graph(library.load_graph(name, known, homes), name, known)


def of_rules(known: Knowledge, name: str) -> Knowledge:
    """Return the knowledge with the actions of the set that rules of that name read; only `consequences` read set 3."""
    from hearth.kb.action_sets import LATEST

    return known.of_set(LATEST) if name == "consequences" else known


def read_rules(name: str, home: Home) -> Rules:
    """Return the rules of that name (see `simulation.rules.CHOICES`).

    `auto` takes the rules that fit the home, and says so if they are not ours.

    A graph of VirtualHome 2.x has no CLOSE edges between things: its simulator infers closeness from ON and INSIDE, and
    so do the rules `evolving_graph`.
    """
    from hearth.commands import output
    from hearth.simulation.rules import CHOICES, EVOLVING_GRAPH

    if name != "auto":
        return CHOICES[name]
    if any(home.close) or not home.able("Grab"):
        return CHOICES["default"]
    output.note(
        f"No two things of {home.name} are CLOSE, as in graphs of VirtualHome 2.x: read by the rules `evolving_graph`; "
        "`--rules default` takes ours."
    )
    return EVOLVING_GRAPH


def note_filled(nodes: Sequence[str]) -> None:
    """Say which nodes of a graph have a category, properties or states only from the knowledge of their class."""
    from hearth.commands import output

    if nodes:
        count = output.counted(len(nodes), "node")
        named = _some(iter(nodes), len(nodes))
        output.note(f"{count} without category, properties or states: from the knowledge of the class: {named}.")


def read_goals(goals: Sequence[str], home: Home) -> Goal:
    """Return all that some goals ask for; `@FILE` is a goal in a file, as text or as JSON.

    Raises:
        HearthError: the first fault, with its place.
    """
    from hearth.schemas.goals import Goal
    from hearth.simulation.goal_text import read_goal

    found = Goal()
    for text in goals:
        inside = text.startswith("@")
        file = text[1:] if inside else "--goal"
        found &= read_goal(_goal(_goal_text(file) if inside else text, file), home, file)
    return found


def _goal_text(file: str) -> Any:
    from hearth.schemas.text_decoding import decode
    from hearth.storage.input_files import read_input

    return decode(read_input(Path(file)), file)


def _goal(text: Any, file: str) -> Any:
    """Return text as it is; a text that begins with a brace as JSON."""
    from hearth.pipelines.readers.json_documents import parsed
    from hearth.storage.rejects import Reject

    found = parsed(text, file, 1) if isinstance(text, str) and text.lstrip().startswith("{") else text
    if isinstance(found, Diagnostic | Reject):
        raise HearthError(found if isinstance(found, Diagnostic) else found.diagnostics)
    return found
