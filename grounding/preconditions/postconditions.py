"""Post-conditions: what a program achieves, in terms of its own objects, so that any environment can be checked.

What the original brings about in its own, unperturbed environment has to be reached by every repair of it (thesis A.2,
eq. A.1: the function Omega).
"""

from collections.abc import Iterable, Mapping, Sequence

from hearth.schemas.literals import HOLDS, Key, Literal
from hearth.schemas.program import Program
from hearth.schemas.vocabulary import CHARACTER_CLASS, EVERY_STATE, EVERY_STATE_ID
from hearth.simulation.engine import Execution
from hearth.simulation.lasting_changes import lasting_rows
from hearth.simulation.literal_truth import RELATED, holds
from hearth.simulation.world.action_set_3_states import is_wide
from hearth.simulation.world.bits import indices, mask_of
from hearth.simulation.world.world import World

Postconditions = tuple[Literal[Key], ...]
"""States, ON, INSIDE and HOLDS, of a program's objects, sorted, each once; what is worn is ON the character."""


def achieved(execution: Execution) -> Postconditions:
    """Facts that hold at the end of a run and did not at its start, about the program's objects and the characters.

    That a bottle is INSIDE the glass it was poured into counts only if it is put nowhere else, and that it is GONE when
    the glass was drunk not at all: carried on, the bottle is no longer INSIDE. A room counts where it
    is the point: for a character, when the last walk was to that room itself; for a thing, when it lies in a room that
    the program walked to and on or in none of its objects.
    """
    program, world = execution.program, execution.final
    nodes = nodes_of(program, world)
    home = world.home
    before = frozenset(facts(execution.worlds[0], nodes))
    now = tuple(facts(world, nodes))
    new = [fact for fact in now if fact not in before]
    rooms = {key for key, node in nodes.items() if home.rooms >> home.index[node] & 1}
    held = {fact.target for fact in now if fact.name == HOLDS}
    poured = _residues(program, now, held, rooms)
    placed = {fact.subject for fact in new if fact.name in ("ON", "INSIDE") and fact.target not in rooms}
    going = home.knowledge.group("goes")
    drunk = {Literal("GONE", (step.objects[0].key,)) for step in program.steps if step.action == "Pour"}
    walked = [step.objects[0].key for step in program.steps if step.action in going and step.objects]

    def is_meant(fact: Literal[Key]) -> bool:
        if fact in poured or fact in drunk:
            return False
        if fact.name != "INSIDE" or fact.target not in rooms:
            return True
        if fact.subject[0] == CHARACTER_CLASS:
            return bool(walked) and fact.target == walked[-1]
        return fact.target in walked and fact.subject not in placed and fact.subject not in held

    return tuple(sorted(filter(is_meant, new)))


def missing(wanted: Postconditions, nodes: Mapping[Key, int], world: World) -> Postconditions:
    """Return the facts that do not hold in a world; `nodes` says which node each object is."""
    return tuple(fact for fact in wanted if not holds(fact, world, nodes))


def reached(wanted: Postconditions, nodes: Mapping[Key, int], world: World) -> bool:
    """Return whether every fact holds in a world."""
    return all(holds(fact, world, nodes) for fact in wanted)


def nodes_of(program: Program, world: World) -> dict[Key, int]:
    """Return the node of each object of a bound program, and of each character."""
    home = world.home
    nodes = {ref.key: ref.node for ref in program.objects() if ref.node is not None and ref.node in home.index}
    for number, agent in enumerate(world.agents, 1):
        nodes[CHARACTER_CLASS, number] = home.ids[agent.index]
    return nodes


def facts(
    world: World,
    nodes: Mapping[Key, int],
    states: Sequence[str] = (),
    relations: Sequence[str] = ("ON", "INSIDE", HOLDS),
) -> Iterable[Literal[Key]]:
    """All states and relations, or these, of some objects in a world; not states that a thing leaves by itself.

    Args:
        world: whose facts they are.
        nodes: the node of each object.
        states: names of the ten states of worlds of every action set; all states of the world when empty.
        relations: names of relations.
    """
    rows = world.states if not is_wide(world) else lasting_rows(world)
    index = world.home.index
    keys: dict[int, list[Key]] = {}
    for key, node in nodes.items():
        keys.setdefault(index[node], []).append(key)
    named = mask_of(keys)
    known = [
        (state, row) for state in states or EVERY_STATE[: len(rows)] if (row := rows[EVERY_STATE_ID[state]]) & named
    ]
    for i, subjects in keys.items():
        found: list[tuple[str, tuple[Key, ...]]] = [(state, ()) for state, row in known if row >> i & 1]
        for relation in relations:
            if row := RELATED[relation](world, i, named):
                found.extend((relation, (key,)) for j in indices(row) for key in keys[j])
        for subject in subjects:
            yield from (Literal(name, (subject, *target)) for name, target in found)


def _residues(program: Program, now: Postconditions, held: set[Key | None], rooms: set[Key]) -> set[Literal[Key]]:
    """Pouring: a thing is INSIDE the one it was poured into, although it is held or stands in another place."""
    pours = {(s.objects[0].key, s.objects[1].key) for s in program.steps if s.action == "Pour"}
    if not pours:
        return set()
    poured = {f for f in now if f.name == "INSIDE" and (f.subject, f.target) in pours}
    placed = {
        f.subject
        for f in now
        if f.name in ("ON", "INSIDE") and f.target is not None and f.target not in rooms and f not in poured
    }
    return {fact for fact in poured if fact.subject in held | placed}
