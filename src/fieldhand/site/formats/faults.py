"""Collect the unusable features of a site file, to report them together or to skip them."""

from __future__ import annotations

from collections.abc import Sequence

from fieldhand.errors import SiteError
from fieldhand.site.formats.records import RecordUnit

MOST_REASONS = 10
_MOST_NUMBERS = 5


class UnusableFeature(Exception):  # never leaves the reader
    """A feature that cannot be used.

    Args:
        what: Problem, worded to follow "feature 7: ".
        advice: Remedy.
    """

    def __init__(self, what: str, advice: str) -> None:
        self.what, self.advice = what, advice
        super().__init__(what)


class Faults:
    """The unusable features of a file, each with its reason.

    Args:
        source: Path or name of the file.
        unit: Unit that feature numbers count.
        lenient: Skip unusable features, except those that keep a robot out of an area.
    """

    def __init__(self, source: str, unit: RecordUnit = "feature", *, lenient: bool = False) -> None:
        self.source = source
        self.unit = unit
        self.lenient = lenient
        self._faults: dict[tuple[str, str], list[int]] = {}
        self._needed: dict[tuple[str, str], list[int]] = {}

    def add(self, number: int, what: str, advice: str, *, needed: bool = False) -> None:
        """Record an unusable feature; ``needed`` if the site must not be used without it."""
        for faults in (self._faults, self._needed) if needed else (self._faults,):
            numbers = faults.setdefault((what, advice), [])
            if number not in numbers[-1:]:
                numbers.append(number)

    def check(self) -> None:
        """Raise an error if there are unusable features that must not be skipped.

        Raises:
            SiteError: The file is rejected; the message lists the first faults with their features.
        """
        faults = self._needed if self.lenient else self._faults
        if not faults:
            return
        (what, advice), numbers = next(iter(faults.items()))
        if len(faults) == 1 and len(numbers) == 1:
            raise SiteError(what, where=f"{self.source}, {self.unit} {numbers[0]}", advice=advice)
        if len(faults) == 1:
            raise SiteError(f"{numbered(self.unit, numbers)} cannot be used: {what}", where=self.source, advice=advice)
        count = len({n for numbers in faults.values() for n in numbers})
        texts = [
            f"{numbered(self.unit, numbers)}: {what} ({advice})"
            for (what, advice), numbers in list(faults.items())[:MOST_REASONS]
        ]
        more = len(faults) - MOST_REASONS
        raise SiteError(
            f"{count} {self.unit}{'s' * (count > 1)} cannot be used: "
            + "; ".join(texts)
            + (f"; and {more} more kinds of fault" if more > 0 else ""),
            where=self.source,
            advice=self._way_out(),
        )

    def notes(self) -> list[str]:
        """Return a sentence for each of the first few reasons for which features were left out."""
        texts = [
            f"left out {numbered(self.unit, numbers)}: {what}"
            for (what, _), numbers in list(self._faults.items())[:MOST_REASONS]
        ]
        more = sum(len(numbers) for numbers in list(self._faults.values())[MOST_REASONS:])
        return [*texts, f"left out {more} more {self.unit}s that cannot be used"] if more else texts

    def _way_out(self) -> str:
        if self.lenient:
            return "correct them: keep-outs, fences and the boundary are never left out, not even with --lenient"
        return "correct or remove them, or leave them out with --lenient"


def numbered(unit: RecordUnit, numbers: Sequence[int]) -> str:
    """Return feature numbers as text: ``features 3, 4, 9, 12, 14 and 8 more``."""
    if len(numbers) == 1:
        return f"{unit} {numbers[0]}"
    shown = [str(n) for n in numbers[:_MOST_NUMBERS]]
    last = shown.pop() if len(numbers) <= _MOST_NUMBERS else f"{len(numbers) - _MOST_NUMBERS} more"
    return f"{unit}s {', '.join(shown)} and {last}"
