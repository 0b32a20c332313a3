"""The actions and services of ROS that a profile binds its actions to: each makes a capture of the body."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial

from fieldhand.execution.drivers.protocol import Progress
from fieldhand.execution.drivers.ros2.fields import message_of, value_at
from fieldhand.execution.drivers.ros2.interfaces import Interfaces
from fieldhand.execution.drivers.ros2.transport import Message, Server, Transport
from fieldhand.execution.drivers.ros2.twin.action_server import ActionServer, Goal
from fieldhand.execution.drivers.ros2.twin.body import Body
from fieldhand.execution.drivers.ros2.twin.ground import Places
from fieldhand.execution.drivers.ros2.twin.messages import as_sent
from fieldhand.robot.bindings import CallBinding
from fieldhand.robot.model import Action
from fieldhand.site.model import Place

Parameters = dict[str, str | float]
#: Told of each capture: of which action, where, and how it ended.
Say = Callable[[str, Place, Progress], None]


class Capturing:
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
        self, action: Action, call: CallBinding, interfaces: Interfaces, body: Body, places: Places, say: Say
    ) -> None:
        self.action, self.call, self.body = action, call, body
        self._interfaces, self._places, self._say = interfaces, places, say
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
            self._say(self.action.name, place, progress)
            over(*self.answer(progress))

        self.body.capture(self.action.name, place, self._parameters(request), done)

    def answer(self, progress: Progress) -> tuple[Message, bool]:
        """What a capture came to, as the type of the call has it, and whether it succeeded."""
        if progress.state != "succeeded":
            return self.failure(progress.what or progress.state), False
        values: dict[str, object] = {self.call.success: True} if self.call.success else {}
        for name, binding in self.call.readings.items():
            values[binding.path] = as_sent(self._interfaces, self._answer, binding, progress.readings.get(name))
            if values[binding.path] is None:
                return self.failure(f"there is no reading of {name}"), False
        return message_of(values), True

    def failure(self, why: str) -> Message:
        """An answer that says why not, as far as its type can."""
        said = ((self.call.success, False), (self.call.message, why))
        return message_of({path: value for path, value in said if path})

    def _place(self, request: Message) -> Place:
        named = {value: path for path, value in self.call.request.items() if isinstance(value, str)}
        at = self.body.position
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


class CapturingAction:
    """A capture as an action: a :class:`~fieldhand.execution.drivers.ros2.twin.action_server.GoalHandler`."""

    def __init__(self, capturing: Capturing) -> None:
        self._capturing = capturing
        self._goal: Goal | None = None

    def refuses(self, goal: Message) -> str | None:  # noqa: ARG002  any that its type allows is one
        does = self._capturing.body.does
        return f"the robot is {does}" if does else None

    def begin(self, goal: Goal) -> None:
        self._goal = goal
        self._capturing.begin(goal.asked, self._over)

    def cancel(self, goal: Goal) -> None:
        if goal is self._goal:
            self._goal = None
            self._capturing.body.break_off()
            goal.cancelled(self._capturing.failure("cancelled"))

    def _over(self, result: Message, succeeded: bool) -> None:
        goal, self._goal = self._goal, None
        if goal is not None:
            (goal.succeeded if succeeded else goal.aborted)(result)


class CapturingService:
    """A capture as a service, answered when it is over. A failure that its type cannot say is not answered at all."""

    def __init__(self, capturing: Capturing, transport: Transport, name: str) -> None:
        self._capturing = capturing
        self._server: Server = transport.serve(name, capturing.call.type)

    def step(self) -> None:
        """Take what was asked meanwhile."""
        for to, request in self._server.requests():
            does = self._capturing.body.does
            if does:
                self._reply(to, self._capturing.failure(f"the robot is {does}"), False)
            else:
                self._capturing.begin(request, partial(self._reply, to))

    def _reply(self, to: object, answer: Message, succeeded: bool) -> None:
        if succeeded or self._capturing.call.success:
            self._server.reply(to, answer)


Served = ActionServer | CapturingService


def serve_capture(
    capturing: Capturing,
    transport: Transport,
    name: str,
    *,
    stamp: Callable[[], Mapping[str, int]],
    refused: Callable[[str], None],
) -> Served:
    """Serve a call of a profile under its whole name.

    Raises:
        Ros2Error: Its type is not known.
    """
    if capturing.call.kind == "service":
        return CapturingService(capturing, transport, name)
    handler = CapturingAction(capturing)
    return ActionServer(transport, name, capturing.call.type, handler, stamp=stamp, refused=refused)


def _text(request: Message, path: str | None) -> str:
    """What stands at a path, as text; numbers as people write them."""
    value = None if path is None else value_at(request, path)
    return "" if value is None else str(value)
