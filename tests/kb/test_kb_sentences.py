"""The steps that one sentence asks for, and the sentences that ask for none."""

import gzip
from pathlib import Path

import lemminflect
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hearth.kb.language.english_lexicon import foreign_language, is_english, is_noun, is_verb, verb_lemmas
from hearth.kb.language.noun_phrases import thing_of
from hearth.kb.language.numbered_steps import parse_steps
from hearth.kb.language.reading_modes import Fuzzy
from hearth.kb.language.sentences import asked_steps
from hearth.kb.language.step_phrases import say
from hearth.kb.language.step_understanding import understand
from hearth.schemas.syntax import print_lines


def read(knowledge, *steps, fuzzy=Fuzzy.TYPOS):
    text = "Task: T\n" + "".join(f"Step {number}: {step}\n" for number, step in enumerate(steps, 1))
    found = parse_steps(text, 0, "a.txt", knowledge, fuzzy)
    return list(print_lines(found.program)), found


@pytest.mark.parametrize(
    "sentence",
    [
        # Verbs that are English but not ours.
        "Heat the salmon", "Bake the bread", "Fry the fish", "Lock the window", "Feed the cat", "Bring the book",
        "Hit the window", "Load the dishwasher", "Serve the bread", "Plug the toaster", "Taste the bread",
        "Hug the cat", "Cook the salmon.", "Toast the bread", "Kick the ball", "Paint the chair", "Call the cat",
        # Nouns that are English but not ours.
        "Find the cutlery", "Find the switch", "Find a soda", "find cloth", "Walk to the rocket",
        "Grab the elephant", "Grab the lettuce", "Grab the boot polish", "Open the packet",
        # A verb that wants two things, with one; a place that is not known; what turns the act round.
        "put microwave", "put desk", "put garbagecan", "Take the towel off of the holder.", "put the milk in the zorb",
        "Don't open the fridge", "Never open the fridge", "Open the fridge without the milk",
        "Grab the cup instead of the plate", "Grab the cup or the plate", "Pull the chair to the table",
    ],
)  # fmt: skip
def test_what_is_not_understood_is_refused(knowledge, sentence):
    lines, found = read(knowledge, sentence)
    assert not lines and not found.warnings
    assert [fault.code for fault in found.faults] == ["NOT_UNDERSTOOD"]


def test_a_thing_with_two_places_is_refused(knowledge):
    for sentence in ("Put the cd in the bowl on the cabinet", "Put the fork in the cup on the table"):
        lines, found = read(knowledge, sentence)
        assert not lines and [fault.code for fault in found.faults] == ["NOT_UNDERSTOOD"]


def test_hints_are_near(knowledge):
    for sentence, hints in {"Done": 0, "Contemplate life": 0, "Find a soda": 0, "Grab the bowel": 1}.items():
        near = understand(knowledge, sentence).candidates
        assert len(near) == hints and all(each.score >= 0.7 for each in near)


EXACT = {
    "Take the apple out of the fridge": "[Grab] <food_apple> (1)",
    "Get the milk from the fridge": "[Grab] <milk> (1)",
    "pick up the cup from the table": "[Grab] <cup> (1)",
    "remove the milk from the fridge": "[Grab] <milk> (1)",
    "take out the milk": "[Grab] <milk> (1)",
    "pick the cup up": "[Grab] <cup> (1)",
    "Put the cup down": "[Release] <cup> (1)",
    "put down the cup": "[Release] <cup> (1)",
    "Take a seat on the sofa": "[Sit] <sofa> (1)",
    "have a seat on the chair": "[Sit] <chair> (1)",
    "turn the light on": "[SwitchOn] <light> (1)",
    "switch the TV off": "[SwitchOff] <television> (1)",
    "Close the fridge door": "[Close] <fridge> (1)",
    "navigate to the kitchen counter": "[Walk] <kitchen_counter> (1)",
    "head over to the sofa": "[Walk] <sofa> (1)",
    "go back to the bedroom": "[Walk] <bedroom> (1)",
    "move the cup to the table": "[PutBack] <cup> (1) <table> (1)",
    "move the egg to the garbage can": "[PutIn] <food_egg> (1) <garbage_can> (1)",
    "Fill the kettle with water": "[Pour] <water> (1) <kettle> (1)",
    "put the clothes in the washing machine": "[PutIn] <clothes_pile> (1) <washing_machine> (1)",
    "Wash your hands": "[Wash] <hands_both> (1)",
    "walking to the kitchen": "[Walk] <kitchen> (1)",
    "opens the fridge": "[Open] <fridge> (1)",
    "grabbed the plates": "[Grab] <plate> (1)",
    "took the mug from the desk": "[Grab] <mug> (1)",
    "make your way to the kitchen": "[Walk] <kitchen> (1)",
    "grab yourself a beer from the fridge": "[Grab] <beer> (1)",
    "have a sip of the tea": "[Drink] <tea> (1)",
    "take a bite of the sandwich": "[Eat] <sandwich> (1)",
    "take a look at the mirror": "[LookAt] <mirror> (1)",
    "return the rag to its place": "[PutObjBack] <rag> (1)",
    "put the book back on the shelf": "[PutBack] <book> (1) <shelf> (1)",
    "return the book to the bookshelf": "[PutBack] <book> (1) <bookshelf> (1)",
    "insert the plate into the microwave": "[PutIn] <plate> (1) <microwave> (1)",
    "throw the napkin in the bin": "[Throw] <napkin> (1) <trashcan> (1)",
    "pull the curtains shut": "[Close] <curtain> (1)",
    "get up from the chair": "[StandUp]",
    "I sat at the desk": "[Sit] <desk> (1)",
    "sit down at the table": "[Sit] <table> (1)",
    "walk to the kids' room": "[Walk] <kids_bedroom> (1)",
    "find a pair of socks": "[Find] <clothes_socks> (1)",
    "I entered the bedroom": "[Walk] <bedroom> (1)",
    "pick pan": "[Grab] <fryingpan> (1)",
    "take the car keys": "[Grab] <keys> (1)",
}


