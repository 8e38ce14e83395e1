"""What a build will take, told before its long stages begin: time, disk, and whether the disk has it.

Rough on purpose: from counts that are known once programs are validated and from what builds of the embedded corpus
took. Twice the time is no surprise, ten times is.
"""

from __future__ import annotations

import shutil
from dataclasses import dataclass
from pathlib import Path

from hearth.pipelines.engine.build_homes import Homes
from hearth.pipelines.engine.settings import Settings
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

BYTES = {"sampled": 1_200, "augmented": 1_500, "picture": 4_000_000}
"""On disk, of one execution in the sample or augment stage and once more published, and of one film."""

SECONDS = {"sampled": 0.004, "augmented": 0.006, "picture": 20.0}
"""Of one core, for the same."""

LONG = 60.0
"""Seconds from which a build is worth a word beforehand."""


@dataclass(frozen=True, slots=True)
class Estimate:
    """What the stages after validating will take.

    Attributes:
        executions: programs that will be run, augmented ones included.
        size: bytes on disk.
        seconds: with the workers asked for.
    """

    executions: int
    size: int
    seconds: float

    def __str__(self) -> str:
        minutes = max(1, round(self.seconds / 60))
        return f"about {self.executions:,} executions, {self.size / 1e6:,.0f} MB and {minutes} min"


def estimate(programs: int, settings: Settings, workers: int, homes: int) -> Estimate:
    """What is ahead of a build.

    Args:
        programs: that passed validation.
        settings: what was asked for.
        workers: processes.
        homes: how many there are to sample in.
    """
    each = min(settings.homes_each, homes) if settings.homes_each else homes
    sampled = programs * each
    augmented = sampled * settings.variants
    if settings.target:
        augmented = min(augmented, settings.target)
    number = {"sampled": sampled, "augmented": augmented, "picture": min(settings.pictures, sampled)}
    size = sum(2 * BYTES[kind] * count for kind, count in number.items())
    seconds = sum(SECONDS[kind] * count for kind, count in number.items()) / max(1, workers)
    return Estimate(sampled + augmented, size, seconds)


def foretold(programs: int, settings: Settings, workers: int, *, force: bool = False) -> str:
    """What to say before the long stages begin; "" for a build that is short.

    Raises:
        HearthError: UNWRITABLE, the disk has not room enough and nobody forces it.
    """
    ahead = estimate(programs, settings, workers, len(Homes(settings).names()))
    free = shutil.disk_usage(Path(settings.out)).free
    if ahead.size > free and not force:
        raise HearthError.of(
            Code.UNWRITABLE,
            f"this build needs about {ahead.size / 1e6:,.0f} MB, and {free / 1e6:,.0f} MB are free",
            file=settings.out,
            suggestion="free some space, choose another folder with --out, or build all the same with --force",
        )
    if ahead.seconds < LONG:
        return ""
    return f"{ahead}, with {workers} workers; {free / 1e9:,.0f} GB are free"
