"""Baselines of the thesis on a dataset's own splits (4.3, 5.6.2; tables 4.4, 4.5 and 5.2), and yardsticks of ours."""

from collections.abc import Callable, Sequence
from random import Random
from typing import Any, NamedTuple

from hearth.datasets.dataset import Dataset
from hearth.datasets.format.case_rows import start_of
from hearth.datasets.format.row_conversion import program_of
from hearth.datasets.format.sketch_choice import ANNOTATED, sketches_query
from hearth.datasets.format.stored_cases import StoredCaseRow, stored_cases
from hearth.datasets.verify import opened
from hearth.grounding.binding import nearest
from hearth.kb.knowledge import Knowledge
from hearth.kb.knowledge_records import Action
from hearth.repair.sketch_plan import planned_program
from hearth.schemas.literals import Literal
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.schemas.rng import rng
from hearth.schemas.row_types import DifferenceRow
from hearth.scoring.dataset_scores import score_steps
from hearth.scoring.evaluate import summarise
from hearth.scoring.metrics.lcs import matrix
from hearth.scoring.prediction_scores import METRICS, Scored
from hearth.simulation.actions.legal import legal
from hearth.simulation.engine import act
from hearth.simulation.rules import RULES, Rules
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

Steps = tuple[Step, ...]


class Example(NamedTuple):
    """A program with its description, its sketch, the difference of its start from the home, and its execution."""

    execution_id: str
    text: str
    steps: Steps
    sketch: Steps = ()
    start: frozenset[Literal[str]] = frozenset()
    case: StoredCaseRow | None = None


Starting = Callable[[Sequence[Example], Example, World, Rules, Random], Steps]
"""A baseline that sees the start of one test example."""


class Result(NamedTuple):
    """A baseline's mean scores, as in `METRICS`: of programs, of final graphs, of goals, of running. None if the thesis
    has no figure. The source is `here` for a score on this dataset, `thesis` for one that the thesis prints.
    """

    baseline: str
    action: float | None
    object: float | None
    step: float | None
    mean: float | None
    step_instances: float | None = None
    f1_relation: float | None = None
    f1_state: float | None = None
    f1: float | None = None
    goal: float | None = None
    goal_fraction: float | None = None
    executable: float | None = None
    parsable: float | None = None
    goal_whole: float | None = None
    source: str = "thesis"


SCORES = tuple(name for name in Result._fields if name not in ("baseline", "source"))
"""The scores of a baseline."""

THESIS_NOTE = "Rows of source `thesis` are figures that the thesis prints, of its own data; not measured here."

THESIS = (
    Result("Random sampling, table 4.4", 0.226, 0.039, 0.020, 0.095, executable=0.006),
    Result("Random retrieval, table 4.4", 0.473, 0.079, 0.071, 0.207, executable=1.0),
    Result("Skip-thoughts retrieval, table 4.4", 0.642, 0.272, 0.252, 0.389, executable=1.0),
    Result("MLE, table 4.4", 0.777, 0.723, 0.686, 0.729, executable=0.386),
    Result("PG(LCS), table 4.4", 0.803, 0.766, 0.732, 0.767, executable=0.355),
    Result("PG(LCS+Sim), table 4.4", 0.806, 0.775, 0.740, 0.774, executable=0.398),
    Result("Random sampling, table 4.5", 0.106, 0.018, 0.004, 0.043),
    Result("Random retrieval, table 4.5", 0.320, 0.037, 0.032, 0.130),
    Result("Skip-thoughts retrieval, table 4.5", 0.469, 0.297, 0.266, 0.344),
    Result("MLE, table 4.5", 0.497, 0.392, 0.340, 0.410),
    Result("PG(LCS), table 4.5", 0.522, 0.433, 0.387, 0.447),
    Result("Nearest neighbours, table 5.2", None, None, None, None, 0.127, 0.019, 0.288, 0.041),
    *(
        Result(name, None, None, None, None, lcs, *f1, None, None, *runs)
        for name, lcs, f1, runs in (
            ("Unaries, table 5.2", 0.372, (0.162, 0.142, 0.159), (0.248, 0.753)),
            ("Graph, table 5.2", 0.404, (0.171, 0.171, 0.172), (0.231, 0.822)),
            ("FCActGraph, table 5.2", 0.469, (0.261, 0.273, 0.263), (0.337, 0.886)),
            ("GRUActGraph, table 5.2", 0.508, (0.410, 0.408, 0.411), (0.489, 0.879)),
            ("ResActGraph, table 5.2", 0.516, (0.410, 0.420, 0.413), (0.493, 0.853)),
            ("Unaries (K=0), table 5.3", 0.372, (0.160, 0.142, 0.592), (None, None)),
            ("ResActGraph (K=1), table 5.3", 0.427, (0.262, 0.271, 0.264), (None, None)),
            ("ResActGraph (K=2), table 5.3", 0.516, (0.410, 0.420, 0.413), (None, None)),
            ("ResActGraph (K=3), table 5.3", 0.513, (0.399, 0.407, 0.401), (None, None)),
            ("Unaries, table 5.4", 0.289, (0.188, 0.191, 0.189), (0.444, 0.734)),
            ("Graph, table 5.4", 0.297, (0.241, 0.233, 0.241), (0.439, 0.899)),
            ("ResActGraph, table 5.4", 0.331, (0.347, 0.339, 0.348), (0.633, 0.925)),
            ("Unaries, table 5.5", 0.257, (0.099, 0.090, 0.098), (0.256, 0.740)),
            ("Graph, table 5.5", 0.284, (0.202, 0.202, 0.203), (0.343, 0.828)),
            ("ResActGraph, table 5.5", 0.327, (0.316, 0.323, 0.318), (0.547, 0.860)),
        )
    ),
)
"""The thesis's figures: 4.4 on synthetic programs, 4.5 on people's, 5.2 to 5.5 on augmented ones. Retrieval in
4.4 is always executable, because programs run without a given home; here they run in the test's home. In chapter 5 the
LCS compares nodes. The F1 of .592 in 5.3 is as printed; of the same model 5.2 has .159."""

