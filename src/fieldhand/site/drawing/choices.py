"""Draw the picture of a question: the places of each choice, marked with its number."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from fieldhand.site.choices import choice_marks
from fieldhand.site.drawing import colours
from fieldhand.site.drawing.ground import draw_dots, draw_site, site_figure, tree_size
from fieldhand.site.drawing.names import name_site
from fieldhand.site.drawing.saving import make_text_visible, save_figure
from fieldhand.site.model import Place, Site

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

#: Diameter in points of a disc with a number, and the increase for each further character.
_DISC, _WIDER = 13.0, 2.4
#: Letters per inch of the question and of the choices below it.
_LETTERS_IN = 12.0


def save_choices_picture(
    site: Site, question: str, choices: Sequence[str], places: Sequence[Sequence[Place]], path: Path
) -> None:
    """Draw a question into a picture file; the extension selects the format (``.png``, ``.svg``, ``.pdf``).

    Args:
        site: Site of the places.
        question: Text above the map.
        choices: Answers, listed below the map with their numbers from 1.
        places: Places of each choice; empty if unknown.
        path: File to write.

    Raises:
        OutputError: The file cannot be written, or its extension is not that of a picture format.
    """
    figure = choices_picture(site, question, choices, places)
    save_figure(figure, path)


def choices_picture(site: Site, question: str, choices: Sequence[str], places: Sequence[Sequence[Place]]) -> Figure:
    """Return the picture as a figure without a window."""
    figure = site_figure(site)
    ax = figure.axes[0]
    draw_site(ax, site)
    _mark(ax, site, places)
    _write(figure, question, choices, places)
    make_text_visible(figure)
    figure.draw_without_rendering()  # so that the layout accounts for the texts
    figure.set_layout_engine("none")
    name_site(ax, site)
    return figure


def colour_of(number: int) -> str:
    """Return the colour of a choice by its number, counted from 1."""
    return colours.CHOICES[(number - 1) % len(colours.CHOICES)]


def _mark(ax: Axes, site: Site, places: Sequence[Sequence[Place]]) -> None:
    """Draw a disc for each place, larger if the numbers of its choices are written in it."""
    marks = choice_marks(places)
    dot = max(math.sqrt(tree_size(ax, site)) * 1.3, 5.0) ** 2
    for number in dict.fromkeys(mark.numbers[0] for mark in marks):
        xy = np.array([m.place.xy for m in marks if m.numbers[0] == number])
        draw_dots(ax, xy, dot, colour_of(number), zorder=10)
    for mark in marks:
        if not mark.labelled:
            continue
        words = ", ".join(str(number) for number in sorted(mark.numbers))
        ax.plot(
            *mark.place.xy, marker="o", markersize=_DISC + _WIDER * (len(words) - 1), markeredgewidth=1.0,
            color=colour_of(mark.numbers[0]), markeredgecolor="white", zorder=12, gid="choice",
        )  # fmt: skip
        ax.text(
            *mark.place.xy, words, ha="center", va="center_baseline", fontsize=8, fontweight="bold", color="white",
            zorder=13, gid="choice-number",
        )  # fmt: skip


def _write(figure: Figure, question: str, choices: Sequence[str], places: Sequence[Sequence[Place]]) -> None:
    """Write the question above the map and the choices below it."""
    from matplotlib.lines import Line2D

    width = max(30, int(figure.get_size_inches()[0] * _LETTERS_IN))
    figure.suptitle("\n".join(textwrap.wrap(question, width)), fontsize=11, color=colours.INK)
    handles = [
        Line2D(
            [], [], marker="o", linestyle="none", markersize=8, color=colour_of(k) if there else "white",
            markeredgecolor="white", label=textwrap.shorten(f"{k}. {choice}", width, placeholder=" …"),
        )
        for k, (choice, there) in enumerate(zip(choices, places, strict=True), start=1)
    ]  # fmt: skip
    figure.legend(handles=handles, loc="outside lower left", frameon=False, fontsize=9, labelcolor=colours.INK)
