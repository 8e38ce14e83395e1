"""An episode on the floor plan: the agents' ways, and the moments at which they handled something (figure 6-6)."""

from collections.abc import Iterator, Sequence

from hearth.challenges.challenge_definition import challenge
from hearth.challenges.episodes import Record, replayed, start_of
from hearth.challenges.result_files import Results
from hearth.challenges.tasks import Task
from hearth.homes.floor_plan_drawing import Trail
from hearth.homes.side_by_side_floor_plans import Panel
from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.simulation.env import Tick
from hearth.simulation.motion.ground import ground_of
from hearth.simulation.world.world import World

COLOURS = ("#d1495b", "#2a6fbb")
"""Colors of the main agent and of the helper."""


def episode_of(found: Results, file: str, task: str, episode: int, alone: bool) -> tuple[Task, Record]:
    """Return an episode of results, and its task.

    Args:
        found: the results.
        file: their name in faults.
        task: its task's id.
        episode: its number among those of its task.
        alone: without the helper, where there are episodes with one.

    Raises:
        HearthError: UNKNOWN_ID: there is none.
    """
    wanted = (task, episode, found.header.helped[-1] and not alone)
    record = next((each for each in found.records if (each.task, each.seed, each.helped) == wanted), None)
    if record is None:
        raise HearthError.of(Code.UNKNOWN_ID, f"no episode {episode} of `{task[:80]}`", file=file)
    return next(each for each in found.header.suite.tasks if each.id == task), record


def ticks_of(task: Task, record: Record, knowledge: Knowledge) -> tuple[World, list[Tick]]:
    """Return the start of an episode and its ticks; errors as of `episodes.again`."""
    start = start_of(task, knowledge, None if record.helped else 1)
    return start, replayed(challenge(task.challenge), task, record, start)[0]


def trails(start: World, ticks: Sequence[Tick]) -> list[Trail]:
    """Return the way of each agent; within a stride the shortest one on the floor, which does not cut corners of walls.

    Raises:
        HearthError: NOT_RENDERED: the agents have no places.
    """
    found = []
    here = ground_of(start.home)
    for number, agent in enumerate(start.agents):
        if agent.pose is None or here is None:
            raise HearthError.of(Code.NOT_RENDERED, f"{start.home.name} has no geometry, and agents no places")
        points, moments = [agent.pose.point], []
        for tick in ticks:
            pose = tick.world.agents[number].pose
            assert pose is not None
            if pose.point != points[-1]:
                points += (here.ground.ways.path(points[-1], pose.point) or ())[1:-1]
                points.append(pose.point)
            if _handles(tick, number):
                moments.append(pose.point)
        found.append(Trail(tuple(points), COLOURS[number % len(COLOURS)], tuple(moments)))
    return found


def panels_of(found: Results, task: Task, record: Record, knowledge: Knowledge) -> list[Panel]:
    """Return an episode as drawings: the helped one, and next to it the main agent alone, where the run has it.

    Raises:
        HearthError: NOT_RENDERED: the agents have no places.
    """
    helper = found.header.lineup.helper
    alone = [each for each in found.records if (each.task, each.seed) == (task.id, record.seed) and not each.helped]
    records = [*alone, record] if record.helped else [record]
    return [_panel(each, *ticks_of(task, each, knowledge), helper) for each in records]


def _panel(record: Record, start: World, ticks: Sequence[Tick], helper: str) -> Panel:
    found = tuple(trails(start, ticks))
    reached = "goal reached" if record.metrics["success"] else "goal not reached"
    title = f"{'with ' + helper if record.helped else 'alone'}: {reached} after {record.metrics['ticks']} ticks"
    return Panel(title, found, ("main agent", f"helper ({helper})")[: len(found)])


def furniture(task: Task, world: World) -> set[str]:
    """Return the classes of furniture that a task's goal names."""
    home = world.home
    every = [term for literal, _ in task.goal_in(home) for term in literal.terms]
    return {home.classes[home.index[term]] for term in every if isinstance(term, int)}


def _handles(tick: Tick, number: int) -> bool:
    """Return whether an agent did something with things other than walking to them."""
    step = tick.instructions.get(number)
    if step is None or number in tick.failures or not step.objects:
        return False
    return step.action not in tick.world.home.knowledge.group("goes")


def narrated(ticks: Sequence[Tick]) -> Iterator[tuple[int, int, str, str]]:
    """Yield all actions but walking: tick, agent, instruction in words, and the reason of a failure."""
    for number, tick in enumerate(ticks):
        for agent, step in sorted(tick.instructions.items()):
            known = tick.world.home.knowledge
            if step.action in known.group("goes") and agent not in tick.failures:
                continue
            names = ", ".join(f"{ref.name} ({ref.node})" for ref in step.objects)
            failure = tick.failures.get(agent)
            yield number + 1, agent, f"{step.action} {names}".strip(), str(failure.code) if failure else ""
