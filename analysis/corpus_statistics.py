"""Statistics of a corpus, as in thesis 3.4 and table 4.1."""

import re
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from hearth.datasets.format.ids import activity_id
from hearth.datasets.format.row_conversion import steps_of
from hearth.kb.knowledge import Knowledge
from hearth.pipelines import validate
from hearth.pipelines.engine.source_labels import labelled
from hearth.pipelines.ingest import items, read
from hearth.schemas.failures import Code
from hearth.schemas.program import Step
from hearth.schemas.stage_rows import IngestedRow
from hearth.schemas.syntax import normal_name
from hearth.storage.rejects import Reject

THESIS_FUNNEL = {
    "descriptions": 1814,
    "with a program": 1703,
    "first programs": 1257,
    "more programs": 1564,
    "programs": 2821,
}
"""Thesis 3.4. First programs are one per description, without those with Special blocks."""

THESIS_VARIETY = {"activities": 576, "actions": 75, "objects": 308, "unique steps": 2709}

THESIS_AVERAGES = {"ActivityPrograms": (2821, 11.6, 3.2, 21.9), "SyntheticPrograms": (5193, 9.6, 3.4, 20.5)}
"""Table 4.1: programs, steps a program, sentences and words a description."""

THESIS_DIVERSITY = {
    "Make coffee": (69, 4.56, 0.26),
    "Fold laundry": (11, 1.29, 0.08),
    "Watch TV": (128, 3.65, 0.40),
    "Clean": (42, 0.76, 0.04),
}
"""Table 3.1: programs, mean LCS, mean normalised LCS."""

_SENTENCE = re.compile(r"[.!?…]+(?=\s|$|[\"')])")
_WORD = re.compile(r"[\w’']+")


@dataclass(slots=True)
class Written:
    """A valid program of a corpus."""

    program_id: str
    title: str
    description_id: str
    steps: tuple[Step, ...]


@dataclass(slots=True)
class Corpus:
    """Descriptions and programs of some sources, and counts of rejected records.

    Attributes:
        descriptions: text by id.
        programs: the valid programs.
        attempted: ids of descriptions with a program, valid or not.
        refused: number of rejected records by code.
        specials: free text of Special blocks without a replacement, with counts: candidates for new actions.
        warnings: number of warnings by code.
    """

    descriptions: dict[str, str] = field(default_factory=dict)
    programs: list[Written] = field(default_factory=list)
    attempted: set[str] = field(default_factory=set)
    refused: Counter[str] = field(default_factory=Counter)
    specials: Counter[str] = field(default_factory=Counter)
    warnings: Counter[str] = field(default_factory=Counter)


def gather(paths: Iterable[str], known: Knowledge) -> Corpus:
    """Read and check sources as `ingest` and `validate` do, without writing tables (thesis 3.4).

    Raises:
        HearthError: a source is missing or of unknown form.

    Examples:
        >>> from hearth.analysis.corpus_statistics import gather, variety
        >>> variety(gather(["milk.txt"], known))
        {'activities': 1, 'actions': 3, 'objects': 2, 'unique steps': 3}
    """
    corpus = Corpus()
    for _, item in items(labelled(paths)):
        for row in read(item):
            if isinstance(row, Reject):
                corpus.refused[row.code] += 1
            elif row["kind"] == "program":
                _take(corpus, row, known)
            elif row["kind"] == "description":
                corpus.descriptions[row["description_id"]] = row["description"]
    return corpus


def _take(corpus: Corpus, row: IngestedRow, known: Knowledge) -> None:
    described = row["description_id"]
    corpus.attempted.add(described)
    if row["description"]:
        corpus.descriptions.setdefault(described, row["description"])
    for valid in validate.process({**row, "groundings": None}, known):
        if isinstance(valid, Reject):
            corpus.refused[valid.code] += 1
            corpus.specials.update(_free_text(f.found) for f in valid.diagnostics if f.code is Code.SPECIAL_BLOCK)
        else:
            corpus.warnings.update({warning["code"] for warning in valid["warnings"]})
            written = Written(row["program_id"], valid["title"], described, steps_of(valid["steps"]))
            corpus.programs.append(written)


def _free_text(block: str) -> str:
    return " ".join(re.sub(r"\[[^\]]*\]|[<>]|\(\d+\)", " ", block).lower().split())


# Numbers


def funnel(corpus: Corpus) -> dict[str, int]:
    """Return numbers of descriptions and programs after each filter (thesis 3.4)."""
    first = len({written.description_id for written in corpus.programs})
    return {
        "descriptions": len(corpus.descriptions),
        "with a program": len(corpus.attempted),
        "first programs": first,
        "more programs": len(corpus.programs) - first,
        "programs": len(corpus.programs),
    }


def variety(corpus: Corpus) -> dict[str, int]:
    """Return numbers of different activities, actions, objects and steps, ignoring instances."""
    steps = [step for written in corpus.programs for step in written.steps]
    return {
        "activities": len({activity_id(written.title) for written in corpus.programs}),
        "actions": len({step.action for step in steps}),
        "objects": len({ref.name for step in steps for ref in step.objects}),
        "unique steps": len({(step.action, *(ref.name for ref in step.objects)) for step in steps}),
    }


