"""Numbered plans: from zero, in nested lists, with a line without a number, on one line."""

from __future__ import annotations

from cases.plans import Plan, lines

NUMBERED = (
    Plan(
        "02",
        "a.txt",
        lines("0) Walk to the bedroom", "1) Sit on the bed", "2) Lie on the bed"),
        ("Walk bedroom; Sit bed; Lie bed",),
    ),
    Plan(
        "02",
        "b.txt",
        lines("0 - Find the book", "1 - Grab the book", "2 - Read the book"),
        ("Find book; Grab book; Read book",),
    ),
    Plan(
        "02",
        "c.md",
        lines("**0.** Go to the bathroom", "**1.** Switch on the light", "**2.** Enter the shower"),
        ("Walk bathroom; SwitchOn light; Enter shower",),
    ),
    Plan(
        "02",
        "d.txt",
        lines("00. Walk to the sofa", "01. Sit on the sofa", "02. Stand up"),
        ("Walk sofa; Sit sofa; StandUp",),
    ),
    Plan(
        "04",
        "a.txt",
        lines(
            "Task: Watch the news",
            "Step 0 - Walk to the television",
            "Step 1 - Turn on the television",
            "Step 2 - Watch the television",
        ),
        ("Walk television; SwitchOn television; Watch television",),
        titles=("Watch the news",),
    ),
    Plan(
        "04",
        "b.txt",
        lines("Goal: write a letter", "STEP 0. Find a pen", "STEP 1. Grab the pen"),
        ("Find pen; Grab pen",),
    ),
    Plan(
        "04",
        "c.txt",
        lines("Task: tea", "Action 0: walk to the kettle", "Action 1: turn on the kettle"),
        ("Walk kettle; SwitchOn kettle",),
    ),
    Plan(
        "12",
        "a.txt",
        "Explanation: The shirt is in the closet. I would look there first, then put it in the machine.\n\n"
        "Plan: 1. walk to bedroom 2. find shirt 3. grab shirt 4. walk to bathroom 5. Done.\n",
        ("Walk bedroom; Find clothes_shirt; Grab clothes_shirt; Walk bathroom",),
    ),
    Plan(
        "12",
        "b.txt",
        "Plan: 1) go to the living room, 2) find the remote control, 3) grab the remote control, 4) done\n",
        ("Walk living_room; Find remote_control; Grab remote_control",),
    ),
    Plan(
        "12",
        "c.txt",
        "Explanation: I need 2 cups.\nPlan: 1. walk to kitchen; 2. find cup; 3. grab cup; 4. DONE\n",
        ("Walk kitchen; Find cup; Grab cup",),
    ),
    Plan(
        "14",
        "a.txt",
        lines("1. Go to the bathroom", "   a. Turn on the faucet", "   b. Grab the soap", "2. Turn off the faucet"),
        ("Walk bathroom; SwitchOn faucet; Grab soap; SwitchOff faucet",),
    ),
    Plan(
        "14",
        "b.txt",
        lines(
            "1. Walk to the bedroom",
            "  1.1 Open the closet",
            "  1.2 Grab the shirt",
            "2. Walk to the bed",
            "  2.1. Sit on the bed",
        ),
        ("Walk bedroom; Open closet; Grab clothes_shirt; Walk bed; Sit bed",),
    ),
    Plan(
        "14",
        "c.md",
        lines(
            "1) Go to the kitchen",
            "\t* Find the cup",
            "\t* Grab the cup",
            "\t\t+ Walk to the table",
            "2) Sit on the chair",
        ),
        ("Walk kitchen; Find cup; Grab cup; Walk table; Sit chair",),
    ),
    Plan(
        "14",
        "d.txt",
        lines("1. Walk to the sofa", "   and sit on the sofa", "2. Read the book"),
        ("Walk sofa; Sit sofa; Read book",),
    ),
    Plan(
        "14",
        "e.md",
        lines("## 1. Prepare", "- [ ] Walk to the desk", "- [ ] Grab the pen", "## 2. Write", "- [ ] Sit on the chair"),
        ("Walk desk; Grab pen; Sit chair",),
    ),
    Plan(
        "15",
        "a.txt",
        lines("1. Walk to the bedroom", "2. Open the closet", "Grab the shirt", "4. Close the closet"),
        ("Walk bedroom; Open closet; Grab clothes_shirt; Close closet",),
    ),
    Plan(
        "15",
        "b.txt",
        lines("Step 1: Find the book", "Grab the book", "Step 3: Read the book"),
        ("Find book; Grab book; Read book",),
    ),
    Plan(
        "15",
        "c.txt",
        lines("- Walk to the television", "Turn on the television", "- Sit on the sofa"),
        ("Walk television; SwitchOn television; Sit sofa",),
    ),
    Plan(
        "15",
        "d.txt",
        lines("1. Walk to the desk", "Fnord the desk quickly", "3. Sit on the chair"),
        ("Walk desk; Sit chair",),
        "2 NOT_UNDERSTOOD",
    ),
)
