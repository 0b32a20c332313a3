"""Readings of one name taken during a mission, with the place of each."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import overload

from fieldhand.site.model import Place


@dataclass(frozen=True, kw_only=True)
class TakenReading:
    """One reading.

    Attributes:
        place: Place at which it was taken.
        values: Measured values by quantity; empty in a forecast, which knows no values.
    """

    place: Place
    values: Mapping[str, float] = field(default_factory=dict)


class ReadingSeries(Sequence[TakenReading]):
    """An immutable series of readings in order. An extended copy shares its storage with the original.

    Args:
        readings: The readings.
    """

    def __init__(self, readings: Sequence[TakenReading] = ()) -> None:
        #: Positions beyond the count belong to extended copies.
        self._readings = list(readings)
        self._count = len(self._readings)

    def plus(self, reading: TakenReading) -> ReadingSeries:
        """Return the series with one more reading."""
        longer = ReadingSeries()
        longer._readings = self._readings if len(self._readings) == self._count else self._readings[: self._count]
        longer._readings.append(reading)
        longer._count = self._count + 1
        return longer

    def values(self, quantity: str) -> tuple[float, ...]:
        """Return the measured values of a quantity, in order."""
        return tuple(r.values[quantity] for r in self if quantity in r.values)

    @overload
    def __getitem__(self, index: int) -> TakenReading: ...

    @overload
    def __getitem__(self, index: slice) -> Sequence[TakenReading]: ...

    def __getitem__(self, index: int | slice) -> TakenReading | Sequence[TakenReading]:
        return self._readings[: self._count][index]

    def __iter__(self) -> Iterator[TakenReading]:
        return itertools.islice(self._readings, self._count)

    def __len__(self) -> int:
        return self._count

    def __eq__(self, other: object) -> bool:
        return isinstance(other, ReadingSeries) and tuple(self) == tuple(other)

    def __hash__(self) -> int:
        return hash((ReadingSeries, self._count))

    def __repr__(self) -> str:
        return f"ReadingSeries({tuple(self)!r})"


#: Name and quantity of the readings in the examples of selectors.
EXAMPLE_READING, EXAMPLE_QUANTITY = "seen_temperature", "canopy_temperature"
#: Series by the name of their readings.
SeriesByName = Mapping[str, ReadingSeries]
