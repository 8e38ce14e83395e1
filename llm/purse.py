"""The budget of a run: a request is made only if its reply, at its longest, can still be paid."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager

from hearth.llm.language_settings import Means
from hearth.llm.replies import Reply
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code


class Purse:
    """Money for replies; the tokens of each are the server's count.

    Args:
        means: with prices and the budget.
        spent: what earlier replies have cost.
    """

    def __init__(self, means: Means, spent: float = 0.0) -> None:
        self._means, self._spent, self._held = means, spent, 0.0
        self._lock = threading.Lock()

    @property
    def spent(self) -> float:
        """Return what replies have cost until now."""
        return self._spent

    @contextmanager
    def holding(self, tokens_in: int, tokens_out: int) -> Iterator[None]:
        """Keep the price of a reply aside while it is asked for.

        Raises:
            HearthError: OVER_BUDGET: it might cost more than is left.
        """
        price, budget = self._means.cost(tokens_in, tokens_out), self._means.budget
        with self._lock:
            if budget is not None and self._spent + self._held + price > budget:
                aside = f", {self._held:.4f} kept for replies under way" if self._held else ""
                spent = f"{self._spent:.4f} of the budget of {budget:g} are spent{aside}"
                message = f"{spent}, and a reply may cost {price:.4f}"
                remedy = "the same command with a greater --budget goes on; nothing is asked twice"
                raise HearthError.of(Code.OVER_BUDGET, message, suggestion=remedy)
            self._held += price
        try:
            yield
        finally:
            with self._lock:
                self._held -= price

    def pay(self, reply: Reply) -> None:
        """Count a reply."""
        with self._lock:
            self._spent += self._means.cost(reply.tokens_in, reply.tokens_out)
