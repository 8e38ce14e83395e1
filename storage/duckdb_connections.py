"""The only door to DuckDB: every connection is opened here, with the same limits and its own place for spilled rows.

DuckDB adds its folder of temporary files to the folders that a query may read, and by default takes `.tmp` of the
current folder, which may be a link to anywhere. Here that folder is private to the process.
"""

import glob
import os
from collections.abc import Mapping
from functools import lru_cache
from itertools import count
from pathlib import Path
from types import MappingProxyType
from typing import Any
from weakref import WeakSet

MEMORY = 4 * 2**30
"""Bytes that DuckDB may take before it spills rows to the disk; half of the machine's memory where that is less."""

SPILLED = "20GB"
"""Most that one database writes to its folder of temporary files."""

THREADS = 8
"""Most threads of one database."""

_CLOSED = ("enable_external_access = false", "lock_configuration = true")
"""Settings that keep queries from other files and the network; the last one locks them all."""

_numbers = count()
_opened: WeakSet[Any] = WeakSet()


def open_database(path: Path | None = None, settings: Mapping[str, Any] = MappingProxyType({})) -> Any:
    """Open a DuckDB database: that of a file, or one in memory.

    Extensions, variables of Python and stored secrets are out of its reach from the start. Our own statements may
    still read any file; `limited` ends that, and comes before any statement of a stranger.

    Args:
        path: of the file; None for a database in memory.
        settings: more of DuckDB's settings, or other values of those here.

    Raises:
        duckdb.Error: the file cannot be opened.
    """
    import duckdb

    made = duckdb.connect(str(path or ":memory:"), config={**_settings(), **settings})
    _opened.add(made)
    return made


def interrupt_all() -> None:
    """Interrupt the statements of all connections of this process: the time of a command is over."""
    for each in list(_opened):
        each.interrupt()


def _settings() -> dict[str, Any]:
    aside = _spill_folder()
    return {
        "temp_directory": aside,
        "secret_directory": aside,
        "allow_persistent_secrets": False,
        "max_temp_directory_size": SPILLED,
        "memory_limit": f"{memory_limit() // 2**20}MiB",
        "threads": min(THREADS, os.cpu_count() or 1),
        "autoinstall_known_extensions": False,
        "autoload_known_extensions": False,
        "allow_community_extensions": False,
        "python_enable_replacements": False,
    }


def _spill_folder() -> str:
    """Return the path of a folder that no other database has; DuckDB makes it when it spills, and removes it."""
    return str(_aside("sql"))


def _aside(name: str) -> Path:
    """Return a new path in the temporary folder of this process, which others cannot read and which goes at exit."""
    from multiprocessing.util import get_temp_dir

    return Path(get_temp_dir()).resolve() / f"{name}-{os.getpid()}-{next(_numbers)}"


def memory_limit() -> int:
    """Return how many bytes a database may take."""
    try:
        whole = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, OSError, ValueError):  # no such figures on this system
        return MEMORY
    return min(MEMORY, whole // 2)


def limited(connection: Any, *roots: str) -> Any:
    """Return the connection, which from now on reads only these folders; each path ends in a slash."""
    connection.execute(f"SET allowed_directories = [{', '.join(map(quoted, roots))}]")
    for setting in _CLOSED:
        connection.execute(f"SET {setting}")
    return connection


def quoted(text: str) -> str:
    """Return a text as SQL has it."""
    return "'" + text.replace("'", "''") + "'"


def identifier(name: str) -> str:
    """Return a name as SQL has it."""
    return '"' + name.replace('"', '""') + '"'


@lru_cache(maxsize=1024)
def without_patterns(folder: Path) -> str:
    """Return a path of the folder that has no pattern in it: its own, or that of a link of ours to it.

    A connection that is `limited` to the folder takes both. A pattern for the folder would let `glob` follow links
    that lead out of it.
    """
    whole = str(folder.resolve())
    if pattern_of(whole) == whole:
        return whole
    link = _aside("folder")
    link.symlink_to(whole)
    return str(link)


def pattern_of(path: Path | str) -> str:
    """Return a path for DuckDB's readers, which take `*`, `?` and `[` in paths for patterns."""
    return glob.escape(str(path))
