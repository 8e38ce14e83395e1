"""Plans that are Python code: the calls are the steps, and comments are comments."""

from __future__ import annotations

from cases.plans import Plan, lines

TEA = "Walk kettle; SwitchOn kettle"
CODE = (
    Plan(
        "61",
        "a.py",
        lines(
            "def make_tea():",
            "    # 0: walk to the kitchen",
            "    walk('kitchen')",
            "    # 1: put it on",
            "    find('kettle')",
            "    switchon('kettle')",
            "    # 2: Done",
        ),
        ("Walk kitchen; Find kettle; SwitchOn kettle",),
    ),
    Plan(
        "61",
        "b.py",
        lines(
            "def eat_apple():",
            "\t# 0: open fridge",
            "\tassert('close' to 'fridge')",
            "\t\telse: walk('fridge')",
            "\topen('fridge')",
            "\tgrab('apple')",
            "\teat('apple')",
            "",
            "def nap():",
            "\twalk('bed')",
            "\tlie('bed')",
        ),
        ("Walk fridge; Open fridge; Grab food_apple; Eat food_apple", "Walk bed; Lie bed"),
    ),
    Plan(
        "61",
        "c.py",
        lines(
            "def put_cup_away():",
            '    """Put the cup on the table."""',
            "    grab('cup')  # 1: take it",
            "    putback('cup', 'table')",
            "    standup()",
        ),
        ("Grab cup; PutBack cup table; StandUp",),
    ),
    Plan(
        "62",
        "a.md",
        lines(
            "Here is the code:",
            "",
            "```python",
            "# go to it",
            'walk("kettle")',
            "switch_on('kettle')  # on",
            "```",
            "",
            "Let me know!",
        ),
        (TEA,),
        broken="below words, a call such as switch_on() with a comment behind it is not read",
    ),
    Plan("62", "b.md", lines("```", "1. Walk to the kettle", "2. Turn on the kettle", "```"), (TEA,)),
    Plan(
        "62",
        "c.md",
        lines("```py", "from actions import *", "", "robot.walk('kettle')", "robot.switch_on('kettle')", "```"),
        (TEA,),
    ),
)
