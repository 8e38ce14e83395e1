"""Every door knows every state of action set 3: it shows, explains, refuses or repairs it, or the table fails."""

import re

import pytest

from hearth.envs.json_observations import observation
from hearth.envs.observation_arrays import Encoder, Sizes
from hearth.envs.text_agent import description
from hearth.envs.text_layout import layout, said_rows, stated
from hearth.envs.text_protocol_settings import protocol
from hearth.homes import library
from hearth.kb.action_sets import states_of_set
from hearth.kb.loading.load import default
from hearth.kb.tools.pddl import unary_predicates
from hearth.kb.tools.show import about_action
from hearth.repair.remedies import stop_reason
from hearth.schemas.failure_words import why
from hearth.schemas.failures import Code, Failure
from hearth.schemas.literals import Literal
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.schemas.vocabulary import FURTHER_STATES, STATE_ID
from hearth.simulation.actions.legal import legal
from hearth.simulation.change_summary import summary
from hearth.simulation.engine import act, run
from hearth.simulation.env import Env
from hearth.simulation.goal_text import read_goal
from hearth.simulation.goals import Progress
from hearth.simulation.literal_truth import holds
from hearth.simulation.processes import widened
from hearth.simulation.rules import CONSEQUENCES
from hearth.simulation.step_explanations import checks_until, facts
from hearth.simulation.world.edit import edit
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

KNOWN = default().of_set(3)

MADE_BY = {
    "COLD": "fridge_cools", "HOT": "kettle_boils", "RAW": "", "COOKED": "oven_cooks", "BURNT": "oven_burns",
    "EMPTY": "Drink", "FULL": "Pour", "DRY": "Wipe", "WET": "Wash", "UNFOLDED": "Unfold", "FOLDED": "Fold",
    "UNWRAPPED": "Unwrap", "WRAPPED": "Wrap", "UNCOVERED": "Uncover", "COVERED": "Cover", "REPAIRED": "Sew",
    "BROKEN": "Break", "COMBED": "Brush", "SHAVED": "Shave", "CUT": "Cut", "FLUSHED": "Flush", "WRITTEN": "Write",
    "SMEARED": "Spread", "IN_CALL": "Call", "GONE": "Eat", "FINISHED": "kettle_boils", "BEGUN": "Eat",
    "HALF_LEFT": "Eat", "LAST_LEFT": "Drink",
}  # fmt: skip
"""An act or a process that makes each state; only homes and users say that something is RAW."""

STOPS = {
    "BROKEN": (("Break", "cup"), ("Drink", "cup")),
    "COVERED": (("Cover", "bed", "blanket"),),
    "CUT": (("Cut", "food_bread"),),
    "EMPTY": (("Drink", "cup"), ("Pour", "cup", "bowl")),
    "FOLDED": (("Fold", "towel"),),
    "UNCOVERED": (("Uncover", "bed"),),
    "UNFOLDED": (("Unfold", "towel"),),
    "UNWRAPPED": (("Unwrap", "cup"),),
    "WRAPPED": (("Wrap", "cup", "towel"),),
    "GONE": (("Grab", "cup"), ("Walk", "cup"), ("Drink", "cup")),
}
"""The acts that each state stops, and what they are done with."""

SAYS = {
    "BROKEN": "is broken, which nothing undoes",
    "COVERED": "is covered: [Uncover] would change that",
    "CUT": "is cut, which nothing undoes",
    "EMPTY": "is empty: [Pour] would change that",
    "FOLDED": "is folded: [Unfold] would change that",
    "UNCOVERED": "is uncovered: [Cover] would change that",
    "UNFOLDED": "is unfolded: [Fold] would change that",
    "UNWRAPPED": "is unwrapped: [Wrap] would change that",
    "WRAPPED": "is wrapped: [Unwrap] would change that",
    "GONE": "is used up",
}
"""The reason that such an act gives, with the act that would be needed."""


@pytest.fixture(scope="module")
def maple() -> Home:
    return Home.from_graph(library.load_graph("maple", KNOWN), "maple", KNOWN)


@pytest.fixture(scope="module")
def start(maple: Home) -> World:
    return widened(World.start(maple))


def one(home: Home, name: str) -> int:
    return home.ids[next(i for i, each in enumerate(home.classes) if each == name)]


def in_state(world: World, node: int, *states: str) -> World:
    found = edit(world, set=[(node, state) for state in states], check=False)
    assert isinstance(found, World)
    return found


def stopped() -> list[tuple[str, tuple[str, ...]]]:
    return [(state, each) for state, acts in STOPS.items() for each in acts]


