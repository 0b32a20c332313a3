"""The ROS 2 release of a robot, from what its navigation announces.

From Iron on, every endpoint announces the hash of its type (REP 2016), and Nav2's actions differ between releases.
Humble announces none. Releases whose actions are the same for a profile need not be told apart.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping
from typing import get_args

from fieldhand.errors import Ros2Error
from fieldhand.execution.drivers.ros2.interfaces import Interfaces
from fieldhand.execution.drivers.ros2.transport import Transport
from fieldhand.robot.bindings import Distro, Ros2Bindings

#: Releases with hashes. The first that fits is used.
_NEWER: tuple[Distro, ...] = ("jazzy", "kilted", "iron")
#: Seconds after the first server was heard, within which the rest of what it serves is heard, too.
_REST_S = 1.0
_LOOK_S = 0.02


def sourced_release() -> Distro | None:
    """Return the release that is sourced in the environment; None if there is none, or an unknown one."""
    sourced = os.environ.get("ROS_DISTRO", "").strip()
    return next((name for name in get_args(Distro) if name == sourced), None)


def wait_for_release(
    transport: Transport,
    bindings: Ros2Bindings,
    *,
    within_s: float,
    steady: Callable[[], float],
    sleep: Callable[[float], None],
) -> Distro | None:
    """Return the release of a robot as soon as its navigation is heard; None if it is not heard.

    Args:
        within_s: Seconds to wait for the navigation.
        steady: Monotonic clock in seconds.
        sleep: Sleeps for the given seconds of that clock.

    Raises:
        Ros2Error: The robot announces definitions of no known release.
    """
    begun_s, heard_s = steady(), None
    while steady() < begun_s + within_s:
        hashes = _announced(transport, bindings)
        if hashes is not None:
            heard_s = steady() if heard_s is None else heard_s
            if not hashes or all(hashes.values()) or steady() >= heard_s + _REST_S:
                break
        sleep(_LOOK_S)
    found = heard_releases(transport, bindings)
    if found is None:
        return None
    first = next(found, None)
    if first is None:
        raise Ros2Error(
            "the robot announces definitions of Nav2's actions that fit no release that is known here "
            f"({', '.join(get_args(Distro))})",
            advice="set the nearest one as distro in the profile, and give what differs under ros2: interfaces",
        )
    return first


def heard_releases(transport: Transport, bindings: Ros2Bindings) -> Iterator[Distro] | None:
    """Return the releases whose definitions agree with all that the robot's actions announce; None if none is there."""
    hashes = _announced(transport, bindings)
    if hashes is None:
        return None
    unhashed: tuple[Distro, ...] = ("humble",)
    return _fitting({of: one for of, one in hashes.items() if one}, bindings) if hashes else iter(unhashed)


def _fitting(hashes: Mapping[str, str], bindings: Ros2Bindings) -> Iterator[Distro]:
    for release in _NEWER:
        known = Interfaces.of(release, bindings.interfaces)
        if all(known.has(of) and known.type_hash(of) == one for of, one in hashes.items()):
            yield release


def _announced(transport: Transport, bindings: Ros2Bindings) -> dict[str, str] | None:
    """Return the hashes that the servers of all bound actions announce, by message; empty if they announce none, and
    None if there are no servers. A hash is empty if only others of its server were heard.
    """
    found: dict[str, str] = {}
    there = False
    for action, of in _actions(bindings):
        for service, kind in (("send_goal", "SendGoal"), ("get_result", "GetResult")):
            peers = [p for p in transport.servers_of(f"{action}/_action/{service}") if p.type == f"{of}_{kind}"]
            there = there or bool(peers)
            for peer in peers:
                found[f"{of}_{kind}_Request"] = peer.type_hash
                found[f"{of}_{kind}_Response"] = peer.reply_hash
    return None if not there else found if any(found.values()) else {}


def _actions(bindings: Ros2Bindings) -> Iterator[tuple[str, str]]:
    navigation = bindings.navigation
    yield bindings.whole_name(navigation.action), navigation.type
    if navigation.working:
        yield bindings.whole_name(navigation.working_action), navigation.working
    for bound in bindings.actions.values():
        if bound.call is not None and bound.call.kind == "action":
            yield bindings.whole_name(bound.call.name), bound.call.type