@pytest.mark.parametrize(("sentence", "step"), EXACT.items())
def test_usual_phrasings_are_exact(knowledge, sentence, step):
    lines, found = read(knowledge, sentence, fuzzy=Fuzzy.OFF)
    assert lines == [step] or lines == [step.replace("food_tomato", "tomato")]
    assert not found.faults and not found.warnings


@pytest.mark.parametrize(
    ("sentences", "steps"),
    [
        (["Get up from the chair and go to the couch"], "Stand up, Walk to couch"),
        (["open the fridge, take out the milk and close it"], "Open fridge, Grab milk, Close fridge"),
        (["go to the kitchen; then open the fridge"], "Walk to kitchen, Open fridge"),
        (["Walk to kitchen;Open fridge"], "Walk to kitchen, Open fridge"),
        (["grab a fork, a plate, and a cup"], "Grab fork, Grab plate, Grab cup"),
        (["put the cup and the plate on the table"], "Put cup on table, Put plate on table"),
        (["turn off the light", "switch it on"], "Switch off light, Switch on light"),
        (["Put milk in fridge", "drink it"], "Put milk in fridge, Drink milk"),
        (["Open the fridge", "Put milk in it"], "Open fridge, Put milk in fridge"),
    ],
)
def test_clauses(knowledge, sentences, steps):
    _, found = read(knowledge, *sentences)
    said = [say(knowledge.actions[step.action], [ref.name for ref in step.objects]) for step in found.program.steps]
    assert ", ".join(said) == steps and not found.faults and not found.warnings


def test_a_clause_that_is_not_understood_is_a_fault_at_its_column_and_the_others_are_steps(knowledge):
    lines, found = read(knowledge, "open the fridge, juggle the milk and close it")
    assert lines == ["[Open] <fridge> (1)", "[Close] <fridge> (1)"]
    (fault,) = found.faults
    assert (fault.code, fault.found, fault.column) == ("NOT_UNDERSTOOD", "juggle the milk", 26)


@pytest.mark.parametrize(
    "sentence",
    ["Open the fridge, never the window", "Open the fridge, or the window", "If it is warm, open the window",
     "Open the fridge but do not grab the milk", "juggle the milk and bake the bread"],
)  # fmt: skip
def test_a_line_is_refused_where_a_clause_of_it_changes_the_act_or_none_is_understood(knowledge, sentence):
    lines, found = read(knowledge, sentence)
    assert not lines and [fault.code for fault in found.faults] == ["NOT_UNDERSTOOD"]


def test_counts_are_instances(knowledge):
    assert read(knowledge, "Grab two forks")[0] == ["[Grab] <fork> (1)", "[Grab] <fork> (2)"]
    assert read(knowledge, "pick up both cups")[0] == ["[Grab] <cup> (1)", "[Grab] <cup> (2)"]
    lines = ["[PutBack] <plate> (1) <table> (1)", "[PutBack] <plate> (2) <table> (1)"]
    assert read(knowledge, "put 2 plates on the table")[0] == lines
    assert read(knowledge, "put the cup on two tables")[0] == []
    assert read(knowledge, "both sit on the sofa")[0] == []


