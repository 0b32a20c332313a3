"""One mission at the command line, from review to report: what ``run`` and ``demo`` share."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING

from fieldhand import finished_missions, mission, missions
from fieldhand.cli import show
from fieldhand.cli.approving import approve_plan, review_plan
from fieldhand.cli.bundles import signer_record
from fieldhand.cli.driver_options import see_off
from fieldhand.cli.inputs import InputFiles, write_file
from fieldhand.cli.outputs import left_in
from fieldhand.cli.show import note
from fieldhand.errors import InputError
from fieldhand.language import ENGLISH, Language, kept_in_log, message
from fieldhand.mission.documents import SiteAndRobot
from fieldhand.task.frames import Task
from fieldhand.task.results import Ended, Event, MissionStatus

if TYPE_CHECKING:
    from fieldhand.approval.bundle.opening import Bundle
    from fieldhand.execution.drivers.simulation.world import World
    from fieldhand.execution.vehicle import Vehicle
    from fieldhand.robot.model import RobotProfile
    from fieldhand.site.model import Site
    from fieldhand.task.authorization import AuthorizedTask


@dataclass(frozen=True, kw_only=True)
class Kept:
    """The folder of a mission, and what it takes along.

    Attributes:
        under: The folder of all missions.
        files: The bytes from which site and robot were read.
    """

    under: Path
    files: InputFiles


@dataclass(frozen=True, kw_only=True)
class Orders:
    """How to carry a mission out at the command line.

    Attributes:
        ask: Ask the operator before it starts.
        confirm: Every warning is confirmed without asking.
        by: Who approves; None for the user who is logged in.
        world: What sensors read and what goes wrong.
        speed: Simulated seconds in a second; None for as fast as it goes.
        log: Where to write the event log beside the one in ``folder``.
        mcap: Where to write it as MCAP.
        folder: Where to leave Task, map, events and report.
        history: Folder in which it is kept what missions cost the robot; None to keep nothing.
        quiet: Print one JSON object at the end and nothing else.
        language: In which the plan is read back.
        kept: Where the mission is kept, so that it outlasts a power cut; None for one that does not.
        bundle: The signed mission, if it is one.
        vehicle: The robot; None for the simulation.
    """

    ask: bool
    confirm: bool = False
    by: str | None
    world: World
    seed: int
    speed: float | None = None
    log: Path | None = None
    mcap: Path | None = None
    folder: Path | None = None
    history: Path | None = None
    quiet: bool = False
    language: Language = ENGLISH
    kept: Kept | None = None
    bundle: Bundle | None = None
    vehicle: Vehicle | None = None


def fly(
    ground: SiteAndRobot,
    task: Task,
    document: bytes | None,
    orders: Orders,
    *,
    planner: str,
    authorized: AuthorizedTask | None = None,
) -> int:
    """Review, approve, carry out, judge and report one mission.

    Args:
        authorized: The Task with its authorization if it was approved before: a signed mission.

    Returns:
        The exit status: 0 if the plan was done and every goal was met, else 1.

    Raises:
        NotConfirmedError: There are warnings, and nobody is asked about them.
        NotApprovedError: A check fails, or the operator says no.
        ExecutionError: The robot may not set out from where it is.
        OutputError: Something cannot be written.
    """
    review = review_plan(ground, task, document, orders)
    if authorized is None:
        approved = approve_plan(review, orders, message("Approve and carry out?"))
    else:
        approved = mission.ApprovedMission(
            authorized=authorized, site=ground.site, robot=ground.robot, estimate=review.estimate
        )
    leave_plan(ground, review, document, orders)
    if orders.vehicle is not None:
        see_off(ground, review, orders.vehicle, orders)
    events, name = _carry_out(approved, orders, planner)
    return conclude(approved, events, orders, planner, name)


def parse_speed(text: str | None) -> float | None:
    """``max`` or nothing is None; else simulated seconds in a second.

    Raises:
        InputError: Neither.
    """
    if text is None or text == "max":
        return None
    try:
        speed = float(text)
    except ValueError:
        speed = math.nan
    if not 0 < speed < math.inf:
        raise InputError(
            message("'{text}' is no speed", text=text),
            where="--speed",
            advice=message("give max, or a number above 0 (1 is real time)"),
        )
    return speed


def leave_plan(ground: SiteAndRobot, review: mission.Review, document: bytes | None, orders: Orders) -> None:
    """Write Task and map before a wheel turns, so that an unwritable folder costs no mission."""
    if orders.folder is None:
        return
    from fieldhand.cli.pictures import draw_plan
    from fieldhand.task.codec import encode

    write_file(orders.folder / "task.xml", document or encode(review.task))
    draw_plan(orders.folder / "map.png", review, ground, orders.language)


def _carry_out(approved: mission.ApprovedMission, orders: Orders, planner: str) -> tuple[tuple[Event, ...], str]:
    """The events of a mission, and the name under which it is kept; none is begun before every log is open."""
    from fieldhand.execution.drivers.simulation.vehicle import simulation

    with _taking(approved.site, approved.robot, orders, ()) as take:
        if orders.kept is not None:
            given = _begin(approved, orders, orders.kept, planner)
            return missions.carry_out(given, speed=orders.speed, vehicle=orders.vehicle, emit=take).events, given.id
        site, robot, seed = approved.site, approved.robot, orders.seed
        vehicle = orders.vehicle or simulation(site, robot, orders.world, seed=seed, speed=orders.speed)
        return mission.carry_out(approved, vehicle=vehicle, seed=seed, emit=take).events, ""


def _begin(approved: mission.ApprovedMission, orders: Orders, kept: Kept, planner: str) -> missions.StoredMission:
    inputs = missions.Inputs(
        authorized=approved.authorized,
        site=approved.site,
        robot=approved.robot,
        files=kept.files.site,
        profile=kept.files.profile,
        lenient=kept.files.lenient,
        world=orders.world,
        seed=orders.seed,
        planner=planner,
        bundle=orders.bundle,
        departure=missions.departure_on(orders.vehicle),
    )
    given = missions.begin(kept.under, missions.new_id(datetime.now(UTC)), inputs)
    if not orders.quiet:
        named = message(
            "mission {id}; fieldhand status, pause, resume, abort and return know it by this name", id=given.id
        )
        show.note(named, orders.language)
    return given


def go_on(given: missions.StoredMission, orders: Orders) -> tuple[Event, ...]:
    """Carry out what is left of a mission that is kept, as after a power cut."""
    before = missions.events_of(given.folder)
    with _taking(given.site, given.robot, orders, before) as take:
        return missions.carry_out(given, speed=orders.speed, vehicle=orders.vehicle, emit=take).events


@contextmanager
def _taking(
    site: Site, robot: RobotProfile, orders: Orders, before: Sequence[Event]
) -> Iterator[Callable[[Event], None]]:
    """What takes each event: the logs that were asked for, in which those before stand as well, and the terminal."""
    from fieldhand.evaluation.event_text import EventText
    from fieldhand.execution.event_log import EventLog

    event_text = EventText(robot)
    if not orders.quiet:
        show.heading(orders.language.say(message("The mission")))
        if before:
            if isinstance(before[-1], Ended):
                left = message("{count} events before; nothing is left to do", count=len(before))
            else:
                left = message("{count} events before; it goes on from there", count=len(before))
            show.out.print(f"          {orders.language.say(left)}")
    with ExitStack() as stack:
        paths = [orders.log, None if orders.folder is None else orders.folder / "events.jsonl"]
        logs: list[Callable[[Event], None]] = [
            stack.enter_context(EventLog(path)) for path in paths if path is not None
        ]
        if orders.mcap is not None:
            from fieldhand.exchange.mcap import McapLog

            logs.append(stack.enter_context(McapLog(orders.mcap, tell=event_text.line, site=site)))

        def take(event: Event) -> None:
            for log in logs:
                log(event)
            line = orders.language.say(event_text.line(event) or "")
            if line and not orders.quiet:
                show.out.print(line)

        for event in before:
            for log in logs:
                log(event)
        yield take


def conclude(
    approved: mission.ApprovedMission,
    events: Sequence[Event],
    orders: Orders,
    planner: str,
    name: str = "",
) -> int:
    """Judge and report a mission that was carried out.

    Returns:
        The exit status, as :func:`fly`.
    """
    from fieldhand.evaluation.event_text import goal_names

    done = finished_missions.conclude(
        approved.authorized,
        approved.site,
        approved.robot,
        events,
        estimate=approved.estimate,
        folder=orders.folder,
        history=orders.history,
        at=datetime.now(UTC),
        bundle=orders.bundle,
    )
    if done.history_error:
        note(done.history_error, orders.language)
    assessment = done.assessment
    ended = next((e for e in reversed(events) if isinstance(e, Ended)), None)
    written: list[Path] = []
    if orders.folder is not None:
        written = list(left_in(orders.folder))
    status = 0 if assessment.success else 1
    if orders.quiet:
        record = show.mission_record(approved.task, planner, ended, assessment, written)
        signed = None if orders.bundle is None else signer_record(orders.bundle)
        show.print_json({"mission": name} | record | {"signed": signed})
        return status
    show.show_outcomes(assessment, goal_names(approved.task, approved.robot), orders.language)
    if ended is not None and assessment.status is not None:
        show.out.print()
        show.out.print(orders.language.say(_say_end(assessment.status, assessment.reason, ended)))
    if written:
        show.heading(orders.language.say(message("Where to look")))
        for path in written:
            show.out.print(f"  {path}")
    return status


def _say_end(status: MissionStatus, reason: str, ended: Ended) -> str:
    """Say how a mission ended, what it took, and why."""
    from fieldhand.task.exceeded import say_status

    said = message(
        "Mission {status}: {metres} m driven in {minutes} min, battery at {charge} %",
        status=say_status(status),
        metres=f"{ended.travelled_m:.0f}",
        minutes=f"{ended.t / 60:.0f}",
        charge=f"{ended.charge_percent:.0f}",
    )
    return message("{what} ({why})", what=said, why=kept_in_log(reason)) if reason else said
