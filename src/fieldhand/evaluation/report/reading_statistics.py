"""Simple statistics of the readings of a mission, per quantity and per block of the site."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field

from fieldhand.evaluation.report.log_facts import captures
from fieldhand.places.series_statistics import statistic
from fieldhand.site.model import Site
from fieldhand.task.results import Event


@dataclass(frozen=True, kw_only=True)
class ReadingStatistics:
    """Statistics of some readings of one quantity.

    Attributes:
        count: Number of readings.
        mean, median, minimum, maximum: In the unit of the quantity.
    """

    count: int
    mean: float
    median: float
    minimum: float
    maximum: float


@dataclass(frozen=True, kw_only=True)
class QuantityStatistics:
    """Statistics of all readings of one quantity.

    Attributes:
        quantity, unit: The quantity and its unit, as in the profile.
        readings: Statistics of all readings.
        blocks: Statistics by the name of the block; empty if the readings are not from several blocks.
    """

    quantity: str
    unit: str
    readings: ReadingStatistics
    blocks: Mapping[str, ReadingStatistics] = field(default_factory=dict)


def reading_statistics(site: Site, events: Sequence[Event]) -> tuple[QuantityStatistics, ...]:
    """Return the statistics of each quantity that was read, in the order of first readings."""
    taken: dict[str, list[tuple[str, float]]] = {}
    units: dict[str, str] = {}
    blocks = block_names(site)
    for event in captures(events):
        for quantity, value in event.readings.items():
            if math.isfinite(value):
                block = blocks.get(event.place, "") if event.kind == "tree" else ""
                taken.setdefault(quantity, []).append((block, value))
                units.setdefault(quantity, event.units.get(quantity, ""))
    return tuple(
        QuantityStatistics(
            quantity=quantity, unit=units[quantity], readings=_of([v for _, v in values]), blocks=_by_block(values)
        )
        for quantity, values in taken.items()
    )


def block_names(site: Site) -> Mapping[str, str]:
    """Return the name of the block of each tree by its id, without trees in no row."""
    return {
        site.trees[k].place.id: block.name
        for block in site.planting.blocks
        for row in block.rows
        for k in row.trees.tolist()
    }


def statistics_record(site: Site, events: Sequence[Event]) -> list[dict[str, object]]:
    """Return :func:`reading_statistics` as JSON."""
    return [asdict(one) for one in reading_statistics(site, events)]


def _of(values: Sequence[float]) -> ReadingStatistics:
    return ReadingStatistics(
        count=len(values),
        mean=statistic("mean", values),
        median=statistic("median", values),
        minimum=statistic("minimum", values),
        maximum=statistic("maximum", values),
    )


def _by_block(values: Sequence[tuple[str, float]]) -> Mapping[str, ReadingStatistics]:
    names = dict.fromkeys(block for block, _ in values if block)
    if len(names) < 2:
        return {}
    return {name: _of([value for block, value in values if block == name]) for name in names}
