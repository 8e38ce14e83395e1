"""The interface's tasks for our own homes and programs: goals that the engine proved, and prompts with fingerprints."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Mapping
from typing import Any

from hearth.datasets.export.pddl_domain import planning_domain
from hearth.grounding.grounded_run import attempt
from hearth.homes.library import load_graph
from hearth.kb.action_grammar import check
from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code, Failure
from hearth.schemas.graph import Edge
from hearth.schemas.program import Program
from hearth.schemas.syntax import parse_programs, print_lines
from hearth.schemas.vocabulary import STATES
from hearth.simulation.engine import Execution, run
from hearth.simulation.goal_text import read_goal
from hearth.simulation.goals import Progress
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

KEPT = ("ON", "INSIDE", "HOLDS_RH", "HOLDS_LH")
"""Relations of goals; nearness and facing are left out, as any later step ends them."""

MOST_FACTS = 12
"""Facts of a goal; a program that changes more makes no task."""

ASKED: Mapping[str, str] = {
    "goal_interpretation": 'Write the goal of the task as JSON: {"goal": ["STATE(thing.id)" or '
    '"RELATION(thing.id, thing.id)", ...]}. Use the things below.',
    "subgoal_decomposition": "Write the facts that hold one after the other on the way to the goal, as JSON: "
    '{"output": ["STATE(thing.id)" or "RELATION(thing.id, thing.id)", ...]}.',
    "action_sequencing": 'Write a plan that reaches the goal, as JSON: {"plan": ["[Action] <thing> (1.id)", ...]}.',
    "transition_modeling": "Write these actions as PDDL operators with the predicates below, as JSON: "
    '{"output": "(:action ...)"}.',
}
"""The requests of the four abilities."""


def own_task(execution: Execution, home: str, seed: int = 0) -> dict[str, Any] | None:
    """Return the task that a program poses in a home; None where it changes nothing that lasts, or too much.

    With the seed the program gives its environment again, in which answers are judged. The goal is what the program
    changed. The engine proves it: it does not hold at the start, and does at the end.
    """
    start, end = execution.worlds[0], execution.final
    facts = _facts(start, end)
    if not facts or len(facts) > MOST_FACTS:
        return None
    goal = " and ".join(facts)
    if not proved(goal, start, execution):
        return None
    names = _things(start, execution.program)
    task = {
        "id": f"{home}/{hashlib.sha256(''.join(print_lines(execution.program)).encode()).hexdigest()[:12]}",
        "home": home,
        "seed": seed,
        "title": execution.program.title,
        "description": execution.program.description,
        "goal": goal,
        "things": names,
        "program": list(print_lines(execution.program.unbound())),
    }
    prompts = {ability: _prompt(ability, task, start.home.knowledge) for ability in ASKED}
    return task | {"prompts": prompts, "fingerprints": {name: fingerprint(text) for name, text in prompts.items()}}


def proved(goal: str, start: World, execution: Execution) -> bool:
    """Return whether a goal does not hold at the start of a run, and does at its end."""
    read = read_goal(goal, start.home)
    nothing = run(start, Program(), execution.rules)
    return not Progress.of(read, nothing).satisfied and Progress.of(read, execution).satisfied


def _facts(start: World, end: World) -> list[str]:
    """Return the states and relations that a run brought about, as text."""
    change = end.changes(start)
    home = start.home

    def named(node: int) -> str:
        return f"{home.classes[home.index[node]]}.{node}"

    states = [f"{state}({named(node)})" for node, state in change.set_states if state in STATES]
    relations = [f"{edge.relation}({named(edge.source)}, {named(edge.target)})" for edge in _lasting(change.added, end)]
    return sorted({*states, *relations})


def _lasting(edges: Iterable[Edge], end: World) -> list[Edge]:
    """Return the relations of goals: of a thing that a character holds, the hand alone."""
    rooms = end.home.rooms
    held = {node for nodes in end.holding().values() for node in nodes}
    return [
        edge
        for edge in edges
        if edge.relation in KEPT and not rooms >> end.home.index[edge.target] & 1 and edge.source not in held
    ]


def _things(start: World, program: Program) -> list[str]:
    """Return the things that a program names, and the character, each with its states."""
    home = start.home
    nodes = {ref.node for step in program.steps for ref in step.objects if ref.node is not None}
    nodes |= {home.ids[agent.index] for agent in start.agents}
    found = []
    for node in sorted(nodes):
        states = [state for state in STATES if start.has_state(node, state)]
        found.append(f"{home.classes[home.index[node]]}.{node}: {', '.join(states) or 'no states'}")
    return found


def _prompt(ability: str, task: Mapping[str, Any], knowledge: Knowledge) -> str:
    lines = [f"Task: {task['title']}", task["description"], "", ASKED[ability], "", "Things:", *task["things"]]
    if ability in ("subgoal_decomposition", "action_sequencing"):
        lines += ["", f"Goal: {task['goal']}"]
    if ability == "transition_modeling":
        actions = actions_of(task)
        domain = planning_domain(knowledge, actions, loose=False)
        lines += ["", f"Actions: {', '.join(actions)}", "", domain[: domain.index("(:action")].strip()]
    return "\n".join(lines)


def actions_of(task: Mapping[str, Any]) -> list[str]:
    """Return the actions that a task's operators are asked for: those of its program."""
    program = parse_programs("Task\n\n\n\n" + "\n".join(task["program"]) + "\n").programs[0]
    return sorted({step.action for step in program.steps})


