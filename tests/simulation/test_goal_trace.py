"""Goals about actions, alternatives and order: read from text, and judged over runs as slowly read ones are."""

from __future__ import annotations

import random
from itertools import pairwise

import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st
from oracles.goals import PlainRun
from small_worlds import random_graph

import hearth
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Failure
from hearth.schemas.goals import Goal, Joined
from hearth.schemas.literals import Literal
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.simulation.actions.legal import legal
from hearth.simulation.engine import act, run
from hearth.simulation.goal_text import read_goal
from hearth.simulation.goals import Progress
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

KNOWLEDGE = default()
SMALL = [Home.from_graph(random_graph(random.Random(seed)), "", KNOWLEDGE) for seed in range(24)]
USED = {"Walk", "Open", "Close", "Sit", "StandUp", "SwitchOn", "SwitchOff", "Grab", "LookAt", "Find"}
WATCH_TV = "[Walk] <television> (1)\n[SwitchOn] <television> (1)\n[Walk] <sofa> (1)\n[Sit] <sofa> (1)\n" \
           "[Watch] <television> (1)"  # fmt: skip


def ran(home, text):
    program = hearth.parse_program(f"T\n\n\n{text}\n")
    world = World.start(home)
    bound = hearth.bind(program, world)
    assert not isinstance(bound, Failure), bound.message()
    return run(world, bound.apply(program))


@pytest.mark.parametrize(
    ("goal", "reached"),
    [
        ("LOOKAT or WATCH", True),
        ("LOOKAT|WATCH", True),
        ("WATCH(television)", True),
        ("WATCH(tv)", True),
        ("WATCH(sofa)", False),
        ("GRAB or DRINK", False),
        ("WALK: 2", True),
        ("WALK: 3", False),
        ("WATCH(agent, television)", True),
        ("SIT(agent:0) and not GRAB", True),
        ("SWITCHON then WATCH", True),
        ("WATCH then SWITCHON", False),
        ("SWITCHON(television) then SIT(sofa) then WATCH(television)", True),
        ("SIT(sofa) then SWITCHON(television) then WATCH(television)", False),
        ("ON(television) then SITTING(agent)", True),
        ("SITTING(agent) then ON(television)", False),
        ("SITTING(agent) then WATCH", True),
        ("WATCH then SITTING(agent)", True),
        ("WATCH then ON(television) and SITTING(agent)", True),
        ("ON(television) then SITTING(agent) or OPEN(fridge)", True),
        ("(SITTING(agent) or OPEN(fridge)) then ON(television)", False),
        ("ON(television) then not SITTING(agent)", False),
        ("exists x0. ((LOOKAT(x0) or WATCH(x0))) then (ON(television) and SITTING(agent))", True),
        ("exists x. (SWITCHON(x) then WATCH(x))", True),
        ("exists x. (SIT(x) then WATCH(x))", False),
        ("exists x. (exists y. (SIT(x) and WATCH(y)))", True),
        ("forall x. (not WATCH(x) or ON(x))", True),
        ("forall x. (WATCH(x))", False),
        ("OPEN(fridge)", False),
        ("[Open](fridge)", False),
        ("CLOSED(fridge) and not [Close](fridge)", True),
        ("never GRAB", True),
        ("never OPEN(fridge) and WATCH", True),
        ("never ON(television)", False),
        ("always CLOSED(fridge)", True),
        ("always ON(television)", False),
        ("always not OPEN(fridge) and SITTING(agent)", True),
        ("SWITCHON then always ON(television)", True),
        ("ON(television) then always ON(television)", True),
        ("ON(television) then never SITTING(agent)", False),
        ("ON(television) then never OPEN(fridge) and SITTING(agent)", True),
        ("SITTING(agent) then never OPEN(fridge) and ON(television)", False),
        ("ON(television) within 2", True),
        ("ON(television) within 1", False),
        ("ON(television) then SITTING(agent) within 2", True),
        ("ON(television) then SITTING(agent) within 1", False),
        ("ON(television) then ON(television) within 9", False),
        ("SWITCHON then ON(television) within 0", True),
        ("(SWITCHON then SIT) within 4 and WATCH within 5", True),
        ("not (SITTING(agent) within 3)", True),
        ("exists x. (SWITCHON(x) within 2)", True),
        ("forall x. (never GRAB(x))", True),
        ("exists x. (never SIT(x) and WATCH(x))", True),
    ],
)
def test_watching_television(maple, goal, reached):
    progress = Progress.of(read_goal(goal, maple), ran(maple, WATCH_TV))
    assert progress.satisfied == reached
    assert progress.unmet() == Goal() if reached else progress.fraction < 1
    assert Progress.start(read_goal(goal, maple), World.start(maple)).satisfied == goal.startswith(
        ("CLOSED", "forall x. (n", "never GRAB", "never ON", "always CLOSED", "not (")
    )


