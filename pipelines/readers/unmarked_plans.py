"""Plans of plain lines, which nothing marks as steps: where one ends and the next begins."""

from collections.abc import Iterator

from hearth.kb.language.plan_lines import META, RULE, PlanLine, is_answer, is_aside, level_of, plan_line
from hearth.kb.language.step_like_lines import chained, is_like_step, is_title
from hearth.kb.language.title_marks import are_titles, is_part
from hearth.schemas.program_boundaries import is_sentence

NumberedLines = list[tuple[int, str]]


def unmarked_blocks(lines: Iterator[tuple[int, str]], most: int = 1_000_000) -> Iterator[tuple[int, list[str]]]:
    """Split a text into its programs: (number of the first line, lines), cut after `most` characters.

    A heading begins a program, unless it is a deeper one above steps; so does the title of a paragraph, once the
    program has steps, or a title and a description.
    """
    block = _Block()
    before: NumberedLines = []
    for part in _parts(lines, most):
        if before and (block.ends_before(before, part) or block.is_titled_as(before)):
            yield block.taken()
        block.add(before)
        before = part
    if before and (block.ends_before(before, []) or block.is_titled_as(before)):
        yield block.taken()
    block.add(before)
    if block.lines:
        yield block.taken()


def _parts(lines: Iterator[tuple[int, str]], most: int) -> Iterator[NumberedLines]:
    """Part a text before each paragraph, heading and rule."""
    part: NumberedLines = []
    size, is_apart = 0, False
    for number, raw in lines:
        is_blank = not raw.strip()
        if part and not is_blank and (is_apart or plan_line(raw).heading or RULE.match(raw)):
            yield part
            part, size = [], 0
        is_apart = is_blank or (is_apart and not part)
        part += [(number, raw)] if size <= most else []
        size += len(raw) + 1
        is_apart = is_blank
    if part:
        yield part


class _Block:
    """The parts of a program so far."""

    def __init__(self) -> None:
        self.lines: NumberedLines = []
        self._has_steps = self._has_title = self._has_description = self._has_colon = False
        self._level = 0

    def add(self, part: NumberedLines) -> None:
        """Add a part, without the blank lines above the first."""
        read = [plan_line(raw) for _, raw in part]
        texts = [line for line in read if line.text]
        if self.lines or texts:
            self.lines += part
        for (_, raw), line in zip(part, read, strict=True):
            if line.heading and not is_aside(line.text):
                self._level = self._level or level_of(raw)
        plain = [line.text for line in texts if not line.heading and not META.match(line.text)]
        named = [line for line in texts if line.heading]
        steps = [text for text in plain if is_like_step(text) or chained(text)]
        is_name = len(plain) == 1 and not named and not is_sentence(plain[0]) and not chained(plain[0])
        is_top = not (self._has_steps or self._has_title or self._has_description)
        self._has_colon = self._has_colon or bool(is_top and plain and plain[0].endswith(":") and not is_part(plain[0]))
        self._has_steps = self._has_steps or bool(steps and not (is_name and not self._has_title))
        self._has_description = self._has_description or bool(plain and not steps and not is_name)
        self._has_title = self._has_title or bool(named) or is_name

    def ends_before(self, part: NumberedLines, below: NumberedLines) -> bool:
        """Return whether a part begins the next program."""
        if not any(raw.strip() for _, raw in self.lines):
            return False
        first = plan_line(part[0][1])
        if RULE.match(part[0][1]):
            return self._has_steps or (self._has_title and self._has_description)
        if first.heading:
            return self._ends_before_heading(first, part[0][1])
        plain = [line.text for _, raw in part if (line := plan_line(raw)).text]
        if (
            not plain
            or (is_sentence(plain[0]) and not self._is_titled_alike(plain[0]))
            or META.match(plain[0])
            or is_aside(plain[0])
        ):
            return False
        is_apart = len(plain) == 1
        following = plain[1:] or [line.text for _, raw in below if (line := plan_line(raw)).text and not line.heading]
        if not is_title(plain[0], following, is_apart):
            return False
        return self._has_steps or (self._has_title and self._has_description and is_apart)

    def is_titled_as(self, part: NumberedLines) -> bool:
        """Return whether this program and a part begin with titles that only stand above steps; `Task:` marks both."""
        top = next((n for n, (_, raw) in enumerate(self.lines) if raw.strip()), len(self.lines))
        end = next((n for n, (_, raw) in enumerate(self.lines) if n > top and not raw.strip()), len(self.lines))
        if not are_titles(_plain_texts(self.lines[top:end]), _plain_texts(part)):
            return False
        self.lines[top], part[0] = _as_task(self.lines[top]), _as_task(part[0])
        return True

    def _is_titled_alike(self, text: str) -> bool:
        """Return whether a line with a colon is a title, as the first line of the program is one with a colon."""
        return text.endswith(":") and self._has_colon and not is_part(text)

    def _ends_before_heading(self, line: PlanLine, raw: str) -> bool:
        if is_aside(line.text) or is_answer(line):
            return False
        if self._has_steps or not self._level:
            return self._has_steps
        return level_of(raw) <= self._level and not _is_label(line)

    def taken(self) -> tuple[int, list[str]]:
        """Return the program, and begin the next."""
        first, lines = self.lines[0][0], [raw for _, raw in self.lines]
        self.__init__()  # type: ignore[misc]
        return first, lines


def _is_label(line: PlanLine) -> bool:
    return line.text.lower().startswith("plan")


def _plain_texts(part: NumberedLines) -> list[str]:
    return [line.text for _, raw in part if (line := plan_line(raw)).text]


def _as_task(line: tuple[int, str]) -> tuple[int, str]:
    """Return a line marked as a title, which a reader of this program alone would take for a step."""
    number, raw = line
    return (number, raw) if plan_line(raw).heading else (number, f"Task: {raw.strip()}")
