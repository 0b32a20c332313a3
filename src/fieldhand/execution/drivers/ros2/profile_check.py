"""Check of a profile's ROS 2 bindings against their types and against a live robot.

The check commands nothing: it subscribes, and looks for servers. Only the map service of the robot's localization is
called, with one point.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Literal

from fieldhand.errors import ProfileError, Ros2Error
from fieldhand.execution.drivers.ros2 import plausibility, ros_clock
from fieldhand.execution.drivers.ros2.endpoint_checks import (
    ActionCheck,
    EndpointBinding,
    EndpointCheck,
    EndpointReport,
    LifecycleCheck,
    ServiceCheck,
    SubscriberCheck,
    TopicCheck,
)
from fieldhand.execution.drivers.ros2.interfaces import Interfaces
from fieldhand.execution.drivers.ros2.interfaces.definitions import FLOATS, INTEGERS
from fieldhand.execution.drivers.ros2.message_fields import message_of
from fieldhand.execution.drivers.ros2.navigation import FROM_LL, SPEED_LIMIT
from fieldhand.execution.drivers.ros2.node_states import GET_STATE
from fieldhand.execution.drivers.ros2.plausibility import MessageCheck
from fieldhand.execution.drivers.ros2.release import heard_releases
from fieldhand.execution.drivers.ros2.telemetry import fix_problem
from fieldhand.execution.drivers.ros2.transport import IMAGE_TYPES, QosProfile, Rmw, RosMessage, Transport
from fieldhand.robot.bindings import (
    CallBinding,
    Distro,
    EventBinding,
    RequestValue,
    Ros2Bindings,
    SwitchBinding,
    TopicBinding,
)
from fieldhand.robot.model import Action, RobotProfile

_NUMBERS = (*INTEGERS, *FLOATS, "bool")
_CORRECT = "correct it in the profile's ros2 part"
#: Seconds of the steady clock between two polls.
_LOOK_S = 0.02
#: Seconds after which a second robot on the domain would have been discovered.
_SETTLED_S = 1.0
#: Seconds after which no endpoint is waited for any more of a robot that has another release than the profile insists
#: on: those that differ never fit.
_OTHER_RELEASE_S = 5.0

#: Field paths of a message, each with the allowed types.
_Paths = Sequence[tuple[str, tuple[str, ...]]]


@dataclass(frozen=True, kw_only=True)
class ProfileReport:
    """Results for all endpoints of a profile.

    Attributes:
        insisted: Release that the profile insists on.
        heard: Releases whose definitions the robot announces; None if its navigation was not heard.
    """

    endpoints: tuple[EndpointReport, ...]
    insisted: Distro | None = None
    heard: tuple[Distro, ...] | None = None

    @property
    def rmw(self) -> tuple[Rmw, ...]:
        """Middlewares of the robot, by the endpoints that were discovered."""
        return tuple(sorted({rmw for endpoint in self.endpoints for rmw in endpoint.rmw}))

    @property
    def other_release(self) -> tuple[str, str] | None:
        """Description of a robot that has another release than the profile insists on, and advice; else None."""
        if self.heard is None or self.insisted is None or self.insisted in self.heard:
            return None
        heard = " or ".join(self.heard) or "one that is not known here"
        return (
            f"the profile insists on ROS 2 {self.insisted}, and the robot has {heard}",
            f"leave distro out of the profile{f', or set it to {self.heard[0]}' if self.heard else ''}",
        )

    @property
    def missing(self) -> tuple[EndpointReport, ...]:
        """Endpoints that a mission could not use."""
        return tuple(f for f in self.endpoints if not f.usable)


@dataclass(frozen=True, kw_only=True)
class _Bound:
    """An endpoint with its check.

    Attributes:
        wrong: Mismatches with its type, independent of the robot.
        make: Creates the check against a robot.
    """

    binding: EndpointBinding
    wrong: tuple[str, ...]
    make: Callable[[Transport], EndpointCheck]


def bindings_of(profile: RobotProfile) -> Ros2Bindings:
    """Return the ROS 2 bindings of a profile.

    Raises:
        ProfileError: The profile has none.
    """
    if profile.ros2 is None:
        raise ProfileError(
            f"the profile of {profile.name} does not define how the robot is reached over ROS 2",
            where=profile.source,
            advice="add a ros2 section (docs/formats.md)",
        )
    return profile.ros2


def check_types(profile: RobotProfile, interfaces: Interfaces) -> ProfileReport:
    """Check every binding against its type, without a robot.

    Raises:
        ProfileError: The profile has no ROS 2 part.
    """
    bound = _Bindings(profile, interfaces).all()
    return ProfileReport(
        endpoints=tuple(_unfit(b) or EndpointReport(binding=b.binding, usable=True, what="fits") for b in bound)
    )


def check_live(
    profile: RobotProfile,
    transport: Transport,
    interfaces: Interfaces,
    *,
    within_s: float,
    steady: Callable[[], float],
    sleep: Callable[[float], None],
) -> ProfileReport:
    """Check every binding against a live robot.

    Args:
        interfaces: Types of the profile's release and its own.
        within_s: Seconds to wait for missing endpoints.
        steady: Monotonic clock in seconds.
        sleep: Sleeps for the given seconds of that clock.

    Raises:
        ProfileError: The profile has no ROS 2 part.
    """
    tried = [_unfit(b) or b.make(transport) for b in _Bindings(profile, interfaces).all()]
    bindings = bindings_of(profile)
    nodes = _node_checks(bindings, transport, interfaces)
    checks = [*(t for t in tried if not isinstance(t, EndpointReport)), *nodes]
    begun, agreed = steady(), steady()
    while steady() < min(begun + within_s, agreed + _OTHER_RELEASE_S):
        seen = [check for check in checks if check.look()]
        if _agrees(bindings.distro, transport, bindings):
            agreed = steady()
        if len(seen) == len(checks) and steady() > begun + _SETTLED_S:
            break
        sleep(_LOOK_S)
    reports = [t if isinstance(t, EndpointReport) else t.report() for t in tried]
    heard = heard_releases(transport, bindings)
    return ProfileReport(
        endpoints=(*reports, *(check.report() for check in nodes if check.found)),
        insisted=bindings.distro,
        heard=None if heard is None else tuple(heard),
    )


def _agrees(insisted: Distro | None, transport: Transport, bindings: Ros2Bindings) -> bool:
    """Return False once the robot is heard to have another release than the profile insists on."""
    if insisted is None or (heard := heard_releases(transport, bindings)) is None:
        return True
    return insisted in heard


def _node_checks(ros2: Ros2Bindings, transport: Transport, interfaces: Interfaces) -> list[LifecycleCheck]:
    """Return a check of each node of the navigation that may have a lifecycle."""
    names = ((node, ros2.whole_name(f"{node}/get_state")) for node in ros2.navigation.nodes)
    return [
        LifecycleCheck(
            EndpointBinding(part=f"navigation: {node}", kind="service", name=name, type=GET_STATE),
            transport,
            interfaces,
        )
        for node, name in names
    ]


def _unfit(bound: _Bound) -> EndpointReport | None:
    if not bound.wrong:
        return None
    return EndpointReport(binding=bound.binding, usable=False, what="; ".join(bound.wrong), advice=_CORRECT)


class _Bindings:
    """All endpoints that a profile binds."""

    def __init__(self, profile: RobotProfile, interfaces: Interfaces) -> None:
        self._profile, self._ros2, self._interfaces = profile, bindings_of(profile), interfaces
        self._fix: TopicCheck | None = None

    def all(self) -> tuple[_Bound, ...]:
        """Return the endpoints in the order of the profile."""
        return tuple(self._each(self._ros2))

    def _each(self, ros2: Ros2Bindings) -> Iterator[_Bound]:
        bound = ros2.navigation
        yield self._call("navigation", "action", bound.action, bound.type)
        if bound.working:
            yield self._call("navigation: working", "action", bound.working_action, bound.working)
        if bound.from_ll and bound.type != "nav2_msgs/action/FollowGPSWaypoints":
            yield self._call("navigation: from_ll", "service", bound.from_ll, FROM_LL, question=self._here)
        if bound.speed_limit:
            yield self._subscribed_topic("navigation: speed_limit", bound.speed_limit, SPEED_LIMIT)
        yield self._position(ros2)
        charge = ros2.battery.value
        yield self._topic("battery", ros2.battery.topic, plausibility.battery(ros2.battery), [(charge.path, _NUMBERS)])
        if ros2.odometry is not None:
            yield self._topic("odometry", ros2.odometry, plausibility.odometry)
        if ros2.odometer is not None:
            counter, value = ros2.odometer, ros2.odometer.value
            yield self._topic("odometer", counter.topic, plausibility.odometer(counter), [(value.path, _NUMBERS)])
        if ros2.stop is not None:
            yield self._topic("stop", ros2.stop.topic, plausibility.stop(ros2.stop), [(ros2.stop.path, ("bool",))])
        for name, event in ros2.events.items():
            yield self._event(name, event)
        if ros2.use_sim_time:
            time = TopicBinding(topic=ros_clock.TOPIC, type=ros_clock.TYPE, stale_s=0.0)
            yield self._topic("use_sim_time", time, plausibility.clock)
        for name, action in ros2.actions.items():
            part = f"actions: {name}"
            if action.call is not None:
                wrong = tuple(self._wrong_call(action.call, self._profile.doable[name]))
                yield self._call(part, action.call.kind, action.call.name, action.call.type, wrong)
            if action.switch is not None:
                yield self._switch(part, action.switch, self._profile.action[name])
            for quantity, bound_topic in action.topics.items():
                yield self._topic(
                    f"{part}: {quantity}",
                    TopicBinding(
                        topic=bound_topic.topic,
                        type=bound_topic.type,
                        stale_s=bound_topic.within_s,
                        reliable=bound_topic.reliable,
                    ),
                    plausibility.reading(bound_topic.value, self._profile.quantity[quantity]),
                    [(bound_topic.value.path, _NUMBERS)],
                    rare=action.call is not None,
                )
            for label, image in action.images.items():
                yield self._topic(
                    f"{part}: image {label}",
                    TopicBinding(topic=image.topic, type=image.type, stale_s=image.within_s, reliable=image.reliable),
                    plausibility.image(label),
                    rare=action.call is not None,
                )

    def _position(self, ros2: Ros2Bindings) -> _Bound:
        bound = self._topic("position", ros2.position.fix, plausibility.position(ros2.position))

        def make(transport: Transport) -> EndpointCheck:
            check = bound.make(transport)
            assert isinstance(check, TopicCheck)  # noqa: S101 - a topic is
            self._fix = check
            return check

        return _Bound(binding=bound.binding, wrong=bound.wrong, make=make)

    def _event(self, name: str, bound: EventBinding) -> _Bound:
        lists = self._is_list(bound.topic.type, bound.value.path)
        check = plausibility.event(bound, self._profile.event[name])
        return self._topic(f"events: {name}", bound.topic, check, () if lists else [(bound.value.path, _NUMBERS)])

    def _is_list(self, type_name: str, path: str) -> bool:
        """Return True if a path leads to a list, whose length counts."""
        try:
            return self._interfaces.field_at(type_name, path).many != "one"
        except Ros2Error:
            return False

    def _here(self) -> RosMessage | None:
        """Return a request with the robot's position for the map service; None without a valid fix."""
        fix = self._fix.message if self._fix is not None else None
        if fix is None or fix_problem(fix, self._ros2.position) is not None:
            return None
        return {"ll_point": {"latitude": fix["latitude"], "longitude": fix["longitude"]}}

    def _topic(
        self,
        part: str,
        bound: TopicBinding,
        check_message: MessageCheck,
        paths: _Paths = (),
        *,
        rare: bool = False,
    ) -> _Bound:
        """Return a topic that the robot publishes.

        Args:
            paths: Field paths that the mission reads, with their allowed types.
            rare: True if the topic is published on demand. Transient local topics are published on change, so they are
                rare, too.
        """
        binding = EndpointBinding(part=part, kind="topic", name=self._ros2.whole_name(bound.topic), type=bound.type)
        qos = QosProfile(reliable=bound.reliable, transient=bound.transient)
        rare = rare or bound.transient
        return _Bound(
            binding=binding,
            wrong=tuple(self._wrong(bound.type, bound.type, paths)),
            make=lambda transport: TopicCheck(binding, transport, self._interfaces, qos, check_message, rare=rare),
        )

    def _subscribed_topic(self, part: str, topic: str, type_name: str) -> _Bound:
        """Return a topic that the robot subscribes to."""
        binding = EndpointBinding(part=part, kind="topic", name=self._ros2.whole_name(topic), type=type_name)
        wrong = tuple(self._wrong(type_name, type_name, ()))
        return _Bound(binding=binding, wrong=wrong, make=lambda transport: SubscriberCheck(binding, transport))

    def _switch(self, part: str, switch: SwitchBinding, action: Action) -> _Bound:
        """Return the switch of an implement."""
        asked = switch.type if switch.kind == "topic" else f"{switch.type}_Request"
        wrong: list[str] = []
        for values in (switch.on, switch.off):
            try:
                message = message_of({path: _example(value, action) for path, value in values.items()})
                self._interfaces.complete(asked, message)
            except Ros2Error as error:
                wrong.append(str(error))
        if switch.kind == "topic":
            found = self._subscribed_topic(part, switch.name, switch.type)
            return replace(found, wrong=(*found.wrong, *wrong))
        flags = [(path, kinds) for path, kinds in ((switch.success, ("bool",)), (switch.message, ("string",))) if path]
        wrong += self._wrong(switch.type, f"{switch.type}_Response", flags)
        return self._call(part, "service", switch.name, switch.type, tuple(wrong))

    def _call(
        self,
        part: str,
        kind: Literal["action", "service"],
        name: str,
        type_name: str,
        wrong: tuple[str, ...] = (),
        question: Callable[[], RosMessage | None] | None = None,
    ) -> _Bound:
        whole = self._ros2.whole_name(name)
        binding = EndpointBinding(part=part, kind=kind, name=whole, type=type_name)

        def make(transport: Transport) -> EndpointCheck:
            if kind == "action":
                return ActionCheck(binding, transport, self._interfaces)
            return ServiceCheck(binding, transport, self._interfaces, question)

        unknown = tuple(self._wrong(type_name, f"{type_name}{'_Goal' if kind == 'action' else '_Request'}", ()))
        return _Bound(binding=binding, wrong=unknown or wrong, make=make)

    def _wrong_call(self, call: CallBinding, action: Action) -> Iterator[str]:
        """Yield the mismatches between a call and its type."""
        asked, answered = ("Goal", "Result") if call.kind == "action" else ("Request", "Response")
        try:
            values = message_of({path: _example(value, action) for path, value in call.request.items()})
            self._interfaces.complete(f"{call.type}_{asked}", values)
        except Ros2Error as error:
            yield str(error)
        paths = [(binding.path, _NUMBERS) for binding in call.readings.values()]
        paths += [(path, kinds) for path, kinds in ((call.success, ("bool",)), (call.message, ("string",))) if path]
        yield from self._wrong(call.type, f"{call.type}_{answered}", paths)
        for path in call.images.values():
            try:
                kind = self._interfaces.field_at(f"{call.type}_{answered}", path).base
            except Ros2Error as error:
                yield str(error)
                continue
            if kind not in IMAGE_TYPES:
                yield f"{path} of {call.type} is {kind}, not an image ({' or '.join(IMAGE_TYPES)})"

    def _wrong(self, type_name: str, message: str, paths: _Paths) -> Iterator[str]:
        """Yield an unknown type, or the paths that do not lead to a value of an allowed type."""
        try:
            self._interfaces.definition(message)
        except Ros2Error as error:
            yield error.what
            return
        for path, kinds in paths:
            try:
                kind = self._interfaces.field_at(message, path)
            except Ros2Error as error:
                yield str(error)
                continue
            if kind.many != "one" or kind.base not in kinds:
                yield f"{path} of {type_name} is {kind}, not {'a number' if kinds == _NUMBERS else kinds[0]}"


def _example(value: RequestValue, action: Action) -> RequestValue:
    """Return an example value for a reference in a request."""
    if not isinstance(value, str) or not value.startswith("$"):
        return value
    if value in ("$place", "$kind"):
        return "place"
    return next((p.default for p in action.parameters if p.name == value[1:]), 0.0)