def ready(start: World, state: str, names: tuple[str, ...]) -> tuple[World, Step]:
    """The world in which only the state can stop the step, and the step."""
    home = start.home
    nodes = [one(home, name) if name in home.classes else -1 for name in names[1:]]
    if -1 in nodes:
        pytest.skip(f"the home has no {names[1:]}")
    me = home.ids[home.agents[0]]
    world = start
    room = next(e.target for e in world.edges() if e.source == me and e.relation == "INSIDE")
    for node in nodes:
        if home.able("Grab") >> home.index[node] & 1:
            world = edit(world, place={node: ("INSIDE", room)}, check=False)
    links = [(me, "CLOSE", node) for node in nodes] + [(node, "CLOSE", me) for node in nodes]
    world = edit(world, link=links, check=False)
    held = {"Drink": nodes[:1], "Pour": nodes[:1], "Cover": nodes[1:], "Wrap": nodes[1:]}.get(names[0], [])
    if names[0] == "Cut":
        held = [one(home, "knife")]
        world = edit(world, place={held[0]: ("INSIDE", room)}, check=False)
    for node in held:
        world = edit(world, link=[(me, "HOLDS_RH", node), (me, "CLOSE", node)], check=False)
    refs = tuple(ObjectRef(name, 1, node) for name, node in zip(names[1:], nodes, strict=True))
    return world, Step(names[0], refs)


def test_the_tables_name_every_state_and_every_check_of_one():
    assert set(MADE_BY) == set(FURTHER_STATES) and set(SAYS) == set(STOPS)
    checked = {
        (str(check.formula.terms[1].name), action.name)
        for action in KNOWN.actions.values()
        for check in action.preconditions
        if isinstance(check.formula, Literal) and check.formula.name == "state" and check.formula.negated
        if check.formula.terms[0].name == "o" and check.formula.terms[1].name not in STATE_ID
    }
    assert checked == {(state, each[0]) for state, each in stopped() if state != "GONE"}


@pytest.mark.parametrize("state", FURTHER_STATES)
def test_what_makes_a_state_stands_in_the_knowledge(state):
    name = MADE_BY[state]
    if name in KNOWN.actions:
        rows = about_action(KNOWN, KNOWN.actions[name])["set_3"]
        words = "gone(" if state == "GONE" else f", {state})"
        assert any(row["part"] == "effect" and words in row["is"] for row in rows), rows
    elif name:
        assert any(str(effect.literal) == f"state(x, {state})" for effect in KNOWN.processes[name].effects)


@pytest.mark.parametrize("state", FURTHER_STATES)
def test_observations_show_a_state(maple, start, state):
    cup = one(maple, "cup")
    env = Env(rules=CONSEQUENCES, partial=False, knowledge=KNOWN)
    seen = []
    for states in ((), (state,)):
        env.reset(in_state(start, cup, *states))
        view = env.observe(0)
        shown = next(n for n in observation(view)["graph"]["nodes"] if n["id"] == cup)["states"]
        line = re.search(rf"cup {cup}( \([^)]*\))?", description(view))[0]
        encoder = Encoder(Sizes(nodes=len(maple)), ("Walk",), KNOWN)
        rows = encoder.rows(view.world.home)
        slot = list(rows.slots.order).index(maple.index[cup])
        array = encoder.arrays(view, rows)["states"][slot]
        seen.append((state in shown, state.lower() in line, bool(array[states_of_set(3).index(state)])))
        assert encoder.spaces()["states"].shape == (len(maple), len(states_of_set(3)))
    assert seen == [(False,) * 3, (True,) * 3]
    world, place = in_state(start, cup, state), layout(maple, protocol())
    words = stated(place, said_rows(world, maple.everything, place), 0, None).words
    assert words[maple.index[cup]] == f" ({state.lower().replace('_', ' ')})"


@pytest.mark.parametrize("state", FURTHER_STATES)
def test_goals_facts_changes_and_pddl_know_a_state(maple, start, state):
    cup = one(maple, "cup")
    world = in_state(start, cup, state)
    goal = read_goal(f"{state}({cup})", maple)
    assert not Progress.start(goal, start).satisfied and Progress.start(goal, world).satisfied
    assert holds(Literal.of(state, cup), world) and not holds(Literal.of(state, cup), start)
    assert any(state in line for line in facts(world, 0, [cup]))
    assert f"cup ({cup}) is {state}" in summary(world.changes(start), start)
    assert f"is-{state.lower().replace('_', '-')}" in unary_predicates(KNOWN)


@pytest.mark.parametrize(("state", "names"), stopped())
def test_an_act_that_a_state_stops_says_which_act_would_be_needed(start, state, names):
    usual, step = ready(start, state, names)
    others = [each for each, acts in STOPS.items() if each != state for act_ in acts if act_[0] == names[0]]
    assert not isinstance(act(usual, step, CONSEQUENCES), Failure) and step in legal(usual, 0, CONSEQUENCES), others
    node = step.objects[0].node
    world = in_state(usual, node, state)
    if state == "GONE":
        world = edit(world, unlink=[each for each in world.edges() if node in (each.source, each.target)], check=False)
    failure = act(world, step, CONSEQUENCES)
    assert isinstance(failure, Failure) and step not in legal(world, 0, CONSEQUENCES)
    assert SAYS[state] in why(failure), why(failure)
    if state == "GONE":
        return
    assert failure.code is Code.WRONG_STATE
    last = list(checks_until(world, step, CONSEQUENCES, failure))[-1]
    assert not last.held and f", {state})" in last.literal
    said = stop_reason(run(world, Program(steps=(step,)), CONSEQUENCES))
    assert SAYS[state] in said
    repairable = state != "BROKEN" or names[0] == "Break"
    assert ("leave this step out" in said or "first" in said) is repairable, said
