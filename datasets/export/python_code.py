"""`code`: programs as Python functions, a prompt format of planners."""

import keyword
import re
from collections.abc import Iterator
from pathlib import Path
from unicodedata import category

from hearth.datasets.dataset import Dataset
from hearth.datasets.export.program_batches import Wanted, programs, write
from hearth.datasets.format.row_conversion import program_of
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.schemas.published_rows import ProgramRow


def code(dataset: Dataset, to: Path, wanted: Wanted) -> int:
    """Two modules. `programs.py` has a function per program, a call per step, objects as `'cup_1'`.

    `actions.py`, which it imports, has a function per action that prints its call: others put their own in its place.

    Returns:
        Number of programs.
    """
    calls = {call_name(name) for (name,) in dataset.rows("SELECT DISTINCT action FROM steps")[1]}
    used = {*calls}  # a function of that name would hide the action, and call itself
    actions: set[str] = set()
    functions = []
    for row in programs(dataset, wanted):
        program = program_of(row)
        actions.update(call_name(step.action) for step in program.steps)
        functions.append("\n".join(_function(row, program, _unused(_identifier(row["title"]), used))))
    names = sorted(actions) or ["walk"]
    head = f'"""Programs of a household dataset: one function each."""\n\nfrom actions import {", ".join(names)}\n'
    write(to / "programs.py", "\n\n".join((head, *functions)).encode() + b"\n")
    write(to / "actions.py", "\n\n".join((_ACTIONS, *map(_action, names))).encode())
    return len(functions)


_ACTIONS = '''"""The actions that programs.py calls. Each prints its call; put what a robot does in its place."""

import builtins as PYTHON


def SHOW(name, objects, how):
    """Print a call as programs.py writes it."""
    given = [PYTHON.repr(each) for each in objects]
    given += [f"{key}={value!r}" for key, value in how.items()]
    PYTHON.print(f"{name}({', '.join(given)})")
'''
"""The beginning of `actions.py`; no action has a name in capitals, so that none hides these."""


def _action(name: str) -> str:
    return f'def {name}(*objects, **how):\n    SHOW("{name}", objects, how)\n'


def call_name(action: str) -> str:
    """Return `switch_on` for `SwitchOn`; Python's own words get an underscore, and any other text becomes a name."""
    name = re.sub(r"(?<=[a-z])(?=[A-Z])", "_", action).lower()
    if not (name.isascii() and name.isidentifier()):
        return _identifier(name)
    return f"{name}_" if keyword.iskeyword(name) else name


def _function(row: ProgramRow, program: Program, name: str) -> Iterator[str]:
    yield f"def {name}():"
    yield from _comment(row["program_id"])
    yield from _comment(f"{program.title}. {program.description}")
    for step in program.steps:
        yield f"    {_call(step)}"
    if not program.steps:
        yield "    pass"


def _comment(text: str) -> Iterator[str]:
    """Yield a comment, whose every line is one to Python too; characters that can't be seen are written as escapes."""
    for line in text.strip().splitlines():
        shown = "".join(ascii(char)[1:-1] if category(char) in _UNSEEN else char for char in line)
        yield f"    # {shown}".rstrip()


_UNSEEN = frozenset({"Cc", "Cf", "Cs"})
"""Control characters, marks that change in which direction text runs, halves of characters."""


def _call(step: Step) -> str:
    given = [repr(_object(ref)) for ref in step.objects]
    given += [f"agent={int(step.agent)}"] if step.agent else []  # a stranger's may be any text
    given += ["together=True"] if step.joins else []
    given += [f"{_identifier(name)}={value!r}" for name, value in step.modifiers]
    return f"{call_name(step.action)}({', '.join(given)})"


def _object(ref: ObjectRef) -> str:
    return f"{ref.name}_{ref.instance}"


def _identifier(text: str) -> str:
    name = "_".join(re.findall(r"[a-z0-9]+", text.lower())) or "untitled"
    return f"do_{name}" if name[0].isdigit() or keyword.iskeyword(name) else name


def _unused(name: str, used: set[str]) -> str:
    number, found = 1, name
    while found in used:
        number += 1
        found = f"{name}_{number}"
    used.add(found)
    return found
