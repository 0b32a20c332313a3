"""Waiting for a navigation that was restarted, and while another client drives the robot; ends of drives for which the
drive itself is no reason.
"""

from __future__ import annotations

from fieldhand.errors import DriveFault
from fieldhand.execution.active_mission import ActiveMission
from fieldhand.execution.drivers.protocol import Progress
from fieldhand.execution.waiting import wait, wait_for_position
from fieldhand.language import joined, message
from fieldhand.task.results import Continued, Faulted, Paused, Waited
from fieldhand.task.run import Steps

#: Least seconds before an interrupted drive is tried again.
_AGAIN_S = 2.0
#: Metres that a drive must lead on for its interruption not to count as one in vain.
_ON_M = 1.0
#: Largest number of interruptions of one drive.
_MOST = 20


def wait_for_robot(mission: ActiveMission, node: str) -> Steps:
    """Wait until a drive can begin: for the position, for the navigation, and while another client drives the robot.

    Raises:
        LostFault: The position is still unknown.
        DriveFault: The navigation still cannot be used.
    """
    yield from wait_for_position(mission, node)
    yield from _wait_for_navigation(mission, node)
    if mission.observation.taken is not None:
        yield from _wait_for_others(mission, mission.observation.taken)
        yield from wait_for_position(mission, node)
        yield from _wait_for_navigation(mission, node)


def _wait_for_navigation(mission: ActiveMission, node: str) -> Steps:
    """Wait for a navigation that cannot be used, as long as the profile allows; while the mission is halted, for ever.

    Raises:
        DriveFault: It still cannot be used.
    """
    while mission.halted:
        yield
    why = mission.observation.away
    if why is None:
        return
    begun_s, patience = mission.clock.now(), mission.robot.patience.navigation_wait_s
    what = message("the robot's navigation is not ready ({why})", context="log", why=why)
    most = message("it is waited for at most {seconds} s", context="log", seconds=f"{patience:g}")
    mission.emit(Faulted(t=mission.t, node=node, fault="navigation", what=joined("; ", (what, most)), handled=True))
    yield from wait(mission, patience, over=lambda: mission.observation.away is None)
    still, waited_s = mission.observation.away, mission.clock.now() - begun_s
    over = still is None
    mission.emit(Waited(t=mission.t, node=node, wanted="navigation", seconds=waited_s, over=over, what=still or why))
    if still is not None:
        raise DriveFault(
            message(
                "the robot's navigation was not ready within {seconds} s ({why})",
                context="log",
                seconds=f"{patience:g}",
                why=still,
            ),
            advice=message("check whether Nav2 is active on the robot", context="log"),
        )


def _wait_for_others(mission: ActiveMission, why: str) -> Steps:
    """Pause while another client drives the robot, as long as the profile says or until an operator ends the pause.

    Then the mission takes the robot back, wherever it is.
    """
    before, patience = mission.observation.order, mission.robot.patience.taken_wait_s
    most = message("the mission goes on in {seconds} s, or when it is resumed", context="log", seconds=f"{patience:g}")
    mission.emit(Paused(t=mission.t, reason=joined("; ", (why, most))))

    def over() -> bool:
        order = mission.observation.order
        return mission.observation.taken is None or (
            order is not None and order.wanted == "continue" and order != before
        )

    yield from wait(mission, patience, over=over)
    mission.emit(Continued(t=mission.t))
    mission.stands_anew()


class Interruptions:
    """Interruptions of one drive, of which those in vain are limited by the profile's ``retries``.

    Args:
        mission: The mission.
        node: Id of the node.
    """

    def __init__(self, mission: ActiveMission, node: str) -> None:
        self._mission, self._node = mission, node
        self._in_vain = self._count = 0

    def note(self, progress: Progress, what: str) -> Steps:
        """Record an interruption, and wait before the drive is tried again.

        Args:
            progress: End of the drive.
            what: Description of the drive and the reason.

        Raises:
            DriveFault: There were too many.
        """
        mission = self._mission
        self._count += 1
        self._in_vain = 0 if progress.metres >= _ON_M else self._in_vain + 1
        if self._in_vain > mission.robot.retries or self._count > _MOST:
            times = message("interrupted {count} times", context="log", count=self._count)
            raise DriveFault(joined("; ", (what, times)) if self._count > 1 else what)
        again = joined("; ", (what, message("trying again", context="log")))
        mission.emit(Faulted(t=mission.t, node=self._node, fault="interrupted", what=again, handled=True))
        yield from wait(mission, max(_AGAIN_S, mission.robot.patience.retry_wait_s))
