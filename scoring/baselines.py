"""Baselines of the thesis on a dataset's own splits (4.3, 5.6.2; tables 4.4, 4.5 and 5.2)."""

from collections.abc import Callable, Sequence
from random import Random
from typing import NamedTuple

from hearth.datasets.dataset import Dataset
from hearth.datasets.format.codecs import program_of
from hearth.kb.knowledge import Knowledge
from hearth.kb.records import Action
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.literals import Literal
from hearth.schemas.program import ObjectRef, Step
from hearth.schemas.rng import rng
from hearth.schemas.rows import Row
from hearth.scoring.dataset_scores import score_steps
from hearth.scoring.evaluate import Scored, summarise
from hearth.scoring.metrics.lcs import matrix

Steps = tuple[Step, ...]


class Example(NamedTuple):
    """A program with its description, its sketch, and the difference of its start from the home, as class literals."""

    execution_id: str
    text: str
    steps: Steps
    sketch: Steps = ()
    start: frozenset[Literal[str]] = frozenset()


class Result(NamedTuple):
    """A baseline's mean scores: LCS by action, object and step, and their mean; graph F1; executability; parsability.

    None if the thesis has no figure.
    """

    baseline: str
    action: float | None
    object: float | None
    step: float | None
    mean: float | None
    f1_relation: float | None = None
    f1_state: float | None = None
    f1: float | None = None
    executable: float | None = None
    parsable: float | None = None


THESIS = (
    Result("Random sampling, table 4.4", 0.226, 0.039, 0.020, 0.095, executable=0.006),
    Result("Random retrieval, table 4.4", 0.473, 0.079, 0.071, 0.207, executable=1.0),
    Result("Skip-thoughts retrieval, table 4.4", 0.642, 0.272, 0.252, 0.389, executable=1.0),
    Result("Random sampling, table 4.5", 0.106, 0.018, 0.004, 0.043),
    Result("Random retrieval, table 4.5", 0.320, 0.037, 0.032, 0.130),
    Result("Skip-thoughts retrieval, table 4.5", 0.469, 0.297, 0.266, 0.344),
    Result("Nearest neighbours, table 5.2", None, None, 0.127, None, 0.019, 0.288, 0.041),
    Result("Unaries, table 5.2", None, None, 0.372, None, 0.162, 0.142, 0.159, 0.248, 0.753),
    Result("ResActGraph, table 5.2", None, None, 0.516, None, 0.410, 0.420, 0.413, 0.493, 0.853),
)
"""The thesis's figures: 4.4 on synthetic programs, 4.5 on crowd-sourced ones, 5.2 on augmented ones. Retrieval in 4.4
is always executable, because programs run without a given home; here they run in the test's home."""

MOST = 1_000
"""Greatest number of test executions for baselines over sketches; of more, a sample spread over all of them."""


