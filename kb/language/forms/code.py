"""Plans as code: calls such as `walk('kitchen')` and `robot.grab("milk")`, as ProgPrompt writes them."""

import ast
import re
from collections.abc import Sequence

from hearth.kb.language.forms.form import Form, Placed, step, title, written

_DEF = re.compile(r"\s*(?:async\s+)?def\s+(\w+)\s*\(")
_CALL = re.compile(r"\s*(?:await\s+)?(?:\w+\s*=\s*)?((?:\w+\.)*(\w+)\((.*)\))\s*;?\s*(?:#.*|//.*)?$")
_LEFT_OUT = re.compile(
    r"\s*(?:assert\b|else\b|if\b|elif\b|for\b|while\b|try\b|import\b|from\b.*\bimport\b|return\b|pass\b|print\()"
)
_COMMENT = re.compile(r"\s*(?:#|//|`{3}|~{3}|$)")
_LONGEST = 500


def _fits(lines: Sequence[str]) -> bool:
    """Return whether most lines are calls: a text in which some line is nothing that code has is none."""
    code = [line for line in lines if not _COMMENT.match(line)]
    calls = sum(_is_call(line) for line in code)
    return calls > 0 and (any(map(_DEF.match, code)) or calls >= 0.6 * len(code))


def _is_call(line: str) -> bool:
    return len(line) <= _LONGEST and not _LEFT_OUT.match(line) and _CALL.match(line) is not None


def _lines(lines: Sequence[str]) -> list[Placed]:
    found: list[Placed] = []
    for row, raw in enumerate(lines):
        named = _DEF.match(raw)
        if named:
            found.append(title(row, named[1].replace("_", " ")))
        elif not _COMMENT.match(raw) and not _LEFT_OUT.match(raw) and not raw.strip().startswith(('"""', "'''")):
            call = _CALL.match(raw) if len(raw) <= _LONGEST else None
            found.append(step(row, _called(call) if call else raw, len(raw) - len(raw.lstrip())))
    return found


def _called(call: re.Match[str]) -> str:
    """Return the step of a call; its arguments are texts or names, and nothing is run."""
    try:
        parsed = ast.parse(call[1], mode="eval").body
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return call[1]
    if not isinstance(parsed, ast.Call):
        return call[1]
    arguments = [_name(each) for each in (*parsed.args, *(keyword.value for keyword in parsed.keywords))]
    return written(call[2], [each for each in arguments if each]) if None not in arguments else call[1]


def _name(argument: ast.expr) -> str | None:
    """Return the thing that an argument names; None for one that is an expression."""
    if isinstance(argument, ast.Constant) and isinstance(argument.value, str):
        return argument.value
    return argument.id if isinstance(argument, ast.Name) else None


CODE = Form(_fits, _lines, _DEF)
