"""The text environment: the words of hearth-text/1, its forms of answers, its limits, and many worlds at once."""

from __future__ import annotations

import json
import random

import pytest
from golden_files import compare

import hearth
from hearth.challenges.published_tasks import tasks
from hearth.envs.answer_forms import command_line, read_answer
from hearth.envs.rewards import Rewards
from hearth.envs.session import opening
from hearth.envs.text_homes import SeededTask, TextHome, TextHomes
from hearth.envs.text_protocol_settings import PROTOCOLS, protocol
from hearth.homes import library
from hearth.homes.procedural.home_generator import generate
from hearth.homes.scene_graph import scene
from hearth.schemas.diagnostics import HearthError
from hearth.simulation.world.home import Home

MILK = "ON(milk, table)"
WAH = tasks("wah", "train", limit=6)
WAY = ("Walk kitchen", "Walk fridge", "Open fridge", "Grab milk 142", "Walk table 212", "PutBack milk 142, table 212")


@pytest.fixture
def home():
    found = TextHome("maple", MILK)
    found.reset(4)
    return found


def played(world, answers):
    """The transcript of a world: each answer, and what it was answered."""
    return [(answer, *world.step(answer)[:4]) for answer in answers]


def test_one_brings_the_milk_in_six_commands(home):
    *before, last = played(home, WAY)
    assert not any(terminated for _, _, _, terminated, _ in before) and last[3] and last[2] == pytest.approx(0.996)
    assert "You see 1/1 done." in last[1]


@pytest.mark.parametrize(
    "answer",
    [
        "Walk fridge 137", "walk to the fridge 137", "go to fridge 137", "> go to fridge 137",
        "[Walktowards] <fridge> (1)", "[Walk] <fridge> (1)", "[Walk] <fridge> (1.137)", "[WALK] <fridge> (137)",
        "0. go to the fridge", "1) Walk fridge", "- walk to the fridge", "Step 1: go to the fridge",
        "Thought: I want milk. Action: walk fridge", "1. [Walk] <fridge> (1)",
        "Thought: the milk is cold.\nAction: Walk fridge 137", "I will go there.\nWalk fridge 137",
        '{"name": "act", "arguments": {"command": "Walk fridge 137"}}',
        '{"function": {"name": "act", "arguments": "{\\"command\\": \\"Walk fridge 137\\"}"}}',
        '[{"action": "Walk", "objects": ["fridge 137"]}]', '```json\n{"command": "Walk fridge 137"}\n```',
        'Action: {"command": "Walk fridge 137"}', "**Walk fridge 137**", "Walk fridge",
    ],
)  # fmt: skip
def test_all_forms_of_an_answer_mean_the_same(home, answer):
    home.step("Walk kitchen")
    text, _, _, _, info = home.step(answer)
    assert info["fault"] is None and "Last: Walk fridge 137 - done." in text


@pytest.mark.parametrize(
    ("answer", "said"),
    [
        ("take milk 142 from fridge 137", "Grab milk 142"), ("pick up the milk 142", "Grab milk 142"),
        ("close fridge 137", "Close fridge 137"), ("Shut the fridge", "Close fridge 137"),
    ],
)  # fmt: skip
def test_words_of_other_games_and_sentences_are_read(home, answer, said):
    played(home, WAY[:3])
    text, _, _, _, info = home.step(answer)
    assert info["fault"] is None and f"Last: {said} - done." in text


