"""Tasks of `household`: made from ids, solved, without leaks between splits."""

from __future__ import annotations

from collections import Counter

import pytest
import typer

from hearth.agents.forbidden_actions import forbidden
from hearth.challenges import household
from hearth.challenges.episodes import read_instruction as read_step
from hearth.challenges.household import digest_of, household_ids, household_task, household_tasks, solve
from hearth.challenges.household_activities import _titles, activities
from hearth.challenges.household_definition import (
    RULES,
    home_named,
    settings,
    share_of,
    share_of_goal,
    share_of_program,
    split_named,
)
from hearth.challenges.household_files import read_tasks, write_tasks
from hearth.challenges.household_task_workers import attempts, drawn_tasks
from hearth.challenges.instruction_reader import read_instruction
from hearth.commands import challenge_household, play
from hearth.envs.compact_text import IN_SHORT
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.goals import Goal, Joined
from hearth.schemas.literals import Literal
from hearth.schemas.program import ObjectRef, Step
from hearth.simulation.env import Env
from hearth.simulation.goals import Progress
from hearth.simulation.literal_truth import candidates
from hearth.simulation.world import edge_rows
from hearth.simulation.world.bits import indices
from hearth.simulation.world.digest import digest

SPLITS = tuple(settings()["splits"])
TRAIN = 20
OTHERS = 10
PUBLISHED = {
    "train": "a56331ceeb8eab2235920d0b8f71b0b9",
    "valid_seen": "285d7b4fe2550cdc86621e1d4ad49dd7",
    "valid_unseen": "c4ce54853e365b0f1dc08210195ec0f6",
    "valid_words": "228da3aaaa789032d27fabf017dfa032",
    "test_seen": "25c0aed60b21a5375ef429f47c4906e6",
    "test_unseen": "dc4d15fd418a44930ff84bf261edf0f4",
}
"""Digests of the first ten tasks of each split."""


@pytest.fixture(scope="module")
def drawn(knowledge):
    """The first tasks of each split."""
    limits = {split: TRAIN if split == "train" else OTHERS for split in SPLITS}
    return {split: [*household_tasks(split, limit, knowledge=knowledge)] for split, limit in limits.items()}


@pytest.fixture(scope="module")
def every(drawn):
    return [task for tasks in drawn.values() for task in tasks]


def test_there_are_twelve_thousand_ids_or_more():
    ids = [task_id for split in SPLITS for task_id in household_ids(split)]
    assert len(set(ids)) == len(ids) >= 12_000


@pytest.mark.parametrize("split", SPLITS)
def test_the_published_tasks_stay_as_they_are(drawn, split):
    assert digest_of(drawn[split][:10]) == PUBLISHED[split]


def test_every_family_is_there(drawn):
    for tasks in drawn.values():
        assert {task.family for task in tasks} == set(settings()["families"])


def test_nothing_of_a_goal_holds_at_the_start(every, knowledge):
    for task in every:
        progress = Progress.start(task.goal, task.start(knowledge))
        assert not any(progress.counts) and not progress.satisfied, task.id


def test_nothing_that_is_wanted_is_shut_in_a_box_or_basket(every, knowledge):
    for task in every:
        world = task.start(knowledge)
        movable = world.home.properties["GRABBABLE"]
        for literal, _ in () if task.activity else task.goal:
            some = candidates(literal, world.home)
            for i in indices((some.targets if some.by_target else some.subjects) & movable):
                assert not edge_rows.inside(world, i) & movable, task.id


def test_a_start_is_the_same_every_time(every, knowledge):
    for task in every[::7]:
        assert digest(task.start(knowledge)) == digest(task.start(knowledge))


def test_the_expert_reaches_the_goal_in_the_ticks_that_are_said(every, knowledge):
    allowed = knowledge.group(settings()["actions"])
    for task in every:
        env = Env(RULES, True)
        env.restore(task.start(knowledge))
        progress = Progress.start(task.goal, env.world)
        for text in task.expert:
            done = env.step({0: read_step(text, 0, env.world.home, allowed)} if text else {})
            progress = progress.then(done.before, done.world, [*done.instructions.values()])
        assert progress.satisfied and task.min_ticks == len(task.expert) > 0, task.id


def test_the_human_like_agent_solves_most_tasks(every):
    found = list(attempts(every, default))
    assert sum(each.success for each in found) >= 0.94 * len(found)


def test_an_instruction_is_read_back(every, knowledge):
    for task in every:
        assert read_instruction(task.instruction, knowledge) == task.goal, task.id


