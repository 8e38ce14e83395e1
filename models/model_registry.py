"""The models by name. To add one: a file with its settings, a row here, a test."""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from pathlib import Path
from typing import Any, Literal, NamedTuple

from hearth.models.checkpoint import MISFITS, load, misfit
from hearth.models.protocols import Model, Trained
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

TRAINED = Path(__file__).parent / "trained"
"""Checkpoints that come with Hearth, a folder each, named as in `model list`."""


class Entry(NamedTuple):
    """A model: the place of its settings (`module:Class` of `hearth.models`), its input, its line, its source.

    `learns` is false for one that needs no training; `output` is `sketch` for one that learns to write sketches;
    `by` is the command that trains one that writes no programs.
    """

    place: str
    input: Literal["text", "sketch", "film", "episode"]
    line: str
    source: str
    settings: dict[str, Any] = {}  # noqa: RUF012
    learns: bool = True
    output: Literal["program", "sketch"] = "program"
    by: str = ""


MODELS: dict[str, Entry] = {
    "random-retrieval": Entry(
        "text.retrieval:RandomRetrieval", "text", "The program of a random training example.", "thesis 4.5.2"
    ),
    "nearest": Entry(
        "text.retrieval:Nearest", "text", "The program with the most similar description, by TF-IDF.", "thesis 4.5.2"
    ),
    "nearest-svd": Entry(
        "text.retrieval:Nearest",
        "text",
        "The same in the space of 100 singular vectors.",
        "thesis 4.5.2",
        {"singular": 100},
    ),
    "planner": Entry(
        "planner:Planner",
        "sketch",
        "Binds the sketch to the nearest nodes; the repairs make it run. It needs no training.",
        "ours",
        learns=False,
    ),
    **{
        name: Entry("sketches.graph_model:GraphModel", "sketch", line, "thesis 5.4.2, 5.6.2", settings)
        for name, line, settings in (
            ("unaries", "Nodes without their relations.", {"change": "none", "rounds": 0}),
            ("graph", "A graph network; what is done changes nothing in it.", {"change": "none"}),
            ("fcactgraph", "A layer changes the nodes that a step is about.", {"change": "layer"}),
            ("gruactgraph", "A recurrent cell changes the nodes that a step is about.", {"change": "recurrent"}),
            ("resactgraph", "Residuals change the nodes that a step is about.", {"change": "residual"}),
        )
    },
    "chooser": Entry(
        "sketches.plan_chooser:Chooser", "sketch", "Chooses nodes and optional steps; the planner makes it run.", "ours"
    ),
    "chooser-text": Entry(
        "sketches.plan_chooser:Chooser",
        "sketch",
        "The same; it reads the description as well as the sketch.",
        "ours",
        {"text": True},
    ),
    "masks": Entry("films.mask_model:MaskModel", "film", "Predicts the class masks of pictures.", "thesis 4.3.3"),
    "clips-rgb": Entry(
        "films.clip_model:ClipModel",
        "film",
        "Names the instruction of a two-second clip by its colours.",
        "thesis 4.3.3",
    ),
    "clips-seen": Entry(
        "films.mask_clip_model:SeenModel",
        "film",
        "Names it by the behavior of each mask class near the person; it points at the objects.",
        "ours",
    ),
    "clips-context": Entry(
        "films.mask_clip_model:SeenModel",
        "film",
        "The same; it looks at seven seconds before and after each clip, too.",
        "ours",
        {"context": True},
    ),
    "clips-predicted": Entry(
        "films.mask_clip_model:SeenModel",
        "film",
        "The same; it learns from masks as a network predicts them (--set masks=FOLDER), too.",
        "ours",
        {"context": True, "masks": "masks"},
    ),
    "films-mle": Entry(
        "films.film_writer:FilmWriter",
        "film",
        "LSTM with attention over what a classifier of clips (--set start=FOLDER) says.",
        "thesis 4.3.3",
    ),
    "films-pg-lcs": Entry(
        "films.film_self_critical:FilmCritical",
        "film",
        "A trained `films-mle` (--set start=FOLDER) trained on by LCS.",
        "thesis 4.3.1",
    ),
    "films-pg-lcs-sim": Entry(
        "films.film_self_critical:FilmCritical",
        "film",
        "A trained `films-pg-lcs` trained on by LCS and a tenth for programs that run.",
        "thesis 4.3.1",
        {"reward": "lcs+sim"},
    ),
    "demo2sketch": Entry(
        "demonstrations.demo_model:DemoModel",
        "film",
        "Writes the sketch of pictures from above, by colors, masks and the area around the person.",
        "thesis 5.4.3, A.1",
        output="sketch",
    ),
    "goal-inference": Entry(
        "watching.goal_inference:GoalInference",
        "film",
        "What somebody wants, from where things were seen.",
        "thesis B.3.1",
        by="challenge learn wah",
    ),
    "helping-subgoals": Entry(
        "helping.policies:HelpingPolicy",
        "episode",
        "Hybrid's choice of subgoals.",
        "thesis B.3.5",
        by="challenge learn wah --what subgoals",
    ),
    "helping-actions": Entry(
        "helping.policies:HelpingPolicy",
        "episode",
        "HRL's choice of actions for a subgoal.",
        "thesis B.3.4",
        {"chooses": "actions"},
        by="challenge learn wah --what actions",
    ),
    "mle": Entry(
        "text.text_models:TextModel",
        "text",
        "LSTM with attention over a closed list of steps.",
        "thesis 4.3.1",
        {"steps": "closed", "copy": False},
    ),
    "mle-composed": Entry(
        "text.text_models:TextModel",
        "text",
        "The same; steps composed of action and objects, which may be copied.",
        "ours",
    ),
    "pg-lcs": Entry(
        "text.self_critical:SelfCritical",
        "text",
        "A trained `mle-composed` (--set start=FOLDER) trained on by LCS.",
        "thesis 4.3.1",
    ),
    "pg-lcs-sim": Entry(
        "text.self_critical:SelfCritical",
        "text",
        "The same by LCS and a tenth for programs that run.",
        "thesis 4.3.1",
        {"reward": "lcs+sim"},
    ),
    "transformer": Entry(
        "text.text_models:TextModel",
        "text",
        "A small transformer with composed steps and copying.",
        "ours",
        {"body": "transformer", "layers": 2, "hidden": 128},
    ),
    "retrieve-edit": Entry(
        "text.retrieve_edit:RetrieveEdit",
        "text",
        "The consensus of similar texts' programs, with the asked objects.",
        "ours",
    ),
    "consensus": Entry(
        "text.consensus_model:Consensus",
        "text",
        "The program most like those that `mle-composed` draws and `retrieve-edit` finds.",
        "ours",
    ),
    "desc2sketch": Entry(
        "text.text_models:TextModel",
        "text",
        "`mle-composed` that writes the sketch of a description.",
        "thesis 5.4.1, A.1",
        {"dropout": 0.5},
        output="sketch",
    ),
    "retrieve-sketch": Entry(
        "text.retrieve_edit:RetrieveEdit",
        "text",
        "`retrieve-edit` over the sketches of similar descriptions.",
        "ours",
        output="sketch",
    ),
    "consensus-sketch": Entry(
        "text.consensus_model:Consensus",
        "text",
        "The sketch most like those that `desc2sketch` draws and `retrieve-sketch` finds.",
        "ours",
        output="sketch",
    ),
}


