"""SyntheticPrograms: as many as asked for, distinct, the same for a seed, in the thesis's proportions, and they run."""

import json
import re

import pytest
from typer.testing import CliRunner

from hearth.analysis import synthesis
from hearth.analysis.described import described
from hearth.cli import app
from hearth.grounding.environments.sampling import sample
from hearth.kb import grammar as action_grammar
from hearth.pipelines.checks.programs import contradictions
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.syntax import parse_program


@pytest.fixture(scope="module", params=[False, True], ids=["animated", "all"])
def drawn(request, knowledge):
    weights = synthesis.load(synthesis.FILE, knowledge, every_action=request.param)
    return list(synthesis.synthesize(synthesis.DEFAULT_COUNT, 0, weights)), request.param


def program(one, knowledge):
    parsed, faults = parse_program("\n".join(one.lines()) + "\n")
    canonical, wrong = action_grammar.check(parsed, knowledge)
    assert not faults and not wrong and not action_grammar.affordances(canonical, knowledge)
    return canonical


def test_as_many_as_the_thesis_and_no_two_alike(drawn):
    programs, _ = drawn
    assert len({one.steps for one in programs}) == len(programs) == 5_193


def test_only_the_animated_actions_unless_all_are_asked_for(drawn, knowledge):
    programs, every = drawn
    used = {action for one in programs for action, _ in one.steps}
    animated = knowledge.group("animated")
    assert len(animated) == 14
    assert used > animated if every else used == animated


def test_averages_are_near_table_4_1(drawn):
    programs, _ = drawn
    texts = [text for one in programs for text in one.descriptions]
    steps = sum(len(one.steps) for one in programs) / len(programs)
    sentences = sum(len(re.findall(r"\.(?:\s|$)", text)) for text in texts) / len(texts)
    words = sum(len(text.split()) for text in texts) / len(texts)
    assert steps == pytest.approx(9.6, abs=0.5)
    assert sentences == pytest.approx(3.4, abs=0.2)
    assert words == pytest.approx(20.5, abs=1)


def test_programs_are_told_in_several_ways(drawn):
    programs, _ = drawn
    assert sum(len(one.descriptions) > 1 for one in programs) > 0.95 * len(programs)
    assert not any("{" in text or "_" in text or "  " in text for one in programs for text in one.descriptions)


def test_they_are_well_formed_and_run(drawn, knowledge, maple):
    programs, _ = drawn
    for number, one in enumerate(programs[::80]):
        found = program(one, knowledge)
        assert not list(contradictions(found, knowledge))
        result = sample(found, maple, seed=number)
        assert isinstance(result, tuple) and result[1].executable, (one.lines(), result)


def test_a_seed_decides_and_more_begins_with_fewer(knowledge):
    weights = synthesis.load(synthesis.FILE, knowledge)
    fewer, more, other = (list(synthesis.synthesize(n, s, weights)) for n, s in ((20, 3), (40, 3), (20, 4)))
    assert more[:20] == fewer != other


def test_a_faulty_grammar_is_told_where(knowledge, tmp_path):
    file = tmp_path / "g.yaml"
    file.write_text(
        "plan: {1: 1}\njoin: 0\nfirst: 0\ntold: 1\ntasks:\n  nap:\n    weight: 1\n    titles: [Nap]\n"
        "    choose: {bed: {bedd: 1, television: 1}}\n    parts:\n    - {steps: [Lie bed, Fly], say: [sleep]}\n"
    )
    with pytest.raises(HearthError) as caught:
        synthesis.load(file, knowledge)
    assert [str(fault.code) for fault in caught.value.diagnostics] == [
        "UNKNOWN_OBJECT",
        "NOT_AFFORDED",
        "UNKNOWN_ACTION",
    ]
    file.write_text("plan: [")
    with pytest.raises(HearthError, match="BAD_TABLE"):
        synthesis.load(file, knowledge)


def test_a_grammar_too_small_says_so(knowledge, tmp_path):
    file = tmp_path / "g.yaml"
    file.write_text(
        "plan: {1: 1}\njoin: 0\nfirst: 0\ntold: 1\ntasks:\n  nap:\n    weight: 1\n    titles: [Nap]\n"
        "    choose: {bed: {bed: 1}}\n    parts:\n    - {steps: [Walk bed], say: [go to bed]}\n"
    )
    with pytest.raises(HearthError, match="1 different programs"):
        list(synthesis.synthesize(2, 0, synthesis.load(file, knowledge)))


def test_the_command_writes_what_ingest_reads(tmp_path):
    file = tmp_path / "s.jsonl"
    done = CliRunner().invoke(app, ["corpus", "synthesize", "30", "--seed", "5", "--out", str(file)])
    assert done.exit_code == 0, done.output
    arguments = ["ingest", str(file), "--out", str(tmp_path / "out"), "--workers", "1", "--json"]
    counts = json.loads(CliRunner().invoke(app, arguments).stdout)["stages"]["ingest"]
    assert counts["tally"]["program"] == 30 and counts["tally"]["description"] >= 25
    assert counts["rejected"] == 0


def test_described_programs_are_animated_each_in_words_of_its_own(knowledge):
    records = list(described())
    programs = [parse_program("\n".join([one["title"], "", *one["steps"]])) for one in records]
    assert not [faults for _, faults in programs if faults]
    assert {step.action for program, _ in programs for step in program.steps} <= knowledge.group("animated")
    assert len({tuple(one["steps"]) for one in records}) == len({one["description"] for one in records}) == 500


def test_described_programs_are_written_and_read(tmp_path):
    file = tmp_path / "described.jsonl"
    done = CliRunner().invoke(app, ["corpus", "synthesize", "--described", "--out", str(file)])
    assert done.exit_code == 0 and "500 programs" in done.output, done.output
    arguments = ["ingest", str(file), "--out", str(tmp_path / "out"), "--workers", "1", "--json"]
    counts = json.loads(CliRunner().invoke(app, arguments).stdout)["stages"]["ingest"]
    assert counts["tally"]["program"] == 500 and counts["rejected"] == 0
