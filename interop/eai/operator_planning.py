"""Success of a planner with a model's operators: Fast Downward on the interface's problems."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterable, Iterator, Mapping
from functools import lru_cache
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

from hearth.interop.eai.operator_repair import names_in, read, repaired, with_constants
from hearth.interop.eai.transition_modelling import left_out, operators_of, parameters_of
from hearth.interop.eai.wheel import RESOURCES, Answer, Wheel
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.optional_libraries import remedy

SECONDS = 100
"""Time of the planner for a task, as the interface gives it."""

SEARCH = (
    "let(hlm, eval_modify_costs(landmark_sum(lm_factory=lm_reasonable_orders_hps(lm_rhw()),pref=false),cost_type=one),"
    "let(hff, eval_modify_costs(ff(),cost_type=one),"
    "lazy_greedy([hff,hlm],preferred=[hff,hlm],cost_type=one,reopen_closed=false)))"
)
"""The first search of LAMA, which the interface uses."""


class Outcome(NamedTuple):
    """A task planned with a model's operators.

    Attributes:
        task: its number.
        solved: whether a plan was found.
        why: the planner's last line where none was.
    """

    task: str
    solved: bool
    why: str = ""


class OperatorPlanning:
    """The problems of a wheel, and the planner.

    Args:
        wheel: of the interface.

    Raises:
        HearthError: MISSING_FILE: the wheel has no problems, or the planner is not installed.
    """

    def __init__(self, wheel: Wheel) -> None:
        self.wheel = wheel
        self.tasks = frozenset(wheel.json(f"{RESOURCES}success_task.json"))
        self.titles: Mapping[str, str] = wheel.json(f"{RESOURCES}id2task.json")
        self.gold: Mapping[str, Mapping[str, str]] = wheel.json(f"{RESOURCES}gold_action.json")
        self.domain = wheel.bytes_of(f"{RESOURCES}virtualhome_pd.pddl").decode()
        self.folder = planner_folder()

    def planned(self, answer: Answer) -> Outcome | None:
        """Return whether the planner solves a task with an answer's operators.

        Actions that the answer lacks are the gold ones. It is None for a task without a problem, and for an answer that
        the interface leaves out.
        """
        if answer.task not in self.tasks or left_out(answer.text):
            return None
        name = "_".join(self.titles[answer.task].split())
        problem = self.wheel.bytes_of(f"{RESOURCES}problem_pddl/{name}/{answer.task}.pddl").decode()
        why = _solved(self.folder, *self.posed(answer, problem))
        return Outcome(answer.task, not why, why)

    def posed(self, answer: Answer, problem: str) -> tuple[str, str]:
        """Return the domain with an answer's operators, and a problem for it."""
        given = parameters_of(answer.text)
        parts = {name: repaired(given[name], *each) for name, each in operators_of(answer.text).items()}
        parts |= {
            name: (row["action_parameters"], row["action_preconditions"], row["action_effects"])
            for name, row in sorted(self.gold.items()) if name not in parts
        }  # fmt: skip
        text = self.domain + "\n".join(_action(name, *each) for name, each in parts.items()) + ")"
        return with_constants(text, problem, _names(parts.values()))


def _names(parts: Iterable[tuple[str, str, str]]) -> Iterator[str]:
    for _, *formulas in parts:
        for text in formulas:
            try:
                yield from names_in(read(text))
            except ValueError:
                continue


def _action(name: str, parameters: str, precondition: str, effect: str) -> str:
    return f"(:action {name} :parameters {parameters} :precondition {precondition} :effect {effect})"


def planner_folder() -> Path:
    """Return the folder of Fast Downward's programs.

    Raises:
        HearthError: MISSING_FILE: it is not installed.
    """
    found = find_spec("up_fast_downward")
    if found is None or found.origin is None:
        raise HearthError.of(Code.MISSING_FILE, "this needs Fast Downward, which is not installed",
                             suggestion=remedy("plan"))  # fmt: skip
    return Path(found.origin).parent / "downward/builds/release/bin"


@lru_cache(maxsize=20_000)
def _solved(folder: Path, domain: str, problem: str) -> str:
    """Return an empty text where a plan is found, or else the planner's last line."""
    with TemporaryDirectory() as name:
        here = Path(name)
        (here / "domain.pddl").write_text(domain, "utf-8")
        (here / "problem.pddl").write_text(problem, "utf-8")
        translate = [sys.executable, "-S", "-m", "fast_downward.translate", "domain.pddl", "problem.pddl"]
        try:
            first = _ran(translate, here, {"PYTHONPATH": str(folder), "PYTHONHASHSEED": "0"})
            task = here / "output.sas"
            if first.returncode or not task.is_file():
                return _last_line(first.stdout + first.stderr)
            second = _ran([str(folder / "downward"), "--search", SEARCH], here, {}, task.read_text("utf-8"))
        except subprocess.TimeoutExpired:
            return f"no plan in {SECONDS} seconds"
    return "" if "Solution found!" in second.stdout else _last_line(second.stdout + second.stderr)


def _ran(
    command: list[str], folder: Path, environment: Mapping[str, str], text: str = ""
) -> subprocess.CompletedProcess[str]:
    return subprocess.run(command, cwd=folder, env=dict(environment), input=text, capture_output=True, text=True,
                          timeout=SECONDS, check=False, errors="replace")  # fmt: skip


def _last_line(text: str) -> str:
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    return lines[-1][:200] if lines else "no word of the planner"
