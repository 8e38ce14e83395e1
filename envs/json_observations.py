"""An agent's observation as a JSON-able mapping. Every field depends on the visible nodes alone."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

from hearth.schemas.failures import Failure
from hearth.schemas.goals import Goal
from hearth.schemas.graph import to_release
from hearth.schemas.literals import AGENT, Literal, Name
from hearth.schemas.program import Step
from hearth.schemas.syntax import print_step
from hearth.simulation.goal_trace import acts
from hearth.simulation.literal_truth import Candidates, nodes
from hearth.simulation.observation.masked_world import as_seen
from hearth.simulation.observation.views import LastAction, Pose, View
from hearth.simulation.world.home import Home


@dataclass(frozen=True, slots=True)
class SeenLiteral:
    """A counted literal of a goal, as far as an agent sees whether it holds.

    Attributes:
        literal: as the goal has it.
        wanted: how often it must hold; of a negated one, of all that the agent sees.
        seen: how often it holds among the visible nodes; None of a literal about actions.
    """

    literal: Literal[Name]
    wanted: int
    seen: int | None


def seen_goal(goal: Goal, view: View) -> Iterator[SeenLiteral]:
    """Yield the counted literals of a goal and of its parts, with how many of each the agent sees fulfilled now."""
    home, mask = view.world.home, view.mask
    world = as_seen(view.world, mask)
    for literal, wanted, terms in _terms(goal, home):
        if terms is None:
            yield SeenLiteral(literal, wanted, None)
            continue
        masks = [next((some for each in sets if (some := each & mask)), 0) for sets in terms]
        if len(masks) == 1:
            found = Candidates(literal, masks[0], 0, by_target=False)
        else:
            found = Candidates(literal, masks[0], masks[1], by_target=not masks[0] & ~home.characters)
        yield SeenLiteral(literal, found.needed(wanted), sum(mask.bit_count() for mask in found.met(world)))


@lru_cache(maxsize=256)
def _terms(goal: Goal, home: Home) -> tuple[tuple[Literal[Name], int, tuple[tuple[int, ...], ...] | None], ...]:
    """Return the counted literals of a goal, each with the sets of nodes that its terms may stand for.

    No sets of a literal that nobody sees fulfilled: one about actions, with variables, or of a ban.
    """
    return tuple(
        (
            literal,
            wanted,
            None
            if not aims or acts(literal, home) or any(str(term).startswith("?") for term in literal.terms)
            else tuple(_sets(term, home) for term in literal.terms),
        )
        for literal, wanted, aims in goal.aims()
    )


def _sets(term: Name, home: Home) -> tuple[int, ...]:
    """Return the sets of which the first that is seen is what a term of a goal stands for.

    Other names of a class count where it is not seen itself.
    """
    if isinstance(term, int) or term.partition(":")[0] == AGENT:
        return (nodes(term, home),)
    return named_nodes(term, home)


@lru_cache(maxsize=4096)
def named_nodes(name: str, home: Home) -> tuple[int, ...]:
    """Return the nodes of a class, and of each of its other names."""
    return tuple(home.by_class.get(each, 0) for each in (name, *home.knowledge.same_class(name)))


def seen_instances(name: str, home: Home, mask: int) -> int:
    """Return the seen nodes that a class name stands for (see `Home.instances`, which looks at all)."""
    return next((found for each in named_nodes(name, home) if (found := each & mask)), 0)


def observation(view: View, goal: Goal | None = None) -> dict[str, Any]:
    """Return an agent's observation: `tick`, `me`, `others`, `messages`, `goal` and `graph`.

    The graph is in the form of the release. A box has the place of a thing at the start, so a thing that was carried
    elsewhere has none.

    A box is where a thing stood at the start, so things that were carried elsewhere have none.
    """
    return {
        "tick": view.tick,
        "me": _pose(view.me, view),
        "others": [_pose(other, view) for other in view.others],
        "messages": [{"agent": number, "says": str(said)} for number, said in view.messages],
        "goal": None if goal is None else goal_json(goal, view),
        "graph": _graph(view),
    }


def goal_json(goal: Goal, view: View) -> dict[str, Any]:
    """Return a goal as text, and its literals with `wanted` and `seen` (see `SeenLiteral`)."""
    literals = [
        {"literal": str(each.literal), "wanted": each.wanted, "seen": each.seen} for each in seen_goal(goal, view)
    ]
    return {"text": str(goal), "literals": literals}


def _graph(view: View) -> dict[str, Any]:
    world = view.world
    carried = world.moved.on | world.moved.inside
    graph = view.graph
    shown = (replace(n, box=None) if carried >> world.home.index[n.id] & 1 else n for n in graph.nodes)
    return to_release(replace(graph, nodes=tuple(shown)))


def _pose(pose: Pose, view: View) -> dict[str, Any]:
    return {
        "agent": pose.agent,
        "node": pose.node,
        "room": pose.room,
        "posture": pose.posture,
        "on": pose.on,
        "facing": pose.facing,
        "holding": pose.holding,
        "wearing": pose.wearing,
        "place": None if pose.place is None else pose.place._asdict(),
        "stride": pose.stride,
        "last": None if pose.last is None else last_json(pose.last, view),
    }


def last_json(last: LastAction, view: View) -> dict[str, Any]:
    """Return the instruction that was tried last, and why it failed, or null."""
    failure = None if last.failure is None else seen_failure(last.failure, view)
    reason = None if failure is None else {"code": str(failure.code), "message": failure.message()}
    return {"instruction": instruction_text(last.instruction), "failure": reason}


def seen_failure(failure: Failure, view: View) -> Failure:
    """Return a failure that names visible nodes alone: a closed door in another room is not named."""
    pairs = [pair for pair in zip(failure.objects, failure.names, strict=False) if view.sees(pair[0])]
    objects, names = tuple(node for node, _ in pairs), tuple(name for _, name in pairs)
    return replace(failure, tick=max(0, view.tick - 1), objects=objects, names=names)


def instruction_text(step: Step) -> str:
    """Return an instruction as agents read and write it: `[Grab] <cup> (1.41)`, of whom is known."""
    refs = tuple(replace(ref, instance=1) for ref in step.objects)
    return print_step(replace(step, objects=refs, agent=0, joins=False))
