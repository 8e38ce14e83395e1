"""The action, the observation and the state, as they are sent."""

from openenv.core.env_server.types import Action, Observation, State
from pydantic import Field


class HearthAction(Action):
    """A command: one line."""

    command: str = Field(max_length=20_000, description="One command, such as `Walk fridge 142`.")


class HearthObservation(Observation):
    """The words of a world after a command; `reward` is 1.0 with the command that reaches the goal, else 0.0."""

    text: str = Field(description="The goal, what the agent sees, and commands that make sense.")
    legal: list[str] = Field(default_factory=list, description="Every command that is legal.")
    instructions: str = Field(default="", description="How to act; after a reset alone.")
    fault: dict[str, str] | None = Field(
        default=None, description="Why the command was refused: code, message, remedy."
    )
    total: float = Field(default=0.0, description="The rewards of Hearth's engine up to here.")


class HearthState(State):
    """The facts of an episode that the agent does not see."""

    task: str = ""
    won: bool = False
    goal_fraction: float = 0.0
    ticks: int = 0
    faults: int = 0
    protocol: str = ""
