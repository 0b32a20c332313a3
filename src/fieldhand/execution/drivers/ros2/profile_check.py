"""Every binding of a profile held against its types, and tried on the robot itself: what is missing, and what to do.

Nothing is asked of the robot that moves or measures: it is listened to, and who would answer is looked for. Only the
map service of its localization is asked where a point lies.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

from fieldhand.errors import ProfileError, Ros2Error
from fieldhand.execution.drivers.ros2 import plausibility, ros_clock
from fieldhand.execution.drivers.ros2.endpoint_checks import (
    ActionCheck,
    EndpointBinding,
    EndpointCheck,
    EndpointReport,
    ServiceCheck,
    SubscriberCheck,
    TopicCheck,
)
from fieldhand.execution.drivers.ros2.interfaces import Interfaces
from fieldhand.execution.drivers.ros2.interfaces.definitions import FLOATS, INTEGERS
from fieldhand.execution.drivers.ros2.message_fields import message_of
from fieldhand.execution.drivers.ros2.navigation import FROM_LL, SPEED_LIMIT
from fieldhand.execution.drivers.ros2.plausibility import MessageCheck
from fieldhand.execution.drivers.ros2.telemetry import fix_problem
from fieldhand.execution.drivers.ros2.transport import Message, QosProfile, Rmw, Transport
from fieldhand.robot.bindings import CallBinding, RequestValue, Ros2Bindings, TopicBinding
from fieldhand.robot.model import Action, RobotProfile

_NUMBERS = (*INTEGERS, *FLOATS, "bool")
_CORRECT = "correct it in the profile's ros2 part"
#: Seconds of the steady clock between two looks.
_LOOK_S = 0.02
#: Seconds after which a second robot has been found, too, if there is one.
_SETTLED_S = 1.0

#: Paths into a message, each with the kinds of value that are right there.
_Paths = Sequence[tuple[str, tuple[str, ...]]]


@dataclass(frozen=True, kw_only=True)
class ProfileReport:
    """What a robot has of what its profile says."""

    endpoints: tuple[EndpointReport, ...]

    @property
    def rmw(self) -> tuple[Rmw, ...]:
        """Which middleware it runs, by everything that was seen of it."""
        return tuple(sorted({rmw for endpoint in self.endpoints for rmw in endpoint.rmw}))

    @property
    def missing(self) -> tuple[EndpointReport, ...]:
        """What a mission could not use."""
        return tuple(f for f in self.endpoints if not f.usable)


@dataclass(frozen=True, kw_only=True)
class _Bound:
    """A binding.

    Attributes:
        wrong: What of it does not fit its type, whatever the robot has.
        make: How it is tried.
    """

    binding: EndpointBinding
    wrong: tuple[str, ...]
    make: Callable[[Transport], EndpointCheck]


def bindings_of(profile: RobotProfile) -> Ros2Bindings:
    """What a profile says of ROS 2.

    Raises:
        ProfileError: Nothing.
    """
    if profile.ros2 is None:
        raise ProfileError(
            f"the profile of {profile.name} does not say how the robot is reached over ROS 2",
            where=profile.source,
            advice="add a part ros2 (docs/formats.md)",
        )
    return profile.ros2


def check_types(profile: RobotProfile, interfaces: Interfaces) -> ProfileReport:
    """Hold every binding against its type, without a robot.

    Raises:
        ProfileError: The profile says nothing of ROS 2.
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
    """Try every binding on the robot.

    Args:
        interfaces: Of the profile's release, with its own.
        within_s: How long to wait for what is not there yet.
        steady: Seconds of a clock that nobody sets.
        sleep: Waits so many of them.

    Raises:
        ProfileError: The profile says nothing of ROS 2.
    """
    tried = [_unfit(b) or b.make(transport) for b in _Bindings(profile, interfaces).all()]
    checks = [t for t in tried if not isinstance(t, EndpointReport)]
    begun = steady()
    while steady() < begun + within_s:
        seen = [check for check in checks if check.look()]
        if len(seen) == len(checks) and steady() > begun + _SETTLED_S:
            break
        sleep(_LOOK_S)
    return ProfileReport(endpoints=tuple(t if isinstance(t, EndpointReport) else t.report() for t in tried))


def _unfit(bound: _Bound) -> EndpointReport | None:
    if not bound.wrong:
        return None
    return EndpointReport(binding=bound.binding, usable=False, what="; ".join(bound.wrong), advice=_CORRECT)


