"""The progress of a mission: where it is, what is done, what is left."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from fieldhand.evaluation.outcome import judge, judge_end
from fieldhand.language import message
from fieldhand.language.words import say_near, say_place
from fieldhand.robot.model import RobotProfile
from fieldhand.task.exceeded import Exceeded
from fieldhand.task.frames import Task
from fieldhand.task.results import (
    Acted,
    Arrived,
    Continued,
    Driving,
    Ended,
    Event,
    Exited,
    GoalOutcome,
    InDoubt,
    LimitCrossed,
    Paused,
    Resumed,
    Started,
    Worked,
)
from fieldhand.wording.events import EventText, noun

_CHARGED = Started | Arrived | Acted | Worked | InDoubt | Resumed | LimitCrossed | Ended

ProgressState = Literal["running", "paused", "interrupted", "ended"]


@dataclass(frozen=True, kw_only=True)
class MissionProgress:
    """The progress of a mission.

    Attributes:
        doing: Current or last activity in words.
        place: The place that it is at or drives to; empty before the first.
        near: The same in words: "at tree 12", "on the way to the end".
        lat, lon: Last logged position; None before the beginning.
        captures: Successful captures.
        in_doubt: Captures that a power cut left in doubt.
        goals: Each goal, as far as it is known.
        limits: Limits of the Task by kind of budget.
        status, reason: Final status and its reason.
        exceeded: Limits that it exceeded so far.
    """

    state: ProgressState
    doing: str
    node: str
    place: str
    near: str
    lat: float | None
    lon: float | None
    seconds: float
    travelled_m: float
    charge_percent: float | None
    captures: int
    in_doubt: int
    goals: tuple[GoalOutcome, ...]
    limits: dict[str, float]
    events: int
    status: str = ""
    reason: str = ""
    exceeded: tuple[Exceeded, ...] = ()


def mission_progress(task: Task, robot: RobotProfile, events: Sequence[Event], *, running: bool) -> MissionProgress:
    """Return the progress of a mission.

    Args:
        task, robot: The mission's Task and robot.
        events: Events on the disk.
        running: True if a process carries it out.
    """
    last = events[-1] if events else None
    state, ended = state_of(events, running=running)
    at = next((e for e in reversed(events) if isinstance(e, Started | Arrived | Resumed | LimitCrossed | Ended)), None)
    to = next((e for e in reversed(events) if isinstance(e, Arrived | Driving)), None)
    charged = [e.charge_percent for e in events if isinstance(e, _CHARGED)]
    driven = [e.travelled_m for e in events if isinstance(e, Arrived | Worked | LimitCrossed | Ended)]
    status, reason, found = judge_end(task, events, robot.energy.reserve_percent)
    return MissionProgress(
        state=state,
        doing=_doing(robot, last, task),
        node=next((e.node for e in reversed(events) if e.node), ""),
        place=to.place if to is not None else "",
        near="" if to is None else say_near(to.kind, to.place, arrived=isinstance(to, Arrived)),
        lat=at.lat if at is not None else None,
        lon=at.lon if at is not None else None,
        seconds=last.t if last is not None else 0.0,
        travelled_m=driven[-1] if driven else 0.0,
        charge_percent=charged[-1] if charged else None,
        captures=sum(isinstance(e, Acted) and e.status == "success" for e in events),
        in_doubt=sum(isinstance(e, InDoubt) for e in events),
        goals=judge(task, events, under_way=ended is None),
        limits={b.kind: b.limit for b in task.constraints.budgets},
        events=len(events),
        status=status or "",
        reason=reason,
        exceeded=found,
    )


def state_of(events: Sequence[Event], *, running: bool) -> tuple[ProgressState, Ended | None]:
    """Return the state of a mission, and its end if it has ended.

    Args:
        events: Those that are safe; of them are needed ends, exits, and the beginnings and ends of pauses.
        running: True if a process carries it out.
    """
    last = events[-1] if events else None
    if isinstance(last, Ended):
        return "ended", last
    turn = next((e for e in reversed(events) if isinstance(e, Paused | Continued | Exited)), None)
    if not running:
        return "interrupted", None
    return ("paused" if isinstance(turn, Paused) else "running"), None


def _doing(robot: RobotProfile, last: Event | None, task: Task) -> str:
    match last:
        case None:
            return message("nothing yet")
        case Driving():
            return message("drives to {place}", place=say_place(last.kind, last.place, last.side))
        case Arrived():
            action = next((g.action for g in task.command.goals if g.node == last.node), None)
            if action is None:
                return say_near(last.kind, last.place, arrived=True)
            place = say_place(last.kind, last.place, last.side)
            return message("{capture} at {place}", capture=noun(robot, action), place=place)
        case _:
            return EventText(robot).brief(last)
