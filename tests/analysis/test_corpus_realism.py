"""One corpus compared with another: equal ones can't be distinguished, others can."""

from __future__ import annotations

import json
from collections import Counter

import pytest
from typer.testing import CliRunner

from hearth.analysis import corpus_realism as numbers
from hearth.analysis.ngrams import WittenBell
from hearth.cli import app
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.rng import rng


def corpus(count, names, seed=0):
    """Programs that fetch one of some things and put it somewhere."""
    chance = rng(seed, "test")
    found = []
    for number in range(count):
        thing = chance.choice(names)
        steps = (f"Walk {thing}", f"Grab {thing}", "Walk table", f"PutBack {thing} table")
        found.append(numbers.Sample(f"activity {number % 6}", steps[: chance.randint(2, 4)], ("take", "the", thing)))
    return found


def test_probabilities_of_all_steps_sum_to_one_after_any_history():
    vocabulary = {"a", "b", "c"}
    model = WittenBell([("a", "b"), ("a", "c", "b")], vocabulary, order=3)
    for history in ((), ("a",), ("a", "b"), ("c", "c")):
        assert sum(model.probability(each, history) for each in (*vocabulary, "<end>")) == pytest.approx(1)


def test_witten_bell_by_hand():
    model = WittenBell([("a", "a")], {"a"}, order=1)
    # Two `a` and one end: two kinds in three tokens; the rest is shared by two kinds.
    assert model.probability("a", ()) == pytest.approx((2 + 2 * 0.5) / 5)


def test_divergence_is_in_bits_between_0_and_1():
    assert numbers.divergence(Counter(a=2, b=2), Counter(a=1, b=1)) == pytest.approx(0)
    assert numbers.divergence(Counter(a=2), Counter(b=5)) == pytest.approx(1)


def test_a_corpus_of_the_same_kind_has_ratios_near_1_and_another_has_not():
    names = [f"thing{number}" for number in range(12)]
    theirs = corpus(80, names)
    same = numbers.compare(corpus(90, names, seed=1), theirs, draws=6)
    other = numbers.compare(corpus(90, ["rock", "cloud"], seed=1), theirs, draws=6)
    assert same["step perplexity"]["ratio"]["mean"] == pytest.approx(1, abs=0.25)
    assert other["step perplexity"]["ratio"]["low"] > 2
    assert other["unseen instructions"]["ours"]["mean"] > 0.5 > same["unseen instructions"]["ours"]["mean"]


def test_halves_by_activity_share_none():
    first, second = numbers._halves(corpus(60, ["a", "b"]), rng(0, "x"), by_activity=True)
    assert not {one.activity for one in first} & {one.activity for one in second}
    assert len(first) + len(second) == 60


def test_too_few_programs_are_an_error():
    with pytest.raises(HearthError, match="2 programs"):
        numbers.compare(corpus(2, ["a"]), corpus(20, ["a"]))


def test_one_activity_has_no_halves_by_activity():
    one = [each._replace(activity="only") for each in corpus(8, ["a", "b"])]
    with pytest.raises(HearthError, match="halves by activity need two"):
        numbers.compare(corpus(8, ["a"]), one, draws=2, by_activity=True)
    assert numbers.compare(corpus(8, ["a"]), one, draws=2)


def test_the_command_compares_and_draws(tmp_path):
    source = "data_raw/crowd"
    words = ["corpus", "realism", source, "--against", source, "--draws", "2", "--out", str(tmp_path), "--json"]
    result = CliRunner().invoke(app, words)
    assert result.exit_code == 0, result.output
    found = json.loads(result.stdout)
    # Drawn from all of it, a half knows part of the other half.
    assert found["measures"]["step perplexity"]["ratio"]["mean"] < 1
    assert found["portraits"]["ours"] == found["portraits"]["theirs"]
    assert (tmp_path / "realism.png").stat().st_size > 10_000


def test_the_other_corpus_has_to_be_given():
    assert CliRunner().invoke(app, ["corpus", "realism"]).exit_code == 2
