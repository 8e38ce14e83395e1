"""Reading a study's YAML: every fault is named with its line and its remedy."""

import re
from collections.abc import Sequence
from dataclasses import replace
from importlib.resources import files
from pathlib import Path
from typing import Any

from hearth.agents.agent_registry import HELPERS
from hearth.agents.human_like import HumanLike
from hearth.challenges.challenge_definition import challenge
from hearth.challenges.episode_agents import NOBODY, Lineup
from hearth.challenges.published_tasks import tasks as published
from hearth.schemas import located_yaml
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code
from hearth.schemas.numbers import number_of
from hearth.schemas.text_decoding import decode
from hearth.schemas.yaml_fields import Faults, ReadValue, fields, one_of, reads
from hearth.storage.input_files import read_input
from hearth.studies.assignment import assignment, balanced, imbalances
from hearth.studies.recruitment import Recruitment, is_completion, platforms
from hearth.studies.study import (
    AFTER,
    EPISODES,
    FILM,
    JUDGE,
    LANGUAGES,
    PLAY,
    PROGRAMS,
    ROOMS,
    SHOWN,
    SOURCES,
    Band,
    Condition,
    Films,
    Limits,
    Page,
    Question,
    Study,
    Tasks,
)  # fmt: skip

SHIPPED = ("people-alone", "people-with-helpers", "likeness-of-films", "online", "programs-by-lcs")
"""The studies that come with Hearth; each is a file of this package."""

_NAME = re.compile(r"[a-z][a-z0-9_-]{0,59}")

MOST_PEOPLE, MOST_TRIALS = 5_000, 100_000

name = reads("a name of letters, digits, - and _", lambda it: isinstance(it, str) and _NAME.fullmatch(it), then=str)
text = reads("a text of 1 to 20,000 characters", lambda it: isinstance(it, str) and 0 < len(it) <= 20_000, then=str)
hours = reads("a number above 0", lambda it: isinstance(it, located_yaml.Number) and 0 < it < 10_000, then=float)
share = reads("a number from 0 to 1", lambda it: isinstance(it, located_yaml.Number) and 0 <= it <= 1, then=float)
yes = reads("true or false", lambda it: isinstance(it, bool))


def whole(low: int, high: int) -> ReadValue:
    """Return a reader of whole numbers between two."""
    return reads(
        f"a whole number from {low} to {high:,}",
        lambda it: isinstance(it, located_yaml.Number) and float(it).is_integer() and low <= it <= high,
        then=int,
    )


def _mapping(value: Any) -> Any:
    return value


STUDY_KEYS: dict[str, ReadValue] = {
    "name": name, "title": text, "source": text, "room": one_of(*ROOMS), "seed": whole(0, 2**53), "consent": text,
    "people": whole(1, MOST_PEOPLE), "tutorial": list, "practice": whole(0, 10), "tasks": _mapping, "films": _mapping,
    "interface": one_of("symbolic", "visual"), "conditions": list, "repeats": whole(1, 1000),
    "at_least": whole(0, 1000), "limits": _mapping, "alone": name, "questions": list, "exit": list,
    "recruitment": _mapping, "language": one_of(*LANGUAGES),
}  # fmt: skip
NEEDED = ("name", "title", "room", "seed", "people", "consent", "conditions")

PAGE_KEYS: dict[str, ReadValue] = {"title": text, "text": text}
TASK_KEYS: dict[str, ReadValue] = {"challenge": one_of("wah", "owah"), "split": text, "number": whole(1, 10_000)}
FILM_KEYS: dict[str, ReadValue] = {"of": one_of(*SOURCES), "study": name, "bands": list, "each": whole(1, 1000),
                                  "shown": one_of(*SHOWN)}  # fmt: skip
BAND_KEYS: dict[str, ReadValue] = {"name": name, "title": text, "from": share, "to": share}
LIMIT_KEYS: dict[str, ReadValue] = {"minutes": hours, "idle_hours": hours, "least_seconds": hours}
RECRUITMENT_KEYS: dict[str, ReadValue] = {
    "platform": one_of(*platforms()),
    "completion": reads("an https address; {person} and {code} are filled in", is_completion, then=str),
}
CONDITION_KEYS: dict[str, ReadValue] = {
    "name": name, "title": text, "helper": text, "goal": text, "actor": one_of("person", "agent"),
}  # fmt: skip
QUESTION_KEYS: dict[str, ReadValue] = {
    "name": name, "text": text, "scale": _mapping, "choices": list, "required": yes, "after": one_of(*AFTER),
    "correct": reads("a number or a choice", lambda it: isinstance(it, str | located_yaml.Number)),
}  # fmt: skip


