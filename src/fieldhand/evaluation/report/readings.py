"""Readings of a mission: a row each, related to the thresholds that the Task tests, and a summary per quantity."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from fieldhand.clock import clock_time
from fieldhand.evaluation.report.log_facts import captures
from fieldhand.evaluation.report.place_names import PlaceNames
from fieldhand.evaluation.report.reading_statistics import QuantityStatistics, ReadingStatistics
from fieldhand.language.words import capitalised, say_action, say_name, say_number, say_unit
from fieldhand.places.series_statistics import statistic
from fieldhand.robot.model import RobotProfile
from fieldhand.site.names import say_block
from fieldhand.task.conditions import Between, Compare, Level, walk
from fieldhand.task.frames import Task
from fieldhand.task.plan import Node
from fieldhand.task.plan import walk as walk_plan
from fieldhand.task.results import Acted, Event, InDoubt

#: Most readings in the page; the CSV file has all.
MOST_ROWS = 1_000


@dataclass(frozen=True, kw_only=True)
class ReadingRow:
    """A row of the table: time, place, what was read or done, and its relation to the thresholds."""

    time: str
    where: str
    place: str
    what: str
    value: str
    relation: str


@dataclass(frozen=True, kw_only=True)
class ReadingSummary:
    """Summary of all readings of one quantity.

    Attributes:
        quantity: Its name in the profile.
        name: Its name in words.
        unit: Its unit with a leading space, as printed after a number.
        values: All values in the order of reading.
        decimals: Decimals needed to distinguish the values.
        thresholds: Thresholds that the Task tests, ascending, by the node that reads.
        words: Count, lowest, mean and highest, and per threshold the readings above it of those tested against it.
    """

    quantity: str
    name: str
    unit: str
    values: tuple[float, ...]
    decimals: int
    thresholds: Mapping[str, tuple[float, ...]]
    words: tuple[tuple[str, str], ...]

    def say(self, value: float) -> str:
        """Format a value with the decimals of this summary."""
        return say_fixed(value, self.decimals)


def summaries(
    task: Task, robot: RobotProfile, events: Sequence[Event], statistics: Sequence[QuantityStatistics] = ()
) -> tuple[ReadingSummary, ...]:
    """Return a summary per quantity read, in the order of first readings.

    Args:
        task, robot: Task and robot of the mission.
        events: Its event log.
        statistics: Statistics of the readings, which give the means of several blocks.
    """
    by_block = {one.quantity: one.blocks for one in statistics}
    made = [e for e in captures(events) if e.status == "success"]
    limits = thresholds(task, robot)
    found = []
    for quantity in dict.fromkeys(q for e in made for q in e.readings):
        values = tuple(e.readings[quantity] for e in made if math.isfinite(e.readings.get(quantity, math.nan)))
        unit = _unit(next((e.units[quantity] for e in made if quantity in e.units), ""))
        digits = decimals(values)
        held = {node: found for (node, q), found in limits.items() if q == quantity}
        found.append(
            ReadingSummary(
                quantity=quantity,
                name=capitalised(say_name(quantity)),
                unit=unit,
                values=values,
                decimals=digits,
                thresholds=held,
                words=(
                    *_in_short(values, digits, unit),
                    *_of_blocks(by_block.get(quantity, {}), digits, unit),
                    *_above(quantity, made, held, unit),
                ),
            )
        )
    return tuple(found)


def reading_rows(
    summary: Mapping[str, ReadingSummary], events: Sequence[Event], names: PlaceNames
) -> tuple[ReadingRow, ...]:
    """Return a row per reading, and per capture that measured nothing or is in doubt.

    Stops soon after :data:`MOST_ROWS`; the CSV has the rest.
    """
    rows: list[ReadingRow] = []
    for event in events:
        if isinstance(event, InDoubt) or (isinstance(event, Acted) and event.status == "success"):
            rows.extend(_rows_of(event, summary, names))
        if len(rows) > MOST_ROWS:
            break
    return tuple(rows)


def thresholds(task: Task, robot: RobotProfile) -> Mapping[tuple[str, str], tuple[float, ...]]:
    """Return the thresholds that the Task's conditions test, ascending, by the node that reads and the quantity.

    A reading that no condition tests has none, even if the profile defines levels for its quantity.
    """
    asked: dict[tuple[str, str], set[float]] = {}
    for node in walk_plan(task.composition.plan):
        for reading, quantity, value in _tested(node, robot):
            asked.setdefault((reading, quantity), set()).add(value)
    return {held: tuple(sorted(values)) for held, values in asked.items()}


def relation(value: float, limits: Sequence[float], digits: int, unit: str) -> str:
    """Return how a reading relates to its thresholds: "1.4 °C above 34 °C"; empty if there are none."""
    parts = []
    for limit in limits:
        apart = abs(value - limit)
        side = "above" if value > limit else "below"
        if apart == 0.0:
            parts.append(f"exactly {say_number(limit)}{unit}")
        else:
            # Enough decimals that a reading near its threshold is never printed as equal to it.
            finer = max(digits, min(6, math.ceil(-math.log10(apart))))
            parts.append(f"{say_fixed(apart, finer)}{unit} {side} {say_number(limit)}{unit}")
    return "; ".join(parts)


def decimals(values: Sequence[float]) -> int:
    """Return the decimals that show about a hundredth of the spread of values."""
    spread = max(values) - min(values) if values else 0.0
    size = spread if spread > 1e-9 else max((abs(v) for v in values), default=0.0)
    return 0 if size <= 0.0 else min(max(1 - math.floor(math.log10(size / 4)), 0), 6)


def say_fixed(value: float, digits: int) -> str:
    """Format a number with a given number of decimals and a true minus sign."""
    return f"{value:.{digits}f}".replace("-", "\N{MINUS SIGN}")


def _unit(unit: str) -> str:
    """Return a unit with a leading space, or nothing for none."""
    unit_text = say_unit(unit)
    return f" {unit_text}" if unit_text else ""


def _tested(node: Node, robot: RobotProfile) -> Iterator[tuple[str, str, float]]:
    """Yield reading, quantity and threshold of each test in a node's condition."""
    condition = node.tested
    for test in () if condition is None else walk(condition):
        match test:
            case Compare():
                yield test.reading, test.quantity, test.value
            case Between():
                yield test.reading, test.quantity, test.low
                yield test.reading, test.quantity, test.high
            case Level():
                quantity = robot.quantity.get(test.quantity)
                if quantity is not None and test.level in quantity.levels:
                    yield test.reading, test.quantity, quantity.levels[test.level].value
            case _:
                pass


