"""Programs of several characters get what the home lacks."""

import pytest

from hearth.grounding.grounded_run import attempt
from hearth.kb import action_grammar
from hearth.schemas.failures import Failure
from hearth.schemas.syntax import parse_program

PARTY = """Juice
Two people have juice.


<char0> [Walk] <apple_juice> (1) | <char1> [Walk] <apple_juice> (2)
<char0> [Grab] <apple_juice> (1) | <char1> [Grab] <apple_juice> (2)
<char0> [Drink] <apple_juice> (1) | <char1> [Drink] <apple_juice> (2)
"""


@pytest.fixture
def party(knowledge, maple):
    thing = next(n for n, c in sorted(knowledge.objects.items())
                 if {"GRABBABLE", "DRINKABLE"} <= set(c.properties) and knowledge.placements(n)
                 and n not in maple.by_class and knowledge.same_class(n)[0] == n)  # fmt: skip
    program, faults = parse_program(PARTY.replace("apple_juice", thing))
    program, wrong = action_grammar.check(program, knowledge)
    assert not faults and not wrong
    return program


def test_what_two_need_is_added(maple, party):
    trial = attempt(party, maple, seed=1)
    assert not isinstance(trial, Failure), trial
    assert trial.execution.executable and len(trial.execution.worlds[0].agents) == 2
    nodes = {ref.key: ref.node for ref in trial.execution.program.objects()}
    assert len(set(nodes.values())) == len(nodes)
    assert trial.environment is not None and trial.environment.nodes


def test_nothing_is_added_where_that_is_not_wanted(maple, party):
    found = attempt(party, maple, add=False)
    assert isinstance(found, Failure) or found.environment is None
