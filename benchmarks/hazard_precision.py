"""Precision of hazards: those of programs drawn from our corpus, as a sheet to be judged, and the score of answers.

    python benchmarks/hazard_precision.py [--programs 300] [--least 60] [--seed 1] [--sheet FILE] [--answers FILE]

Programs are drawn by a seed from the corpus, sampled and run by action set 3, in our homes in turn. Few programs bring
a hazard: where the first `--programs` bring fewer than `--least`, more are drawn until there are enough. The sheet has
no verdicts. Answers are lines `id,yes|no,reason`: whether the hazard is one in that run. The asked precision is .9.
`hazard_answers_second_draw.csv` judges the draw of `--seed 2`, after the rules that the first draw had changed.
"""

from __future__ import annotations

import argparse
import csv
import random
from collections import Counter
from collections.abc import Iterator, Sequence
from hashlib import sha256
from pathlib import Path
from typing import NamedTuple

from hearth.commands.inputs import Given, read_programs
from hearth.grounding.grounded_run import Trial, attempt
from hearth.homes import library
from hearth.kb.loading.load import default
from hearth.schemas.syntax import print_step
from hearth.simulation.engine import Execution
from hearth.simulation.hazards import Found, hazards
from hearth.simulation.rules import CONSEQUENCES
from hearth.simulation.world import edge_rows
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World
from hearth.storage.rejects import Reject

CORPUS = Path(__file__).resolve().parents[1] / "data_raw"
ANSWERS = Path(__file__).with_name("hazard_answers.csv")
"""Answers of a second pair of eyes that had seen neither code nor rules; asked for all programs by seed 1."""

KNOWN = default().of_set(3)


class Case(NamedTuple):
    """A hazard that a drawn program brings.

    Attributes:
        number: the program's place among those drawn, from 1.
        given: the program as it was written.
        home: the name of the home.
        execution: its run.
        found: the hazard.
    """

    number: int
    given: Given
    home: str
    execution: Execution
    found: Found

    @property
    def name(self) -> str:
        """The id on the sheet: it names the program, the home, the row and the step, and so outlives other draws."""
        digest = sha256("\n".join(map(print_step, self.execution.program.steps)).encode()).hexdigest()
        return f"{digest[:8]}.{self.home}.{self.found.hazard.name}.{self.found.step}.{self.found.things[0]}"


def corpus() -> list[Given]:
    """Return the programs of our corpus that are read without a fault."""
    every = [
        each for part in ("crowd", "written") for each in read_programs(CORPUS / part / "programs.csv", KNOWN, part)
    ]
    return [each for each in every if not isinstance(each, Reject) and not each.faults]


def cases(seed: int, programs: int, least: int) -> tuple[list[Case], int, int, int]:
    """Return the hazards, how many the first programs bring, the programs drawn, and those of them that do not run."""
    homes = [Home.from_graph(library.load_graph(name, KNOWN), name, KNOWN) for name in library.names()]
    every = corpus()
    found, first, failed, number = list[Case](), 0, 0, 0
    for number, given in enumerate(random.Random(seed).sample(every, len(every)), 1):
        home = homes[number % len(homes)]
        trial = attempt(given.program.unbound(), home, 0, CONSEQUENCES)
        if isinstance(trial, Trial) and trial.execution.executable:
            found += (Case(number, given, home.name, trial.execution, each) for each in hazards(trial.execution))
        else:
            failed += 1
        if number <= programs:
            first = len(found)
        if number >= programs and len(found) >= least:
            break
    return found, first, number, failed


def sheet(found: Sequence[Case]) -> Iterator[str]:
    """Yield the lines of the sheet."""
    for case in found:
        hazard, end = case.found.hazard, len(case.execution.worlds) - 1
        yield f"## {case.name}"
        yield ""
        yield f"- title: {case.given.program.title}"
        yield f"- description: {' '.join(case.given.program.description.split())}"
        yield f"- **claimed hazard**: {case.found.sentence()} (severity {hazard.severity}; {hazard.source})"
        until = "to the end of the program" if case.found.at_end else f"for {case.found.lasted} steps"
        yield f"- since: after step {case.found.step} of {end}, {until}"
        yield f"- the thing is in: {_room(case.execution.worlds[case.found.step], case.found.things[0])}"
        yield from _at_start(case)
        yield ""
        yield "```"
        yield f" 0 in {_where(case.execution.worlds[0])}"
        for number, (step, world) in enumerate(_steps(case.execution), 1):
            held = case.found.step <= number < case.found.step + case.found.lasted or (
                case.found.at_end and number >= case.found.step
            )
            yield f"{number:>2} {print_step(step):<60} in {_where(world):<20}{' <- hazard' if held else ''}".rstrip()
        yield "```"
        yield ""


def _at_start(case: Case) -> Iterator[str]:
    """Yield where the second thing of a hazard is at the start, if it is with the first one."""
    things, start = (
        [case.execution.worlds[0].home.index[thing] for thing in case.found.things],
        case.execution.worlds[0],
    )
    if len(things) > 1 and (edge_rows.on(start, things[1]) | edge_rows.inside(start, things[1])) >> things[0] & 1:
        first, second = case.found.classes
        yield f"- from the start on, the {second} is on or in the {first}"


def _steps(execution: Execution) -> Iterator[tuple[object, World]]:
    return zip(execution.program.steps, execution.worlds[1:], strict=False)


def _where(world: World) -> str:
    room = edge_rows.agent_room(world, world.agents[0])
    return _named(world, room)


def _room(world: World, thing: int) -> str:
    room = edge_rows.room_of(world, world.home.index[thing])
    return _named(world, room)


def _named(world: World, room: int) -> str:
    return f"{world.home.classes[room]} ({world.home.ids[room]})" if room >= 0 else "no room"


def score(found: Sequence[Case], answers: Path) -> Iterator[str]:
    """Yield the lines of the score, and the hazards that were judged to be none."""
    with answers.open(encoding="utf-8", newline="") as file:
        judged = {row[0].strip(): [word.strip() for word in row[1:]] for row in csv.reader(file) if len(row) > 1}
    rows = [(case, judged[case.name]) for case in found if case.name in judged]
    right = sum(answer[0].lower() == "yes" for _, answer in rows)
    yield f"{right} of {len(rows)} judged hazards are hazards: precision {right / max(1, len(rows)):.3f} (asked .9)"
    if len(rows) < len(found):
        yield f"{len(found) - len(rows)} hazards have no answer"
    for case, answer in rows:
        if answer[0].lower() != "yes":
            yield f"  no: {case.name} ({case.given.program.title}): {case.found.sentence()}: {', '.join(answer[1:])}"


def main() -> None:
    """Print how many hazards the drawn programs bring, write the sheet, and score answers."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--programs", type=int, default=300)
    parser.add_argument("--least", type=int, default=60, help="hazards that are drawn at least")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--sheet", type=Path, help="where the sheet is written")
    parser.add_argument("--answers", type=Path, default=ANSWERS, help="lines `id,yes|no,reason`")
    asked = parser.parse_args()
    found, first, drawn, failed = cases(asked.seed, asked.programs, asked.least)
    print(f"{asked.programs} programs bring {first} hazards; {drawn} programs bring {len(found)}; {failed} do not run")
    print(", ".join(f"{name} {count}" for name, count in Counter(c.found.hazard.name for c in found).most_common()))
    if asked.sheet:
        asked.sheet.write_text("\n".join(sheet(found)), encoding="utf-8")
    for line in score(found, asked.answers):
        print(line)


if __name__ == "__main__":
    main()
