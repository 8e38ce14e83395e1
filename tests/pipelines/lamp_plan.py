"""A plan of two steps for small files, and the programs and faults that a file gives."""

from __future__ import annotations

from hearth.commands import inputs
from hearth.kb.loading.load import default
from hearth.schemas.syntax import print_step
from hearth.storage.rejects import Reject

LAMP = ["Walk to lamp", "Switch on lamp"]
LINES = ["[Walk] <lamp> (1)", "[SwitchOn] <lamp> (1)"]
CUP = ["[Walk] <kitchen> (1)", "[Grab] <cup> (1)", "[PutBack] <cup> (1) <table> (1)", "[SwitchOn] <lamp> (1)"]


def read(path, columns=""):
    """Return the title, and line and step of each step, of a file's programs; code and line of each fault."""
    programs, faults = [], []
    for given in inputs.read_programs(path, default(), path.name, columns):
        if isinstance(given, Reject):
            faults += [(fault.code, fault.line) for fault in given.diagnostics]
            continue
        steps = zip(given.program.lines, map(print_step, given.program.steps), strict=True)
        programs.append((given.program.title, list(steps)))
        faults += [(fault.code, fault.line) for fault in given.faults]
    return programs, faults
