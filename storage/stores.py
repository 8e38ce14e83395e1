"""Remote folders (S3 or any other store of fsspec), worked on in a local copy.

A build into a store works in a local copy of it. Complete parts go to the store at once, a stage's manifest last, so
that the store, too, only ever holds what is whole; a build on another machine takes up what it finds there. Datasets
and sources in a store are fetched before they are read, into a folder that is removed when the process ends; within a
process only what changed is fetched again. What a store lists is never written outside the copy.

fsspec's own caching does not serve here: it keeps files under hashes of their names, or all in one folder, where a
dataset is read by the names of its tables and parts.
"""

import atexit
import os
import re
import shutil
import socket
import stat
import tempfile
import uuid
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from functools import lru_cache
from pathlib import Path, PurePosixPath
from typing import Any

import orjson

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.libraries import library
from hearth.storage.exchange import beside
from hearth.storage.files import TEMPORARY, is_temporary, read_json, value_digest, write_bytes, write_json
from hearth.storage.names import inside, leaves

MANIFEST = "manifest.json"
_LOCK = ".lock"
_REVISION = ".revision"
_FETCHED = ".fetched.json"
_URL = re.compile(r"([a-z][a-z0-9+.-]+):/{1,2}(?=[^/])(.+)", re.DOTALL)


def url_of(path: str | Path) -> str | None:
    """The URL that a path is meant as, also where a `Path` has swallowed a slash of it; None for a plain path."""
    match = _URL.fullmatch(str(path))
    return f"{match[1]}://{match[2].rstrip('/')}" if match and len(match[1]) > 1 else None


class Store:
    """A folder in a store and its copy in a work folder of this machine.

    Attributes:
        url: of the folder.
        work: the local copy; the same for all processes of a user on this machine, and closed to others.
    """

    def __init__(self, url: str) -> None:
        self.url = url
        self.work = _own_folder() / value_digest(url)[:16]
        self._fs, self._root = _filesystem(url)

    @contextmanager
    def locked(self) -> Iterator[None]:
        """Hold the folder: nobody else, on any machine, builds into it.

        Raises:
            HearthError: LOCKED, naming who holds it.
        """
        path = self._path(_LOCK)
        me = {"host": socket.gethostname(), "pid": os.getpid()}
        with _reported(self.url):
            try:
                self._fs.pipe_file(path, orjson.dumps(me), mode="create")
            except (FileExistsError, OSError) as error:
                if not self._fs.exists(path):
                    raise
                self._take_over(path, me, error)
        try:
            yield
        finally:
            with _reported(self.url):
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

        What only this machine built since its last visit goes to the store; where another machine has built there, the
        local copy is fetched anew.
        """
        with _reported(self.url):
            self._fs.invalidate_cache()
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
            with _reported(self.url):
                shutil.rmtree(self.work, ignore_errors=True)
                self._get(name for name in self._names() if _is_plain(name))
                self.work.mkdir(parents=True, exist_ok=True)
                write_bytes(self.work / _REVISION, revision.encode())

    def fetch(self, path: Path) -> None:
        """See that a file of the local copy is there."""
        if not path.exists():
            with _reported(self.url):
                self._get([path.relative_to(self.work).as_posix()])

    def push(self, paths: Iterable[Path]) -> None:
        """Put files of the local copy into the store, one after the other."""
        with _reported(self.url):
            for path in paths:
                self._put(path.relative_to(self.work).as_posix())

    def begin(self, stage: str) -> None:
        """Make the store say that a stage is not complete."""
        with _reported(self.url):
            path = self._path(f"{stage}/{MANIFEST}")
            if self._fs.exists(path):
                self._fs.rm_file(path)

    def end(self, stage: str, whole: bool = False) -> None:
        """Make a stage's folder in the store the same as the local one, the manifest last.

        Args:
            stage: its name.
            whole: its parts, too, are put there anew: those in the store are of another build.
        """
        if whole:
            self.begin(stage)
        with _reported(self.url):
            self._sync(stage, whole)
            for name in self._names():
                if whole and name.startswith(f"{beside(Path(stage))}/"):
                    self._fs.rm_file(self._path(name))

    def _push_unfinished(self) -> None:
        """Push every stage that is complete here and not there: a build was stopped in between."""
        for manifest in sorted(self.work.glob(f"*/{MANIFEST}")):
            stage = manifest.parent.name
            if not stage.startswith(".") and self._read(f"{stage}/{MANIFEST}") != manifest.read_bytes():
                self._sync(stage, whole=True)

    def _sync(self, stage: str, whole: bool) -> None:
        self._fs.invalidate_cache()
        there = {name: info for name, info in self._found().items() if name.startswith(f"{stage}/")}
        here = {path.relative_to(self.work).as_posix(): path for path in _files(self.work / stage)}
        last = f"{stage}/{MANIFEST}"
        for name, path in here.items():
            known = there.get(name)
            if name != last and (whole or known is None or _is_plain(name) or known["size"] != path.stat().st_size):
                self._put(name)
        for name in there.keys() - here.keys():
            self._fs.rm_file(self._path(name))
        self._put(last)

    def _path(self, name: str) -> str:
        return f"{self._root}/{name}"

    def _read(self, name: str) -> bytes | None:
        try:
            return bytes(self._fs.cat_file(self._path(name)))
        except FileNotFoundError:
            return None

    def _found(self) -> dict[str, dict[str, Any]]:
        try:
            found = self._fs.find(self._root, detail=True)
        except FileNotFoundError:
            return {}
        return _listed(self._root, found)

    def _names(self) -> list[str]:
        return [name for name in self._found() if not is_temporary(name)]

    def _put(self, name: str) -> None:
        self._fs.put_file(str(self.work / name), self._path(name))

    def _get(self, names: Iterable[str]) -> None:
        for name in names:
            _get(self._fs, self._path(name), inside(self.work, name))


@lru_cache(maxsize=8)
def store(url: str) -> Store:
    """The store of that URL, one in a process."""
    return Store(url)


@contextmanager
def working(out: str) -> Iterator[tuple[str, str, str]]:
    """The local folder to build in, and URL and revision of the store it is a copy of; "" for a plain folder.

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


