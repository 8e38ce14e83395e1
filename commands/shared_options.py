"""Groups of options that several commands have: the home of a program, and the choice of a program in a file.

A command has one parameter for a group; `options.described` lists the fields of the group as options in its place.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from hearth.commands.inputs import Given, choose_given, read_knowledge
from hearth.kb.language.reading_modes import Fuzzy

if TYPE_CHECKING:
    from hearth.kb.knowledge import Knowledge
    from hearth.schemas.program import Program
    from hearth.simulation.world.home import Home


@dataclass(frozen=True)
class HomeOptions:
    """The options that choose a home, and the knowledge of it.

    Attributes:
        home: its name or its file; the graph that came with the program, or maple, if empty.
        graph: a file of a scene graph in place of a name.
        homes: a folder of homes laid over ours.
        kb: a folder of knowledge laid over ours.
    """

    home: str = ""
    graph: Path | None = None
    homes: Path | None = None
    kb: Path | None = None

    def knowledge(self) -> Knowledge:
        """Return the knowledge, with the classes of the graph if one is named."""
        return read_knowledge(self.kb, self.home, self.graph, self.homes)

    def placed(self, given: Given, known: Knowledge) -> tuple[Program, Home]:
        """Return a program that was read, and the home in which it takes place."""
        program, home, _ = given.at_home(self.home, self.graph, self.homes, known)
        return program, home


@dataclass(frozen=True)
class ProgramOptions:
    """The options that choose and read a program of a file.

    Attributes:
        which: the number of the program, from 1.
        columns: columns of a table, or keys of JSON.
        fuzzy: how far a step may be from a known sentence.
    """

    which: int = 1
    columns: str = ""
    fuzzy: Fuzzy = Fuzzy.TYPOS

    def given(self, file: Path, known: Knowledge) -> Given:
        """Return the program with its faults; none of them is printed yet."""
        return choose_given(file, known, self.which, self.columns, self.fuzzy)
