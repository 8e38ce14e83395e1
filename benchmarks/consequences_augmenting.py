"""Augmenting and sketches by action set 3 beside set 2: new programs that run again, and F1 of inferred sketches.

    python benchmarks/consequences_augmenting.py [--programs 150] [--sketches 111] [--touched 150]

Programs of our corpus are drawn and augmented in our homes in turn, by both strengths and sets. Each new program is
bound and run again in its environment. Then programs are drawn that take states of set 3 for granted (`--touched`). Of
each perturbation the pairs are counted that could not be repaired. The sketches are of people (HEARTH_REAL_DATA, else
../shared/real); the figure for them is left out where these are absent.
"""

from __future__ import annotations

import argparse
import random
from collections import Counter
from collections.abc import Sequence

from benchmark_cases import REAL, SAMPLE

from hearth.analysis.programs_in_homes import Script, scripts
from hearth.analysis.sketch_evaluation import annotated, evaluate_sketches
from hearth.grounding.environments.default_state import prepared
from hearth.grounding.preconditions.precondition_inference import infer
from hearth.grounding.preconditions.usual_states import usual_states
from hearth.homes import library
from hearth.kb.action_sets import LATEST
from hearth.kb.knowledge import Knowledge
from hearth.kb.loading.load import default
from hearth.pipelines.build import corpus
from hearth.repair.augmentation import Options, augment
from hearth.repair.perturbation import PERTURBATIONS, Case, Perturber
from hearth.schemas.failures import Code, Failure
from hearth.simulation.engine import run
from hearth.simulation.rules import CONSEQUENCES, DEFAULT, Rules
from hearth.simulation.world.home import Home
from hearth.storage.rejects import Reject

SETS = {2: DEFAULT, 3: CONSEQUENCES}


def homes_of(known: Knowledge, number: int = 7) -> list[Home]:
    """Return the first of our homes."""
    return [Home.from_graph(library.load_graph(name, known), name, known) for name in library.names()[:number]]


def of_set_3() -> dict[str, Perturber]:
    """Return the perturbations that only programs of action set 3 have."""
    names = {row.violated[0] for row in usual_states().values() if row.violated} | {"done"}
    return {name: perturber for name, perturber in PERTURBATIONS.items() if name in names}


def touched(programs: Sequence[Script], known: Knowledge, home: Home) -> list[Script]:
    """Return the programs of which a perturbation of set 3 violates a condition."""
    kinds, found = of_set_3(), []
    for script in programs:
        conditions = infer(script.program, known, CONSEQUENCES)
        if not isinstance(conditions, Failure):
            case = Case(script.program.numbered(), conditions, prepared(home))
            if any(True for each in kinds.values() for _ in each(case)):
                found.append(script)
    return found


def augmented(programs: Sequence[Script], known: Knowledge, rules: Rules, strength: str) -> str:
    """Return how many new programs there are, how many run again, and what is perturbed."""
    homes, options = homes_of(known), Options(strength=strength, rules=rules)
    outcomes, changed, lost = Counter[str](), Counter[str](), Counter[str]()
    new = again = 0
    for number, script in enumerate(programs):
        found = augment(script.program, homes[number % len(homes)], 0, script.program_id, options)
        for pair in () if isinstance(found, Failure) else found.pairs:
            outcomes["" if pair.failure is None else str(pair.failure.code)] += 1
            changed.update(each.kind for each in pair.perturbations)
            if pair.failure is not None and pair.failure.code not in (Code.DUPLICATE, Code.UNPERTURBED):
                lost.update(each.kind for each in pair.perturbations)
            if pair.failure is None:
                new += 1
                again += run(pair.environment.world, pair.program, rules).executable
    repaired = outcomes[""] + outcomes[str(Code.DUPLICATE)]
    share = 100 * repaired / max(1, outcomes.total())
    kinds = ", ".join(f"{kind} {count} (not repaired {lost[kind]})" for kind, count in changed.most_common())
    return f"{again} of {new} new programs run again; {share:.1f} % of pairs repaired; perturbed: {kinds}"


def main() -> None:
    """Print the figures."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--programs", type=int, default=150)
    parser.add_argument("--touched", type=int, default=150)
    parser.add_argument("--sketches", type=int, default=111)
    asked = parser.parse_args()
    for number, rules in SETS.items():
        known = default().of_set(number)
        every = [one for one in scripts(corpus(), known) if not isinstance(one, Reject)]
        drawn = random.Random(1).sample(every, min(asked.programs, len(every)))
        for strength in ("mild", "thesis"):
            print(f"set {number}, {strength}: {augmented(drawn, known, rules, strength)}", flush=True)
        affected = touched(every, known, homes_of(known, 1)[0]) if asked.touched and number == LATEST else []
        print(f"set {number}: {len(affected)} of {len(every)} programs take states of set 3 for granted", flush=True)
        for strength in ("mild", "thesis") if affected else ():
            some = random.Random(2).sample(affected, min(asked.touched, len(affected)))
            print(f"set {number}, {strength}, these: {augmented(some, known, rules, strength)}", flush=True)
        if asked.sketches and SAMPLE.exists():
            programs = [one for one in scripts([str(SAMPLE)], known) if not isinstance(one, Reject)]
            found = [one for one in annotated(REAL / "sketch_annotation.json", "s", programs, known) if one]
            summary = evaluate_sketches(found[: asked.sketches], homes_of(known, 3), known).summary()
            print(
                f"set {number}: sketches of {summary['programs']} programs, F1 {summary['inferred']['f1']}", flush=True
            )


if __name__ == "__main__":
    main()