def test_an_activity_has_a_persons_words_and_their_short_form(every):
    for task in every:
        assert (IN_SHORT in task.instruction) == bool(task.activity) == (task.family == "activity")


def _parts(task, steps):
    """Return what no test may have in common with train."""
    goal = frozenset((str(literal), number) for literal, number in task.goal), task.goal.parts
    return {("words", task.instruction), ("goal", goal), ("program", (task.home, *map(str, steps)))}


def _steps(task, knowledge):
    home, allowed = task.start(knowledge).home, knowledge.group(settings()["actions"])
    return [read_step(text, 0, home, allowed) for text in task.expert if text]


@pytest.fixture(scope="module")
def programs(every, knowledge):
    """The steps of each task's expert, by id."""
    return {task.id: _steps(task, knowledge) for task in every}


def _leaks(tasks, programs):
    """Return the ids of tasks of other splits that have something in common with train."""
    train = {part for task in tasks if task.split == "train" for part in _parts(task, programs[task.id])}
    return [task.id for task in tasks if task.split != "train" and _parts(task, programs[task.id]) & train]


def test_no_instruction_goal_or_program_of_another_split_is_in_train(every, programs):
    assert _leaks(every, programs) == []


@pytest.mark.slow
def test_none_of_many_tasks_is_in_train(knowledge):
    limits = {split: 2_000 if split == "train" else 400 for split in SPLITS}
    ids = [each for split, limit in limits.items() for each in household_ids(split, limit)]
    tasks = [household_task(each, knowledge=knowledge) for each in ids]
    assert _leaks(tasks, {task.id: _steps(task, knowledge) for task in tasks}) == []


def test_goal_and_program_of_a_task_belong_to_the_share_of_its_split(every, programs):
    for task in every:
        share = split_named(task.split).goals
        assert share_of_goal(task.goal) == share == share_of_program(programs[task.id]), task.id
        assert share_of_goal(Goal(task.goal.counts[::-1], task.goal.parts)) == share


def test_goals_that_one_program_reaches_belong_to_one_share():
    """Numbers, bans and the way to things do not matter, so that no such goal is of a test if another is trained on."""
    shelf = Goal.of(Literal.of("INSIDE", "book", "bookshelf"))
    assert share_of_goal(shelf & Goal(parts=(Joined("not", (shelf,)),))) == share_of_goal(shelf)
    assert share_of_goal(Goal.of((Literal.of("INSIDE", "book", "bookshelf"), 2))) == share_of_goal(shelf)
    book, place = ObjectRef("book", 0, 5), ObjectRef("bookshelf", 0, 6)
    done = [
        Step("Walktowards", (ObjectRef("sofa", 0, 9),)),
        Step("Grab", (book,)),
        Step("Open", (ObjectRef("door", 0, 3),)),
    ]
    assert share_of_program([*done, Step("PutIn", (book, place))]) == share_of_goal(shelf)


def test_a_program_of_another_share_is_no_task_of_the_split(monkeypatch, knowledge, drawn):
    share, rejected = household.share_of_program, Counter()
    first = iter(["test"])
    monkeypatch.setattr(household, "share_of_program", lambda steps: next(first, None) or share(steps))
    assert household_task("household-train-00001", rejected, knowledge) != drawn["train"][1]
    assert rejected["program of another split"] >= 1


def test_a_program_of_the_corpus_is_drawn_for_one_share_alone():
    found = {}
    for share in settings()["shares"]:
        for ids in _titles(share).values():
            for each in ids:
                found.setdefault(" ".join(activities()[each].program.lower().split()), set()).add(share)
    assert len(found) > 4_000 and all(len(shares) == 1 for shares in found.values())


def test_activities_of_tests_are_in_no_training_task(every):
    titles = {task.split: set() for task in every}
    for task in every:
        if task.activity:
            title = household.activities()[task.activity].title.lower()
            titles[task.split].add(title)
            assert share_of(title) == split_named(task.split).goals


def test_homes_that_are_not_seen_are_in_no_other_split():
    seen = {home for name in ("train", "valid_seen", "test_seen", "valid_words") for home in split_named(name).homes}
    valid, test = set(split_named("valid_unseen").homes), set(split_named("test_unseen").homes)
    assert not seen & valid and not seen & test and not valid & test


def test_words_of_tests_are_in_no_training_split():
    pools = {name: split_named(name).words for name in SPLITS}
    assert {pools["test_seen"], pools["test_unseen"]} == {"test"} and pools["valid_words"] == "valid"
    assert pools["train"] == "train"


