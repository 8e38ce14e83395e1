"""Phrases of people and language models: each is read as meant, or refused; none as something else."""

from __future__ import annotations

from cases.plans import Plan, lines


def refused(case: str, file: str, *phrases: str) -> Plan:
    """Return a plan of which no line is a step."""
    faults = ", ".join(f"{line} NOT_UNDERSTOOD" for line in range(1, len(phrases) + 1))
    return Plan(case, file, lines(*(f"{n}. {phrase}" for n, phrase in enumerate(phrases, 1))), ("",), faults)


PHRASES = (
    refused(
        "11",
        "a.txt",
        "Boil the water",
        "Iron the shirt",
        "Bleach the towel",
        "Paint the wall",
        "Mop the floor",
        "Peel the potato",
        "Simmer the soup",
        "Kick the ball",
        "Ring the phone",
    ),
    refused(
        "11",
        "b.txt",
        "Melt the cheese",
        "Shake the bottle",
        "Freeze the milk",
        "Hang the coat",
        "Garnish the cereal",
        "Crush the can",
        "Toss the pillow",
        "Fix the lamp",
        "Hem the shirt",
    ),
    refused(
        "11",
        "c.txt",
        "Toast the bread",
        "Water the plant",
        "Fill the cup",
        "Light the candle",
        "Book the room",
        "Charge the phone",
        "Unclog the toilet",
        "Sketch the curtains",
        "Varnish the floor",
    ),
    Plan(
        "19",
        "a.txt",
        lines(
            "1. Head over to the kitchen",
            "2. Open the cupboard door",
            "3. Take a mug out of the cupboard",
            "4. Place the mug on the counter",
        ),
        ("Walk kitchen; Open cupboard; Grab mug",),
        "4 NOT_UNDERSTOOD",
    ),
    Plan(
        "19",
        "b.txt",
        lines("1. First, walk over to the TV", "2. Then switch the TV on", "3. Finally, have a seat on the couch"),
        ("Walk television; SwitchOn television; Sit couch",),
    ),
    Plan(
        "19",
        "c.txt",
        lines(
            "1. Go into the bathroom", "2. Pick the towel up", "3. Put down the towel", "4. Turn off the light switch"
        ),
        ("Walk bathroom; Grab towel; Release towel; SwitchOff lightswitch",),
    ),
    refused(
        "23",
        "a.txt",
        "put sofa",
        "put chair",
        "Heat the potato with the microwave",
        "Rinse off the knife holder wall",
        "Put the watch on the shelf in the box",
        "Cool the tomato",
    ),
    Plan(
        "23",
        "b.txt",
        lines("1. Slice the bread on the table.", "2. Take the plate off of the table", "3. put bed"),
        ("Cut food_bread; Grab plate",),
        "3 NOT_UNDERSTOOD",
        1,
    ),
    Plan(
        "23",
        "c.txt",
        lines(
            "1. Carry the tomato to the trash can",
            "2. Cook the potato.",
            "3. find tarp",
            "4. Put the pen in the mug on the desk",
        ),
        ("Walk trashcan",),
        "2 NOT_UNDERSTOOD, 3 NOT_UNDERSTOOD, 4 NOT_UNDERSTOOD",
        1,
    ),
    Plan(
        "67",
        "a.txt",
        lines(
            "Task: clean", "1. Wipe the table with a sponge", "2. find a lime soda", "3. Move the apple to the fridge"
        ),
        ("Wipe table; PutIn food_apple fridge",),
        "3 NOT_UNDERSTOOD",
        1,
    ),
    Plan(
        "67",
        "b.txt",
        lines("Task: laundry", "1. put the laundry in the washing machine", "2. find a fan belt"),
        ("PutIn clothes_pile washing_machine",),
        "3 NOT_UNDERSTOOD",
    ),
    Plan(
        "67",
        "c.txt",
        lines("Task: x", "1. wash the mug with the dish soap", "2. move the book to the bookshelf", "3. grab a coke"),
        ("Wash mug; PutBack book bookshelf",),
        "4 NOT_UNDERSTOOD",
        1,
    ),
    Plan(
        "68",
        "a.txt",
        lines(
            "Task: usual",
            "1. remove the cup from the cupboard",
            "2. get the book from the shelf",
            "3. turn the tv off",
            "4. shut the closet door",
            "5. walk to the sofa and sit on the sofa",
        ),
        ("Grab cup; Grab book; SwitchOff television; Close closet; Walk sofa; Sit sofa",),
    ),
    Plan(
        "68",
        "b.txt",
        lines(
            "Task: usual",
            "1. bring the plate to the table",
            "2. put the cup down",
            "3. pick the pen up from the desk",
            "4. proceed to the bedroom",
        ),
        ("PutBack plate table; Release cup; Grab pen; Walk bedroom",),
    ),
    Plan(
        "68",
        "c.txt",
        lines(
            "Task: usual",
            "1. switch the lamp on",
            "2. retrieve the milk from the fridge, then close the fridge",
            "3. head to the kitchen table",
            "4. place the glass onto the kitchen counter",
        ),
        ("SwitchOn lamp; Grab milk; Close fridge; Walk kitchen_table; PutBack glass kitchen_counter",),
    ),
    Plan(
        "74",
        "a.txt",
        "Look\n\n\n\n[TurnTo] <bedroom> (1)\n[LookAt] <bedroom> (1)\n",
        ("TurnTo bedroom; LookAt bedroom",),
        "6 NOT_AFFORDED",
    ),
    Plan(
        "74",
        "b.txt",
        "1. Turn to the living room\n2. Look at the living room\n",
        ("TurnTo living_room; LookAt living_room",),
        "2 NOT_AFFORDED",
    ),
    Plan("74", "c.json", '{"TURNTO": ["bathroom"]}', ("TurnTo bathroom",)),
)
