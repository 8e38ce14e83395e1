"""Plans as code: calls such as `walk('kitchen')` and `robot.grab("milk")`, as ProgPrompt writes them."""

import ast
import re
from collections.abc import Iterator, Sequence
from types import MappingProxyType

from hearth.kb.language.action_keys import names_action
from hearth.kb.language.forms.code_functions import Functions, plan_of
from hearth.kb.language.forms.control_flow import CodeLine, ThingNames, in_order
from hearth.kb.language.forms.form import Form, Placed, note, refused, step, title
from hearth.kb.language.refusals import Refusal
from hearth.kb.language.steps_from_calls import composed_step

_DEF = re.compile(r"\s*(?:async\s+)?def\s+(\w+)\s*\(")
_CALL = re.compile(r"\s*(?:await\s+)?(?:\w+\s*=\s*)?((?:\w+\.)*(\w+)\((.*)\))\s*[;,]?\s*(?:#.*|//.*)?$")
_LEFT_OUT = re.compile(
    r"\s*(?:(?:assert|else|if|elif|for|while|try|except|import|return|pass|class|with)\b|from\b.*\bimport\b|print\(|\"{3}|'{3})"
)
_FRAME = re.compile(r"\s*(?:from\b.*\bimport\b|import\b|[\])}]\s*[,;]?\s*$|\w+\s*=\s*[\[(]\s*$)")
"""A line of code around the calls: an import, or the begin or end of a list."""

_MADE_TRUE = re.compile(r"\s*else\s*:(?!\s*find\b)\s*(\S.*)")
"""ProgPrompt's act where a state lacks, `else: open('fridge')`; finding a thing again is left out."""

_HEAD = re.compile(r"\s*(?:for|while|if|elif|else|try|except|with)\b[^:]*:\s*(?:#.*)?")
"""A line that holds others, and is none of a text in words."""

_COMMENT = re.compile(r"\s*(?:#|//|`{3}|~{3}|$)")
_LONGEST = 500


def _fits(lines: Sequence[str]) -> bool:
    """Return whether most lines are calls: a text in which some line is nothing that code has is none."""
    code = [x for x in lines if not _COMMENT.match(x) and not _HEAD.fullmatch(x) and not _FRAME.match(x)]
    calls = sum(_is_call(line) for line in code)
    return any(map(_DEF.match, code)) or (calls > 0 and calls >= 0.6 * len(code))


def _is_call(line: str) -> bool:
    return len(line) <= _LONGEST and not _LEFT_OUT.match(line) and _CALL.match(line) is not None


def _lines(lines: Sequence[str]) -> list[Placed]:
    plan = plan_of(lines)
    return [placed for line in in_order(plan.lines) for placed in _placed(line, plan)]


def _placed(line: CodeLine, plan: Functions) -> Iterator[Placed]:
    """Yield the steps, the title, or the note of a line."""
    row, raw = line.row, line.text
    why = line.why or plan.why(raw, row)
    if why:
        yield refused(row, raw, why)
    elif named := _DEF.match(raw):
        if named[1] not in plan.called:
            yield title(row, named[1].replace("_", " "))
    elif not _COMMENT.match(raw) and not _FRAME.match(raw):
        made_true, returned = _MADE_TRUE.match(raw), _RETURNED.fullmatch(raw)
        own = made_true or returned
        words = own[1] if own else raw
        call = _CALL.match(words) if len(raw) <= _LONGEST else None
        is_step = own is not None or not _LEFT_OUT.match(raw)
        several = calls_of(words.strip()) if is_step and call and not line.names else []
        if len(several) > 1:
            yield from (step(row, each) for each in several)
        elif call and is_step and (variable := _unknown(call[1], line.names)):
            yield refused(row, raw, Refusal(_COMPUTED.format(variable), "name the thing itself, as in grab('cup')"))
        else:
            yield step(row, called(call[1], line.names) if call else words) if is_step else note(row, raw)