def test_a_state_that_held_before_is_reached_when_it_holds_again(maple):
    things = ("[Walk] <television>", "[SwitchOn] <television>", "[Walk] <fridge>", *(f"[{each}] <fridge>" for each in (
        "Open", "Close", "Open")))  # fmt: skip
    whole = ran(maple, "\n".join(f"{each} (1)" for each in things))
    goal = read_goal("OPEN(fridge) then ON(television) and OPEN(fridge)", maple)
    reached = [Progress.of(goal, run(whole.worlds[0], whole.program.with_steps(whole.program.steps[:number]))).satisfied
               for number in range(7)]  # fmt: skip
    # After four steps both hold for the first time at once; the second is reached when the fridge is open again.
    assert reached == [False] * 6 + [True]


def test_a_record_of_the_embodied_agent_interface(maple):
    execution = ran(maple, WATCH_TV)
    me, nodes = maple.ids[maple.agents[0]], {ref.name: ref.node for ref in execution.program.objects()}
    tv, sofa = nodes["television"], nodes["sofa"]
    facts = [{"id": tv, "class_name": "television", "state": "ON"},
             {"from_id": me, "relation_type": "ON", "to_id": sofa}]  # fmt: skip
    record = {"actions": ["SWITCH ON", "LOOKAT|WATCH"], "goal": facts}
    text = f"(exists x0. (SWITCHON(x0)) then exists x0. ((LOOKAT(x0) or WATCH(x0))) then (ON(television.{tv}) and\n" \
           f"    ONTOP(character.{me}, couch.{sofa})))"  # fmt: skip
    for one in (record, {"vh_goal": record}, {"vh_goal": record, "tl_goal": text}, text):
        assert Progress.of(read_goal(one, maple), execution).satisfied
    back = record | {"actions": record["actions"][::-1]}
    assert not Progress.of(read_goal(back, maple), execution).satisfied
    for wrong in ({}, {"actions": 3, "goal": []}, {"actions": [], "goal": [{"id": 1}]}, {"vh_goal": 7}):
        with pytest.raises(HearthError, match="BAD_JSON"):
            read_goal(wrong, maple)


