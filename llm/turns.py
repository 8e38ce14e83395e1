"""Turns of a language model in an episode: its answers, their faults, and their cost."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from hashlib import blake2b
from typing import Any

from hearth.llm.replies import Reply, well_formed
from hearth.schemas.numbers import LARGEST

MOST_TURNS = 100_000
"""Turns of an episode, at most."""


@dataclass(frozen=True, slots=True)
class Turn:
    """One answer.

    Attributes:
        tick: when it was asked.
        answer: what the model wrote; of a longer text than the protocol reads, the beginning.
        fault: the code of the reason why it was not used; "" where it was.
    """

    tick: int
    answer: str
    fault: str = ""


@dataclass
class Transcript:
    """The answers of an episode.

    Attributes:
        turns: in their order.
        tokens_in, tokens_out, seconds, tries: sums over the replies, as the server says them; a request that is made
            again in the episode has the reply that is kept, and counts once.
        estimated: replies whose tokens the server did not count.
        cut: replies that ended because they were too long.
        disobeyed: replies that are outside the grammar that was sent.
        constraint: the way in which the grammar of legal commands was sent; "" where none was.
        pictures: prompts with a picture.
    """

    turns: list[Turn] = field(default_factory=list)
    tokens_in: int = 0
    tokens_out: int = 0
    seconds: float = 0.0
    tries: int = 0
    estimated: int = 0
    cut: int = 0
    disobeyed: int = 0
    constraint: str = ""
    pictures: int = 0
    _asked: Any = field(default_factory=lambda: blake2b(digest_size=16))
    _requests: set[bytes] = field(default_factory=set)

    def prompt(self, messages: Sequence[Mapping[str, Any]]) -> None:
        """Add a prompt to the digest of all prompts."""
        import orjson

        self._asked.update(orjson.dumps(list(messages), option=orjson.OPT_SORT_KEYS))

    def add(self, turn: Turn, reply: Reply, request: Sequence[Any], *, disobeyed: bool = False) -> None:
        """Add an answer to a request."""
        import orjson

        self.turns.append(turn)
        self.cut += reply.cut
        self.disobeyed += disobeyed
        key = blake2b(orjson.dumps(list(request), option=orjson.OPT_SORT_KEYS), digest_size=16).digest()
        if key in self._requests:
            return
        self._requests.add(key)
        self.tokens_in += reply.tokens_in
        self.tokens_out += reply.tokens_out
        self.seconds += reply.seconds
        self.tries += reply.tries
        self.estimated += not reply.counted

    def as_json(self) -> dict[str, Any]:
        """Return the transcript as result files have it, and pictures only where there were some."""
        pictures = {"pictures": self.pictures} if self.pictures else {}
        return {
            "turns": [[turn.tick, turn.answer, turn.fault or None] for turn in self.turns],
            "asked": self._asked.hexdigest(),
            "tokens_in": self.tokens_in,
            "tokens_out": self.tokens_out,
            "seconds": round(self.seconds, 3),
            "tries": self.tries,
            "estimated": self.estimated,
            "cut": self.cut,
            "disobeyed": self.disobeyed,
            "constraint": self.constraint,
            **pictures,
        }


PICTURES = "pictures"
"""The count that only transcripts with pictures have."""

COUNTS = ("tokens_in", "tokens_out", "tries", "estimated", "cut", "disobeyed")


def turns_of(transcript: Mapping[str, Any]) -> list[Turn]:
    """Return the turns of a transcript that a result file has."""
    return [Turn(tick, answer, fault or "") for tick, answer, fault in transcript["turns"]]


def faults_of(transcript: Mapping[str, Any]) -> Counter[str]:
    """Return the faults of a transcript, by code."""
    return Counter(fault for _, _, fault in transcript["turns"] if fault)


def is_transcript(given: Any) -> bool:
    """Return whether a value of JSON, perhaps a stranger's, is a transcript."""
    names = {"turns", "asked", "seconds", "constraint", *COUNTS}
    if not isinstance(given, dict) or given.keys() - {PICTURES} != names or not isinstance(given["turns"], list):
        return False
    counts = [given[name] for name in (*COUNTS, PICTURES) if name in given]
    counted = all(type(count) is int and 0 <= count <= LARGEST for count in counts)
    timed = type(given["seconds"]) in (int, float) and 0 <= given["seconds"] <= LARGEST
    return (
        counted
        and timed
        and all(isinstance(given[name], str) and len(given[name]) < 100 for name in ("asked", "constraint"))
        and len(given["turns"]) <= MOST_TURNS
        and all(map(_is_turn, given["turns"]))
    )


def _is_turn(given: Any) -> bool:
    if not isinstance(given, list) or len(given) != 3:
        return False
    tick, answer, fault = given
    return (
        type(tick) is int
        and 0 <= tick <= LARGEST
        and isinstance(answer, str)
        and answer == well_formed(answer)
        and (fault is None or (isinstance(fault, str) and len(fault) < 100))
    )
