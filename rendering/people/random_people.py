"""People drawn by a seed: sex, age, build, face, skin, hair and clothes."""

import random
from dataclasses import replace
from functools import lru_cache
from typing import Any

from hearth.rendering.people.body_shape import Shape, is_present
from hearth.rendering.people.person_appearance import BODIES, Body
from hearth.schemas.rng import derive
from hearth.schemas.yaml_limits import packaged

CHOICES: dict[str, Any] = packaged("hearth.rendering.people", "variety.yaml")
"""Colours, styles and garments to choose from."""

STATURE = {"female": (1.645, 0.065), "male": (1.775, 0.07)}
"""Mean and standard deviation of adults' heights, metres."""

YOUNGEST, GROWN, OLD = 11, 18, 65
"""Years: of the youngest person, of adults, and from which hair is grey and backs have become shorter."""

CHILDREN = 0.07
"""Share of people below `GROWN`."""


@lru_cache(maxsize=256)
def person(seed: int) -> Body:
    """Return the person of a seed; a simple figure where the file of bodies is not installed."""
    if not is_present():
        return BODIES[sorted(BODIES)[seed % len(BODIES)]]
    numbers = random.Random(derive(seed, "person"))
    sex = "female" if numbers.random() < 0.5 else "male"
    child = numbers.random() < CHILDREN
    age = numbers.uniform(YOUNGEST, GROWN) if child else min(GROWN + numbers.expovariate(1 / 28.0), 86.0)
    ancestry = numbers.choice(CHOICES["ancestry"])
    height = _height(sex, age, numbers)
    shape = Shape(
        sex=_between(numbers, 0.0, 0.2) if sex == "female" else _between(numbers, 0.85, 1.0),
        age=round(age, 2),
        muscle=round(min(max(numbers.gauss(0.52 - 0.003 * max(age - 40, 0), 0.15), 0.15), 0.95), 3),
        weight=round(min(max(numbers.gauss(0.5 + 0.002 * max(age - 25, 0), 0.16), 0.1), 0.95), 3),
        stature=round(min(max((height - STATURE[sex][0]) / 0.25, -0.6), 0.6), 3),
        ideal=_between(numbers, 0.1, 0.6),
        ancestry=(ancestry["african"], ancestry["asian"], ancestry["caucasian"]),
        face=_face(numbers),
    )
    return _clothed(Body(height=height, shape=shape), sex, age, ancestry, numbers)


def _between(numbers: random.Random, low: float, high: float) -> float:
    return round(numbers.uniform(low, high), 3)


def _height(sex: str, age: float, numbers: random.Random) -> float:
    mean, spread = STATURE[sex]
    height = min(max(numbers.gauss(mean, spread), mean - 2 * spread), mean + 2 * spread)
    if age < GROWN:
        height *= 0.84 + 0.16 * (age - YOUNGEST) / (GROWN - YOUNGEST)
    return round(height - 0.001 * max(age - 45, 0), 3)


def _face(numbers: random.Random) -> tuple[tuple[str, float], ...]:
    """Weights of the features of a face, and a slight smile."""
    chosen = [(name, round(min(abs(numbers.gauss(0, 0.35)), 0.8), 3)) for name in CHOICES["face"]]
    kept = [(name, weight) for name, weight in chosen if weight > 0.12]
    return (*kept, ("smile", _between(numbers, 0.05, 0.3)))


def _clothed(body: Body, sex: str, age: float, ancestry: Any, numbers: random.Random) -> Body:
    """Return the person with skin, eyes, hair and clothes."""
    grey = numbers.random() < min(max((age - 38) / 35, 0.0), 0.95)
    styles = CHOICES["styles"][sex]
    style = numbers.choice(styles["old"] if age > 50 else styles["young"])
    outfit = numbers.choice(CHOICES["outfits"][sex] if age >= GROWN else CHOICES["outfits"]["child"])
    top = numbers.choice(CHOICES["tops"])
    bottom = numbers.choice(CHOICES["bottoms"])
    return replace(
        body,
        skin=numbers.choice(ancestry["skins"]),
        iris=numbers.choice(ancestry["irises"]),
        hair=numbers.choice(CHOICES["greys"] if grey else ancestry["hairs"]),
        style=style,
        garment=outfit["garment"],
        legwear=outfit["legwear"],
        top=top,
        bottom=top if outfit.get("dress") else bottom,
        weave=numbers.choice(CHOICES["weaves"]),
        shoes=numbers.choice(CHOICES["shoes"]),
    )
