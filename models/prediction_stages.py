"""The way from words or a sketch to a program that runs in a home: words, sketch, program, execution."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import zip_longest
from typing import NamedTuple

from hearth.models.interface import Request, Steps
from hearth.models.protocols import Trained
from hearth.models.reading.instruction_reading import LONGEST
from hearth.models.reading.misspelled_words import corrections
from hearth.models.reading.program_writing import sketch_of
from hearth.models.reading.reader import Reader
from hearth.models.text.text_words import words_of
from hearth.repair.runnable_predictions import Completion, complete
from hearth.schemas.failures import Code, Failure
from hearth.schemas.program import Step
from hearth.scoring.metrics.lcs import items
from hearth.simulation.rules import rules_of
from hearth.simulation.world.world import World


@dataclass(frozen=True, slots=True)
class Shown:
    """The results for one text or sketch.

    Attributes:
        words: those that the model was given.
        sketch: the steps that were written or given, without nodes.
        completion: the program that runs, and the steps that were left out of it.
        failure: why nothing of it is left to run; None where something is.
        explained: of the reader, the words that each step of the program is for; "" for a step that prepares others.
        unread: of the reader, the parts of the text that are not understood.
        forbidden: of the reader, the words for acts that are not to be done.
        corrected: of the reader, the misspelled words that it took for others: `teh = the`.
    """

    words: tuple[str, ...]
    sketch: Steps
    completion: Completion
    failure: Failure | None
    explained: tuple[str, ...] = ()
    unread: tuple[str, ...] = ()
    corrected: tuple[str, ...] = ()
    forbidden: tuple[str, ...] = ()


def show_text(trained: Trained, text: str, world: World, writer: Trained | None = None, beam: int = 1) -> Shown:
    """Write a program for a text, and complete and run it in a world.

    Args:
        trained: a model of texts.
        text: the task to do.
        world: where the program runs.
        writer: a model of sketches, which reads the output of the first as a sketch; without one the planner does.
        beam: programs followed at once.
    """
    request = Request("text", "", text, (), world)
    found = tuple(words_of(request))
    (sketch,) = trained.predict([request], beam) if found else ((),)
    shown = show_sketch(writer, sketch, world, text, beam)
    return Shown(found, sketch, shown.completion, shown.failure if found else EMPTY)


def show_reading(reader: Reader, text: str, world: World) -> Shown:
    """Return the program of the reader for a text in a world, with the words that each step is for."""
    found = tuple(words_of(Request("text", "", text[:LONGEST])))
    if not found:
        return Shown((), (), complete((), world, world.home.knowledge), EMPTY)
    answer = reader.answer(text, world, rules_of(world.home.knowledge))
    corrected = corrections(world.home.knowledge, text[:LONGEST])
    forbidden = tuple(dict.fromkeys(act.words for act in answer.reading.forbidden))
    sketch = sketch_of(answer.reading)
    written = answer.written
    if written is None:
        nothing = complete((), world, world.home.knowledge)
        understood = tuple(act.words for act in answer.reading.acts)
        return Shown(found, sketch, nothing, answer.failure, understood, answer.reading.unread, corrected, forbidden)
    left_out = tuple((Step(act.action, act.objects), failure) for act, failure in written.left_out)
    completion = Completion(written.execution, left_out, written.sources)
    acts = written.acts
    explained = tuple(acts[source].words if source >= 0 else "" for source in written.sources)
    return Shown(found, sketch, completion, None, explained, answer.reading.unread, corrected, forbidden)


EMPTY = Failure(Code.EMPTY, expected="a text", actual="no words")


def show_sketch(writer: Trained | None, sketch: Steps, world: World, text: str = "", beam: int = 1) -> Shown:
    """Write a program for a sketch, and complete and run it in a world.

    Args:
        writer: a model of sketches; None for the planner.
        sketch: without nodes.
        world: where the program runs.
        text: the text of the sketch, for models that read it.
        beam: programs followed at once.
    """
    request = Request("sketch", "", text, sketch, world)
    (written,) = writer.predict([request], beam) if writer and sketch else (sketch,)
    known = world.home.knowledge
    completion = complete(written, world, known, rules_of(known))
    return Shown(tuple(words_of(request)), sketch, completion, _failure(sketch, completion))


def _failure(sketch: Steps, completion: Completion) -> Failure | None:
    if not sketch:
        return Failure(Code.NOT_UNDERSTOOD, expected="a program", actual="no steps")
    if not completion.execution.program.steps:
        left_out = completion.left_out
        return left_out[0][1] if left_out else Failure(Code.NOT_UNDERSTOOD, expected="a step", actual="none that runs")
    return None


class Beside(NamedTuple):
    """A line of two programs side by side; `common` if both have the step, objects compared by class."""

    left: Step | None
    right: Step | None
    common: bool


def side_by_side(left: Sequence[Step], right: Sequence[Step]) -> Iterator[Beside]:
    """Two programs as lines, so that the steps of their longest common subsequence are opposite (figure 5-6)."""
    from rapidfuzz.distance import LCSseq

    for each in LCSseq.opcodes(items(tuple(left)), items(tuple(right))):
        one, other = left[each.src_start : each.src_end], right[each.dest_start : each.dest_end]
        for steps in zip_longest(one, other):
            yield Beside(*steps, common=each.tag == "equal")
