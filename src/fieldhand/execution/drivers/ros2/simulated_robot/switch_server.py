"""Switches of the simulated robot's implements: services and topics."""

from __future__ import annotations

from collections.abc import Callable

from fieldhand.execution.drivers.ros2.message_fields import message_of, value_at
from fieldhand.execution.drivers.ros2.simulated_robot.robot_platform import SimulatedPlatform
from fieldhand.execution.drivers.ros2.transport import QosProfile, RosMessage, Server, Subscription, Transport
from fieldhand.robot.bindings import SwitchBinding


class SwitchServer:
    """The switch of one implement.

    Args:
        action: Name of the action.
        binding: Service or topic that switches it.
        transport: Node of the robot.
        name: Full name of the service or topic.
        platform: The vehicle that has the implement.
        report: Called with the new state, or with the reason for which it did not change.

    Raises:
        Ros2Error: The type is unknown.
    """

    def __init__(
        self,
        action: str,
        binding: SwitchBinding,
        transport: Transport,
        name: str,
        platform: SimulatedPlatform,
        report: Callable[[bool, str], None],
    ) -> None:
        self._action, self._binding, self._platform, self._report = action, binding, platform, report
        self._server: Server | None = None
        self._topic: Subscription | None = None
        if binding.kind == "service":
            self._server = transport.serve(name, binding.type)
        else:
            self._topic = transport.subscribe(name, binding.type, QosProfile())
        self._on = False

    def step(self) -> None:
        """Process the requests or messages received since the last call."""
        if self._server is not None:
            for to, request in self._server.requests():
                why = self._switch(request)
                paths = ((self._binding.success, not why), (self._binding.message, why))
                self._server.reply(to, message_of({path: value for path, value in paths if path}))
        for message in self._topic.take() if self._topic is not None else ():
            self._switch(message)

    def _switch(self, request: RosMessage) -> str:
        """Carry out a request; return why that failed, or an empty text."""
        fixed = {path: value for path, value in self._binding.on.items() if not str(value).startswith("$")}
        on = all(value_at(request, path) == value for path, value in fixed.items())
        if on == self._on:
            return ""
        why = self._platform.switch(self._action, on=on)
        self._on = on and not why
        self._report(on, why)
        return why