def read_study(path: Path) -> Study:
    """Return the study of a file.

    Raises:
        HearthError: every fault of the file, with its line and its remedy; MISSING_FILE, NOT_TEXT, FILE_TOO_LARGE.
    """
    found = decode(read_input(path), str(path))
    if isinstance(found, Diagnostic):
        raise HearthError(found)
    return study_of(found, str(path))


def named(given: str) -> Study:
    """Return a study that comes with Hearth, by its name; else that of a file."""
    if given in SHIPPED:
        return study_of(files("hearth.studies").joinpath(f"{given}.yaml").read_text("utf-8"), f"{given}.yaml")
    return read_study(Path(given))


def study_of(content: str, file: str, begun: bool = False) -> Study:
    """Return the study of a text; errors as of `read_study`.

    A study that has `begun` is read whatever its helpers could do, so that its collected data stays readable.
    """
    tree = located_yaml.read(content, file)
    faults = Faults(file)
    top = fields(tree, STUDY_KEYS, "a study", faults, NEEDED)
    found = _study(top, tree, faults, content)
    if found is not None and not faults:
        _check_balance(found, tree, faults)
        if not begun:
            _check_helpers(found, top["conditions"], faults)
    if faults or found is None:
        raise HearthError(faults.underlined(content))
    return found


def _study(top: dict[str, Any], tree: Any, faults: Faults, content: str) -> Study | None:
    """Return the study; None where something without which it can't be read is lacking."""
    room = top.get("room", PLAY)
    tasks = _tasks(top.get("tasks"), tree, faults) if "tasks" in top else None
    films = _films(top.get("films"), faults) if "films" in top else None
    conditions = [_condition(each, room, faults) for each in top.get("conditions", ())]
    _check_room(room, top, tasks, films, tree, faults)
    _distinct([each.name for each in conditions], "conditions", tree, faults)
    questions = [_question(each, faults) for each in top.get("questions", ())]
    at_end = [_question(each, faults) for each in top.get("exit", ())]
    _distinct([each.name for each in (*questions, *at_end)], "questions", tree, faults)
    pages = [fields(each, PAGE_KEYS, "a page", faults, ("title", "text")) for each in top.get("tutorial", ())]
    limits = fields(top["limits"], LIMIT_KEYS, "the limits", faults) if "limits" in top else {}
    recruited = None
    if "recruitment" in top:
        recruited = fields(top["recruitment"], RECRUITMENT_KEYS, "`recruitment`", faults, ("platform",))
    if faults:
        return None
    return Study(
        top["name"], top["title"], top.get("source", ""), room, top["seed"], top["people"], top["consent"],
        tuple(Page(**page) for page in pages), top.get("practice", 0), tasks, films, top.get("interface", "symbolic"),
        tuple(conditions), top.get("repeats", 1), top.get("at_least", 0), Limits(**limits), top.get("alone", ""),
        tuple(questions), tuple(at_end), content, None if recruited is None else Recruitment(**recruited),
        top.get("language", ""),
    )  # fmt: skip


def _tasks(entry: Any, tree: Any, faults: Faults) -> Tasks | None:
    found = fields(entry, TASK_KEYS, "`tasks`", faults, ("challenge", "split", "number"))
    if len(found) < len(TASK_KEYS):
        return None
    try:
        there = len(published(found["challenge"], found["split"], limit=found["number"]))
    except HearthError as error:
        first = error.diagnostics[0]
        faults.add(Code.BAD_ARGUMENT, first.message, entry.at("split"), first.suggestion)
        return None
    if there < found["number"]:
        faults.add(Code.BAD_ARGUMENT, f"the split has {there} tasks", entry.at("number"), f"at most {there}")
    return Tasks(**found)


