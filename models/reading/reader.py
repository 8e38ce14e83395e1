"""The model `reader`: what a person says, read by clauses, and planned in the home in which it is to be done.

A text is cut into clauses; each is read by a table of requests, or as a step in words. Out come acts about things of
the home, in the order that the text says, and goals. The planner makes them run. Nothing is learned, and nothing is
made up: a text with a part that is not understood has no program. Of long descriptions, the parts that are understood
are done.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

from hearth.kb.action_sets import LATEST
from hearth.kb.loading.load import default
from hearth.models.interface import Request, Settings, Steps, Training
from hearth.models.reading.clause_marks import DESCRIPTION
from hearth.models.reading.instruction_reading import Reading, read_text
from hearth.models.reading.narration import narrated
from hearth.models.reading.program_writing import Written, is_forbidden, repeats, write_program
from hearth.schemas.failures import Code, Failure
from hearth.schemas.syntax import print_step
from hearth.simulation.rules import Rules
from hearth.simulation.world.world import World
from hearth.storage.parallel import Seen, unseen

if TYPE_CHECKING:
    from hearth.models.checkpoint import Checkpoint
    from hearth.models.text_examples import Corpus


class Answer(NamedTuple):
    """The answer to a text in a home.

    Attributes:
        reading: of the text.
        written: the program; None where the text is refused.
        failure: why it is refused.
    """

    reading: Reading
    written: Written | None
    failure: Failure | None = None


@dataclass(frozen=True, slots=True)
class Reader(Settings):
    """The reader as a model: it needs no training."""

    def fit(self, corpus: Corpus, how: Training, seen: Seen = unseen) -> Reader:
        """Itself."""
        return self

    @classmethod
    def restored(cls, checkpoint: Checkpoint) -> Reader:
        """Itself."""
        return cls()

    def predict(self, requests: Sequence[Request], beam: int = 1) -> list[Steps]:
        """Return the program for each text in its world; without a world, its acts as people write programs."""
        return [self._steps(each) for each in requests]

    def _steps(self, request: Request) -> Steps:
        text = f"{request.title}. {request.description}" if request.description and request.title else (
            request.description or request.title)  # fmt: skip
        if request.world is None:
            known = default().of_set(LATEST)
            return narrated(read_text(text, known).acts, known)
        found = self.answer(text, request.world, request.rules)
        return found.written.execution.program.steps if found.written else ()

    def answer(self, text: str, world: World, rules: Rules) -> Answer:
        """Return the program for a text in a home, or why there is none."""
        from hearth.models.reading.unread_texts import refusal

        reading = read_text(text, world.home.knowledge, world)
        if (failure := refusal(reading, is_long=is_description(text))) is not None:
            return Answer(reading, None, failure)
        written = write_program(reading, world, rules)
        if written.left_out and not is_description(text):
            return Answer(reading, None, written.left_out[0][1])
        steps = written.execution.program.steps
        if not steps:
            return Answer(reading, None, refusal(Reading(), is_long=False))
        if banned := next((step for step in steps if is_forbidden(step, reading.forbidden)), None):
            return Answer(reading, None, Failure(Code.NOT_UNDERSTOOD, action=banned.action,
                                                 expected="a way without what is not to be done",
                                                 actual=f"`{print_step(banned)}` is needed"))  # fmt: skip
        return Answer(reading, written)

    def checkpoint(self) -> Checkpoint:
        """Return a checkpoint without weights."""
        from hearth.models.checkpoint import Checkpoint

        return Checkpoint("reader", {}, {}, {})


def is_description(text: str) -> bool:
    """Return whether a text is a description, and not an instruction."""
    return len(text.split()) > DESCRIPTION


__all__ = ["Answer", "Reader", "is_description", "repeats"]
