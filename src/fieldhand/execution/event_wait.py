"""Waiting until a watched event is over: the robot stands still, as in a pause."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

from fieldhand.execution.active_mission import LOOK_AGAIN_S, ActiveMission
from fieldhand.execution.event_monitor import EventMonitor, WatchState
from fieldhand.execution.waiting import SAME_S
from fieldhand.task.results import Waited
from fieldhand.task.watches import Fallback
from fieldhand.wording.watches import wait_limit_s


def wait_until_over(
    mission: ActiveMission,
    events: EventMonitor,
    due: WatchState,
    look: Callable[[], None],
    interrupted: Callable[[], bool],
) -> Fallback | Literal["interrupted"]:
    """Stand still until an event is over, its maximum has passed, or something interrupts the wait.

    A drive is cancelled and continued later; a capture is finished. The controller stays paused: the caller ends that.

    Args:
        mission: The mission.
        events: Its monitor.
        due: The watch that demands the wait.
        look: Checks limits and events after time has passed.
        interrupted: Returns True if the wait ends for another reason.

    Returns:
        ``go_on`` if the event is over, its fallback after the maximum, or ``interrupted``.
    """
    begun_s, limit_s = mission.t, wait_limit_s(due.watch, mission.robot)
    outcome: Fallback | Literal["interrupted"] = "go_on"
    while events.holds(due):
        mission.controller.pause()  # again after an operator's pause, whose end has ended this one
        mission.attend()
        left_s = begun_s + limit_s - mission.t
        if left_s <= SAME_S:
            outcome = due.watch.fallback
            break
        soon = mission.observation.next_in
        mission.clock.advance(min(left_s, LOOK_AGAIN_S, LOOK_AGAIN_S if soon is None else soon))
        look()
        if interrupted():
            outcome = "interrupted"
            break
    node = "" if mission.doing is None else mission.doing.node
    over, seconds = not events.holds(due), mission.t - begun_s
    mission.emit(Waited(t=mission.t, node=node, wanted="event", seconds=seconds, over=over, what=due.why))
    return outcome
