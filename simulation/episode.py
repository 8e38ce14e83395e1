"""Episodes that can be re-run, and checked by a digest of every tick."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from hashlib import blake2b

from hearth.schemas.agent_messages import Message
from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.failures import Code, Failure
from hearth.schemas.program import Step
from hearth.schemas.syntax import print_step
from hearth.simulation.engine import tick
from hearth.simulation.env import Env
from hearth.simulation.rules import Rules
from hearth.simulation.world.digest import digest
from hearth.simulation.world.world import World

Instructions = Mapping[int, Step]
"""Instructions of each agent in a tick, by number."""

Said = Mapping[int, Message]
"""Messages of each agent in a tick, by number."""


@dataclass(frozen=True, eq=False)
class Episode:
    """The events of an episode. Two episodes are equal if their digests are.

    Attributes:
        start: the world at its start.
        rules: how actions were read.
        ticks: what each agent tried.
        digests: of the start, then of each tick: of the digest before, what was tried, what failed, what was said, the
            world after.
        said: what agents said in each tick, by number.
    """

    start: World
    rules: Rules
    ticks: tuple[Instructions, ...]
    digests: tuple[str, ...]
    said: tuple[Said, ...]

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Episode) and self.digests == other.digests

    def __hash__(self) -> int:
        return hash(self.digests)

    @classmethod
    def of(cls, env: Env, said: Sequence[Said] = ()) -> Episode:
        """Return the episode of an environment up to now, with the agents' messages in each tick.

        Raises:
            HearthError: UNKNOWN_HOME before the first `reset`.
        """
        start = env.ticks[0].before if env.ticks else env.world
        digests = [digest(start)]
        spoken: tuple[Said, ...] = tuple(said) or ({},) * len(env.ticks)
        for each, words in zip(env.ticks, spoken, strict=True):
            digests.append(_following(digests[-1], each.instructions, each.failures, words, each.world))
        return cls(start, env.rules, tuple(each.instructions for each in env.ticks), tuple(digests), spoken)

    def again(self) -> Iterator[tuple[World, str]]:
        """Re-run the episode: yield the world and the digest at the start and after each tick."""
        world, last = self.start, digest(self.start)
        yield world, last
        for instructions, words in zip(self.ticks, self.said, strict=True):
            world, failures = tick(world, instructions, self.rules)
            last = _following(last, instructions, failures, words, world)
            yield world, last

    def verify(self) -> Diagnostic | None:
        """Return the first tick (from 1; 0 is the start) that is not as recorded; None if all are."""
        for number, ((_, found), recorded) in enumerate(zip(self.again(), self.digests, strict=True)):
            if found != recorded:
                message = f"tick {number} is not as recorded: its digest is {found}, and {recorded} was stored"
                return Diagnostic(Code.REPLAY_DIFFERS, message, line=number, found=found)
        return None


def _following(last: str, instructions: Instructions, failures: Mapping[int, Failure], said: Said, world: World) -> str:
    tried = ((number, print_step(step), str(failures[number].code) if number in failures else "")
             for number, step in sorted(instructions.items()))  # fmt: skip
    words = ((number, str(message)) for number, message in sorted(said.items()))
    return blake2b(repr((last, *tried, *words, digest(world))).encode(), digest_size=16).hexdigest()
