"""Monitor of the events that a mission watches, at every poll of the robot.

A watched condition begins to hold at once, and is over when it has not held for the time that the profile sets. Both
are logged. Each occurrence causes its response once; a visit is also left out if the condition still holds when the
robot arrives there.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from fieldhand.execution.active_mission import ActiveMission
from fieldhand.task.plan import actions_of
from fieldhand.task.results import Acted, EventBegan, EventEnded
from fieldhand.task.watches import PRIORITY, EventAbsent, EventBeyond, EventHolds, ReadingBeyond, Watch, exceeds
from fieldhand.wording.watches import say_held, say_watched, slow_limit_m_s


@dataclass(kw_only=True)
class WatchState:
    """State of one watch.

    Attributes:
        number: Position in the Task, from 1.
        began_s: Mission time at which the condition began to hold; None while it does not.
        free_since_s: Mission time since which it has not held, while it counts as holding.
        answered: The response to this occurrence was given.
        why: Condition in words, as it began to hold.
    """

    watch: Watch
    number: int
    began_s: float | None = None
    free_since_s: float | None = None
    answered: bool = False
    why: str = ""

    @property
    def skips(self) -> bool:
        """True if the response is to leave out visits."""
        return self.watch.response in ("skip", "skip_row")


class EventMonitor:
    """Event monitor of one mission.

    Args:
        mission: The mission.
    """

    def __init__(self, mission: ActiveMission) -> None:
        self._mission = mission
        self._states = [
            WatchState(watch=watch, number=number)
            for number, watch in enumerate(mission.task.composition.watches, start=1)
        ]
        self._read = 0
        self._readings: dict[str, float] = {}

    def look(self) -> None:
        """Check all conditions, and record which began to hold and which are over."""
        if not self._states:
            return
        self._note_readings()
        for state in self._states:
            holds, value = self._test(state.watch)
            if not holds:
                self._free(state)
            else:
                state.free_since_s = None
                if state.began_s is None:
                    self._begin(state, value)

    def due(self, *, visiting: bool, arrived: bool) -> WatchState | None:
        """Return the strongest watch whose response is due; None if there is none.

        Args:
            visiting: True during a visit, which can be left out.
            arrived: True if the robot has arrived at the place of that visit.
        """
        found = [s for s in self._states if s.began_s is not None and self._is_due(s, visiting, arrived)]
        return min(found, key=lambda s: PRIORITY.index(s.watch.response), default=None)

    @property
    def speed_m_s(self) -> float:
        """The highest driving speed that the conditions which hold now allow; infinite without one."""
        slow = (s.watch for s in self._states if s.began_s is not None and s.watch.response == "slow")
        return min((slow_limit_m_s(watch, self._mission.robot) for watch in slow), default=math.inf)

    def holds(self, state: WatchState) -> bool:
        """Return True while a watched condition counts as holding."""
        return state.began_s is not None

    def stronger(self, state: WatchState) -> bool:
        """Return True if a response with a higher priority than that of a watch is due."""
        due = self.due(visiting=False, arrived=False)
        return due is not None and PRIORITY.index(due.watch.response) < PRIORITY.index(state.watch.response)

    @staticmethod
    def _is_due(state: WatchState, visiting: bool, arrived: bool) -> bool:
        if state.watch.response not in PRIORITY:
            return False
        if state.skips:
            return visiting and (arrived or not state.answered)
        return not state.answered

    def _test(self, watch: Watch) -> tuple[bool, float | None]:
        """Return whether the condition of a watch holds now, and the value; outside of its part it does not."""
        if watch.during and not self._is_under_way(watch.during):
            return False, None
        match watch.condition:
            case EventHolds(event=name):
                value, event = self._mission.observation.events.get(name), self._mission.robot.event[name]
                return (event.unless_heard == "holds" if value is None else event.holds(value)), value
            case EventAbsent(event=name):
                value, event = self._mission.observation.events.get(name), self._mission.robot.event[name]
                return (event.unless_heard == "holds" if value is None else not event.holds(value)), value
            case EventBeyond(event=name, test=test, value=limit):
                value, event = self._mission.observation.events.get(name), self._mission.robot.event[name]
                return (event.unless_heard == "holds" if value is None else exceeds(test, value, limit)), value
            case ReadingBeyond(quantity=quantity, test=test, value=limit):
                value = self._readings.get(quantity)
                return value is not None and exceeds(test, value, limit), value

    def _is_under_way(self, action: str) -> bool:
        """Return True while a step that does an action is under way, or a loop around such steps."""
        nodes = (frame.node for frame in self._mission.run.frames)
        parts = (n for n in nodes if n.visits_each or n.rounds is not None or n.act is not None or n.work is not None)
        return any(action in actions_of(part) for part in parts)

    def _note_readings(self) -> None:
        """Take the readings of the captures since the last check."""
        events = self._mission.events
        for event in events[self._read :]:
            if isinstance(event, Acted):
                self._readings.update(event.readings)
        self._read = len(events)

    def _free(self, state: WatchState) -> None:
        """Record that a condition does not hold; it is over once that has lasted."""
        if state.began_s is None:
            return
        now = self._mission.t
        if state.free_since_s is None:
            state.free_since_s = now
        if now - state.free_since_s < self._clear_s(state.watch):
            return
        mission, robot = self._mission, self._mission.robot
        mission.emit(
            EventEnded(
                t=now,
                node=self._node,
                watch=state.number,
                name=_name(state.watch),
                seconds=state.free_since_s - state.began_s,
                what=say_watched(state.watch, robot),
            )
        )
        state.began_s, state.free_since_s, state.answered = None, None, False

    def _begin(self, state: WatchState, value: float | None) -> None:
        mission, at, watch = self._mission, self._mission.observation.position, state.watch
        state.began_s, state.answered, state.why = mission.t, False, say_held(watch, mission.robot, value)
        mission.emit(
            EventBegan(
                t=mission.t,
                node=self._node,
                watch=state.number,
                name=_name(watch),
                response=watch.response,
                value=value,
                unit="" if isinstance(watch.condition, EventHolds | EventAbsent) else watch.condition.unit,
                what=state.why,
                lat=at.lat,
                lon=at.lon,
                travelled_m=mission.spent.metres,
                charge_percent=mission.charge_percent(),
            )
        )

    def _clear_s(self, watch: Watch) -> float:
        condition = watch.condition
        return 0.0 if isinstance(condition, ReadingBeyond) else self._mission.robot.event[condition.event].clear_s

    @property
    def _node(self) -> str:
        return "" if self._mission.doing is None else self._mission.doing.node


def _name(watch: Watch) -> str:
    condition = watch.condition
    return condition.quantity if isinstance(condition, ReadingBeyond) else condition.event
