"""Captures as the profile binds them: a ROS action or service call, and topics that carry the readings.

    request ──▶ call ──▶ readings of its result ──▶ next message of each topic ──▶ the mission

A triggered sensor may publish its reading before the call returns and nothing afterwards; a streaming sensor publishes
old values until it has measured. So the first message after the reply counts; if none arrives in time, the last one
since the call was sent. A missing or NaN value is a missing reading, which the mission judges. A topic without any
message is a failure that names the topic.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Collection, Generator, Iterator, Mapping
from dataclasses import dataclass, field

from fieldhand.errors import Ros2Error
from fieldhand.execution.drivers.protocol import ActionGoal, CapturedImage
from fieldhand.execution.drivers.ros2.action_client import ActionClient
from fieldhand.execution.drivers.ros2.action_outcome import ActionOutcome, GoalEnd
from fieldhand.execution.drivers.ros2.images import image_of
from fieldhand.execution.drivers.ros2.message_fields import message_of, number_at, value_at
from fieldhand.execution.drivers.ros2.service_call import TimeLimit, call_service
from fieldhand.execution.drivers.ros2.transport import (
    MOST_IMAGE_BYTES,
    Client,
    QosProfile,
    RosMessage,
    Subscription,
    Transport,
)
from fieldhand.execution.robot_text import robot_text
from fieldhand.robot.bindings import ActionBinding, CallBinding, NextImage, NextMessage, RequestValue, Ros2Bindings

#: Seconds to find an action server, and to get a goal accepted.
ACCEPT_S = 5.0

#: Messages of a topic that are kept between two polls; of images only the newest.
_DEPTH, _IMAGES = 10, 1

GoalSteps = Generator[None, None, GoalEnd]
Steps = Generator[None, None, None]
_IMAGE = "image: "
Readings = dict[str, float]


@dataclass(frozen=True, kw_only=True)
class BoundAction:
    """An action of the profile with the endpoints it is bound to.

    Attributes:
        action, service: Client of the call; at most one of them is set.
    """

    binding: ActionBinding
    action: ActionClient | None = None
    service: Client | None = None
    topics: Mapping[str, tuple[str, Subscription]] = field(default_factory=dict)

    def close(self) -> None:
        """Close the endpoints without sending anything."""
        for end in (self.action, self.service, *(subscription for _, subscription in self.topics.values())):
            if end is not None:
                end.close()


class CaptureClient:
    """Clients and subscriptions for every action that the profile binds.

    Args:
        transport: Transport of the robot's graph.
        bindings: ROS 2 bindings of the robot.
        clock: Mission clock in seconds, for the time limit of a capture.
        steady: Monotonic clock in seconds, for the time limit of a reply.
        new_id: Returns goal ids.
        only: Names of the actions to bind; None for all.

    Raises:
        Ros2Error: A type is unknown.
    """

    def __init__(
        self,
        transport: Transport,
        bindings: Ros2Bindings,
        *,
        clock: Callable[[], float],
        steady: Callable[[], float],
        new_id: Callable[[], bytes],
        only: Collection[str] | None = None,
    ) -> None:
        self.clock, self.steady, self._bindings, self._transport = clock, steady, bindings, transport
        self.bound = {
            name: self._bind(transport, binding, new_id)
            for name, binding in bindings.actions.items()
            if only is None or name in only
        }

    @property
    def actions(self) -> tuple[ActionClient, ...]:
        """Clients of the captures that are ROS actions."""
        return tuple(bound.action for bound in self.bound.values() if bound.action is not None)

    def whole_name(self, name: str) -> str:
        """Return a name with the robot's namespace."""
        return self._bindings.whole_name(name)

    def subscribe(self, image: NextImage) -> tuple[str, Subscription]:
        """Subscribe to an image, and return the full name of its topic, too. The caller closes it.

        Images are large, so the program listens to them only during a capture.
        """
        name, qos = self.whole_name(image.topic), QosProfile(reliable=image.reliable, depth=_IMAGES)
        return name, self._transport.subscribe(name, image.type, qos)

    def close(self) -> None:
        """Close all endpoints without sending anything."""
        for bound in self.bound.values():
            bound.close()

    def _bind(self, transport: Transport, binding: ActionBinding, new_id: Callable[[], bytes]) -> BoundAction:
        call, action, service = binding.call, None, None
        if call is not None and call.kind == "action":
            action = ActionClient(
                transport,
                self.whole_name(call.name),
                call.type,
                steady=self.steady,
                accept_s=min(ACCEPT_S, call.within_s),
                new_id=new_id,
            )
        elif call is not None:
            service = transport.client(self.whole_name(call.name), call.type)
        topics = {}
        for quantity, message in binding.topics.items():
            name, qos = self.whole_name(message.topic), QosProfile(reliable=message.reliable, depth=_DEPTH)
            topics[quantity] = name, transport.subscribe(name, message.type, qos)
        return BoundAction(binding=binding, action=action, service=service, topics=topics)


