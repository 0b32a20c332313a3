"""Routes of the agent. A mission is identified by its SHA-256, so that no request contains a file name."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Annotated

import anyio
from fastapi import APIRouter, Path, Query, Request, Response
from starlette.concurrency import run_in_threadpool

from fieldhand import __version__
from fieldhand.agent.command_handler import CommandHandler
from fieldhand.agent.uploads import UploadLimits, UploadSlots, receive, size_of
from fieldhand.api.problems import RefusedRequest
from fieldhand.delivery.json_models import (
    LONGEST_WAIT_S,
    MOST_EVENTS,
    CommandRequest,
    CommandResponse,
    Events,
    Receipt,
    RobotState,
    Runs,
    event_lines,
    mission_summary,
    run_summary,
)
from fieldhand.delivery.mission_store import MissionStore
from fieldhand.delivery.mission_supervisor import MissionSupervisor
from fieldhand.delivery.received_missions import ReceivedMission
from fieldhand.delivery.received_status import LoggedEvent
from fieldhand.delivery.timetable_keeper import NEXT_LISTED

#: Number of missions that are listed.
LISTED = 50
#: Seconds between two reads of a journal.
LOOK_S = 0.2

BundleHash = Annotated[str, Path(pattern=r"^[0-9a-f]{64}$")]
ImageName = Annotated[str, Path(pattern=r"^[A-Za-z0-9_-]{1,150}\.(png|jpg|tif)$")]


@dataclass(frozen=True, kw_only=True)
class RobotIdentity:
    """The identity of a robot, and the sites on which it may work.

    Attributes:
        robot: Name of the robot.
        robot_sha256: SHA-256 of its profile.
        sites: Names of the sites; empty for any.
        on: Driver of its missions.
        missing: Returns the parts of the robot that do not respond, in words; none in simulation.
    """

    robot: str
    robot_sha256: str
    sites: tuple[str, ...]
    on: str = "simulation"
    missing: Callable[[], tuple[str, ...]] = tuple


def router(
    mission_store: MissionStore, supervisor: MissionSupervisor, who: RobotIdentity, uploads: UploadLimits
) -> APIRouter:
    """Return all routes of the agent."""
    routes = APIRouter()
    entrance, orders = UploadSlots(uploads.at_once), CommandHandler(mission_store, supervisor)

    @routes.get("/agent")
    def robot() -> RobotState:
        """Return the state of the robot, and the missions that it received last."""
        return RobotState(
            robot=who.robot,
            robot_sha256=who.robot_sha256,
            sites=list(who.sites),
            version=__version__,
            on=who.on,
            missing=list(who.missing()),
            active=supervisor.active,
            missions=[mission_summary(supervisor.status_of(received)) for received in listed()],
        )

    @routes.put("/agent/missions/{bundle}")
    async def upload(bundle: BundleHash, request: Request, response: Response) -> Receipt:
        """Receive a mission, whose SHA-256 is in the address; it does not start by that."""
        size = size_of(request, uploads)
        with entrance.entered():
            receiving = mission_store.receiving()
            # The disk may be slow, so it is not used in the thread of the event loop.
            incoming = await run_in_threadpool(receiving.__enter__)
            try:
                await receive(request, incoming, size, uploads)
                received, new = await run_in_threadpool(mission_store.take, incoming, bundle)
            finally:
                with anyio.CancelScope(shield=True):
                    await run_in_threadpool(receiving.__exit__, None, None, None)
        response.status_code = 201 if new else 200
        return Receipt(
            hashes=dict(received.hashes),
            new=new,
            mission=mission_summary(await run_in_threadpool(supervisor.status_of, received)),
        )

    @routes.get("/agent/missions/{bundle}")
    def mission(bundle: BundleHash) -> Receipt:
        """Return hashes and state of a mission that was received."""
        received = find_received(bundle)
        return Receipt(hashes=dict(received.hashes), new=False, mission=mission_summary(supervisor.status_of(received)))

    @routes.post("/agent/missions/{bundle}/orders")
    async def order(bundle: BundleHash, body: CommandRequest) -> CommandResponse:
        """Command a mission to start, pause, resume, return or abort, or cancel its timetable or one run."""
        return await orders.take(body, bundle)

    @routes.post("/agent/orders")
    async def order_now(body: CommandRequest) -> CommandResponse:
        """Command the running mission, else the one begun last, to pause, resume, return or abort."""
        return await orders.take(body, None)

    @routes.get("/agent/missions/{bundle}/events")
    async def events(
        bundle: BundleHash,
        after: Annotated[int, Query(ge=0, le=10**12)] = 0,
        wait: Annotated[float, Query(ge=0, le=LONGEST_WAIT_S, allow_inf_nan=False)] = 0.0,
    ) -> Events:
        """Return the events after number ``after``; if there are none yet, wait some seconds for one."""
        received = await run_in_threadpool(find_received, bundle)
        lines, idle = await _awaited(supervisor, received, after, wait)
        standing = await run_in_threadpool(supervisor.status_of, received)
        return Events(events=event_lines(lines), idle=idle, mission=mission_summary(standing))

    @routes.get("/agent/missions/{bundle}/images/{image}")
    def image(bundle: BundleHash, image: ImageName) -> Response:
        """Return an image of a mission, which an event of it names."""
        data = supervisor.image_of(find_received(bundle), image)
        if data is None:
            raise RefusedRequest(404, "there is no such image", "ask for one that an action event of the mission names")
        return Response(content=data, media_type="application/octet-stream")

    @routes.get("/agent/missions/{bundle}/runs")
    def runs(bundle: BundleHash) -> Runs:
        """Return the next runs of a mission with a timetable, and the last ones."""
        received = find_received(bundle)
        last = mission_store.runs(received, LISTED)
        return Runs(
            mission=mission_summary(supervisor.status_of(received)),
            next=[run_summary(run) for run in supervisor.timetables.next_runs(received, NEXT_LISTED)],
            last=[mission_summary(supervisor.status_of(run)) for run in last],
        )

    def listed() -> tuple[ReceivedMission, ...]:
        """Return the missions that arrived last, and before them every other one whose timetable is kept."""
        latest = mission_store.latest(LISTED)
        known = {received.sha256 for received in latest}
        return (*(kept for kept in mission_store.kept() if kept.sha256 not in known), *latest)

    def find_received(bundle: str) -> ReceivedMission:
        received = mission_store.find(bundle)
        if received is None:
            raise RefusedRequest(404, "no such mission has arrived", "send it first")
        return received

    return routes


async def _awaited(
    supervisor: MissionSupervisor, received: ReceivedMission, after: int, wait: float
) -> tuple[tuple[LoggedEvent, ...], bool]:
    """Return the next events; none after a number of seconds, or if no further event can follow."""
    until = anyio.current_time() + wait
    while True:
        lines, idle = await run_in_threadpool(supervisor.events_after, received, after, MOST_EVENTS)
        if lines or idle or anyio.current_time() >= until:
            return lines, idle
        await anyio.sleep(LOOK_S)
