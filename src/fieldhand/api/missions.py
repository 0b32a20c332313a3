"""Live missions: begin, list, follow, command, and fetch what they produced."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterator
from dataclasses import asdict
from datetime import datetime
from functools import lru_cache, partial
from pathlib import Path
from typing import Annotated, Any

from anyio import CapacityLimiter, to_thread
from fastapi import APIRouter, Depends, Query, Response
from fastapi import Path as InPath
from starlette.responses import StreamingResponse

from fieldhand import mission, missions
from fieldhand.api.answers import review_answer, unplanned_answer
from fieldhand.api.audit import Record
from fieldhand.api.callers import Caller, Scope, approver, require
from fieldhand.api.earlier import records_of, with_logs
from fieldhand.api.event_records import event_record, summary_record
from fieldhand.api.inputs import CommandBody, Lang, MissionBody, answers_of, open_files, open_task, open_world
from fieldhand.api.plan import Planners
from fieldhand.api.problems import RefusedRequest
from fieldhand.api.work import Workers
from fieldhand.approval.production import require_unsigned_allowed
from fieldhand.compatibility import UTC
from fieldhand.fleet import Fleet, MissionFeed, WorkerSettings
from fieldhand.language import message, open_language
from fieldhand.mission.documents import SiteAndRobot
from fieldhand.planning.planner import Planned
from fieldhand.task.codec import encode

#: Missions of a list, and events of an answer.
LISTED, MOST_EVENTS = 50, 500
#: Seconds within which a mission confirms a command, and between two looks. A worker that starts needs a few.
CONFIRMED_WITHIN_S, LOOK_S = 10.0, 0.05
#: Threads for commands, and for reading; neither waits for plans or for each other.
_COMMANDS, _READERS = 32, 8
#: Policy of a report, which is a page with its own style and images.
REPORT_POLICY = (
    "default-src 'none'; img-src data:; style-src 'unsafe-inline';"
    " base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)

MissionId = Annotated[str, InPath(pattern=r"^[A-Za-z0-9][A-Za-z0-9_-]{0,99}$")]
ImageName = Annotated[str, InPath(pattern=r"^[A-Za-z0-9_-]{1,150}\.(png|jpg|tif)$")]
Reader = Annotated[Caller, Depends(require(Scope.READ))]
READER = [Depends(require(Scope.READ))]
Approver = Annotated[Caller, Depends(require(Scope.APPROVE))]
Commander = Annotated[Caller, Depends(require(Scope.COMMAND))]


def router(workers: Workers, planners: Planners, fleet: Fleet, record: Record) -> APIRouter:
    """Return the routes below ``/missions``."""
    routes = APIRouter(tags=["missions"])
    commands, readers = CapacityLimiter(_COMMANDS), CapacityLimiter(_READERS)

    def found(name: str) -> Path:
        folder = fleet.folder(name)
        if folder is None:
            raise no_mission(name)
        return folder

    @routes.post("/missions", status_code=201, dependencies=[Depends(require(Scope.COMMAND))])
    async def begin(body: MissionBody, caller: Approver, response: Response) -> dict[str, Any]:
        """Approve a mission in the name of the caller, and begin it on a simulated robot."""
        by = approver(caller, body.approved_by)
        answer = await workers.do(lambda: _begin(body, by, planners, fleet), caller.name)
        if answer["outcome"] == "began":
            await record(caller, "approve and begin", answer["id"], approved_by=by, request=answer["request"][:200])
        else:
            response.status_code = 200
        return answer

    @routes.get("/missions", dependencies=READER)
    async def listed(lang: Lang = "en", limit: Annotated[int, Query(ge=1, le=LISTED)] = LISTED) -> list[dict[str, Any]]:
        """Return the missions that were begun last, the newest first."""
        return await to_thread.run_sync(lambda: _listed(fleet, limit, lang), limiter=readers)

    @routes.get("/missions/{name}")
    async def one(name: MissionId, caller: Reader, lang: Lang = "en") -> dict[str, Any]:
        """Return a mission: its state, and what was approved: the plan in words, the forecast and the map."""
        feed = _feed(fleet, name)
        plan = await workers.do(lambda: _plan(found(name), lang), caller.name)
        state = await to_thread.run_sync(lambda: summary_record(feed, open_language(lang)), limiter=readers)
        return {**plan, **state}

    @routes.get("/missions/{name}/events", dependencies=READER)
    async def events(
        name: MissionId, after: Annotated[int, Query(ge=0, le=10**12)] = 0, lang: Lang = "en"
    ) -> dict[str, Any]:
        """Return the events after number ``after``, at most 500."""
        feed = _feed(fleet, name)
        return await to_thread.run_sync(lambda: _events(feed, after, lang), limiter=readers)

    @routes.post("/missions/{name}/commands")
    async def command(name: MissionId, body: CommandBody, caller: Commander) -> dict[str, Any]:
        """Command a mission to pause, resume, return or abort, and wait until it has received the command."""
        folder, language = found(name), open_language(body.lang)
        answer = await to_thread.run_sync(
            partial(fleet.command, folder, body.command, caller.name, wait=_patience()), limiter=commands
        )
        await record(caller, body.command, name, confirmed=answer.confirmed, sent=answer.sent)
        return {**asdict(answer), "why": language.say(answer.why)}

    @routes.get("/missions/{name}/report", dependencies=READER)
    async def report(name: MissionId) -> Response:
        """Return the report of a mission that has ended, a page."""
        path = found(name) / "report.html"
        data = await to_thread.run_sync(lambda: path.read_bytes() if path.is_file() else None, limiter=readers)
        if data is None:
            raise RefusedRequest(
                404, message("there is no report yet"), message("it is written when the mission has ended")
            )
        headers = {"Content-Security-Policy": REPORT_POLICY}
        return Response(data, media_type="text/html; charset=utf-8", headers=headers)

    @routes.get("/missions/{name}/images/{image}", dependencies=READER)
    async def image(name: MissionId, image: ImageName) -> Response:
        """Return an image of a capture, which an event names."""
        folder = found(name)
        data = await to_thread.run_sync(lambda: missions.image_of(folder, image), limiter=readers)
        if data is None:
            advice = message("ask for one that an action event of the mission names")
            raise RefusedRequest(404, message("there is no such image"), advice)
        kind = {"png": "image/png", "jpg": "image/jpeg", "tif": "image/tiff"}[image.rpartition(".")[2]]
        return Response(data, media_type=kind)

    @routes.get("/missions/{name}/log", dependencies=READER)
    async def whole_log(name: MissionId) -> Response:
        """Return the event log so far, one JSON object a line."""
        feed = _feed(fleet, name)
        return StreamingResponse(_lines(feed), media_type="application/x-ndjson", headers=_saved(f"{name}.jsonl"))

    @routes.get("/missions/{name}/observations.csv", dependencies=READER)
    async def observations(name: MissionId) -> Response:
        """Return the captures so far, a row per reading."""
        from fieldhand.evaluation.report.observations import observations_csv

        folder = found(name)
        text = await to_thread.run_sync(lambda: observations_csv(missions.events_of(folder)), limiter=readers)
        return Response(text, media_type="text/csv; charset=utf-8", headers=_saved(f"{name}.csv"))

    @routes.get("/missions/{name}/results.geojson", dependencies=READER)
    async def results(name: MissionId) -> Response:
        """Return the captures so far as points with their readings."""
        from fieldhand.evaluation.report.observations import observations_geojson

        folder = found(name)
        text = await to_thread.run_sync(lambda: observations_geojson(missions.events_of(folder)), limiter=readers)
        return Response(text, media_type="application/geo+json", headers=_saved(f"{name}.geojson"))

    return routes


def no_mission(name: str) -> RefusedRequest:
    """Return the refusal for a mission that does not exist."""
    return RefusedRequest(
        404,
        message("there is no mission '{name}'", name=name),
        message("{route} lists them", route="GET /api/v1/missions"),
    )


def _feed(fleet: Fleet, name: str) -> MissionFeed:
    feed = fleet.feed(name)
    if feed is None:
        raise no_mission(name)
    return feed


def _begin(body: MissionBody, by: str, planners: Planners, fleet: Fleet) -> dict[str, Any]:
    require_unsigned_allowed(os.environ)
    site_and_robot, files = open_files(body)
    site, robot = site_and_robot.site, site_and_robot.robot
    world = open_world(body.world)
    mission.check_world(world, site, robot)
    planner = "document"
    if body.request is not None:
        outcome = mission.plan(
            body.request,
            site,
            robot,
            planners(body.planner),
            answers_of(body),
            earlier=records_of(body.earlier, site),
        )
        if not isinstance(outcome, Planned):
            return unplanned_answer(outcome, site_and_robot, open_language(body.lang))
        task, planner = outcome.task, outcome.planner
    else:
        task = with_logs(open_task(body.xml or "", robot)[0], body.earlier, site)
    approved = mission.authorize(
        mission.review(task, site, robot),
        by=by,
        at=datetime.now(UTC),
        confirmed=body.confirmed,
        language=body.lang,
    )
    name = fleet.begin(
        missions.Inputs(
            authorized=approved.authorized,
            site=site,
            robot=robot,
            files=files.site,
            profile=files.profile,
            world=world,
            seed=world.seed if body.seed is None else body.seed,
            planner=planner,
        ),
        WorkerSettings(speed=None if body.speed == "max" else body.speed, by=by),
    )
    return {"outcome": "began", **summary_record(_feed(fleet, name), open_language(body.lang))}


def _listed(fleet: Fleet, limit: int, lang: str) -> list[dict[str, Any]]:
    language = open_language(lang)
    feeds = [fleet.feed(name) for name in reversed(fleet.ids()[-limit:])]
    return [summary_record(feed, language) for feed in feeds if feed is not None]


def _plan(folder: Path, lang: str) -> dict[str, Any]:
    """Return the approved plan of a mission."""
    review = _review(folder)
    return {
        "xml": encode(review.task).decode(),
        **review_answer(review, SiteAndRobot(site=review.site, robot=review.robot), open_language(lang)),
    }


@lru_cache(maxsize=8)
def _review(folder: Path) -> mission.Review:
    stored = missions.open_mission(folder)
    return mission.review(stored.authorized.task, stored.site, stored.robot)


def _events(feed: MissionFeed, after: int, lang: str) -> dict[str, Any]:
    lines, language = feed.lines_after(after, MOST_EVENTS), open_language(lang)
    return {
        "events": [event_record(feed, line, language) for line in lines],
        "last": lines[-1].n if lines else after,
        "state": feed.summary().state,
    }


def _lines(feed: MissionFeed) -> Iterator[str]:
    after = 0
    while lines := feed.lines_after(after, MOST_EVENTS):
        yield "".join(f"{line.line}\n" for line in lines)
        after = lines[-1].n


def _saved(name: str) -> dict[str, str]:
    """Return the header with which browsers save an answer under a name."""
    return {"Content-Disposition": f'attachment; filename="{name}"'}


def _patience() -> Callable[[], bool]:
    """Return a function that waits a moment, and returns True until a mission must have confirmed a command."""
    until = time.monotonic() + CONFIRMED_WITHIN_S

    def wait() -> bool:
        time.sleep(LOOK_S)
        return time.monotonic() < until

    return wait
