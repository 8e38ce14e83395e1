"""The messages to a person's page: at first the whole view, then the differences after each tick."""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from functools import lru_cache, reduce
from operator import or_
from typing import Any

from hearth.challenges.instruction_object_names import label
from hearth.challenges.instruction_writer import acted, instruction
from hearth.envs.json_observations import last_json, seen_failure
from hearth.homes.geometry import footprint
from hearth.kb.action_groups import relation_of
from hearth.schemas.failure_words import sentence
from hearth.schemas.failures import Failure
from hearth.schemas.goals import BANS, Goal, Joined
from hearth.schemas.graph import Node
from hearth.schemas.literals import AGENT, HOLDS
from hearth.schemas.vocabulary import CHARACTER_CATEGORY, ROOM_CATEGORY, STATES
from hearth.simulation.actions.legal import Legal
from hearth.simulation.goals import Progress
from hearth.simulation.motion.ground import UNTOUCHED
from hearth.simulation.observation import reach
from hearth.simulation.observation.masked_world import as_seen
from hearth.simulation.observation.views import LastAction, View
from hearth.simulation.observation.views import Pose as AgentPose
from hearth.simulation.world import edge_rows
from hearth.simulation.world.bits import indices, lowest
from hearth.simulation.world.home import Home
from hearth.simulation.world.pose import Pose
from hearth.web.phrases import ENGLISH, language, phrases, say, thing_name
from hearth.web.play.games import Game
from hearth.web.play.player_memory import Counted

USES = ("GRABBABLE", "CAN_OPEN", "HAS_SWITCH", "SURFACES", "CONTAINERS", "SITTABLE", "LIEABLE")
"""Properties of things that pages show; no action uses a thing with none of them, such as a wall."""

PLAN = ("Walls", "Doors", "Windows")
"""Categories that floor plans show of a whole home, which everybody knows."""

Objects = dict[int, list[Any]]
"""Changing facts about things: node id -> room, relation, holder, states, whether it is close."""


def thing_group(node: Node) -> str:
    """Return the panel of a thing: rooms and doors, furniture, things to hold, or people; floors are in none."""
    if node.category == "Floor":
        return "floor"
    if node.category in (ROOM_CATEGORY, "Doors"):
        return "rooms"
    if node.category == CHARACTER_CATEGORY:
        return "people"
    return "things" if "GRABBABLE" in node.properties else "furniture"


class Telling:
    """One page's knowledge of a game, so that the server sends the page only news.

    Args:
        game: the game.
        number: the character of the person.
    """

    def __init__(self, game: Game, number: int) -> None:
        self.game, self.number = game, number
        self._known: Objects = {}
        self._named: set[int] = set()

    def begin(self) -> dict[str, Any]:
        """Return the first message: the trial, the floor plan, the present and past observations."""
        game = self.game
        trial = game.trial
        self._known, self._named = {}, set()
        seen = game.seen[self.number]
        return {
            "type": "begin",
            "me": self.number,
            "characters": len(game.start.agents),
            "helper": trial.helper,
            "interface": trial.interface,
            "limit": game.playing.limit,
            "partial": trial.partial,
            "plan": floor_plan(game.start.home),
            "trails": {str(who): [[at, *_point(pose)] for at, pose in way] for who, way in seen.trails.items()},
            **self.now(),
        }

    def now(self) -> dict[str, Any]:
        """Return the tick: the changes for this page, the legal actions, and the progress of the goal."""
        game = self.game
        view, legal = game.view(self.number), game.legal(self.number)
        objects = seen_objects(view)
        changed = {str(node): row for node, row in objects.items() if self._known.get(node) != row}
        gone = [node for node in self._known if node not in objects]
        new = [node for node in objects if node not in self._named]
        self._known = objects
        self._named.update(new)
        return {
            "tick": game.tick,
            "goal": self._goal(view.world.home),
            "things": {str(node): _thing(view.world.home, node) for node in new},
            "changed": changed,
            "gone": gone,
            "legal": legal_json(legal, view.me.node),
            "agents": [{**_character(pose, view), "waited": self._waited(pose)} for pose in (view.me, *view.others)],
            "over": game.over,
            "success": game.playing.progress[-1].satisfied,
            "end": None if game.end is None else game.end["code"],
            "ended_by": None if game.end is None else game.end["agent"],
        }

    def _goal(self, home: Home) -> list[dict[str, Any]]:
        """Return the counted parts of the goal as the person last saw them; what it did itself it knows."""
        counts = self.game.seen[self.number].counts
        progress = self.game.playing.progress[-1]
        done = progress.counts if self.number == 0 else (0,) * len(counts)
        rows = [
            _wanted(replace(each, count=number) if each.seen.seen is None else each, home)
            for each, number in zip(counts, done, strict=True)
        ]
        return [*rows, *joined_rows(progress)] if self.number == 0 else rows

    def _waited(self, pose: AgentPose) -> bool:
        """Return whether a character did nothing in the tick before; its last act is of an earlier one then."""
        return bool(self.game.texts) and self.game.texts[-1][pose.agent] is None

    def tick(self) -> dict[str, Any]:
        """Return the tick as a message of its own."""
        return {"type": "tick", **self.now()}