@pytest.mark.parametrize(
    ("answer", "code"),
    [
        ("", "EMPTY"), ("\n \n", "EMPTY"), (None, "NOT_TEXT"), (b"wait", "NOT_TEXT"),
        ("x" * 10_000_000, "LINE_TOO_LONG"), ("wait\n" * 2_000_000, "LINE_TOO_LONG"),
        ("\x07\x1b[2J", "NOT_UNDERSTOOD"), ("Grab milk 142", "NOT_SEEN"), ("Grab milk", "NOT_SEEN"),
        ("17", "NOT_UNDERSTOOD"),
        ("fly to the moon", "UNKNOWN_ACTION"), ("Walk zebra", "UNKNOWN_OBJECT"), ("Open couch 51", "NOT_AFFORDED"),
        ("aller à la cuisine", "NOT_UNDERSTOOD"), ("{" * 400, "NOT_UNDERSTOOD"),
        ("a" * 5000, "LINE_TOO_LONG"), ('{"command": 3}', "NOT_UNDERSTOOD"),
    ],
)  # fmt: skip
def test_what_is_refused_says_why_and_takes_a_tick(home, answer, code):
    text, reward, terminated, truncated, info = home.step(answer)
    assert info["fault"]["code"] == code and info["fault"]["message"], info["fault"]
    assert info["ticks"] == 1 and reward == pytest.approx(-0.004) and not terminated and not truncated
    assert f"Last: refused, you waited. {code}: " in text
    assert text.replace("\n", "").isprintable() and len(text) <= 1200


@pytest.mark.parametrize(
    ("answer", "said"),
    [
        ("take milk 142 from oven 5", "NOT_SEEN: you do not see `oven` 5"),
        ("Grab milk 142 from the oven", "NOT_SEEN: `milk` 142 is not in or on `oven`"),
        ("take milk 142 from bathroom", "NOT_SEEN: `milk` 142 is not in or on `bathroom`"),
        ("Walk to the kitchen, then use the sink", "SYNTAX: more than one command"),
        ("Go to the kitchen and use the sink", "SYNTAX: more than one command"),
        ("Drink sink", "NOT_HOLDING: the character does not hold the sink (take it first)"),
        ("Walk fridge, sink", "WRONG_ARITY: Walk takes 1 object, not 2 (write Walk destination)"),
        ("cook", "UNKNOWN_ACTION: no action is called `cook` (a command as under `Do:`"),
        ("Grab gizmo", "UNKNOWN_OBJECT: unknown object `gizmo` (a command as under `Do:`"),
        ("Walk sink 1", "UNBOUND: 1 is `living_room`, not `sink` (you see 158)"),
    ],
)  # fmt: skip
def test_a_refusal_says_why_in_words_and_what_to_do(home, answer, said):
    played(home, WAY[:3])
    assert f"Last: refused, you waited. {said}" in home.step(answer)[0]


@pytest.mark.parametrize("place", ["fridge 137", "the fridge", "kitchen", "kitchen 109"])
def test_a_thing_is_taken_from_where_it_is(home, place):
    played(home, WAY[:3])
    assert "Last: Grab milk 142 - done." in home.step(f"take milk 142 from {place}")[0]


def test_of_several_things_the_one_at_the_place_is_taken(home):
    played(home, WAY[:4])
    assert "Last: Grab milk 143 - done." in home.step("take the milk from the fridge")[0]


def test_a_world_that_is_over_stays_as_it_is(home):
    played(home, WAY[:-1])
    text, *_, info = home.step(WAY[-1])
    ticks = info["ticks"]
    again, reward, terminated, truncated, info = home.step("Walk kitchen")
    assert (again, reward, terminated, truncated) == (text, 0.0, True, False)
    assert info["fault"]["code"] == "OUT_OF_ORDER" and info["fault"]["remedy"] and info["ticks"] == ticks
    short = TextHome("maple", MILK, limit=2)
    short.reset(0)
    assert [short.step("wait")[3] for _ in range(3)] == [False, True, True]


def test_a_walk_goes_on_and_stops_where_something_wanted_comes_into_sight():
    slow, fast = TextHome("maple", MILK, travel=False), TextHome("maple", MILK)
    slow.reset(4), fast.reset(4)
    ticks = fast.step("Walk bedroom 237")[4]["ticks"]
    assert ticks > 2 and slow.step("Walk bedroom 237")[4]["ticks"] == 1
    table = TextHome("maple", "ON(book, kitchen_counter)")
    table.reset(4)
    text, *_, info = table.step("Walk fridge 137")
    assert info["fault"]["code"] == "NOT_SEEN"
    text, *_, first = table.step("Walk kitchen 109")
    assert "in kitchen 109" in text and first["ticks"] > 1


