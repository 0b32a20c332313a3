"""Parts of the day as windows: "in the morning" is from sunrise to noon, and a day without a time is its daylight."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from fieldhand.language import message
from fieldhand.task.timing import DayTime
from fieldhand.wording.timing import say_day_time

#: Part of the day that an hour of 12 is in; the night has hours of both halves.
Half = Literal["", "am", "pm", "night"]


@dataclass(frozen=True, kw_only=True, slots=True)
class DayWindow:
    """A part of the day.

    Attributes:
        part: Its name.
        begin, end: Its bounds.
    """

    part: str
    begin: DayTime
    end: DayTime

    @property
    def half(self) -> Half:
        """The part of the day that its hours are in; empty for the whole day."""
        if self.part in ("day", "night"):
            return "night" if self.part == "night" else ""
        return "am" if "morning" in self.part else "pm"

    def until(self, end: DayTime) -> DayWindow | None:
        """Return its part before another time; None if that lies outside of it."""
        first, last = _hour(self.begin), _hour(self.end)
        inside = first < _hour(end) <= last if first < last else _hour(end) > first or _hour(end) <= last
        return DayWindow(part=self.part, begin=self.begin, end=end) if inside else None

    @property
    def assumption(self) -> str:
        """The sentence that states it in the plan."""
        return message(
            "Takes place {when}, from {begin} to {end}.",
            context="assumption",
            when=_WORDS[self.part],
            begin=say_day_time(self.begin),
            end=say_day_time(self.end),
        )

    @property
    def choice(self) -> str:
        """The answer that stands for it."""
        begin, end = say_day_time(self.begin), say_day_time(self.end)
        return message("{when}, from {begin} to {end}", when=_WORDS[self.part], begin=begin, end=end)


#: Words for the parts of the day, in the form that follows a verb.
_WORDS = {
    "early morning": message("early in the morning"),
    "morning": message("in the morning"),
    "late morning": message("late in the morning"),
    "early afternoon": message("early in the afternoon"),
    "afternoon": message("in the afternoon"),
    "late afternoon": message("late in the afternoon"),
    "evening": message("in the evening"),
    "night": message("at night"),
    "day": message("by day"),
}
_SUNRISE, _SUNSET = DayTime(sun="sunrise"), DayTime(sun="sunset")
_BOUNDS = {
    "early morning": (_SUNRISE, DayTime(sun="sunrise", offset_min=180)),
    "morning": (_SUNRISE, DayTime(clock="12:00")),
    "late morning": (DayTime(clock="10:00"), DayTime(clock="12:00")),
    "early afternoon": (DayTime(clock="12:00"), DayTime(clock="15:00")),
    "afternoon": (DayTime(clock="12:00"), DayTime(clock="18:00")),
    "late afternoon": (DayTime(clock="15:00"), DayTime(clock="18:00")),
    "evening": (DayTime(clock="18:00"), DayTime(clock="22:00")),
    "night": (DayTime(sun="dusk"), DayTime(sun="dawn")),
    "day": (_SUNRISE, _SUNSET),
}
#: The parts of the day, by their names.
WINDOWS = {part: DayWindow(part=part, begin=begin, end=end) for part, (begin, end) in _BOUNDS.items()}
#: The time at which a mission takes place of which only the days are said: the robot works at night only if told to.
DAYLIGHT = WINDOWS["day"]


def without_a_time() -> str:
    """Return what is assumed if only the days are said, as a sentence."""
    return message(
        "No time of the day is said: takes place by day, from {begin} to {end}.",
        context="assumption",
        begin=say_day_time(DAYLIGHT.begin),
        end=say_day_time(DAYLIGHT.end),
    )


def contradicts(at: DayTime, half: Half) -> bool:
    """Return True for a time that lies in another part of the day, such as sunset in the morning."""
    if not half:
        return False
    if half == "night":
        return at.sun is None and "09:00" <= at.clock < "16:00"
    if at.sun is None:
        return (at.clock < "12:00") != (half == "am")
    rises = at.sun in ("dawn", "sunrise")
    return abs(at.offset_min) <= 240 and rises != (half == "am")


def _hour(at: DayTime) -> float:
    """Return the hour of the day of a time; that of the sun is about right, in no season by much."""
    if at.sun is None:
        return int(at.clock[:2]) + int(at.clock[3:]) / 60
    return {"dawn": 5.5, "sunrise": 6.0, "sunset": 18.0, "dusk": 18.5}[at.sun] + at.offset_min / 60