def fetched(path: str | Path) -> Path:
    """The local path of a file or folder to be read; what is in a store is fetched, of a build only its dataset.

    Raises:
        HearthError: MISSING_FILE, or the store cannot be reached.
    """
    url = url_of(path)
    if url is None:
        return Path(path)
    with _reported(url):
        fs, root = _filesystem(url)
        fs.invalidate_cache()
        copy = _temporary_folder(os.getpid()) / f"hearth-{os.getuid()}-read-{value_digest(url)[:16]}"
        if fs.isfile(root):
            name = PurePosixPath(root).name
            return inside(_updated(fs, {name: fs.info(root)}, copy), name)
        folder = root
        if not fs.exists(f"{root}/{MANIFEST}") and fs.exists(f"{root}/publish/{MANIFEST}"):
            folder = f"{root}/publish"
        infos = _listed(folder, fs.find(folder, detail=True))
        if not infos:
            raise FileNotFoundError(url)
        return _updated(fs, infos, copy)


def _listed(root: str, found: dict[str, dict[str, Any]]) -> dict[str, dict[str, Any]]:
    """What a store lists below a folder, by names within it, sorted.

    Raises:
        HearthError: DAMAGED_FILE: a name leaves the folder, or a link leads out of it.
    """
    infos = {}
    for path, info in sorted(found.items()):
        name = path.removeprefix(f"{root}/")
        destination = info.get("destination")
        outside = destination is not None and not Path(path).resolve().is_relative_to(Path(root).resolve())
        if name == path or leaves(name) or outside:
            raise HearthError.of(Code.DAMAGED_FILE, f"`{path[:200]!a}` leaves the folder", file=root)
        infos[name] = info
    return infos


def _own_folder() -> Path:
    """A folder of this user's for copies that builds work in.

    Raises:
        HearthError: UNWRITABLE: somebody else made it, or it is open to others.
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


@lru_cache(maxsize=1)
def _temporary_folder(process: int) -> Path:
    """A folder of this process, closed to others and removed when it ends, for copies that are only read."""
    folder = Path(tempfile.mkdtemp(prefix="hearth-"))
    atexit.register(_remove, folder, process)
    return folder


def _remove(folder: Path, process: int) -> None:
    if os.getpid() == process:  # a process forked from it runs the same exit
        shutil.rmtree(folder, ignore_errors=True)


def _updated(fs: Any, infos: dict[str, dict[str, Any]], copy: Path) -> Path:
    """A local copy of files, of which those are fetched that are not as they were."""
    known = read_json(copy / _FETCHED) or {}
    now = {name: _version(info) for name, info in sorted(infos.items()) if not name.rsplit("/", 1)[-1].startswith(".")}
    for path in _files(copy):
        if path.relative_to(copy).as_posix() not in now:
            path.unlink()
    for name, version in now.items():
        target = inside(copy, name)
        if known.get(name) != version or not target.exists():
            _get(fs, infos[name]["name"], target)
    copy.mkdir(parents=True, exist_ok=True)
    write_json(copy / _FETCHED, now)
    return copy


def _version(info: dict[str, Any]) -> str:
    """What changes when a file in a store is written anew."""
    return value_digest([str(info.get(key)) for key in ("size", "ETag", "etag", "mtime", "created", "LastModified")])


def _get(fs: Any, source: str, target: Path) -> None:
    target.parent.mkdir(parents=True, exist_ok=True)
    temporary = target.with_name(f".{target.name}.{os.getpid()}{TEMPORARY}")
    fs.get_file(source, str(temporary))
    temporary.replace(target)


def _files(folder: Path) -> Iterator[Path]:
    if folder.is_dir():
        yield from (path for path in sorted(folder.rglob("*")) if path.is_file() and not path.name.startswith("."))


def _is_plain(name: str) -> bool:
    """Whether a file is not a part; parts never change under their name while a build goes on."""
    base = name.rsplit("/", 1)[-1]
    return not (base.startswith((".", "part-")) and base.endswith(".parquet")) and base not in (_LOCK, _REVISION)


def read_text(path: Path) -> str | None:
    """A small file's text; None when it is not there."""
    return path.read_text("utf-8") if path.exists() else None


def _filesystem(url: str) -> tuple[Any, str]:
    core = library("fsspec.core")
    try:
        fs, root = core.url_to_fs(url)
    except (ImportError, ValueError) as error:
        suggestion = "install the package it names, or check the URL's beginning"
        raise HearthError.of(Code.UNSUPPORTED_FILE, str(error), file=url, suggestion=suggestion) from None
    return fs, str(root).rstrip("/")


@contextmanager
def _reported(url: str) -> Iterator[None]:
    """Raises a store's errors as HearthError."""
    try:
        yield
    except HearthError:
        raise
    except FileNotFoundError as error:
        raise HearthError.of(Code.MISSING_FILE, "no such file or folder in the store", file=url) from error
    except Exception as error:  # every store has errors of its own
        message = f"the store does not do what was asked: {type(error).__name__}: {error}"
        suggestion = "check its address and your right to write there; what is complete stays, run the command again"
        raise HearthError.of(Code.UNWRITABLE, message, file=url, suggestion=suggestion) from error
