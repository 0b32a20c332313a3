"""Orders that came over the network, on their way to a mission: nothing else that the agent does can hold them up.

event loop ──▶ the mission's memory, at once          an order that stops a robot, or brings it home
          └──▶ threads of their own ──▶ the folder    every order; with a disk that is slow this may take its time
"""

from __future__ import annotations

import asyncio
import time
from concurrent.futures import ThreadPoolExecutor
from functools import partial

import anyio

from fieldhand.api.problems import Turned
from fieldhand.delivery.json_models import CommandRequest, Heard, mission_summary
from fieldhand.delivery.mission_store import MissionStore
from fieldhand.delivery.mission_supervisor import DirectCommand, MissionSupervisor
from fieldhand.delivery.received_missions import ReceivedMission
from fieldhand.delivery.received_status import ReceivedStatus

#: Seconds until an order that was not heard is answered, and how much longer the disk may take.
ANSWER_WITHIN_S, DISK_WITHIN_S = 5.0, 5.0
#: Orders whose threads may wait for a disk at the same time.
AT_ONCE = 16


class CommandHandler:
    """Takes orders.

    Args:
        mission_store: Where missions have arrived.
        supervisor: Who carries them out.
        answer_within_s, disk_within_s: Seconds until an order is answered that was not heard, and until one is answered
            without the disk.
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

    async def take(self, order: CommandRequest, bundle: str | None) -> Heard:
        """Take an order for a mission; for the one under way, or begun last, where none is named.

        Raises:
            Turned: There is no such mission, or its disk does not answer.
            ExecutionError: It comes too late, or another mission is under way.
        """
        if bundle is None and order.order == "start":
            raise Turned(422, "no mission is named", "name the one to start")
        reason = order.because or f"{order.order} from elsewhere"
        active = self._supervisor.under_way
        direct = None
        if active is not None and bundle in (None, active.sha256):
            direct = self._supervisor.give_direct_command(active.sha256, order.order, reason)
        with anyio.move_on_after(self._answer_s + self._disk_s):
            return await asyncio.get_running_loop().run_in_executor(
                self._threads, partial(self._keep, order, reason, bundle, active, direct)
            )
        if direct is None or active is None:
            raise Turned(503, "the robot's disk does not answer", "try again in a moment")
        return Heard(heard=direct.heard, mission=mission_summary(ReceivedStatus(received=active, state="running")))

    def _keep(
        self,
        order: CommandRequest,
        reason: str,
        bundle: str | None,
        active: ReceivedMission | None,
        direct: DirectCommand | None,
    ) -> Heard:
        """Tell the mission by its folder, too, and wait until it has heard the order."""
        until = time.monotonic() + self._answer_s

        def wait() -> bool:
            time.sleep(0.02)
            return time.monotonic() < until

        if direct is not None and active is not None:
            received = active
            heard = self._supervisor.follow(received, direct, wait=wait)
        else:
            received = self._found(bundle)
            heard = self._supervisor.give_command(received, order.order, reason, wait=wait)
        return Heard(heard=heard, mission=mission_summary(self._supervisor.status_of(received)))

    def _found(self, bundle: str | None) -> ReceivedMission:
        received = self._supervisor.latest if bundle is None else self._mission_store.find(bundle)
        if received is None:
            raise Turned(404, "no such mission has arrived" if bundle else "no mission was begun", "send it first")
        return received
