"""Servers of the ROS actions and services that a profile binds its actions to; each makes a capture."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial

from fieldhand.execution.drivers.protocol import Progress
from fieldhand.execution.drivers.ros2.interfaces import Interfaces
from fieldhand.execution.drivers.ros2.message_fields import message_of, value_at
from fieldhand.execution.drivers.ros2.simulated_robot.action_server import ActionServer, ServerGoal
from fieldhand.execution.drivers.ros2.simulated_robot.field_values import field_value
from fieldhand.execution.drivers.ros2.simulated_robot.place_lookup import PlaceLookup
from fieldhand.execution.drivers.ros2.simulated_robot.robot_platform import SimulatedPlatform
from fieldhand.execution.drivers.ros2.transport import RosMessage, Server, Transport
from fieldhand.robot.bindings import CallBinding
from fieldhand.robot.model import Action
from fieldhand.site.model import Place

Parameters = dict[str, str | float]
#: Called after each capture with the action, the place, and the result.
CaptureCallback = Callable[[str, Place, Progress], None]


class CaptureCall:
    """A call that makes a capture, served as an action or as a service.

    Args:
        action: Action of the profile.
        call: Action or service that it is bound to.
        interfaces: Definitions that include the type of the call.
        platform: Makes the capture.
        places: Finds the place of a request.
        report: Called after each capture.
        images: Returns the images of a reply by path, for its type.

    Raises:
        Ros2Error: A path of the binding does not exist in its type.
    """

    def __init__(
        self,
        action: Action,
        call: CallBinding,
        interfaces: Interfaces,
        platform: SimulatedPlatform,
        places: PlaceLookup,
        report: CaptureCallback,
        *,
        images: Callable[[str], Mapping[str, object]] = lambda _: {},
    ) -> None:
        self._images = images
        self.action, self.call, self.platform = action, call, platform
        self._interfaces, self._places, self._report = interfaces, places, report
        self._answer = f"{call.type}_{'Result' if call.kind == 'action' else 'Response'}"
        for binding in call.readings.values():
            interfaces.field_at(self._answer, binding.path)
        for path in filter(None, (call.success, call.message, *call.images.values())):
            interfaces.field_at(self._answer, path)

    def begin(self, request: RosMessage, over: Callable[[RosMessage, bool], None]) -> None:
        """Start the capture that a request asks for.

        Args:
            over: Called at the end with the reply, and True if the capture succeeded.
        """
        place = self._place(request)

        def done(progress: Progress) -> None:
            self._report(self.action.name, place, progress)
            over(*self.answer(progress))

        self.platform.capture(self.action.name, place, self._parameters(request), done)

    def answer(self, progress: Progress) -> tuple[RosMessage, bool]:
        """Return the reply for the end of a capture, and True if it succeeded."""
        if progress.state != "succeeded":
            return self.failure(progress.what or progress.state), False
        values: dict[str, object] = {self.call.success: True} if self.call.success else {}
        for name, binding in self.call.readings.items():
            values[binding.path] = field_value(self._interfaces, self._answer, binding, progress.readings.get(name))
            if values[binding.path] is None:
                return self.failure(f"there is no reading of {name}"), False
        return message_of({**values, **self._images(self._answer)}), True

    def failure(self, why: str) -> RosMessage:
        """Return a reply that reports a failure, as far as its type has fields for it."""
        fields = ((self.call.success, False), (self.call.message, why))
        return message_of({path: value for path, value in fields if path})

    def _place(self, request: RosMessage) -> Place:
        named = {value: path for path, value in self.call.request.items() if isinstance(value, str)}
        at = self.platform.position
        identity, kind = (_text(request, named.get(reference)) for reference in ("$place", "$kind"))
        return self._places.named(identity, kind, at.xy)

    def _parameters(self, request: RosMessage) -> Parameters:
        found: Parameters = {parameter.name: parameter.default for parameter in self.action.parameters}
        for path, value in self.call.request.items():
            name = value.removeprefix("$") if isinstance(value, str) and value.startswith("$") else ""
            given = value_at(request, path)
            if name in found and isinstance(given, (str, float, int)):
                found[name] = given
        return found


class CaptureActionHandler:
    """A :class:`GoalHandler` that serves a capture as a ROS action."""

    def __init__(self, capture_call: CaptureCall) -> None:
        self._call = capture_call
        self._goal: ServerGoal | None = None

    def rejection_reason(self, goal: RosMessage) -> str | None:  # noqa: ARG002  any that its type allows is one
        activity = self._call.platform.activity
        return f"the robot is {activity}" if activity else None

    def begin(self, goal: ServerGoal) -> None:
        self._goal = goal
        self._call.begin(goal.goal_message, self._over)

    def cancel(self, goal: ServerGoal) -> None:
        if goal is self._goal:
            self._goal = None
            self._call.platform.stop_now()
            goal.cancelled(self._call.failure("cancelled"))

    def _over(self, result: RosMessage, succeeded: bool) -> None:
        goal, self._goal = self._goal, None
        if goal is not None:
            (goal.succeeded if succeeded else goal.aborted)(result)


class CaptureServiceServer:
    """Serves a capture as a ROS service; replies when it ends. If the type cannot report failure, a failed call gets no
    reply.
    """

    def __init__(self, capture_call: CaptureCall, transport: Transport, name: str) -> None:
        self._call = capture_call
        self._server: Server = transport.serve(name, capture_call.call.type)

    def step(self) -> None:
        """Process the requests received since the last call."""
        for to, request in self._server.requests():
            activity = self._call.platform.activity
            if activity:
                self._reply(to, self._call.failure(f"the robot is {activity}"), False)
            else:
                self._call.begin(request, partial(self._reply, to))

    def _reply(self, to: object, answer: RosMessage, succeeded: bool) -> None:
        if succeeded or self._call.call.success:
            self._server.reply(to, answer)


CaptureServer = ActionServer | CaptureServiceServer


def capture_server(
    capture_call: CaptureCall,
    transport: Transport,
    name: str,
    *,
    stamp: Callable[[], Mapping[str, int]],
    refused: Callable[[str], None],
) -> CaptureServer:
    """Create the server of a call under its full name.

    Raises:
        Ros2Error: The type is unknown.
    """
    if capture_call.call.kind == "service":
        return CaptureServiceServer(capture_call, transport, name)
    handler = CaptureActionHandler(capture_call)
    return ActionServer(transport, name, capture_call.call.type, handler, stamp=stamp, refused=refused)


def _text(request: RosMessage, path: str | None) -> str:
    """Return the value at a path as text."""
    value = None if path is None else value_at(request, path)
    return "" if value is None else str(value)