@pytest.mark.parametrize(
    ("sentence", "step", "out"),
    [
        ("Carefully open the fridge", "[Open] <fridge> (1)", "carefully"),
        ("Lie on the bed to get some rest", "[Lie] <bed> (1)", "to get some rest"),
        ("Wait for 5 minutes", "[Wait]", "for 5 minutes"),
        ("scrub the plate with a sponge", "[Scrub] <plate> (1)", "with a sponge"),
        ("wipe the table with the cloth", "[Wipe] <table> (1)", "with the cloth"),
        ("Wait about two minutes", "[Wait]", "about two minutes"),
        ("Wait an hour", "[Wait]", "an hour"),
        ("Wait until it is done", "[Wait]", "until it is done"),
        ("Open the fridge once more", "[Open] <fridge> (1)", "once more"),
        ("Shave your face with the razor", "[Shave] <face> (1)", "with the razor"),
        ("Sleep for a while so that you are fresh", "[Sleep]", "for a while so that you are fresh"),
    ],
)
def test_what_is_left_out_is_counted(knowledge, sentence, step, out):
    lines, found = read(knowledge, sentence)
    assert lines == [step] and [warning.code for warning in found.warnings] == ["FUZZY_MATCH"]
    assert found.warnings[0].message.endswith(f"left out: {out}")
    assert read(knowledge, sentence, fuzzy=Fuzzy.OFF)[0] == []


@pytest.mark.parametrize(
    "sentence",
    ["He opens the fridge", "You should open the fridge", "The robot opens the fridge.", "You need to open the fridge",
     "Could you please open the fridge?", "I'd like you to open the fridge", "Let me open the fridge",
     "she is opening the fridge", "I have opened the fridge", "Lastly, open the fridge", "Second, open the fridge",
     "Would you open the fridge, please?", "They will then open the fridge", "You will need to open the fridge",
     "the person opened the fridge"],
)  # fmt: skip
def test_subjects_duties_and_courtesies_ask_for_the_same(knowledge, sentence):
    lines, found = read(knowledge, sentence, fuzzy=Fuzzy.OFF)
    assert lines == ["[Open] <fridge> (1)"] and not found.warnings


@pytest.mark.parametrize(
    "sentence",
    ["You should not open the fridge", "He never opens the fridge", "You do not need to open the fridge",
     "You can open the fridge", "The dog opens the fridge", "I have a cup"],
)  # fmt: skip
def test_other_subjects_denials_and_possibilities_are_no_steps(knowledge, sentence):
    lines, found = read(knowledge, sentence)
    assert not lines and len(found.faults) == 1


@pytest.mark.parametrize(
    ("sentence", "step", "out"),
    [
        ("Walk to the big sink", "[Walk] <sink> (1)", "big"),
        ("Eat an old banana", "[Eat] <food_banana> (1)", "old"),
        ("Look at the nearest candle", "[LookAt] <candle> (1)", "nearest"),
        ("Put the cup on the small wooden table", "[PutBack] <cup> (1) <table> (1)", "wooden small"),
        ("Turn the big tv on", "[SwitchOn] <television> (1)", "big"),
        ("Walk to the kitchen sink", "[Walk] <sink> (1)", "kitchen"),
    ],
)
def test_an_adjective_is_left_out_and_counted(knowledge, sentence, step, out):
    lines, found = read(knowledge, sentence)
    assert lines == [step] and found.warnings[0].message.endswith(f"left out: {out}")
    assert read(knowledge, sentence, fuzzy=Fuzzy.OFF)[0] == []


@pytest.mark.parametrize(
    "sentence", ["Grab the hot dog", "Walk to the green house", "Walk to the boat house", "Grab the toy cat"]
)
def test_what_is_another_noun_with_its_adjective_stays_so(knowledge, sentence):
    assert read(knowledge, sentence)[0] == []


@pytest.mark.parametrize(
    "sentence",
    ["Take a bath", "take a shower", "He takes a long shower", "Take a break", "grab a quick shower", "Take a picture",
     "Have a bath", "took a bath"],
)  # fmt: skip
def test_idioms_take_nothing(knowledge, sentence):
    lines, found = read(knowledge, sentence)
    assert not lines and len(found.faults) == 1
    assert read(knowledge, "Take the picture")[0] == ["[Grab] <picture> (1)"]


def test_glasses_that_are_counted_or_said_before_are_to_drink_from(knowledge):
    glass = thing_of(knowledge, "glass")
    assert read(knowledge, "Grab two glasses")[0] == [f"[Grab] <{glass}> (1)", f"[Grab] <{glass}> (2)"]
    assert read(knowledge, "Grab a glass", "Pour juice into the glasses")[0][1:] == [
        f"[Pour] <juice> (1) <{glass}> (1)"
    ]
    assert read(knowledge, "Grab a cup", "Put on the glasses")[0][1:] == ["[PutOn] <spectacles> (1)"]


