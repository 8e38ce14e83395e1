from duckdb import DuckDBPyConnection

from hearth.challenges.array_homes import ArrayHomes as ArrayHomes
from hearth.challenges.language_runs import run_tasks as run_tasks
from hearth.challenges.task_files import suite as suite
from hearth.challenges.text_episode import TextEpisode as TextEpisode
from hearth.datasets.dataset import Dataset as Dataset
from hearth.datasets.execution_graphs import ExecutionGraphs as ExecutionGraphs
from hearth.datasets.export.formats import export as export
from hearth.datasets.verify import verify as verify
from hearth.envs.text_homes import TextHome as TextHome
from hearth.envs.text_homes import TextHomes as TextHomes
from hearth.grounding.binding import bind as bind
from hearth.grounding.environments.sampling import sample as sample
from hearth.grounding.preconditions.precondition_inference import infer as infer
from hearth.homes.library import load_graph as load_graph
from hearth.homes.procedural.home_generator import generate as generate
from hearth.kb.knowledge import Knowledge
from hearth.kb.language.step_understanding import understand as understand
from hearth.kb.tools.find import Query as Query
from hearth.kb.tools.find import find as find
from hearth.llm.endpoint import Endpoint as Endpoint
from hearth.pipelines.build import build as build
from hearth.pipelines.readers.plans_in_words import parse_steps as parse_steps
from hearth.rendering.film.execution_keyframes import trajectory_of as trajectory_of
from hearth.rendering.film.video import record as record
from hearth.rendering.modalities import render as render
from hearth.rendering.scene.scene_preparation import scene_of as scene_of
from hearth.repair.augmentation import augment as augment
from hearth.repair.sketch import sketch as sketch
from hearth.schemas.diagnostics import HearthError as HearthError
from hearth.schemas.goals import Goal as Goal
from hearth.schemas.literals import Literal as Literal
from hearth.schemas.program import Program
from hearth.scoring.evaluate import evaluate as evaluate
from hearth.scoring.metrics.executability import executability as executability
from hearth.scoring.predictions import read_pairs as read_pairs
from hearth.simulation.engine import run as run
from hearth.simulation.env import Env as Env
from hearth.simulation.goal_text import read_goal as read_goal
from hearth.simulation.goals import Progress as Progress
from hearth.simulation.hazards import hazards as hazards
from hearth.simulation.lasting_changes import irreversible as irreversible
from hearth.simulation.literal_truth import holds as holds
from hearth.simulation.world.edit import edit as edit
from hearth.simulation.world.home import Home as Home
from hearth.simulation.world.world import World as World

__version__: str

def attach(connection: DuckDBPyConnection, path: str, name: str) -> None: ...
def load(path: str, failures: bool = False) -> Dataset: ...
def knowledge(overlay: str | None = None) -> Knowledge: ...
def home(name: str, knowledge: Knowledge | None = None) -> Home: ...
def parse_program(text: str, knowledge: Knowledge | None = None) -> Program: ...
