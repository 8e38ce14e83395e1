"""The table of actions for the documentation, written from the knowledge."""

from collections.abc import Iterator

from hearth.kb.derived_uses import derived_used
from hearth.kb.knowledge import Knowledge
from hearth.kb.knowledge_records import Action


def action_table(knowledge: Knowledge) -> str:
    """Markdown: what each executed action takes, needs (and the failure otherwise) and changes; then the rest."""
    return "\n".join(_lines(knowledge)) + "\n"


def _lines(knowledge: Knowledge) -> Iterator[str]:
    yield "| action | takes | needs, in this order | changes |"
    yield "|---|---|---|---|"
    for action in knowledge.actions.values():
        if action.executed:
            yield f"| {action.name} | {_takes(action)} | {_needs(action)} | {_changes(action)} |"
    yield ""
    yield "Where the words above have a meaning of their own:"
    yield ""
    for head, body in derived_used(knowledge).values():
        yield f"- `{head}` is `{body}`"
    yield ""
    yield "Valid to write, and not executed:"
    yield ""
    for action in knowledge.actions.values():
        if not action.executed:
            yield f"- {action.name}: {_takes(action)}"


def _takes(action: Action) -> str:
    parts = [f"{role} ({need})" for role, need in zip(action.roles, action.grammar, strict=True)]
    return "; ".join(parts) or "nothing"


def _needs(action: Action) -> str:
    checks = [
        f"`{_cell(str(check.formula))}` else {check.code}{f' (option {check.option})' if check.option else ''}"
        for check in action.preconditions
    ]
    return "<br>".join(checks) or "nothing"


def _changes(action: Action) -> str:
    return "<br>".join(f"`{_cell(str(effect))}`" for effect in action.effects) or "nothing"


def _cell(text: str) -> str:
    return text.replace("|", "\\|")
