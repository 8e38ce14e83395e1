"""Rooms 3 and 4: people take part in a study, doing tasks or judging films, and its researcher's desk."""

from hearth.web.room import Room, get, post
from hearth.web.study import study_desk, study_pages, trial_page

ROOM = Room(
    "study",
    "Study",
    "Take part in a study: do tasks in a home, or judge films.",
    addresses=(
        get("/", study_pages.way),
        post("/agree", study_pages.agree),
        post("/understood", study_pages.understood),
        post("/begin", study_pages.begin),
        post("/answer", study_pages.answer),
        post("/leave", study_pages.leave),
        get("/film/{number}", study_pages.film),
    ),
    desk=(
        get("/", study_desk.overview),
        get("/tables.zip", study_desk.tables),
        get("/report.html", study_desk.report),
        get("/payments.csv", study_desk.payments),
        get("/trial/{person}/{number}", trial_page.trial),
        get("/trial/{person}/{number}/replay.json", trial_page.replay),
        post("/forget", study_desk.forget),
        post("/dismiss", study_desk.dismiss),
    ),
    studied=study_pages.takes_part,
)
"""The room."""
