"""SyntheticPrograms: as many as asked for, distinct, the same for a seed, in the thesis's proportions, and they run."""

import json
import re
from itertools import combinations

import pytest
from typer.testing import CliRunner

from hearth.analysis import synthesis, synthesis_splits, synthesis_wording
from hearth.analysis.written_descriptions import described
from hearth.cli import app
from hearth.datasets.dataset import Dataset
from hearth.datasets.format.near_duplicates import near_texts
from hearth.datasets.format.split_columns import NEAR, normalised
from hearth.grounding.environments.sampling import sample
from hearth.kb import action_grammar as action_grammar
from hearth.models.text_examples import corpus
from hearth.pipelines.build import build
from hearth.pipelines.checks.meaning_checks import contradictions
from hearth.pipelines.readers.published_dataset import read, scan
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.rng import rng
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
    sentences = sum(len(re.findall(r"[.!](?:\s|$)", text)) for text in texts) / len(texts)
    words = sum(len(text.split()) for text in texts) / len(texts)
    assert steps == pytest.approx(9.6, rel=0.1)
    assert sentences == pytest.approx(3.4, rel=0.1)
    assert words == pytest.approx(20.5, rel=0.1)


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


NAP = """
plan: {1: 1}
join: 0
first: 0
described: 1
tasks:
  nap:
    weight: 1
    titles: [Nap]
    choose: {bed: {bed: 1, sofa: 1}}
    parts:
    - {steps: [Walk bed], say: ["go to the {bed}"]}
"""


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("{1: 1}", "{}"),
        ("{1: 1}", "{x: 1}"),
        ("{1: 1}", "{0: 1}"),
        ("{1: 1}", "{1: .inf}"),
        ("weight: 1", "weight: 0"),
        ("weight: 1", "weight: .nan"),
        ("[Nap]", "[]"),
        ("[Nap]", "[7]"),
        ("{bed: 1, sofa: 1}", "{}"),
        ("[Walk bed]", "[]"),
        ("[Walk bed]", "['']"),
        ('["go to the {bed}"]', "[]"),
        ("{bed}", "{chair}"),
        ("{bed}", "<nothing>"),
        ("the {bed}", "a < b"),
    ],
)
def test_a_grammar_from_which_nothing_could_be_drawn_is_refused(knowledge, tmp_path, old, new):
    file = tmp_path / "g.yaml"
    file.write_text(NAP)
    assert len(list(synthesis.synthesize(2, 0, synthesis.load(file, knowledge)))) == 2
    file.write_text(NAP.replace(old, new))
    with pytest.raises(HearthError, match=r"BAD_TABLE|EMPTY"):
        synthesis.load(file, knowledge)


def test_a_plan_of_more_tasks_than_there_are_ends(knowledge, tmp_path):
    (tmp_path / "g.yaml").write_text(NAP.replace("{1: 1}", "{3: 1}"))
    (found,) = synthesis.synthesize(1, 0, synthesis.load(tmp_path / "g.yaml", knowledge))
    assert found.tasks == ("nap",)


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


def test_words_are_many_and_word_orders_are_not_repeated(drawn):
    found = synthesis_splits.figures(drawn[0])
    assert found["tasks"] >= 60 and set(found["programs_by_tasks"]) == {1, 2, 3}
    assert found["word_types"] >= 1_500 and found["word_types_used_three_times"] >= 1_300
    assert found["distinct_4_grams"] >= 0.5


@pytest.fixture(scope="module")
def split(drawn):
    programs = drawn[0][:1_500]
    parts = {}
    for row in synthesis_splits.splits(programs):
        parts.setdefault(row.split, {}).setdefault(row.part, []).append((programs[row.program - 1], row.description))
    return parts


def held_out(split, names):
    """Names of test programs that no program in train has, and the share of test programs with one."""
    train = {name for one, _ in split["train"] for name in names(one)}
    shares = [bool(set(names(one)) - train) for one, _ in split["test"]]
    return sum(shares) / len(shares)


def test_what_a_split_holds_out_is_in_the_test_part_alone(split):
    assert held_out(split["tasks"], lambda one: one.tasks) == 1
    assert held_out(split["pairs"], lambda one: list(combinations(sorted(one.tasks), 2))) == 1
    assert held_out(split["objects"], lambda one: [name for _, names in one.steps for name in names]) == 1
    assert all(one.held_out[place] for one, place in split["paraphrases"]["test"])
    assert not any(one.held_out[place] for one, place in split["paraphrases"]["train"])
    # Each task of a held-out pair is in train, with others.
    train = {task for one, _ in split["pairs"]["train"] for task in one.tasks}
    assert train >= {task for one, _ in split["pairs"]["test"] for task in one.tasks}


