"""A plan as one readable line, for tests: ``for Corners: [picture x2; co2 = r1; if r1 co2 low: [picture]]``."""

from __future__ import annotations

from dataclasses import fields

from fieldhand.places import selectors as s
from fieldhand.places.earlier.period import Period
from fieldhand.task import conditions as c
from fieldhand.task import plan as p
from fieldhand.task.aggregates import Aggregate, CompareSeries, CountReadings, MeanKnown
from fieldhand.task.battery_condition import BatteryBelow
from fieldhand.task.frames import Constraints, Task
from fieldhand.task.timing import DayTime, Schedule, StartTime
from fieldhand.task.watches import EventAbsent, EventBeyond, EventHolds, ReadingBeyond, Watch

SHORT = {"take_thermal_picture": "picture", "take_picture": "picture", "read_co2": "co2"}
SHORT |= {"read_ambient_temperature": "air", "read_soil_moisture": "moisture", "read_soil_nitrate": "nitrate"}
SIGNS = {"lt": "<", "le": "<=", "gt": ">", "ge": ">=", "eq": "=", "ne": "!="}


def outline(task: Task) -> str:
    """The plan of a Task, its limits and its exit where it is not the usual one."""
    limits = "".join(f" | {b.kind} {b.limit:g}" for b in task.constraints.budgets)
    if task.constraints.reserve_percent is not None:
        limits += f" | reserve {task.constraints.reserve_percent:g}"
    if task.constraints.speed_m_s is not None:
        limits += f" | speed {task.constraints.speed_m_s:g}"
    for avoid in task.constraints.avoid:
        limits += f" | avoid {selector(avoid.places)}" + (f" {avoid.distance_m:g} m" if avoid.distance_m else "")
    limits += "".join(f" | only {only.gate}" for only in task.constraints.only_gates)
    for slow in task.constraints.slow:
        limits += f" | slow {selector(slow.places)}" + (f" {slow.distance_m:g} m" if slow.distance_m else "")
        limits += f" at {slow.speed_m_s:g} m/s" if slow.speed_m_s else ""
    if task.constraints.recharge:
        limits += f" | recharge{_charge(task.constraints)}"
    exit_ = "" if task.composition.nominal == "return_to_end" else f" | {task.composition.nominal}"
    times = "" if task.timing is None else " | " + " ".join(timing(task.timing))
    watches = "".join(f" | at any time {watch(one)}" for one in task.composition.watches)
    return node(task.composition.plan) + limits + times + exit_ + watches


def timing(when: StartTime | Schedule) -> list[str]:
    """The fields of a timing that are not their defaults."""
    said = []
    for field in fields(when):
        value = getattr(when, field.name)
        if field.name in ("said", "time_zone") or value == field.default:
            continue
        many = value if isinstance(value, tuple) else (value,)
        said.append(f"{field.name}={','.join(day_time(v) if isinstance(v, DayTime) else str(v) for v in many)}")
    return said


def day_time(at: DayTime) -> str:
    """A time of day."""
    if at.sun is None:
        return at.clock
    return f"{at.sun}{at.offset_min:+g}" if at.offset_min else at.sun


def watch(one: Watch) -> str:
    """What is watched, the response, and after a wait its minutes and what follows."""
    match one.condition:
        case EventHolds(event=name):
            what = name
        case EventAbsent(event=name):
            what = f"not {name}"
        case EventBeyond(event=name, test=test, value=value, unit=unit):
            what = f"{name} {SIGNS[test]} {value:g} {unit}"
        case ReadingBeyond(quantity=name, test=test, value=value, unit=unit):
            what = f"{name} {SIGNS[test]} {value:g} {unit}"
    if one.during:
        what = f"while {SHORT.get(one.during, one.during)}: {what}"
    if one.speed_m_s is not None:
        return f"{what}: {one.response} {one.speed_m_s:g}"
    if one.response != "wait":
        return f"{what}: {one.response}"
    most = "" if one.at_most_s is None else f" {one.at_most_s / 60:g} min"
    return f"{what}: wait{most}, then {one.fallback}"


def _charge(limits: Constraints) -> str:
    below, until, most = limits.recharge_below_percent, limits.recharge_until_percent, limits.recharge_at_most
    said = ("" if below is None else f" below {below:g}") + ("" if until is None else f" to {until:g}")
    return said + ("" if most is None else f" at most {most}")


