"""Table 4.6: steps by the classes of their nodes, and what the rows compare."""

from __future__ import annotations

import numpy as np

import hearth
from hearth.models.execution_trials import Trial
from hearth.models.films import film_result_tables
from hearth.models.films.clip_data import Clip, Clips, Instruction
from hearth.models.films.film_contents import Shown, by_class
from hearth.models.films.film_result_tables import COLUMNS, THESIS, WAYS
from hearth.models.films.film_writer import TrainedFilmWriter
from hearth.models.films.possible_instructions import Reading
from hearth.models.films.step_order import StepOrder
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.simulation.rules import DEFAULT

DONE = (Instruction("Sit", ("sofa",)), Instruction("StandUp", ()), Instruction("Walk", ("sofa",)))


def test_steps_have_the_classes_of_their_nodes():
    world = hearth.World.start(hearth.home("maple"))
    program = hearth.parse_program("Sit\nDown.\n\n\n[Walk] <sofa> (1)\n[Sit] <sofa> (1)\n[StandUp]\n")
    bound = hearth.bind(program, world).apply(program)
    node = bound.steps[0].objects[0].node
    classes = {each.id: each.class_name for each in world.graph().nodes}
    found = by_class(bound.steps, world)
    assert [[ref.name for ref in step.objects] for step in found] == [[classes[node]]] * 2 + [[]]
    assert all(ref.node is None for step in found for ref in step.objects)
    assert by_class(program.steps, world)[0].objects[0].name == "sofa"


def test_with_the_engine_programs_run_and_without_they_need_not():
    world = hearth.World.start(hearth.home("maple"))
    scores = np.full((6, 3), -8.0, np.float32)
    scores[:2, 1] = scores[2:4, 2] = scores[4:, 0] = 0.0
    order = StepOrder.of([[DONE[2], DONE[0], DONE[1]]] * 5)
    runs = {}
    for name, write in WAYS.items():
        steps = write(Reading(DONE, scores), order, world).steps
        runs[name] = hearth.run(world, Program(steps=steps)).executable if steps else None
    assert runs["engine"] and runs["engine, order of steps"] and runs["Viterbi, order of steps, repaired"]
    assert not runs["each clip alone"]


class Writer(TrainedFilmWriter):
    """It writes the same for every film, and something else with the engine."""

    def __init__(self, free, followed):
        for name, value in {"free": free, "engine": followed, "closed": (), "reader": None}.items():
            object.__setattr__(self, name, value)

    def write(self, films, beam=1):
        return [self.free] * len(films)

    def followed(self, films, worlds, beam=1):
        return [self.engine] * len(films)


def test_writers_stand_beside_classifiers_and_seeds_are_one_row(monkeypatch):
    world = hearth.World.start(hearth.home("maple"))
    steps = tuple(Step(each.action, tuple(map(ObjectRef, each.objects))) for each in (DONE[2], DONE[0]))
    clips = tuple(Clip(film, 0, DONE[0], kind, 1) for film, kind in enumerate(("seen", "unseen")))
    models = {"a": ("films-mle", Writer(steps, steps)), "b": ("films-mle", Writer((), steps))}
    test = Clips(("one", "two"), [np.zeros((9, 2, 2), np.uint16)] * 2, clips, 9)
    monkeypatch.setattr(film_result_tables.Clips, "of", lambda *_, **__: test)
    monkeypatch.setattr(film_result_tables, "restore", models.__getitem__)
    shown = [Shown(Trial(world, Program(steps=steps), DEFAULT, name), steps) for name in "xy"]
    monkeypatch.setattr(film_result_tables, "shown_films", lambda *_: shown)
    monkeypatch.setattr(film_result_tables, "film_probabilities", lambda *_: (None, None))
    monkeypatch.setattr(film_result_tables, "score_steps", lambda dataset, pairs: [None for _ in pairs])
    monkeypatch.setattr(
        film_result_tables, "METRICS", dict.fromkeys(("executable", "goal", "goal_whole"), lambda _: 1.0)
    )
    rows = {(row.method, row.homes): row for row in film_result_tables.film_table(None, ["a", "b"])}
    free, engine = rows["films-mle, free", "all"], rows["films-mle, engine", "unseen"]
    assert free.seeds == engine.seeds == 2 and free.films == 2 and engine.films == 1
    assert free.scores["mean"].mean == free.spread == 0.5
    assert engine.scores["mean"].mean == 1.0 and engine.spread == 0
    assert rows["films-mle, free, repaired", "seen"].scores["mean"].mean < 1


def test_the_thesis_has_a_figure_in_each_column_but_ours():
    assert {len(row) for row in THESIS.values()} == {len(COLUMNS) - 2}
