"""The share of drawn programs that their descriptions say: the score of an ideal reader.

Half of a program's parts go unsaid, as in the thesis's corpora (3.3; table 4.1 has 3.4 sentences for 9.6 steps). A
model can only guess those parts. The score to compare models with is therefore that of a reader who understands every
clause, and knows how often each part is in a program.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import groupby
from typing import NamedTuple

from hearth.analysis.synthesis import ChosenPart, Grammar, Part, Synthetic, joined
from hearth.analysis.synthesis_splits import SplitText
from hearth.schemas.program import Step
from hearth.schemas.syntax import parse_program
from hearth.scoring.metrics.lcs import score_pairs

LIKELY = 0.4
"""A part that is not mentioned is guessed from this probability on."""


class Reading(NamedTuple):
    """A program, and which of its descriptions is read."""

    program: Synthetic
    description: int


def ideal(asked: Reading, grammar: Grammar) -> Synthetic:
    """Return the program that an ideal reader of a description writes.

    Mentioned parts are understood, and the objects that their clauses name; the title gives the first task. Other parts
    of these tasks are written if they are likely, with the likeliest objects. Tasks that are not mentioned are left
    out.
    """
    steps = [step for step, _ in groupby(joined(_parts(asked, grammar), grammar.known))]
    return replace(asked.program, steps=tuple(steps))


def _parts(asked: Reading, grammar: Grammar) -> Iterator[ChosenPart]:
    mentioned = asked.program.mentioned[asked.description]
    for name in asked.program.tasks:
        own = [each for each in mentioned if each.task == name]
        if not own and name != asked.program.tasks[0]:
            continue
        task = grammar.tasks[name]
        chosen = {slot: weighted.likeliest for slot, weighted in task.slots.items()}
        for each in own:
            chosen |= each.chosen
        said = {id(each.part) for each in own}
        yield from (ChosenPart(name, part, chosen) for part in task.parts if id(part) in said or unsaid(part) >= LIKELY)


def unsaid(part: Part) -> float:
    """Return the probability that a program has a part which its description does not mention (Bayes)."""
    silent = part.chance * (1 - part.described)
    return silent / (silent + 1 - part.chance) if silent else 0.0


def mean_lcs(asked: Sequence[Reading], grammar: Grammar) -> float:
    """Return the mean LCS (of steps, actions and objects) of ideal readers' programs with the true ones; 0 for none."""
    pairs = ((_steps(ideal(each, grammar)), _steps(each.program)) for each in asked)
    scores = score_pairs(pairs)
    return sum(score.mean for score in scores) / len(scores) if scores else 0.0


def figures(programs: Sequence[Synthetic], rows: Sequence[SplitText], grammar: Grammar) -> dict[str, float]:
    """Return the mean LCS of ideal readers, to three digits.

    Of first descriptions in all, and in the test of each split.

    Args:
        programs: in the order of their numbers.
        rows: the parts of their descriptions in splits; see `synthesis_splits.splits`.
        grammar: that they were drawn from.
    """
    tests: dict[str, list[Reading]] = {"all": [Reading(each, 0) for each in programs]}
    for row in rows:
        if row.description == 0 and row.part == "test":
            tests.setdefault(row.split, []).append(Reading(programs[row.program - 1], 0))
    return {name: round(mean_lcs(asked, grammar), 3) for name, asked in tests.items()}


def _steps(program: Synthetic) -> tuple[Step, ...]:
    return parse_program("\n".join(program.lines()) + "\n")[0].steps
