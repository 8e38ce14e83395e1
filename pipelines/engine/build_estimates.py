"""Estimates the time and disk space of a build before its long stages begin, and checks the free disk space.

A rough estimate, from the number of valid programs and the costs of builds of the embedded corpus: right within a
factor of two or three.
"""

import shutil
from dataclasses import dataclass
from pathlib import Path

from hearth.pipelines.engine.build_homes import Homes
from hearth.pipelines.engine.settings import Settings
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

BYTES = {"sampled": 1_200, "augmented": 1_500, "picture": 4_000_000}
"""Bytes on disk: of one execution in the sample or augment stage, and the same again published; of one film."""

SECONDS = {"sampled": 0.004, "augmented": 0.006, "picture": 20.0}
"""Seconds of one core, for each of them."""

LONG = 60.0
"""Seconds from which an estimate is printed."""


@dataclass(frozen=True, slots=True)
class Estimate:
    """The estimated costs of the stages after `validate`.

    Attributes:
        executions: including those of augmented programs.
        size: bytes on disk.
        seconds: with the given workers.
    """

    executions: int
    size: int
    seconds: float

    def __str__(self) -> str:
        minutes = max(1, round(self.seconds / 60))
        return f"about {self.executions:,} executions, {self.size / 1e6:,.0f} MB and {minutes} min"


def estimate(programs: int, settings: Settings, workers: int, homes: int) -> Estimate:
    """Return the costs of a build.

    Args:
        programs: the number of valid programs.
        settings: the options of the build.
        workers: processes.
        homes: the number of homes to sample in.
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


def forecast(programs: int, settings: Settings, workers: int, *, force: bool = False) -> str:
    """Return the estimate as text; "" for a short build.

    Raises:
        HearthError: UNWRITABLE, the disk is too small and `force` is False.
    """
    ahead = estimate(programs, settings, workers, len(Homes(settings).names()))
    free = shutil.disk_usage(Path(settings.out)).free
    if ahead.size > free and not force:
        raise HearthError.of(
            Code.UNWRITABLE,
            f"this build needs about {ahead.size / 1e6:,.0f} MB, and {free / 1e6:,.0f} MB are free",
            file=settings.out,
            suggestion="free some space, choose another folder with --out, or build anyway with --force",
        )
    if ahead.seconds < LONG:
        return ""
    return f"{ahead}, with {workers} workers; {free / 1e9:,.0f} GB are free"