def test_no_near_duplicates_are_in_two_parts(split):
    for parts in split.values():
        test = [normalised(one.descriptions[place]) for one, place in parts["test"]]
        train = [normalised(one.descriptions[place]) for one, place in parts["train"]]
        texts = sorted({*test, *train})
        for one, other in near_texts(texts, NEAR):
            pair = {texts[one], texts[other]}
            assert not (pair & set(test) and pair & set(train))
        assert not set(test) & set(train)


def test_every_paraphrase_of_a_part_is_held_out_or_not_for_any_seed():
    say = ["take the {thing}", "get the {thing}", "grab the {thing}", "lift the {thing}", "fetch the {thing}"]
    out = [each for each in say if synthesis_wording.is_held_out(each)]
    drawn = {synthesis_wording.paraphrase(say, True, rng(seed, "x")) for seed in range(30)}
    assert drawn == set(out or say)


def test_a_pronoun_stands_for_the_last_thing_alone(knowledge):
    words = synthesis_wording.load_words(knowledge)
    for seed in range(40):
        speaker = synthesis_wording.Speaker(words, False, rng(seed, "pronouns"))
        first = speaker.clause("put it on the {spot}", {"cup": "cup", "spot": "table"}, "cup")
        assert not re.search(r"\bit\b", first), first
        assert "cup" in first


def test_a_typing_error_changes_one_word():
    text = "Take the kettle from the cupboard."
    for seed in range(30):
        other = synthesis_wording.mistyped(text, rng(seed, "typing"))
        assert sum(a != b for a, b in zip(text.split(), other.split(), strict=True)) <= 1


def test_words_with_an_unknown_list_are_an_error(knowledge, tmp_path):
    page = synthesis_wording.WORDS.read_text().replace("- for <person>\n", "- for <nobody>\n")
    (tmp_path / "words.yaml").write_text(page)
    with pytest.raises(HearthError, match="unknown list `nobody`"):
        synthesis_wording.load_words(knowledge, tmp_path / "words.yaml")


def test_the_command_writes_the_splits(tmp_path):
    words = ["--out", str(tmp_path / "s.jsonl"), "--splits", str(tmp_path / "s.csv"), "--json"]
    done = CliRunner().invoke(app, ["corpus", "synthesize", "40", *words])
    assert done.exit_code == 0, done.output
    rows = (tmp_path / "s.csv").read_text().splitlines()
    assert rows[0] == "split,program_id,description,part"
    found = json.loads(done.stdout)
    assert len(rows) - 1 == 4 * found["descriptions"] and set(found["splits"]) == set(synthesis_splits.SPLITS)
    records = list(map(json.loads, (tmp_path / "s.jsonl").read_text().splitlines()))
    of_first = {
        f"{split},{one['program_id']},0,{part or ''}" for one in records for split, part in one["splits"].items()
    }
    assert of_first == {row for row in rows if row.split(",")[2] == "0"}


def test_a_dataset_of_drawn_programs_has_their_splits(tmp_path):
    words = ["corpus", "synthesize", "30", "--out", str(tmp_path / "s.jsonl")]
    assert CliRunner().invoke(app, words).exit_code == 0
    build([str(tmp_path / "s.jsonl")], str(tmp_path / "out"), pictures=0, homes_each=1)
    dataset = Dataset.open(tmp_path / "out/publish")
    rows = dataset.rows("SELECT DISTINCT split, program_id, part FROM splits")[1]
    published = {(split, name): part for split, name, part in rows if split in synthesis_splits.SPLITS}
    records = {one["program_id"]: one for one in map(json.loads, (tmp_path / "s.jsonl").read_text().splitlines())}
    originals = {name: part for name, part in published.items() if name[1] in records}
    assert len(originals) > 60
    assert all(records[name]["splits"][split] == part for (split, name), part in originals.items())
    assert len(published) > len(originals)  # augmented ones, too
    ingested = {row["program_id"]: row["parts"] for item in scan(tmp_path / "out/publish", "out") for row in read(item)}
    again = {(one["split"], name): one["part"] for name, parts in ingested.items() for one in parts or ()}
    assert again == originals, "a dataset that is built from this one has them, too"
    found = corpus(dataset, "pairs")
    assert {each.program_id for each in found.validation} == {
        name for (split, name), part in originals.items() if (split, part) == ("pairs", "validation")
    }
