"""Drives along a given path with an implement on in parts of it.

    switch on ──▶ follow the path, switching by the robot's position ──▶ switch off ──▶ the mission

Switching on and off takes the seconds that the profile gives, so it is ordered so many metres ahead. The implement is
switched off at every end of the drive. An implement whose switch does not answer, or reports a failure, ends the drive.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Generator, Mapping

from fieldhand.errors import Ros2Error
from fieldhand.execution.drivers.protocol import DriveGoal, StretchWork
from fieldhand.execution.drivers.ros2.action_outcome import GoalEnd
from fieldhand.execution.drivers.ros2.message_fields import message_of, value_at
from fieldhand.execution.drivers.ros2.navigation import GoalSteps, NavigationClient, RunningDrive
from fieldhand.execution.drivers.ros2.service_call import TimeLimit, call_service
from fieldhand.execution.drivers.ros2.transport import Client, Publisher, RosMessage, Transport
from fieldhand.robot.bindings import RequestValue, Ros2Bindings, SwitchBinding
from fieldhand.robot.model import RobotProfile
from fieldhand.site.working.stretch import Stretch

#: Attempts to switch an implement off.
_OFF_TRIES = 3
#: Number of messages by which a topic switches, as one may be lost.
_REPEATS = 2
#: Metres ahead of the position within which the robot is looked for on its path, per second since the last look.
_AHEAD_M, _BEHIND_M = 3.0, 0.5

SwitchSteps = Generator[None, None, str]


class ImplementClient:
    """The switches of a robot's implements.

    Args:
        transport: Transport of the robot's graph.
        robot, bindings: Profile of the robot and its ROS 2 bindings.
        clock: Mission clock in seconds.
        steady: Monotonic clock in seconds.
        only: Names of the actions that the mission needs; None for all. The others are bound, too, because an earlier
            mission may have left them on, but may be missing.

    Attributes:
        is_on: Names of the implements that are on, or may be.

    Raises:
        Ros2Error: A type is unknown.
    """

    def __init__(
        self,
        transport: Transport,
        robot: RobotProfile,
        bindings: Ros2Bindings,
        *,
        clock: Callable[[], float],
        steady: Callable[[], float],
        only: Collection[str] | None = None,
    ) -> None:
        self.robot, self.clock, self.steady, self._bindings = robot, clock, steady, bindings
        self.is_on: set[str] = set()
        self._only = only
        self.switches: dict[str, tuple[SwitchBinding, Client | Publisher]] = {}
        for name, bound in bindings.actions.items():
            if bound.switch is None:
                continue
            full_name = bindings.whole_name(bound.switch.name)
            end: Client | Publisher
            if bound.switch.kind == "service":
                end = transport.client(full_name, bound.switch.type)
            else:
                end = transport.publish(full_name, bound.switch.type)
            self.switches[name] = bound.switch, end

    def whole_name(self, name: str) -> str:
        """Return a name with the robot's namespace."""
        return self._bindings.whole_name(name)

    def is_needed(self, name: str) -> bool:
        """Return True if the mission needs this implement."""
        return self._only is None or name in self._only

    def _is_there(self, name: str) -> bool:
        end = self.switches[name][1]
        return (end.servers() if hasattr(end, "servers") else end.subscribers()) > 0

    def switch(self, action: str, *, on: bool, parameters: Mapping[str, str | float]) -> SwitchSteps:
        """Switch an implement in steps that yield while waiting; return why that failed, or an empty text."""
        if action not in self.switches:
            return f"the profile does not define how {action} is switched over ROS 2"
        binding, end = self.switches[action]
        if on:
            self.is_on.add(action)
        values = binding.on if on else binding.off
        try:
            request = message_of({path: _value(value, parameters) for path, value in values.items()})
            if binding.kind == "topic":
                assert not hasattr(end, "ask")  # noqa: S101  a topic has a publisher
                yield from self._send(binding, end, request)
            else:
                answer = yield from self._ask(binding, end, request)  # type: ignore[arg-type]
                if binding.success and not value_at(answer, binding.success):
                    words = value_at(answer, binding.message) if binding.message else ""
                    return f"{self.whole_name(binding.name)} did not succeed{f': {words}' if words else ''}"
        except Ros2Error as error:
            return str(error)
        if not on:
            self.is_on.discard(action)
        return ""

    def _ask(self, binding: SwitchBinding, client: Client, request: RosMessage) -> Generator[None, None, RosMessage]:
        limit = TimeLimit(binding.within_s, self.clock, self.steady)
        answers = yield from call_service(client, self.whole_name(binding.name), [request], limit, self.steady)
        return answers[0]

    def _send(self, binding: SwitchBinding, publisher: Publisher, request: RosMessage) -> Generator[None, None, None]:
        if publisher.subscribers() == 0:
            raise Ros2Error(f"nothing subscribes to {self.whole_name(binding.name)}", advice="check whether it runs")
        for _ in range(_REPEATS):
            publisher.send(request)
            yield

    def all_off(self) -> Generator[None, None, tuple[str, ...]]:
        """Switch all implements off, except those that the mission does not need and that are missing; return what
        failed, one text each.
        """
        failed = []
        for name in self.switches:
            if not self.is_needed(name) and not self._is_there(name):
                continue
            parameters = {p.name: p.default for p in self.robot.action[name].parameters}
            if why := (yield from self.switch(name, on=False, parameters=parameters)):
                failed.append(f"{name} could not be switched off: {why}")
        return tuple(failed)

    def close(self) -> None:
        """Close all endpoints without sending anything."""
        for _, end in self.switches.values():
            end.close()