_RETURNED = re.compile(r"\s*return\s+((?:\w+\.)*\w+\(.*\)\s*)")
_COMPUTED = "which thing `{}` stands for is known only while the code runs"


def _unknown(call: str, names: ThingNames) -> str:
    """Return the argument of a call that is known only when the code runs."""
    try:
        parsed = ast.parse(call, mode="eval").body
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return ""
    if not isinstance(parsed, ast.Call):
        return ""
    for each in (*parsed.args, *(keyword.value for keyword in parsed.keywords)):
        if isinstance(each, ast.Name) and each.id in names and names[each.id] is None:
            return each.id
        if isinstance(each, ast.JoinedStr | ast.IfExp | ast.ListComp | ast.GeneratorExp):
            return ast.unparse(each)[:60]
    return ""


_CALLS = re.compile(r"[A-Za-z_]\w*\([^()]*\)(?:\s*[,;]\s*[A-Za-z_]\w*\([^()]*\))*[.;]?")
_ONE = re.compile(r"\w+\([^()]*\)")


def calls_of(text: str) -> list[str]:
    """Return the steps of a line that is calls alone, `walk(kitchen), grab(milk)`; none where it is not."""
    return list(map(called, _ONE.findall(text))) if _CALLS.fullmatch(text) else []


def called(call: str, names: ThingNames = MappingProxyType({})) -> str:
    """Return the step of a call; its arguments are texts or names, and nothing is run.

    Args:
        call: as the code has it.
        names: the things that variables stand for.
    """
    try:
        parsed = ast.parse(call, mode="eval").body
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return _called_with_words(call)
    if not isinstance(parsed, ast.Call):
        return call
    name = parsed.func.attr if isinstance(parsed.func, ast.Attribute) else getattr(parsed.func, "id", "")
    keywords = list(parsed.keywords)
    if keywords and not parsed.args and keywords[0].arg in _ACTS:  # `execute(action="grab", obj="cup")`
        name = _name(keywords.pop(0).value, names) or ""
    arguments = [_name(each, names) for each in (*parsed.args, *(keyword.value for keyword in keywords))]
    relation = (keywords[-1].arg or "") if keywords else ""
    objects = [each for each in arguments if each]
    if name.lower() in _MAKES and len(objects) == len(arguments) > 0 and names_action(objects[0], objects[1:]):
        return composed_step(objects[0], objects[1:], relation)
    if name.lower() in _EXECUTES and len(arguments) == 1 and objects and not keywords:
        if "(" in objects[0]:
            return called(objects[0], names)
        if " " in objects[0].strip():
            return objects[0]
    return composed_step(name, objects, relation) if name and None not in arguments else call


_ACTS = frozenset(("action", "act", "verb", "skill", "command", "primitive"))
"""Keywords of calls that hold the name of the action, where the function only executes it."""

_MAKES = frozenset(("step", "action", "act", "do", "execute", "instruction", "command"))
"""Functions and classes of a step whose first argument is its action: `Step(Walk, "kitchen")`."""

_EXECUTES = frozenset(("run", "do", "execute", "exec", "perform", "step", "act"))
"""Functions that execute a step given as a text: `robot.execute("walk to the bedroom")`."""

_WITH_WORDS = re.compile(r"(?:\w+\.)*(\w+)\(\s*([A-Za-z][\w '-]*(?:,\s*[A-Za-z][\w '-]*)*)\)")


def _called_with_words(call: str) -> str:
    """Return the step of a call that is not Python, as its things have several words: `Walk(living room)`."""
    found = _WITH_WORDS.fullmatch(call)
    return composed_step(found[1], [each.strip() for each in found[2].split(",")]) if found else call


def _name(argument: ast.expr, names: ThingNames) -> str | None:
    """Return the thing that an argument names; None for one that is an expression."""
    if isinstance(argument, ast.Constant) and isinstance(argument.value, str):
        return argument.value
    return (names.get(argument.id) or argument.id) if isinstance(argument, ast.Name) else None


CODE = Form(_fits, _lines, _is_call, re.compile(r"\s*(?:async\s+)?def\s"))