def seen_objects(view: View) -> Objects:
    """Return the usable things in a person's view: their room, place, states, and whether they are close."""
    home, world = view.world.home, as_seen(view.world, view.mask)
    usable = usable_things(home)
    agent = world.agents[view.agent]
    close = reach.close_to(world, agent)
    held = {i: other for other in world.agents for i in edge_rows.held_indices(other)}
    found: Objects = {}
    for i in indices(usable & view.mask & ~agent.bit):
        relation, holder = _where(view, i, held)
        states = [name for number, name in enumerate(STATES) if world.states[number] >> i & 1]
        room = i if home.rooms >> i & 1 else edge_rows.room_of(world, i)
        if home.characters >> i & 1:
            room = edge_rows.agent_room(world, edge_rows.character(world, i))
        found[home.ids[i]] = [home.ids[room] if room >= 0 else 0, relation, holder, states, close >> i & 1]
    return found


def _where(view: View, i: int, held: dict[int, Any]) -> tuple[str, int]:
    """Return the relation and the id of a thing's holder or place, as far as it is visible; '' and 0 without one."""
    world, home = view.world, view.world.home
    if i in held:
        return "held", home.ids[held[i].index]
    if home.characters >> i & 1:
        return "", 0
    inside = edge_rows.inside(world, i) & ~home.rooms & view.mask
    if inside:
        return "in", home.ids[lowest(inside)]
    on = edge_rows.on(world, i) & ~home.rooms & view.mask
    return ("on", home.ids[lowest(on)]) if on else ("", 0)


def _thing(home: Home, node_id: int) -> list[Any]:
    """Return the constant facts about a thing: class, panel, footprint on the plan, and name for people."""
    i = home.index[node_id]
    node = home.node(i)
    return [node.class_name, thing_group(node), _rect(node), called(home)[i]]


def called(home: Home) -> tuple[str, ...]:
    """Return what people call each thing of a home, in their language: `mug 2` where there are several mugs."""
    return _all_called(home, language())


@lru_cache(maxsize=64)
def _all_called(home: Home, _: str) -> tuple[str, ...]:
    names = [_called(home, i) for i in range(len(home.ids))]
    places: dict[str, list[int]] = {}
    for i in indices(home.everything):
        if home.node(i).category not in UNTOUCHED - {ROOM_CATEGORY}:  # pieces of floor look alike
            places.setdefault(names[i], []).append(i)
    for same in places.values():
        for number, i in enumerate(same if len(same) > 1 else (), 1):
            names[i] += f" {number}"
    return tuple(names)


def _called(home: Home, i: int) -> str:
    if home.characters >> i & 1:
        return say("play", "person")
    name = thing_name(label(home.classes[i]))
    between = [thing_name(label(home.classes[room])) for room in indices(home.between[i] & home.rooms)]
    return say("play", "door", door=name, one=between[0], other=between[1]) if len(between) == 2 else name


def _rect(node: Node) -> list[float] | None:
    if node.box is None:
        return None
    rect = footprint(node.box)
    return [round(value, 2) for value in (rect.x0, rect.z0, rect.x1, rect.z1)]


def floor_plan(home: Home) -> list[list[Any]]:
    """Rooms, walls, doors and windows, which never move: kind, class, rectangle (x0, z0, x1, z1 in metres), id, name.

    What surrounds a door is a `frame`: nothing can be done with it.
    """
    kinds = {ROOM_CATEGORY: "room", "Walls": "wall", "Doors": "door", "Windows": "window"}
    nodes = [home.node(i) for i in range(len(home.ids)) if not home.absent >> i & 1]
    order = sorted((node for node in nodes if node.category in kinds and node.box), key=lambda n: n.category in PLAN)
    frames = {node.id for node in order if node.category == "Doors" and "CAN_OPEN" not in node.properties}
    rows = [(node, "frame" if node.id in frames else kinds[node.category]) for node in order]
    names = called(home)  # as the lists have them: of two bedrooms, one is `bedroom 1`
    return [[kind, node.class_name, _rect(node), node.id, names[home.index[node.id]]] for node, kind in rows]


PLACES = {"ON": ("SURFACES",), "INSIDE": ("CONTAINERS", "CAN_OPEN")}
"""Properties of the places that people put things on or in; the engine takes anything that is close."""


