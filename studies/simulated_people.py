"""Agents in people's places, and the ratings that they give, so that a whole study is tested before anyone is invited.

Nothing of it is a finding about people. A person is the human-like agent with faults whose rates differ from person to
person. Ratings come of a stated model: the result of a trial, the person's own bias, and chance; see `rated`.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from random import Random
from typing import Any

from hearth.agents.human_faults import Faults, Faulty
from hearth.schemas.rng import rng
from hearth.studies.study import Question

BIAS, NOISE = 0.5, 0.7
"""Standard deviations of a person's own bias and of chance, in steps of a scale."""

SECONDS_A_TICK = 3.0
"""Time of a simulated person for a decision, seconds."""


@dataclass(frozen=True, slots=True)
class SimulatedPerson:
    """An agent in a person's place; called, it makes the agent.

    Attributes:
        faults: rates of its faults.
        bias: added to its ratings.
    """

    faults: Faults
    bias: float

    def __call__(self) -> Faulty:
        """Return a new agent for an episode."""
        return Faulty(self.faults)


def simulated_person(seed: int, number: int) -> SimulatedPerson:
    """Return the person of a number; equal for equal seeds."""
    chooser = rng(seed, "simulated person", number)
    faults = Faults(
        rationality=round(chooser.uniform(0.5, 3.0), 4),
        forgetting=round(chooser.uniform(0.0, 0.01), 4),
        leaving_open=round(chooser.uniform(0.0, 0.5), 4),
        mistake=round(chooser.uniform(0.0, 0.05), 4),
        change_of_mind=round(chooser.uniform(0.0, 0.02), 4),
        detour=round(chooser.uniform(0.0, 0.02), 4),
    )
    return SimulatedPerson(faults, round(chooser.gauss(0.0, BIAS), 4))


@dataclass(frozen=True, slots=True)
class Impression:
    """The grounds of a simulated person's rating, each from 0 to 1; 0.5 is neither good nor bad.

    Attributes:
        knew: F1 of the helper's goal with the true one; 0.5 for a helper that is not given a goal.
        helpful: half the share of the human-like agent's ticks alone that were saved, above or below 0.5.
        looks: how good a film is: the shortest way's share of its length, or the normalised LCS of a program.
    """

    knew: float = 0.5
    helpful: float = 0.5
    looks: float = 0.5

    def of(self, question: str) -> float:
        """Return the ground of a question: for `trust`, the worse of knowledge and help."""
        about = {"knew": self.knew, "helpful": self.helpful, "trust": min(self.knew, self.helpful)}
        return about.get(question, self.looks)


def answers(person: SimulatedPerson, asked: tuple[Question, ...], seen: Impression, chooser: Random) -> dict[str, Any]:
    """Return the answers of a simulated person."""
    return {each.name: _answer(person, each, seen, chooser) for each in asked}


def _answer(person: SimulatedPerson, question: Question, seen: Impression, chooser: Random) -> Any:
    if question.kind == "scale":
        return rated(question, seen.of(question.name), person.bias, chooser)
    return chooser.choice(question.choices) if question.kind == "choice" else "a simulated answer"


def rated(question: Question, impression: float, bias: float, chooser: Random) -> int:
    """Return a rating: the impression on the question's scale, plus bias and chance, to the nearest number of the
    scale.
    """
    value = question.low + (question.high - question.low) * impression + bias + chooser.gauss(0.0, NOISE)
    return min(question.high, max(question.low, round(value)))


def likeness(lengths: Mapping[str, float], film: str) -> float:
    """Return how good a film looks among those of its task.

    The shortest length's share of its own, a little below perfect.
    """
    return 0.85 * min(lengths.values()) / max(lengths[film], 1.0)