class _LatestMessages:
    """Latest message of each topic since the last call of :meth:`forget`."""

    def __init__(self, topics: Mapping[str, tuple[str, Subscription]]) -> None:
        self._topics = topics
        self.last: dict[str, RosMessage] = {}

    def forget(self) -> None:
        """Discard everything received so far."""
        self.listen()
        self.last.clear()

    def listen(self) -> None:
        """Take the messages received since the last call."""
        for quantity, (_, subscription) in self._topics.items():
            for message in subscription.take()[-1:]:
                self.last[quantity] = message


class RunningCapture:
    """A capture in progress, advanced by :meth:`step`."""

    def __init__(self, captures: CaptureClient, goal: ActionGoal) -> None:
        self._captures, self._goal = captures, goal
        self._cancelled = False
        self._steps = self._carry_out()
        self._ending: GoalEnd | None = None

    def step(self) -> GoalEnd | None:
        """Advance the capture; return None while it runs."""
        if self._ending is None:
            try:
                next(self._steps)
            except StopIteration as done:
                self._ending = done.value
            except Ros2Error as error:
                self._ending = _failed(str(error))
        return self._ending

    def cancel(self) -> None:
        """Request cancellation; :meth:`step` reports the end. A service that was already called is not interrupted."""
        self._cancelled = True

    def _carry_out(self) -> GoalSteps:
        bound = self._captures.bound.get(self._goal.action)
        if bound is None:
            return _failed(f"the profile does not define how {self._goal.action} is done over ROS 2")
        images = {name: self._captures.subscribe(image) for name, image in bound.binding.images.items()}
        try:
            yield from self._await_publishers(bound, images)
            return (yield from self._take(bound, images))
        finally:
            for _, subscription in images.values():
                subscription.close()

    def _await_publishers(self, bound: BoundAction, images: Mapping[str, tuple[str, Subscription]]) -> Steps:
        """Wait until the images would be received; without a publisher, until their time is over."""
        limits = {name: self._limit(image.within_s) for name, image in bound.binding.images.items()}
        while not self._cancelled:
            if all(images[name][1].publishers() or limit.over for name, limit in limits.items()):
                return
            yield

    def _take(self, bound: BoundAction, images: Mapping[str, tuple[str, Subscription]]) -> GoalSteps:
        """Make the capture."""
        ending = GoalEnd(state="succeeded")
        call, latest = bound.binding.call, _LatestMessages({**bound.topics, **_keyed(images)})
        latest.forget()
        if call is not None:
            request = message_of({path: self._value(value) for path, value in call.request.items()})
            if bound.action is not None:
                ending = yield from self._call_action(bound.action, call, request, latest)
            elif bound.service is not None:
                ending = yield from self._call_service(bound.service, call, request, latest)
        if ending.state != "succeeded" or not (bound.topics or images):
            return ending
        return (yield from self._wait_for_topics(bound, latest, ending, images))

    def _value(self, value: RequestValue) -> RequestValue:
        """Return a constant, a parameter, or a property of the capture's place."""
        place = self._goal.place
        if not isinstance(value, str) or not value.startswith("$"):
            return value
        known: Mapping[str, RequestValue] = {
            **self._goal.parameters,
            "place": place.id,
            "kind": place.kind,
            "lat": place.lat,
            "lon": place.lon,
        }
        name = value.removeprefix("$")
        if name not in known:
            raise Ros2Error(f"{self._goal.action} has no parameter {name!r}, which its request needs")
        return known[name]

    def _limit(self, seconds: float) -> TimeLimit:
        return TimeLimit(seconds, self._captures.clock, self._captures.steady)

    def _call_action(
        self, client: ActionClient, call: CallBinding, request: RosMessage, latest: _LatestMessages
    ) -> GoalSteps:
        limit = self._limit(call.within_s)
        client.start(request, sending=latest.forget)
        while (outcome := client.step()) is None:
            if self._cancelled:
                client.cancel()
            elif limit.over:
                client.cancel(f"{client.name} did not end within {limit.seconds:g} s")
            yield
            latest.listen()
        return self._ending_of(outcome, call, client.name)

    def _ending_of(self, outcome: ActionOutcome, call: CallBinding, name: str) -> GoalEnd:
        if outcome.how == "succeeded":
            return capture_end(outcome.result, call, name)
        if outcome.moving:
            return _failed(f"{outcome.what}; check whether it runs on the robot, and what the robot does")
        if self._cancelled:
            return GoalEnd(state="cancelled")
        if outcome.how == "aborted":
            return _failed(f"{name} failed{_failure_message(outcome.result, call)}")
        return _failed(outcome.what or f"another client cancelled {name}")

    def _call_service(
        self, client: Client, call: CallBinding, request: RosMessage, latest: _LatestMessages
    ) -> GoalSteps:
        name, limit = self._captures.whole_name(call.name), self._limit(call.within_s)
        asking = call_service(client, name, [request], limit, self._captures.steady, sending=latest.forget)
        while not self._cancelled:
            try:
                next(asking)
            except StopIteration as answered:
                return capture_end(answered.value[0], call, name)
            yield
            latest.listen()
        return GoalEnd(state="cancelled")

    def _wait_for_topics(
        self,
        bound: BoundAction,
        latest: _LatestMessages,
        called: GoalEnd,
        images: Mapping[str, tuple[str, Subscription]],
    ) -> GoalSteps:
        """Wait for the next message of each topic; after the time limit, use the last one since the call was sent."""
        latest.listen()
        before = dict(latest.last)
        latest.forget()
        wanted: dict[str, tuple[NextMessage | NextImage, TimeLimit]] = {
            quantity: (message, self._limit(message.within_s)) for quantity, message in bound.binding.topics.items()
        }
        wanted |= {_key(name): (image, self._limit(image.within_s)) for name, image in bound.binding.images.items()}
        readings, taken = dict(called.readings), list(called.images)
        while not self._cancelled:
            latest.listen()
            for key, (message, limit) in list(wanted.items()):
                came = latest.last.get(key, before.get(key) if limit.over else None)
                if came is not None:
                    del wanted[key]
                    if isinstance(message, NextMessage):
                        readings |= _reading(key, number_at(came, message.value))
                    else:
                        label = key.removeprefix(_IMAGE)
                        taken.append(image_of(came, label, images[label][0]))
                elif limit.over and isinstance(message, NextMessage):
                    name = bound.topics[key][0]
                    return _failed(f"no message on {name} within {limit.seconds:g} s, so there is no {key}")
                elif limit.over:
                    label = key.removeprefix(_IMAGE)
                    most = f"one of more than {MOST_IMAGE_BYTES // 1024**2} MiB is not read"
                    return _failed(f"no image on {images[label][0]} within {limit.seconds:g} s ({most})")
            if not wanted:
                return GoalEnd(state="succeeded", readings=readings, images=tuple(taken))
            yield
        return GoalEnd(state="cancelled")


