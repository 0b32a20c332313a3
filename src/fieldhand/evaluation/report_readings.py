"""The readings of a mission as a grower reads them: each beside the thresholds that matter, and all in short."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from fieldhand.clock import clock_time
from fieldhand.evaluation.report_facts import captures
from fieldhand.evaluation.report_places import PlaceNames
from fieldhand.robot.model import RobotProfile
from fieldhand.task.conditions import Between, Compare, Level, walk
from fieldhand.task.frames import Task
from fieldhand.task.plan import Node, condition_of
from fieldhand.task.plan import walk as walk_plan
from fieldhand.task.results import Acted, Event, InDoubt
from fieldhand.task.words import capitalised, say_action, say_name, say_number, say_unit

#: More readings than this stand in the CSV file alone.
MOST_ROWS = 1_000


@dataclass(frozen=True, kw_only=True)
class Threshold:
    """A value that readings are held against.

    Attributes:
        word: What the profile calls a reading beyond it ("low"); empty for one that the Task itself names.
        below: Whether the word is for what is below it.
    """

    value: float
    word: str = ""
    below: bool = False


@dataclass(frozen=True, kw_only=True)
class ReadingRow:
    """A row of the table: when, where, what was read or done, and how it stands to the thresholds."""

    time: str
    where: str
    place: str
    what: str
    value: str
    relation: str


@dataclass(frozen=True, kw_only=True)
class Summary:
    """All readings of one quantity in short.

    Attributes:
        quantity: Its name in the profile.
        name: As it is said.
        unit: As it is printed behind a number, with the space between.
        values: In the order in which they were read.
        decimals: As many as tell the values apart.
        thresholds: That its readings are held against, ascending.
        words: Count, lowest, mean and highest, and how many lie beyond each threshold.
    """

    quantity: str
    name: str
    unit: str
    values: tuple[float, ...]
    decimals: int
    thresholds: tuple[Threshold, ...]
    words: tuple[tuple[str, str], ...]

    def say(self, value: float) -> str:
        """A value with as many decimals as the others."""
        return say_fixed(value, self.decimals)


def summaries(task: Task, robot: RobotProfile, events: Sequence[Event]) -> tuple[Summary, ...]:
    """The quantities that were read, in the order in which they came up."""
    made = [e for e in captures(events) if e.status == "success"]
    limits = thresholds(task, robot)
    found = []
    for quantity in dict.fromkeys(q for e in made for q in e.readings):
        values = tuple(e.readings[quantity] for e in made if math.isfinite(e.readings.get(quantity, math.nan)))
        unit = _unit(next((e.units[quantity] for e in made if quantity in e.units), ""))
        digits, beyond = decimals(values), limits.get(quantity, ())
        found.append(
            Summary(
                quantity=quantity,
                name=capitalised(say_name(quantity)),
                unit=unit,
                values=values,
                decimals=digits,
                thresholds=beyond,
                words=tuple(_in_short(values, digits, unit, beyond)),
            )
        )
    return tuple(found)


def reading_rows(summary: Mapping[str, Summary], events: Sequence[Event], names: PlaceNames) -> tuple[ReadingRow, ...]:
    """A row a reading, and one a capture that measured nothing or is in doubt.

    Those beyond :data:`MOST_ROWS` are left to the CSV.
    """
    rows: list[ReadingRow] = []
    for event in events:
        if isinstance(event, InDoubt) or (isinstance(event, Acted) and event.status == "success"):
            rows.extend(_rows_of(event, summary, names))
        if len(rows) > MOST_ROWS:
            break
    return tuple(rows)


def thresholds(task: Task, robot: RobotProfile) -> Mapping[str, tuple[Threshold, ...]]:
    """What each quantity is held against: what the Task's conditions name, else the words of the profile."""
    asked: dict[str, set[float]] = {}
    for node in walk_plan(task.composition.plan):
        for quantity, value in _tested(node, robot):
            asked.setdefault(quantity, set()).add(value)
    found = {
        q.name: tuple(
            Threshold(value=level.value, word=word, below=level.direction == "below")
            for word, level in sorted(q.levels.items(), key=lambda item: item[1].value)
        )
        for q in robot.quantities
    }
    return found | {q: tuple(Threshold(value=v) for v in sorted(values)) for q, values in asked.items()}