def fingerprint(text: str) -> str:
    """Return the fingerprint of a prompt."""
    return hashlib.sha256(text.encode("utf-8")).hexdigest()


def start_of(task: Mapping[str, Any], knowledge: Knowledge) -> Execution:
    """Return the run that a task was made of, with the world at its start.

    Raises:
        HearthError: CONDITION_UNMET: the program no longer gives the environment.
    """
    home = Home.from_graph(load_graph(task["home"], knowledge), task["home"], knowledge)
    parsed = parse_programs(f"{task['title']}\n{task['description']}\n\n\n" + "\n".join(task["program"]) + "\n")
    trial = attempt(parsed.programs[0], home, task["seed"])
    if isinstance(trial, Failure):
        raise HearthError.of(Code.CONDITION_UNMET, f"task {task['id']} cannot be made again")
    return trial.execution


def plan_verdict(task: Mapping[str, Any], answer: str, knowledge: Knowledge) -> tuple[bool, bool]:
    """Return whether every step of an answer's plan is done, and whether the goal then holds."""
    execution = start_of(task, knowledge)
    start = execution.worlds[0]
    try:
        lines = json.loads(_plain(answer))["plan"]
        program = parse_programs("Plan\n\n\n\n" + "\n".join(map(str, lines)) + "\n")
        checked, faults = check(program.programs[0], knowledge)
    except (ValueError, KeyError, TypeError, IndexError, RecursionError):
        return False, False
    if faults or program.diagnostics or not checked.steps:
        return False, False
    done = run(start, checked, execution.rules)
    reached = done.failure is None and Progress.of(read_goal(task["goal"], start.home), done).satisfied
    return done.failure is None, reached


def _plain(answer: str) -> str:
    return answer.strip().removeprefix("```json").strip("`").strip()


def interpretation_counts(task: Mapping[str, Any], answer: str) -> tuple[int, int, int]:
    """Return the facts of an answer that are right, wrong and left out."""
    wanted = {fact.replace(" ", "") for fact in str(task["goal"]).split(" and ")}
    try:
        found = json.loads(_plain(answer))["goal"]
        given = {str(fact).replace(" ", "") for fact in found}
    except (ValueError, KeyError, TypeError, RecursionError):
        given = set()
    return len(given & wanted), len(given - wanted), len(wanted - given)
