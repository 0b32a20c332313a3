"""Times in a request: when a mission begins, and when a standing one runs again."""

from fieldhand.planning.grammar.times.reading import (
    RequestTimes,
    asked_time,
    assumed_times,
    warned_times,
    with_answers,
    without_times,
)

__all__ = ["RequestTimes", "asked_time", "assumed_times", "warned_times", "with_answers", "without_times"]
