"""The actions and services of ROS that a profile binds its actions to: each makes a capture of the body."""

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
from fieldhand.execution.drivers.ros2.transport import Message, Server, Transport
from fieldhand.robot.bindings import CallBinding
from fieldhand.robot.model import Action
from fieldhand.site.model import Place

Parameters = dict[str, str | float]
#: Told of each capture: of which action, where, and how it ended.
CaptureCallback = Callable[[str, Place, Progress], None]


class CaptureCall:
    """What both kinds of calls have in common: which capture is meant, and what is answered.

    Args:
        action: Of the profile.
        call: What it is bound to.
        interfaces: With the type of the call.
        body: Makes the capture.
        places: Which place is meant.
        say: Told of each capture that is over.

    Raises:
        Ros2Error: A path of the binding leads nowhere in its type.
    """

    def __init__(
        self,
        action: Action,
        call: CallBinding,
        interfaces: Interfaces,
        platform: SimulatedPlatform,
        places: PlaceLookup,
        report: CaptureCallback,
    ) -> None:
        self.action, self.call, self.platform = action, call, platform
        self._interfaces, self._places, self._report = interfaces, places, report
        self._answer = f"{call.type}_{'Result' if call.kind == 'action' else 'Response'}"
        for binding in call.readings.values():
            interfaces.field_at(self._answer, binding.path)
        for path in filter(None, (call.success, call.message)):
            interfaces.field_at(self._answer, path)

    def begin(self, request: Message, over: Callable[[Message, bool], None]) -> None:
        """Make the capture that a request asks for.

        Args:
            over: Told what is to be answered, and whether it succeeded.
        """
        place = self._place(request)

        def done(progress: Progress) -> None:
            self._report(self.action.name, place, progress)
            over(*self.answer(progress))

        self.platform.capture(self.action.name, place, self._parameters(request), done)

    def answer(self, progress: Progress) -> tuple[Message, bool]:
        """What a capture came to, as the type of the call has it, and whether it succeeded."""
        if progress.state != "succeeded":
            return self.failure(progress.what or progress.state), False
        values: dict[str, object] = {self.call.success: True} if self.call.success else {}
        for name, binding in self.call.readings.items():
            values[binding.path] = field_value(self._interfaces, self._answer, binding, progress.readings.get(name))
            if values[binding.path] is None:
                return self.failure(f"there is no reading of {name}"), False
        return message_of(values), True

    def failure(self, why: str) -> Message:
        """An answer that says why not, as far as its type can."""
        said = ((self.call.success, False), (self.call.message, why))
        return message_of({path: value for path, value in said if path})

    def _place(self, request: Message) -> Place:
        named = {value: path for path, value in self.call.request.items() if isinstance(value, str)}
        at = self.platform.position
        identity, kind = (_text(request, named.get(reference)) for reference in ("$place", "$kind"))
        return self._places.named(identity, kind, (at.x, at.y))

    def _parameters(self, request: Message) -> Parameters:
        found: Parameters = {parameter.name: parameter.default for parameter in self.action.parameters}
        for path, value in self.call.request.items():
            name = value.removeprefix("$") if isinstance(value, str) and value.startswith("$") else ""
            given = value_at(request, path)
            if name in found and isinstance(given, (str, float, int)):
                found[name] = given
        return found


class CaptureActionHandler:
    """Goal handler that serves a capture as a ROS action."""

    def __init__(self, capture_call: CaptureCall) -> None:
        self._call = capture_call
        self._goal: ServerGoal | None = None

    def rejection_reason(self, goal: Message) -> str | None:  # noqa: ARG002  any that its type allows is one
        activity = self._call.platform.activity
        return f"the robot is {activity}" if activity else None

    def begin(self, goal: ServerGoal) -> None:
        self._goal = goal
        self._call.begin(goal.asked, self._over)

    def cancel(self, goal: ServerGoal) -> None:
        if goal is self._goal:
            self._goal = None
            self._call.platform.stop_now()
            goal.cancelled(self._call.failure("cancelled"))

    def _over(self, result: Message, succeeded: bool) -> None:
        goal, self._goal = self._goal, None
        if goal is not None:
            (goal.succeeded if succeeded else goal.aborted)(result)


class CaptureServiceServer:
    """A capture as a service, answered when it is over. A failure that its type cannot say is not answered at all."""

    def __init__(self, capture_call: CaptureCall, transport: Transport, name: str) -> None:
        self._call = capture_call
        self._server: Server = transport.serve(name, capture_call.call.type)

    def step(self) -> None:
        """Take what was asked meanwhile."""
        for to, request in self._server.requests():
            activity = self._call.platform.activity
            if activity:
                self._reply(to, self._call.failure(f"the robot is {activity}"), False)
            else:
                self._call.begin(request, partial(self._reply, to))

    def _reply(self, to: object, answer: Message, succeeded: bool) -> None:
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
    """Serve a call of a profile under its whole name.

    Raises:
        Ros2Error: Its type is not known.
    """
    if capture_call.call.kind == "service":
        return CaptureServiceServer(capture_call, transport, name)
    handler = CaptureActionHandler(capture_call)
    return ActionServer(transport, name, capture_call.call.type, handler, stamp=stamp, refused=refused)


def _text(request: Message, path: str | None) -> str:
    """What stands at a path, as text; numbers as people write them."""
    value = None if path is None else value_at(request, path)
    return "" if value is None else str(value)