@pytest.mark.parametrize("name", library.names())
def test_every_observation_keeps_to_its_length_and_every_legal_command_is_accepted(name):
    goal = "HOLDS(agent, book)"
    world, chooser, lengths = TextHome(name, goal, limit=60), random.Random(1), []
    text, info = world.reset(1)
    shown, may = world._homes._places[0].shown
    options = list(info["admissible"])
    assert len(options) == len(info["admissible"]) == len(may) + 1 and options[3] == info["admissible"][3]
    for option in options:
        assert option == "wait" or read_answer(option, shown, may, protocol()) in may
    for _ in range(40):
        text, _, terminated, truncated, info = world.step(chooser.choice(list(info["admissible"])))
        assert info["fault"] is None
        lengths.append(len(text))
        if terminated or truncated:
            break
    assert max(lengths) <= 1200


def test_a_generated_home_is_played_too(knowledge):
    made = Home.from_graph(scene(generate(5, 1, knowledge), knowledge), "made", knowledge)
    world, chooser = TextHome(opening(made, MILK, agents=1)), random.Random(0)
    text, info = world.reset(0)
    for _ in range(20):
        text, *_, info = world.step(chooser.choice(list(info["admissible"])))
        assert info["fault"] is None and len(text) <= 1200


def test_observations_have_under_800_characters_on_average(knowledge):
    made = [
        Home.from_graph(scene(generate(3 + n % 5, n, knowledge), knowledge), f"made {n}", knowledge) for n in range(5)
    ]
    lengths, means = [], {}
    for home in (*library.names(), *made):
        goal = next(goal for goal in (MILK, "INSIDE(apple, fridge)", "HOLDS(agent, book)") if possible(home, goal))
        world, chooser = TextHome(opening(home, goal, agents=1), limit=40), random.Random(2)
        text, info = world.reset(1)
        for _ in range(40):
            walks = [each for each in info["admissible"] if each.startswith("Walk ")]
            rest = [each for each in info["admissible"] if not each.startswith(("Walk", "Turn"))]
            text, _, terminated, truncated, info = world.step(
                chooser.choice(chooser.choice([walks, rest]) or list(info["admissible"]))
            )
            lengths.append(len(text))
            means.setdefault(home if isinstance(home, str) else home.name, []).append(len(text))
            if terminated or truncated:
                break
    assert sum(lengths) / len(lengths) < 800 and max(lengths) <= 1200
    assert max(sum(each) / len(each) for each in means.values()) < 850, means


def possible(home, goal):
    try:
        TextHome(opening(home, goal, agents=1)).reset(1)
    except HearthError:
        return False
    return True


def test_what_is_left_out_of_a_long_observation_works_all_the_same():
    world = TextHome("willow", MILK)
    world.reset(1)
    text, *_ = world.step("Walk kitchen")
    assert " things" in text and len(text) <= 1200
    text, *_, info = world.step("Walk kitchen_table")
    text, *_, info = world.step(next(each for each in info["admissible"] if each.startswith("Grab plate")))
    assert info["fault"] is None and "- done." in text


def test_names_stay_and_texts_are_equal_for_any_number_of_worlds():
    answers = ["Walk kitchen", "wait", "Walk table", "fly", "Walk fridge"]
    many, one = TextHomes(WAH, worlds=6), TextHomes(WAH, worlds=1)
    begun, _ = many.reset(indices=range(6))
    rows = [many.step([answer] * 6) for answer in answers]
    for number in range(6):
        (text,), _ = one.reset(indices=[number])
        assert text == begun[number]
        for answer, row in zip(answers, rows, strict=True):
            texts, rewards, *_ = one.step([answer])
            assert (texts[0], rewards[0]) == (row[0][number], row[1][number])