class _Bindings:
    """Everything that a profile binds, in its order."""

    def __init__(self, profile: RobotProfile, interfaces: Interfaces) -> None:
        self._profile, self._ros2, self._interfaces = profile, bindings_of(profile), interfaces
        self._fix: TopicCheck | None = None

    def all(self) -> tuple[_Bound, ...]:
        """In the order of the profile."""
        return tuple(self._each(self._ros2))

    def _each(self, ros2: Ros2Bindings) -> Iterator[_Bound]:
        bound = ros2.navigation
        yield self._call("navigation", "action", bound.action, bound.type)
        if bound.from_ll and bound.type != "nav2_msgs/action/FollowGPSWaypoints":
            yield self._call("navigation: from_ll", "service", bound.from_ll, FROM_LL, question=self._here)
        if bound.speed_limit:
            yield self._told("navigation: speed_limit", bound.speed_limit, SPEED_LIMIT)
        yield self._position(ros2)
        charge = ros2.battery.value
        yield self._topic("battery", ros2.battery.topic, plausibility.battery(ros2.battery), [(charge.path, _NUMBERS)])
        if ros2.odometry is not None:
            yield self._topic("odometry", ros2.odometry, plausibility.odometry)
        if ros2.stop is not None:
            yield self._topic("stop", ros2.stop.topic, plausibility.stop(ros2.stop), [(ros2.stop.path, ("bool",))])
        if ros2.use_sim_time:
            time = TopicBinding(topic=ros_clock.TOPIC, type=ros_clock.TYPE, stale_s=0.0)
            yield self._topic("use_sim_time", time, plausibility.clock)
        for name, action in ros2.actions.items():
            part = f"actions: {name}"
            if action.call is not None:
                wrong = tuple(self._wrong_call(action.call, self._profile.action[name]))
                yield self._call(part, action.call.kind, action.call.name, action.call.type, wrong)
            for quantity, heard in action.topics.items():
                yield self._topic(
                    f"{part}: {quantity}",
                    TopicBinding(topic=heard.topic, type=heard.type, stale_s=heard.within_s, reliable=heard.reliable),
                    plausibility.reading(heard.value, self._profile.quantity[quantity]),
                    [(heard.value.path, _NUMBERS)],
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

    def _here(self) -> Message | None:
        """Where the robot is, for the map service; None while nobody knows."""
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
        """A topic.

        Args:
            paths: Into its messages, with the kinds of value that are right there.
            rare: It speaks when it is asked to. What is kept for who comes late speaks when something changes.
        """
        binding = EndpointBinding(part=part, kind="topic", name=self._ros2.whole_name(bound.topic), type=bound.type)
        qos = QosProfile(reliable=bound.reliable, transient=bound.transient)
        rare = rare or bound.transient
        return _Bound(
            binding=binding,
            wrong=tuple(self._wrong(bound.type, bound.type, paths)),
            make=lambda transport: TopicCheck(binding, transport, self._interfaces, qos, check_message, rare=rare),
        )

    def _told(self, part: str, topic: str, type_name: str) -> _Bound:
        """A topic by which the robot is told something."""
        binding = EndpointBinding(part=part, kind="topic", name=self._ros2.whole_name(topic), type=type_name)
        wrong = tuple(self._wrong(type_name, type_name, ()))
        return _Bound(binding=binding, wrong=wrong, make=lambda transport: SubscriberCheck(binding, transport))

    def _call(
        self,
        part: str,
        kind: Literal["action", "service"],
        name: str,
        type_name: str,
        wrong: tuple[str, ...] = (),
        question: Callable[[], Message | None] | None = None,
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
        """What of a call does not fit its type."""
        asked, told = ("Goal", "Result") if call.kind == "action" else ("Request", "Response")
        try:
            values = message_of({path: _example(value, action) for path, value in call.request.items()})
            self._interfaces.complete(f"{call.type}_{asked}", values)
        except Ros2Error as error:
            yield str(error)
        paths = [(binding.path, _NUMBERS) for binding in call.readings.values()]
        paths += [(path, kinds) for path, kinds in ((call.success, ("bool",)), (call.message, ("string",))) if path]
        yield from self._wrong(call.type, f"{call.type}_{told}", paths)

    def _wrong(self, type_name: str, message: str, paths: _Paths) -> Iterator[str]:
        """Paths that do not lead to a value of the right kind, or that the type is not known at all."""
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
    """What could stand for a reference in a request."""
    if not isinstance(value, str) or not value.startswith("$"):
        return value
    if value in ("$place", "$kind"):
        return "place"
    return next((p.default for p in action.parameters if p.name == value[1:]), 0.0)
