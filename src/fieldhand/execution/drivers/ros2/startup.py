"""Readiness check before a mission: wait for every part of the robot, and report what is missing and why."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from fieldhand.errors import Ros2Error
from fieldhand.execution.drivers.ros2.action_client import CANCEL_S, ActionClient
from fieldhand.execution.drivers.ros2.capture import BoundAction, CaptureClient
from fieldhand.execution.drivers.ros2.endpoint_problems import (
    EndpointProblem,
    action_problem,
    service_problem,
    topic_problem,
)
from fieldhand.execution.drivers.ros2.event_topics import EventTopics
from fieldhand.execution.drivers.ros2.interfaces import Interfaces
from fieldhand.execution.drivers.ros2.navigation import FROM_LL, NavigationClient
from fieldhand.execution.drivers.ros2.telemetry import Telemetry, TelemetryTopic
from fieldhand.execution.drivers.ros2.transport import Client, QosProfile, Transport
from fieldhand.execution.drivers.ros2.working import ImplementClient

#: Largest number of missing parts that are named.
_MOST_NAMED = 8

#: Description of a missing part, and advice; the advice may be empty.
_Missing = tuple[str, str]

_ONE_WAY = (
    "it was discovered, but is not matched in both directions",
    "check that its definition is that of the profile's distro, and that no firewall blocks one direction",
)


class Startup:
    """Checks that all parts of the robot that a mission needs are available.

    Args:
        transport, interfaces: Used to diagnose missing parts.
        navigation, captures, implements, telemetry, events: Required parts.
        far: Returns why the robot cannot be on the mission's site; None if it can.
        rest: Sleeps until the next poll.
        steady: Monotonic clock in seconds.
    """

    def __init__(
        self,
        transport: Transport,
        interfaces: Interfaces,
        *,
        navigation: NavigationClient,
        captures: CaptureClient,
        implements: ImplementClient,
        telemetry: Telemetry,
        events: EventTopics,
        far: Callable[[], str | None],
        rest: Callable[[], None],
        steady: Callable[[], float],
    ) -> None:
        self._transport, self._interfaces = transport, interfaces
        self._navigation, self._captures, self._telemetry = navigation, captures, telemetry
        self._events = events
        self._implements = implements
        self._far, self._rest, self._steady = far, rest, steady
        self._since_s = steady()

    def wait(self, within_s: float) -> None:
        """Wait until all parts are available.

        Raises:
            Ros2Error: Some part is missing after ``within_s``; the missing parts are named.
        """
        self._since_s = self._steady()
        until = self._since_s + within_s
        while missing := list(self._missing()):
            if self._steady() >= until:
                raise Ros2Error(f"the robot is not ready after {within_s:g} s: {_summary(missing)}")
            self._rest()
            self._telemetry.listen()
            self._events.listen()

    def clear(self) -> None:
        """Cancel all goals of the robot and switch its implements off: an interrupted mission may have left them on.

        Raises:
            Ros2Error: The goals do not end, or an implement does not switch off.
        """
        clients = (*self._navigation.stopping, *self._captures.actions)
        until = self._steady() + CANCEL_S
        while busy := [client.name for client in clients if not client.cancel_everything()]:
            if self._steady() >= until:
                raise Ros2Error(
                    f"{' and '.join(busy)} did not confirm within {CANCEL_S:g} s that all goals are cancelled",
                    advice="check which other program controls the robot",
                )
            self._rest()
        switching = self._implements.all_off()
        while True:
            try:
                next(switching)
            except StopIteration as done:
                failed: tuple[str, ...] = done.value
                break
            self._rest()
        if failed:
            raise Ros2Error("; ".join(failed), advice="switch it off by hand, and check whether its switch answers")

    def _missing(self) -> Iterator[_Missing]:
        yield from self._missing_navigation()
        for topic in (*self._telemetry.all, *self._events.all):
            yield from self._silent(topic)
        if (why := self._far()) is not None:
            yield why, ""
        if (pressed := self._telemetry.stopped()) is not None:
            yield pressed, "release it and start again"
        for name, bound in self._captures.bound.items():
            yield from self._missing_capture(name, bound)
        yield from self._missing_switches()

    def _missing_navigation(self) -> Iterator[_Missing]:
        navigation = self._navigation
        for client in navigation.clients:
            yield from self._no_action("navigation", client)
        navigation.nodes.look()
        yield from navigation.nodes.problems(self._since_s)
        if navigation.from_ll is not None:
            yield from self._no_service("the map", navigation.from_ll, navigation.from_ll_name, FROM_LL)
        if navigation.speed is not None and navigation.speed.subscribers() == 0:
            what = f"the speed limit {navigation.speed_name}: there is no subscriber"
            yield what, "check whether Nav2's controller is active"

    def _missing_switches(self) -> Iterator[_Missing]:
        for name, (binding, end) in self._implements.switches.items():
            if not self._implements.is_needed(name):
                continue
            full_name = self._implements.whole_name(binding.name)
            if binding.kind == "service":
                yield from self._no_service(name, end, full_name, binding.type)  # type: ignore[arg-type]
            elif end.subscribers() == 0:  # type: ignore[union-attr]
                yield f"{name} {full_name}: there is no subscriber", "check whether it runs on the robot"

    def _missing_capture(self, name: str, bound: BoundAction) -> Iterator[_Missing]:
        call = bound.binding.call
        if bound.action is not None:
            yield from self._no_action(name, bound.action)
        elif bound.service is not None and call is not None:
            yield from self._no_service(name, bound.service, self._captures.whole_name(call.name), call.type)
        for quantity, (topic, subscription) in bound.topics.items():
            message = bound.binding.topics[quantity]
            if subscription.publishers() == 0:
                # A topic that is published on demand has no messages yet.
                qos = QosProfile(reliable=message.reliable)
                why = topic_problem(self._transport, self._interfaces, topic, message.type, qos)
                yield _line(f"{quantity} of {name}", topic, why)

        for label, image in bound.binding.images.items():
            topic, qos = self._captures.whole_name(image.topic), QosProfile(reliable=image.reliable)
            if (why := topic_problem(self._transport, self._interfaces, topic, image.type, qos)) is not None:
                yield _line(f"image {label} of {name}", topic, why)

    def _no_action(self, what: str, client: ActionClient) -> Iterator[_Missing]:
        why = action_problem(self._transport, self._interfaces, client.name, client.type)
        if why is not None or client.servers() == 0:
            yield _line(what, client.name, why)

    def _no_service(self, what: str, client: Client, name: str, type_name: str) -> Iterator[_Missing]:
        why = service_problem(self._transport, self._interfaces, name, type_name)
        if why is not None or client.servers() == 0:
            yield _line(what, name, why)

    def _silent(self, topic: TelemetryTopic) -> Iterator[_Missing]:
        if topic.known():
            return
        why = topic_problem(self._transport, self._interfaces, topic.name, topic.binding.type, topic.qos)
        if why is not None or topic.subscription.publishers() == 0:
            yield _line(topic.what, topic.name, why)
        elif topic.received:
            yield f"{topic.what} {topic.name}: {topic.problem}", ""
        else:
            yield f"{topic.what} {topic.name}: no message yet", "check whether the robot publishes it"


def _line(what: str, name: str, why: EndpointProblem | None) -> _Missing:
    found, advice = _ONE_WAY if why is None else (why.what, why.advice)
    return f"{what} {name}: {found}", advice


def _summary(missing: list[_Missing]) -> str:
    """Join all missing parts in one line; shared advice is given once, after the last part it applies to."""
    named = missing[:_MOST_NAMED]
    advised: dict[str, list[str]] = {}
    for what, advice in named:
        advised.setdefault(advice, []).append(what)
    parts = ["; ".join(filter(None, (", ".join(whats), advice))) for advice, whats in advised.items()]
    return "; ".join([*parts, *([f"and {len(missing) - len(named)} more"] if len(missing) > len(named) else [])])