def test_one_world_has_no_part_in_another():
    homes = TextHomes(WAH, worlds=2)
    homes.reset(indices=[0, 1])
    calm = homes.step(["wait", "wait"])[0][1]
    homes.reset(indices=[0, 1])
    assert homes.step(["x" * 10_000_000, "wait"])[0][1] == calm


def test_groups_share_a_task_and_seeds_draw_the_same():
    homes = TextHomes(WAH, worlds=6, group=3, seed=1)
    texts, infos = homes.reset()
    assert [info["id"] for info in infos] == [infos[0]["id"]] * 3 + [infos[3]["id"]] * 3
    assert texts[0] == texts[1] == texts[2]
    assert homes.reset(seeds=[5, 9])[0] == homes.reset(seeds=[5, 9])[0]
    assert TextHomes(WAH, worlds=6, group=3, seed=1).reset()[0] == texts


def test_a_snapshot_is_gone_on_from_as_often_as_one_likes(home):
    played(home, WAY[:3])
    kept = home.snapshot()
    first = played(home, WAY[3:])
    text, info = home.restore(kept)
    assert "fridge 137 (open)" in text and info["won"] is False
    assert played(home, WAY[3:]) == first
    other = TextHome("maple", MILK)
    other.restore(kept)
    assert played(other, WAY[3:]) == first


def test_the_expert_solves_its_tasks():
    homes = TextHomes(WAH[:2], worlds=2, expert=True, travel=False)
    _, infos = homes.reset(indices=[0, 1])
    for _ in range(250):
        _, _, won, _, infos = homes.step([info["expert"] for info in infos])
        assert all(info["fault"] is None or info["won"] for info in infos)
        if all(won):
            break
    assert all(info["won"] and info["goal_fraction"] == 1.0 for info in infos)


def test_a_reward_is_any_function_of_a_tick():
    world = TextHome("maple", MILK, reward=lambda before, after, agent: 10.0 + agent)
    world.reset(4)
    _, reward, *_, info = world.step("Walk kitchen")
    assert reward == 10.0 * info["ticks"]
    assert TextHome("maple", MILK, reward=Rewards(tick=-1.0)).reset(0)


class Said:
    """A task with a sentence."""

    id, instruction = "said", "Bring\nme the \x07 milk!"

    def __init__(self):
        self.begin = opening("maple", MILK, agents=1)
        self.goal = self.begin(0)[1]

    def start(self):
        return self.begin(0)[0]


def test_the_sentence_of_a_task_is_its_goal():
    (text,), (info,) = TextHomes([Said()], worlds=1).reset()
    assert text.startswith("Goal: Bring me the ? milk!") and info["id"] == "said"


