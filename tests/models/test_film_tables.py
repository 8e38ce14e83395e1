"""Table 4.6: steps by the classes of their nodes, and what the rows compare."""

from __future__ import annotations

import numpy as np

import hearth
from hearth.models.films.clip_data import Instruction
from hearth.models.films.film_executions import by_class
from hearth.models.films.film_readings import Reading
from hearth.models.films.film_tables import COLUMNS, THESIS, WAYS
from hearth.models.films.step_order import StepOrder
from hearth.schemas.program import Program

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


def test_the_thesis_has_a_figure_in_each_column_but_ours():
    assert {len(row) for row in THESIS.values()} == {len(COLUMNS) - 1}