def _films(entry: Any, faults: Faults) -> Films:
    found = fields(entry, FILM_KEYS, "`films`", faults, ("of",))
    if found.get("of") == EPISODES:
        if "study" not in found:
            faults.add(Code.SYNTAX, "`films` of episodes need `study`", entry.at("of"), "study: people-alone")
        return Films(EPISODES, found.get("study", ""), shown=found.get("shown", FILM))
    bands = []
    for each in found.get("bands", ()):
        band = fields(each, BAND_KEYS, "a band", faults, ("name", "title", "from", "to"))
        if len(band) == len(BAND_KEYS):
            if band["from"] >= band["to"]:
                faults.add(Code.BAD_ARGUMENT, "the band is empty", located_yaml.line_of(each), "`from` is below `to`")
            bands.append(Band(band["name"], band["title"], band["from"], band["to"]))
    if isinstance(entry, located_yaml.Mapping) and not (bands and "each" in found):
        faults.add(Code.SYNTAX, "`films` of programs need `bands` and `each`", entry.line, "each: 10")
    return Films(PROGRAMS, "", tuple(bands), found.get("each", 0), found.get("shown", FILM))


def _condition(entry: Any, room: str, faults: Faults) -> Condition:
    found = fields(entry, CONDITION_KEYS, "a condition", faults, ("name", "title"))
    line = located_yaml.line_of(entry)
    helper, goal = found.get("helper", NOBODY), found.get("goal", "")
    if room == JUDGE and (helper, goal) != (NOBODY, ""):
        faults.add(Code.BAD_ARGUMENT, "a person who judges films has no helper", line, "leave out `helper` and `goal`")
    elif ":" in helper:
        faults.add(Code.BAD_ARGUMENT, "a study's helper is one of ours", line, "`challenge run` runs others")
    else:
        try:
            lineup = Lineup(helper=helper, goal=goal).checked()
            if reads_plans(lineup.helper):
                message = f"`{helper}` reads its partner's plan, and people have none that it could read"
                faults.add(Code.BAD_ARGUMENT, message, line, "hp, hp_random, nopa, ...")
        except HearthError as error:
            first = error.diagnostics[0]
            faults.add(first.code, first.message, line, first.suggestion)
    return Condition(found.get("name", ""), found.get("title", ""), helper, goal, found.get("actor", ""))


def reads_plans(helper: str) -> bool:
    """Return whether a helper is made for a partner that is a program, whose subgoal it reads."""
    partner = HumanLike()
    return helper in HELPERS and getattr(HELPERS[helper].make(partner), "partner", None) is partner


def _question(entry: Any, faults: Faults) -> Question:
    """Return a question; a right answer must be one of those that it can have."""
    made = _plain_question(entry, faults)
    if not isinstance(entry, located_yaml.Mapping) or "correct" not in entry:
        return made
    given = entry["correct"]
    right = int(given) if isinstance(given, located_yaml.Number) and float(given).is_integer() else given
    if made.kind == "text" or made.fault(right):
        remedy = f"{made.low} to {made.high}" if made.kind == "scale" else "one of `choices`"
        faults.add(Code.BAD_ARGUMENT, "`correct` is no answer to the question", entry.at("correct"), remedy)
        return made
    return replace(made, correct=right if isinstance(right, int) else str(right))


def _plain_question(entry: Any, faults: Faults) -> Question:
    found = fields(entry, QUESTION_KEYS, "a question", faults, ("name", "text"))
    line = located_yaml.line_of(entry)
    plain: dict[str, Any] = {key: found[key] for key in ("required", "after") if key in found}
    if "scale" in found and "choices" in found:
        faults.add(Code.SYNTAX, "a question has a scale or choices, not both", line, "leave one of them out")
    if "scale" in found:
        return Question(
            found.get("name", ""), found.get("text", ""), "scale", **_scale(found["scale"], faults), **plain
        )
    if "choices" in found:
        choices = [each for each in found["choices"] if isinstance(each, str) and each]
        if len(choices) < max(2, len(found["choices"])):
            faults.add(Code.SYNTAX, "`choices` is a list of two or more texts", line, '["yes", "no"]')
        return Question(found.get("name", ""), found.get("text", ""), "choice", choices=tuple(choices), **plain)
    return Question(found.get("name", ""), found.get("text", ""), "text", **plain)


