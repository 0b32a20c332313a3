"""Text panel beside a map: the request, the steps of the read-back, the legend, and the totals."""

from __future__ import annotations

import re
import textwrap
from functools import partial
from typing import TYPE_CHECKING

from fieldhand.approval.marks import HEADING, HEADING_PT, LINES
from fieldhand.approval.readback import ReadBack, say_totals
from fieldhand.approval.stops import Certainty, DrawnPlan
from fieldhand.language import Language, message
from fieldhand.language.words import capitalised, say_action
from fieldhand.site.drawing.colours import INK, PATH
from fieldhand.task.frames import Task
from fieldhand.wording.steps import ReadBackLine

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

_LINE_WORDS: dict[Certainty, str] = {
    "certain": message("driven in any case"),
    "budget": message("driven as far as the budget allows"),
    "conditional": message("driven only on some readings"),
}
_QUIET = "#6b6b6b"
#: Characters per inch at a font size of one point; line spacing as a multiple of the font size.
_LETTERS, _LEADING = 122.0, 1.42
_STEP_PT, _REQUEST_PT, _SMALL_PT = 9.0, 11.5, 8.5
_INDENT, _REQUEST_ROWS = 3, 9
#: Font scales, largest first; the first at which all text fits is used.
_SCALES = (1.25, 1.15, 1.05, 0.95, 0.85)
#: Pattern of a number with its unit, which are kept on one row.
_UNIT = re.compile(r"(\d) (m|min|h|s|%|°C|ppm)(?!\w)")


def draw_panel(
    ax: Axes, task: Task, plan: DrawnPlan, words: ReadBack, colours: dict[str, str], language: Language
) -> float:
    """Write the text from top to bottom; steps that do not fit are counted, while legend and totals always appear.

    Returns:
        Free height at the bottom, in points.
    """
    legend, totals = _legend(plan, colours, language), language.read(say_totals(words.totals))
    request = " ".join(task.command.request.split())
    writer = next(
        (w for w in map(partial(_PanelWriter, ax), _SCALES) if _fits(w, request, words, totals, len(legend))), None
    )
    writer = writer or _PanelWriter(ax, _SCALES[-1])
    for line in writer.wrapped(f"“{request}”", _REQUEST_PT, most=_REQUEST_ROWS):
        writer.write(line, _REQUEST_PT, style="italic")
    writer.skip(9)
    _write_steps(writer, words.lines, writer.left - _below(writer, totals, len(legend)), language)
    writer.skip(6)
    box = ax.legend(
        handles=legend,
        loc="upper left",
        bbox_to_anchor=(0.0, writer.share),
        frameon=False,
        fontsize=_SMALL_PT * writer.scale,
        labelcolor=INK,
        borderpad=0,
        borderaxespad=0,
        handlelength=2.2,
        labelspacing=0.55,
    )
    box.set_gid("legend")
    writer.skip(_legend_points(len(legend)))
    for text in totals:
        for line in writer.wrapped(text, _SMALL_PT):
            writer.write(line, _SMALL_PT, colour=_QUIET)
    return writer.left


def _legend_points(entries: int) -> float:
    return (entries * 1.55 + 0.8) * _SMALL_PT


def _below(writer: _PanelWriter, totals: tuple[str, ...], entries: int) -> float:
    """Return the height of legend and totals, in points."""
    rows = sum(len(writer.wrapped(text, _SMALL_PT)) for text in totals)
    return (_legend_points(entries) + 6 + (rows + 0.5) * _LEADING * _SMALL_PT) * writer.scale


def _rows(writer: _PanelWriter, line: ReadBackLine) -> list[str]:
    """Return a step with its number as rows, with a hanging indent."""
    number = f"{line.number}. " if line.number is not None else ""
    margin = " " * (_INDENT * line.indent)
    return writer.wrapped(f"{number}{line.text}", _STEP_PT, margin=margin, hang=" " * (len(number) + 1))


