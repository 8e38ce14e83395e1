"""Records as the interfaces of language models write them: chats, batches of answers, calls of tools; bare mappings."""

from typing import Any

from hearth.pipelines.readers.actions import is_action, is_mapping, steps_of_mapping


def of_others(value: dict[str, Any]) -> dict[str, Any] | None:
    """An object of such a form as a record of ours, with the texts that it holds; None for any other object."""
    if is_mapping(value):
        return {"steps": steps_of_mapping(value)}
    answered = _in_batch(value)
    if answered is not None:
        own = value.get("custom_id")
        return {**_answer(answered), **({"id": own} if isinstance(own, str) else {})}
    if _is_chat(value.get("messages")):
        return _chat(value["messages"])
    if _are_calls(value.get("tool_calls")):
        return _answer(value)
    if "title" not in value and is_action(value) and ("function" in value or "object" in value):
        return {"steps": [value]}
    return None


def _chat(messages: list[dict[str, Any]]) -> dict[str, Any]:
    """The last answer of a chat, with the request before it as title."""
    last = max((at for at, each in enumerate(messages) if each["role"] == "assistant"), default=None)
    asked = [each.get("content") for each in messages[:last] if each["role"] == "user"]
    title = asked[-1] if asked and isinstance(asked[-1], str) else ""
    answer = _answer(messages[last]) if last is not None else {}
    first, _, rest = title.strip().partition("\n")
    return {"title": first[:200], **({"description": rest.strip()} if rest.strip() else {}), **answer}


def _answer(message: dict[str, Any]) -> dict[str, Any]:
    """The program of a message: its calls of tools, else its content."""
    if _are_calls(message.get("tool_calls")):
        return {"steps": message["tool_calls"]}
    content = message.get("content")
    if isinstance(content, list):
        parts = [part["text"] for part in content if isinstance(part, dict) and isinstance(part.get("text"), str)]
        content = parts[0] if parts else None
    return {"program": content} if isinstance(content, str) and content.strip() else {}


def _is_chat(value: Any) -> bool:
    return (
        isinstance(value, list)
        and bool(value)
        and all(isinstance(each, dict) and isinstance(each.get("role"), str) for each in value)
    )


def _are_calls(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and all(map(is_action, value))


def _in_batch(value: dict[str, Any]) -> dict[str, Any] | None:
    """The message of the first choice in an answer, or in a line of a batch's output."""
    found: Any = value
    for key in ("response", "body"):
        found = found[key] if isinstance(found, dict) and key in found and "choices" not in found else found
    choices = found.get("choices") if isinstance(found, dict) else None
    if not isinstance(choices, list) or not choices or not isinstance(choices[0], dict):
        return None
    message = choices[0].get("message")
    return message if isinstance(message, dict) else None
