"""Evaluation of inferred sketches against annotated ones: precision, recall and F1 over steps (thesis 5.5.1)."""

from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, NamedTuple

from hearth.analysis.programs_in_homes import Script
from hearth.kb.knowledge import Knowledge
from hearth.pipelines.readers import sketches as reader
from hearth.repair.sketch import Keep, sketch
from hearth.repair.sketch_model import SketchModel, learned_sketch
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.program import Program
from hearth.schemas.stage_rows import IngestedRow
from hearth.schemas.syntax import print_step
from hearth.simulation.world.home import Home
from hearth.storage.archives import Place
from hearth.storage.rejects import Reject

THESIS_LENGTH = 2.4
"""Mean number of steps of a sketch (thesis 5.6.3)."""


class Annotated(NamedTuple):
    """A program, and the steps that an annotator kept."""

    script: Script
    answer: Keep


@dataclass(slots=True)
class Counts:
    """Numbers of steps kept by both, by the inferred sketch only, and by the annotator only."""

    both: int = 0
    extra: int = 0
    missing: int = 0

    def add(self, keep: Sequence[bool], answer: Sequence[bool]) -> None:
        """Count one program's steps."""
        for mine, theirs in zip(keep, answer, strict=True):
            self.both += mine and theirs
            self.extra += mine and not theirs
            self.missing += theirs and not mine

    def scores(self) -> dict[str, float]:
        """Precision, recall and F1 over all steps; 1 if there are none."""
        kept, wanted = self.both + self.extra, self.both + self.missing
        f1 = 2 * self.both / (kept + wanted) if kept + wanted else 1.0
        precision = self.both / kept if kept else 1.0
        recall = self.both / wanted if wanted else 1.0
        return {"precision": round(precision, 4), "recall": round(recall, 4), "f1": round(f1, 4)}


@dataclass(slots=True)
class SketchEvaluation:
    """The evaluation of inferred sketches.

    Attributes:
        by_the_way: actions that the simple baseline always drops.
        unmatched: number of annotations without a program in the sources.
        rows: annotation and inferred sketch of each program.
    """

    by_the_way: frozenset[str]
    unmatched: int = 0
    rows: list[tuple[Annotated, Keep]] = field(default_factory=list)

    def summary(self) -> dict[str, Any]:
        """Scores of the inferred sketches and of both baselines, lengths, and disagreements by action."""
        usual = _usual(annotated for annotated, _ in self.rows)
        dropped = self.by_the_way
        keepers: dict[str, Callable[[Program], Keep]] = {
            "dropping_what_is_by_the_way": lambda program: tuple(s.action not in dropped for s in program.steps),
            "keeping_what_people_usually_keep": lambda program: tuple(s.action in usual for s in program.steps),
        }
        return {
            "programs": len(self.rows),
            "steps": sum(len(annotated.answer) for annotated, _ in self.rows),
            "unmatched": self.unmatched,
            "inferred": self._scores([keep for _, keep in self.rows]),
            **{name: self._scores([keep(a.script.program) for a, _ in self.rows]) for name, keep in keepers.items()},
            "average_length": {
                "inferred": _average(keep for _, keep in self.rows),
                "people": _average(annotated.answer for annotated, _ in self.rows),
                "thesis": THESIS_LENGTH,
            },
            "alike": sum(annotated.answer == keep for annotated, keep in self.rows),
            "disagreements_by_action": self._by_action(),
        }

    def _scores(self, keeps: Sequence[Keep]) -> dict[str, float]:
        counts = Counts()
        for (annotated, _), keep in zip(self.rows, keeps, strict=True):
            counts.add(keep, annotated.answer)
        return counts.scores()

    def _by_action(self) -> dict[str, dict[str, int]]:
        found: Counter[tuple[str, str]] = Counter()
        for annotated, keep in self.rows:
            for step, mine, theirs in zip(annotated.script.program.steps, keep, annotated.answer, strict=True):
                if mine != theirs:
                    found[step.action, "extra" if mine else "missing"] += 1
        ranked: dict[str, dict[str, int]] = {}
        for (action, kind), count in sorted(found.items(), key=lambda each: (-each[1], each[0])):
            ranked.setdefault(action, {})[kind] = count
        return ranked

    def disagreements(self) -> Iterator[dict[str, Any]]:
        """Yield the programs with different sketches; each step with those that keep it."""
        for annotated, keep in self.rows:
            if keep != annotated.answer:
                program = annotated.script.program
                yield {
                    "program_id": annotated.script.program_id,
                    "title": program.title,
                    "description": program.description,
                    "steps": [
                        {"step": print_step(step), "inferred": mine, "people": theirs}
                        for step, mine, theirs in zip(program.steps, keep, annotated.answer, strict=True)
                    ],
                }