def _scale(entry: Any, faults: Faults) -> dict[str, Any]:
    keys = {"from": whole(0, 100), "to": whole(1, 100), "labels": _mapping}
    found = fields(entry, keys, "a scale", faults, ("from", "to"))
    low, high = found.get("from", 1), found.get("to", 1)
    line = located_yaml.line_of(entry)
    if {"from", "to"} <= found.keys() and low >= high:
        faults.add(Code.BAD_ARGUMENT, f"the scale from {low} to {high} is empty", line, "`from` is below `to`")
    labels = found.get("labels") or {}
    if not isinstance(labels, dict) or any(not _is_of_scale(key, low, high) for key in labels):
        faults.add(Code.SYNTAX, "`labels` gives words to numbers of the scale", line, f"labels: {{{low}: never}}")
        labels = {}
    return {"low": low, "high": high, "labels": tuple((int(key), str(word)) for key, word in labels.items())}


def _is_of_scale(key: str, low: int, high: int) -> bool:
    """Return whether a key is a number of a scale; other digits than 0 to 9, or thousands of them, are none."""
    number = number_of(key)
    return number is not None and low <= number <= high


def _check_room(room: str, top: dict[str, Any], tasks: Any, films: Any, tree: Any, faults: Faults) -> None:
    line = tree.at("room") if isinstance(tree, located_yaml.Mapping) else 0
    if room == PLAY:
        if "tasks" not in top:
            faults.add(Code.SYNTAX, "people who play need `tasks`", line, "tasks: {challenge: wah, ...}")
        if films is not None:
            faults.add(Code.SYNTAX, "`films` are for people who judge", tree.at("films"), "room: judge")
        return
    if films is None:
        faults.add(Code.SYNTAX, "people who judge need `films`", line, "films: {of: episodes, study: people-alone}")
    elif films.of == EPISODES and "tasks" not in top:
        faults.add(Code.SYNTAX, "films of episodes need `tasks`", line, "tasks: {challenge: wah, ...}")
    elif films.of != EPISODES and tasks is not None:
        faults.add(Code.SYNTAX, "films of programs have no `tasks`", tree.at("tasks"), "leave it out")
    if not top.get("questions"):
        faults.add(Code.SYNTAX, "people who judge need `questions`", line)


def _distinct(names: list[str], what: str, tree: Any, faults: Faults) -> None:
    for each in sorted({one for one in names if names.count(one) > 1 and one}):
        faults.add(Code.DUPLICATE, f"two {what} are called `{each}`", tree.at(what), "rename one of them")


def _check_balance(study: Study, tree: Any, faults: Faults) -> None:
    if not study.conditions:
        faults.add(Code.SYNTAX, "there is not one condition", tree.at("conditions"), "- {name: alone, title: Alone}")
        return
    if not study.people <= study.trials <= MOST_TRIALS:
        message = f"{study.trials:,} trials for {study.people:,} people"
        faults.add(Code.BAD_ARGUMENT, message, tree.at("people"), f"one each at least, {MOST_TRIALS:,} in all at most")
        return
    groups = groups_of(study)
    if found := imbalances(study, assignment(study, groups)):
        more = f", and {len(found) - 1:,} more places or tasks are not balanced" if len(found) > 1 else ""
        remedy = " or ".join(balanced(study, groups)) or "change `people`, `repeats`, `tasks` or `at_least`"
        faults.add(Code.CONTRADICTION, found[0] + more, tree.at("people"), f"write {remedy}")


def _check_helpers(study: Study, entries: Sequence[Any], faults: Faults) -> None:
    """Name the helpers that would end every episode of the study's challenge."""
    if study.room != PLAY or study.tasks is None:
        return
    for condition, entry in zip(study.conditions, entries, strict=True):
        try:
            Lineup(helper=condition.helper, goal=condition.goal).checked().fits(challenge(study.tasks.challenge))
        except HearthError as error:
            first = error.diagnostics[0]
            faults.add(first.code, first.message, located_yaml.line_of(entry), first.suggestion)


def groups_of(study: Study) -> int:
    """Return how many kinds of tasks come in turn: the goal sets of a challenge, or the bands of programs."""
    if study.tasks is not None:
        return len(challenge(study.tasks.challenge).grammar.sets)
    return len(study.films.bands) if study.films else 1
