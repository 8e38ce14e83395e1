"""The training data of the chooser: objects of sketches with their nodes, and steps with their alternatives.

Nodes and steps before a choice are those of the program; only the choice is predicted.
"""

from collections.abc import Iterable, Iterator

from hearth.models.decoding.next_step_options import Grammar
from hearth.models.sketches.candidate_choices import Choice
from hearth.models.sketches.name_numbers import Words
from hearth.models.sketches.next_steps import Habits
from hearth.models.sketches.node_features import Places, node_choice
from hearth.models.sketches.sketch_examples import Grounded
from hearth.models.sketches.sketch_progress import Progress
from hearth.models.sketches.step_features import Offer
from hearth.models.sketches.text_features import NO_CLUES, Clues
from hearth.schemas.failures import Failure
from hearth.schemas.rng import rng
from hearth.simulation.engine import act


def node_choices(examples: Iterable[Grounded], words: Words) -> Iterator[Choice]:
    """Yield the choice of a node for each object of each sketch with several candidates, the right one among them."""
    for each in examples:
        places = Places(each.world, each.sketch, words)
        index = each.world.home.index
        nodes = {ref.key: index[ref.node] for step in each.sketch for ref in step.objects if ref.node is not None}
        bound: dict[tuple[str, int], int] = {}
        for use in places.objects:
            if len(places.candidates[use.key]) > 1:
                choice = node_choice(places, use, bound, nodes[use.key])
                if choice.right >= 0:
                    yield choice
            bound[use.key] = nodes[use.key]


def step_choices(
    examples: Iterable[Grounded], habits: Habits, words: Words, *, text: bool = False, most: int = 24
) -> Iterator[Choice]:
    """Yield the choice of each step of each program, and of its end; those that are not offered are left out.

    Args:
        examples: programs with their sketches.
        habits: the steps of programs that their sketches leave out.
        words: numbers of names.
        text: whether the title and the description are looked at.
        most: candidates of a choice, the right one and random others.
    """
    for each in examples:
        grammar = Grammar(each.world.home, each.rules)
        clues = Clues.of(each.request, each.world.home.knowledge) if text else NO_CLUES
        random = rng(0, "offered steps", each.id)
        progress = Progress.start(each.sketch, each.world, each.rules, clues)
        for step in (*each.steps, None):
            offer = Offer(progress, grammar.options(progress.world), habits, words)
            if (choice := offer.known_choice(step, most, random)) is not None:
                yield choice
            if step is None:
                break
            after = act(progress.world, step, each.rules)
            if isinstance(after, Failure):
                break
            progress = progress.after(step, after)