@pytest.mark.parametrize("length", [10, 400, 5_000])
def test_of_a_long_sentence_a_persons_words_are_cut_and_not_their_short_form(length):
    said = Said()
    short = "Put a carton of milk on the table."
    said.instruction = f"{'Words of mine. ' * (length // 15)}In short: {short}"
    (text,), _ = TextHomes([said], worlds=1).reset()
    first = text.splitlines()[0]
    assert f"In short: {short} You see" in first and len(first) < 350
    assert (" ..." in first) == (length > 300)
    said.instruction = f"Words. In short: {short * 20}"
    (text,), _ = TextHomes([said], worlds=1).reset()
    assert text.startswith("Goal: Put a carton") and len(text.splitlines()[0]) < 350


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: TextHomes([]), "no tasks"), (lambda: TextHomes([3]), "no tasks"), (lambda: TextHomes(7), "no tasks"),
        (lambda: TextHomes(WAH, worlds=0), "`worlds`"), (lambda: TextHomes(WAH, worlds=5, group=2), "no whole groups"),
        (lambda: TextHomes(WAH, protocol="hearth-text/9"), "no text protocol"),
        (lambda: TextHomes(WAH, reward=3), "reward"),
        (lambda: TextHomes(WAH, worlds=1).step(["wait"]), "no world has begun"),
        (lambda: TextHomes(WAH, worlds=1).reset(indices=[99]), "no task 99"),
        (lambda: TextHomes(WAH, worlds=1).reset(indices=[0, 1]), "2 values"),
        (lambda: TextHomes(WAH, worlds=1).reset(indices=[0], seeds=[0]), "both given"),
        (lambda: TextHomes(WAH, worlds=1).restore([3]), "not a snapshot"),
        (lambda: TextHome("nowhere", MILK), "no home `nowhere`"), (lambda: TextHome("maple"), "0 goals"),
        (lambda: begun().step("wait"), "one text"), (lambda: begun().step(["wait"] * 3), "3 answers"),
    ],
)  # fmt: skip
def test_what_can_not_be_is_refused_with_a_remedy(make, said):
    with pytest.raises(HearthError) as caught:
        make()
    fault = caught.value.diagnostics[0]
    assert said in fault.message and fault.suggestion


def begun():
    homes = TextHomes(WAH, worlds=1)
    homes.reset()
    return homes


@pytest.mark.parametrize(
    ("answer", "line"),
    [
        ("Walk a", "Walk a"), ("think\n\nWalk a\n", "Walk a"), ("Action: Walk a\nObservation: you are there", "Walk a"),
        ('{"arguments": "Walk a"}', "Walk a"), ("{}", "{}"), ("", ""), ("[1, 2]", "[1, 2]"),
        ("```\nWalk a\n```", "Walk a"), ("2. Walk a", "Walk a"), ("17", "17"), ("1.5", "1.5"),
    ],
)  # fmt: skip
def test_the_command_in_an_answer_is_found(answer, line):
    assert command_line(answer) == line


def test_the_transcripts_are_those_that_were_kept():
    """Golden: two episodes word for word, and the fingerprint of the protocol under which they were made."""
    kept = {
        "protocols": {name: protocol(name).fingerprint for name in PROTOCOLS},
        "instructions": protocol().instructions,
    }
    answers = (*WAY[:3], "Grab milk", "dance", *WAY[3:])
    world = TextHome("maple", MILK)
    kept["milk"] = [world.reset(4)[0], *([f"> {row[0]}", row[1]] for row in played(world, answers))]
    homes = TextHomes(WAH[:1], worlds=1, expert=True)
    (text,), (info,) = homes.reset(indices=[0])
    rows = [text]
    for _ in range(12):
        answer = info["expert"]
        (text,), _, _, _, (info,) = homes.step([answer])
        rows.append([f"> {answer}", text])
    kept["expert"] = rows
    compare("text_transcripts.json", json.loads(json.dumps(kept)))


def test_a_seeded_task_is_a_value():
    begin = opening("maple", MILK, agents=1)
    task = SeededTask("seed-3", begin, 3)
    assert task.start().graph() == begin(3)[0].graph() and task.goal == begin(3)[1]


@pytest.mark.parametrize("goal, line", [
    ("never OPEN(fridge) and HOLDS(agent, milk)", "Goal: hold milk; never (OPEN(fridge)). You see 0/1 done."),
    ("always CLOSED(fridge) and OPEN(oven)", "Goal: OPEN(oven); always (CLOSED(fridge))."),
    ("OPEN(fridge) or OPEN(microwave)", "Goal: (OPEN(fridge)) or (OPEN(microwave))."),
])  # fmt: skip
def test_a_ban_is_told_as_a_ban_and_nothing_of_it_counts_as_done(goal, line):
    observation, _ = hearth.TextHome("maple", goal).reset(seed=4)
    assert observation.splitlines()[0].startswith(line)
