"""The work of earlier missions that a selector refers to, by place."""

from __future__ import annotations

import math
import statistics
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from fieldhand.errors import NoPlaceError, PlaceError
from fieldhand.language import counted, message
from fieldhand.language.words import say_name
from fieldhand.site.earlier_missions import EarlierCapture, EarlierMission, EarlierMissions
from fieldhand.site.names import short

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldhand.places.earlier.done_earlier import DoneEarlier
    from fieldhand.places.earlier.period import Period
    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.site.model import Site

#: One value for several earlier readings of a place.
EarlierStatistic = Literal["latest", "mean", "median", "minimum", "maximum"]

#: Distance in metres up to which a point of an earlier mission is the same place.
SAME_POINT_M = 0.5

#: A capture with its mission.
Work = tuple[EarlierMission, EarlierCapture]
_Key = tuple[str, str]


def work_in(records: EarlierMissions, period: Period, wanted: Callable[[EarlierCapture], bool]) -> tuple[Work, ...]:
    """Return the wanted captures of a period, in the order of time.

    Args:
        records: Earlier missions on the site.
        period: Period; its last missions are the last ones with a wanted capture.
        wanted: Returns True for a capture that counts.

    Raises:
        PlaceError: The period is not a possible one.
    """
    now = records.time
    period.require(now)
    found = [work for work in records.captures() if wanted(work[1]) and period.covers(work[1].time, now)]
    found.sort(key=lambda work: (work[1].time, work[0].id))
    if period.last_missions is None:
        return tuple(found)
    latest: dict[str, None] = {}
    for mission, _ in reversed(found):
        latest.setdefault(mission.id)
    counted_ones = set(list(latest)[: period.last_missions])
    return tuple(work for work in found if work[0].id in counted_ones)


def records_of(resolution: Resolution) -> EarlierMissions:
    """Return the earlier missions of the site.

    Raises:
        PlaceError: The site comes without them.
    """
    records = resolution.site.earlier
    if records is None:
        raise PlaceError(
            message(
                "the plan needs what earlier missions did on '{site}', and it is not given", site=resolution.site.name
            ),
            where=resolution.site.name,
            advice=message(
                "give the folder of finished missions with --missions, or in Python earlier=fh.earlier_missions(site)"
            ),
        )
    return records


@dataclass(frozen=True, kw_only=True)
class WorkByPlace:
    """Earlier captures by place.

    Attributes:
        at: Captures at each place in the order of time, by its kind and id.
        points: Captures at places that are no trees, which count for any place at that position.
    """

    at: Mapping[_Key, Sequence[Work]]
    points: tuple[Work, ...]

    @staticmethod
    def of(work: Iterable[Work]) -> WorkByPlace:
        """Group captures by place."""
        at: dict[_Key, list[Work]] = {}
        points: list[Work] = []
        for one in work:
            capture = one[1]
            if capture.lat is None:
                at.setdefault((capture.kind, capture.place), []).append(one)
            else:
                points.append(one)
        return WorkByPlace(at=at, points=tuple(points))

    def each(self, group: PlaceGroup) -> tuple[Sequence[Work], ...]:
        """Return the captures at each place of a group, in its order."""
        if not self.points:
            if not self.at:
                return ((),) * len(group)
            return tuple(self.at.get((place.kind, place.id), ()) for place in group.places)
        xy = _points_xy(self.points, group)
        found: list[Sequence[Work]] = []
        for place, (x, y) in zip(group.places, group.xy.tolist(), strict=True):
            if place.kind == "tree":
                found.append(self.at.get((place.kind, place.id), ()))
                continue
            near = np.flatnonzero(np.hypot(xy[:, 0] - x, xy[:, 1] - y) <= SAME_POINT_M)
            found.append([self.points[k] for k in near.tolist()])
        return tuple(found)


def _points_xy(points: Sequence[Work], group: PlaceGroup) -> NDArray[np.float64]:
    projection = group.site.projection
    return projection.metres([one.lat or 0.0 for _, one in points], [one.lon or 0.0 for _, one in points])


