"""Agreement of inferred preconditions with those of the release's rules, over a source (thesis 5.5.2)."""

from collections import Counter, defaultdict
from collections.abc import Iterable
from typing import Any

from hearth.analysis.programs_in_homes import Script
from hearth.grounding.preconditions.precondition_inference import infer
from hearth.grounding.preconditions.release_rules import by_rules, compare
from hearth.kb.knowledge import Knowledge
from hearth.schemas.failures import Failure
from hearth.storage.rejects import Reject


def agreement(programs: Iterable[Script | Reject], knowledge: Knowledge) -> dict[str, Any]:
    """Counts of the rules' conditions by name and agreement, and of inferred conditions that the rules lack.

    Returns:
        `programs`, `impossible` (programs without a satisfying start), and `conditions`: by name the rules' count,
        the numbers of those that are inferred, not needed, or refused because the program would stop; and the numbers
        of inferred conditions that the rules lack, required ones and defaults.
    """
    counts: dict[str, Counter[str]] = defaultdict(Counter)
    read = impossible = 0
    for script in programs:
        if isinstance(script, Reject):
            continue
        read += 1
        ours = infer(script.program, knowledge)
        if isinstance(ours, Failure):
            impossible += 1
            continue
        for one in compare(script.program, ours, knowledge):
            counts[one.condition.name]["ours" if one.ours else one.why.partition(":")[0]] += 1
        theirs = {condition.literal for condition in by_rules(script.program, knowledge)}
        for condition in ours:
            if condition.literal not in theirs:
                counts[condition.name]["missed, needed" if condition.hard else "missed, usual"] += 1
    kinds = ("ours", "not needed", "refused", "missed, needed", "missed, usual")
    rows = [{"condition": name, "by_rules": sum(found[kind] for kind in kinds[:3]),
             **{kind: found[kind] for kind in kinds}} for name, found in sorted(counts.items())]  # fmt: skip
    return {"programs": read, "impossible": impossible, "conditions": rows}
