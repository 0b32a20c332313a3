"""Days in words of a Task: today, tomorrow, a weekday, or a date with or without its year."""

from __future__ import annotations

import re
from collections.abc import Iterator
from datetime import date, timedelta

from fieldhand.compatibility import date_from_iso
from fieldhand.errors import TaskError
from fieldhand.language import message
from fieldhand.task.timing import WEEKDAYS

_YEARLY = re.compile(r"--(\d\d)-(\d\d)")


def day_of(words: str, approved: date) -> date:
    """Return the day that is meant by words of a Task.

    Args:
        words: As in :attr:`fieldhand.task.timing.StartTime.day`.
        approved: Day of approval, from which relative days count.

    Raises:
        TaskError: The words name no day.
    """
    if words in ("", "today"):
        return approved
    if words == "tomorrow":
        return approved + timedelta(days=1)
    if words in WEEKDAYS:
        return approved + timedelta(days=(WEEKDAYS.index(words) - approved.weekday() - 1) % 7 + 1)
    try:
        if words.startswith("+"):
            return approved + timedelta(days=int(words[1:]))
        yearly = _YEARLY.fullmatch(words)
        if yearly is None:
            return date_from_iso(words)
        month, day = (int(part) for part in yearly.groups())
        return next(_dates(approved, month, day))
    except (OverflowError, ValueError, StopIteration):
        raise TaskError(
            message("{day} is no day", day=repr(words)),
            advice=message("write 'today', 'tomorrow', 'mon' to 'sun', or a date such as 2027-03-01"),
        ) from None


def _dates(approved: date, month: int, day: int) -> Iterator[date]:
    for year in range(approved.year, approved.year + 9):
        try:
            found = date(year, month, day)
        except ValueError:  # 29 February
            continue
        if found >= approved:
            yield found