@pytest.mark.parametrize(
    ("text", "code", "place", "message"),
    [
        ("", "SYNTAX", (1, 1), "found `the end`"),
        ("WATCH and", "SYNTAX", (1, 10), "found `the end`"),
        ("ON(television", "SYNTAX", (1, 14), "expected )"),
        ("ON(television))", "SYNTAX", (1, 15), "`)` is too much"),
        ("WATCH $", "SYNTAX", (1, 7), "cannot read `$`"),
        ("ON(television): 0", "SYNTAX", (1, 17), "expected a count"),
        ("ON(television): ٣", "SYNTAX", (1, 17), "cannot read"),
        ("WATCH\n  and SHINY(cup)", "SYNTAX", (2, 7), "SHINY is not a known state"),
        ("UNDER(cup, table)", "SYNTAX", (1, 1), "UNDER is not a known relation"),
        ("LOKAT or WATCH", "UNKNOWN_ACTION", (1, 1), "`LOKAT` is not a known action"),
        ("ON(plte, sofa)", "UNKNOWN_OBJECT", (1, 4), "`plte` is not a known class"),
        ("ON(cup, television.3)", "UNKNOWN_OBJECT", (1, 9), "the home has no `television.3`"),
        ("ON(9999999, sofa)", "UNKNOWN_OBJECT", (1, 4), "no node 9999999"),
        ("WATCH(agent:4, tv)", "UNKNOWN_AGENT", (1, 7), "no agent:4"),
        ("WATCH(tv, tv)", "WRONG_ARITY", (1, 1), "has 2 objects and takes 1"),
        ("exists x. (WATCH(x)) then READ(x)", "UNKNOWN_OBJECT", (1, 32), "`x` is not a known class"),
        ("exists x. (exists y. (exists z. (READ(z))))", "SYNTAX", (1, 30), "more than 2 variables"),
        ("never OPEN(fridge) then GRAB(milk)", "SYNTAX", (1, 1), "always and never are about the time up to the end"),
        ("WATCH and (not (always OPEN(fridge))) then GRAB", "SYNTAX", (1, 1), "about the time up to the end"),
        ("WATCH within", "SYNTAX", (1, 13), "expected a number of ticks"),
        ("WATCH within x", "SYNTAX", (1, 14), "expected a number of ticks"),
        ("WATCH within 9999999", "SYNTAX", (1, 14), "at most 10,000"),
        ("WATCH\n and never SHINY(cup)", "SYNTAX", (2, 12), "SHINY is not a known state"),
        ("never " * 10_000, "SYNTAX", (1, 241), "more than 40 parts within one another"),
        ("(" * 10_000, "SYNTAX", (1, 41), "more than 40 parts within one another"),
        ("not " * 10_000, "SYNTAX", (1, 161), "more than 40 parts within one another"),
    ],
)
def test_faults_have_their_place(maple, text, code, place, message):
    with pytest.raises(HearthError) as caught:
        read_goal(text, maple, "goal.txt")
    (fault,) = caught.value.diagnostics
    assert (str(fault.code), (fault.line, fault.column)) == (code, place)
    assert message in fault.message and fault.file == "goal.txt"


def random_run(seed: int, length: int) -> tuple[World, list[Step]]:
    """Random steps that can be done, few actions and objects so that some recur."""
    rng = random.Random(seed)
    start = world = World.start(rng.choice(SMALL))
    steps: list[Step] = []
    while len(steps) < length:
        could = legal(world)
        action = rng.choice(sorted(USED & {*could.masks}))
        nodes = [rng.choice(could.objects(action, place)[:40]) for place in range(len(could.masks[action]))]
        names = [world.home.classes[world.home.index[node]] for node in nodes]
        step = Step(action, tuple(ObjectRef(name, 1, node) for name, node in zip(names, nodes, strict=True)))
        after = act(world, step)
        if isinstance(after, World):
            steps.append(step)
            world = after
    return start, steps


def random_goal(rng: random.Random, start: World, final: World, steps: list[Step], depth: int, variables: int) -> Goal:
    """A goal about what the run did and changed, so that it is often reached."""
    spans = ("always", "never", "within")
    kinds = ("literal",) * 3 + ("and", "or", "then", "then", "not", "exists", *spans)
    kind = rng.choice(kinds) if depth else "literal"
    if kind == "literal":
        return random_literal(rng, start, final, steps, variables)
    several = kind in ("and", "or", "then")
    more = variables + (kind == "exists" and variables < 2)
    goals = [
        random_goal(rng, start, final, steps, depth - 1, more) for _ in range(rng.choice((2, 3)) if several else 1)
    ]
    if kind == "and":
        return Goal(sum((goal.counts for goal in goals), ()), sum((goal.parts for goal in goals), ()))
    if kind == "exists":
        return Goal(parts=(Joined(kind, tuple(goals), f"?x{variables}"),)) if more > variables else goals[0]
    if kind == "then" and any(goal.lasts for goal in goals[:-1]):
        return goals[-1]  # such a goal is a fault of its text
    return Goal(parts=(Joined(kind, tuple(goals), ticks=rng.randint(0, 5) if kind == "within" else 0),))


