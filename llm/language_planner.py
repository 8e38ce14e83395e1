"""A planner: a language model that writes the program of a description, with similar training examples before it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import Any

from hearth.kb.knowledge import Knowledge
from hearth.kb.tools.line_grammars import LineGrammar
from hearth.kb.tools.step_grammar import step_grammar, step_schema
from hearth.llm.constraints import FORMS, SCHEMA, keeps, schema_fields
from hearth.llm.endpoint import Endpoint
from hearth.llm.legal_commands import form_of
from hearth.llm.prompt_pages import PromptPage, page
from hearth.llm.replies import Reply, sums
from hearth.llm.timed_connections import asking
from hearth.models.interface import Request, Steps
from hearth.models.text.mixed_similarity import MixedSimilarity
from hearth.models.text.retrieval import Similarity, text_of
from hearth.models.text_examples import Example
from hearth.pipelines.readers.plans_in_words import parse_steps
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code
from hearth.schemas.program import Program
from hearth.schemas.syntax import print_lines

MOST_SHOTS = 64
"""Examples in a prompt, at most."""


@dataclass
class Planned:
    """The counts of a planner's answers.

    Attributes:
        texts: descriptions that were answered.
        steps: steps that were understood.
        faults: lines that were not, by code; they are no steps.
        warnings: steps with words corrected or left out, by code.
        unanswered: descriptions without an answer, by code.
        first: the first reason for that, in words.
        replies: the answers.
        disobeyed: answers outside the grammar that was sent.
    """

    texts: int = 0
    steps: int = 0
    faults: Counter[str] = field(default_factory=Counter)
    warnings: Counter[str] = field(default_factory=Counter)
    unanswered: Counter[str] = field(default_factory=Counter)
    first: Diagnostic | None = None
    replies: list[Reply] = field(default_factory=list)
    disobeyed: int = 0

    def as_json(self) -> dict[str, Any]:
        """Return the counts, with the sums of the replies."""
        return {
            "texts": self.texts,
            "steps": self.steps,
            "faults": dict(self.faults),
            "warnings": dict(self.warnings),
            "unanswered": dict(self.unanswered),
            "disobeyed": self.disobeyed,
            **sums(self.replies),
        }


class LanguagePlanner:
    """A language model as a planner.

    Args:
        endpoint: the model.
        knowledge: the action grammar.
        examples: of training, from which those before a request are chosen by the words of their texts.
        shots: how many.
        similarity: makes the similarity to the examples' texts; usually that of words.

    Attributes:
        planned: the counts of all answers.

    Raises:
        HearthError: BAD_ARGUMENT: constrained, and the server obeys no grammar.
    """

    def __init__(
        self,
        endpoint: Endpoint,
        knowledge: Knowledge,
        examples: Sequence[Example] = (),
        shots: int = 0,
        similarity: Callable[[Sequence[str]], Similarity | MixedSimilarity] = Similarity,
    ) -> None:
        self._endpoint, self._knowledge, self._page = endpoint, knowledge, page("planner")
        first = {text_of(each.title, each.description): each for each in reversed(examples)}
        self._examples = list(first.values())[::-1]
        self._shots = min(shots, len(self._examples))
        texts = [text_of(each.title, each.description) for each in self._examples]
        self._similarity = similarity(texts) if self._shots else None
        self._form = form_of(endpoint) if endpoint.asking.constrained else ""
        self._grammar: LineGrammar | None = step_grammar(knowledge) if self._form else None
        self._fields = self._constraint() if self._form else {}
        self._system = self._page.said("system", actions=", ".join(sorted(knowledge.actions)))
        self.planned = Planned()

    @property
    def page(self) -> PromptPage:
        """Return the prompt page."""
        return self._page

    @property
    def at_once(self) -> int:
        """Return how many requests are made at the same time."""
        return self._endpoint.means.at_once

    def _constraint(self) -> Mapping[str, Any]:
        if self._form == SCHEMA:
            return schema_fields(step_schema(self._knowledge))
        assert self._grammar is not None
        return FORMS[self._form](self._grammar)

    def predict(self, requests: Sequence[Request], beam: int = 1) -> list[Steps | None]:
        """Return the program for each request; None where there is no answer.

        A budget that is spent ends the asking: the other requests have no answer.
        """
        with ThreadPoolExecutor(self.at_once) as pool, asking(pool):
            return [self._read(found) for found in pool.map(self._asked, requests, self._chosen(requests))]

    def _chosen(self, requests: Sequence[Request]) -> list[list[Example]]:
        """Return the examples before each request, the most similar last; none has the text of the request."""
        if self._similarity is None:
            return [[] for _ in requests]
        texts = [text_of(each.title, each.description) for each in requests]
        nearest = self._similarity.nearest(texts, self._shots + 1)
        found = []
        for text, (places, _) in zip(texts, nearest, strict=True):
            others = [self._examples[place] for place in places]
            others = [each for each in others if text_of(each.title, each.description) != text][: self._shots]
            found.append(others[::-1])
        return found

    def _asked(self, request: Request, examples: Sequence[Example]) -> Reply | Diagnostic:
        try:
            return self._endpoint.ask(list(self._chat(request, examples)), **self._fields)
        except HearthError as error:
            if error.diagnostics[0].code not in (Code.NO_ANSWER, Code.OVER_BUDGET):
                raise
            return error.diagnostics[0]

    def _chat(self, request: Request, examples: Sequence[Example]) -> Iterator[Mapping[str, str]]:
        yield {"role": "system", "content": self._system}
        for each in examples:
            yield {"role": "user", "content": self._said(each.title, each.description)}
            yield {"role": "assistant", "content": "\n".join(print_lines(Program(steps=each.steps)))}
        yield {"role": "user", "content": self._said(request.title, request.description)}

    def _said(self, title: str, description: str) -> str:
        return self._page.said("request", title=title, description=description)

    def _read(self, found: Reply | Diagnostic) -> Steps | None:
        """Return the program of an answer, and count what is in it."""
        planned = self.planned
        if isinstance(found, Diagnostic):
            planned.unanswered[str(found.code)] += 1
            planned.first = planned.first or found
            return None
        planned.replies.append(found)
        planned.texts += 1
        planned.disobeyed += self._disobeys(found.text)
        read = parse_steps(_as_lines(found.text), self._knowledge)
        planned.faults.update(str(fault.code) for fault in read.faults)
        planned.warnings.update(str(fault.code) for fault in read.warnings)
        planned.steps += len(read.program.steps)
        return read.program.steps

    def _disobeys(self, text: str) -> bool:
        if self._form == SCHEMA:
            return _steps_of_json(text) is None
        return self._grammar is not None and not keeps(text, self._grammar, self._form)


def _as_lines(text: str) -> str:
    """Return an answer as lines of a program: those of JSON as the schema of steps has it, or the text as it is."""
    lines = _steps_of_json(text)
    return text if lines is None else "\n".join(lines)


def _steps_of_json(text: str) -> list[str] | None:
    import orjson

    try:
        given = orjson.loads(text)
        return [_line(step) for step in given["steps"]]
    except (orjson.JSONDecodeError, TypeError, KeyError, AttributeError):
        return None


def _line(step: Mapping[str, Any]) -> str:
    names = [str(step[name]) for name in ("object1", "object2") if name in step]
    return f"[{step['action']}]" + "".join(f" <{name}> (1)" for name in names)
