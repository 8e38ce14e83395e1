"""The instructions possible now: a bit set for each argument of each action, instructions listed lazily."""

from __future__ import annotations

from collections.abc import Collection, Iterator, KeysView, Mapping
from dataclasses import dataclass
from functools import lru_cache
from itertools import product
from typing import TYPE_CHECKING, Any

from hearth.kb.tools.line_grammars import written
from hearth.schemas.program import ObjectRef, Step
from hearth.schemas.short_repr import brief
from hearth.simulation.actions.common import Action
from hearth.simulation.actions.consequences import actions as consequent
from hearth.simulation.actions.legal_grammar import legal_grammar
from hearth.simulation.actions.registry import ACTIONS, EVERY
from hearth.simulation.actions.situation import Situation
from hearth.simulation.observation import reach, visible_nodes
from hearth.simulation.observation.masked_world import as_seen
from hearth.simulation.processes import widened
from hearth.simulation.rules import DEFAULT, Rules
from hearth.simulation.world.bits import indices

if TYPE_CHECKING:
    from hearth.simulation.world.home import Home
    from hearth.simulation.world.world import World


@dataclass(frozen=True, slots=True)
class Legal:
    """The instructions one agent could do in one world.

    Attributes:
        home: whose nodes the masks are about.
        agent: whose instructions.
        masks: action -> masks, for the executed actions that can be done. Of two arguments any two different nodes.
    """

    home: Home
    agent: int
    masks: Mapping[str, tuple[int, ...]]

    def __repr__(self) -> str:
        return f"Legal({self.home!r}, agent {self.agent}, {len(self):,} instructions)"

    def __contains__(self, instruction: Step) -> bool:
        masks = self.masks.get(instruction.action)
        if masks is None or len(masks) != len(instruction.objects) or instruction.agent != self.agent:
            return False
        index, nodes = self.home.index, [ref.node for ref in instruction.objects]
        if len(set(nodes)) < len(nodes):
            return False
        return all(node in index and mask >> index[node] & 1 for node, mask in zip(nodes, masks, strict=True))

    @property
    def asked(self) -> Collection[str]:
        """Return the actions that were asked about; whether one of them can be done, `masks` says."""
        return self.masks.asked if isinstance(self.masks, _Masks) else self.masks

    def __iter__(self) -> Iterator[Step]:
        """Instructions by action name, then node ids; made one by one as they are asked for."""
        for action in sorted(self.masks):
            for objects in product(*map(self._references, self.masks[action])):
                if len({ref.node for ref in objects}) == len(objects):
                    yield Step(action, objects, self.agent)

    def __len__(self) -> int:
        return sum(map(self.count, self.masks))

    def count(self, action: str) -> int:
        """Return how many instructions of an action there are; no thing is named twice in one."""
        masks = self.masks.get(action, (0,))
        count = masks[0].bit_count() if masks else 1
        if len(masks) > 1:
            count = count * masks[1].bit_count() - (masks[0] & masks[1]).bit_count()
        return count

    def grammar(self, form: str = "gbnf", names: Mapping[str, str] | None = None, *, wait: bool = False) -> str:
        """Return the grammar of these instructions, written as `Grab milk 142`, for constrained decoding.

        Args:
            form: `gbnf`, `lark`, `regex` or `schema` (of JSON, with the field `command`).
            names: the actions that may be written, and the word for each; all, by their own names, where None.
            wait: whether `wait` may be written, too.

        Raises:
            HearthError: BAD_ARGUMENT: there is no such form; EMPTY: nothing can be done.

        Examples:
            >>> legal = env.legal(0)
            >>> legal.grammar("gbnf").splitlines()[0], "Walk" in legal.grammar("regex")
            ('root ::= line', True)
        """
        return written(legal_grammar(self.home, self.masks, names, wait=wait), form)

    def objects(self, action: str, position: int = 0) -> tuple[int, ...]:
        """Ids of the nodes that an argument of an action may be, ascending; none when it can't be done."""
        masks = self.masks.get(action)
        return tuple(self.home.ids[i] for i in indices(masks[position])) if masks else ()

    def _references(self, mask: int) -> Iterator[ObjectRef]:
        home = self.home
        return (ObjectRef(home.classes[i], 0, home.ids[i]) for i in indices(mask))


