"""Word the crossing of a limit or of a battery level."""

from __future__ import annotations

from fieldhand.language import Number, message
from fieldhand.task.results import LimitCrossed


def say_crossing(event: LimitCrossed) -> str:
    """Return a sentence on the level or limit that was crossed and the robot's response."""
    what = _cleared(event) if event.cleared else _crossed(event)
    match event.then:
        case "return" if event.level == "costly_drive":
            return message("{what}: it turns to the charger", context="log", what=what)
        case "return":
            return message("{what}: it turns home", context="log", what=what)
        case "end":
            return message("{what}: it ends its mission there", context="log", what=what)
        case "stop":
            return message("{what}: it stops", context="log", what=what)
        case "go_on":
            return what


def _crossed(event: LimitCrossed) -> str:
    at = {"value": _number(event.value), "level": _number(event.threshold)}
    match (event.level, event.quantity):
        case ("warn", _):
            return message("battery at {value} %, its warning level is {level} %", context="log", **at)
        case ("return", _):
            return message("battery at {value} %, its return level is {level} %", context="log", **at)
        case ("stop", _):
            return message("battery at {value} %, its stop level is {level} %", context="log", **at)
        case ("reserve", _):
            return message("battery at {value} %, below the reserve of {level} %", context="log", **at)
        case ("way_home", "distance_m"):
            return message("{value} m are left, and the way home takes {level} m on average", context="log", **at)
        case ("way_home", "duration_s"):
            return message("{value} s are left, and the way home takes {level} s on average", context="log", **at)
        case ("way_home", "energy_percent"):
            return message(
                "{value} % of the battery may be used, and the way home takes {level} % on average", context="log", **at
            )
        case ("costly_drive", _):
            return message(
                "the drive takes far more than its length: {value} % charge above the stop level would be left at its "
                "end, and the way to the charger takes {level} % on average",
                context="log",
                **at,
            )
        case ("out_of_reach", _):
            return message(
                "{value} % charge above the stop level does not last for the way home ({level} %)", context="log", **at
            )
        case ("way_home", _):
            return message(
                "{value} % charge above the reserve, and the way home takes {level} % on average", context="log", **at
            )
        case (_, "distance_m"):
            return message("{value} m driven, the limit is {level} m", context="log", **at)
        case (_, "duration_s"):
            return message("{value} s taken, the limit is {level} s", context="log", **at)
        case _:
            return message("{value} % of the battery used, the limit is {level} %", context="log", **at)


def _cleared(event: LimitCrossed) -> str:
    return message(
        "battery at {value} % again, above {level} %",
        context="log",
        value=_number(event.value),
        level=_number(event.threshold),
    )


def _number(value: float) -> str:
    return Number(f"{value:.1f}".removesuffix(".0"))