def baselines(dataset: Dataset, split: str = "activities", seed: int = 0) -> list[Result]:
    """Every baseline on a split: trained on `train`, tested on all test parts.

    Baselines over descriptions use original programs, whose descriptions people wrote; those over sketches use every
    execution. A baseline without train or test programs has no row.
    """
    found = []
    for makers, originals in ((BASELINES, True), (BY_SKETCH, False)):
        train, test = (_examples(dataset, split, part, originals) for part in ("train", "test"))
        test = test[:: max(1, -(-len(test) // MOST))]
        if train and test:
            predicted = [make(train, test, seed, dataset.knowledge) for make in makers.values()]
            # Predictions for one execution are adjacent: it is then read once.
            pairs = ((each.execution_id, one) for each, *some in zip(test, *predicted, strict=True) for one in some)
            scored = score_steps(dataset, pairs)
            found += [_result(name, scored[place :: len(makers)]) for place, name in enumerate(makers)]
    return found


_EXAMPLES = """
    SELECT min(s.execution_id) AS execution_id, any_value(p) AS program, any_value(k.keep) AS keep,
        arg_min(e.environment_id, s.execution_id) AS environment_id
    FROM splits s JOIN programs p USING (program_id) JOIN executions e USING (execution_id)
    LEFT JOIN (SELECT program_id, min(keep) AS keep FROM sketches WHERE keep IS NOT NULL GROUP BY 1) k
        ON k.program_id = p.program_id
    WHERE s.split = $split AND starts_with(s.part, $part) AND e.executable AND {where} GROUP BY {group} ORDER BY 1
"""

_STARTS = """
    WITH fact AS (
        SELECT environment_id, home, s.state AS name, s.node AS node, NULL AS other
        FROM (SELECT environment_id, home, unnest(set_states) AS s FROM environments)
        UNION ALL
        SELECT environment_id, home, d.relation, d.source, d.target
        FROM (SELECT environment_id, home, unnest(added) AS d FROM environments) WHERE d.relation IN ('ON', 'INSIDE')
    ),
    node AS (
        SELECT environment_id, n.id AS id, n.class_name AS class_name
        FROM (SELECT environment_id, unnest(added_nodes) AS n FROM environments)
    )
    SELECT fact.environment_id, list(DISTINCT [name, coalesce(a.class_name, b.class_name),
                                             coalesce(c.class_name, d.class_name)]) AS literals
    FROM fact
    LEFT JOIN node a ON a.environment_id = fact.environment_id AND a.id = fact.node
    LEFT JOIN home_nodes b ON b.home = fact.home AND b.id = fact.node
    LEFT JOIN node c ON c.environment_id = fact.environment_id AND c.id = fact.other
    LEFT JOIN home_nodes d ON d.home = fact.home AND d.id = fact.other
    GROUP BY fact.environment_id
"""


def _examples(dataset: Dataset, split: str, part: str, originals: bool) -> list[Example]:
    where = "p.parent_id IS NULL" if originals else "k.keep IS NOT NULL"
    query = _EXAMPLES.format(where=where, group="p.program_id" if originals else "s.execution_id")
    rows = dataset.sql(query, split=split, part=part).to_arrow_table().to_pylist()
    starts = {} if originals else {name: frozenset(map(_literal, found)) for name, found in dataset.rows(_STARTS)[1]}
    return [_example(row, starts.get(row["environment_id"], frozenset())) for row in rows]


def _literal(names: Sequence[str | None]) -> Literal[str]:
    name, *terms = (each for each in names if each)
    return Literal(name, tuple(terms))


def _example(row: Row, start: frozenset[Literal[str]]) -> Example:
    program = row["program"]
    steps = program_of(program).steps
    kept = tuple(step for step, keep in zip(steps, row["keep"] or (), strict=False) if keep)
    return Example(row["execution_id"], f"{program['title']} {program['description']}", steps, kept, start)


def _result(name: str, scored: Sequence[Scored]) -> Result:
    means = summarise(scored).means
    wanted = ("lcs_action", "lcs_object", "lcs_step", "lcs_mean", "f1_relation", "f1_state", "f1", "executable")
    return Result(name, *(means[each].mean if each in means else None for each in (*wanted, "parsable")))


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
    """The program with the most similar description, by the cosine of TF-IDF weights; of equal ones the first.

    Raises:
        HearthError: MISSING_FILE, if scikit-learn is not installed.
    """
    try:
        from sklearn.feature_extraction.text import TfidfVectorizer
    except ImportError as error:
        remedy = "pip install scikit-learn"
        raise HearthError.of(Code.MISSING_FILE, f"no TF-IDF here: {error}", suggestion=remedy) from None
    weights = TfidfVectorizer(token_pattern=WORD)
    known = weights.fit_transform([each.text for each in train])
    alike = (weights.transform([each.text for each in test]) @ known.T).toarray()
    # Sums of floats depend on the order of words: rounding makes them equal.
    return [train[int(place)].steps for place in alike.round(9).argmax(axis=1)]


WORD = r"(?u)[^\W_]{2,}"
"""A word of a description."""


def nearest_sketch(train: Sequence[Example], test: Sequence[Example], seed: int, _: Knowledge) -> list[Steps]:
    """The program with the most similar sketch by LCS; of equal ones, that with the most similar start (5.6.2).

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


Maker = Callable[[Sequence[Example], Sequence[Example], int, Knowledge], list[Steps]]

BASELINES: dict[str, Maker] = {
    "random sampling": random_sampling,
    "random retrieval": random_retrieval,
    "nearest description": nearest_description,
}
"""Each predicts a program for every test example from its description. To add one: a function, a row here, a test."""

BY_SKETCH: dict[str, Maker] = {"nearest sketch": nearest_sketch}
"""Likewise from its sketch and its start."""
