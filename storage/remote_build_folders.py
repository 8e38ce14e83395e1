"""Folders at URLs (S3 or any other store of fsspec) that are built in, worked on in a local copy.

Complete parts go to the store at once, a stage's manifest last. So the store, too, only ever holds complete parts, and
a build on another machine continues from them. The replacement of a folder that may be read is written next to it, and
takes its place inside the store.
"""

import os
import shutil
import socket
import stat
import tempfile
import uuid
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from functools import lru_cache
from pathlib import Path
from typing import Any

import orjson

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.files import is_temporary, value_digest, write_bytes
from hearth.storage.folder_exchange import beside
from hearth.storage.manifest import NAME, read_manifest
from hearth.storage.names import inside
from hearth.storage.remote import filesystem, get, listed, reported, url_of

_LOCK = ".lock"
_REVISION = ".revision"


class Store:
    """A folder in a store and its copy in a work folder of this machine.

    Attributes:
        url: of the folder.
        work: the local copy; the same for all processes of a user on this machine, and closed to others.
    """

    def __init__(self, url: str) -> None:
        self.url = url
        self.work = _own_folder() / value_digest(url)[:16]
        self._fs, self._root = filesystem(url)

    @contextmanager
    def locked(self) -> Iterator[None]:
        """Hold the folder: nobody else, on any machine, builds into it.

        Raises:
            HearthError: LOCKED, naming who holds it.
        """
        path = self._path(_LOCK)
        me = {"host": socket.gethostname(), "pid": os.getpid()}
        with reported(self.url):
            try:
                self._fs.pipe_file(path, orjson.dumps(me), mode="create")
            except (FileExistsError, OSError) as error:
                if not self._fs.exists(path):
                    raise
                self._take_over(path, me, error)
        try:
            yield
        finally:
            with reported(self.url):
                self._fs.rm_file(path)

    def _take_over(self, path: str, me: dict[str, Any], error: OSError) -> None:
        """Take over a lock whose process on this machine has ended."""
        self._fs.invalidate_cache()
        held = orjson.loads(self._fs.cat_file(path))
        if held["host"] != me["host"] or Path(f"/proc/{int(held['pid'])}").exists():
            raise HearthError.of(
                Code.LOCKED,
                f"process {held['pid']} of {held['host']} is building here",
                file=self.url,
                suggestion=f"wait until it has ended; if it was killed, remove {self.url}/{_LOCK}",
            ) from error
        self._fs.pipe_file(path, orjson.dumps(me))

    def settle(self) -> str:
        """Make the local copy and the store agree, and give both a new revision.

        The parts that only this machine built since its last visit go to the store; where another machine has built
        there, the local copy is fetched anew.
        """
        with reported(self.url):
            self._fs.invalidate_cache()
            self._go_on_replacing()
            theirs = self._read(_REVISION)
            mine = (self.work / _REVISION).read_bytes() if (self.work / _REVISION).exists() else None
            if theirs is None or theirs != mine:
                shutil.rmtree(self.work, ignore_errors=True)
                self._get(name for name in self._names() if name not in (_LOCK, _REVISION))
            else:
                self._push_unfinished()
            revision = uuid.uuid4().hex
            self.work.mkdir(parents=True, exist_ok=True)
            write_bytes(self.work / _REVISION, revision.encode())
            self._fs.pipe_file(self._path(_REVISION), revision.encode())
        return revision

    def attend(self, revision: str) -> None:
        """See, in a worker on any machine, that the local copy is of the build at hand: all but its parts."""
        if read_text(self.work / _REVISION) != revision:
            with reported(self.url):
                shutil.rmtree(self.work, ignore_errors=True)
                self._get(name for name in self._names() if _is_plain(name))
                self.work.mkdir(parents=True, exist_ok=True)
                write_bytes(self.work / _REVISION, revision.encode())

    def fetch(self, path: Path) -> None:
        """See that a file of the local copy is there."""
        if not path.exists():
            with reported(self.url):
                self._get([path.relative_to(self.work).as_posix()])

    def push(self, paths: Iterable[Path]) -> None:
        """Put files of the local copy into the store, one after the other."""
        with reported(self.url):
            for path in paths:
                self._put(path.relative_to(self.work).as_posix())

    def begin(self, stage: str) -> None:
        """Make the store say that a stage is not complete."""
        with reported(self.url):
            self._remove(stage, [NAME])

    def end(self, stage: str) -> None:
        """Make a stage's folder in the store the same as the local one, the manifest last."""
        with reported(self.url):
            self._sync(stage, stage)

    def tidy(self, stage: str) -> None:
        """Remove the files that a stopped build left next to a stage's folder."""
        with reported(self.url):
            self._remove(_following(stage), self._under(_following(stage)))

    def replace(self, stage: str) -> None:
        """Make a stage's folder in the store the same as the local one; readers find the old or the new one throughout.

        Until the new one is complete next to the old one, nothing of the old one changes. The new one stays there until
        it has taken the place of the old one. See `fetching`.
        """
        with reported(self.url):
            self._sync(stage, _following(stage))
            self._take_place(stage)

    def _take_place(self, stage: str) -> None:
        """Put the complete next version of a folder in its place, within the store, and remove it."""
        self._fs.invalidate_cache()
        new, old = self._under(_following(stage)).keys(), self._under(stage).keys()
        for name in sorted(new - {NAME}):
            self._copy(f"{_following(stage)}/{name}", f"{stage}/{name}")
        self._remove(stage, old - new)
        self._copy(f"{_following(stage)}/{NAME}", f"{stage}/{NAME}")
        self._remove(_following(stage), [NAME, *sorted(new - {NAME})])

    def _go_on_replacing(self) -> None:
        """Let every version that is complete next to its folder take its place: a build was stopped meanwhile."""
        for folder, _, name in (path.rpartition("/") for path in self._names()):
            if name == NAME and folder.startswith(".") and "/" not in folder:
                self._take_place(folder.removeprefix("."))

    def _push_unfinished(self) -> None:
        """Push every stage that is complete here and not there: a build was stopped in between."""
        for manifest in sorted(self.work.glob(f"*/{NAME}")):
            stage = manifest.parent.name
            if not stage.startswith(".") and self._read(f"{stage}/{NAME}") != manifest.read_bytes():
                self.replace(stage)

    def _sync(self, stage: str, there: str) -> None:
        """Make a folder in the store the same as a local one, the manifest last.

        Files that workers have pushed are there.
        """
        self._fs.invalidate_cache()
        known, folder = self._under(there), self.work / stage
        here = {path.relative_to(folder).as_posix(): path for path in _files(folder)}
        complete = read_manifest(folder)
        pushed = {name for part in complete.parts for name in part["files"]} if complete else set()
        for name in sorted(here, key=lambda name: (name == NAME, name)):
            if name not in pushed or known.get(name) != here[name].stat().st_size:
                self._fs.put_file(str(here[name]), self._path(f"{there}/{name}"))
        self._remove(there, known.keys() - here.keys())

    def _under(self, folder: str) -> dict[str, int]:
        """Return the sizes of the files in a folder of the store."""
        return {name: info["size"] for name, info in listed(self._fs, self._path(folder)).items()}

    def _copy(self, source: str, target: str) -> None:
        """Copy a file within the store, or by way of this machine where a store cannot do so."""
        try:
            self._fs.cp_file(self._path(source), self._path(target))
        except NotImplementedError:
            self._fs.pipe_file(self._path(target), self._fs.cat_file(self._path(source)))

    def _remove(self, folder: str, names: Iterable[str]) -> None:
        for name in names:
            with suppress(FileNotFoundError):
                self._fs.rm_file(self._path(f"{folder}/{name}"))

    def _path(self, name: str) -> str:
        return f"{self._root}/{name}"

    def _read(self, name: str) -> bytes | None:
        try:
            return bytes(self._fs.cat_file(self._path(name)))
        except FileNotFoundError:
            return None

    def _names(self) -> list[str]:
        return [name for name in listed(self._fs, self._root) if not is_temporary(name)]

    def _put(self, name: str) -> None:
        self._fs.put_file(str(self.work / name), self._path(name))

    def _get(self, names: Iterable[str]) -> None:
        for name in names:
            get(self._fs, self._path(name), inside(self.work, name))


