"""Order of the numbers of steps: the text keeps its order, and a warning says where the numbers have another."""

from hearth.kb.language.plan_lines import PlanLine

IN_ORDER = "number the steps in the order in which they are done"
"""The remedy of numbers in another order."""


class NumberOrder:
    """The last number at each indent of a list."""

    def __init__(self) -> None:
        self._last: dict[int, int] = {}
        self._begun = False

    def fault_of(self, line: PlanLine) -> str:
        """Return what the number of a line does not fit; empty where it follows the one above at its indent."""
        number, before = line.number or 0, self._last.get(line.indent)
        is_first, self._begun = not self._begun, True
        self._last = {indent: last for indent, last in self._last.items() if indent < line.indent}
        self._last[line.indent] = number
        if is_first and number > 1:
            return f"the first step has the number {number}: steps before it may be missing"
        if before is not None and 1 < number < before:
            return f"step {number} stands below step {before}: the steps keep the order of the text"
        return ""