MOST = 1_000
"""Greatest number of test executions for baselines over sketches; of more, a sample spread over all of them."""


def baselines(dataset: Dataset, split: str = "activities", seed: int = 0) -> list[Result]:
    """Return every baseline on a split: trained on `train`, tested on all test parts.

    Baselines over descriptions use original programs, whose descriptions people wrote; those over sketches and starts
    use every execution. A baseline without train or test programs has no row.
    """
    found = []
    for makers, starting, originals in ((BASELINES, {}, True), (BY_SKETCH, BY_START, False)):
        train, test = (examples(dataset, split, part, originals) for part in ("train", "test"))
        test = test[:: max(1, -(-len(test) // MOST))]
        if train and test:
            predicted = [make(train, test, seed, dataset.knowledge) for make in makers.values()]
            predicted += [[_planned(name, train, each, seed, dataset) for each in test] for name in starting]
            # Predictions for one execution are adjacent: it is then read once.
            pairs = ((each.execution_id, one) for each, *some in zip(test, *predicted, strict=True) for one in some)
            scored = score_steps(dataset, pairs)
            found += [_result(name, scored[place :: len(predicted)]) for place, name in enumerate((*makers, *starting))]
    return found


_EXAMPLES = """
    SELECT min(s.execution_id), any_value(k.keep)
    FROM splits s JOIN programs p USING (program_id) JOIN executions e USING (execution_id)
    LEFT JOIN ({sketches}) k ON k.program_id = p.program_id
    WHERE s.split = $split AND starts_with(s.part, $part) AND e.executable AND {where} GROUP BY {group}
"""


def examples(dataset: Dataset, split: str, part: str, originals: bool, sketches: str = ANNOTATED) -> list[Example]:
    """Return the examples of a part: each original program once, or each execution of a program with a sketch."""
    where = "p.parent_id IS NULL" if originals else "k.keep IS NOT NULL"
    query = _EXAMPLES.format(
        sketches=sketches_query(sketches), where=where, group="p.program_id" if originals else "s.execution_id"
    )
    keeps = dict(dataset.rows(query, split=split, part=part)[1])
    homes = opened(str(dataset.folder))[1]
    cases = stored_cases(dataset, list(keeps)) if keeps else ()
    found = (_example(case, keeps[case["execution_id"]] or (), homes.home(case["home"])) for case in cases)
    return sorted(found, key=lambda each: each.execution_id)


def _example(case: StoredCaseRow, keep: Sequence[bool], home: Home) -> Example:
    steps = program_of(case).steps
    kept = tuple(step for step, keeps in zip(steps, keep, strict=False) if keeps)
    text = f"{case['title']} {case['description']}"
    return Example(case["execution_id"], text, steps, kept, _start(case["environment"], home), case)


def _start(environment: DifferenceRow, home: Home) -> frozenset[Literal[str]]:
    """Return the difference of an environment from its home, as literals of classes."""
    added = {node["id"]: node["class_name"] for node in environment["added_nodes"]}

    def name(node: int) -> str:
        return added[node] if node in added else home.classes[home.index[node]]

    edges = [edge for edge in environment["added"] if edge["relation"] in ("ON", "INSIDE")]
    states = {Literal.of(each["state"], name(each["node"])) for each in environment["set_states"]}
    return frozenset(states | {Literal.of(e["relation"], name(e["source"]), name(e["target"])) for e in edges})


def _result(name: str, scored: Sequence[Scored]) -> Result:
    means = summarise(scored).means
    columns = (each if each in METRICS else f"lcs_{each}" for each in SCORES)
    values: dict[str, Any] = {
        each: means[of].mean if of in means else None for each, of in zip(SCORES, columns, strict=True)
    }
    return Result(name, source="here", **values)


def random_sampling(train: Sequence[Example], test: Sequence[Example], seed: int, knowledge: Knowledge) -> list[Steps]:
    """Programs of the length of a random training program, with random actions and objects."""
    actions = [action for action in knowledge.actions.values() if action.executed]
    names = sorted(knowledge.objects)
    return [_sampled(rng(seed, "random sampling", each.execution_id), train, actions, names) for each in test]


def _sampled(random: Random, train: Sequence[Example], actions: list[Action], names: list[str]) -> Steps:
    length = len(random.choice(train).steps)
    steps = []
    for _ in range(length):
        action = random.choice(actions)
        steps.append(Step(action.name, tuple(ObjectRef(random.choice(names)) for _ in range(action.arity))))
    return tuple(steps)


def random_retrieval(train: Sequence[Example], test: Sequence[Example], seed: int, _: Knowledge) -> list[Steps]:
    """Random training programs."""
    return [rng(seed, "random retrieval", each.execution_id).choice(train).steps for each in test]


def nearest_description(train: Sequence[Example], test: Sequence[Example], seed: int, _: Knowledge) -> list[Steps]:
    """Return the program with the most similar description, by the cosine of TF-IDF weights.

    Of equal ones the first is taken.
    """
    from sklearn.feature_extraction.text import TfidfVectorizer

    weights = TfidfVectorizer(token_pattern=WORD)
    known = weights.fit_transform([each.text for each in train])
    alike = (weights.transform([each.text for each in test]) @ known.T).toarray()
    # Sums of floats depend on the order of words: rounding makes them equal.
    return [train[int(place)].steps for place in alike.round(9).argmax(axis=1)]


WORD = r"(?u)[^\W_]{2,}"
"""A word of a description."""


def nearest_sketch(train: Sequence[Example], test: Sequence[Example], seed: int, _: Knowledge) -> list[Steps]:
    """Return the program with the most similar sketch by LCS; of equal ones, that with the most similar start (5.6.2).

    The similarity of starts is the Jaccard index of their differences from the homes, as literals of classes: states,
    and ON and INSIDE edges; of equal ones the first.
    """
    alike = matrix([each.sketch for each in test], [each.sketch for each in train])
    answers = []
    for each, row in zip(test, alike, strict=True):
        nearest = [train[int(place)] for place in (row >= row.max() - 1e-6).nonzero()[0]]
        shared = [_shared(each.start, other.start) for other in nearest]
        answers.append(nearest[shared.index(max(shared))].steps)
    return answers


def _shared(one: frozenset[Literal[str]], other: frozenset[Literal[str]]) -> float:
    return len(one & other) / len(one | other) if one or other else 1.0


def empty(train: Sequence[Example], example: Example, world: World, rules: Rules, random: Random) -> Steps:
    """Return the program without steps."""
    return ()


def random_legal(train: Sequence[Example], example: Example, world: World, rules: Rules, random: Random) -> Steps:
    """Return steps that the engine does not refuse, as many as a random training program has."""
    steps: list[Step] = []
    for _ in range(len(random.choice(train).steps)):
        could = legal(world, rules=rules)
        action = random.choice(sorted(could.masks))
        nodes = [random.choice(could.objects(action, place)) for place in range(len(could.masks[action]))]
        objects = tuple(ObjectRef(world.home.classes[world.home.index[node]], 1, node) for node in nodes)
        after = act(world, Step(action, objects), rules)
        if isinstance(after, World):
            steps.append(Step(action, objects))
            world = after
    return tuple(steps)


def sketch_alone(train: Sequence[Example], example: Example, world: World, rules: Rules, random: Random) -> Steps:
    """Return the sketch, its objects bound to the nearest nodes of their classes."""
    program = Program(steps=example.sketch)
    return nearest(program, world).apply(program).steps


def planner(train: Sequence[Example], example: Example, world: World, rules: Rules, random: Random) -> Steps:
    """Return the sketch so bound, and repaired: the result of planning without learning."""
    return planned_program(example.sketch, world, rules)


Maker = Callable[[Sequence[Example], Sequence[Example], int, Knowledge], list[Steps]]

BASELINES: dict[str, Maker] = {
    "random sampling": random_sampling,
    "random retrieval": random_retrieval,
    "nearest description": nearest_description,
}
"""Each predicts a program for every test example from its description. To add one: a function, a row here, a test."""

BY_SKETCH: dict[str, Maker] = {"nearest sketch": nearest_sketch}
"""Likewise from its sketch and its start's differences from the home."""

BY_START: dict[str, Starting] = {
    "empty program": empty,
    "random legal steps": random_legal,
    "sketch alone": sketch_alone,
    "planner": planner,
}
"""Likewise for one test example, in its environment at the start: yardsticks of ours."""


def _planned(baseline: str, train: Sequence[Example], example: Example, seed: int, dataset: Dataset) -> Steps:
    case = example.case
    assert case
    world = start_of(case["environment"], case["home"], opened(str(dataset.folder))[1])
    return BY_START[baseline](train, example, world, RULES[case["rules"]], rng(seed, baseline, example.execution_id))
