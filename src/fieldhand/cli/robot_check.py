"""``fieldhand robot check``: check the ROS 2 interface in a profile against message types, or on the robot."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from fieldhand.cli.driver_options import TransportOptions
from fieldhand.cli.option_groups import grouped
from fieldhand.cli.options import JsonOption

if TYPE_CHECKING:
    from fieldhand.execution.drivers.ros2.endpoint_checks import EndpointReport
    from fieldhand.execution.drivers.ros2.profile_check import ProfileReport
    from fieldhand.robot.model import RobotProfile


@grouped("name live on domain namespace within json")
def check(
    transport: TransportOptions,
    name: Annotated[str, typer.Argument(metavar="ROBOT", help="Built-in robot or a profile file (YAML).")],
    live: Annotated[bool, typer.Option("--live", help="Try every binding on the robot, without moving it.")] = False,
    within: Annotated[
        float, typer.Option("--within", min=1.0, max=600.0, help="Seconds to wait for endpoints that are missing.")
    ] = 10.0,
    json: JsonOption = False,
) -> None:
    """Check the ROS 2 interface in a profile against its message types; --live tries it on the robot, too."""
    from dataclasses import replace

    from fieldhand.cli import show
    from fieldhand.execution.drivers.ros2.profile_check import bindings_of
    from fieldhand.robot.loader import load_robot

    profile = load_robot(name)
    bindings = transport.in_namespace(bindings_of(profile))
    profile = replace(profile, ros2=bindings)
    report = _check_live(profile, transport, within) if live else _check_types(profile)
    if json:
        show.print_json(_record(profile, report, live=live))
    else:
        for line in _lines(profile, report, live=live):
            show.out.print(line)
    if report.missing or report.other_release:
        raise typer.Exit(1)


def _check_types(profile: RobotProfile) -> ProfileReport:
    """Check a profile against its release; one that insists on none, against the release that it fits best."""
    from typing import get_args

    from fieldhand.execution.drivers.ros2.interfaces import Interfaces
    from fieldhand.execution.drivers.ros2.profile_check import bindings_of, check_types
    from fieldhand.robot.bindings import Distro

    bindings = bindings_of(profile)
    releases: tuple[Distro, ...] = get_args(Distro) if bindings.distro is None else (bindings.distro,)
    reports = []
    for release in releases:
        reports.append(check_types(profile, Interfaces.of(release, bindings.interfaces)))
        if not reports[-1].missing:
            break
    return min(reports, key=lambda report: len(report.missing))


def _check_live(profile: RobotProfile, transport: TransportOptions, within_s: float) -> ProfileReport:
    import time
    from contextlib import closing

    from fieldhand.execution.drivers.ros2.interfaces import Interfaces
    from fieldhand.execution.drivers.ros2.open_transport import open_transport
    from fieldhand.execution.drivers.ros2.profile_check import bindings_of, check_live
    from fieldhand.execution.drivers.ros2.robot_connection import with_release

    bindings = with_release(bindings_of(profile), transport.on, transport.domain, within_s)
    interfaces = Interfaces.of(bindings.release, bindings.interfaces)
    with closing(open_transport(transport.on, interfaces, transport.domain)) as node:
        return check_live(profile, node, interfaces, within_s=within_s, steady=time.monotonic, sleep=time.sleep)


def _lines(profile: RobotProfile, report: ProfileReport, *, live: bool) -> list[str]:
    from fieldhand.execution.drivers.ros2.endpoint_problems import rmw_package

    lines = [line for finding in report.endpoints for line in _finding_lines(finding)]
    bindings = f"{len(report.endpoints)} bindings of {profile.name}"
    if live and not report.rmw:
        lines.append("Nothing of this robot was found on this ROS domain (--domain, ROS_DOMAIN_ID).")
    elif live:
        release = f", ROS 2 {' or '.join(report.heard)}" if report.heard else ""
        lines.append(f"The robot runs {' and '.join(map(rmw_package, report.rmw))}{release}.")
    if (other := report.other_release) is not None:
        lines += [f"MISSING distro: {other[0]}", f"          {other[1]}"]
    if not report.missing and other is None:
        return [
            *lines,
            f"All {bindings} can be used." if live else f"All {bindings} fit their types; --live tries them.",
        ]
    return [*lines, f"{len(report.missing)} of {bindings} cannot be used."] if report.missing else lines


def _finding_lines(finding: EndpointReport) -> list[str]:
    bound = finding.binding
    first = f"{'ok     ' if finding.usable else 'MISSING'} {bound.part}: {bound.name} ({bound.type}): {finding.what}"
    return [first] if not finding.advice else [first, f"          {finding.advice}"]


def _record(profile: RobotProfile, report: ProfileReport, *, live: bool) -> dict[str, Any]:
    from dataclasses import asdict

    return {
        "robot": profile.name,
        "live": live,
        "usable": not report.missing and report.other_release is None,
        "distro": {"profile": report.insisted, "heard": report.heard},
        "rmw": list(report.rmw),
        "bindings": [
            {**asdict(f.binding), "usable": f.usable, "what": f.what, "advice": f.advice, "rmw": list(f.rmw)}
            for f in report.endpoints
        ],
    }