def capture_end(result: RosMessage, call: CallBinding, name: str) -> GoalEnd:
    """Return the end of a capture from the reply of its call: its readings, or a failure that the reply reports."""
    if call.success and not value_at(result, call.success):
        return _failed(f"{name} did not succeed{_failure_message(result, call)}")
    pairs = ((quantity, number_at(result, binding)) for quantity, binding in call.readings.items())
    readings = dict(itertools.chain.from_iterable(_reading(*pair).items() for pair in pairs))
    return GoalEnd(state="succeeded", readings=readings, images=tuple(_images(result, call, name)))


def _images(result: RosMessage, call: CallBinding, name: str) -> Iterator[CapturedImage]:
    """Yield the images of a reply.

    Raises:
        Ros2Error: One is missing or cannot be used.
    """
    for label, path in call.images.items():
        found = value_at(result, path)
        if not isinstance(found, Mapping):
            raise Ros2Error(f"{name} returned no image {label} at {path}")
        yield image_of(found, label, name)


def _key(image: str) -> str:
    """Return the key of an image among the topics of a capture; no quantity has such a name."""
    return f"{_IMAGE}{image}"


def _keyed(images: Mapping[str, tuple[str, Subscription]]) -> dict[str, tuple[str, Subscription]]:
    return {_key(name): found for name, found in images.items()}


def _reading(quantity: str, value: float | None) -> Readings:
    return {} if value is None else {quantity: value}


def _failure_message(result: RosMessage, call: CallBinding) -> str:
    """Return the failure message of a reply, with a leading colon; empty if it has none."""
    words = value_at(result, call.message) if call.message else None
    said = robot_text(words.strip()) if isinstance(words, str) else ""
    return f": {said}" if said else ""


def _failed(what: str) -> GoalEnd:
    return GoalEnd(state="failed", fault="failed", what=what)
