"""Patterns of bans, and of clauses by which things stay as they are: `hands off the stove`."""

from __future__ import annotations

import re

HANDS_OFF = re.compile(
    r"(?:(?:keep|leave) (?:your |those )?(?:hands|fingers|paws|mitts) off|hands off|(?:stay|keep)"
    r" (?:away from|clear of|off)"
    r"|stay off|no(?! [a-z]+ing\b)) (?:of )?(.+)"
)
LEFT_ALONE = re.compile(
    r"(?:leave |let |(?=.+ (?:stays?|remains?) ))(.+?) (?:(?:stays? |remains? )?(?:alone|be|in peace"
    r"|untouched|undisturbed|(?:exactly |just )?(?:as|where|how) (?:it|they)"
    r" (?:is|are)(?: now)?))"
)
STAYS = re.compile(
    r"(.+?) (?:stays?|remains?|(?:can|should|must|may|shall|is to|are to|has to|have to) (?:stay|remain))"
    r"(?: switched| turned)? (on|off|open|closed|shut|plugged in|unplugged)(?: the whole time| all"
    r" the time| at all times| throughout)?"
)
CHANGES = {
    "on": "switch off", "off": "switch on", "open": "close", "closed": "open", "shut": "open",
    "plugged in": "unplug", "unplugged": "plug in",
}  # fmt: skip
"""Requests that would change a state in which things are to stay."""

BANNED_PLACE = re.compile(r"(on|in|to|into) ")
FURTHER = re.compile(r", (?:and|but|then) ")
BACKWARD = re.compile(
    r"(.+?),? (?:without|instead of|rather than|but not|and not|but don't(?! forget| leave)|but do"
    r" not(?! forget| leave)"
    r"|and don't(?! forget| leave)|but never|as long as you (?:don't|do not)"
    r"|provided you (?:don't|do not)|so long as you (?:don't|do not)) ((?:[a-z]+ing|[a-z]+) .+)"
)
