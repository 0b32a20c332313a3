"""Step numbers on a map, placed beside their stops without overlap, or connected to them by a line."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from fieldhand.approval.marks import MANY_STOPS, stop_size
from fieldhand.approval.stops import MapStop
from fieldhand.site.drawing.colours import INK, PATH
from fieldhand.site.drawing.detail_window import Window
from fieldhand.site.drawing.labels import XY, Labels

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_FONT, _SMALL_FONT = 8.5, 7.5
#: Distances in points from a stop to its number; at the last four, a line connects them.
_GAP, _SOMEWHAT, _FARTHER = 3.0, 5.0, (14.0, 26.0, 40.0, 56.0)
#: Loops with more visits than this are numbered sparsely: first, last, and multiples of 50, 10, 5 as space permits.
_NUMBERED, _ROUND = 12, (50, 10, 5)
#: Maximum number of step ranges named in the label of an inset window.
_MOST_RUNS = 3


def draw_labels(ax: Axes, labels: Labels, stops: Sequence[MapStop], disc: float) -> None:
    """Write the number of each stop beside it, and the tree id if there are few stops.

    Args:
        ax: Axes to draw on, in metres.
        labels: Label placement for these axes.
        stops: All stops on the map.
        disc: Diameter of a disc in points.
    """
    for stop in stops:
        labels.keep_free(labels.at(stop.place.xy), stop_size(stop, disc) / 2)
    if len(stops) <= MANY_STOPS:
        for stop in stops:
            _name(ax, labels, stop, disc)
        return
    for stop, text in _by_worth(stops):
        at = labels.at(stop.place.xy)
        size, near = labels.size(text, _SMALL_FONT, bold=True), stop_size(stop, disc) / 2 + _GAP
        spots = [*_around(at, size, near), *_around(at, size, near + _SOMEWHAT)]
        labels.put(text, spots, font=_SMALL_FONT, colour=INK, bold=True, over_trees=True, zorder=14, gid="label")


def label_window(labels: Labels, window: Window, stops: Sequence[MapStop]) -> None:
    """Write the range of steps that an inset window shows beside its frame."""
    (west, south), (east, north) = labels.at((window.west, window.south)), labels.at((window.east, window.north))
    text = ", ".join(_runs(stops))
    width, height = labels.size(text, _FONT, bold=True)
    middle = ((west + east) / 2, (south + north) / 2)
    over, beside = (north - south) / 2 + height / 2 + _GAP, (east - west) / 2 + width / 2 + _GAP
    spots = [
        *_crosswise(middle, beside, over),
        *((x, middle[1] + up * over) for up in (1, -1) for x in (west + width / 2, east - width / 2)),
    ]
    labels.put(text, spots, font=_FONT, colour=INK, bold=True, over_trees=True, zorder=14, gid="window label")


def _name(ax: Axes, labels: Labels, stop: MapStop, disc: float) -> None:
    """Write the number of a stop as close to it as possible, with its tree id if there is space."""
    number = ", ".join(_ranges(stop.labels))
    if not number:
        return
    at, near = labels.at(stop.place.xy), stop_size(stop, disc) / 2 + _GAP
    texts = [f"{number}  tree {stop.place.id}", number] if stop.place.kind == "tree" else [number]
    for text, far in itertools.product(texts, (0.0, *_FARTHER)):
        spots = list(_around(at, labels.size(text, _FONT, bold=True), near + far))
        over = far == 0.0 or text == number
        if labels.put(text, spots, font=_FONT, colour=INK, bold=True, over_trees=over, zorder=14, gid="label"):
            if far:
                spot = labels.last
                ax.plot(
                    *zip(stop.place.xy, labels.metres(spot), strict=True), color=PATH, linewidth=0.6, alpha=0.8,
                    zorder=11, gid="pointer",
                )  # fmt: skip
            return


def _by_worth(stops: Sequence[MapStop]) -> list[tuple[MapStop, str]]:
    """Return the stops to number with their text, by priority: ends of each loop, then the roundest numbers."""
    last: dict[str, int] = {}
    for label in (label for stop in stops for label in stop.labels):
        loop, _, visit = label.partition(".")
        last[loop] = max(last.get(loop, 0), int(visit or 0))
    found: list[tuple[int, MapStop, str]] = []
    for stop in stops:
        worth = {label: _worth(label, last) for label in stop.labels}
        shown = [label for label in stop.labels if worth[label] is not None]
        if shown:
            found.append((min(w for w in worth.values() if w is not None), stop, ", ".join(_ranges(shown))))
    return [(stop, text) for _, stop, text in sorted(found, key=lambda item: item[0])]


def _worth(label: str, last: dict[str, int]) -> int | None:
    """Return the priority of a number: 0 for a step or the end of a loop, None for a number to omit."""
    loop, _, visit = label.partition(".")
    if not visit or int(visit) in (1, last[loop]):
        return 0
    if last[loop] <= _NUMBERED:
        return 1
    return next((k for k, step in enumerate(_ROUND, start=1) if int(visit) % step == 0), None)


def _runs(stops: Sequence[MapStop]) -> list[str]:
    """Return the steps of the stops as ranges: "1.1-1.91", "3-7"."""
    ends: dict[str, list[str]] = {}
    for label in (label for stop in stops for label in stop.labels):
        ends.setdefault(label.partition(".")[0] if "." in label else "", []).append(label)
    runs = [
        f"{known[0]}\N{EN DASH}{known[-1]}" if len(known) > 1 else known[0]
        for known in (sorted(labels, key=lambda label: [int(n) for n in label.split(".")]) for labels in ends.values())
    ]
    return [*runs[:_MOST_RUNS], "\N{HORIZONTAL ELLIPSIS}"] if len(runs) > _MOST_RUNS else runs


def _ranges(labels: Sequence[str]) -> list[str]:
    """Return consecutive steps merged into ranges: 1, 2, 3 become "1-3"."""
    found: list[list[str]] = []
    for label in labels:
        last = found[-1][-1] if found else ""
        if last.isdigit() and label.isdigit() and int(label) == int(last) + 1:
            found[-1].append(label)
        else:
            found.append([label])
    return [f"{run[0]}\N{EN DASH}{run[-1]}" if len(run) > 2 else ", ".join(run) for run in found]


def _around(at: XY, size: XY, gap: float) -> Iterator[XY]:
    """Yield text centres to the right, left, top and bottom of a symbol, then at its corners."""
    (width, height), slant = size, 0.75
    yield from _crosswise(at, gap + width / 2, gap + height / 2)
    for across, up in itertools.product((1, -1), (1, -1)):
        yield at[0] + across * (slant * gap + width / 2), at[1] + up * (slant * gap + height / 2)


def _crosswise(at: XY, beside: float, over: float) -> Iterator[XY]:
    x, y = at
    yield from ((x + beside, y), (x - beside, y), (x, y + over), (x, y - over))
