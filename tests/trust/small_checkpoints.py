"""Checkpoints of every kind of model, and how each is asked: what attacks and fuzzing change a little.

Kinds that no checkpoint comes with are untrained and tiny: what reads them is the same.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, replace
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

import numpy as np

from hearth.kb.loading.load import default
from hearth.models.checkpoint import Checkpoint, load, save
from hearth.models.interface import Request
from hearth.models.model_registry import TRAINED, restore_any
from hearth.models.proposals.goal_proposals import restored
from hearth.schemas.program import ObjectRef, Step

PROPOSALS = "goal-proposals-small"
"""Of a kind that the registry lacks, as it answers no questions of people."""

STEPS = tuple(
    Step(action, tuple(map(ObjectRef, names)))
    for action, *names in (
        ("Walk", "bathroom"), ("SwitchOn", "television"), ("Watch", "television"), ("Sit", "sofa"),
        ("Grab", "milk"), ("PutBack", "plate", "table"), ("Sleep",),
    )
)  # fmt: skip
"""The training steps of untrained models: steps of none, one and two objects."""

PAIRS = ((Request("x", "Watch TV", "Turn on the television and sit down on the sofa."), STEPS),)

REMEMBERED = ("watch tv", "sleep in bed"), (STEPS[:4], STEPS[6:])
"""Texts and programs of models that remember them."""


class Kind(NamedTuple):
    """A kind of model: how a checkpoint of it is made, and how the restored model is asked."""

    made: Callable[[], Checkpoint]
    ask: Callable[[Any], Any]


@cache
def folder_of(kind: str) -> Path:
    """A checkpoint of a kind, which nothing changes."""
    if (TRAINED / kind).is_dir():
        return TRAINED / kind
    found = Path(_made().name) / kind
    save(replace(KINDS[kind].made(), model=kind, trained={"dataset": "", "split": ""}), found)
    return found


@cache
def _made() -> TemporaryDirectory[str]:
    return TemporaryDirectory()


def ask(folder: Path, kind: str) -> Any:
    """Load a checkpoint and ask it what its kind is asked."""
    found = restored(str(folder)) if kind == PROPOSALS else restore_any(folder)[1]
    return KINDS[kind].ask(found)


def _came_with(kind: str) -> Callable[[], Checkpoint]:
    return lambda: load(TRAINED / kind)


def _write(model: Any) -> Any:
    """A program for a text."""
    return model.predict([Request("x", "Watch TV", "Turn on the TV and sit down on the sofa.")], 2)


def _ground(model: Any) -> Any:
    """A program for a sketch in a home."""
    from hearth.homes import library
    from hearth.simulation.world.home import Home
    from hearth.simulation.world.world import World

    world = World.start(Home.from_graph(library.load_graph("maple", default()), "maple", default()))
    return model.predict([Request("x", "", "", (STEPS[1], STEPS[3]), world)])


def film() -> np.ndarray:
    """(12, 48, 64) masks: somebody walks to a sofa."""
    things = default().objects
    frames = np.zeros((12, 48, 64), np.uint16)
    for time, frame in enumerate(frames):
        frame[20:40, 44:60] = things["sofa"].id
        frame[10:42, 2 + 3 * time : 8 + 3 * time] = things["character"].id
    return frames


def _name(model: Any) -> Any:
    """The instructions of a film's clips."""
    from hearth.models.films.film_prediction import cut

    clips = cut(film())
    (found,) = model.readings(clips)
    return found.instructions, found.moves(model.order).shape, model.named(clips)


def colours() -> np.ndarray:
    """(12, 48, 64, 3) colours of the same."""
    return np.repeat(film()[..., None] % 251, 3, -1).astype(np.uint8)


def _name_colours(model: Any) -> Any:
    from hearth.models.films.film_prediction import cut

    return list(model.readings(cut(colours())))


def _write_film(model: Any) -> Any:
    from hearth.models.films.clip_probabilities import of_film

    return model.write([of_film(model.reader, film())], 2)


def _predict_masks(model: Any) -> Any:
    return model.masks(colours()[:2])


def _sketch(model: Any) -> Any:
    from hearth.models.demonstrations.demonstration_data import Pictures

    return model.sketches([model.see(Pictures(film()[:4], colours()[:4]))])


def _infer(model: Any) -> Any:
    """The goal of the published demonstration's predicates, where nothing happens."""
    from hearth.challenges.challenge_definition import challenge

    grammar = challenge("wah").grammar
    return model.infer((), grammar.predicates, tuple(grammar.goals))


def _propose(model: Any) -> Any:
    return model.probabilities((1,) * model.settings.inputs)


def _choose(model: Any) -> Any:
    """A choice before one node, as somebody who helps has it."""
    from random import Random

    from hearth.models.helping.policy_inputs import FEATURES, KINDS, Scene

    scene = Scene((5, 9), ((0.0,) * len(FEATURES),) * 2, ((0, 0, 1),), ((True, True),) * len(KINDS), (True, False))
    return model.choose(scene, None, Random(0))[0]


def _text(**changed: Any) -> Callable[[], Checkpoint]:
    def made() -> Checkpoint:
        from hearth.models.text.step_vocabulary import StepVocabulary
        from hearth.models.text.text_models import TextModel, TrainedTextModel, listed

        settings = TextModel(hidden=12, vector=12, **changed)
        vocabulary = StepVocabulary.of(PAIRS, default())
        closed = listed(PAIRS, vocabulary, 40) if settings.steps == "closed" else ()
        return TrainedTextModel(
            settings, vocabulary, closed, settings.network(vocabulary, closed, None), {}
        ).checkpoint()

    return made


