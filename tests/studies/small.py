"""A study small enough to be simulated in a test."""

from hearth.kb.loading.load import default
from hearth.studies.simulated_study import simulated_study
from hearth.studies.study_file import study_of
from hearth.studies.study_simulation import Crowd

SMALL = """
name: small
title: A small study
room: play
seed: 3
people: 4
consent: You may stop at any time.
tutorial:
- {title: The home, text: You act for a person.}
practice: 1
tasks: {challenge: owah, split: test, number: 4}
conditions:
- {name: alone, title: Alone}
- {name: hp_rg, title: HP_RG, helper: hp_random, goal: random}
at_least: 1
questions:
- {name: helpful, text: How helpful was it?, scale: {from: 1, to: 7, labels: {1: hurting, 7: helpful}}, after: helped}
exit:
- {name: age, text: How old are you?, choices: [young, old], required: false}
- {name: comments, text: What else?, required: false}
"""


def small():
    return study_of(SMALL, "small.yaml")


def simulated(out, workers=1, drop_outs=1, seed=0):
    return simulated_study(small(), Crowd(seed, drop_outs), out, default, workers)
