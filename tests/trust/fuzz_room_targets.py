"""Readers of what strangers give to challenges, models, studies and pages: targets of `guided_fuzz.py`.

Each takes a file's bytes, or a message's, and may raise only HearthError or the server's refusal. Those of what is
beside corpora, datasets and stores are in `fuzz_file_targets.py`, of knowledge, tables and goals in
`fuzz_table_targets.py`.
"""

from __future__ import annotations

import contextlib
import json
import shutil
from hashlib import sha256
from pathlib import Path
from typing import Any

from fuzz_file_targets import FILES, One, Room, _by_file, _signed_results
from fuzz_table_targets import TABLES

SMALL = "goal-inference"
"""The checkpoint whose description is changed."""

EMPTY = "retrieve-edit"
"""The checkpoint whose weights are changed: it has none."""


def _suite() -> Any:
    from hearth.challenges import task_files

    return task_files.suite("wah", "test-1", limit=1)


def _tasks() -> bytes:
    from hearth.challenges.task_files import suite_data

    return json.dumps(suite_data(_suite())).encode()


def _results() -> bytes:
    from hearth.challenges import result_files
    from hearth.challenges.episode_agents import Lineup
    from hearth.challenges.episodes import Job, played
    from hearth.kb.loading.load import default

    suite = _suite()
    header = result_files.Header(suite, Lineup("human_like", "none"), 1)
    record = played(Job(suite.tasks[0], 0, header.lineup, False, None, default))
    return b"".join([result_files.first_line(header), result_files.line(header, record)])


def _signed_tasks(path: Path) -> None:
    """Give a file of tasks the digest of what it holds, where that can be worked out."""
    from attacks_on_challenges import _signed

    with contextlib.suppress(ValueError, RecursionError):
        document = json.loads(path.read_bytes())
        if isinstance(document, dict):
            path.write_text(json.dumps(_signed(document)), "utf-8")


def _read_tasks(path: Path) -> Any:
    _signed_tasks(path)
    from hearth.challenges.episodes import start_of
    from hearth.challenges.task_files import read
    from hearth.kb.loading.load import default

    return [start_of(task, default(), 1) for task in read(path).tasks[:1]]


def _read_results(path: Path) -> Any:
    from attacks_on_challenges import consumed

    from hearth.challenges.result_files import read
    from hearth.challenges.verification import verify
    from hearth.kb.loading.load import default

    _signed_results(path)
    found = read(path)
    return verify(found, str(path), default), consumed(path)


def _episodes() -> bytes:
    from attacks_on_episodes import recorded

    return "".join(f"{json.dumps(each)}\n" for each in recorded()).encode()


def _read_episodes(path: Path) -> Any:
    from attacks_on_episodes import done_again

    return done_again(path)


def _ways() -> bytes:
    from attacks_on_ways import stored

    return stored()


def _walked(scratch: Path) -> One:
    from attacks_on_ways import read

    return lambda data: read(data, scratch)


def _read_study(path: Path) -> Any:
    from hearth.studies.study_file import read_study

    return read_study(path)


def _read_films(path: Path) -> Any:
    from hearth.studies.films_to_judge import read_films

    return read_films(path)


def _checkpoint(base: str, name: str) -> Room:
    """One file of a checkpoint is given, with a digest that fits; the other is as it was."""

    def example() -> bytes:
        from hearth.models.model_registry import TRAINED

        return (TRAINED / base / name).read_bytes()

    def reader(scratch: Path) -> One:
        from hearth.models.checkpoint import NAME
        from hearth.models.model_registry import TRAINED, restore_any

        folder = scratch / "checkpoint"
        shutil.copytree(TRAINED / base, folder)
        document = json.loads((folder / NAME).read_text("utf-8"))

        def one(data: bytes) -> Any:
            (folder / name).write_bytes(data)
            if name == NAME:
                (folder / name).write_bytes(_signed_description(data))
            else:
                (folder / NAME).write_text(json.dumps({**document, "weights": sha256(data).hexdigest()}), "utf-8")
            return restore_any(folder)

        return one

    return Room(example, reader)


def _signed_description(data: bytes) -> bytes:
    from hearth.storage.files import value_digest

    with contextlib.suppress(ValueError, RecursionError, TypeError, AttributeError):
        document = json.loads(data)
        return json.dumps({**document, "digest": value_digest(document.get("content"))}).encode()
    return data


def _kind(kind: str) -> Room:
    """The description of a checkpoint of a kind, with a digest that fits; the model is asked what its kind is asked."""

    def example() -> bytes:
        from small_checkpoints import folder_of

        return (folder_of(kind) / "model.json").read_bytes()

    def reader(scratch: Path) -> One:
        from small_checkpoints import ask, folder_of

        folder = Path(shutil.copytree(folder_of(kind), scratch / "checkpoint"))

        def one(data: bytes) -> Any:
            (folder / "model.json").write_bytes(_signed_description(data))
            return ask(folder, kind)

        return one

    return Room(example, reader)


