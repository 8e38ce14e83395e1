"""Environments for programs of several characters: objects that the home lacks are added where they belong."""

from collections import Counter
from dataclasses import replace

from hearth.grounding.binding import Binding, bind
from hearth.grounding.environments.default_state import prepared
from hearth.grounding.environments.environment_draft import PartialEnvironment
from hearth.grounding.environments.goal_environments import provide
from hearth.grounding.environments.sampling import TRIES, Environment, of_partial, unplaceable
from hearth.grounding.environments.soundness import unsound
from hearth.grounding.preconditions.conditions import Preconditions
from hearth.schemas.failures import Failure
from hearth.schemas.program import Program
from hearth.schemas.rng import rng
from hearth.schemas.vocabulary import CHARACTER_CLASS
from hearth.simulation.engine import Execution, run
from hearth.simulation.env import with_agents
from hearth.simulation.rules import DEFAULT, Rules
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World


def sample_together(
    program: Program, home: Home, agents: int, seed: int = 0, rules: Rules = DEFAULT
) -> tuple[Environment, Execution] | Failure:
    """Draw an environment in which a program of several characters runs.

    Args:
        program: instances as counters.
        home: any home; it is brought to its default state first.
        agents: how many characters take part.
        seed: of the added objects, and of the rooms that the characters stand in.
        rules: for the run.

    Returns:
        The environment and the execution in it, or what stopped the last one drawn.
    """
    base = prepared(home)
    failure = unplaceable(program, base)
    if failure is not None:
        return failure
    named = Counter(name for name, _ in {ref.key for ref in program.objects()})
    for attempt in range(TRIES):
        partial = PartialEnvironment(base, rng(seed, "together", home.name, program.title, attempt))
        for name, number in sorted(named.items()):
            if name != CHARACTER_CLASS and not base.knowledge.is_room(name):
                provide(partial, name, number)
        world = with_agents(World.start(partial.home()), agents, seed + attempt)
        found = bind(program, world, rules)
        failure = found if isinstance(found, Failure) else unsound(world)
        if isinstance(found, Binding) and failure is None:
            bound = found.apply(program)
            drawn = of_partial(partial, seed, bound, Preconditions())
            return replace(drawn, world=world, program=bound), run(world, bound, rules)
    assert failure is not None
    return failure
