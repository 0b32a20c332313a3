"""What went wrong, is in doubt or was interrupted, on a map of the report."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fieldhand.evaluation.report_facts import out_of_reach
from fieldhand.evaluation.report_marks import FAILED, Mark
from fieldhand.site.model import Site
from fieldhand.task.results import Acted, Event, InDoubt, Obstructed, Resumed, Shed

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Floats = NDArray[np.float64]
DOUBT = "#6a1b9a"


def draw_incidents(ax: Axes, site: Site, events: Sequence[Event], disc: float) -> list[Mark]:
    """What stood in the way at the end, trees to which no way led, captures in doubt, power cuts."""
    from matplotlib.collections import PolyCollection

    marks: list[Mark] = []
    areas = blocked_areas(site, events)
    if areas:
        ax.add_collection(
            PolyCollection(areas, facecolors=f"{FAILED}55", edgecolors=FAILED, linewidths=1.0, zorder=9), autolim=False
        )
        marks.append(("area", FAILED, "something stands in the way"))
    xy = _trees(site, never_reached(events))
    if len(xy):
        ax.plot(
            *(xy[:, 0], xy[:, 1]), "x", markersize=0.75 * disc, markeredgecolor=FAILED, markeredgewidth=1.6, zorder=12,
            gid="out of reach",
        )  # fmt: skip
        marks.append(("cross", FAILED, "no way led there"))
    doubtful = [e for e in events if isinstance(e, InDoubt) and _known(e)]
    for event in doubtful:
        ((x, y),) = site.projection.metres(event.lat, event.lon)
        ax.plot(x, y, "o", color="none", markersize=disc + 4, markeredgecolor=DOUBT, markeredgewidth=1.4, zorder=15)
    if doubtful:
        marks.append(("ring", DOUBT, "capture in doubt"))
    cuts = [e for e in events if isinstance(e, Resumed) and _known(e)]
    for cut in cuts:
        ((x, y),) = site.projection.metres(cut.lat, cut.lon)
        ax.plot(x, y, "D", color="white", markersize=0.6 * disc, markeredgecolor=DOUBT, markeredgewidth=1.2, zorder=15)
    if cuts:
        marks.append(("diamond", DOUBT, "went on after a power cut"))
    return marks


def blocked_areas(site: Site, events: Sequence[Event]) -> list[Floats]:
    """What the robot kept off at the end, in local metres, each area with shape (n, 2)."""
    last = next((e for e in reversed(events) if isinstance(e, Obstructed)), None)
    found = [np.asarray(area, dtype=np.float64).reshape(-1, 2) for area in (() if last is None else last.blocked)]
    return [site.projection.metres(a[:, 0], a[:, 1]) for a in found if len(a) > 2 and np.isfinite(a).all()]


def never_reached(events: Sequence[Event]) -> tuple[str, ...]:
    """Trees that were left out because no way led to them; not those that were come to later."""
    found: dict[str, None] = {}
    for event in events:
        if isinstance(event, Shed) and out_of_reach(event):
            found.update(dict.fromkeys(event.places))
        elif isinstance(event, Acted) and event.status == "success":
            found.pop(event.place, None)
    return tuple(found)


def _known(event: InDoubt | Resumed) -> bool:
    return math.isfinite(event.lat) and math.isfinite(event.lon)


def _trees(site: Site, places: Sequence[str]) -> Floats:
    found = [site.by_id[p].place.xy for p in places if p in site.by_id]
    return np.asarray(found, dtype=np.float64).reshape(-1, 2)
