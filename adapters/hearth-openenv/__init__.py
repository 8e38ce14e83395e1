"""Household tasks in text as an environment of OpenEnv."""

from .client import HearthEnv
from .models import HearthAction, HearthObservation

__all__ = ["HearthAction", "HearthEnv", "HearthObservation"]
