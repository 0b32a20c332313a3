"""One binding of a profile tried on a robot that is there, without asking it to do anything."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Literal, Protocol

from fieldhand.execution.drivers.ros2.interfaces import Interfaces
from fieldhand.execution.drivers.ros2.plausible import Implausible, Judge
from fieldhand.execution.drivers.ros2.seen import (
    FEEDBACK,
    Unusable,
    action_unusable,
    service_unusable,
    topic_unusable,
)
from fieldhand.execution.drivers.ros2.transport import (
    STATUS,
    Client,
    Message,
    Peer,
    Publisher,
    Quality,
    Rmw,
    Subscription,
    Transport,
)

Kind = Literal["action", "service", "topic"]


@dataclass(frozen=True, kw_only=True)
class Binding:
    """What the profile says of an endpoint.

    Attributes:
        part: Where: ``navigation``, ``battery``, ``actions: read_co2``.
    """

    part: str
    kind: Kind
    name: str
    type: str


@dataclass(frozen=True, kw_only=True)
class Finding:
    """What became of trying a binding.

    Attributes:
        usable: Whether a mission can use it.
        what: What is there, or what is missing.
        advice: What to do; empty where nothing has to be done.
        rmw: By which middleware; empty where nothing is there.
    """

    binding: Binding
    usable: bool
    what: str
    advice: str = ""
    rmw: tuple[Rmw, ...] = ()


class Probe(Protocol):
    """Tries one binding."""

    def look(self) -> bool:
        """Whether all is seen that there is to see; to be asked again while it is not."""
        ...

    def finding(self) -> Finding:
        """What was seen so far."""
        ...


@dataclass
class TopicProbe:
    """Listens to a topic.

    Args:
        judge: Of its first message.
        rare: It may rightly be silent: it speaks when something changes, or after a call.
    """

    binding: Binding
    transport: Transport
    interfaces: Interfaces
    quality: Quality
    judge: Judge
    rare: bool = False
    message: Message | None = field(default=None, init=False)

    def __post_init__(self) -> None:
        self._subscription: Subscription = self.transport.subscribe(self.binding.name, self.binding.type, self.quality)

    def look(self) -> bool:
        for message in self._subscription.take():
            self.message = message
        return self.message is not None or (self.rare and self._subscription.publishers() > 0)

    def finding(self) -> Finding:
        rmw = _rmw_of(self.transport.writers_of(self.binding.name))
        if self.message is not None:
            try:
                return Finding(binding=self.binding, usable=True, what=self.judge(self.message), rmw=rmw)
            except Implausible as error:
                return Finding(binding=self.binding, usable=False, what=error.what, advice=error.advice, rmw=rmw)
        why = topic_unusable(self.transport, self.interfaces, self.binding.name, self.binding.type, self.quality)
        if why is None and self.rare and self._subscription.publishers() > 0:
            return Finding(binding=self.binding, usable=True, what="there; nothing was said so far", rmw=rmw)
        if why is None:
            # One whose bytes do not fit its type is dropped by DDS without a word.
            advice = "see whether the robot sends any; if it does, set its distro, or its definition in the profile"
            why = Unusable(what="it is there, and no message came", advice=advice)
        return Finding(binding=self.binding, usable=False, what=why.what, advice=why.advice, rmw=rmw)


@dataclass
class ServiceProbe:
    """Looks for the server of a service.

    Args:
        question: What it is asked, where it only computes; nothing while there is None.
    """

    binding: Binding
    transport: Transport
    interfaces: Interfaces
    question: Callable[[], Message | None] | None = None

    def __post_init__(self) -> None:
        self._client = self.transport.client(self.binding.name, self.binding.type)
        self._asked = self._answered = False

    def look(self) -> bool:
        there = self._client.servers() > 0
        if there and self.question is not None and not self._asked and (question := self.question()) is not None:
            self._asked = True
            self._client.ask(question)
        self._answered = self._answered or bool(self._client.replies())
        return there and (self.question is None or self._answered)

    def finding(self) -> Finding:
        rmw = _rmw_of(self.transport.servers_of(self.binding.name))
        why = service_unusable(self.transport, self.interfaces, self.binding.name, self.binding.type)
        if why is None and self._asked and not self._answered:
            why = Unusable(what="it is there, and does not answer", advice="see whether its node is active")
        there = "answers" if self._answered else "there"
        return _of_call(self.binding, why, self._client.servers() > 0, there, rmw)


@dataclass
class ActionProbe:
    """Looks for all that an action consists of."""

    binding: Binding
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
            self.transport.subscribe(f"{name}/_action/feedback", f"{of}_FeedbackMessage", FEEDBACK),
            self.transport.subscribe(f"{name}/_action/status", "action_msgs/msg/GoalStatusArray", STATUS),
        )

    def look(self) -> bool:
        return all(c.servers() > 0 for c in self._clients) and all(t.publishers() > 0 for t in self._topics)

    def finding(self) -> Finding:
        rmw = _rmw_of(self.transport.servers_of(f"{self.binding.name}/_action/send_goal"))
        why = action_unusable(self.transport, self.interfaces, self.binding.name, self.binding.type)
        return _of_call(self.binding, why, self.look(), "there", rmw)


@dataclass
class ListenerProbe:
    """Looks for who hears a topic that is sent to the robot; sends nothing."""

    binding: Binding
    transport: Transport

    def __post_init__(self) -> None:
        self._publisher: Publisher = self.transport.publish(self.binding.name, self.binding.type)

    def look(self) -> bool:
        return self._publisher.subscribers() > 0

    def finding(self) -> Finding:
        if self.look():
            return Finding(binding=self.binding, usable=True, what="heard")
        advice = "see whether its node is active, and hears it under this name and type"
        return Finding(binding=self.binding, usable=False, what="nobody hears it", advice=advice)


def _of_call(binding: Binding, why: Unusable | None, matched: bool, there: str, rmw: tuple[Rmw, ...]) -> Finding:
    if why is None and not matched:
        why = Unusable(
            what="it is seen, and the way to it and back is not open",
            advice="see whether a firewall or the network between lets only one direction through",
        )
    if why is not None:
        return Finding(binding=binding, usable=False, what=why.what, advice=why.advice, rmw=rmw)
    return Finding(binding=binding, usable=True, what=there, rmw=rmw)


def _rmw_of(peers: tuple[Peer, ...]) -> tuple[Rmw, ...]:
    return tuple(sorted({p.rmw for p in peers}))