def _place(kind: str) -> Room:
    """The same of kinds with long descriptions: two bytes say in which place the value is that follows them."""

    def reader(scratch: Path) -> One:
        from attacks_on_models import _document_of, _places, _put
        from small_checkpoints import ask, folder_of

        document = _document_of(kind)
        places = [place for part in ("settings", "content") for place in _places(document, part, 6)]
        folder = Path(shutil.copytree(folder_of(kind), scratch / "checkpoint"))

        def one(data: bytes) -> Any:
            changed = json.loads(json.dumps(document))
            try:
                value = json.loads(data[2:])
            except (ValueError, RecursionError):
                value = data[2:].decode("latin-1")
            _put(places[int.from_bytes(data[:2]) % len(places)], value)(changed)
            (folder / "model.json").write_bytes(_signed_description(json.dumps(changed).encode()))
            return ask(folder, kind)

        return one

    return Room(lambda: b'\x00\x00[["Walk", 1, -1, 0.5, null, [], {}], 0]', reader)


def _array() -> bytes:
    from attacks_on_films import _array
    from small_checkpoints import film

    return _array(film()[:9, ::3, ::3])


def _film(scratch: Path) -> One:
    """The bytes of an array, packed as they should be: its clips are named."""
    from attacks_on_films import _packed, named

    return lambda data: named(scratch / "given.npz", _packed({"class_ids.npy": data}))


def _archive() -> bytes:
    from attacks_on_films import above

    return above()


def _demonstration(scratch: Path) -> One:
    from attacks_on_films import sketched

    return lambda data: sketched(scratch / "above.npz", data)


def _video() -> bytes:
    from attacks_on_videos import video

    return video()


def _watched(path: Path) -> Any:
    from attacks_on_videos import watched

    return watched(path)


def _state() -> bytes:
    from tempfile import TemporaryDirectory

    from attacks_on_trainings import _line

    from hearth.models.training import STATE

    with TemporaryDirectory() as folder:
        _line(Path(folder))
        return Path(folder, STATE).read_bytes()


def _continued(scratch: Path) -> One:
    """A state of a training: it is taken up, or not."""
    from attacks_on_trainings import _line

    from hearth.models.training import STATE

    def one(data: bytes) -> Any:
        (scratch / STATE).write_bytes(data)
        return _line(scratch)

    return one


def _answers(scratch: Path) -> One:
    """A line of an agent, and the text in it, in the middle of nothing."""
    from hearth.challenges.wire_protocol import read_answer
    from hearth.envs.agent_answers import by_number, by_text
    from hearth.homes import library
    from hearth.kb.loading.load import default
    from hearth.simulation.actions.legal import legal
    from hearth.simulation.env import Env
    from hearth.simulation.observation.views import view
    from hearth.simulation.world.home import Home

    env = Env(knowledge=default())
    env.reset(Home.from_graph(library.load_graph("maple", default()), "maple", default()), 1)
    seen, may = view(env.world, 0), legal(env.world, 0, env.rules, only_visible=True)
    options = list(may)

    def one(data: bytes) -> Any:
        _, act = read_answer(data, 0)
        return by_number(act, options) if isinstance(act, int) else act is None or by_text(act, seen, may)

    return one


def _messages(scratch: Path) -> One:
    """A message of a page that puts a program together: its form, then its steps."""
    from hearth.kb.loading.load import default
    from hearth.web.annotate.program_draft import Draft, read_blocks
    from hearth.web.messages import Inbox
    from hearth.web.web_errors import WebError

    scene, known = Draft({"kitchen": 1}, {"cup": 2, "table": 1}), default()

    def one(data: bytes) -> Any:
        with contextlib.suppress(WebError):
            return read_blocks(Inbox().take(data).get("steps"), scene, known)

    return one


def _study() -> bytes:
    return Path(__file__).resolve().parents[2].joinpath("studies", "people-alone.yaml").read_bytes()


_FILM = (
    b'[{"item": 1, "condition": "agent", "name": "f1", "group": "agent", "about": "a task", "home": "maple", '
    b'"measure": 0.5, "content": ["[Sleep]"]}]'
)
_ANSWER = b'{"tick": 0, "act": "[Walk] <bed> (1)", "agent": 0}'
_STEPS = b'{"type": "check", "n": 1, "steps": [{"action": "Grab", "things": [["cup", 1]]}, {"special": "a nap"}]}'

ROOMS: dict[str, Room] = {
    "tasks": Room(_tasks, _by_file("tasks.json", _read_tasks)),
    "episodes": Room(_episodes, _by_file("episodes.jsonl", _read_episodes)),
    "results": Room(_results, _by_file("results.jsonl", _read_results)),
    "ways": Room(_ways, _walked),
    "study": Room(_study, _by_file("study.yaml", _read_study)),
    "films-list": Room(lambda: _FILM, _by_file("films.json", _read_films)),
    "checkpoint": _checkpoint(SMALL, "model.json"),
    "weights": _checkpoint(EMPTY, "weights.safetensors"),
    **{f"model-{kind}": _kind(kind) for kind in ("clips-rgb", "masks", "resactgraph", "nearest", "helping-actions")},
    **{
        f"model-{kind}": _place(kind)
        for kind in ("demo2sketch", "films-mle", "clips-seen", "consensus", "mle", "chooser")
    },
    "film-array": Room(_array, _film),
    "film-archive": Room(_archive, _demonstration),
    "film-video": Room(_video, _by_file("film.webm", _watched)),
    "training-state": Room(_state, _continued),
    "agent-answer": Room(lambda: _ANSWER, _answers),
    "page-steps": Room(lambda: _STEPS, _messages),
    **FILES,
    **TABLES,
}
