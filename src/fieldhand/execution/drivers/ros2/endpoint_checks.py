"""Checks of a single binding against a live robot, without commanding it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Literal, Protocol

from fieldhand.execution.drivers.ros2.endpoint_problems import (
    FEEDBACK_QOS,
    EndpointProblem,
    action_problem,
    service_problem,
    topic_problem,
)
from fieldhand.execution.drivers.ros2.interfaces import Interfaces
from fieldhand.execution.drivers.ros2.node_states import state_problem
from fieldhand.execution.drivers.ros2.plausibility import ImplausibleMessage, MessageCheck
from fieldhand.execution.drivers.ros2.transport import (
    STATUS_QOS,
    Client,
    Peer,
    Publisher,
    QosProfile,
    Rmw,
    RosMessage,
    Subscription,
    Transport,
)

EndpointKind = Literal["action", "service", "topic"]


@dataclass(frozen=True, kw_only=True)
class EndpointBinding:
    """An endpoint that the profile names.

    Attributes:
        part: Part of the profile: ``navigation``, ``battery``, ``actions: read_co2``.
    """

    part: str
    kind: EndpointKind
    name: str
    type: str


@dataclass(frozen=True, kw_only=True)
class EndpointReport:
    """Result of checking an endpoint.

    Attributes:
        usable: True if a mission can use it.
        what: Description of what was found or is missing.
        advice: Recommended action; empty if none is needed.
        rmw: Middlewares that serve it; empty if nothing was found.
    """

    binding: EndpointBinding
    usable: bool
    what: str
    advice: str = ""
    rmw: tuple[Rmw, ...] = ()


class EndpointCheck(Protocol):
    """Check of one endpoint."""

    def look(self) -> bool:
        """Poll once and return True when the check is complete."""
        ...

    def report(self) -> EndpointReport:
        """Return the result so far."""
        ...


@dataclass
class TopicCheck:
    """Check of a topic that the robot publishes.

    Args:
        check_message: Checks the first message for plausibility.
        rare: True if silence is normal: the topic is published on change, or after a call.
    """

    binding: EndpointBinding
    transport: Transport
    interfaces: Interfaces
    qos: QosProfile
    check_message: MessageCheck
    rare: bool = False
    message: RosMessage | None = field(default=None, init=False)

    def __post_init__(self) -> None:
        self._subscription: Subscription = self.transport.subscribe(self.binding.name, self.binding.type, self.qos)

    def look(self) -> bool:
        for message in self._subscription.take():
            self.message = message
        return self.message is not None or (self.rare and self._subscription.publishers() > 0)

    def report(self) -> EndpointReport:
        rmw = _rmw_of(self.transport.writers_of(self.binding.name))
        if self.message is not None:
            try:
                return EndpointReport(binding=self.binding, usable=True, what=self.check_message(self.message), rmw=rmw)
            except ImplausibleMessage as error:
                return EndpointReport(binding=self.binding, usable=False, what=error.what, advice=error.advice, rmw=rmw)
        why = topic_problem(self.transport, self.interfaces, self.binding.name, self.binding.type, self.qos)
        if why is None and self.rare and self._subscription.publishers() > 0:
            return EndpointReport(binding=self.binding, usable=True, what="there; no message so far", rmw=rmw)
        if why is None:
            # DDS drops a message whose bytes do not fit its type, without an error.
            advice = "check whether the robot sends any; if it does, set its distro, or its definition in the profile"
            why = EndpointProblem(what="it is there, but sent no message", advice=advice)
        return EndpointReport(binding=self.binding, usable=False, what=why.what, advice=why.advice, rmw=rmw)


@dataclass
class ServiceCheck:
    """Check of a service that the robot offers.

    Args:
        question: Returns a request to a service without side effects, or None while there is none to send.
    """

    binding: EndpointBinding
    transport: Transport
    interfaces: Interfaces
    question: Callable[[], RosMessage | None] | None = None

    def __post_init__(self) -> None:
        self._client = self.transport.client(self.binding.name, self.binding.type)
        self._sent = self._answered = False

    def look(self) -> bool:
        there = self._client.servers() > 0
        if there and self.question is not None and not self._sent and (question := self.question()) is not None:
            self._sent = True
            self._client.ask(question)
        self._answered = self._answered or bool(self._client.replies())
        return there and (self.question is None or self._answered)

    def report(self) -> EndpointReport:
        rmw = _rmw_of(self.transport.servers_of(self.binding.name))
        why = service_problem(self.transport, self.interfaces, self.binding.name, self.binding.type)
        if why is None and self._sent and not self._answered:
            why = EndpointProblem(what="it is there, but does not answer", advice="check whether its node is active")
        there = "answers" if self._answered else "there"
        return _of_call(self.binding, why, self._client.servers() > 0, there, rmw)


@dataclass
class LifecycleCheck:
    """Check that a node is active.

    Attributes:
        found: True if the node has a lifecycle; one without needs no check.
    """

    binding: EndpointBinding
    transport: Transport
    interfaces: Interfaces

    def __post_init__(self) -> None:
        self._client = self.transport.client(self.binding.name, self.binding.type)
        self._asked = False
        self._state: RosMessage | None = None

    @property
    def found(self) -> bool:
        return self._client.servers() > 0

    def look(self) -> bool:
        if self.found and not self._asked:
            self._asked = True
            self._client.ask({})
        for _, reply in self._client.replies():
            self._state = reply
        return self._state is not None or not self.found

    def report(self) -> EndpointReport:
        rmw = _rmw_of(self.transport.servers_of(self.binding.name))
        node = self.binding.name.removesuffix("/get_state")
        if self._state is None:
            why = service_problem(self.transport, self.interfaces, self.binding.name, self.binding.type)
            found = (why.what, why.advice) if why is not None else ("it does not answer", "check whether it hangs")
            return EndpointReport(binding=self.binding, usable=False, what=found[0], advice=found[1], rmw=rmw)
        if (problem := state_problem(node, self._state)) is not None:
            return EndpointReport(binding=self.binding, usable=False, what=problem[0], advice=problem[1], rmw=rmw)
        return EndpointReport(binding=self.binding, usable=True, what="active", rmw=rmw)


@dataclass
class ActionCheck:
    """Check of the services and topics of an action."""

    binding: EndpointBinding
    transport: Transport
    interfaces: Interfaces

    def __post_init__(self) -> None:
        name, of = self.binding.name, self.binding.type
        self._clients: tuple[Client, ...] = (
            self.transport.client(f"{name}/_action/send_goal", f"{of}_SendGoal"),
            self.transport.client(f"{name}/_action/get_result", f"{of}_GetResult"),
            self.transport.client(f"{name}/_action/cancel_goal", "action_msgs/srv/CancelGoal"),
        )
        self._topics = (
            self.transport.subscribe(f"{name}/_action/feedback", f"{of}_FeedbackMessage", FEEDBACK_QOS),
            self.transport.subscribe(f"{name}/_action/status", "action_msgs/msg/GoalStatusArray", STATUS_QOS),
        )

    def look(self) -> bool:
        return all(c.servers() > 0 for c in self._clients) and all(t.publishers() > 0 for t in self._topics)

    def report(self) -> EndpointReport:
        rmw = _rmw_of(self.transport.servers_of(f"{self.binding.name}/_action/send_goal"))
        why = action_problem(self.transport, self.interfaces, self.binding.name, self.binding.type)
        return _of_call(self.binding, why, self.look(), "there", rmw)


@dataclass
class SubscriberCheck:
    """Check of a topic that the robot subscribes to; sends nothing."""

    binding: EndpointBinding
    transport: Transport

    def __post_init__(self) -> None:
        self._publisher: Publisher = self.transport.publish(self.binding.name, self.binding.type)

    def look(self) -> bool:
        return self._publisher.subscribers() > 0

    def report(self) -> EndpointReport:
        if self.look():
            return EndpointReport(binding=self.binding, usable=True, what="heard")
        advice = "check whether its node is active, and subscribes under this name and type"
        return EndpointReport(binding=self.binding, usable=False, what="there is no subscriber", advice=advice)


def _of_call(
    binding: EndpointBinding, why: EndpointProblem | None, matched: bool, there: str, rmw: tuple[Rmw, ...]
) -> EndpointReport:
    if why is None and not matched:
        why = EndpointProblem(
            what="it was discovered, but is not matched in both directions",
            advice="check that no firewall or network blocks one direction",
        )
    if why is not None:
        return EndpointReport(binding=binding, usable=False, what=why.what, advice=why.advice, rmw=rmw)
    return EndpointReport(binding=binding, usable=True, what=there, rmw=rmw)


def _rmw_of(peers: tuple[Peer, ...]) -> tuple[Rmw, ...]:
    return tuple(sorted({p.rmw for p in peers}))
