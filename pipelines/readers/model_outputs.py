"""Records as the interfaces of language models write them: chats, batches of answers, calls of tools; bare mappings."""

from typing import Any

from hearth.kb.language.forms.order_dialogues import orders_in
from hearth.kb.language.program_lines import is_plan
from hearth.pipelines.readers.chat_titles_from_requests import accepts, rejects, titled
from hearth.pipelines.readers.json_actions import is_action, is_mapping, steps_of_mapping
from hearth.pipelines.readers.reader_warnings import warned
from hearth.pipelines.readers.texts_with_positions import Text


def of_others(value: dict[str, Any]) -> dict[str, Any] | None:
    """Return an object of such a form as a record of ours, with the texts that it holds; None for any other object."""
    if is_mapping(value):
        return {"steps": steps_of_mapping(value)}
    answered = _in_batch(value)
    if answered is not None:
        own = value.get("custom_id")
        return {**_answer(answered), **({"id": own} if isinstance(own, str) else {})}
    if isinstance(value.get("content"), list) and _used(value["content"]):
        return _answer(value)
    chat = chat_of(value)
    if chat:
        return _chat(_messages(value[chat]))
    if _are_calls(value.get("tool_calls")):
        return _answer(value)
    if "title" not in value and is_action(value) and ("function" in value or "object" in value):
        return {"steps": [value]}
    return None


def chat_of(value: dict[str, Any]) -> str:
    """Return the key of a record that holds the messages of a chat; empty where none does."""
    return next((key for key in _CHATS if _messages(value.get(key))), "")


def _chat(messages: list[dict[str, Any]]) -> dict[str, Any]:
    """Return the last answer of a chat, with the request that it answers as title."""
    if ordered := _ordered(messages):
        return {"steps": ordered}
    last = _last_answer(messages)
    asked = [_said(each.get("content")) for each in messages[:last] if each["role"] == "user"]
    answer = _answer(messages[last]) if last is not None else {}
    found = {**titled(asked if answer else asked[-1:]), **answer}
    return warned(found, _unanswered(messages[last:])) if answer else found


def _unanswered(messages: list[dict[str, Any]]) -> list[tuple[int, str, str]]:
    """Return a warning for the request that corrects the last answer, and has no answer."""
    asked = [each.get("content") for each in messages if each["role"] == "user"]
    text = next((text for text in asked if rejects(_said(text))), None)
    if text is None:
        return []
    line = text.line if isinstance(text, Text) else 0
    message = f"`{_said(text).strip()[:60]}` corrects the answer above and has no answer: the steps are those above"
    return [(line, message, "add the corrected answer, or leave the chat out")]


def _last_answer(messages: list[dict[str, Any]]) -> int | None:
    """Return the index of the last answer of a chat; one that only answers thanks counts where nothing else is said."""
    answers = [at for at, each in enumerate(messages) if each["role"] == "assistant"]
    plans = [at for at in answers if not _answers_thanks(messages, at)]
    return max(plans or answers, default=None)


def _answers_thanks(messages: list[dict[str, Any]], at: int) -> bool:
    """Return whether a message without a plan answers one that takes the plan before it as it is."""
    before = [_said(each.get("content")) for each in messages[:at] if each["role"] == "user"]
    is_answer = len(before) > 1 and accepts(before[-1]) and not _are_calls(messages[at].get("tool_calls"))
    return is_answer and not is_plan(_said(messages[at].get("content")).split("\n"))


def holds_orders(messages: list[dict[str, Any]]) -> bool:
    """Return whether the steps of a chat are the orders that one gives in it."""
    return bool(_ordered(messages))


def _ordered(messages: list[dict[str, Any]]) -> list[str]:
    """Return the orders that one gives in a chat whose answers hold no plan."""
    said = [(each["role"], _said(each.get("content"))) for each in messages]
    if any(each.get("tool_calls") for each in messages) or any(is_plan(text.split("\n")) for _, text in said):
        return []
    at = orders_in([f"{role}: {text}" for role, text in said])
    return [said[row][1] for row in at]


def _answer(message: dict[str, Any]) -> dict[str, Any]:
    """Return the program of a message: its calls of tools, else its content."""
    if _are_calls(message.get("tool_calls")):
        return {"steps": message["tool_calls"]}
    content = message.get("content")
    if isinstance(content, list) and (used := _used(content)):
        return {"steps": used}
    said = _said(content)
    return {"program": said} if said.strip() else {}


def _said(content: Any) -> str:
    """Return the text of a message, or of the first of its parts that has one."""
    if isinstance(content, list):
        parts = [part["text"] for part in content if isinstance(part, dict) and isinstance(part.get("text"), str)]
        content = parts[0] if parts else None
    return content if isinstance(content, str) else ""


def _used(content: list[Any]) -> list[dict[str, Any]]:
    """Return the calls of tools among the parts of a message."""
    parts = [part for part in content if isinstance(part, dict) and part.get("type") == "tool_use"]
    return [{"action": part["name"], "args": part.get("input")} for part in parts if isinstance(part.get("name"), str)]


_CHATS = ("messages", "conversations", "conversation", "contents", "dialogue", "dialog", "chat")
"""Keys of the messages of a chat."""


def is_message(value: Any) -> bool:
    """Return whether a value is one message of a chat, with its speaker and a text."""
    if not isinstance(value, dict) or len(value) > _MOST_KEYS or not _messages([value]):
        return False
    return any(isinstance(value.get(key), str) for key in _CONTENTS)


_MOST_KEYS = 5
_SPEAKERS = ("role", "from", "speaker", "sender", "author")
_ROLES = {"human": "user", "gpt": "assistant", "model": "assistant", "bot": "assistant", "chatgpt": "assistant"}
_CONTENTS = ("content", "value", "parts", "text", "message", "utterance")


def _messages(value: Any) -> list[dict[str, Any]]:
    """Return the messages of a chat, with `role` and `content` for `from` and `value` of others.

    The result is empty for other values.
    """
    if not isinstance(value, list) or not value:
        return []
    found = []
    for each in value:
        role = next((each[key] for key in _SPEAKERS if each.get(key)), None) if isinstance(each, dict) else None
        if not isinstance(role, str):
            return []
        content = next((each[key] for key in _CONTENTS if key in each), None)
        found.append({**each, "role": _ROLES.get(role.lower(), role.lower()), "content": content})
    return found


def _are_calls(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and all(map(is_action, value))


def _in_batch(value: dict[str, Any]) -> dict[str, Any] | None:
    """Return the message of the first choice in an answer, or in a line of a batch's output."""
    found: Any = value
    for key in ("response", "body"):
        found = found[key] if isinstance(found, dict) and key in found and "choices" not in found else found
    choices = found.get("choices") if isinstance(found, dict) else None
    if not isinstance(choices, list) or not choices or not isinstance(choices[0], dict):
        return None
    message = choices[0].get("message")
    return message if isinstance(message, dict) else None
