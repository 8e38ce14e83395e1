"""The closed vocabularies of a scene graph, with stable integer ids (their positions).

Ids are published; append only. Sources: thesis 2.3.2, 5.4.1, table A.2, and the ActivityPrograms release.
"""

STATES: tuple[str, ...] = (
    "CLOSED", "OPEN", "OFF", "ON", "DIRTY", "CLEAN", "PLUGGED_OUT", "PLUGGED_IN", "SITTING", "LYING",
)  # fmt: skip
"""The ten simulated states. Neighbours (0,1), (2,3), (4,5), (6,7), (8,9) exclude each other."""

STATE_ID = {name: number for number, name in enumerate(STATES)}

OPPOSITE = {name: STATES[number ^ 1] for number, name in enumerate(STATES)}
"""The state that cannot hold at the same time."""

FURTHER_STATES: tuple[str, ...] = (
    "COLD", "HOT", "RAW", "COOKED", "BURNT", "EMPTY", "FULL", "DRY", "WET", "UNFOLDED", "FOLDED", "UNWRAPPED",
    "WRAPPED", "UNCOVERED", "COVERED", "REPAIRED", "BROKEN", "COMBED", "SHAVED", "CUT", "FLUSHED", "WRITTEN", "SMEARED",
    "IN_CALL", "GONE", "FINISHED",
    "BEGUN", "HALF_LEFT", "LAST_LEFT",
)  # fmt: skip
"""The states that acts set besides in action set 3; what excludes what stands in kb/data/states.yaml. GONE is what was
eaten, drunk or used up: it is nowhere, and its id is never used again. FINISHED is a device that switched itself off,
until somebody turns its knob. The last three are of food and drink in several portions, of which one, two and three are
taken."""

EVERY_STATE = STATES + FURTHER_STATES
"""The states of worlds of action set 3, in the order of their rows."""

EVERY_STATE_ID = {name: number for number, name in enumerate(EVERY_STATE)}

RELATIONS: tuple[str, ...] = ("ON", "INSIDE", "CLOSE", "FACING", "BETWEEN", "HOLDS_RH", "HOLDS_LH")
"""`a R b`: a is ON b, a is INSIDE b, a is CLOSE to b (symmetric), a is FACING b, door a is BETWEEN room b and another,
character a holds b in its right or left hand."""

RELATION_ID = {name: number for number, name in enumerate(RELATIONS)}

PROPERTIES: tuple[str, ...] = (
    "SURFACES", "GRABBABLE", "SITTABLE", "LIEABLE", "HANGABLE", "DRINKABLE", "EATABLE", "RECIPIENT", "CUTTABLE",
    "POURABLE", "CAN_OPEN", "HAS_SWITCH", "READABLE", "LOOKABLE", "CONTAINERS", "CLOTHES", "PERSON", "BODY_PART",
    "COVER_OBJECT", "HAS_PLUG", "HAS_PAPER", "MOVABLE", "CREAM",
)  # fmt: skip
"""Uses of an object."""

PROPERTY_ID = {name: number for number, name in enumerate(PROPERTIES)}

ROOM_CATEGORY = "Rooms"
CHARACTER_CATEGORY = "Characters"
CHARACTER_CLASS = "character"

FIRST_ADDED_ID = 1000
"""Ids from here are objects of a program that the home lacked (semantics: preparing an environment)."""

FIRST_FILLED_ID = 2000
"""Ids from here are common-sense objects added to make an environment more diverse."""