def legal(
    world: World,
    agent: int = 0,
    rules: Rules = DEFAULT,
    *,
    only_visible: bool = False,
    only_reachable: bool = False,
    actions: Collection[str] | None = None,
) -> Legal:
    """Return the legal instructions of an agent: exactly those that `engine.act` would not refuse.

    With `only_visible` it is the agent's knowledge of them: instructions about visible nodes, possible as far as the
    agent sees. Nothing out of its sight changes the answer. An unseen door therefore stops nobody here, and an
    instruction may be refused when it is tried.

    Args:
        world: now.
        agent: number of the agent.
        rules: of the engine.
        only_visible: answer from the agent's view alone (see `visible_nodes.visible` and `as_seen`).
        only_reachable: leave out instructions about nodes behind closed doors or in closed containers, even where the
            action itself would not mind.
        actions: only these; all where None.

    Raises:
        HearthError: UNKNOWN_AGENT, if the world has no character of that number.
    """
    if rules.consequences:
        world = widened(world)
    me, keep = world.agent(agent), -1
    if only_visible:
        keep = visible_nodes.visible(world, me)
        world = as_seen(world, keep)
    situation = Situation(world, agent, rules)
    if only_reachable:
        keep &= reach.reachable(world, situation.me)
    placed = situation.me.pose is not None
    every: Mapping[str, Action] = consequent(world.home.knowledge, placed) if rules.consequences else _USUAL[placed]
    if actions is None:
        chosen = every
    elif isinstance(actions, frozenset) and not rules.consequences:
        chosen = _some(placed, actions)
    else:
        chosen = {name: action for name, action in every.items() if name in actions}
    return Legal(world.home, agent, _Masks(situation, chosen, keep))


_USUAL = (ACTIONS, EVERY)
"""The actions of characters that are not at places, and of those that are."""


@lru_cache(maxsize=128)
def _some(placed: bool, names: frozenset[str]) -> Mapping[str, Action]:
    """Return some of these actions; agents ask for the same ones tick by tick."""
    return {name: action for name, action in _USUAL[placed].items() if name in names}


class _Masks(Mapping[str, tuple[int, ...]]):
    """The masks of the actions that can be done, each made when it is asked for: most agents ask for few."""

    __repr__ = brief

    def __init__(self, situation: Situation, actions: Mapping[str, Action], keep: int) -> None:
        self._situation, self._actions, self._keep = situation, actions, keep
        self._found: dict[str, tuple[int, ...] | None] = {}
        self.asked = actions

    def __getitem__(self, name: str) -> tuple[int, ...]:
        masks = self._found[name] if name in self._found else self._made(name)
        if masks is None:
            raise KeyError(name)
        return masks

    def get(self, name: str, default: Any = None) -> Any:
        """Return the masks of an action, or the default where it can't be done; without an error in between."""
        masks = self._found[name] if name in self._found else self._made(name)
        return default if masks is None else masks

    def __contains__(self, name: object) -> bool:
        found = self._found
        return (found[name] if name in found else self._made(name)) is not None  # type: ignore[arg-type]

    def keys(self) -> KeysView[str]:
        found, situation = self._found, self._situation
        for name, action in self._actions.items():
            if name not in found:
                masks = action.mask(situation)
                found[name] = masks and self._kept(masks)
        return {name: None for name in self._actions if found[name] is not None}.keys()

    def __iter__(self) -> Iterator[str]:
        return iter(self.keys())

    def __len__(self) -> int:
        return len(self.keys())

    def _made(self, name: str) -> tuple[int, ...] | None:
        action = self._actions.get(name)
        masks = None if action is None else action.mask(self._situation)
        self._found[name] = masks = masks and self._kept(masks)
        return masks

    def _kept(self, masks: tuple[int, ...]) -> tuple[int, ...] | None:
        """Return the masks without what is out of reach; None where nothing is left, or only a thing with itself."""
        if self._keep != -1:
            masks = tuple([mask & self._keep for mask in masks])
        single = len(masks) > 1 and masks[0] == masks[1] and masks[0].bit_count() == 1
        return masks if all(masks) and not single else None
