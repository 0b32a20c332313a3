"""Place names on a picture where they cover no other name, symbol or tree; names without room are left out."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fieldhand.hidden_characters import visible
from fieldhand.site.point_index import PointIndex

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.backends.backend_agg import RendererAgg

XY = tuple[float, float]
Box = tuple[float, float, float, float]

_GAP, _STEP = 1.5, 6.0


class Labels:
    """Placement of names on axes. Coordinates are in points from the lower left of the figure.

    Args:
        ax: Axes to write on; their position and limits must not change afterwards.
        dots: Positions of the trees in metres, shape (n, 2).
        dot_radius: Radius of a tree's dot in points.
    """

    def __init__(self, ax: Axes, dots: NDArray[np.float64], dot_radius: float) -> None:
        from matplotlib.backends.backend_agg import FigureCanvasAgg

        self._ax = ax
        figure = ax.get_figure(root=True)
        assert figure is not None  # noqa: S101  (an Axes without a figure cannot be drawn at all)
        self._renderer: RendererAgg = FigureCanvasAgg(figure).get_renderer()  # type: ignore[no-untyped-call]
        self._points_a_pixel = 72.0 / figure.dpi
        self._trees = PointIndex(np.asarray(ax.transData.transform(dots)) * self._points_a_pixel)
        self._radius = dot_radius
        #: Centre of the last name.
        self.last: XY = (0.0, 0.0)
        self._taken = np.empty((0, 4))
        self._sizes: dict[tuple[str, float, bool], XY] = {}
        (west, east), (south, north) = ax.get_xlim(), ax.get_ylim()
        self._frame = (*self.at((west, south)), *self.at((east, north)))

    def at(self, xy: XY) -> XY:
        """Return the position in points of a place in metres."""
        x, y = self._ax.transData.transform(xy)
        return (float(x) * self._points_a_pixel, float(y) * self._points_a_pixel)

    def metres(self, spot: XY) -> XY:
        """Return the place in metres of a position in points."""
        x, y = self._ax.transData.inverted().transform(np.array(spot) / self._points_a_pixel)
        return (float(x), float(y))

    def avoid(self, ways: Iterable[Sequence[XY]]) -> None:
        """Treat lines through places in metres like trees: names cover them only if no other spot is free."""
        points = [point for way in ways for point in _along([self.at(xy) for xy in way])]
        if points:
            self._trees = PointIndex(np.vstack([self._trees.points, np.array(points)]))

    def size(self, text: str, font: float, *, bold: bool = False) -> XY:
        """Return width and height of a text on one line."""
        from matplotlib.font_manager import FontProperties

        if (known := self._sizes.get((text, font, bold))) is not None:
            return known
        weight = "bold" if bold else "normal"
        width, _, _ = self._renderer.get_text_width_height_descent(  # type: ignore[no-untyped-call]
            text, FontProperties(size=font, weight=weight), False
        )
        size = self._sizes[text, font, bold] = (float(width) * self._points_a_pixel, 1.05 * font)
        return size

    def keep_free(self, at: XY, half: float) -> None:
        """Reserve the area of a symbol."""
        self._take([(at[0] - half, at[1] - half, at[0] + half, at[1] + half)])

    def keep_part_free(self, x0: float, y0: float, x1: float, y1: float) -> None:
        """Reserve a part of the axes, in fractions of its width and height."""
        left, bottom, right, top = self._frame
        wide, tall = right - left, top - bottom
        self._take([(left + x0 * wide, bottom + y0 * tall, left + x1 * wide, bottom + y1 * tall)])

    def put(
        self,
        text: str,
        spots: Sequence[XY],
        *,
        font: float,
        colour: str,
        bold: bool = False,
        turn_deg: float = 0.0,
        over_trees: bool = False,
        zorder: float = 7,
        gid: str = "name",
    ) -> bool:
        """Write a name at the first of the spots with room for it.

        Args:
            text: Text on one line.
            spots: Possible centres of the text, best first.
            font: Font size in points.
            colour: Colour of the text.
            bold: True for bold text.
            turn_deg: Rotation in degrees, anticlockwise.
            over_trees: Cover trees if no spot is free of them.
            zorder: Drawing order.
            gid: Group id of the text in the figure.

        Returns:
            True if the text was written.
        """
        text = visible(text)
        size = self.size(text, font, bold=bold)
        for trees_too in (False, True) if over_trees else (False,):
            for spot in spots:
                boxes = _boxes(spot, size, turn_deg)
                if all(self._free(box, trees_too) for box in boxes):
                    self._take(boxes)
                    self.last = spot
                    self._write(text, spot, font, colour, bold, turn_deg, zorder, gid)
                    return True
        return False

    def _take(self, boxes: Sequence[Box]) -> None:
        self._taken = np.vstack([self._taken, np.array(boxes)])

    def _free(self, box: Box, over_trees: bool) -> bool:
        x0, y0, x1, y1 = box
        left, bottom, right, top = self._frame
        if x0 < left or y0 < bottom or x1 > right or y1 > top:
            return False
        other = self._taken
        apart = (
            (other[:, 0] >= x1 + _GAP)
            | (other[:, 2] <= x0 - _GAP)
            | (other[:, 1] >= y1 + _GAP)
            | (other[:, 3] <= y0 - _GAP)
        )
        if not apart.all():
            return False
        if over_trees:
            return True
        middle, half = np.array([(x0 + x1) / 2, (y0 + y1) / 2]), ((x1 - x0) / 2, (y1 - y0) / 2)
        near = self._trees.close_to(middle[None], math.hypot(*half) + self._radius)[:, 1]
        away = np.maximum(np.abs(self._trees.points[near] - middle) - half, 0.0)
        return not (np.hypot(away[:, 0], away[:, 1]) < self._radius).any()

    def _write(
        self, text: str, spot: XY, font: float, colour: str, bold: bool, turn_deg: float, zorder: float, gid: str
    ) -> None:
        from matplotlib.patheffects import withStroke

        self._ax.text(
            *(*self.metres(spot), text),
            parse_math=False,
            ha="center",
            va="center",
            rotation=turn_deg,
            rotation_mode="anchor",
            fontsize=font,
            fontweight="bold" if bold else "normal",
            color=colour,
            path_effects=[withStroke(linewidth=0.28 * font, foreground="white")],
            zorder=zorder,
            gid=gid,
        )


def _along(corners: Sequence[XY]) -> Iterator[XY]:
    """Yield points along a line, too close for a name to fit between them."""
    for (x0, y0), (x1, y1) in itertools.pairwise(corners):
        count = min(int(math.hypot(x1 - x0, y1 - y0) / _STEP) + 1, 400)
        yield from ((x0 + (x1 - x0) * k / count, y0 + (y1 - y0) * k / count) for k in range(count))


def _boxes(spot: XY, size: XY, turn_deg: float) -> list[Box]:
    """Return the boxes that cover a text: one, or a chain along it if it is rotated."""
    (x, y), (width, height) = spot, size
    if turn_deg % 180.0 == 0.0:
        return [(x - width / 2, y - height / 2, x + width / 2, y + height / 2)]
    c, s = math.cos(math.radians(turn_deg)), math.sin(math.radians(turn_deg))
    count = max(1, math.ceil(width / height))
    piece = width / count
    half_x, half_y = (abs(c) * piece + abs(s) * height) / 2, (abs(s) * piece + abs(c) * height) / 2
    found = []
    for k in range(count):
        along = (k - (count - 1) / 2) * piece
        mx, my = x + along * c, y + along * s
        found.append((mx - half_x, my - half_y, mx + half_x, my + half_y))
    return found