@lru_cache(maxsize=8)
def store(url: str) -> Store:
    """Return the store of that URL, one in a process."""
    return Store(url)


@contextmanager
def working(out: str) -> Iterator[tuple[str, str, str]]:
    """Yield the local folder to build in, and URL and revision of the store it is a copy of; "" for a plain folder.

    Raises:
        HearthError: LOCKED, or the store cannot be reached.
    """
    url = url_of(out)
    if url is None:
        yield out, "", ""
        return
    here = store(url)
    with here.locked():
        yield str(here.work), url, here.settle()


def _own_folder() -> Path:
    """Return a folder of this user's for copies that builds work in.

    Raises:
        HearthError: UNWRITABLE: another user made it, or it is open to others.
    """
    folder = Path(tempfile.gettempdir()) / f"hearth-{os.getuid()}"
    with suppress(FileExistsError):
        folder.mkdir(mode=0o700)
    status = folder.lstat()
    if not stat.S_ISDIR(status.st_mode) or status.st_uid != os.getuid() or status.st_mode & 0o077:
        message = "it is not a folder of yours that is closed to others"
        suggestion = f"remove it, or set TMPDIR to a folder of your own; then `chmod 700 {folder}`"
        raise HearthError.of(Code.UNWRITABLE, message, file=str(folder), suggestion=suggestion)
    return folder


def _following(stage: str) -> str:
    """Return where the next version of a stage's folder is written, as in a plain folder."""
    return beside(Path(stage)).name


def _files(folder: Path) -> Iterator[Path]:
    if folder.is_dir():
        yield from (path for path in sorted(folder.rglob("*")) if path.is_file() and not path.name.startswith("."))


def _is_plain(name: str) -> bool:
    """Return whether a file is not a part; parts never change under their name while a build goes on."""
    base = name.rsplit("/", 1)[-1]
    return not (base.startswith((".", "part-")) and base.endswith(".parquet")) and base not in (_LOCK, _REVISION)


def read_text(path: Path) -> str | None:
    """Return a small file's text; None when it is not there."""
    return path.read_text("utf-8") if path.exists() else None
