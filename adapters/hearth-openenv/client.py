"""The client of a server: `HearthEnv(base_url=...)`."""

from typing import Any

from openenv.core import EnvClient
from openenv.core.client_types import StepResult

from .models import HearthAction, HearthObservation, HearthState


class HearthEnv(EnvClient[HearthAction, HearthObservation, HearthState]):
    """A connection with a world of its own."""

    def _step_payload(self, action: HearthAction) -> dict[str, Any]:
        return {"command": action.command}

    def _parse_result(self, payload: dict[str, Any]) -> StepResult[HearthObservation]:
        seen = HearthObservation(**{**payload.get("observation", {}), "done": payload.get("done", False)})
        return StepResult(observation=seen, reward=payload.get("reward"), done=payload.get("done", False))

    def _parse_state(self, payload: dict[str, Any]) -> HearthState:
        return HearthState(**payload)
