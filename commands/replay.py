"""`replay`: compares the engine with the end graphs stored in a release, or with the digests of episodes."""

from __future__ import annotations

from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any
from zipfile import is_zipfile

from hearth.commands import output
from hearth.commands.failure_output import failure_document
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

if TYPE_CHECKING:
    from hearth.analysis.release_replay import Replayed


def replay(
    release: Path,
    limit: int | None = None,
    default_rules: bool = False,
    strict: bool = False,
    as_json: bool = False,
) -> None:
    """Run a release's programs on their stored start graphs and compare with the stored end graphs; or episodes.

    Prints the number of executed programs and of end graphs reproduced exactly, in every state and relation, and the
    edges of each mismatch. The release is read in place, one program at a time.

    Episodes are replayed and compared tick by tick, with the recorded state of the home, poses and failures; the status
    is 1 if one differs.

    \b
    Examples:
      hearth replay activityprograms.zip
      hearth replay episode.jsonl
    """
    if release.name.endswith((".jsonl", ".jsonl.gz")):
        _episodes(release, limit, as_json)
        return
    if release.is_file() and not is_zipfile(release):
        message, remedy = "neither a release nor episodes", "give a release as a zip or a folder, or episodes as .jsonl"
        raise HearthError.of(Code.UNSUPPORTED_FILE, message, file=str(release), suggestion=remedy)
    import gc

    from hearth.analysis.release_replay import replay as run_all
    from hearth.commands.progress_line import bar, watched
    from hearth.kb.loading.load import default
    from hearth.simulation.rules import DEFAULT, REPLAY

    known = default()
    gc.freeze()  # Objects loaded by now stay, and a program's objects form no circles: looking through them takes time
    gc.set_threshold(20_000)  # and finds nothing.
    found = islice(run_all(release, known, DEFAULT if default_rules else REPLAY), limit)
    with bar("programs run") as seen:
        results = list(watched(found, seen, limit))
    summary = _summary(results)
    inexact = [one for one in results if not one.exact]
    if as_json:
        output.emit({**summary, "mismatches": [_json(one) for one in inexact]})
    else:
        output.figures(summary)
        for one in inexact:
            _explain(one)
    output.status(len(inexact), strict=strict)


def _episodes(path: Path, limit: int | None, as_json: bool) -> None:
    from hearth.kb.loading.load import default
    from hearth.simulation.episode_files import read

    found = [(len(each.ticks), each.verify()) for each in islice(read(path, default()), limit)]
    differing = [{"episode": number, "fault": fault} for number, (_, fault) in enumerate(found, 1) if fault]
    summary = {"episodes": len(found), "ticks": sum(ticks for ticks, _ in found), "differing": len(differing)}
    if as_json:
        output.emit({**summary, "differences": differing})
    else:
        output.figures(summary)
        output.report(fault for _, fault in found if fault is not None)
    output.status(len(differing), strict=True)


def _summary(results: list[Replayed]) -> dict[str, Any]:
    seconds = [sum(part) for part in zip(*(one.seconds for one in results), strict=True)] or [0.0, 0.0, 0.0]
    steps = sum(one.steps for one in results)
    return {
        "programs": len(results),
        "executed": sum(one.executed for one in results),
        "exact": sum(one.exact for one in results),
        "steps": steps,
        "seconds reading": round(seconds[0], 3),
        "seconds building worlds": round(seconds[1], 3),
        "seconds executing": round(seconds[2], 3),
        "steps a second executing": round(steps / seconds[2]) if seconds[2] else 0,
    }


def _json(one: Replayed) -> dict[str, Any]:
    return {
        "program_id": one.program_id,
        "home": one.home,
        "faults": one.faults,
        "failure": failure_document(one.failure, None, one.failure.tick + 1 if one.failure else 0),
        "difference": {
            "missing": one.difference.added,
            "surplus": one.difference.removed,
            "missing_states": one.difference.set_states,
            "surplus_states": one.difference.cleared_states,
        },
    }


def _explain(one: Replayed) -> None:
    from hearth.schemas.failure_words import sentence

    output.line(f"\n{one.program_id} in {one.home}:")
    for fault in one.faults:
        output.line(output.explain(fault))
    if one.failure is not None:
        output.line(f"  step {one.failure.tick + 1} failed: {sentence(one.failure)}")
    for sign, edges in (("missing", one.difference.added), ("surplus", one.difference.removed)):
        for edge in edges:
            output.line(f"  {sign}: {edge.source} {edge.relation} {edge.target}")
    for sign, states in (("missing", one.difference.set_states), ("surplus", one.difference.cleared_states)):
        for node_id, name in states:
            output.line(f"  {sign}: {node_id} {name}")
