"""Commands from the network to a mission, which no other work of the agent delays.

event loop ──▶ the mission's memory, at once          commands that stop the robot or call it back
          └──▶ threads of their own ──▶ the folder    all commands; a slow disk delays only this path
"""

from __future__ import annotations

import asyncio
import time
from concurrent.futures import ThreadPoolExecutor
from functools import partial

import anyio

from fieldhand.api.problems import RefusedRequest
from fieldhand.delivery.json_models import CommandRequest, CommandResponse, mission_summary
from fieldhand.delivery.mission_store import MissionStore
from fieldhand.delivery.mission_supervisor import DirectCommand, MissionSupervisor
from fieldhand.delivery.received_missions import ReceivedMission
from fieldhand.delivery.received_status import ReceivedStatus

#: Seconds to wait until the mission receives a command, and further seconds for the disk.
ANSWER_WITHIN_S, DISK_WITHIN_S = 5.0, 5.0
#: Number of threads for commands that wait for the disk.
AT_ONCE = 16


class CommandHandler:
    """Handler of commands to missions.

    Args:
        mission_store: Missions that were received.
        supervisor: Supervisor that carries them out.
        answer_within_s: Seconds to wait until the mission receives a command.
        disk_within_s: Further seconds to wait for the disk.
    """

    def __init__(
        self,
        mission_store: MissionStore,
        supervisor: MissionSupervisor,
        *,
        answer_within_s: float = ANSWER_WITHIN_S,
        disk_within_s: float = DISK_WITHIN_S,
    ) -> None:
        self._mission_store, self._supervisor = mission_store, supervisor
        self._answer_s, self._disk_s = answer_within_s, disk_within_s
        self._threads = ThreadPoolExecutor(AT_ONCE, thread_name_prefix="order")

    async def take(self, order: CommandRequest, bundle: str | None) -> CommandResponse:
        """Pass a command to a mission; by default, to the running one, else to the one begun last.

        Raises:
            RefusedRequest: There is no such mission, or the disk does not respond.
            ExecutionError: The command comes too late, or another mission is running.
        """
        if bundle is None and order.order in ("start", "cancel"):
            raise RefusedRequest(422, "no mission is named", f"name the mission to {order.order}")
        if order.due is not None and order.order != "cancel":
            raise RefusedRequest(422, "only cancel names a run", "leave 'due' out")
        reason = order.because or f"{order.order} from elsewhere"
        active = self._supervisor.under_way
        direct = None
        if active is not None and bundle in (None, active.sha256):
            direct = self._supervisor.give_direct_command(active.sha256, order.order, reason)
        with anyio.move_on_after(self._answer_s + self._disk_s):
            return await asyncio.get_running_loop().run_in_executor(
                self._threads, partial(self._write_command, order, reason, bundle, active, direct)
            )
        if direct is None or active is None:
            raise RefusedRequest(503, "the robot's disk does not answer", "try again in a moment")
        return CommandResponse(
            heard=direct.heard, mission=mission_summary(ReceivedStatus(received=active, state="running"))
        )

    def _write_command(
        self,
        order: CommandRequest,
        reason: str,
        bundle: str | None,
        active: ReceivedMission | None,
        direct: DirectCommand | None,
    ) -> CommandResponse:
        """Write the command to the mission's folder, and wait until the mission receives it."""
        until = time.monotonic() + self._answer_s

        def wait() -> bool:
            time.sleep(0.02)
            return time.monotonic() < until

        if direct is not None and active is not None:
            received = active
            heard = self._supervisor.follow(received, direct, wait=wait)
        elif order.due is not None:
            received = self._supervisor.timetables.skip(self._received(bundle), order.due, reason)
            heard = True
        else:
            received = self._received(bundle)
            heard = self._supervisor.give_command(received, order.order, reason, wait=wait)
        return CommandResponse(heard=heard, mission=mission_summary(self._supervisor.status_of(received)))

    def _received(self, bundle: str | None) -> ReceivedMission:
        received = self._supervisor.latest if bundle is None else self._mission_store.find(bundle)
        if received is None:
            raise RefusedRequest(
                404, "no such mission has arrived" if bundle else "no mission has been started", "send it first"
            )
        return received