def test_shares_are_those_of_the_file():
    found = Counter(share_of(str(number)) for number in range(10_000))
    for name, share in settings()["shares"].items():
        assert abs(found[name] / 100 - share) < 2


def test_the_same_id_gives_the_same_task_whoever_draws_it(drawn, knowledge):
    tasks = drawn["train"][:4]
    assert [household_task(task.id, knowledge=knowledge) for task in reversed(tasks)] == tasks[::-1]
    assert drawn_tasks("train", 4, 0, default, workers=2).tasks == tuple(tasks)


def test_another_seed_gives_other_tasks(drawn, knowledge):
    (other,) = household_tasks("train", 1, seed=9, knowledge=knowledge)
    assert other.id == "household-train-9-00000" and other.goal != drawn["train"][0].goal
    assert household_task(other.id, knowledge=knowledge) == other


def test_what_is_rejected_is_counted(knowledge):
    rejected = Counter()
    assert len([*household_tasks("test_seen", 3, rejected=rejected, knowledge=knowledge)]) == 3
    assert rejected["goal of another split"] > 0


def test_a_task_that_is_not_solved_is_replaced(monkeypatch, knowledge, drawn):
    """The first solution is refused, so that the same id gives another task."""
    calls = []

    def refuse_first(*arguments, **named):
        calls.append(named)
        done = solve(*arguments, **named)
        object.__setattr__(done, "progress", done.progress[: 1 if len(calls) == 1 else None])
        return done

    monkeypatch.setattr(household, "solve", refuse_first)
    rejected = Counter()
    found = household_task("household-train-00001", rejected, knowledge)
    assert rejected["not solved by an agent that sees everything"] >= 1
    assert found != drawn["train"][1]


def test_files_of_tasks_are_read_back(tmp_path, drawn, knowledge):
    path = tmp_path / "tasks.json"
    write_tasks(path, drawn["train"])
    assert list(read_tasks(path, knowledge)) == drawn["train"]
    assert digest_of(drawn["train"]) in path.read_text()
    path.write_text(path.read_text().replace('"min_ticks"', '"minimum"', 1))
    with pytest.raises(HearthError) as caught:
        read_tasks(path, knowledge)
    assert caught.value.diagnostics[0].code is Code.BAD_JSON
    write_tasks(path, drawn["train"])
    path.write_text(path.read_text().replace("-00000", "-99999", 1))
    with pytest.raises(HearthError) as caught:
        read_tasks(path, knowledge)
    assert caught.value.diagnostics[0].code is Code.DAMAGED_FILE


@pytest.mark.parametrize(
    "task_id", ["", "household-train-99999", "household-moon-00000", "../train", "household-train-1"]
)
def test_there_is_no_other_task(task_id):
    with pytest.raises(HearthError) as caught:
        household_task(task_id)
    assert caught.value.diagnostics[0].code is Code.BAD_ARGUMENT


def test_the_command_prints_instructions_with_their_goals(capsys, drawn):
    challenge_household.print_tasks("train", None, 0, 2, 1, as_json=False)
    printed = capsys.readouterr().out
    for task in drawn["train"][:2]:
        assert task.instruction in printed and str(task.goal) in printed and task.id in printed


def test_a_task_is_played_where_it_starts(drawn, knowledge):
    task = drawn["train"][1]
    scene = play._task_scene(task.id, "", None, knowledge)
    assert (scene.goal, scene.instruction, scene.actions) == (task.goal, task.instruction, settings()["actions"])
    assert digest(scene.world) == digest(task.start(knowledge))
    with pytest.raises(typer.BadParameter, match="leave out"):
        play._task_scene(task.id, "maple", None, knowledge)


def test_what_is_never_to_be_done_is_not_done(drawn, knowledge):
    tasks = [task for tasks in drawn.values() for task in tasks if task.family == "without"]
    for task in tasks:
        never = forbidden(task.goal, home_named(task.home, knowledge))
        assert never
        done = solve(task.start(knowledge), task.goal, task.seed, knowledge)
        for tick in done.env.ticks:
            for step in tick.instructions.values():
                index = done.env.world.home.index
                assert not any(never.get(step.action, 0) >> index[ref.node] & 1 for ref in step.objects[:1])


def test_an_agent_looks_before_it_believes_that_a_lamp_is_off(knowledge):
    task = next(task for task in household_tasks("train", 10, knowledge=knowledge) if task.family == "turn_off")
    assert all(literal.negated for literal, _ in task.goal)
    assert solve(task.start(knowledge), task.goal, task.seed, knowledge).success
