"""Import paths of earlier versions: each still imports the module that has its content now, with a warning."""

from __future__ import annotations

import sys
import warnings
from functools import lru_cache
from importlib import import_module
from importlib.machinery import ModuleSpec
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Sequence
    from importlib.abc import Loader, MetaPathFinder
    from types import CodeType, ModuleType
else:  # `importlib.abc` takes as long to import as the rest of `hearth`
    Loader = MetaPathFinder = object

_PACKAGE = __name__.partition(".")[0]


@lru_cache(maxsize=1)
def modules() -> dict[str, str]:
    """Return the module of today for each module that was renamed or moved, both without `hearth.`; read when asked."""
    rows = Path(__file__).with_suffix(".csv").read_text(encoding="utf-8").split()[1:]
    return {old: new for old, _, new in (row.partition(",") for row in rows)}


class OldModules(MetaPathFinder):
    """Finds modules by the names of `old_names.csv`; Python asks it last, for modules that no other finder has."""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Return the specification of a module of an earlier version."""
        package, _, module = fullname.partition(".")
        if package != _PACKAGE or module not in modules():
            return None
        return ModuleSpec(fullname, OldModule(f"{package}.{modules()[module]}"))


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