def _fits(writer: _PanelWriter, request: str, words: ReadBack, totals: tuple[str, ...], entries: int) -> bool:
    """Return True if all text fits at the writer's scale."""
    asked = len(writer.wrapped(f"“{request}”", _REQUEST_PT))
    head = asked * _REQUEST_PT * _LEADING + 9
    rows = sum(len(_rows(writer, line)) for line in words.lines)
    steps = rows * _STEP_PT * _LEADING + 1.5 * len(words.lines)
    return asked <= _REQUEST_ROWS and (head + steps) * writer.scale + _below(writer, totals, entries) < writer.left


def _write_steps(writer: _PanelWriter, lines: tuple[ReadBackLine, ...], room: float, language: Language) -> None:
    """Write the steps that fit; the read-back lists them all."""
    bottom = writer.left - room
    for k, line in enumerate(lines):
        rows = _rows(writer, line)
        needed = (len(rows) + (1 if k + 1 < len(lines) else 0)) * _STEP_PT * _LEADING * writer.scale
        if writer.left - needed < bottom:
            more = message("… and {count} more lines in the read-back", count=len(lines) - k)
            writer.write(language.say(more), _STEP_PT, colour=_QUIET)
            return
        for row in rows:
            writer.write(row, _STEP_PT)
        writer.skip(1.5)


class _PanelWriter:
    """Writes lines of text from the top of an axes downwards, measured in points.

    Args:
        ax: Axes to write on.
        scale: Factor applied to all font sizes and gaps.
    """

    def __init__(self, ax: Axes, scale: float) -> None:
        figure = ax.get_figure(root=True)
        width, height = figure.get_size_inches() if figure is not None else (5.0, 8.0)
        box = ax.get_position()
        ax.set_axis_off()
        self._ax = ax
        self.scale = scale
        self._width = float(width * box.width)
        self._height = float(height * box.height) * 72.0
        #: Height left above the lower edge, in points.
        self.left = self._height

    @property
    def share(self) -> float:
        """Return the vertical position of the next line, as a fraction of the axes height."""
        return self.left / self._height

    def wrapped(
        self, text: str, size: float, *, margin: str = "", hang: str = "", most: int | None = None
    ) -> list[str]:
        """Return the text wrapped to the width of the panel."""
        return textwrap.wrap(
            _UNIT.sub("\\1\N{NO-BREAK SPACE}\\2", text),
            width=max(20, int(self._width * _LETTERS / (size * self.scale))),
            initial_indent=margin,
            subsequent_indent=margin + hang,
            max_lines=most,
            placeholder=" …”",
        )

    def write(self, text: str, size: float, *, colour: str = INK, style: str = "normal") -> None:
        """Write one row, with dollar signs escaped so that they do not start math mode."""
        self._ax.text(
            0.0,
            self.share,
            text,
            fontsize=size * self.scale,
            color=colour,
            fontstyle=style,
            va="top",
            transform=self._ax.transAxes,
            parse_math=False,
        )
        self.skip(size * _LEADING)

    def skip(self, points: float) -> None:
        """Leave vertical space."""
        self.left -= points * self.scale


def _legend(plan: DrawnPlan, colours: dict[str, str], language: Language) -> list[Artist]:
    from matplotlib.lines import Line2D

    def disc(colour: str, edge: str, label: str) -> Artist:
        return Line2D(
            [],
            [],
            marker="o",
            linestyle="none",
            markersize=8,
            color=colour,
            markeredgecolor=edge,
            label=language.say(label),
        )

    found = [disc(colour, "white", capitalised(say_action(name))) for name, colour in colours.items()]
    if any("conditional" in stop.actions.values() for stop in plan.stops):
        found.append(disc("white", INK, message("Hollow: only if a condition holds")))
    if any(stop.heading_deg is not None for stop in plan.stops):
        label = language.say(message("Heading of the robot at a picture"))
        found.append(
            Line2D(
                [],
                [],
                marker="^",
                linestyle="none",
                markersize=HEADING_PT,
                color=HEADING,
                markeredgecolor=PATH,
                label=label,
            )
        )
    for certainty in LINES:
        if any(leg.certainty == certainty for leg in plan.legs):
            style, width, alpha = LINES[certainty]
            label = language.say(capitalised(_LINE_WORDS[certainty]))
            found.append(Line2D([], [], color=PATH, linestyle=style, linewidth=width, alpha=alpha, label=label))
    return found
