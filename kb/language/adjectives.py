"""Adjectives: words before a thing that only say which one of its kind it is, in a closed list."""

import re
from collections.abc import Iterator

from hearth.kb.knowledge import Knowledge
from hearth.kb.language.english_lexicon import is_english

SIZES = (
    "big bigger biggest large larger largest small smaller smallest little tiny huge long short tall wide narrow thick"
    " thin heavy"
)
AGES = "old older oldest new newer newest fresh ancient antique modern used"
PLACES = "near nearest nearby closest close left right upper lower top bottom front back main"
STATES = (
    "clean dirty empty full open closed hot cold warm cool wet dry soft hard sharp broken loose folded unfolded dusty"
    " ready ripe raw cooked frozen whole sliced leftover spare washed"
    " rinsed dried filled remaining chopped boiled heated"
)
LOOKS = (
    "nice pretty beautiful lovely good favorite favourite comfortable comfy cozy cosy shiny round square plain simple"
    " same"
)
MATERIALS = "wooden plastic metallic woolen ceramic porcelain leather cotton steel"
COLORS = "red blue green yellow white black brown gray grey orange purple pink golden silver dark bright"

OF_LABELS = (
    "wood metal glass stone marble fabric iron bamboo wicker rattan gas electric chipped cracked worn stained striped"
)
"""Words that only say in labels which kind of thing it is: in sentences, some are things of their own."""

SHAPES = ("round", "square")
"""Adjectives of labels that are always apart from their noun: a `round table` of a scan is a table."""

_PACKED = re.compile(
    r"(?:carton|bottle|can|tin|box|bag|pack|packet|jar|tube|loaf|roll|stack|pile|pair|set|bunch) of (?=.)"
)
"""Packing before its contents: a `carton of milk` is milk."""

_ADJECTIVES = "|".join(
    word for words in (SIZES, AGES, PLACES, STATES, LOOKS, MATERIALS, COLORS) for word in words.split()
)
_ROOMS = r"(?:kitchen|bathroom|bedroom|dining room|living room|home office|office|hall)"
"""A room before a thing says where it is, as in `the kitchen sink`."""

_FOUND = re.compile(rf"(?<= )(?:very |really |quite )?({_ADJECTIVES}|{_ROOMS}),? (?=((?!of\b)[a-z-]+))")


def without_adjective(known: Knowledge, text: str) -> Iterator[tuple[str, str]]:
    """Yield a clause without one of its adjectives, and the adjective.

    An adjective that makes another noun of the next one stays: a `hot dog` is not a dog, nor a `white board` a board,
    because they are words when run together, or names of classes.
    """
    for found in _FOUND.finditer(text):
        adjective, noun = found[1], found[2]
        if not is_english(adjective + noun) and not known.object_class(f"{adjective} {noun}"):
            yield text[: found.start()] + text[found.end() :], found[0].strip(" ,")


_LABEL_WORD = re.compile(rf"({_ADJECTIVES}|{_ROOMS}|{'|'.join(OF_LABELS.split())}) (?=([a-z-]+))")


def noun_of(label: str, known: Knowledge) -> str:
    """Return a label such as `small wooden chair` without its adjectives and packing; "" where it has none.

    As in sentences, an adjective that makes another noun of the next one stays.
    """
    text = left = label.lower()
    while (found := _LABEL_WORD.match(text)) and (found[1] in SHAPES or not is_english(found[1] + found[2])):
        text = text[found.end() :]
        if known.object_class(text) is not None:
            break
    return _PACKED.sub("", text, count=1) if _PACKED.match(text) else text if text != left else ""
