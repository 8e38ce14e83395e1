"""Import paths of earlier versions: each still imports the module that has its content now, with a warning."""

from __future__ import annotations

import sys
import warnings
from importlib import import_module
from importlib.machinery import ModuleSpec
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Sequence
    from importlib.abc import Loader, MetaPathFinder
    from types import CodeType, ModuleType
else:  # `importlib.abc` takes as long to import as the rest of `hearth`
    Loader = MetaPathFinder = object

MODULES = {
    # 0.2 -> 0.3: rooms of environments and of other projects' formats
    "challenges.action_codes": "envs.action_codes",
    "challenges.answers": "envs.answers",
    "challenges.edges": "envs.edge_arrays",
    "challenges.episode_export": "interop.episode_export",
    "challenges.goal_rows": "envs.goal_arrays",
    "challenges.lerobot_export": "interop.lerobot_export",
    "challenges.minari_export": "interop.minari_export",
    "challenges.observations": "envs.observations",
    "challenges.parallel": "envs.pettingzoo_env",
    "challenges.plan_pictures": "envs.render_modes",
    "challenges.rewards": "envs.rewards",
    "challenges.seen_arrays": "envs.observation_arrays",
    "challenges.session": "envs.session",
    "challenges.single": "envs.gymnasium_env",
    "challenges.slots": "envs.node_slots",
    "challenges.text_protocol": "envs.text_protocol",
}
"""The module of today for each module that was renamed or moved, both without `hearth.`."""

_PACKAGE = __name__.partition(".")[0]


class OldModules(MetaPathFinder):
    """Finds modules by the names of `MODULES`; Python asks it last, for what no other finder has."""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Return the specification of a module of an earlier version."""
        package, _, module = fullname.partition(".")
        if package != _PACKAGE or module not in MODULES:
            return None
        return ModuleSpec(fullname, OldModule(f"{package}.{MODULES[module]}"))


class OldModule(Loader):
    """Gives an old name the very module of today, so that its classes stay one.

    Attributes:
        today: the full name of that module.
    """

    def __init__(self, today: str) -> None:
        self.today = today

    def create_module(self, spec: ModuleSpec) -> ModuleType | None:
        """Leave it to Python to make the empty module."""
        return None

    def exec_module(self, module: ModuleType) -> None:
        """Replace an empty module of the old name by the module of today."""
        warnings.warn(f"{module.__name__} is now {self.today}", DeprecationWarning, stacklevel=2)
        sys.modules[module.__name__] = import_module(self.today)

    def get_code(self, fullname: str) -> CodeType | None:
        """Return the code of the module of today, for `python -m` with an old name."""
        from importlib.util import find_spec

        warnings.warn(f"{fullname} is now {self.today}", DeprecationWarning, stacklevel=2)
        found = find_spec(self.today)
        loader: Any = found.loader if found else None
        code: CodeType | None = loader.get_code(self.today) if loader else None
        return code


def install() -> None:
    """Let old names be imported; once, however often it is called."""
    if not any(isinstance(finder, OldModules) for finder in sys.meta_path):
        sys.meta_path.append(OldModules())
