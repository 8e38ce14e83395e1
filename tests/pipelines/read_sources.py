"""Records of sources as readers give them, and small sources: a program, batches of answers, a zip of a folder."""

from __future__ import annotations

import zipfile

from hearth.pipelines.engine.source_labels import labelled
from hearth.pipelines.ingest import READERS, items
from hearth.storage.rejects import Reject

HEADER = "HITId,WorkerId,AssignmentStatus,Input.scene,Answer.title,Answer.description"
PROGRAM = "Watch TV\nFrom the sofa.\n\n[Walk] <television> (1)\n[SwitchOn] <television> (1)\n"


def read(*paths):
    """Everything that sources give: rows, and rejects, in order."""
    found = []
    for _, item in items(labelled(map(str, paths))):
        outputs = READERS[item.reader](item, "salt")
        outputs = [outputs] if isinstance(outputs, dict | Reject) else list(outputs)
        found.extend((item.record_id, output) for output in outputs)
    return found


def rows(found):
    """The rows of what was found."""
    return [output for _, output in found if isinstance(output, dict)]


def faults(found):
    """Code, file and line of each reject."""
    return [
        (output.code, output.diagnostics[0].file, output.diagnostics[0].line)
        for _, output in found
        if isinstance(output, Reject)
    ]


def batch(*lines, header=HEADER):
    """A batch of answers as CSV."""
    return "\n".join([header, *lines]) + "\n"


def answer(number, title="Sleep", description="Go to bed.", worker="W1", status="Approved"):
    """A line of a batch: one description."""
    return f"D{number},{worker},{status},bedroom,{title},{description}"


def zipped(folder, path):
    """A zip of a folder's files."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for file in sorted(folder.rglob("*")):
            if file.is_file():
                archive.write(file, file.relative_to(folder).as_posix())
    return path
