"""`ScriptExecutor` and `check_script` of VirtualHome's symbolic half, by our engine."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import orjson

from hearth.grounding.binding import bind_far
from hearth.grounding.grounded_run import attempt
from hearth.interop.virtualhome.symbolic_classes import (
    EnvironmentGraph,
    EnvironmentState,
    ExecutionInfo,
    Script,
    ScriptParseException,
    read_script_from_list_string,
)
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failure_words import in_program, sentence
from hearth.schemas.failures import Code, Failure
from hearth.schemas.graph_wrappers import graph_in
from hearth.schemas.program import Program
from hearth.simulation.engine import Execution, run
from hearth.simulation.rules import EVOLVING_GRAPH, Rules
from hearth.simulation.world.home import Home
from hearth.storage.input_files import read_input


class ScriptExecutor:
    """Runs scripts in a graph.

    Args:
        graph: of the home.
        name_equivalence: read over: our knowledge has the names that mean the same.
        char_index: of the character that acts.
        rules: how actions are read; those of VirtualHome 2.x if none are given.

    Attributes:
        info: why the last script was not executed.
    """

    def __init__(
        self, graph: EnvironmentGraph, name_equivalence: Any = None, char_index: int = 0, rules: Rules = EVOLVING_GRAPH
    ) -> None:
        self.graph, self.name_equivalence, self.char_index, self.rules = graph, name_equivalence, char_index, rules
        self.info = ExecutionInfo()

    def execute(
        self, script: Script, init_changers: Sequence[Any] | None = None, w_graph_list: bool = True
    ) -> tuple[bool, EnvironmentState, list[dict[str, Any]]]:
        """Return whether a script runs, its last state, and the graph at the start and after each step."""
        execution = self._run(script, init_changers)
        last = EnvironmentState.at(execution.final)
        worlds = execution.worlds if w_graph_list else ()
        return execution.executable, last, [EnvironmentState.at(world).to_dict() for world in worlds]

    def find_solutions(self, script: Script, init_changers: Sequence[Any] | None = None) -> Iterator[EnvironmentState]:
        """Yield the last state of a script with things with which it runs; nothing where there are none.

        Raises:
            HearthError: BAD_ARGUMENT: init_changers are given.
        """
        execution = self._run(script, init_changers)
        if execution.executable:
            yield EnvironmentState.at(execution.final)

    def _run(self, script: Script, init_changers: Sequence[Any] | None) -> Execution:
        if init_changers:
            remedy = "change the graph before, or give check_script the preconditions"
            raise HearthError.of(Code.BAD_ARGUMENT, "init_changers are not applied", suggestion=remedy)
        self.info = ExecutionInfo()
        steps = tuple(replace(step, agent=self.char_index) for step in script.program.steps)
        world, program = self.graph.world(), script.program.with_steps(steps)
        found, failure = bind_far(program, world, self.rules)
        bound = found.apply(program)
        execution = run(world, bound, self.rules)
        failure = execution.failure or failure
        if failure is not None:
            self.info.error(in_program(failure, bound))
            return replace(execution, failure=failure)
        return execution


Checked = tuple[Any, Any, Any, Any, Any, Any, Any, Any]
"""The result of `check_script`: message, final state, graphs, start graph, id mapping, info, helper (None), script."""


def check_script(
    program_str: Sequence[str],
    precond: Sequence[Mapping[str, Any]] | None,
    graph_path: str | Path | None,
    inp_graph_dict: Mapping[str, Any] | None = None,
    modify_graph: bool = True,
    id_mapping: Mapping[tuple[str, int], int] | None = None,
    info: Mapping[str, Any] | None = None,
) -> Checked:
    """Return whether a script runs in a graph, as VirtualHome's function of this name.

    With `modify_graph` the graph gets the things that the script needs and the graph lacks, and states in which it can
    run. They follow from the script itself, so that `precond` needs not be given.

    Args:
        program_str: the lines of the script.
        precond: read over: our sampler infers the preconditions.
        graph_path: of a graph as JSON, where none is given as `inp_graph_dict`.
        inp_graph_dict: the graph.
        modify_graph: whether the graph may be changed for the script.
        id_mapping: `(name, number)` of the script's things -> node.
        info: returned as it is.

    Returns:
        Message, final state, graphs, start graph, id mapping, info, None in place of a helper, and the script; eight
        times None where the script can't be read.
    """
    try:
        script = read_script_from_list_string(program_str)
    except ScriptParseException:
        return (None,) * 8
    given = dict(inp_graph_dict) if inp_graph_dict is not None else _loaded(Path(str(graph_path)))
    graph = EnvironmentGraph(given)
    named = dict(id_mapping or {})
    if named:
        script = Script(_mapped(script.program, named))
    if modify_graph:
        home = Home.from_graph(graph._scene, "graph", graph.knowledge)
        trial = attempt(script.program, home, 0, EVOLVING_GRAPH)
        if isinstance(trial, Failure):
            said = f"Script is not executable, since {sentence(trial)}"
            return said, None, [], given, named, dict(info or {}), None, script
        execution = trial.execution
        states = [EnvironmentState.at(world).to_dict() for world in execution.worlds]
        bound, final = execution.program, EnvironmentState.at(execution.final)
        failure = execution.failure
        said = "Script is executable" if failure is None else _said(in_program(failure, bound))
        named |= {(ref.name, ref.instance): ref.node for ref in bound.objects() if ref.node is not None}
        return said, final, states, states[0], named, dict(info or {}), None, Script(bound)
    executor = ScriptExecutor(graph)
    executable, final, states = executor.execute(script)
    said = "Script is executable" if executable else _said(executor.info.get_error_string())
    return said, final, states, given, named, dict(info or {}), None, script


def _said(reason: str) -> str:
    return f"Script is not executable, since {reason}"


def _mapped(program: Program, named: Mapping[tuple[str, int], int]) -> Program:
    steps = tuple(
        replace(step, objects=tuple(replace(ref, node=named.get((ref.name, ref.instance), ref.node))
                                    for ref in step.objects))
        for step in program.steps
    )  # fmt: skip
    return program.with_steps(steps)


def _loaded(path: Path) -> dict[str, Any]:
    found = orjson.loads(read_input(path))
    return graph_in(found) or found
