"""Attacks by videos: files that FFmpeg would read, and that are not the film that they are called."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from attack import Attack, Ground

from hearth.models.films import film_files, film_input


@cache
def video() -> bytes:
    """A true film of two seconds, WebM."""
    from hearth.rendering.film.video_file import Writer

    with TemporaryDirectory() as folder:
        path = Path(folder) / "film.webm"
        writer = Writer(path, 64, 48, 15.0)
        for number in range(30):
            writer.add(np.full((48, 64, 3), (8 * number, 90, 10), np.uint8))
        writer.close()
        return path.read_bytes()


def watched(path: Path) -> Any:
    """Return the content of a video as `model show` reads it."""
    return film_input.read_pictures(film_files.film_file(path)).shape


LISTS = {
    "concat": b"ffconcat version 1.0\nfile other.webm\n",
    "playlist": b"#EXTM3U\n#EXT-X-TARGETDURATION:9\n#EXTINF:9,\nother.webm\n#EXT-X-ENDLIST\n",
    "playlist elsewhere": b"#EXTM3U\n#EXT-X-TARGETDURATION:9\n#EXTINF:9,\nfile://{guard}/secret.csv\n#EXT-X-ENDLIST\n",
    "session": b"v=0\no=- 0 0 IN IP4 127.0.0.1\ns=x\nc=IN IP4 127.0.0.1\nt=0 0\nm=video 9 RTP/AVP 96\n",
    "manifest": b'<?xml version="1.0"?><MPD xmlns="urn:mpeg:dash:schema:mpd:2011" type="static"><Period><AdaptationSet '
    b'mimeType="video/webm"><Representation id="1"><BaseURL>other.webm</BaseURL></Representation></AdaptationSet>'
    b"</Period></MPD>",
    "address": b"http://127.0.0.1:9/film.webm",
    "picture": b"\x89PNG\r\n\x1a\n" + bytes(100),
    "empty": b"",
    "text": b"text",
    "head alone": b"\x1a\x45\xdf\xa3",
    "zeros": bytes(1 << 20),
}  # fmt: skip
"""Files that FFmpeg may know, and that are not the film that they are called."""


def videos() -> Iterator[Attack]:
    """Lists of other films, names that stand for several, and films of which something was changed."""
    for suffix in film_files.VIDEOS:
        for name, data in LISTS.items():
            yield Attack("films", f"video: {name}{suffix}", lambda ground, s=suffix, d=data: _another(ground, s, d))
    for name in ("film%02d.webm", "film*.webm", "pipe:0.webm", "-.webm", "concat:other.webm|other.webm"):
        yield Attack("films", f"video called {name}", lambda ground, n=name: _called(ground, n))
    for name, change in CHANGED.items():
        yield Attack("films", f"video: {name}", lambda ground, c=change: _video(ground, c(video())))
    for seed in range(60):
        yield Attack("films", f"video changed {seed}", lambda ground, s=seed: _video(ground, changed(video(), s)))


def _video(ground: Ground, data: bytes) -> Any:
    path = ground.folder / "given.webm"
    path.write_bytes(data)
    return watched(path)


def _another(ground: Ground, suffix: str, data: bytes) -> None:
    """A file that is not a film gives no pictures, least of all those of the one beside it."""
    (ground.folder / "other.webm").write_bytes(video())
    path = ground.folder / f"given{suffix}"
    path.write_bytes(data.replace(b"{guard}", str(ground.guard).encode()))
    found = watched(path)
    raise AssertionError(f"pictures {found} of what is not a film")


def _called(ground: Ground, name: str) -> Any:
    (ground.folder / "other.webm").write_bytes(video())
    (ground.folder / name).write_bytes(b"\x1a\x45\xdf\xa3")
    return watched(ground.folder / name)


CHANGED: dict[str, Callable[[bytes], bytes]] = {
    "wide": lambda data: data.replace(b"\xb0\x81\x40", b"\xb0\x81\xff").replace(b"\xb0\x82\x00", b"\xb0\x82\x3f"),
    "vast": lambda data: data.replace(b"\x9d\x01\x2a\x40\x00\x30\x00", b"\x9d\x01\x2a\xff\x3f\xff\x3f"),
    "still": lambda data: data.replace(b"\x23\xe3\x83", b"\x23\xe3\x84"),
    "cut": lambda data: data[: len(data) // 2],
    "twice": lambda data: data + data,
    "long": lambda data: data + bytes(50_000_000),
}


def changed(data: bytes, seed: int) -> bytes:
    """A file with some of its bytes changed, mostly in its head, or cut."""
    chooser, found = random.Random(seed), bytearray(data)
    if seed % 7 == 0:
        return bytes(data[: chooser.randrange(len(data))])
    for _ in range(chooser.choice((1, 3, 30, 300))):
        found[chooser.randrange(len(found) if seed % 2 else min(len(found), 600))] = chooser.randrange(256)
    return bytes(found)