def readings_at(
    group: PlaceGroup, resolution: Resolution, quantity: str, unit: str, period: Period
) -> tuple[Sequence[float], ...]:
    """Return the earlier readings of a quantity at each place of a group in a period, in the order of time.

    Args:
        group: The places.
        resolution: Resolution on the site.
        quantity: Name of the quantity.
        unit: Unit of the readings that count; empty for any, if all have the same.
        period: Period of the readings.

    Raises:
        PlaceError: No reading of that quantity is on record in the period, or the readings have different units.
    """
    records = records_of(resolution)
    work = work_in(
        records, period, lambda capture: capture.outcome == "done" and capture.value_of(quantity) is not None
    )
    units = sorted({value.unit for _, capture in work if (value := capture.value_of(quantity)) is not None})
    if not work:
        raise no_reading_on_record(resolution, records, quantity, period)
    if len(units) > 1 or (unit and units != [unit]):
        raise PlaceError(
            message(
                "the earlier readings of {name} are in {units}, which cannot be compared",
                name=say_name(quantity),
                units=short(", ".join(units), 80),
            ),
            where=resolution.site.name,
            advice=message("choose a period in which all have the unit of the robot's profile"),
        )
    by_place = WorkByPlace.of(work).each(group)
    return tuple([value.value for _, one in some if (value := one.value_of(quantity)) is not None] for some in by_place)


def readings_used(
    records: EarlierMissions, quantity: str, period: Period, statistic: EarlierStatistic
) -> tuple[Work, ...]:
    """Return the captures with readings of a quantity in a period, as far as a statistic depends on them."""
    work = work_in(
        records, period, lambda capture: capture.outcome == "done" and capture.value_of(quantity) is not None
    )
    return latest_of_each(work, period) if statistic == "latest" else work


def latest_of_each(work: Iterable[Work], period: Period) -> tuple[Work, ...]:
    """Return the latest capture at each place, of each mission where a period counts missions.

    Args:
        work: Captures in the order of time.
        period: Period that they are in.
    """
    by_mission = period.last_missions is not None
    latest: dict[tuple[object, ...], Work] = {}
    for mission, one in work:
        key = (mission.id if by_mission else "", one.kind, one.place, one.lat, one.lon)
        latest.pop(key, None)
        latest[key] = mission, one
    return tuple(latest.values())


def require_at_least(count: int) -> None:
    """Check a number of places or missions.

    Raises:
        PlaceError: It is below 1.
    """
    if count < 1:
        raise PlaceError(
            message("a number of {count} is not possible", count=count), advice=message("ask for at least 1")
        )


def one_value(of: EarlierStatistic, values: Sequence[float]) -> float:
    """Return one value for the readings of a place, in the order of time; nan without any."""
    if not values:
        return math.nan
    match of:
        case "latest":
            return values[-1]
        case "mean":
            return math.fsum(values) / len(values)
        case "median":
            return statistics.median(values)
        case "minimum":
            return min(values)
        case "maximum":
            return max(values)


def note_without_reading(count: int, quantity: str, notes: ResolutionNotes) -> None:
    """Add a note on the number of places without a reading."""
    if count:
        notes.remark(
            counted(
                "{count} has no earlier reading of {name} and is left out",
                "{count} have no earlier reading of {name} and are left out",
                count,
                name=say_name(quantity),
            )
        )


def nothing_done(site: Site, selector: DoneEarlier, records: EarlierMissions) -> NoPlaceError:
    """Return the error for a selector of places where nothing was done."""
    from fieldhand.places.earlier.wording import say_nothing_done

    return NoPlaceError(
        say_nothing_done(selector, records, site),
        where=site.name,
        advice=message("choose another period, or give the folder of finished missions with --missions"),
    )


def no_reading_on_record(
    resolution: Resolution, records: EarlierMissions, quantity: str, period: Period
) -> NoPlaceError:
    """Return the error for a quantity without readings on record."""
    from fieldhand.places.earlier.wording import say_no_reading

    return NoPlaceError(
        say_no_reading(records, resolution.site, quantity, period),
        where=resolution.site.name,
        advice=message("choose another period, or give the folder of finished missions with --missions"),
    )
