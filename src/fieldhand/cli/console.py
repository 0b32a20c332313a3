"""The terminal, on which hidden characters in all printed text are made visible."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from rich.console import Console
from rich.segment import Segment
from rich.text import Text

from fieldhand.hidden_characters import visible

if TYPE_CHECKING:
    from fieldhand.language import Language

#: Columns of quoted text if the width of the terminal is unknown, and the smallest number used.
_WIDTH, _LEAST_WIDTH = 100, 20
#: Indent of a wrapped line, in columns, and its largest number of rows.
_HANGING, _MOST_ROWS = 4, 40


class Words(Text):
    """Text on one line of the terminal; line ends in it are made visible like other hidden characters."""

    def __init__(self, text: str = "", style: Any = "", **options: Any) -> None:
        super().__init__(visible(text), style, **options)

    def append(self, text: Any, style: Any = None) -> Text:
        return super().append(visible(text) if isinstance(text, str) else text, style)


class Terminal(Console):
    """A console without markup, emoji names and control characters.

    It ignores that its reader has exited (such as a pager), as that must not end a mission.
    """

    def __init__(self, **options: Any) -> None:
        super().__init__(**options, highlight=False, markup=False, emoji=False, soft_wrap=True)
        self._mark: str | None = None

    def on_broken_pipe(self) -> None:
        self.quiet = True
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())

    def render_str(self, text: str, **options: Any) -> Text:
        known = {name: options[name] for name in ("style", "justify", "overflow") if options.get(name) is not None}
        return Words(text, **known)

    def print_lines(self, *lines: str) -> None:
        """Print each text on a line of its own."""
        for line in lines:
            self.print(line)

    @contextmanager
    def behind(self, mark: str = "") -> Iterator[None]:
        """Wrap lines and print a mark before every row, for the duration of the context.

        Quoted text can then not look like a line of this program: with a mark, each of its rows is prefixed; without,
        each wrapped row is indented. If the width of the terminal is unknown, lines without a mark are not wrapped.
        """
        before = self._mark
        self._mark = (before or "") + mark
        try:
            yield
        finally:
            self._mark = before

    def print(self, *objects: Any, **options: Any) -> None:
        if self._mark is None:
            super().print(*objects, **options)
            return
        if not objects:
            super().print(Words(self._mark.rstrip()))
        for text in objects:
            for row in self._rows(text if isinstance(text, Text) else Words(str(text)), self._mark):
                super().print(row, **options)

    def _rows(self, text: Text, mark: str) -> list[Text]:
        """Return the rows of a text after a mark; all but the first are indented."""
        if not mark and not self.is_terminal:
            return [text]
        width = (self.width if self.is_terminal else _WIDTH) - len(mark)
        indent = len(text.plain) - len(text.plain.lstrip(" "))
        hanging = Text(" " * (min(indent, width // 4) + _HANGING))
        rows = list(text.wrap(self, max(width - len(hanging), _LEAST_WIDTH), overflow="fold"))
        left = sum(len(row) for row in rows[_MOST_ROWS:])
        if left:
            rows[_MOST_ROWS:] = [Words(f"... and {left:,} more characters")]
        for row in rows:
            row.rstrip()
        return [Text(mark) + (row if k == 0 else hanging + row) for k, row in enumerate(rows)]

    def _render_buffer(self, buffer: Iterable[Segment]) -> str:
        # Applies to all output, also of other parts of the library.
        return super()._render_buffer(
            segment if segment.control else Segment(visible(segment.text, lines=True), segment.style)
            for segment in buffer
        )


out = Terminal()
err = Terminal(stderr=True)


@contextmanager
def working(what: str, language: Language | None) -> Iterator[None]:
    """Show a progress message on a terminal for the duration of the context.

    Args:
        what: Message.
        language: Language to show it in; None to show nothing.
    """
    if language is None or not err.is_terminal:
        yield
        return
    with err.status(language.say(what)):
        yield