def legal_json(legal: Legal, me: int) -> dict[str, list[list[int]]]:
    """Return the instructions that are offered: action -> the ids that each of its places may have.

    They are those that can be done with things that the page shows, and that make sense to people. `me` is the node of
    the person's character, which the page does not show as a thing.
    """
    home = legal.home
    things = usable_things(home) & ~(1 << home.index[me])
    found = {}
    for name, masks in legal.masks.items():
        shown = [mask & things for mask in masks]
        relation = relation_of(home.knowledge.actions[name])
        if relation in PLACES:
            shown[1] &= _with(home, PLACES[relation]) | (home.characters if relation == "ON" else 0)
        if all(shown):
            found[name] = [[home.ids[i] for i in indices(mask)] for mask in shown]
    return found


def usable_things(home: Home) -> int:
    """Return the things of a home that pages show."""
    return home.rooms | home.characters | _with(home, USES)


def _with(home: Home, properties: Iterable[str]) -> int:
    """Return the things that have one of some properties."""
    return reduce(or_, (home.properties[name] for name in properties))


def _character(pose: Any, view: View) -> dict[str, Any]:
    where = None if pose.place is None else _point(pose.place)
    return {
        "agent": pose.agent,
        "node": pose.node,
        "place": where,
        "room": pose.room or 0,
        "posture": pose.posture,
        "holding": list(pose.holding),
        "last": None if pose.last is None else _last(pose.last, view),
    }


def _last(last: LastAction, view: View) -> dict[str, Any]:
    """Return the last act, and in words for people why it failed, if it did."""
    found = last_json(last, view)
    if last.failure is not None:
        found["failure"]["words"] = _why(seen_failure(last.failure, view))
    return found


def _why(failure: Failure) -> str:
    """Return why an act failed; in other languages than English by its code alone."""
    if language() == ENGLISH:
        return sentence(failure, code=False)
    known = phrases(language())["failed"]
    return known.get(str(failure.code), known["other"])


def _point(pose: Pose) -> list[float]:
    return [round(pose.x, 3), round(pose.z, 3), round(pose.yaw, 1)]


def _wanted(counted: Counted, home: Home) -> dict[str, Any]:
    each = counted.seen
    count = min(counted.count, each.wanted)
    return {"text": goal_words(each.literal, home), "classes": list(_classes(each.literal, home)),
            "count": count, "wanted": each.wanted}  # fmt: skip


def _classes(literal: Any, home: Home) -> Iterator[str]:
    """Yield the classes of the home's things that a literal is about, so that pages can mark them."""
    for term in literal.terms:
        if isinstance(term, int):
            yield home.classes[home.index[term]]
        elif term.partition(":")[0] != AGENT:
            yield from sorted({home.classes[i] for i in indices(home.instances(term))})


def joined_rows(progress: Progress) -> Iterator[dict[str, Any]]:
    """Yield a row for each joined part of a goal, such as a ban: whether it holds now, and whether it is lost for good.

    Also what the person did not see counts: a broken ban ends the game's chance, and a person is to know that.
    """
    home = progress.trace.worlds[0].home if progress.trace else None
    for part, holds, lost in zip(progress.goal.parts, progress.has, progress.lost, strict=False):
        assert home is not None
        yield {"text": part_words(part, home), "classes": [], "ban": part.join in BANS, "holds": holds, "lost": lost}


def part_words(part: Joined, home: Home) -> str:
    """Return a joined part of a goal for people: `Never open the fridge`."""
    goal = part.goals[0]
    alone = goal.counts[0][0] if len(goal.counts) == 1 and not goal.parts else None
    act = acted(alone, home.knowledge) if alone is not None and goal.counts[0][1] == 1 else None
    if part.join in ("not", "never") and act is not None:
        return f"Never {act}"
    return instruction(Goal(parts=(part,)), home.knowledge, terse=True)


def goal_words(literal: Any, home: Home) -> str:
    """Return a literal of a goal for people: `Put plate on dining table`."""
    agent = bool(literal.terms) and str(literal.terms[0]).partition(":")[0] == AGENT
    said = (HOLDS, "ON") if agent else ("ON", "INSIDE")
    if literal.negated or len(literal.terms) != 2 or literal.name not in said or literal.target == AGENT:
        return instruction(Goal.of(literal), home.knowledge, terse=True)
    names = [_name(term, home) for term in literal.terms]
    if agent:
        return say("verbs", "Hold" if literal.name == HOLDS else "SitOn", thing=names[1])
    return say("verbs", "PutIn" if literal.name == "INSIDE" else "PutBack", thing=names[0], place=names[1])


def _name(term: Any, home: Home) -> str:
    if isinstance(term, int):
        name = home.classes[home.index[term]]
    else:
        found = home.instances(term) if term.partition(":")[0] != AGENT else 0
        name = home.classes[lowest(found)] if found else term
    return thing_name(label(name))