def _nearest() -> Checkpoint:
    from hearth.models.text.retrieval import Memory, Nearest, TrainedNearest

    return TrainedNearest(Nearest(), Memory(*REMEMBERED)).checkpoint()


def _random() -> Checkpoint:
    from hearth.models.text.retrieval import Memory, RandomRetrieval, TrainedRandomRetrieval

    return TrainedRandomRetrieval(RandomRetrieval(), Memory(*REMEMBERED), 0).checkpoint()


def _consensus() -> Checkpoint:
    from hearth.models.text.consensus_model import Consensus, TrainedConsensus
    from hearth.models.text.retrieval import Memory
    from hearth.models.text.retrieve_edit import RetrieveEdit, TrainedRetrieveEdit
    from hearth.models.text.step_vocabulary import StepVocabulary
    from hearth.models.text.text_models import TextModel

    memory = Memory(*REMEMBERED)
    neighbours = TrainedRetrieveEdit(RetrieveEdit(), memory, StepVocabulary.of(PAIRS, default()))
    return TrainedConsensus(Consensus(draws=3), TextModel.restored(_text()()), neighbours).checkpoint()


def _graphs() -> Checkpoint:
    from hearth.models.sketches.graph_model import GraphModel, TrainedGraphModel
    from hearth.models.sketches.name_numbers import Words

    words, written = Words.of(default()), ("Walk", "SwitchOn", "Watch", "Sit")
    settings = GraphModel(size=8, hidden=8)
    return TrainedGraphModel(settings, words, written, settings.network(words, written)).checkpoint()


def _of_clips() -> Any:
    """Return the clips in the films of the untrained models."""
    from hearth.models.films.clip_data import Clip, Clips, Instruction

    done = [Instruction(step.action, tuple(ref.name for ref in step.objects)) for step in STEPS]
    return done, Clips(("x",), [film()], tuple(Clip(0, 0, each, "seen", 1) for each in done), 9)


def _seen(**changed: Any) -> Any:
    from hearth.models.films.mask_clip_model import SeenModel, TrainedSeenModel
    from hearth.models.films.object_class_properties import ClassTable
    from hearth.models.films.step_order import StepOrder

    done, _ = _of_clips()
    table, settings = ClassTable.of(default(), done), SeenModel(width=16, layers=1, **changed)
    return TrainedSeenModel(settings, table, StepOrder.of([done]), settings.network(table))


def _coloured() -> Checkpoint:
    from hearth.models.films.clip_model import ClipModel, TrainedClipModel
    from hearth.models.films.frame_data import Labels

    labels, settings = Labels.of(_of_clips()[1]), ClipModel(width=16)
    return TrainedClipModel(settings, labels, settings.network(labels)).checkpoint()


def _of_films() -> Checkpoint:
    from hearth.models.films.film_writer import FilmWriter, TrainedFilmWriter
    from hearth.models.text.step_vocabulary import StepVocabulary

    reader, settings = _seen(), FilmWriter(hidden=12, vector=12)
    vocabulary = StepVocabulary.of(PAIRS, default())
    return TrainedFilmWriter(settings, reader, vocabulary, (), settings.network(vocabulary, (), reader)).checkpoint()


def _of_demonstrations() -> Checkpoint:
    from hearth.models.demonstrations.demo_model import DemoModel, TrainedDemoModel
    from hearth.models.demonstrations.mask_classes import MaskClasses
    from hearth.models.text.step_vocabulary import StepVocabulary

    settings, vocabulary = DemoModel(hidden=16, vector=16), StepVocabulary.of(PAIRS, default())
    known = MaskClasses.of(default(), vocabulary)
    return TrainedDemoModel(settings, vocabulary, known, settings.network(vocabulary, known)).checkpoint()


def _recall() -> Checkpoint:
    from hearth.models.reading.reader_recall import ReaderRecall

    found = _came_with("retrieve-edit")()
    return replace(found, model="reader-recall", settings=asdict(ReaderRecall()))


KINDS: dict[str, Kind] = {
    "mle-composed": Kind(_came_with("mle-composed"), _write),
    "retrieve-edit": Kind(_came_with("retrieve-edit"), _write),
    "mle": Kind(_text(steps="closed", copy=False), _write),
    "transformer": Kind(_text(body="transformer", layers=2), _write),
    "nearest": Kind(_nearest, _write),
    "random-retrieval": Kind(_random, _write),
    "consensus": Kind(_consensus, _write),
    "reader-recall": Kind(_recall, _write),
    "chooser": Kind(_came_with("chooser"), _ground),
    "resactgraph": Kind(_graphs, _ground),
    "masks": Kind(_came_with("masks"), _predict_masks),
    "clips-rgb": Kind(_coloured, _name_colours),
    "clips-seen": Kind(lambda: _seen().checkpoint(), _name),
    "clips-context": Kind(_came_with("clips-context"), _name),
    "films-mle": Kind(_of_films, _write_film),
    "demo2sketch": Kind(_of_demonstrations, _sketch),
    "goal-inference": Kind(_came_with("goal-inference"), _infer),
    PROPOSALS: Kind(_came_with(PROPOSALS), _propose),
    "helping-subgoals": Kind(_came_with("helping-subgoals"), _choose),
    "helping-actions": Kind(_came_with("helping-actions"), _choose),
}  # fmt: skip
"""By the name in the registry. Those of equal classes are one: `pg-lcs` and `desc2sketch` are `mle-composed`,
`films-pg-lcs` is `films-mle`, `retrieve-sketch` is `retrieve-edit`, `consensus-sketch` is `consensus`."""
