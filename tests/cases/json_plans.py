"""Plans in JSON, as benchmarks and language models write them."""

from __future__ import annotations

from cases.plans import Plan, lines

TEA = "Walk kettle; SwitchOn kettle"
JSON = (
    Plan(
        "01",
        "a.json",
        '{"WALK":["bedroom"], "WALK":["bed"], "LIE":["bed"], "SLEEP":[]}\n',
        ("Walk bedroom; Walk bed; Lie bed; Sleep",),
    ),
    Plan(
        "01",
        "b.json",
        '{\n  "FIND": ["tooth_paste"],\n  "GRAB": ["tooth_paste"],\n  "POUR": ["tooth_paste", "toothbrush"],\n'
        '  "PUTBACK": ["tooth_paste", "sink"]\n}\n',
        ("Find tooth_paste; Grab tooth_paste; Pour tooth_paste toothbrush; PutBack tooth_paste sink",),
    ),
    Plan(
        "01", "c.json", '{"walk": ["kitchen"], "switchon": ["stove"], "walk": ["sofa"], "sit": "sofa"}\n', (), "1 EMPTY"
    ),
    Plan(
        "09",
        "a.json",
        '{\n\t"title": "Tea",\n\t"steps": [\n\t\t"[Walk] <kettle> (1)",\n\t\t"[SwitchOn] <kettle> (1)"\n\t]\n}\n',
        (TEA,),
    ),
    Plan(
        "09",
        "b.json",
        '\ufeff{\r\n  "title": "Tea",\r\n  "description": "make",\r\n  "steps": ["Walk to the '
        'kettle", "Turn on the kettle"]\r\n}\r\n',
        (TEA,),
    ),
    Plan(
        "09",
        "c.json",
        '\n\n{\n\n    "steps": [{"action": "walk", "object": "kettle"},\n {"action": "switch on", '
        '"object": "kettle"}], "title": "Tea"\n\n}',
        (TEA,),
        titles=("Tea",),
    ),
    Plan(
        "52",
        "a.jsonl",
        lines(
            "{\"identifier\": \"9_1\", \"llm_output\": \"{'WALK': ['kettle'], 'SWITCHON': ['kettle']}\"}",
            '{"identifier": "9_2", "llm_output": "{\\"STANDUP\\": [], \\"WALK\\": [\\"bed\\", \\"105\\"]}"}',
        ),
        (TEA, "StandUp; Walk bed"),
    ),
    Plan(
        "52",
        "b.jsonl",
        lines(
            '{"identifier": "9_3", '
            '"llm_output": "A plan:\\n```json\\n{\\"WALK\\": [\\"kettle\\"], \\"SWITCHON\\": [\\"kettle\\"]}\\n```"}'
        ),
        (TEA,),
    ),
    Plan(
        "52",
        "c.jsonl",
        lines(
            '{"identifier": "9_4", "llm_output": "[{\\"WALK\\": [\\"kettle\\"]}, {\\"SWITCHON\\": [\\"kettle\\"]}]"}'
        ),
        (TEA,),
    ),
    Plan(
        "52b",
        "a.json",
        '{"GRAB": ["cup", "12"], "PUTBACK": ["cup", "12", "table", "40"], "GRAB": ["mug", "13"], '
        '"PUTBACK": ["mug", "13", "table", "40"]}',
        ("Grab cup; PutBack cup table; Grab mug; PutBack mug table",),
    ),
    Plan(
        "52b",
        "b.json",
        '{"WALK": ["sofa", 20], "SIT": ["sofa", 20], "WALK": ["bed", 21], "LIE": ["bed", 21]}',
        ("Walk sofa; Sit sofa; Walk bed; Lie bed",),
    ),
    Plan(
        "52b",
        "c.json",
        '{"WALK": ["light", "245"],\n "SWITCHON": ["light", "245"],\n "FLY": ["lamp", "10"]}',
        ("Walk light; SwitchOn light",),
        "3 UNKNOWN_ACTION",
    ),
    Plan(
        "70",
        "a.json",
        '{"task": "Tea", "plan": [{"step": 1, "action": "Walk", "object": "kettle"}, {"step": 2, '
        '"action": "SwitchOn", "object": "kettle"}]}',
        (TEA,),
    ),
    Plan(
        "70",
        "b.json",
        '{"task": "Tidy", "plan": [{"action": "pick_up", "object": "cup"}, {"action": "put", '
        '"object": "cup", "location": "table"}]}',
        ("Grab cup; PutBack cup table",),
    ),
    Plan(
        "70",
        "c.json",
        '{"goal": "Nap", "actions": [{"name": "walk", "parameters": ["bed"]}, {"name": "lie", "parameters": ["bed"]}]}',
        ("Walk bed; Lie bed",),
    ),
    Plan(
        "70",
        "d.json",
        '{"task": "Milk", "plan": [{"action": "Grab", "object": "milk", "from": "fridge"}, '
        '{"action": "Close", "target": "fridge"}]}',
        ("Grab milk; Close fridge",),
    ),
    Plan(
        "70b",
        "a.json",
        '{"tool_calls": [{"function": {"name": "walk", "arguments": "{\\"target\\": \\"kettle\\"}"}}, '
        '{"function": {"name": "switch_on", "arguments": "{\\"object\\": \\"kettle\\"}"}}]}',
        (TEA,),
    ),
    Plan(
        "70b",
        "b.json",
        '{"role": "assistant", "content": [{"type": "text", "text": "I will make tea."}, '
        '{"type": "tool_use", "id": "t1", "name": "walk", "input": {"object": "kettle"}}, '
        '{"type": "tool_use", "id": "t2", "name": "switch_on", "input": {"object": "kettle"}}]}',
        (TEA,),
    ),
    Plan(
        "70b",
        "c.json",
        '{"output": [{"type": "function_call", "call_id": "c", "name": "walk", '
        '"arguments": "{\\"object\\":\\"kettle\\"}"}, '
        '{"type": "function_call", "call_id": "d", "name": "switch_on", "arguments": "{\\"object\\":\\"kettle\\"}"}]}',
        (TEA,),
    ),
    Plan(
        "77",
        "a.json",
        '{"make tea": "1. walk to kettle\\n2. switch on kettle", "take a nap": "1. walk to bed\\n2. lie on bed"}',
        (TEA, "Walk bed; Lie bed"),
        titles=("make tea", "take a nap"),
    ),
    Plan(
        "77",
        "b.json",
        '{\n  "make tea": [\n    "walk to kettle",\n    "switch on kettle"\n  ]\n}\n',
        (TEA,),
        titles=("make tea",),
    ),
    Plan(
        "77",
        "c.json",
        '{"make tea": "Explanation: easy.\\nPlan: 1. walk to kettle 2. switch on kettle 3. Done", '
        '"read": "Plan: 1. find book 2. read book 3. Done"}',
        (TEA, "Find book; Read book"),
        titles=("make tea", "read"),
    ),
)
