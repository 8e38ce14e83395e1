"""A file with an activity of BEHAVIOR, read as a home and the text of its goal."""

from __future__ import annotations

from pathlib import Path

from hearth.interop.bddl.environment import environment_of
from hearth.interop.bddl.expressions import LONGEST
from hearth.interop.bddl.goal_reading import goal_of
from hearth.interop.bddl.problem import read_problem
from hearth.interop.scene_graphs.fillings import ReadGraph
from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.text_decoding import decode
from hearth.storage.input_files import read_input


def read_activity(path: Path, knowledge: Knowledge) -> tuple[ReadGraph, str]:
    """Return the home that an activity describes, and its goal as `read_goal` reads it.

    A goal that our language can't say is among the faults, and the text is "".

    Raises:
        HearthError: the file can't be read, or is no problem; see `read_problem` and `environment_of`.
    """
    text = decode(read_input(path, LONGEST), str(path))
    if not isinstance(text, str):
        raise HearthError(text)
    found = environment_of(read_problem(text, str(path)), knowledge)
    names = {number: name for name, number in found.nodes.items()}
    goal, left_out = "", list(found.left_out)
    try:
        goal = str(goal_of(found, knowledge))
    except HearthError as error:
        left_out += error.diagnostics
    return ReadGraph(found.graph, found.fillings, tuple(left_out), names), goal
