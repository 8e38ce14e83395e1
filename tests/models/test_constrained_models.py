"""Every model that is decoded with the engine in the loop, with random weights, in two hundred environments."""

from __future__ import annotations

import pytest
import torch

from hearth.models.decoding.search import Search, Start, decode
from hearth.models.interface import Request, Training
from hearth.models.model_registry import MODELS, settings_of
from hearth.models.sketches.graph_model import TrainedGraphModel
from hearth.models.sketches.name_numbers import Words
from hearth.models.sketches.next_steps import Habits
from hearth.models.sketches.plan_chooser import SIZES, TrainedChooser
from hearth.models.text.text_models import TextModel
from hearth.models.text_examples import Corpus
from hearth.schemas.syntax import parse_steps
from hearth.scoring.metrics.executability import executability
from hearth.scoring.metrics.parsability import parsability

TEXTS = ("Turn on the TV and sit down.", "Put the plate into the dishwasher.", "Hände waschen", "rocket volcano", "")

SKETCHES = (("[Grab] <cup> (1)", "[PutBack] <cup> (1) <table> (1)"), ("[SwitchOn] <television> (1)",), ())

GRAPHS = [name for name, entry in MODELS.items() if "graph_model" in entry.place]

CHOOSERS = [name for name, entry in MODELS.items() if "chooser" in entry.place]


def requests(environments):
    sketches = [tuple(step for line in lines for step in parse_steps(line)) for lines in SKETCHES]
    return [Request(str(n), "", TEXTS[n % 5], sketches[n % 3], world) for n, world in enumerate(environments)]


def graph_model(name, knowledge):
    words = Words.of(knowledge)
    actions = tuple(sorted(each for each, action in knowledge.actions.items() if action.executed))
    settings = settings_of(name, size=8, hidden=16)
    return TrainedGraphModel(settings, words, actions, settings.network(words, actions).eval())


def chooser(name, knowledge):
    settings, words = settings_of(name), Words.of(knowledge, ("on", "the", "turn"))
    habits = Habits(frozenset({"Walk", "Find", "Grab", "Release", "Open", "Close", "SwitchOn"}), (), {})
    rankers = {kind: settings.ranker(words, sizes) for kind, sizes in SIZES.items()}
    for ranker in rankers.values():
        torch.nn.init.normal_(ranker.rest[-1].weight)
        ranker.eval()
    return TrainedChooser(settings, words, habits, rankers, {})


@pytest.mark.slow
@pytest.mark.parametrize("name", [*GRAPHS, *CHOOSERS])
def test_models_of_sketches(name, knowledge, environments):
    torch.manual_seed(1)
    made = chooser(name, knowledge) if name in CHOOSERS else graph_model(name, knowledge)
    asked = requests(environments)
    assert len(asked) == 200
    for request, program in zip(asked, made.predict(asked), strict=True):
        assert parsability(program, knowledge).parsable
        assert executability(program, request.world).executable


@pytest.mark.slow
@pytest.mark.parametrize("body", ["lstm", "transformer"])
def test_models_of_texts(body, dataset, eight, knowledge, environments):
    settings = TextModel(body=body, hidden=16, vector=16, dropout=0.0)
    made = settings.fit(Corpus(dataset, "activities", eight, eight[:1]), Training(epochs=1, rate=1e-6))
    asked = requests(environments)
    programs = decode(made.scorer(), [Start(each.world, each) for each in asked], Search(longest=15))
    for request, program in zip(asked, programs, strict=True):
        assert program and parsability(program, knowledge).parsable
        assert executability(program, request.world).executable
