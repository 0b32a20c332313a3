"""Detail of a map: the part of a site with the work, drawn larger beside the whole."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fieldhand.site.drawing import colours
from fieldhand.site.drawing.ground import points_a_metre
from fieldhand.site.model import Site

if TYPE_CHECKING:
    from matplotlib.axes import Axes

XY = tuple[float, float]

#: A detail is drawn if the tree spacing on the whole map is less than this many points, and the detail enlarges it by
#: at least this factor.
_CLOSE, _GAIN = 12.0, 1.5
#: Least width of a detail, and margin around the work, in tree spacings.
_LEAST, _AROUND = 14.0, 3.0


@dataclass(frozen=True, kw_only=True)
class Window:
    """A rectangular part of a site, in local metres."""

    west: float
    south: float
    east: float
    north: float

    def holds(self, xy: XY) -> bool:
        """Return True if a place is inside."""
        return self.west <= xy[0] <= self.east and self.south <= xy[1] <= self.north

    def as_tall_as(self, width_in: float, height_in: float) -> Window:
        """Return the window extended above and below to the aspect ratio of a taller drawing."""
        more = ((self.east - self.west) * height_in / width_in - (self.north - self.south)) / 2
        return Window(west=self.west, south=self.south - more, east=self.east, north=self.north + more)


def window_of(ax: Axes, site: Site, work: Sequence[XY], width_in: float, height_in: float) -> Window | None:
    """Return the part of a site around some places, with the aspect ratio of a separate drawing.

    Args:
        ax: Map of the whole site, with its final position and limits.
        site: Site on the map.
        work: Places in local metres.
        width_in, height_in: Size of the separate drawing in inches.

    Returns:
        None if the whole map shows the trees well enough, or the detail would hardly enlarge them.
    """
    whole = points_a_metre(ax)
    if not len(work) or site.spacing_m * whole >= _CLOSE:
        return None
    xy = np.asarray(work, dtype=np.float64)
    low, high = xy.min(axis=0), xy.max(axis=0)
    size = np.maximum(high - low + 2 * _AROUND * site.spacing_m, _LEAST * site.spacing_m)
    metres_in = float(max(size[0] / width_in, size[1] / height_in))
    if 72.0 / metres_in < _GAIN * whole:
        return None
    (x, y), wide, tall = (low + high) / 2, metres_in * width_in, metres_in * height_in
    (west, east), (south, north) = ax.get_xlim(), ax.get_ylim()
    # Keep the window inside the map of the whole site.
    x = float(np.clip(x, west + wide / 2, east - wide / 2)) if wide < east - west else (west + east) / 2
    y = float(np.clip(y, south + tall / 2, north - tall / 2)) if tall < north - south else (south + north) / 2
    return Window(west=x - wide / 2, south=y - tall / 2, east=x + wide / 2, north=y + tall / 2)


def show_window(ax: Axes, window: Window) -> None:
    """Draw the frame of a window on the map of the whole site."""
    from matplotlib.patches import Rectangle

    size = (window.east - window.west, window.north - window.south)
    frame = Rectangle((window.west, window.south), *size, fill=False, edgecolor=colours.INK, linewidth=1.1, zorder=15)
    frame.set_gid("window")
    ax.add_patch(frame)


def show_detail(ax: Axes, window: Window) -> None:
    """Set axes to show a window in a frame; everything outside is cut off."""
    ax.set_xlim(window.west, window.east)
    ax.set_ylim(window.south, window.north)
    ax.set_xticks([])
    ax.set_yticks([])
    for spine in ax.spines.values():
        spine.set_edgecolor(colours.INK)
        spine.set_linewidth(1.1)
        spine.set_zorder(18)
