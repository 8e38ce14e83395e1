"""From words to a program that runs in a home, each stage by itself: words, sketch, program, execution."""

from __future__ import annotations

from dataclasses import dataclass

from hearth.kb.knowledge import Knowledge
from hearth.models.interface import Request, Steps
from hearth.models.protocols import Trained
from hearth.models.text.text_words import words_of
from hearth.repair.completion import Completion, complete
from hearth.schemas.failures import Code, Failure
from hearth.simulation.world.world import World


@dataclass(frozen=True, slots=True)
class Shown:
    """What became of a text.

    Attributes:
        words: those that the model was given.
        sketch: the steps that it wrote, without nodes.
        completion: the program that runs, and what was left out of it.
        failure: why nothing of it is left to run; None where something is.
    """

    words: tuple[str, ...]
    sketch: Steps
    completion: Completion
    failure: Failure | None


def show(trained: Trained, text: str, world: World, knowledge: Knowledge, beam: int = 1) -> Shown:
    """Write a program for a text, and complete and run it in a world."""
    request = Request("text", "", text, (), world)
    found = tuple(words_of(request))
    (sketch,) = trained.predict([request], beam) if found else ((),)
    completion = complete(sketch, world, knowledge)
    return Shown(found, sketch, completion, _failure(found, sketch, completion))


def _failure(found: tuple[str, ...], sketch: Steps, completion: Completion) -> Failure | None:
    if not found:
        return Failure(Code.EMPTY, expected="a text", actual="no words")
    if not sketch:
        return Failure(Code.NOT_UNDERSTOOD, expected="a program", actual="no steps")
    if not completion.execution.program.steps:
        return completion.left_out[0][1]
    return None
