"""Stage one: a title and a description of an activity that begins in a room that was drawn (thesis 3.3)."""

import re
import secrets
import time
from typing import Any

import sqlalchemy as sql
from starlette.responses import Response

from hearth.pipelines.crowd.topics import no_activity
from hearth.schemas.rng import rng
from hearth.studies.participant_flags import is_gibberish
from hearth.web.annotate import annotated_programs
from hearth.web.annotate.annotate_tables import TEXTS
from hearth.web.phrases import say
from hearth.web.room_request import Visit

SCENES = (
    "living room", "kitchen", "dining room", "bedroom", "kids bedroom", "bathroom", "entrance hall", "home office",
)  # fmt: skip
"""The eight rooms (thesis 3.3)."""

MOST_SENT = 100_000
"""Characters of a description that is answered with the wish to shorten it."""

FEWEST_WORDS, MOST_TITLE, MOST_DESCRIPTION = 10, 80, 2_000

ENGLISH_WORDS = frozenset({"the", "and", "then", "to", "of", "with", "my", "your", "it", "is", "on", "up", "out"})
"""Words of which every English description of some length has one."""

EXAMPLES = (
    ("living room", "Watch TV",
     "Walk to the living room and sit down on the sofa. Pick up the remote control from the table and switch on the "
     "television. Then turn to it and watch it until the film is over."),
    ("kitchen", "Make tea",
     "Fill the kettle with water and put it on. Take a cup out of the cupboard and put a tea bag in. When the water "
     "boils, pour it into the cup."),
)  # fmt: skip


def describe(visit: Visit) -> Response:
    """Return the page of stage one."""
    thanks = visit.fields.get("thanks") == "yes"
    text = annotated_programs.latest_text(visit.web.store, visit.person) if thanks else None
    return _page(visit, title="", description="", wishes=(), thanks=thanks, text=text)


def submit_description(visit: Visit) -> Response:
    """Store a description, or ask politely for the missing parts."""
    title, description = visit.field("title").strip(), visit.field("description", MOST_SENT).strip()
    if wishes := lacks(title, description):
        return _page(visit, 400, title=title, description=description, wishes=wishes)
    if visit.field("ask", 10) and (questions := doubts(visit, title, description)):
        wishes = (*questions, say("annotate", "as_it_is"))
        return _page(visit, 400, title=title, description=description, wishes=wishes, asked=True)
    row = {
        "id": f"D{secrets.token_hex(5).upper()}",
        "session": visit.person,
        "scene": _scene(visit),
        "title": " ".join(title.split()),
        "description": description,
        "created": time.time(),
    }
    visit.web.store.write(lambda connection: connection.execute(sql.insert(TEXTS).values(row)))
    return visit.go("/annotate/describe?thanks=yes")


def lacks(title: str, description: str) -> tuple[str, ...]:
    """Return the faults of a description, as polite sentences; none if others can read it."""
    found = []
    if sum(letter.isalpha() for letter in title) < 3 or len(title) > MOST_TITLE or len(title.split()) > 10:
        found.append("Please give the activity a short title of its own, such as “Make tea”.")
    words = len(description.split())
    if words < FEWEST_WORDS:
        so_far = "1 word" if words == 1 else f"{words} words"
        found.append(
            f"Please write a little more: {so_far} so far, and others need at least {FEWEST_WORDS} to understand "
            "what is done. Two or three sentences are usually right."
        )
    if len(description) > MOST_DESCRIPTION:
        found.append(f"Please shorten it to {MOST_DESCRIPTION:,} characters; it has {len(description):,}.")
    if not found and (other := no_activity(f"{title}. {description}")):
        found.append(f"This reads like {other[0]}. Please describe something that a person does at home.")
    return tuple(found)


def doubts(visit: Visit, title: str, description: str) -> tuple[str, ...]:
    """Return what a page asks about before it takes a description: nonsense, another language, the same once more."""
    found = []
    if is_gibberish(title) or is_gibberish(description):
        found.append("gibberish")
    elif not set(re.findall("[a-z]+", description.casefold())) & ENGLISH_WORDS:
        found.append("language")
    mine = visit.web.store.rows(sql.select(TEXTS.c.description).where(TEXTS.c.session == visit.person))
    if any(folded(each["description"]) == folded(description) for each in mine):
        found.append("again")
    return tuple(say("annotate", name) for name in found)


def folded(text: str) -> str:
    """Return a text by which descriptions with the same words are found."""
    return " ".join(text.casefold().split())


def _scene(visit: Visit) -> str:
    """Return the room that is drawn for a person's next description."""
    query = sql.select(sql.func.count()).select_from(TEXTS).where(TEXTS.c.session == visit.person)
    count = visit.web.store.scalar(query)
    return rng(0, "annotate", visit.person, count).choice(SCENES)


def _page(visit: Visit, status: int = 200, **values: Any) -> Response:
    given = {"thanks": False, "text": None, "asked": False, "most": MOST_DESCRIPTION, **values}
    return visit.page("annotate/describe.html", status, scene=_scene(visit), examples=EXAMPLES, **given)