def _usual(annotated: Iterable[Annotated]) -> frozenset[str]:
    """Actions that annotators keep more often than not: a baseline that knows the answers."""
    kept: Counter[str] = Counter()
    for one in annotated:
        for step, answer in zip(one.script.program.steps, one.answer, strict=True):
            kept[step.action] += 1 if answer else -1
    return frozenset(action for action, margin in kept.items() if margin > 0)


def _average(keeps: Iterable[Keep]) -> float | None:
    lengths = [sum(keep) for keep in keeps]
    return round(sum(lengths) / len(lengths), 2) if lengths else None


def annotated(place: Place, name: str, scripts: Iterable[Script], knowledge: Knowledge) -> Iterator[Annotated | None]:
    """Yield the annotations of a file with their programs; None for an annotation without a program.

    A program is identified by its id, else by title, length and kept steps if these are unique.

    Raises:
        HearthError: MISSING_FILE: it is not a file.
    """
    if isinstance(place, Path) and not place.is_file():
        raise HearthError.of(Code.MISSING_FILE, "no such file", file=str(place))
    by_id: dict[str, Script] = {}
    by_form: dict[tuple[str, int], list[Script]] = defaultdict(list)
    for script in scripts:
        by_id.setdefault(script.program_id, script)
        by_form[script.program.title.lower(), len(script.program.steps)].append(script)
    for item in reader.scan(place, name):
        row = reader.read(item) if item.reader == reader.NAME else None
        if row is None or isinstance(row, Reject):
            continue
        keep = tuple(row["keep"] or ())
        match = by_id.get(row["description_id"])
        if match is None or len(match.program.steps) != len(keep):
            alike = by_form.get((row["title"].lower(), len(keep)), [])
            said = _answered(row, knowledge)
            same = {one.program.steps: one for one in alike if _kept(one, keep) == said}
            match = next(iter(same.values())) if len(same) == 1 else None
        yield Annotated(_described(match, row), keep) if match else None


def _described(script: Script, row: IngestedRow) -> Script:
    """Return the script, with the annotation's description if it has none."""
    if script.program.description:
        return script
    return script._replace(program=replace(script.program, description=row["description"]))


def _kept(script: Script, keep: Keep) -> list[tuple[str, ...]]:
    steps = zip(script.program.steps, keep, strict=True)
    return [(step.action, *(ref.name for ref in step.objects)) for step, kept in steps if kept]


def _answered(row: IngestedRow, knowledge: Knowledge) -> list[tuple[str, ...]]:
    found = []
    for line in (row["text"] or "").splitlines():
        word, *names = line.split() or [""]
        action = knowledge.action(word)
        things = [knowledge.object_class(name) for name in names]
        names_found = (thing.name if thing else name for thing, name in zip(things, names, strict=True))
        found.append((action.name if action else word, *names_found))
    return found


def evaluate_sketches(
    found: Iterable[Annotated | None],
    homes: Sequence[Home],
    knowledge: Knowledge,
    seed: int = 0,
    model: SketchModel | None = None,
) -> SketchEvaluation:
    """Infer the sketch of every annotated program, by repairs or by a learned model, and compare."""
    dropped = knowledge.group("unsaid") | knowledge.group("takes") | knowledge.achieving("PLUGGED_IN")
    evaluation = SketchEvaluation(dropped)
    for one in found:
        if one is None:
            evaluation.unmatched += 1
            continue
        keep = sketch(one.script.program, homes, knowledge, seed, one.script.program_id)
        learned = learned_sketch(one.script.program, keep, knowledge, model) if model else keep
        evaluation.rows.append((one, learned))
    return evaluation