def averages(corpus: Corpus) -> tuple[int, float, float, float]:
    """Return a row of table 4.1: programs, steps per program, sentences and words per description."""
    texts = [text for text in corpus.descriptions.values() if text.strip()]
    sentences = [max(1, len(_SENTENCE.findall(text))) for text in texts]
    words = [len(_WORD.findall(text)) for text in texts]
    steps = [len(written.steps) for written in corpus.programs]
    return (len(steps), *(round(sum(each) / max(1, len(each)), 2) for each in (steps, sentences, words)))  # type: ignore[return-value]


def frequencies(corpus: Corpus) -> tuple[Counter[str], Counter[str]]:
    """Frequencies of actions and objects in steps (figure 3-4)."""
    steps = [step for written in corpus.programs for step in written.steps]
    objects = Counter(ref.name for step in steps for ref in step.objects)
    return Counter(step.action for step in steps), objects


def together(corpus: Corpus) -> Counter[tuple[str, str]]:
    """Return numbers of programs that use both of two objects; rooms count as objects."""
    found: Counter[tuple[str, str]] = Counter()
    for written in corpus.programs:
        found.update(combinations(sorted({ref.name for step in written.steps for ref in step.objects}), 2))
    return found


@dataclass(frozen=True, slots=True)
class Activity:
    """Similarity of an activity's programs, over all pairs (table 3.1)."""

    activity: str
    title: str
    programs: int
    lcs: float
    normalised: float


@dataclass(slots=True)
class Similarities:
    """Similarity of programs within and between activities (thesis 3.4).

    Attributes:
        activities: with their diversity, the most frequent first.
        order: indices of the compared activities, clustered so that blocks show.
        matrix: mean similarity between their programs, in that order; shape (len(order), len(order)).
    """

    activities: list[Activity]
    order: list[int]
    matrix: NDArray[np.float32]


def similarities(corpus: Corpus, most: int = 60, workers: int = -1) -> Similarities:
    """Compare all pairs of programs, within activities and between the `most` most frequent ones."""
    from hearth.scoring.metrics.lcs import matrix

    programs = [written.steps for written in corpus.programs]
    pairs = matrix(programs, programs, workers=workers) if programs else np.zeros((0, 0), np.float32)
    lengths = np.array([len(steps) for steps in programs], dtype=np.float32)
    members = _members(corpus.programs)
    activities = [_compared(name, titles, rows, pairs, lengths) for name, titles, rows in members]
    chosen = members[:most]
    between = np.array([[_between(pairs, a, b) for *_, b in chosen] for *_, a in chosen], dtype=np.float32)
    order = _sorted(between)
    return Similarities(activities, order, between[np.ix_(order, order)] if order else between)


Members = list[tuple[str, Counter[str], list[int]]]


def _members(programs: Sequence[Written]) -> Members:
    rows: dict[str, list[int]] = defaultdict(list)
    titles: dict[str, Counter[str]] = defaultdict(Counter)
    for number, written in enumerate(programs):
        name = activity_id(written.title)
        rows[name].append(number)
        titles[name][written.title] += 1
    return sorted(((name, titles[name], rows[name]) for name in rows), key=lambda each: (-len(each[2]), each[0]))


def _compared(
    name: str, titles: Counter[str], rows: list[int], pairs: NDArray[np.float32], lengths: NDArray[np.float32]
) -> Activity:
    title = min(titles, key=lambda each: (-titles[each], each))
    if len(rows) < 2:
        return Activity(name, title, len(rows), float("nan"), float("nan"))
    upper = np.triu_indices(len(rows), 1)
    normalised = pairs[np.ix_(rows, rows)][upper]
    longest = np.maximum(lengths[rows][:, None], lengths[rows][None, :])[upper]
    return Activity(name, title, len(rows), float((normalised * longest).mean()), float(normalised.mean()))


def _between(pairs: NDArray[np.float32], one: list[int], other: list[int]) -> float:
    return float(pairs[np.ix_(one, other)].mean())


def _sorted(between: NDArray[np.float32]) -> list[int]:
    """Return an order with similar activities adjacent: leaves of a hierarchical clustering (figure 3-6)."""
    if len(between) < 3:
        return list(range(len(between)))
    from scipy.cluster.hierarchy import leaves_list, linkage
    from scipy.spatial.distance import squareform

    distance = 1 - (between + between.T) / 2
    np.fill_diagonal(distance, 0)
    tree = linkage(squareform(distance, checks=False), "average", optimal_ordering=True)
    return [int(leaf) for leaf in leaves_list(tree)]


def beside_thesis(activities: Sequence[Activity]) -> Iterator[tuple[str, tuple[int, float, float], Activity | None]]:
    """Yield the rows of table 3.1, each with our activity of the same name, if any."""
    ours = {normal_name(one.title): one for one in activities} | {one.activity: one for one in activities}
    for title, row in THESIS_DIVERSITY.items():
        yield title, row, ours.get(activity_id(title))