def random_literal(rng: random.Random, start: World, final: World, steps: list[Step], variables: int) -> Goal:
    change = final.changes(start)
    index, home = start.home.index, start.home

    def term(node: int) -> str | int:
        options = [
            node,
            "agent" if index[node] in home.agents else home.classes[index[node]],
            *(f"?x{number}" for number in range(variables)),
        ]
        return rng.choice(options)

    kind = rng.choice(("action", "action", "state", "relation"))
    if kind == "state" and change.set_states:
        node, name = rng.choice(change.set_states)
        return Goal.of((Literal.of(name, term(node)), rng.choice((1, 1, 1, 2))))
    if kind == "relation" and change.added:
        edge = rng.choice(change.added)
        return Goal.of(Literal.of(edge.relation, term(edge.source), term(edge.target)))
    step = rng.choice(steps)
    terms = tuple(term(ref.node) for ref in step.objects)[: rng.choice((0, 2, 2))]
    agent = ("agent",) if rng.random() < 0.2 else ()
    return Goal.of((Literal(step.action, agent + terms), rng.choice((1, 1, 1, 2))))


@settings(max_examples=25, phases=[Phase.generate], deadline=None)
@given(st.integers(0, 1 << 32))
def test_goals_are_reached_as_they_are_read_slowly(seed):
    rng = random.Random(seed)
    start, steps = random_run(seed, rng.randint(3, 9))
    execution = run(start, Program(steps=tuple(steps)))
    plain = PlainRun.of([world.graph() for world in execution.worlds], list(execution.program.ticks()), KNOWLEDGE)
    for _ in range(4):
        goal = random_goal(rng, start, execution.final, steps, 3, 0)
        expected = [plain.reached(goal, 0, now) for now in range(len(steps) + 1)]
        progress = Progress.start(goal, start)
        found = [progress.satisfied]
        for (before, world), step in zip(pairwise(execution.worlds), steps, strict=True):
            progress = progress.after(world, world.changes(before), (step,))
            found.append(progress.satisfied)
        assert found == expected, str(goal)
        assert Progress.of(goal, execution).satisfied == expected[-1]


@settings(max_examples=60, phases=[Phase.generate], deadline=None)
@given(st.integers(0, 1 << 32))
def test_a_goal_printed_is_read_again(seed):
    rng = random.Random(seed)
    start, steps = random_run(seed, 3)
    final = run(start, Program(steps=tuple(steps))).final
    goal = random_goal(rng, start, final, steps, 3, 0)
    again = read_goal(str(goal), start.home)
    assert again == read_goal(str(again), start.home)
    if "?" not in repr(goal):
        assert str(again) == str(goal)


@settings(max_examples=20, phases=[Phase.generate], deadline=None)
@given(st.integers(0, 1 << 32))
def test_what_was_done_was_done_in_its_order(seed):
    start, steps = random_run(seed, 6)
    execution = run(start, Program(steps=tuple(steps)))
    goals = [Goal.of(Literal(step.action, tuple(ref.node for ref in step.objects))) for step in steps]
    assert Progress.of(Goal(parts=(Joined("then", tuple(goals)),)), execution).satisfied
    for first, second in pairwise(goals):
        if goals.count(first) == goals.count(second) == 1:
            assert not Progress.of(Goal(parts=(Joined("then", (second, first)),)), execution).satisfied


@pytest.mark.parametrize(
    ("goal", "reached"),
    [
        ("ON(television) then (CLOSED(fridge) or SITTING(agent)) then WATCH", True),
        ("ON(television) then (CLOSED(fridge) or LYING(agent)) then WATCH", False),
        ("ON(television) then (OPEN(fridge) and (SITTING(agent) or LYING(agent))) then WATCH", False),
        ("ON(television) then (ON(television) and (SITTING(agent) or LYING(agent))) then WATCH", True),
    ],
)
def test_of_alternatives_one_must_begin_to_hold(maple, goal, reached):
    """One of them held before: the fridge is closed all the time."""
    assert Progress.of(read_goal(goal, maple), ran(maple, WATCH_TV)).satisfied == reached


def test_a_goal_of_more_parts_than_anybody_wants_is_refused(maple):
    with pytest.raises(HearthError, match="more than 1,000"):
        read_goal(" and ".join(["ON(plate, table)"] * 1_001), maple)


@pytest.mark.parametrize(("text", "meant"), [("HOLD(agent, cup)", "HOLDS"), ("OPENED(fridge)", "OPEN")])
def test_misspelt_relations_and_states_are_guessed(maple, text, meant):
    with pytest.raises(HearthError) as caught:
        read_goal(text, maple)
    assert caught.value.diagnostics[0].suggestion == f"did you mean `{meant}`?"
