"""Libraries that only parts of Hearth need: each is of an extra of the package, and imported where it is used."""

import importlib
import importlib.util
from pathlib import Path
from typing import Any

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.version import DISTRIBUTION

CHECKOUT = Path(__file__).parents[1] / "pyproject.toml"
"""In a checkout, Hearth runs from its folder; a wheel has no such folder."""

EXTRAS = {
    "agents": ("gymnasium", "pettingzoo"),
    "dask": ("dask", "distributed"),
    "episodes": ("minari", "h5py"),
    "llm": ("httpx2",),
    "mcp": ("mcp",),
    "models": ("torch", "safetensors"),
    "pictures": ("cv2", "matplotlib", "numba", "open3d", "trimesh"),
    "plan": ("unified_planning",),
    "remote": ("fsspec",),
    "web": ("sqlalchemy", "starlette", "uvicorn", "websockets"),
}
"""The modules of each extra of pyproject.toml."""

MADE = {"agents": "make setup", "pictures": "make setup", "web": "make setup", "models": "make .venv/.models"}
"""The make targets that install some extras in a checkout; pip of `.venv` installs the others."""


def library(module: str) -> Any:
    """Import a module of an extra's library.

    Raises:
        HearthError: MISSING_FILE, if the library is not installed.
    """
    try:
        return importlib.import_module(module)
    except ModuleNotFoundError as error:
        name = str(error.name).partition(".")[0]
        extra = next((extra for extra, modules in EXTRAS.items() if name in modules), None)
        if extra is None:
            raise
        raise HearthError.of(Code.MISSING_FILE, f"this needs {name}, which is not installed",
                             suggestion=remedy(extra)) from error  # fmt: skip


def remedy(extra: str) -> str:
    """Return how to install an extra where Hearth is."""
    if not CHECKOUT.is_file():
        return f"run `pip install '{DISTRIBUTION}[{extra}]'`"
    command = MADE.get(extra, f".venv/bin/python -m pip install '.[{extra}]'")
    return f"run `{command}` in a checkout, else `pip install '.[{extra}]'` in Hearth's folder"


def lacking(extra: str) -> list[str]:
    """Return the modules of an extra that are not installed, found without importing them."""
    return [name for name in EXTRAS[extra] if not _found(name)]


def _found(name: str) -> bool:
    try:
        return importlib.util.find_spec(name) is not None
    except (ImportError, ValueError):
        return False