def relation(value: float, limits: Sequence[Threshold], digits: int, unit: str) -> str:
    """How a reading stands to its thresholds: "1.4 °C above 34 °C", "low"; empty where there are none."""
    said = []
    for limit in limits:
        if limit.word:
            if (value < limit.value) if limit.below else (value > limit.value):
                side = "below" if limit.below else "above"
                said.append(f"{limit.word} ({side} {say_number(limit.value)}{unit})")
            continue
        apart = abs(value - limit.value)
        side = "above" if value > limit.value else "below"
        if apart == 0.0:
            said.append(f"exactly {say_number(limit.value)}{unit}")
        else:
            # So many decimals that a reading beside its threshold is never said to lie on it.
            finer = max(digits, min(6, math.ceil(-math.log10(apart))))
            said.append(f"{say_fixed(apart, finer)}{unit} {side} {say_number(limit.value)}{unit}")
    return "; ".join(said)


def decimals(values: Sequence[float]) -> int:
    """As many decimals as show about a hundredth of the spread of some values."""
    spread = max(values) - min(values) if values else 0.0
    size = spread if spread > 1e-9 else max((abs(v) for v in values), default=0.0)
    return 0 if size <= 0.0 else min(max(1 - math.floor(math.log10(size / 4)), 0), 6)


def say_fixed(value: float, digits: int) -> str:
    """A number with so many decimals."""
    return f"{value:.{digits}f}".replace("-", "\N{MINUS SIGN}")


def _unit(unit: str) -> str:
    """A unit as it stands behind a number."""
    said = say_unit(unit)
    return f" {said}" if said else ""


def _tested(node: Node, robot: RobotProfile) -> Iterator[tuple[str, float]]:
    condition = condition_of(node)
    for test in () if condition is None else walk(condition):
        match test:
            case Compare():
                yield test.quantity, test.value
            case Between():
                yield test.quantity, test.low
                yield test.quantity, test.high
            case Level():
                quantity = robot.quantity.get(test.quantity)
                if quantity is not None and test.level in quantity.levels:
                    yield test.quantity, quantity.levels[test.level].value
            case _:
                pass


def _in_short(
    values: Sequence[float], digits: int, unit: str, limits: Sequence[Threshold]
) -> Iterator[tuple[str, str]]:
    if not values:
        return
    yield "readings", str(len(values))
    if len(values) > 1:
        yield "lowest", f"{say_fixed(min(values), digits)}{unit}"
        yield "mean", f"{say_fixed(math.fsum(values) / len(values), digits)}{unit}"
        yield "highest", f"{say_fixed(max(values), digits)}{unit}"
    for limit in limits:
        below = limit.below and bool(limit.word)
        count = sum(v < limit.value if below else v > limit.value for v in values)
        side = f"{'below' if below else 'above'} {say_number(limit.value)}{unit}"
        yield f"{limit.word} ({side})" if limit.word else side, str(count)


def _rows_of(event: Acted | InDoubt, summary: Mapping[str, Summary], names: PlaceNames) -> Iterator[ReadingRow]:
    where = names.where(event.kind, event.place)
    place = names.name(event.kind, event.place)
    values = [(q, v) for q, v in sorted(event.readings.items()) if q in summary]
    for quantity, value in values:
        known = summary[quantity]
        finite = math.isfinite(value)
        yield ReadingRow(
            time=clock_time(event.t),
            where=where,
            place=place,
            what=known.name,
            value=f"{known.say(value)}{known.unit}" if finite else "no number",
            relation=relation(value, known.thresholds, known.decimals, known.unit) if finite else "",
        )
    if not values:
        said = capitalised(say_action(event.action))
        done = "in doubt" if isinstance(event, InDoubt) else "done"
        yield ReadingRow(time=clock_time(event.t), where=where, place=place, what=said, value=done, relation="")