def test_a_hint_has_the_verb_or_a_thing_of_the_sentence(knowledge):
    for sentence in (
        "Bake the bread",
        "Heat the salmon",
        "Lick the plate",
        "Hug the guest",
        "Tickle it",
        "Cut a fringe",
    ):
        for each in understand(knowledge, sentence).candidates:
            words = say(each.action, each.names).lower().split()
            named = {spelt.replace("_", " ") for name in each.names for spelt in knowledge.same_class(name)}
            assert words[0] == sentence.split()[0].lower() or any(name in sentence.lower() for name in named)


def test_modes(knowledge):
    typo, other = "Wlak to kitchen", "Heat the salmon"
    read_by = {mode: [bool(understand(knowledge, each, mode).meant) for each in (typo, other)] for mode in Fuzzy}
    assert read_by == {Fuzzy.OFF: [False, False], Fuzzy.TYPOS: [True, False], Fuzzy.LOOSE: [True, True]}
    assert read(knowledge, other, fuzzy=Fuzzy.LOOSE)[0] == ["[Eat] <salmon> (1)"]


@pytest.mark.parametrize(
    ("lines", "language"),
    [
        (["Gehe in die Küche", "Öffne den Kühlschrank", "Nimm die Milch"], "German"),
        (["Marche vers la cuisine", "Ouvre le frigo", "Prends le lait"], "French"),
        (["Camina a la cocina", "Abre la nevera", "Toma la leche"], "Spanish"),
        (["Heat the salmon", "Bake the bread"], None),
        (["Frobnicate zorb"], None),
    ],
)
def test_each_line_of_a_plan_in_another_language_names_it(knowledge, lines, language):
    assert foreign_language(lines) == language
    _, found = read(knowledge, *lines)
    assert len(found.faults) == len(lines)
    assert all((language or "could not read this line as a step") in fault.message for fault in found.faults)


def test_a_line_of_another_language_in_an_english_plan_is_a_fault_of_its_own(knowledge):
    lines, found = read(knowledge, "Walk to bed", "Lie on bed", "Schlafe jetzt ruhig ein")
    assert len(lines) == 2 and found.faults[0].message == "could not read this line as a step"


def _ours(knowledge):
    """First words of our phrases, and of the usual phrasings."""
    said = [words for action in knowledge.actions.values() for words in (action.template, *action.words, action.name)]
    return {words.lower().split()[0] for words in said} | {
        "move", "bring", "carry", "transfer", "fill", "travel", "proceed", "return", "come", "navigate", "lay", "rise",
    }  # fmt: skip


def _lexicon(kind):
    table = Path(lemminflect.__file__).parent / "resources/lemma_lu.csv.gz"
    rows = (line.split(",") for line in gzip.decompress(table.read_bytes()).decode().splitlines())
    return sorted(
        {row[0] for row in rows if row[1] == kind and row[0].isalpha() and row[0].isascii() and row[0].islower()}
    )


VERBS, NOUNS = _lexicon("verb"), _lexicon("noun")


@given(st.data())
def test_no_other_verb_is_read_as_ours(knowledge, data):
    ours = _ours(knowledge)
    verb = data.draw(st.sampled_from(VERBS).filter(lambda word: not ours & {word, *verb_lemmas(word)}))
    thing = data.draw(st.sampled_from(["cup", "salmon", "fridge", "window", "cat"]))
    assert is_verb(verb) and not asked_steps(knowledge, f"{verb} the {thing}", (), Fuzzy.TYPOS), verb


@given(st.data())
def test_no_other_noun_is_read_as_ours(knowledge, data):
    noun = data.draw(st.sampled_from(NOUNS).filter(lambda word: thing_of(knowledge, word) is None))
    head = data.draw(st.sampled_from(["Walk to", "Grab", "Open", "Look at", "Put the cup on"]))
    assert is_noun(noun) and not asked_steps(knowledge, f"{head} the {noun}", (), Fuzzy.TYPOS), noun


@given(st.data())
def test_a_phrase_of_ours_reads_as_itself_and_with_a_typo_nearly(knowledge, data):
    action = data.draw(st.sampled_from([a for a in knowledge.actions.values() if a.arity == 1]))
    afforded = [name for name in knowledge.objects if knowledge.affords(action.name, 0, name)]
    name = data.draw(st.sampled_from(afforded))
    (asked,) = asked_steps(knowledge, say(action, (name,)), (), Fuzzy.OFF)
    assert (asked.meant.action.name, asked.meant.names) == (action.name, (name,))
    word = max(name.split("_"), key=len)
    at = data.draw(st.integers(1, max(1, len(word) - 2)))
    swapped = word[:at] + word[at : at + 2][::-1] + word[at + 2 :]
    if len(word) < 7 or swapped == word or is_english(swapped):
        return
    (nearly,) = asked_steps(knowledge, say(action, (name.replace(word, swapped),)), (), Fuzzy.TYPOS)
    assert (nearly.meant.names, nearly.fuzzy) == ((name,), True)
