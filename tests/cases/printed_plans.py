"""Steps as simulators, planners, benchmarks and their logs print them."""

from __future__ import annotations

from cases.plans import Plan, lines

BEDTIME = "Walk bedroom; Find bed; Lie bed"
PRINTED = (
    Plan(
        "22", "a.txt", lines("[WALK] <bedroom> (67) [0]", "[FIND] <bed> (105) [1]", "[LIE] <bed> (105) [2]"), (BEDTIME,)
    ),
    Plan(
        "22", "b.txt", lines("[PUTBACK] <cup> (12) <table> (40) [3]", "[STANDUP] [4]"), ("PutBack cup table; StandUp",)
    ),
    Plan(
        "22",
        "c.txt",
        lines("<char0> [walk] <washingmachine> (73) [0]", "<char0> [open] <washingmachine> (73) [0]"),
        ("Walk washing_machine; Open washing_machine",),
    ),
    Plan("64", "a.txt", lines("[WALK] <bedroom> (1) [0]", "[FIND] <bed> (1) [1]", "[LIE] <bed> (1) [2]"), (BEDTIME,)),
    Plan(
        "64",
        "b.txt",
        lines("Sleep", "", "", "", "[Walk] <bedroom> (1) [10]", "[Find] <bed> (1)  [11]", "[Lie] <bed> (1)\t[12]"),
        (BEDTIME,),
        titles=("Sleep",),
    ),
    Plan("64", "c.txt", lines("[0] [WALK] <bedroom> (1)", "[1] [FIND] <bed> (1)", "[2] [LIE] <bed> (1)"), (BEDTIME,)),
    Plan(
        "65",
        "a.txt",
        lines(
            "[Scene] 1",
            "[Goal] drink milk.",
            "[Step 1] walk fridge.",
            "[Step 2] open fridge.",
            "[Step 3] grab milk.",
            "[Step 4] done task.",
        ),
        ("Walk fridge; Open fridge; Grab milk",),
        titles=("drink milk",),
    ),
    Plan(
        "65",
        "b.txt",
        lines(
            "[Scene] 3",
            "[Goal] listen.",
            "[Description] turn on the radio.",
            "[Step 1] find radio.",
            "[Step 2] switchon radio.",
            "",
            "[Scene] 4",
            "[Goal] sleep.",
            "[Step 1] walk bed.",
            "[Step 2] lie bed.",
            "[Step 3] Done task",
        ),
        ("Find radio; SwitchOn radio", "Walk bed; Lie bed"),
        titles=("listen", "sleep"),
    ),
    Plan(
        "65",
        "c.txt",
        lines(
            "[Goal] put cup on table",
            "[Step 1] grab cup",
            "[Step 2] put cup on table",
            "[Step 3] fnord cup",
            "[Step 4] done task",
        ),
        ("Grab cup; PutBack cup table",),
        "4 NOT_UNDERSTOOD",
    ),
    Plan(
        "71",
        "a.txt",
        lines("Nap", "", "", "", "[Walk] <bed> (1)  // the near one", "[Lie] <bed> (1)"),
        ("Walk bed; Lie bed",),
    ),
    Plan(
        "71",
        "b.txt",
        lines("Nap", "", "", "", "[Walk] <bed> (1) # to bed", "# then rest", "[Lie] <bed> (1) #rest"),
        ("Walk bed; Lie bed",),
        titles=("Nap",),
    ),
    Plan(
        "71",
        "c.txt",
        lines("1. Walk to the bed  # bedroom", "2. Lie on the bed  # (until morning)"),
        ("Walk bed; Lie bed",),
    ),
    Plan(
        "26",
        "a.json",
        '{"1_1": ["walk_towards character bed", "lie_on character bed"]}',
        ("Walk bed; Lie bed",),
        titles=("1_1",),
    ),
    Plan(
        "26",
        "b.json",
        '{"3_2": ["walk_towards character kettle", "switch_on character kettle"], '
        '"4_1": ["grab character cup", "put_on character cup table"]}',
        ("Walk kettle; SwitchOn kettle", "Grab cup; PutBack cup table"),
    ),
    Plan(
        "26",
        "c.json",
        '{\n  "77_1": [\n    "walk_into character bathroom",\n    "open character washing_machine",\n'
        '    "put_inside character soap washing_machine"\n  ]\n}\n',
        ("Walk bathroom; Open washing_machine; PutIn soap washing_machine",),
    ),
    Plan(
        "80",
        "a.json",
        '[{"title": "TV", "steps": ["(walk_towards character television)", "(switch_on character television)"]}]',
        ("Walk television; SwitchOn television",),
    ),
    Plan(
        "80",
        "b.txt",
        lines("(walk_towards character bed)", "(lie_on character bed)", "; cost = 2 (unit cost)"),
        ("Walk bed; Lie bed",),
    ),
    Plan(
        "80",
        "c.txt",
        lines("0.000: (walk_towards character sofa) [1.000]", "1.001: (sit character sofa) [1.000]"),
        ("Walk sofa; Sit sofa",),
    ),
    Plan(
        "80",
        "d.json",
        '{"title": "x", "steps": ["walk_towards char lamp", "switch_on char lamp"]}',
        ("",),
        "1 NOT_UNDERSTOOD, 1 NOT_UNDERSTOOD",
    ),
    Plan(
        "76",
        "a.jsonl",
        lines(
            '{"instruction": "Throw the cup away", "step": ["find cup", "pick cup", '
            '"find garbagecan", "put garbagecan"]}'
        ),
        ("Find cup; Grab cup; Find garbage_can",),
        "1 NOT_UNDERSTOOD",
    ),
    Plan(
        "76",
        "b.jsonl",
        lines(
            '{"instruction": "Lamp", "step": ["find floorlamp", "turn on floorlamp"]}',
            '{"instruction": "TV", "step": ["find remotecontrol", "pick remotecontrol", '
            '"find television", "turn on television"]}',
        ),
        (
            "Find floor_lamp; SwitchOn floor_lamp",
            "Find remote_control; Grab remote_control; Find television; SwitchOn television",
        ),
    ),
    Plan(
        "76",
        "c.jsonl",
        lines('{"instruction": "Break it", "step": ["find mug", "pick mug", "throw mug", "break window"]}'),
        ("Find mug; Grab mug; Break window",),
        "1 NOT_AFFORDED, 1 NOT_UNDERSTOOD",
    ),
)