def settings_of(name: str, **changed: Any) -> Model:
    """Return the settings of a model, its own or with some changed.

    Raises:
        HearthError: UNKNOWN_ID, if there is no such model; BAD_ARGUMENT, if it writes no programs; MISSING_FILE, if the
            extra is not installed.
    """
    entry = MODELS.get(name)
    if entry is None:
        import difflib

        near = difflib.get_close_matches(name, MODELS, n=1)
        suggestion = f"did you mean `{near[0]}`?" if near else f"there are {', '.join(MODELS)}"
        raise HearthError.of(Code.UNKNOWN_ID, f"no model is called `{name}`", suggestion=suggestion)
    if entry.by:
        raise _writes_nothing(name, f"hearth {entry.by} --out FOLDER trains it")
    made: Model = _class(entry)(**{**entry.settings, **changed})
    return made


def _writes_nothing(name: str, remedy: str) -> HearthError:
    return HearthError.of(Code.BAD_ARGUMENT, f"`{name}` writes no programs", suggestion=remedy)


def _class(entry: Entry) -> Any:
    module, name = entry.place.split(":")
    try:
        return getattr(import_module(f"hearth.models.{module}"), name)
    except ModuleNotFoundError as error:
        from hearth.schemas.optional_libraries import library

        library(str(error.name))
        raise


def trained_names() -> list[str]:
    """Return the names of the checkpoints that come with Hearth."""
    return sorted(path.parent.name for path in TRAINED.glob("*/model.json"))


def restore(model: str | Path) -> tuple[str, Trained]:
    """Return a trained model that writes programs, and its name: of a checkpoint's folder, or of one that comes
    with Hearth.

    Raises:
        HearthError: as of `restore_any`; BAD_ARGUMENT, if it writes no programs.
    """
    name, trained = restore_any(model)
    if MODELS[name].by:
        raise _writes_nothing(str(model), "hearth challenge run TASKS --helper hybrid uses such models")
    found: Trained = trained
    return name, found


def restore_any(model: str | Path) -> tuple[str, Any]:
    """Return the name and the trained model of a checkpoint of any kind.

    Raises:
        HearthError: there is none, it is broken or of another version, or the extra is not installed.
    """
    if _learns_nothing(model):
        return str(model), _class(MODELS[str(model)])()
    folder = _folder(model)
    if str(model) in MODELS and not folder.exists():
        message = f"`{model}` has not been trained"
        command = MODELS[str(model)].by or f"model train {model} DATASET"
        suggestion = f"hearth {command} --out FOLDER, and name that folder"
        raise HearthError.of(Code.MISSING_FILE, message, suggestion=suggestion)
    checkpoint = load(folder)
    entry = MODELS.get(checkpoint.model)
    if entry is None:
        message = f"a checkpoint of the model `{checkpoint.model}`, which this version of Hearth does not have"
        raise HearthError.of(Code.UNSUPPORTED_FILE, message, file=str(folder), suggestion="install a newer Hearth")
    try:
        return checkpoint.model, _class(entry).restored(checkpoint)
    except MISFITS as error:
        raise misfit(folder, error) from error


def named(model: str | Path) -> str:
    """Return the name in the registry of a model that can be restored; of a newer version's the one that it has there.

    Raises:
        HearthError: there is none, or it is broken.
    """
    return str(model) if _learns_nothing(model) else load(_folder(model)).model


def recorded(model: str | Path) -> Mapping[str, Any]:
    """Return the facts about its training that a model's checkpoint records; nothing if it has no checkpoint.

    Raises:
        HearthError: there is none, or it is broken.
    """
    return {} if _learns_nothing(model) else load(_folder(model)).trained


def _learns_nothing(model: str | Path) -> bool:
    return str(model) in MODELS and not MODELS[str(model)].learns and not Path(model).exists()


def _folder(model: str | Path) -> Path:
    return TRAINED / str(model) if str(model) in trained_names() else Path(model)
