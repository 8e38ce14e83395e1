"""The fixtures of `people.py`, for every test of the server, where the extra `web` is installed."""

from hearth.schemas.optional_libraries import lacking

if lacking("web"):
    collect_ignore_glob = ["test_*.py"]
else:
    from web.people import browser, drawing, person, served, server, serving  # noqa: F401
