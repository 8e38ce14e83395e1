"""The rooms, in the order of the navigation. To add one: a folder with a `ROOM`, its row here (web/README.md)."""

from hearth.web import play, study
from hearth.web.annotate.annotate_room import ROOM as ANNOTATE
from hearth.web.room import Room

ROOMS: tuple[Room, ...] = (ANNOTATE, play.ROOM, study.ROOM)
"""Every room. Its tables are made because its modules, which declare them in METADATA, are imported here."""
