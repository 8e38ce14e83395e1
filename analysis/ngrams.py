"""N-gram models of programs: how well the steps of one corpus are predicted by another."""

from collections import Counter, defaultdict
from collections.abc import Iterable, Sequence
from math import exp, log

Tokens = Sequence[str]

START, END = "<start>", "<end>"


class WittenBell:
    """Interpolated n-grams with Witten-Bell smoothing.

    A history seen c times with t different successors keeps c / (c + t) for them and gives the rest to the next shorter
    history; the shortest gives it to all steps of the vocabulary alike (Witten and Bell, 1991).

    Args:
        programs: to count.
        vocabulary: every step that may be asked about; the end of a program is added.
        order: length of the n-grams.
    """

    def __init__(self, programs: Iterable[Tokens], vocabulary: Iterable[str], order: int = 3) -> None:
        self.order = order
        self.size = len({*vocabulary, END})
        self.after: dict[Tokens, Counter[str]] = defaultdict(Counter)
        for program in programs:
            for history, token in self._positions(program):
                for start in range(len(history) + 1):
                    self.after[history[start:]][token] += 1

    def _positions(self, program: Tokens) -> Iterable[tuple[tuple[str, ...], str]]:
        padded = [START] * (self.order - 1) + [*program, END]
        for place in range(self.order - 1, len(padded)):
            yield tuple(padded[place - self.order + 1 : place]), padded[place]

    def probability(self, token: str, history: tuple[str, ...]) -> float:
        """Return the probability of a step of the vocabulary after the steps before it."""
        found = 1 / self.size
        for start in range(len(history), -1, -1):
            counts = self.after.get(history[start:])
            if counts is not None:
                found = (counts[token] + len(counts) * found) / (counts.total() + len(counts))
        return found

    def perplexity(self, programs: Iterable[Tokens]) -> float:
        """Return the perplexity of a step; ends of programs count as steps."""
        surprise = steps = 0.0
        for program in programs:
            for history, token in self._positions(program):
                surprise -= log(self.probability(token, history))
                steps += 1
        return exp(surprise / steps) if steps else float("nan")
