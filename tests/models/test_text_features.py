"""A text's mentions of a home's things, and a chooser that writes another program for another text."""

from __future__ import annotations

import dataclasses
from random import Random

import torch

from hearth.models.decoding.next_step_options import Grammar
from hearth.models.interface import Request
from hearth.models.sketches.name_numbers import Words
from hearth.models.sketches.next_steps import ROLES, Habits
from hearth.models.sketches.plan_chooser import SIZES, Chooser, TrainedChooser
from hearth.models.sketches.sketch_progress import Progress
from hearth.models.sketches.step_features import CANDIDATE_NUMBERS, NO_NODE, Offer
from hearth.models.sketches.text_features import AROUND, NO_CLUES, Clues, TextState, frequent
from hearth.schemas.program import Step
from hearth.schemas.syntax import parse_steps

SKETCH = parse_steps("[Grab] <novel> (1)")
TEXT = Request("", "Read", "Switch on the light, take the novel and sit on the couch. The light is nice.")


def test_places_of_mentions(knowledge):
    clues = Clues.of(TEXT, knowledge)
    assert list(clues.places) == ["light", "novel", "couch"]
    assert clues.words[clues.places["light"]] == "light" and clues.places["light"] < clues.places["novel"]
    assert 0 < clues.place("light") < clues.place("novel") < clues.place("couch") < 1
    assert clues.place("bed") == NO_CLUES.place("light") == -1


def test_words_about_a_mention(knowledge):
    words = Words.of(knowledge, ("on", "switch", "take", "the"))
    clues = Clues.of(TEXT, knowledge)
    assert clues.around("light", words) == [words.word("the"), words.word("on"), words.word("take")]
    assert clues.around("bed", words) == [0] * AROUND == NO_CLUES.around("light", words)
    assert set(clues.bag(words)) == {words.word(name) for name in words.words} and NO_CLUES.bag(words) == []
    assert words.size == max(clues.bag(words)) + 1


def test_how_far_a_text_is_done(knowledge):
    clues = Clues.of(TEXT, knowledge)
    assert TextState.of(clues, []) == (0, 0)
    assert TextState.of(clues, ["light", "bed", "novel"]) == (clues.place("novel"), 2 / 3)
    assert TextState.of(NO_CLUES, ["light"]) == (0, 1)


def test_rare_words_are_left_out():
    texts = [Request(str(n), "", f"the novel {n}x") for n in range(5)]
    assert frequent(texts) == ("novel", "the", "x")
    assert frequent(texts[:2]) == ()


def test_mentioned_things_are_offered(environments, knowledge):
    """The sketch names a novel alone; the text a light."""
    world = environments[0]
    habits = Habits(frozenset({"Walk", "SwitchOn"}), (), {})
    for clues, offered in ((NO_CLUES, False), (Clues.of(TEXT, knowledge), True)):
        progress = Progress.start((), world, clues=clues)
        offer = Offer(progress, Grammar(world.home).options(world), habits, Words.of(knowledge))
        names = {ref.name for step in offer.candidates if step for ref in step.objects}
        assert ("light" in names) == offered


def test_numbers_of_candidates_are_as_many_with_a_text_as_without(environments, knowledge):
    habits = Habits(frozenset({"Walk", "Grab"}), (), {})
    for clues in (NO_CLUES, Clues.of(TEXT, knowledge)):
        progress = Progress.start((), environments[0], clues=clues)
        offer = Offer(progress, Grammar(environments[0].home).options(environments[0]), habits, Words.of(knowledge))
        choice = offer.choice()
        assert {(len(each.names), len(each.numbers)) for each in choice.candidates} == {(3 + AROUND, CANDIDATE_NUMBERS)}
        assert (
            len(NO_NODE.numbers) == len(offer._looked(0).numbers) and len(list(offer._next_steps._by_role())) == ROLES
        )


def test_the_right_step_is_among_random_others(environments, knowledge):
    habits = Habits(frozenset({"Walk", "Grab", "Find"}), (), {})
    offer = Offer(
        Progress.start((), environments[0]),
        Grammar(environments[0].home).options(environments[0]),
        habits,
        Words.of(knowledge),
    )
    whole = offer.choice()
    for number in (0, len(offer.candidates) - 1):
        some = offer.known_choice(offer.candidates[number], 5, Random(number))
        assert some is not None and len(some.candidates) == 5
        assert some.candidates[some.right] == whole.candidates[number]
    assert offer.known_choice(Step("Fly"), 5, Random(0)) is None


def test_a_chooser_reads_the_text_only_if_it_is_to(environments, knowledge):
    torch.manual_seed(3)
    settings, words = Chooser(text=True), Words.of(knowledge, ("light", "on", "sit", "take", "the"))
    habits = Habits(frozenset({"Walk", "Find", "SwitchOn", "LookAt", "TurnTo", "Sit"}), (), {})
    rankers = {
        "nodes": settings.ranker(words, SIZES["nodes"]),
        "steps": settings.ranker(words, SIZES["steps"]),
    }
    for ranker in rankers.values():
        torch.nn.init.normal_(ranker.rest[-1].weight)
        ranker.eval()
    reads = TrainedChooser(settings, words, habits, rankers, {})
    blind = dataclasses.replace(reads, settings=Chooser())
    texts = ["", TEXT.description, "Sit down on the bed by the lamp."]
    requests = [
        Request(str(n), "", text, SKETCH, world) for world in environments[:40:8] for n, text in enumerate(texts)
    ]
    for model, differ in ((reads, True), (blind, False)):
        programs = model.predict(requests)
        assert any(len({*programs[n : n + 3]}) > 1 for n in range(0, len(programs), 3)) == differ
