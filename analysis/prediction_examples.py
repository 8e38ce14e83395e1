"""A page of predictions next to people's programs, as figures 4-5, 4-6, 5-5, A-1, A-2 and A-4; with pictures, 4-8.

Examples are taken at equal steps of LCS from the worst to the best, each of another activity: nobody chose them.
"""

from base64 import b64encode
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

from hearth.datasets.dataset import Dataset
from hearth.datasets.format.case_rows import start_of
from hearth.datasets.format.sketch_choice import ANNOTATED
from hearth.datasets.format.stored_cases import stored_cases
from hearth.datasets.verify import opened
from hearth.models.interface import Request
from hearth.models.prediction_stages import Beside, side_by_side
from hearth.models.text_examples import requests
from hearth.schemas.program import Program, Step
from hearth.schemas.syntax import print_step
from hearth.scoring.line_sequences import steps_of
from hearth.scoring.prediction_scores import METRICS, Scored
from hearth.simulation.engine import Execution, run
from hearth.simulation.rules import RULES
from hearth.storage.templates import rendered

SHOWN = {
    "lcs_step": "LCS",
    "lcs_step_instances": "LCS, instances",
    "f1": "F1",
    "goal_fraction": "share of the goal",
}
"""The scores of an example, and the page's names for them."""

SIZE = (320, 240)
"""Size of a picture, pixels."""


class PredictionExample(NamedTuple):
    """A prediction that the page shows.

    Attributes:
        request: the model's request.
        home: in which.
        scores: those of `SHOWN`, as text.
        ran: the prediction, as it runs there.
        beside: the reference and the prediction, common steps opposite.
        pictures: of the run, each with its step.
    """

    request: Request
    home: str
    scores: dict[str, str]
    ran: Execution
    beside: list[Beside]
    pictures: list[tuple[str, bytes]]

    @property
    def steps(self) -> list[tuple[str, str, bool]]:
        """Return lines of the reference and of the prediction, and whether both have it."""
        return [(_text(line.left), _text(line.right), line.common) for line in self.beside]

    @property
    def sketch(self) -> list[str]:
        """Return the main steps that a model of sketches was given."""
        return [print_step(step) for step in self.request.sketch]

    @property
    def drawn(self) -> list[tuple[str, str]]:
        """Return the pictures as addresses of data."""
        return [(step, f"data:image/png;base64,{b64encode(data).decode()}") for step, data in self.pictures]


def _text(step: Step | None) -> str:
    return print_step(step) if step else ""


def spread_over(found: Sequence[Scored], count: int) -> list[Scored]:
    """Predictions at equal steps of LCS, each of another activity, the best first.

    Args:
        found: with the field `activity`.
        count: how many; one of each activity at most.
    """
    order = sorted((each for each in found if not each.missing), key=lambda each: (-each.lcs.step, each.pair.id))
    waiting, chosen = list(order), list[Scored]()
    activities = {each.pair.more["activity"] for each in order}
    wanted = min(count, len(activities))
    for number in range(wanted):
        aim = order[round(number * (len(order) - 1) / max(1, wanted - 1))].lcs.step
        best = min(waiting, key=lambda each: (abs(each.lcs.step - aim), each.pair.id))
        chosen.append(best)
        waiting = [each for each in waiting if each.pair.more["activity"] != best.pair.more["activity"]]
    return sorted(chosen, key=lambda each: (-each.lcs.step, each.pair.id))


def prediction_examples(
    dataset: Dataset, found: Sequence[Scored], count: int = 9, pictures: int = 4, sketches: str = ANNOTATED
) -> Iterator[PredictionExample]:
    """Yield the predictions that the page shows.

    Args:
        dataset: to which they belong.
        found: all, scored.
        count: how many are shown.
        pictures: of each; 0 for none.
        sketches: as the model was given them.
    """
    some = spread_over(found, count)
    names = sorted(each.pair.id for each in some)
    asked = {each.id: each for share in requests(dataset, names, worlds=False, sketches=sketches) for each in share}
    cases = {case["execution_id"]: case for case in stored_cases(dataset, names)}
    for each in some:
        yield _example(each, asked[each.pair.id], cases[each.pair.id], dataset, pictures)


def _example(each: Scored, asked: Request, case: Any, dataset: Dataset, pictures: int) -> PredictionExample:
    known, homes = opened(str(dataset.folder))
    steps = steps_of(each.pair.predicted or ())
    ran = run(start_of(case["environment"], case["home"], homes), Program(steps=steps), RULES[case["rules"]])
    values = {label: METRICS[name](each) for name, label in SHOWN.items()}
    return PredictionExample(
        asked,
        case["home"],
        {label: "none" if value is None else f"{value:.2f}" for label, value in values.items()},
        ran,
        list(side_by_side(steps_of(each.pair.reference), steps)),
        _pictures(ran, case["home"], known, pictures) if pictures and ran.executable and steps else [],
    )


def _pictures(ran: Execution, home: str, dataset: Dataset, count: int) -> list[tuple[str, bytes]]:
    """Pictures of steps at equal distances, the last one among them."""
    from hearth.analysis.step_gallery import picture_of
    from hearth.rendering.film.execution_keyframes import trajectory_of
    from hearth.rendering.film.png import encode
    from hearth.rendering.scene.home_geometry import with_geometry

    # Not the run's start graph: things that the environment moves would be drawn where the home has them.
    graph = with_geometry(dataset.home(home), home, dataset.knowledge).graph
    trajectory = trajectory_of(ran, graph, dataset.knowledge)
    ticks = list(ran.program.ticks())
    numbers = sorted({round((n + 1) * len(ticks) / count) for n in range(count)} - {0})
    return [
        (print_step(ticks[n - 1][0]), encode(picture_of(trajectory, trajectory.keyframes[n], graph, SIZE)[0]))
        for n in numbers
    ]


def examples_page(shown: Sequence[PredictionExample], title: str, count: int) -> str:
    """Return the page as HTML, which opens from disk; every text is escaped.

    Args:
        shown: in this order.
        title: of the page.
        count: how many predictions there are.
    """
    return rendered("hearth.analysis", "prediction_examples.html", shown=shown, title=title, count=count)
