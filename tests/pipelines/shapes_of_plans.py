"""Plans of one lamp in many shapes: what people, language models, planners and tools write."""

import json
from typing import NamedTuple

LAMP = ["[Walk] <desk> (1)", "[Find] <lamp> (1)", "[SwitchOn] <lamp> (1)"]
S = ["walk to the desk", "find the lamp", "switch on the lamp"]


class Shape(NamedTuple):
    """A file, its text, and the steps in it."""

    file: str
    text: str
    steps: list[str]


SHAPES: dict[str, Shape] = {}
"""Shapes by name; all are read."""

NOT_YET = frozenset(
    [
        "sexp",
        "sexp seq",
        "toml tables",
        "toml tables text",
        "jsonl string",
        "&& line",
        "mermaid",
        "numpy list",
        "dictation",
        "todo.txt",
        "ltl",
    ]
)
"""Shapes of which some line is refused."""


def add(name, file, text, want=LAMP):
    """Add a shape."""
    SHAPES[name] = Shape(file, text, want)


add(
    "alexa yaml",
    "a.yaml",
    "routine:\n  name: Light\n  trigger: voice\n  actions:\n    - walk to the desk\n    - find the lamp\n    - switch on the lamp\n",
)
add(
    "home assistant",
    "a.yaml",
    "automation:\n  - alias: Light\n    trigger:\n      - platform: state\n    action:\n      - service: robot.walk\n        target: desk\n      - service: robot.find\n        target: lamp\n      - service: robot.switch_on\n        target: lamp\n",
)
add("ifttt", "a.txt", "IF evening THEN\n  walk to the desk\n  find the lamp\n  switch on the lamp\nEND\n")
add(
    "bt xml",
    "a.xml",
    '<root>\n <BehaviorTree ID="Light">\n  <Sequence>\n   <Action ID="Walk" target="desk"/>\n   <Action ID="Find" target="lamp"/>\n   <Action ID="SwitchOn" target="lamp"/>\n  </Sequence>\n </BehaviorTree>\n</root>\n',
)
add(
    "bt xml named",
    "a.xml",
    '<root main_tree_to_execute="Light">\n  <Sequence name="Light">\n   <Walk object="desk"/>\n   <Find object="lamp"/>\n   <SwitchOn object="lamp"/>\n  </Sequence>\n</root>\n',
)
add("py_trees", "a.txt", "[-] Light\n    --> Walk(desk)\n    --> Find(lamp)\n    --> SwitchOn(lamp)\n")
add(
    "py_trees sel", "a.txt", "{-} Light [*]\n    --> walk desk [✓]\n    --> find lamp [✓]\n    --> switch on lamp [✕]\n"
)
add("ascii tree", "a.txt", "Light\n+-- Walk(desk)\n+-- Find(lamp)\n\\-- SwitchOn(lamp)\n")
add("uni tree", "a.txt", "Light\n├── Walk(desk)\n├── Find(lamp)\n└── SwitchOn(lamp)\n")
add("uni tree words", "a.txt", "Light\n├── walk to the desk\n│   ├── find the lamp\n└── switch on the lamp\n")
add("tree words", "a.txt", "Light\n|-- walk to the desk\n|-- find the lamp\n`-- switch on the lamp\n")
add("pddl", "a.pddl", "; cost = 3\n0: (WALK ROBOT DESK)\n1: (FIND ROBOT LAMP)\n2: (SWITCH_ON ROBOT LAMP)\n")
add(
    "pddl durative",
    "a.plan",
    "0.000: (walk desk) [1.000]\n1.001: (find lamp) [1.000]\n2.002: (switch_on lamp) [1.000]\n",
)
add(
    "ff output",
    "a.txt",
    "ff: found legal plan as follows\n\nstep    0: WALK DESK\n        1: FIND LAMP\n        2: SWITCH_ON LAMP\n\ntime spent: 0.00 seconds\n",
)
add("sexp", "a.txt", "(plan light\n  (walk desk)\n  (find lamp)\n  (switch-on lamp))\n")
add("sexp seq", "a.lisp", "(define (light)\n  (walk 'desk)\n  (find 'lamp)\n  (switch-on 'lamp))\n")
add("prolog", "a.pl", "plan(light, [walk(desk), find(lamp), switch_on(lamp)]).\n")
add(
    "latex enumerate",
    "a.tex",
    "\\documentclass{article}\n\\begin{document}\n\\section{Light}\n\\begin{enumerate}\n\\item Walk to the desk.\n\\item Find the lamp.\n\\item Switch on the lamp.\n\\end{enumerate}\n\\end{document}\n",
)
add(
    "latex table",
    "a.tex",
    "\\begin{tabular}{ll}\n1 & walk to the desk \\\\\n2 & find the lamp \\\\\n3 & switch on the lamp \\\\\n\\end{tabular}\n",
)
add("rst", "a.rst", "Light\n=====\n\n#. Walk to the desk\n#. Find the lamp\n#. Switch on the lamp\n")
add(
    "rst table",
    "a.rst",
    "====  ==================\nNo.   Step\n====  ==================\n1     Walk to the desk\n2     Find the lamp\n3     Switch on the lamp\n====  ==================\n",
)
add(
    "rst grid",
    "a.rst",
    "+---+--------------------+\n| # | Step               |\n+===+====================+\n| 1 | Walk to the desk   |\n+---+--------------------+\n| 2 | Find the lamp      |\n+---+--------------------+\n| 3 | Switch on the lamp |\n+---+--------------------+\n",
)
add("asciidoc", "a.adoc", "== Light\n\n. Walk to the desk\n. Find the lamp\n. Switch on the lamp\n")
add("mediawiki", "a.txt", "== Light ==\n# Walk to the desk\n# Find the lamp\n# Switch on the lamp\n")
add("textile", "a.txt", "h1. Light\n\n# Walk to the desk\n# Find the lamp\n# Switch on the lamp\n")
add(
    "jupyter",
    "a.ipynb",
    json.dumps(
        {
            "cells": [
                {
                    "cell_type": "markdown",
                    "metadata": {},
                    "source": ["# Light\n", "1. Walk to the desk\n", "2. Find the lamp\n", "3. Switch on the lamp"],
                }
            ],
            "metadata": {},
            "nbformat": 4,
            "nbformat_minor": 5,
        },
        indent=1,
    ),
)
add("csv multi-line", "a.csv", 'task,plan\nLight,"walk to the desk\nfind the lamp\nswitch on the lamp"\n')
add("csv bullets", "a.csv", 'task,plan\nLight,"- walk to the desk\n- find the lamp\n- switch on the lamp"\n')
add("csv arrows", "a.csv", "task,plan\nLight,walk to the desk → find the lamp → switch on the lamp\n")
add("csv pipes", "a.csv", "task,plan\nLight,walk to the desk | find the lamp | switch on the lamp\n")
add("csv slashes", "a.csv", "task,plan\nLight,walk to the desk / find the lamp / switch on the lamp\n")
add("csv plus", "a.csv", "task,plan\nLight,walk to the desk + find the lamp + switch on the lamp\n")
add("csv calls", "a.csv", 'task,plan\nLight,"Walk(desk), Find(lamp), SwitchOn(lamp)"\n')
add("csv calls semi", "a.csv", "task,plan\nLight,Walk(desk);Find(lamp);SwitchOn(lamp)\n")
add("csv json list", "a.csv", 'task,plan\nLight,"[""walk to the desk"", ""find the lamp"", ""switch on the lamp""]"\n')
add(
    "csv nr;zeit;was",
    "a.csv",
    'nr;zeit;was\n1;"07:00";"Walk to the desk"\n2;"07:01";"Find the lamp"\n3;"07:02";"Switch on the lamp"\n',
)
add(
    "csv time,activity",
    "a.csv",
    "time,activity\n07:00,Walk to the desk\n07:01,Find the lamp\n07:02,Switch on the lamp\n",
)
add(
    "csv nr,instruction",
    "a.csv",
    "no,instruction,done\n1,Walk to the desk,yes\n2,Find the lamp,yes\n3,Switch on the lamp,no\n",
)
add("csv no header", "a.csv", "1,Walk to the desk\n2,Find the lamp\n3,Switch on the lamp\n")
add("csv no header times", "a.csv", "07:00,Walk to the desk\n07:01,Find the lamp\n07:02,Switch on the lamp\n")
add("csv verbs", "a.csv", "step,verb,noun\n1,walk to,desk\n2,find,lamp\n3,switch on,lamp\n")
add("csv camel", "a.csv", "1,Walk,desk\n2,Find,lamp\n3,SwitchOn,lamp\n")
add("csv camel header", "a.csv", "idx,act,obj1,obj2\n1,Walk,desk,\n2,Find,lamp,\n3,SwitchOn,lamp,\n")
add("tsv camel", "a.tsv", "1\tWalk\tdesk\n2\tFind\tlamp\n3\tSwitchOn\tlamp\n")
add("tsv unnumbered", "a.tsv", "Walk\tdesk\nFind\tlamp\nSwitchOn\tlamp\n")
add("txt tabs", "a.txt", "1\tWalk\tdesk\n2\tFind\tlamp\n3\tSwitchOn\tlamp\n")
add("txt tabs words", "a.txt", "1\tWalk to the desk\n2\tFind the lamp\n3\tSwitch on the lamp\n")
add(
    "md arrows",
    "a.md",
    "| task | plan |\n|---|---|\n| Light | walk to the desk → find the lamp → switch on the lamp |\n",
)
add(
    "md verb obj",
    "a.md",
    "| # | Verb | Object |\n|---|---|---|\n| 1 | walk to | desk |\n| 2 | find | lamp |\n| 3 | switch on | lamp |\n",
)
add(
    "md action target prep",
    "a.md",
    "| Action | Target |\n|---|---|\n| walk | to the desk |\n| find | the lamp |\n| switch on | the lamp |\n",
)
add("md no lines", "a.md", "| 1 | walk to the desk |\n| 2 | find the lamp |\n| 3 | switch on the lamp |\n")
add(
    "md when do",
    "a.md",
    "| When | What to do |\n|---|---|\n| 7:00 | walk to the desk |\n| 7:05 | find the lamp |\n| 7:06 | switch on the lamp |\n",
)
add(
    "psql table",
    "a.txt",
    " n |        step        \n---+--------------------\n 1 | walk to the desk\n 2 | find the lamp\n 3 | switch on the lamp\n(3 rows)\n",
)
add(
    "box table",
    "a.txt",
    "┌───┬────────────────────┐\n│ n │ step               │\n├───┼────────────────────┤\n│ 1 │ walk to the desk   │\n│ 2 │ find the lamp      │\n│ 3 │ switch on the lamp │\n└───┴────────────────────┘\n",
)
add(
    "two columns",
    "a.txt",
    "Action      Object\n------      ------\nwalk to     desk\nfind        lamp\nswitch on   lamp\n",
)
add(
    "xml",
    "a.xml",
    '<plan>\n <title>Light</title>\n <steps>\n  <step n="1">Walk to the desk</step>\n  <step n="2">Find the lamp</step>\n  <step n="3">Switch on the lamp</step>\n </steps>\n</plan>\n',
)
add(
    "xml attr",
    "a.xml",
    '<plan name="Light">\n <action name="Walk" object="desk"/>\n <action name="Find" object="lamp"/>\n <action name="SwitchOn" object="lamp"/>\n</plan>\n',
)
add(
    "xml task el",
    "a.xml",
    "<?xml version='1.0'?>\n<instructions>\n <instruction>Walk to the desk</instruction>\n <instruction>Find the lamp</instruction>\n <instruction>Switch on the lamp</instruction>\n</instructions>\n",
)
add(
    "html ol entities",
    "a.html",
    "<h2>Light</h2>\n<ol>\n<li>Walk to the desk &amp; find the lamp</li>\n<li>Switch&nbsp;on the lamp</li>\n</ol>\n",
)
add("html one line", "a.html", "<ol><li>Walk to the desk</li><li>Find the lamp</li><li>Switch on the lamp</li></ol>\n")
add(
    "html p",
    "a.html",
    "<html><body>\n<p>1. Walk to the desk</p>\n<p>2. Find the lamp</p>\n<p>3. Switch on the lamp</p>\n</body></html>\n",
)
add("ini steps", "a.ini", "[light]\nstep1 = walk to the desk\nstep2 = find the lamp\nstep3 = switch on the lamp\n")
add("ini numbers", "a.ini", "[light]\n1 = walk to the desk\n2 = find the lamp\n3 = switch on the lamp\n")
add(
    "ini title",
    "a.ini",
    "[plan]\ntitle = Light\naction_1=walk to the desk\naction_2=find the lamp\naction_3=switch on the lamp\n",
)
add(
    "properties",
    "a.properties",
    "light.step.1=walk to the desk\nlight.step.2=find the lamp\nlight.step.3=switch on the lamp\n",
)
add("env", "a.env", 'STEP_1="walk to the desk"\nSTEP_2="find the lamp"\nSTEP_3="switch on the lamp"\n')
add("toml list", "a.toml", 'title = "Light"\nsteps = ["walk to the desk", "find the lamp", "switch on the lamp"]\n')
add(
    "toml list multi",
    "a.toml",
    'title = "Light"\nsteps = [\n  "walk to the desk",\n  "find the lamp",\n  "switch on the lamp",\n]\n',
)
add(
    "toml tables",
    "a.toml",
    '[[step]]\naction = "Walk"\nobject = "desk"\n\n[[step]]\naction = "Find"\nobject = "lamp"\n\n[[step]]\naction = "SwitchOn"\nobject = "lamp"\n',
)
add(
    "toml tables text",
    "a.toml",
    'name = "Light"\n[[steps]]\ntext = "walk to the desk"\n[[steps]]\ntext = "find the lamp"\n[[steps]]\ntext = "switch on the lamp"\n',
)
add("toml section list", "a.toml", '[light]\nsteps = ["walk to the desk", "find the lamp", "switch on the lamp"]\n')
add(
    "log iso",
    "a.log",
    "2024-05-01T10:00:01Z INFO walk to the desk\n2024-05-01T10:00:02Z INFO find the lamp\n2024-05-01T10:00:03Z INFO switch on the lamp\n",
)
add(
    "log syslog",
    "a.log",
    "May  1 10:00:01 host robotd[12]: walk to the desk\nMay  1 10:00:02 host robotd[12]: find the lamp\nMay  1 10:00:03 host robotd[12]: switch on the lamp\n",
)
add(
    "log ros",
    "a.log",
    "[INFO] [1714557601.123456] [planner]: walk to the desk\n[INFO] [1714557602.123456] [planner]: find the lamp\n[INFO] [1714557603.123456] [planner]: switch on the lamp\n",
)
add(
    "log executing",
    "a.log",
    "[10:00:01] Executing: Walk(desk)\n[10:00:02] Executing: Find(lamp)\n[10:00:03] Executing: SwitchOn(lamp)\n",
)
add("log python", "a.log", "INFO:robot:walk to the desk\nINFO:robot:find the lamp\nINFO:robot:switch on the lamp\n")
add(
    "log python2",
    "a.log",
    "2024-05-01 10:00:01,123 - robot - INFO - walk to the desk\n2024-05-01 10:00:02,123 - robot - INFO - find the lamp\n2024-05-01 10:00:03,123 - robot - INFO - switch on the lamp\n",
)
add("log t=", "a.log", "t=0 walk to the desk\nt=1 find the lamp\nt=2 switch on the lamp\n")
add("log tick", "a.log", "tick 1: walk desk\ntick 2: find lamp\ntick 3: switchon lamp\n")
add(
    "whatsapp",
    "a.txt",
    "[12/03/24, 09:15:33] Anna: Walk to the desk\n[12/03/24, 09:15:40] Anna: Find the lamp\n[12/03/24, 09:16:01] Bot: ok\n[12/03/24, 09:16:10] Anna: Switch on the lamp\n",
)
add(
    "whatsapp2",
    "a.txt",
    "12/03/2024, 09:15 - Anna: Walk to the desk\n12/03/2024, 09:15 - Anna: Find the lamp\n12/03/2024, 09:16 - Anna: Switch on the lamp\n",
)
add("slack", "a.txt", "Anna  9:15 AM\nWalk to the desk\nFind the lamp\nSwitch on the lamp\n")
add("discord", "a.txt", "Anna — Today at 9:15 AM\n1. Walk to the desk\n2. Find the lamp\n3. Switch on the lamp\n")
add("irc", "a.log", "<anna> walk to the desk\n<anna> find the lamp\n<bot> ok\n<anna> switch on the lamp\n")
add(
    "irc time",
    "a.log",
    "[09:15] <anna> walk to the desk\n[09:15] <anna> find the lamp\n[09:16] <anna> switch on the lamp\n",
)
add(
    "srt",
    "a.srt",
    "1\n00:00:01,000 --> 00:00:04,000\nWalk to the desk\n\n2\n00:00:05,000 --> 00:00:07,000\nFind the lamp\n\n3\n00:00:08,000 --> 00:00:09,000\nSwitch on the lamp\n",
)
add(
    "vtt",
    "a.vtt",
    "WEBVTT\n\n00:01.000 --> 00:04.000\nWalk to the desk\n\n00:05.000 --> 00:07.000\nFind the lamp\n\n00:08.000 --> 00:09.000\nSwitch on the lamp\n",
)
add(
    "email quote",
    "a.txt",
    "On Monday Anna wrote:\n> 1. Walk to the desk\n> 2. Find the lamp\n> 3. Switch on the lamp\n",
)
add("email quote plain", "a.txt", "Light\n> walk to the desk\n> find the lamp\n> switch on the lamp\n")
add(
    "email headers",
    "a.eml",
    "From: a@b.c\nTo: d@e.f\nSubject: Light\n\nHi Bo,\n\n1. Walk to the desk\n2. Find the lamp\n3. Switch on the lamp\n\nThanks,\nAnna\n",
)
add("emoji bullets", "a.txt", "🚶 walk to the desk\n🔍 find the lamp\n💡 switch on the lamp\n")
add("keycaps", "a.txt", "1️⃣ walk to the desk\n2️⃣ find the lamp\n3️⃣ switch on the lamp\n")
add("circled", "a.txt", "① walk to the desk\n② find the lamp\n③ switch on the lamp\n")
add("fullwidth", "a.txt", "1． walk to the desk\n2． find the lamp\n3． switch on the lamp\n")
add("roman", "a.txt", "I. walk to the desk\nII. find the lamp\nIII. switch on the lamp\n")
add("roman)", "a.txt", "i) walk to the desk\nii) find the lamp\niii) switch on the lamp\n")
add("letters", "a.txt", "A. walk to the desk\nB. find the lamp\nC. switch on the lamp\n")
add("letters:", "a.txt", "a: walk to the desk\nb: find the lamp\nc: switch on the lamp\n")
add("Step One:", "a.txt", "Step One: walk to the desk\nStep Two: find the lamp\nStep Three: switch on the lamp\n")
add("One:", "a.txt", "One: walk to the desk\nTwo: find the lamp\nThree: switch on the lamp\n")
add("step I", "a.txt", "Step I: walk to the desk\nStep II: find the lamp\nStep III: switch on the lamp\n")
add("step A", "a.txt", "Step A: walk to the desk\nStep B: find the lamp\nStep C: switch on the lamp\n")
add("STEP 1/3", "a.txt", "Step 1/3: walk to the desk\nStep 2/3: find the lamp\nStep 3/3: switch on the lamp\n")
add("1/3", "a.txt", "1/3 walk to the desk\n2/3 find the lamp\n3/3 switch on the lamp\n")
add("(1/3)", "a.txt", "(1/3) walk to the desk\n(2/3) find the lamp\n(3/3) switch on the lamp\n")
add("Action 1:", "a.txt", "Action 1: Walk[desk]\nAction 2: Find[lamp]\nAction 3: SwitchOn[lamp]\n")
add("Action 1 words", "a.txt", "Action 1: walk to the desk\nAction 2: find the lamp\nAction 3: switch on the lamp\n")
add("Task 1:", "a.txt", "Subtask 1: walk to the desk\nSubtask 2: find the lamp\nSubtask 3: switch on the lamp\n")
add("step_1", "a.txt", "step_1: walk to the desk\nstep_2: find the lamp\nstep_3: switch on the lamp\n")
add("S1", "a.txt", "S1: walk to the desk\nS2: find the lamp\nS3: switch on the lamp\n")
add("[Step 1]", "a.txt", "[Step 1] walk to the desk\n[Step 2] find the lamp\n[Step 3] switch on the lamp\n")
add("<step 1>", "a.txt", "<step 1> walk to the desk\n<step 2> find the lamp\n<step 3> switch on the lamp\n")
add("**Step 1**", "a.md", "**Step 1** walk to the desk\n**Step 2** find the lamp\n**Step 3** switch on the lamp\n")
add("### Step 1", "a.md", "### Step 1\nwalk to the desk\n### Step 2\nfind the lamp\n### Step 3\nswitch on the lamp\n")
add("Step 1 nl", "a.txt", "Step 1\nWalk to the desk\n\nStep 2\nFind the lamp\n\nStep 3\nSwitch on the lamp\n")
add("step: repeated", "a.txt", "step: walk to the desk\nstep: find the lamp\nstep: switch on the lamp\n")
add(
    "action: object:",
    "a.txt",
    "action: walk, object: desk\naction: find, object: lamp\naction: switch on, object: lamp\n",
)
add("action= object=", "a.txt", "action=Walk object=desk\naction=Find object=lamp\naction=SwitchOn object=lamp\n")
add("first second", "a.txt", "First, walk to the desk. Second, find the lamp. Finally, switch on the lamp.\n")
add("first lines", "a.txt", "First, walk to the desk\nNext, find the lamp\nFinally, switch on the lamp\n")
add(
    "ansi",
    "a.log",
    "\x1b[32m1. walk to the desk\x1b[0m\n\x1b[32m2. find the lamp\x1b[0m\n\x1b[1;31m3. switch on the lamp\x1b[0m\n",
)
add(
    "ansi calls",
    "a.log",
    "\x1b[32m>>> Walk(desk)\x1b[0m\n\x1b[32m>>> Find(lamp)\x1b[0m\n\x1b[32m>>> SwitchOn(lamp)\x1b[0m\n",
)
add("tabs indent", "a.txt", "Light\n\twalk to the desk\n\tfind the lamp\n\tswitch on the lamp\n")
add(
    "numbered dict py",
    "a.py",
    'plan = {\n  1: "walk to the desk",\n  2: "find the lamp",\n  3: "switch on the lamp",\n}\n',
)
add("numbered dict json", "a.json", json.dumps({"1": S[0], "2": S[1], "3": S[2]}))
add(
    "dict list py",
    "a.py",
    "steps = [\n  {'action': 'Walk', 'object': 'desk'},\n  {'action': 'Find', 'object': 'lamp'},\n  {'action': 'SwitchOn', 'object': 'lamp'},\n]\n",
)
add(
    "dict lines py",
    "a.txt",
    "{'action': 'Walk', 'object': 'desk'}\n{'action': 'Find', 'object': 'lamp'}\n{'action': 'SwitchOn', 'object': 'lamp'}\n",
)
add(
    "nested steps",
    "a.json",
    json.dumps(
        {
            "task": "Light",
            "plan": {
                "phases": [
                    {"name": "a", "steps": ["walk to the desk", "find the lamp"]},
                    {"name": "b", "steps": ["switch on the lamp"]},
                ]
            },
        }
    ),
)
add("actions calls json", "a.json", json.dumps({"actions": ["walk(desk)", "find(lamp)", "switch_on(lamp)"]}))
add(
    "actions calls json2",
    "a.json",
    json.dumps({"task": "Light", "actions": ["Walk[desk]", "Find[lamp]", "SwitchOn[lamp]"]}),
)
add(
    "actions pairs json",
    "a.json",
    json.dumps({"task": "Light", "actions": ["WALK desk", "FIND lamp", "SWITCHON lamp"]}),
)
add(
    "json verbs",
    "a.json",
    json.dumps(
        {
            "task": "Light",
            "plan": [
                {"verb": "walk to", "noun": "desk"},
                {"verb": "find", "noun": "lamp"},
                {"verb": "switch on", "noun": "lamp"},
            ],
        }
    ),
)
add("json string plan", "a.json", json.dumps({"task": "Light", "plan": "walk(desk); find(lamp); switch_on(lamp)"}))
add(
    "json cmd args",
    "a.json",
    json.dumps(
        {
            "goal": "Light",
            "commands": [
                {"cmd": "walk", "args": ["desk"]},
                {"cmd": "find", "args": ["lamp"]},
                {"cmd": "switch_on", "args": ["lamp"]},
            ],
        }
    ),
)
add(
    "json op",
    "a.json",
    json.dumps(
        [{"op": "walk", "target": "desk"}, {"op": "find", "target": "lamp"}, {"op": "switch_on", "target": "lamp"}]
    ),
)
add(
    "json type params",
    "a.json",
    json.dumps(
        {
            "sequence": [
                {"type": "walk", "params": {"target": "desk"}},
                {"type": "find", "params": {"target": "lamp"}},
                {"type": "switch_on", "params": {"target": "lamp"}},
            ]
        }
    ),
)
add("jsonl string", "a.jsonl", "".join(json.dumps(s) + "\n" for s in S))
add("jsonl step objs", "a.jsonl", "".join(json.dumps({"t": i, "do": s}) + "\n" for i, s in enumerate(S)))
add("json in fence", "a.md", "Here is the plan:\n```json\n" + json.dumps({"plan": S}, indent=1) + "\n```\nEnjoy!\n")
add("json in text", "a.txt", 'Output: {"plan": ["walk to the desk", "find the lamp", "switch on the lamp"]}\n')
add(
    "fence plain",
    "a.md",
    "Sure! This is the plan.\n\n```\nwalk to the desk\nfind the lamp\nswitch on the lamp\n```\n\nPlease take care, as the lamp is hot.\n",
)
add(
    "fence pairs",
    "a.md",
    "Below is the program.\n\n```\nWALK desk\nFIND lamp\nSWITCHON lamp\n```\n\nLet me know if the lamp is broken.\n",
)
add(
    "fence calls",
    "a.md",
    "# Light\nThe function calls:\n```python\nwalk('desk')\nfind('lamp')\nswitch_on('lamp')\n```\n",
)
add("arrow line", "a.txt", "walk to the desk --> find the lamp --> switch on the lamp\n")
add("arrow unicode", "a.txt", "walk to the desk ⇒ find the lamp ⇒ switch on the lamp\n")
add("pipe line", "a.txt", "walk to the desk | find the lamp | switch on the lamp\n")
add("semi line", "a.txt", "walk to the desk; find the lamp; switch on the lamp\n")
add("slash line", "a.txt", "walk to the desk / find the lamp / switch on the lamp\n")
add("plus line", "a.txt", "walk to the desk + find the lamp + switch on the lamp\n")
add("bullet line", "a.txt", "walk to the desk • find the lamp • switch on the lamp\n")
add("dash line", "a.txt", "walk to the desk - find the lamp - switch on the lamp\n")
add("amp line", "a.txt", "walk to the desk & find the lamp & switch on the lamp\n")
add("&& line", "a.sh", "walk desk && find lamp && switchon lamp\n")
add("arrows below", "a.txt", "walk to the desk\n↓\nfind the lamp\n↓\nswitch on the lamp\n")
add("arrows lead", "a.txt", "walk to the desk\n-> find the lamp\n-> switch on the lamp\n")
add("mermaid", "a.mmd", "graph TD\n  A[Walk to the desk] --> B[Find the lamp]\n  B --> C[Switch on the lamp]\n")
add(
    "plantuml", "a.puml", "@startuml\nstart\n:Walk to the desk;\n:Find the lamp;\n:Switch on the lamp;\nstop\n@enduml\n"
)
add(
    "gherkin",
    "a.feature",
    "Feature: Light\n  Scenario: evening\n    Given I walk to the desk\n    When I find the lamp\n    Then I switch on the lamp\n",
)
add("sql-ish", "a.txt", "DO walk(desk)\nDO find(lamp)\nDO switch_on(lamp)\n")
add("brackets args", "a.txt", "Walk[desk]\nFind[lamp]\nSwitchOn[lamp]\n")
add("angle args", "a.txt", "Walk <desk>\nFind <lamp>\nSwitchOn <lamp>\n")
add("braces args", "a.txt", "walk{desk}\nfind{lamp}\nswitch_on{lamp}\n")
add("numbered calls", "a.txt", "1. walk('desk')\n2. find('lamp')\n3. switch_on('lamp')\n")
add("numbered brackets", "a.txt", "1. Walk[desk]\n2. Find[lamp]\n3. SwitchOn[lamp]\n")
add("numbered pairs", "a.txt", "1. WALK desk\n2. FIND lamp\n3. SWITCHON lamp\n")
add("numbered caps things", "a.txt", "1. WALK DESK\n2. FIND LAMP\n3. SWITCHON LAMP\n")
add("caps pairs", "a.txt", "WALK DESK\nFIND LAMP\nSWITCHON LAMP\n")
add("header caps pairs", "a.txt", "Task: light\n\nWALK desk\nFIND lamp\nSWITCHON lamp\n")
add("java", "a.java", 'robot.walk("desk");\nrobot.find("lamp");\nrobot.switchOn("lamp");\n')
add("rust", "a.rs", 'robot.walk("desk")?;\nrobot.find("lamp")?;\nrobot.switch_on("lamp")?;\n')
add("js await", "a.js", "await robot.walk('desk');\nawait robot.find('lamp');\nawait robot.switchOn('lamp');\n")
add(
    "python main",
    "a.py",
    'from robot import *\n\ndef light():\n    walk("desk")\n    find("lamp")\n    switch_on("lamp")\n\nif __name__ == "__main__":\n    light()\n',
)
add(
    "tuple single",
    "a.py",
    'plan = [\n    ("Walk", "desk"),\n    ("Find", "lamp"),\n    ("SwitchOn", "lamp"),\n    ("StandUp",),\n]\n',
    LAMP + ["[StandUp]"],
)
add("numpy list", "a.txt", "['walk to the desk' 'find the lamp' 'switch on the lamp']\n")
add("py list unquoted", "a.txt", "[walk to the desk, find the lamp, switch on the lamp]\n")
add("py list calls", "a.txt", "[walk(desk), find(lamp), switch_on(lamp)]\n")
add("plan = [..]", "a.txt", "plan = ['walk to the desk', 'find the lamp', 'switch on the lamp']\n")
add("plan: [..]", "a.txt", "Plan: ['walk to the desk', 'find the lamp', 'switch on the lamp']\n")
add(
    "say dialog",
    "a.txt",
    "Tom: Please walk to the desk.\nRobot: Done.\nTom: Find the lamp.\nRobot: Here it is.\nTom: Great. Switch on the lamp.\n",
)
add(
    "user robot",
    "a.txt",
    "User: walk to the desk\nSystem: ok\nUser: find the lamp\nSystem: ok\nUser: switch on the lamp\nSystem: ok\n",
)
add("play", "a.txt", "MOTHER. Walk to the desk!\nCHILD. Yes.\nMOTHER. Find the lamp.\nMOTHER. Switch on the lamp.\n")
add("dictation", "a.txt", "um okay walk to the desk\nuh find the lamp\nand er yeah switch on the lamp\n")
add(
    "dictation2",
    "a.txt",
    "so first you walk to the desk and then you know find the lamp and then um switch on the lamp\n",
)
add("comment lines", "a.txt", "# walk to the desk\n# find the lamp\n# switch on the lamp\n")
add("// comments", "a.txt", "// walk to the desk\n// find the lamp\n// switch on the lamp\n")
add("checkbox unicode", "a.txt", "☐ walk to the desk\n☑ find the lamp\n☒ switch on the lamp\n")
add("todo.txt", "todo.txt", "(A) walk to the desk +light\n(B) find the lamp +light\nx 2024-01-01 switch on the lamp\n")
add("done marks", "a.txt", "walk to the desk ... done\nfind the lamp ... done\nswitch on the lamp ... done\n")
add("ticks behind", "a.txt", "1. walk to the desk ✓\n2. find the lamp ✓\n3. switch on the lamp ✗\n")
add("durations", "a.txt", "1. walk to the desk (2 s)\n2. find the lamp (5 s)\n3. switch on the lamp (1 s)\n")
add("score behind", "a.txt", "walk to the desk (0.93)\nfind the lamp (0.87)\nswitch on the lamp (0.99)\n")
add("vtt range", "a.txt", "0:00-0:05 walk to the desk\n0:05-0:10 find the lamp\n0:10-0:12 switch on the lamp\n")
add("secs", "a.txt", "00:01 walk to the desk\n00:05 find the lamp\n00:07 switch on the lamp\n")
add("times dash", "a.txt", "7:00 - walk to the desk\n7:05 - find the lamp\n7:06 - switch on the lamp\n")
add("times at", "a.txt", "at 7:00 walk to the desk\nat 7:05 find the lamp\nat 7:06 switch on the lamp\n")
add("ltl", "a.txt", "walk_to(desk) ∧ find(lamp) ∧ switch_on(lamp)\n")
add("underscore names", "a.txt", "walk_to_desk\nfind_lamp\nswitch_on_lamp\n")
add("kebab", "a.txt", "- walk-to desk\n- find lamp\n- switch-on lamp\n")
add("double quoted lines", "a.txt", '"Walk to the desk"\n"Find the lamp"\n"Switch on the lamp"\n')
add("quoted commas", "a.txt", '"Walk to the desk",\n"Find the lamp",\n"Switch on the lamp"\n')
add("nbsp", "a.txt", "1.\u00a0walk to the desk\n2.\u00a0find the lamp\n3.\u00a0switch on the lamp\n")
add("zero width", "a.txt", "1. walk to the\u200b desk\n2. find the lamp\u200b\n3. \u200bswitch on the lamp\n")
add("bold numbers", "a.md", "**1.** walk to the desk\n**2.** find the lamp\n**3.** switch on the lamp\n")
add("bold all", "a.md", "* **Walk to the desk.**\n* **Find the lamp.**\n* **Switch on the lamp.**\n")
add(
    "bold lead",
    "a.md",
    "1. **Walk:** walk to the desk\n2. **Search:** find the lamp\n3. **Light:** switch on the lamp\n",
)
add(
    "details",
    "a.md",
    "<details>\n<summary>Light</summary>\n\n1. walk to the desk\n2. find the lamp\n3. switch on the lamp\n\n</details>\n",
)
add("answer tags", "a.txt", "<answer>\n1. walk to the desk\n2. find the lamp\n3. switch on the lamp\n</answer>\n")
add("plan tags line", "a.txt", "<plan>walk to the desk; find the lamp; switch on the lamp</plan>\n")
add(
    "think answer",
    "a.txt",
    "<think>\nI open the door first?\n</think>\nwalk to the desk\nfind the lamp\nswitch on the lamp\n",
)
add(
    "final answer",
    "a.txt",
    "Thought: I should get light.\nFinal Answer: 1. walk to the desk 2. find the lamp 3. switch on the lamp\n",
)
add(
    "chatml",
    "a.txt",
    "<|im_start|>user\nMake light<|im_end|>\n<|im_start|>assistant\n1. walk to the desk\n2. find the lamp\n3. switch on the lamp<|im_end|>\n",
)
add("inst", "a.txt", "[INST] Make light [/INST]\n1. walk to the desk\n2. find the lamp\n3. switch on the lamp</s>\n")
add(
    "### response",
    "a.txt",
    "### Instruction:\nMake light\n\n### Response:\nwalk to the desk\nfind the lamp\nswitch on the lamp\n",
)
add(
    "human assistant",
    "a.txt",
    "Human: make light\n\nAssistant: 1. walk to the desk\n2. find the lamp\n3. switch on the lamp\n",
)
add(
    "robot say goal",
    "a.txt",
    "Human: make light\nRobot: 1. walk to the desk, 2. find the lamp, 3. switch on the lamp.\n",
)
add(
    "front matter",
    "a.md",
    "---\ntitle: Light\ndate: 2024-01-01\n---\n\n1. walk to the desk\n2. find the lamp\n3. switch on the lamp\n",
)
add(
    "doc title",
    "a.md",
    "# All my plans\n\n## Light\n1. walk to the desk\n2. find the lamp\n3. switch on the lamp\n\n## Dark\n1. walk to the desk\n2. switch off the lamp\n",
    LAMP + ["[Walk] <desk> (1)", "[SwitchOff] <lamp> (1)"],
)
add("sparql no", "a.txt", "BEGIN\nWALK desk\nFIND lamp\nSWITCHON lamp\nEND\n")
add("assembler", "a.txt", "0x01 WALK desk\n0x02 FIND lamp\n0x03 SWITCHON lamp\n")
add("basic", "a.bas", "10 WALK desk\n20 FIND lamp\n30 SWITCHON lamp\n")
add("numbers no dot", "a.txt", "1 walk to the desk\n2 find the lamp\n3 switch on the lamp\n")
add("01 -", "a.txt", "01 - walk to the desk\n02 - find the lamp\n03 - switch on the lamp\n")
add("1>", "a.txt", "1> walk to the desk\n2> find the lamp\n3> switch on the lamp\n")
add("1|", "a.txt", "1| walk to the desk\n2| find the lamp\n3| switch on the lamp\n")
add("1 =", "a.txt", "1 = walk to the desk\n2 = find the lamp\n3 = switch on the lamp\n")
add("no.1", "a.txt", "No. 1 walk to the desk\nNo. 2 find the lamp\nNo. 3 switch on the lamp\n")
add("1st", "a.txt", "1st: walk to the desk\n2nd: find the lamp\n3rd: switch on the lamp\n")
add("1st,", "a.txt", "1st, walk to the desk\n2nd, find the lamp\n3rd, switch on the lamp\n")