def _value(value: RequestValue, parameters: Mapping[str, str | float]) -> RequestValue:
    if isinstance(value, str) and value.startswith("$"):
        if value[1:] not in parameters:
            raise Ros2Error(f"the action has no parameter {value[1:]!r}, which its switch needs")
        return parameters[value[1:]]
    return value


class RunningStretch:
    """A drive along a path with an implement, advanced by :meth:`step`."""

    def __init__(
        self, navigation: NavigationClient, implements: ImplementClient, goal: DriveGoal, work: StretchWork
    ) -> None:
        self._navigation, self._implements, self._goal, self._work = navigation, implements, goal, work
        self._path = Stretch(name="", points=goal.path_m, on=work.on)
        self._reached_m = 0.0
        self._on = False
        self._switching: SwitchSteps | None = None
        self._wanted = False
        self._why = ""
        self._cancelled = False
        self._drive: RunningDrive | None = None
        self._steps = self._carry_out()
        self._ending: GoalEnd | None = None
        known = implements.robot.action.get(work.action)
        implement = None if known is None else known.implement
        self._on_delay_s = 0.0 if implement is None else implement.on_delay_s
        self._off_delay_s = 0.0 if implement is None else implement.off_delay_s

    def step(self) -> GoalEnd | None:
        """Advance the drive; return None while it runs or the implement is being switched off."""
        if self._ending is None:
            try:
                next(self._steps)
            except StopIteration as done:
                self._ending = done.value
        return self._ending

    def cancel(self) -> None:
        """Request cancellation; :meth:`step` reports the end, once the implement is off."""
        self._cancelled = True
        if self._drive is not None:
            self._drive.cancel()

    def _carry_out(self) -> GoalSteps:
        ending = yield from self._work_along()
        if not self._work.action:
            return ending
        why = ""
        for _ in range(_OFF_TRIES):
            why = yield from self._implements.switch(self._work.action, on=False, parameters=self._work.parameters)
            if not why:
                break
        if why:
            what = f"{self._work.action} could not be switched off ({why}); switch it off by hand"
            return GoalEnd(state="failed", fault="implement", what=what)
        return ending

    def _work_along(self) -> GoalSteps:
        if self._wants(0.0):
            why = yield from self._implements.switch(self._work.action, on=True, parameters=self._work.parameters)
            if why:
                return GoalEnd(state="failed", fault="implement", what=f"{self._work.action}: {why}")
            self._on = True
            limit = TimeLimit(self._on_delay_s, self._implements.clock, self._implements.steady)
            while not limit.over and not self._cancelled and self._on_delay_s > 0.0:
                yield
        if self._cancelled:
            return GoalEnd(state="cancelled")
        self._drive = drive = RunningDrive(self._navigation, self._goal)
        while (ending := drive.step()) is None:
            self._look()
            if self._why:
                drive.cancel()
            yield
        while self._switching is not None:
            self._look()
            yield
        if self._why and ending.state == "cancelled" and not self._cancelled:
            return GoalEnd(state="failed", fault="implement", what=f"{self._work.action}: {self._why}")
        return ending

    def _wants(self, at_m: float) -> bool:
        """Return True if the implement has to be ordered on at a distance along the path, as switching takes time."""
        speed = self._goal.speed_m_s
        lead_on, lead_off = self._on_delay_s * speed, self._off_delay_s * speed
        return bool(self._work.action) and any(a - lead_on <= at_m < b - lead_off for a, b in self._work.on)

    def _look(self) -> None:
        """Switch by the robot's position, one order at a time."""
        if self._switching is not None:
            try:
                next(self._switching)
            except StopIteration as done:
                self._switching = None
                self._why = self._why or str(done.value)
                self._on = self._wanted
            return
        position = self._navigation.position()
        if position is None or self._why:
            return
        ahead = self._reached_m + _AHEAD_M
        self._reached_m = max(
            self._reached_m,
            self._path.project(position.xy, after_m=self._reached_m - _BEHIND_M, before_m=ahead),
        )
        wanted = self._wants(self._reached_m)
        if wanted != self._on:
            self._wanted = wanted
            self._switching = self._implements.switch(self._work.action, on=wanted, parameters=self._work.parameters)
            self._look()