def _in_short(values: Sequence[float], digits: int, unit: str) -> Iterator[tuple[str, str]]:
    if not values:
        return
    yield "readings", str(len(values))
    if len(values) > 1:
        yield "lowest", f"{say_fixed(min(values), digits)}{unit}"
        yield "mean", f"{say_fixed(math.fsum(values) / len(values), digits)}{unit}"
        yield "median", f"{say_fixed(statistic('median', values), digits)}{unit}"
        yield "highest", f"{say_fixed(max(values), digits)}{unit}"


def _of_blocks(blocks: Mapping[str, ReadingStatistics], digits: int, unit: str) -> Iterator[tuple[str, str]]:
    """Yield the mean of each of several blocks, with the number of its readings."""
    for name, one in blocks.items():
        yield f"mean of {say_block(name)}", f"{say_fixed(one.mean, digits)}{unit} of {one.count}"


def _above(
    quantity: str, made: Sequence[Acted], held: Mapping[str, Sequence[float]], unit: str
) -> Iterator[tuple[str, str]]:
    """Yield per threshold the number of readings above it, of those tested against it."""
    for limit in sorted({limit for limits in held.values() for limit in limits}):
        values = [e.readings.get(quantity, math.nan) for e in made if limit in held.get(e.node, ())]
        known = [value for value in values if math.isfinite(value)]
        if known:
            yield f"above {say_number(limit)}{unit}", f"{sum(v > limit for v in known)} of {len(known)}"


def _rows_of(event: Acted | InDoubt, summary: Mapping[str, ReadingSummary], names: PlaceNames) -> Iterator[ReadingRow]:
    where = names.where(event.kind, event.place)
    place = names.name(event.kind, event.place)
    values = [(q, v) for q, v in sorted(event.readings.items()) if q in summary]
    for quantity, value in values:
        known = summary[quantity]
        finite, limits = math.isfinite(value), known.thresholds.get(event.node, ())
        yield ReadingRow(
            time=clock_time(event.t),
            where=where,
            place=place,
            what=known.name,
            value=f"{known.say(value)}{known.unit}" if finite else "no number",
            relation=relation(value, limits, known.decimals, known.unit) if finite else "",
        )
    if not values:
        title = capitalised(say_action(event.action))
        done = "in doubt" if isinstance(event, InDoubt) else "done"
        yield ReadingRow(time=clock_time(event.t), where=where, place=place, what=title, value=done, relation="")
