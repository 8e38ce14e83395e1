"""python benchmarks/judged_instructions.py: household instructions as others judge them, and their requests.

`tests/golden/challenges/judged_tasks.txt` has the answers of a stranger about 200 instructions and their goals, drawn
by a seed over all splits and families. The other files have goals, and
what people said for them: counted is how many are read back as the goal, refused, and read as another goal.
"""

from __future__ import annotations

from collections import Counter
from pathlib import Path

from hearth.challenges.challenge_definition import challenge
from hearth.challenges.instruction_reader import read_instruction
from hearth.kb.knowledge import Knowledge
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError

FOLDER = Path(__file__).resolve().parents[1] / "tests" / "golden" / "challenges"
FILES = (
    "paraphrases.txt",
    "more_paraphrases.txt",
    "requests_of_another_author.txt",
    "requests_of_a_second_author.txt",
    "requests_of_a_third_author.txt",
    "requests_of_a_fourth_author.txt",
    "requests_of_a_fifth_author.txt",
)
OF_WAH = ("dinnertable", "coffeetable", "wineglass", "INSIDE(apple")


def rows(file: str) -> list[list[str]]:
    """Return the lines of a file, parted at ` | `."""
    lines = (FOLDER / file).read_text(encoding="utf-8").splitlines()
    return [line.split(" | ") for line in lines if not line.startswith("#")]


def outcome(goal: str, text: str, known: Knowledge) -> str:
    """Return `read`, `refused`, or `misread`."""
    names = challenge("wah").grammar.names if any(name in goal for name in OF_WAH) else frozenset()
    try:
        found = str(read_instruction(text, known, names=names))
    except HearthError:
        return "refused"
    return "read" if sorted(found.split(" and ")) == sorted(goal.split(" and ")) else "misread"


def main() -> None:
    """Print the figures."""
    answers = Counter(answer for _, answer, *_ in rows("judged_tasks.txt"))
    print(f"instructions that say the same as their goal: {answers['yes']} of {answers.total()}")
    known = default()
    for file in FILES:
        found = Counter(outcome(goal, text, known) for goal, text in rows(file))
        print(
            f"{file}: {found['read']} of {found.total()} read, {found['refused']} refused, {found['misread']} misread"
        )


if __name__ == "__main__":
    main()
