"""Groups of options that several commands have: a program's home, the choice of a program in a file, language models.

A command has one parameter for a group; `options.described` lists the fields of the group as options in its place.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from hearth.commands.inputs import Given, choose_given, read_knowledge
from hearth.kb.language.reading_modes import Fuzzy

if TYPE_CHECKING:
    from hearth.kb.knowledge import Knowledge
    from hearth.llm.endpoint import Endpoint
    from hearth.llm.language_settings import Asking, Means
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


@dataclass(frozen=True)
class LanguageOptions:
    """The options of language models.

    Attributes:
        llm: settings, each NAME=VALUE.
        cache: the file of replies; next to the output where it is None.
        prices: IN,OUT, of a million tokens of prompts and of replies.
        budget: in the money of the prices; None for no limit.
    """

    llm: list[str] | None = None
    cache: Path | None = None
    prices: str = ""
    budget: float | None = None

    @property
    def given(self) -> bool:
        """Return whether any of them is given."""
        return bool(self.llm or self.cache or self.prices or self.budget is not None)

    def settings(self, out: Path | None, names: Sequence[str], *flags: str) -> tuple[Asking, Means]:
        """Return what the models are asked, and the means.

        Args:
            out: of the command; None where nothing is written, and replies are kept in memory.
            names: of the agents or models.
            flags: settings with a flag of their own that is given, as in `images`.

        Raises:
            HearthError: as of `read_settings`.
        """
        from hearth.llm.language_settings import kept_next_to, read_settings

        usual = None if out is None else kept_next_to(out, names)
        changed = [*(self.llm or ()), *(f"{flag}=yes" for flag in flags)]
        return read_settings(changed, self.cache or usual, self.prices, self.budget)

    def model(self, name: str, out: Path, constrained: bool) -> Endpoint:
        """Return the model of a planner or a judge.

        Raises:
            HearthError: as of `settings` and `Endpoint`; BAD_ARGUMENT: pictures are asked for.
        """
        from hearth.llm.endpoint import endpoint_of
        from hearth.schemas.diagnostics import HearthError
        from hearth.schemas.failures import Code

        asking, means = self.settings(out, (name,), *(["constrained"] if constrained else ()))
        if asking.images:
            message = "planners and judges read texts, and are shown no pictures"
            raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="leave out images")
        return endpoint_of(name, asking, means)
