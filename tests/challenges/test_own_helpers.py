"""Helpers of one's own: written as records have it, known by their file, and refused where they cannot be made."""

import pytest

from hearth.challenges.challenge_dataset import _once, _trajectory
from hearth.challenges.episode_agents import Lineup, load
from hearth.challenges.episodes import Job, again, played
from hearth.challenges.result_files import read
from hearth.challenges.suite_runs import run
from hearth.challenges.task_files import suite
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

FEW = suite("wah", "test-1", limit=1)

OPENS = '''
from dataclasses import replace
from hearth.schemas.program import ObjectRef, Step

class Opens:
    """Opens and closes what it can, each time under another instance."""
    def reset(self, observation, goal, seed):
        pass
    def act(self, observation, legal):
        for step in legal:
            if step.action in ("Open", "Close"):
                refs = tuple(replace(ref, instance=observation.tick + 1) for ref in step.objects)
                return replace(step, objects=refs)
        return next((step for step in legal if step.action == "Walktowards"), None)
'''


def test_a_thing_under_another_number_is_the_same_thing(tmp_path, knowledge):
    (tmp_path / "mine.py").write_text(OPENS)
    lineup = Lineup("human_like", f"{tmp_path}/mine.py:Opens").checked()
    record = played(Job(FEW.tasks[0], 0, lineup, True, None, default))
    outcome, final = again(FEW.tasks[0], record, knowledge)
    assert (outcome.as_json(), final) == (record.metrics, record.final)


def test_a_helper_that_was_changed_is_another_helper(tmp_path):
    file, out = tmp_path / "mine.py", tmp_path / "r.jsonl"
    file.write_text("class H:\n    def reset(self, *_): pass\n    def act(self, *_): return None\n")
    lineup = Lineup("human_like", f"{file}:H")
    first = run(FEW, lineup, 1, out, default)
    assert first.header.code and read(out).header == first.header
    assert not any(each.end for each in run(FEW, lineup, 1, out, default).records)
    file.write_text("class H:\n    def reset(self, *_): raise ValueError\n    def act(self, *_): return None\n")
    again = run(FEW, lineup, 1, out, default)
    assert [bool(each.end) for each in again.records] == [False, True]


@pytest.mark.parametrize(
    "text", ["class H:\n    def __init__(self): raise ValueError('no')\n", "H = 3\n", "class H:\n    pass\n"]
)
def test_a_helper_that_cannot_be_made_is_refused_with_a_code(tmp_path, text):
    (tmp_path / "mine.py").write_text(text)
    with pytest.raises(HearthError) as found:
        played(Job(FEW.tasks[0], 0, Lineup("human_like", f"{tmp_path}/mine.py:H").checked(), True, None, default))
    assert found.value.diagnostics[0].code == Code.BAD_ARGUMENT


def test_episodes_that_two_files_have_come_once_and_messages_are_no_instructions(tmp_path):
    from dataclasses import replace

    found = [
        run(FEW, Lineup("human_like", name), 1, tmp_path / f"{name}.jsonl", default) for name in ("random", "none")
    ]
    assert len(list(_once(found))) == 2
    record = next(iter(found[0].records))
    said = replace(record, actions=(("Ask",), ("Tell ON(plate, 55) 2",), *record.actions))
    assert len(list(_trajectory(found[0], said))) == len(list(_trajectory(found[0], record)))
    other = replace(found[1], records=tuple(replace(each, final="x") for each in found[1].records))
    with pytest.raises(HearthError, match="two files"):
        list(_once([found[0], other]))


@pytest.mark.parametrize("name", ["hp_gpn", "nopa_gpn"])
def test_what_is_not_seen_changes_nothing_that_a_helper_is_told_of_places(name, knowledge):
    """Under partial observation the network is shown where things are believed to be, not where they are."""
    pytest.importorskip("torch")
    from hearth.agents.online_helper_registry import ONLINE
    from hearth.challenges.challenge_definition import challenge
    from hearth.simulation.env import Env

    which = challenge("owah_partial")
    task = suite("owah", "test", limit=1).tasks[0]
    start = task.start(knowledge)
    env = Env(partial=True)
    env.restore(start)
    view = env.observe(1)
    helper = ONLINE[name].make(which.goals_in)
    helper.reset(view, None, 0)
    hidden = [n for n, thing in enumerate(helper.space.things) if not view.mask >> thing & 1]
    shown, true = helper.places(view), helper.space.places(start)
    assert len(hidden) > 10 and sum(shown[n] != true[n] for n in hidden) > len(hidden) / 3
    whole = Env(partial=False)
    whole.restore(start)
    assert helper.places(whole.observe(1)) == true


def test_the_method_that_a_helper_lacks_is_named_alone(tmp_path):
    (tmp_path / "mine.py").write_text("class H:\n    def act(self, observation, legal): return None\n")
    lineup = Lineup("human_like", f"{tmp_path}/mine.py:H").checked()
    with pytest.raises(HearthError) as found:
        played(Job(FEW.tasks[0], 0, lineup, True, None, default))
    (fault,) = found.value.diagnostics
    assert fault.message.endswith(":H has no `reset`") and "reset(self, observation, goal, seed)" in fault.suggestion


def test_a_class_that_a_file_lacks_is_named_with_those_it_has(tmp_path):
    (tmp_path / "mine.py").write_text("from pathlib import Path\nclass Lazy:\n    pass\nOther = 3\n")
    for name in ("Nope", "Other"):
        with pytest.raises(HearthError) as found:
            load(f"{tmp_path}/mine.py:{name}")
        (fault,) = found.value.diagnostics
        assert fault.message.endswith(f"has no class `{name}`") and fault.suggestion == "its classes: `Lazy`"


def test_what_cannot_be_inferred_or_learned_is_refused_with_a_code(tmp_path):
    pytest.importorskip("torch")
    from hearth.analysis.online_inference import inference
    from hearth.challenges.learning_to_help import learn
    from hearth.models.interface import Training

    alone = run(FEW, Lineup("human_like", "none"), 1, tmp_path / "alone.jsonl", default)
    for refused in (lambda: inference(alone, default), lambda: learn("wah", "subgoals", default, Training(), limit=1)):
        with pytest.raises(HearthError) as found:
            refused()
        assert found.value.diagnostics[0].code == Code.BAD_ARGUMENT