def node(n: p.Node) -> str:
    """One node with all inside it."""
    match n:
        case p.Act():
            times = f" x{n.count}" if n.count > 1 else ""
            at = f" @ {selector(n.at)}" if n.at is not None else ""
            values = ", ".join(
                f"{name} {value:g}" if isinstance(value, float) else f"{name} {value}" for name, value in n.parameters
            )
            with_ = f"({values})" if values else ""
            return f"{SHORT.get(n.action, n.action)}{with_}{times}{at}" + (f" = {n.reading}" if n.reading else "")
        case p.GoTo():
            return f"go {selector(n.place)}"
        case p.ForEach():
            how = (" given" if n.order == "given" else "") + (" optional" if n.optional else "")
            how += f" {n.reward_by} {n.reward} first" if n.reward_by != "value" else ""
            how += f" at most {n.at_most}" if n.at_most else ""
            how += f" until {condition(n.until)}" if n.until else ""
            return f"for {selector(n.select)}{how}: [{node(n.body)}]"
        case p.If():
            other = "" if n.otherwise is None else f" else [{node(n.otherwise)}]"
            return f"if {condition(n.condition)}: [{node(n.then)}]{other}"
        case p.Repeat():
            until = f" until {condition(n.until)}" if n.until else ""
            return f"{n.times} times{until}: [{node(n.body)}]"
        case p.Try():
            return f"try [{node(n.body)}] or [{node(n.otherwise)}]"
        case p.OptionalStep():
            return f"maybe [{node(n.body)}]"
        case p.AnyOrder():
            return "any order: [" + "; ".join(node(step) for step in n.steps) + "]"
        case p.InOrder():
            return "; ".join(node(step) for step in n.steps)
        case p.Recharge():
            to = "" if n.until_percent is None else f" to {n.until_percent:g}"
            return f"recharge{to}" + ("" if n.duration_s is None else f" for {n.duration_s:g} s")
        case p.StopMission():
            return "stop"
        case p.Wait():
            return f"wait {n.seconds:g}"
        case p.Pace():
            return f"at {n.speed_m_s:g} m/s: [{node(n.body)}]"
        case p.WorkAlong():
            how = "".join(
                f", {name} {value:g}" if isinstance(value, float) else f", {name} {value}"
                for name, value in n.parameters
            )
            how += f", {n.sides}" if n.sides != "one" else ""
            how += f", every {n.every}" if n.every != 1 else ""
            how += f", heading {n.heading}" if n.heading != "any" else ""
            how += f", {n.laps} laps" if n.laps != 1 else ""
            how += ", optional" if n.optional else ""
            return f"{n.action or 'drive'} {n.mode} {selector(n.along)}{how}"
        case _:
            raise AssertionError(n)


def selector(x: s.Selector) -> str:
    """A selector, its defaults left out."""
    said = []
    for f in fields(x):
        value = getattr(x, f.name)
        if value == f.default:
            continue
        if isinstance(value, s.Selector):
            value = selector(value)
        elif isinstance(value, tuple):
            value = "+".join(selector(v) if isinstance(v, s.Selector) else str(v) for v in value)
        elif isinstance(value, float):
            value = f"{value:g}"
        elif isinstance(value, Period):
            value = " ".join(
                f"{part.name.removeprefix('last_')} {getattr(value, part.name)}"
                for part in fields(value)
                if getattr(value, part.name) != part.default
            )
        said.append(f"of {value}" if f.name == "of" else str(value))
    return f"{type(x).__name__}({', '.join(said)})" if said else type(x).__name__


def condition(x: c.Condition) -> str:
    """A condition."""
    match x:
        case c.Compare():
            return f"{x.reading} {SIGNS[x.test]} {x.value:g} {x.unit}"
        case c.Between():
            return f"{x.low:g} <= {x.reading} <= {x.high:g} {x.unit}"
        case c.Level():
            return f"{x.reading} {x.level}"
        case BatteryBelow():
            return f"battery <= {x.percent:g}"
        case c.TreeHas():
            value = f"{x.value:g}" if isinstance(x.value, float) else x.value
            return f"{x.attribute} {SIGNS[x.test]} {value}"
        case Aggregate():
            return f"{x.of}({condition(x.condition)})"
        case CountReadings():
            return f"count({condition(x.condition)}) {SIGNS[x.test]} {x.number:g}{' %' if x.percent else ''}"
        case MeanKnown():
            width = f"{x.percent:g} %" if x.percent else f"{x.value:g} {x.unit}"
            return f"mean({x.reading}) +- {width} from {x.at_least}"
        case CompareSeries():
            by = f" + {x.value:g} {x.unit}" if x.value else ""
            return f"{x.of}({x.reading}) {SIGNS[x.test]} {x.of}({x.than}){by}"
        case c.Not():
            return f"not {condition(x.condition)}"
        case c.AllOf():
            return " and ".join(condition(i) for i in x.conditions)
        case c.AnyOf():
            return " or ".join(condition(i) for i in x.conditions)
