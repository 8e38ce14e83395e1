"""A person at a terminal: reads the observations of hearth-text/1, and answers in commands or plain sentences."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from hearth.agents.protocol import Choice, Resigned
from hearth.envs.agent_answers import Fault, Keep, by_number, by_words, keep_nothing, row
from hearth.envs.answer_forms import WALK, read_answer
from hearth.envs.compact_text import compact, said_step, wanted_nodes
from hearth.envs.seen_bans import SeenBans
from hearth.envs.text_agent import TALKING, Ask, description, plain
from hearth.envs.text_layout import layout
from hearth.envs.text_protocol_settings import protocol
from hearth.envs.text_worlds import reason
from hearth.schemas.agent_messages import ASK, TELL
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.goals import Goal
from hearth.schemas.program import Step
from hearth.simulation.actions.legal import Legal
from hearth.simulation.observation.views import View

PAGE = 20
"""Commands of a page of `list`."""

QUIT = frozenset({"quit", "exit", "q", "bye"})
"""Words that end the episode."""

HELP = f"""\
Say what to do, one command a line, as in `Grab cup 41`, or in words: `take the milk out of the fridge`.
  list         what you can do now, {PAGE} at a time, with numbers that also answer
  list WORD    only what has the word, as in `list fridge`
  more         the next page
  look         all that you see, with its number
  wait         do nothing for a tick
  help, quit   this page; end the episode
`help`, `list`, `more` and `look` take no time. A walk goes on until you arrive or see something that is wanted.
"""


class TerminalAgent:
    """An agent that a person plays at a terminal.

    Attributes:
        faults: commands that could not be used, in their order.

    Args:
        ask: answers a prompt. EOFError ends the episode.
        keep: gets a row for each tick, as of `TextAgent`.
        messages: whether the person may say something instead of doing something.
        task: the goal as somebody says it; put into words where empty.
    """

    def __init__(self, ask: Ask, keep: Keep = keep_nothing, messages: bool = False, task: str = "") -> None:
        self.ask, self.keep, self.messages, self.task = ask, keep, messages, task
        self.faults: list[Fault] = []
        self._goal = Goal()
        self._bans: SeenBans | None = None
        self._walk: _Walk | None = None
        self._rest: list[str] = []

    def reset(self, observation: View, goal: Goal | None, seed: int) -> None:
        """Begin an episode; the seed is for the agents that draw."""
        self.faults, self._goal, self._walk, self._rest = [], goal or Goal(), None, []
        self._bans = SeenBans(self._goal, observation)

    def act(self, observation: View, legal: Legal) -> Choice:
        """Walk on, or ask until a line is a command; one that can't be used is a fault, which the next prompt names."""
        if self._bans is not None:
            self._bans.look(observation)
        walk, self._walk = self._walk, None
        if walk is not None and walk.goes_on(observation, legal, self._goal):
            self._walk = walk.from_here(observation)
            return walk.step
        asked = self._prompt(observation, legal)
        answer = self._answered(asked, observation, legal)
        choice: Choice = None
        fault = None
        try:
            choice = self._understood(answer, observation, legal)
        except HearthError as error:
            fault = Fault(observation.tick, error.diagnostics[0])
            self.faults.append(fault)
        self.keep({**row(observation, answer, choice, fault), "prompt": asked})
        if isinstance(choice, Step) and choice.action == WALK:
            self._walk = _Walk(choice, observation.mask, observation.me.place)
        return choice

    def _prompt(self, view: View, legal: Legal) -> str:
        last = self.faults[-1] if self.faults and self.faults[-1].tick == view.tick - 1 else None
        note = f"refused, you waited. {reason(last.fault)}" if last else ""
        lines = [f"Tick {view.tick}.", compact(view, legal, self._goal, protocol(), self.task, note)]
        lines += self._bans.lines() if self._bans is not None else ()
        lines += (f"Agent {number} said: {said}." for number, said in view.messages)
        lines += [TALKING.rstrip()] if self.messages else []
        return "\n".join((*lines, "What do you do? (`help`, `list`, `look`, `quit`)\n"))

    def _answered(self, asked: str, view: View, legal: Legal) -> str:
        """Return the first line that is not about the terminal itself.

        Raises:
            Resigned: the person ends the episode.
        """
        while True:
            try:
                answer = self.ask(asked)
            except EOFError:
                raise Resigned from None
            word, _, rest = answer.strip().lower().rstrip(".!?").partition(" ")
            if word in QUIT and not rest:
                raise Resigned
            shown = self._shown(word, rest, view, legal)
            if shown is None:
                return answer
            asked = shown

    def _shown(self, word: str, rest: str, view: View, legal: Legal) -> str | None:
        """Return the page that a line asks for; None where it is a command to act."""
        if word in ("help", "?") and not rest:
            return HELP
        if word == "look" and not rest:
            return description(view, self._goal, self._bans) + "\n"
        if word == "list":
            self._rest = list(_listed(rest, view, legal))
            return self._page() if self._rest else f"You can do nothing now with `{rest[:60]}` in it.\n"
        if word == "more" and not rest:
            return self._page() if self._rest else "There are no more. `list` begins again.\n"
        return None

    def _page(self) -> str:
        page, self._rest = self._rest[:PAGE], self._rest[PAGE:]
        left = f"... {len(self._rest)} more: `more`, or `list` with a word" if self._rest else ""
        return "\n".join((*(f"  {line}" for line in page), *([left] if left else []), ""))

    def _understood(self, answer: str, view: View, legal: Legal) -> Choice:
        line = answer.strip()
        number = line.lstrip("#").rstrip(".)")
        if number.isascii() and number.isdecimal() and len(number) < PAGE:
            return by_number(int(number), list(legal))
        if self.messages and line.partition(" ")[0] in (ASK, TELL):
            return by_words(line, view, legal, messages=True)
        step = read_answer(answer, view, legal, protocol())
        if step is None or step.action != WALK or line.lower().startswith(WALK.lower()):
            return step
        whole = replace(step, action="Walk")  # where a walk takes one tick, nobody wants it by meters
        return whole if whole in legal else step


def _listed(word: str, view: View, legal: Legal) -> Iterator[str]:
    """Yield the commands with a word, each after its number; without one, no walks, and none about walls and floors."""
    home, words = view.world.home, protocol()
    built = layout(home, words).built
    for number, step in enumerate(legal):
        line = said_step(plain(step))
        nodes = [home.index[ref.node] for ref in step.objects if ref.node is not None]
        is_usual = step.action not in words.hidden and not any(built >> i & 1 for i in nodes)
        if word in line.lower() if word else is_usual:
            yield f"{number} {line}"


class _Walk:
    """A walk that goes on without a question.

    Attributes:
        step: the instruction.
    """

    def __init__(self, step: Step, seen: int, place: object) -> None:
        self.step, self._seen, self._place = step, seen, place

    def from_here(self, view: View) -> _Walk:
        """Return the walk after a tick."""
        return _Walk(self.step, self._seen, view.me.place)

    def goes_on(self, view: View, legal: Legal, goal: Goal) -> bool:
        """Return whether the walker moved, is not there yet, and saw nothing wanted that was out of sight before."""
        failed = view.me.last is not None and view.me.last.failure is not None
        sighted = wanted_nodes(goal, view.world.home, view.mask) & ~self._seen
        return not failed and not sighted and view.me.place != self._place and self.step in legal
