"""A judge: a language model that says whether a task was done by the steps that it is shown."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import Any

from hearth.envs.text_layout import printable
from hearth.kb.tools.line_grammars import line_grammar
from hearth.llm.constraints import FIELD, FORMS, SCHEMA, keeps
from hearth.llm.endpoint import Endpoint
from hearth.llm.legal_commands import form_of
from hearth.llm.prompt_pages import PromptPage, page, unmarked
from hearth.llm.replies import Reply, sums
from hearth.llm.timed_connections import asking
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code
from hearth.storage.parallel import Seen, unseen

VERDICTS = {"yes": True, "no": False}
"""The two answers of a judge."""

ANSWERS = line_grammar([["yes"], ["no"]])
"""Their grammar."""

_WORD = re.compile(r"[a-z]+", re.IGNORECASE)

MOST_KEPT = 2_000
"""Characters of an answer that judgements keep."""


@dataclass(frozen=True)
class Case:
    """A task and the steps that were done for it.

    Attributes:
        id: of the case.
        task: in words.
        steps: that were tried, in order.
        right: the engine's verdict.
    """

    id: str
    task: str
    steps: tuple[str, ...]
    right: bool


@dataclass(frozen=True)
class Judgement:
    """A judge's answer to a case.

    Attributes:
        case: the case.
        says: whether the task is done; None where the answer is neither yes nor no, or there is none.
        answer: what was written.
        fault: the code of the reason why there is no verdict; "" where there is one.
    """

    case: Case
    says: bool | None
    answer: str = ""
    fault: str = ""

    def as_json(self) -> dict[str, Any]:
        """Return the judgement as files have it."""
        case = self.case
        return {
            "id": case.id,
            "engine": case.right,
            "judge": self.says,
            "fault": self.fault or None,
            "answer": self.answer[:MOST_KEPT],
        }


@dataclass
class Judge:
    """A language model as a judge.

    Attributes:
        endpoint: the model; its `asking.constrained` sends the grammar of the two answers.
        replies: the answers until now.
        faults: cases without a verdict, by code.
        first: the first reason for that, in words.

    Raises:
        HearthError: BAD_ARGUMENT: constrained, and the server obeys no grammar.
    """

    endpoint: Endpoint
    replies: list[Reply] = field(default_factory=list)
    faults: Counter[str] = field(default_factory=Counter)
    first: Diagnostic | None = None

    def __post_init__(self) -> None:
        self.page: PromptPage = page("judge")
        self._form = form_of(self.endpoint) if self.endpoint.asking.constrained else ""
        self._fields: Mapping[str, Any] = FORMS[self._form](ANSWERS) if self._form else {}

    def judge(self, cases: Sequence[Case]) -> list[Judgement]:
        """Return the judgement of each case; a spent budget or a server that fails leaves cases without a verdict."""
        first = {(case.task, case.steps): case for case in cases}  # equal ones are one prompt
        with ThreadPoolExecutor(self.endpoint.means.at_once) as pool, asking(pool):
            found = dict(zip(first, pool.map(self._asked, first.values()), strict=True))
        return [self._read(case, found[case.task, case.steps]) for case in cases]

    def as_json(self) -> dict[str, Any]:
        """Return the prompt page, and the counts of all answers."""
        why = {} if self.first is None else {"first_unanswered": self.first.message}
        said = sums(self.replies)
        cost = round(self.endpoint.means.cost(said["tokens_in"], said["tokens_out"]), 6)
        page = {"prompt": self.page.name, "prompt_fingerprint": self.page.fingerprint}
        return {"model": self.endpoint.model, **page, "faults": dict(self.faults), **said, "cost": cost, **why}

    def _asked(self, case: Case) -> Reply | Diagnostic:
        try:
            return self.endpoint.ask(list(self.chat(case)), **self._fields)
        except HearthError as error:
            if error.diagnostics[0].code not in (Code.NO_ANSWER, Code.OVER_BUDGET):
                raise
            return error.diagnostics[0]

    def chat(self, case: Case) -> Iterator[Mapping[str, str]]:
        """Yield the messages about a case; the engine's verdict is in none."""
        steps = [printable(step) for step in case.steps[-self.page["most_steps"] :]] or [self.page.said("nothing")]
        said = self.page.said("request", steps="\n".join(steps), task=printable(case.task))
        yield {"role": "system", "content": self.page.said("system")}
        yield {"role": "user", "content": unmarked(said)}

    def _read(self, case: Case, found: Reply | Diagnostic) -> Judgement:
        if isinstance(found, Diagnostic):
            self.first = self.first or found
            self.faults[str(found.code)] += 1
            return Judgement(case, None, "", str(found.code))
        self.replies.append(found)
        says = self._verdict(found.text)
        code = "" if says is not None else str(Code.NOT_UNDERSTOOD)
        self.faults.update([code] if code else [])
        return Judgement(case, says, found.text, code)

    def _verdict(self, text: str) -> bool | None:
        if self._form == SCHEMA:
            import orjson

            return VERDICTS[orjson.loads(text)[FIELD]] if keeps(text, ANSWERS, SCHEMA) else None
        return verdict(text)


def judged(judge: Judge, cases: Sequence[Case], seen: Seen = unseen) -> list[Judgement]:
    """Return the judgements of all cases; `seen` is called with the number of those that are done."""
    found: list[Judgement] = []
    step = judge.endpoint.means.at_once * 4
    for first in range(0, len(cases), step):
        found += judge.judge(cases[first : first + step])
        seen(len(found), len(cases))
    return found


def verdict(text: str) -> bool | None:
    """Return the verdict on the last line of an answer: one of the two words, and not the other; else None."""
    lines = [line for line in text.splitlines() if line.strip()]
    said = {VERDICTS[word] for word in map(str.lower, _WORD.findall(lines[-1] if lines else "")) if word in VERDICTS}
    return said.pop() if len(said) == 1 else None
