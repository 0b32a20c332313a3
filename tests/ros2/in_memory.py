"""A ROS 2 graph in one process: any number of nodes with the faults that a real one has, on a clock that is given.

    graph = Graph(clock.now)
    robot, computer = graph.node(), graph.node()
    graph.disturb("*/_action/feedback", Disturbed(loss=0.2, delay_s=(0.0, 1.0)))
    robot.vanish()

Everything that happens by chance follows from the seed. Endpoints find each other by the rules of DDS: the same name,
the same type, and a quality that the writer offers and the reader asks for. What finds nobody is silent, as there.
"""

from __future__ import annotations

import copy
import fnmatch
import heapq
import itertools
import random
from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from fieldhand.execution.drivers.ros2.transport import SENSOR_QOS, Peer, QosProfile, Rmw, RosMessage

RELIABLE = QosProfile()


@dataclass(frozen=True, kw_only=True)
class Disturbed:
    """Faults of messages on their way.

    Attributes:
        loss: Part of them that never arrives.
        twice: Part of them that arrives a second time.
        delay_s: Least and most seconds on the way; they may overtake each other.
    """

    loss: float = 0.0
    twice: float = 0.0
    delay_s: tuple[float, float] = (0.0, 0.0)


class Graph:
    """The connection between nodes.

    Args:
        now: Seconds. What is delayed arrives by it.
        seed: Of chance.
        found_s: So long two endpoints need to find each other; what is sent before gets lost.
        noticed_s: So long a node that vanished still seems to be there.
        complete: Fills in what a message leaves out, by its type: ``complete(type, message)``; a transport that knows
            its types does, and raises what :meth:`Publisher.send` may.
    """

    def __init__(
        self,
        now: Callable[[], float],
        *,
        seed: int = 0,
        found_s: float = 0.0,
        noticed_s: float = 10.0,
        complete: Callable[[str, RosMessage], RosMessage] | None = None,
    ) -> None:
        self.now, self.found_s, self.noticed_s, self.complete = now, found_s, noticed_s, complete
        self.ends: list[_End] = []
        self._random = random.Random(seed)
        self._nodes = itertools.count(1)
        self._order = itertools.count()
        self._disturbed: list[tuple[str, Disturbed]] = []
        self._on_the_way: list[tuple[float, int, Callable[[], None]]] = []

    def node(self, *, rmw: Rmw = "cyclonedds") -> Node:
        """One more process."""
        return Node(self, f"participant {next(self._nodes)}", rmw)

    def disturb(self, pattern: str, disturbed: Disturbed) -> None:
        """From now on: topics by their names, services as ``NAME request`` and ``NAME reply``; the last that fits."""
        self._disturbed.insert(0, (pattern, disturbed))

    def carry(self, what: str, deliver: Callable[[], None]) -> None:
        """Bring a message to one reader, or lose it."""
        how = next((d for pattern, d in self._disturbed if fnmatch.fnmatchcase(what, pattern)), Disturbed())
        for chance in (1.0 - how.loss, how.twice):
            if self._random.random() >= chance:
                break
            arrives = self.now() + self._random.uniform(*how.delay_s)
            heapq.heappush(self._on_the_way, (arrives, next(self._order), deliver))

    def arrive(self) -> None:
        """Deliver what has been on the way for long enough."""
        while self._on_the_way and self._on_the_way[0][0] <= self.now():
            heapq.heappop(self._on_the_way)[2]()

    def filled(self, type_name: str, message: RosMessage) -> RosMessage:
        """A message as it is sent: no later change of the original is in it."""
        whole = message if self.complete is None else self.complete(type_name, message)
        return _frozen(whole)


class Node:
    """A :class:`~fieldhand.execution.drivers.ros2.transport.Transport` of a graph in memory."""

    def __init__(self, graph: Graph, participant: str, rmw: Rmw) -> None:
        self.graph, self.participant, self.rmw = graph, participant, rmw
        self.vanished_s: float | None = None

    @property
    def name(self) -> str:
        return "memory"

    def vanish(self) -> None:
        """The process is killed: nothing goes out or comes in any more; the others notice it later."""
        self.vanished_s = self.graph.now()

    def subscribe(self, topic: str, type_name: str, qos: QosProfile = SENSOR_QOS) -> _Subscription:
        return _Subscription(self, topic, type_name, qos)

    def publish(self, topic: str, type_name: str, qos: QosProfile = RELIABLE) -> _Publisher:
        return _Publisher(self, topic, type_name, qos)

    def client(self, service: str, type_name: str) -> _Client:
        return _Client(self, service, type_name, RELIABLE)

    def serve(self, service: str, type_name: str) -> _Server:
        return _Server(self, service, type_name, RELIABLE)

    def writers_of(self, topic: str) -> tuple[Peer, ...]:
        return self._found(topic, _Publisher)

    def servers_of(self, service: str) -> tuple[Peer, ...]:
        return self._found(service, _Server)

    def close(self) -> None:
        for end in [e for e in self.graph.ends if e.node is self]:
            end.close()

    def _found(self, name: str, kind: type[_End]) -> tuple[Peer, ...]:
        return tuple(
            Peer(participant=e.node.participant, rmw=e.node.rmw, type=e.type, qos=e.qos)
            for e in self.graph.ends
            if isinstance(e, kind) and e.name == name and e.node is not self and e.noticed
        )


@dataclass(eq=False)
class _End:
    """A reader or writer: the part that all endpoints share."""

    node: Node
    name: str
    type: str
    qos: QosProfile
    made_s: float = field(init=False)

    def __post_init__(self) -> None:
        self.made_s = self.graph.now()
        self.graph.ends.append(self)

    @property
    def graph(self) -> Graph:
        return self.node.graph

    @property
    def alive(self) -> bool:
        return self in self.graph.ends and self.node.vanished_s is None

    @property
    def noticed(self) -> bool:
        """Return True if the others take it to be there."""
        gone_s = self.node.vanished_s
        return self in self.graph.ends and (gone_s is None or self.graph.now() < gone_s + self.graph.noticed_s)

    def matches(self, kind: type[_End]) -> list[_End]:
        """Those of a kind that have found this one, by name and type."""
        now = self.graph.now()
        return [
            e
            for e in self.graph.ends
            if isinstance(e, kind)
            and (e.name, e.type) == (self.name, self.type)
            and e.noticed
            and now >= max(e.made_s, self.made_s) + self.graph.found_s
        ]

    def close(self) -> None:
        if self in self.graph.ends:
            self.graph.ends.remove(self)


@dataclass(eq=False)
class _Subscription(_End):
    def __post_init__(self) -> None:
        super().__post_init__()
        self._arrived: deque[RosMessage] = deque(maxlen=self.qos.depth)
        for writer in self.graph.ends:
            if isinstance(writer, _Publisher) and writer.alive and self.qos.transient and _fit(writer, self):
                for message in writer.kept:
                    self.deliver(message)

    def take(self) -> tuple[RosMessage, ...]:
        if not self.alive:
            return ()
        self.graph.arrive()
        taken = tuple(self._arrived)
        self._arrived.clear()
        return taken

    def publishers(self) -> int:
        return sum(_fit(writer, self) for writer in self.matches(_Publisher))

    def deliver(self, message: RosMessage) -> None:
        if self.alive:
            self.graph.carry(self.name, lambda: self._arrived.append(message))


@dataclass(eq=False)
class _Publisher(_End):
    def __post_init__(self) -> None:
        super().__post_init__()
        self.kept: deque[RosMessage] = deque(maxlen=self.qos.depth if self.qos.transient else 0)

    def send(self, message: RosMessage) -> None:
        whole = self.graph.filled(self.type, message)
        if not self.alive:
            return
        self.kept.append(whole)
        for reader in self.matches(_Subscription):
            if isinstance(reader, _Subscription) and _fit(self, reader):
                reader.deliver(whole)

    def subscribers(self) -> int:
        return sum(_fit(self, reader) for reader in self.matches(_Subscription))


@dataclass(eq=False)
class _Client(_End):
    def __post_init__(self) -> None:
        super().__post_init__()
        self._asked = itertools.count(1)
        self._arrived: list[tuple[int, RosMessage]] = []

    def servers(self) -> int:
        return len(self.matches(_Server))

    def ask(self, request: RosMessage) -> int:
        number, whole = next(self._asked), self.graph.filled(f"{self.type}_Request", request)
        for server in self.matches(_Server) if self.alive else ():
            # As over DDS: services of the one do not understand those of the other, though they find each other.
            if isinstance(server, _Server) and server.alive and server.node.rmw == self.node.rmw:
                self.graph.carry(f"{self.name} request", _putting(server.arrived, ((self, number), whole)))
        return number

    def replies(self) -> tuple[tuple[int, RosMessage], ...]:
        if not self.alive:
            return ()
        self.graph.arrive()
        taken = tuple(self._arrived)
        self._arrived.clear()
        return taken

    def deliver(self, number: int, response: RosMessage) -> None:
        if self.alive:
            self.graph.carry(f"{self.name} reply", _putting(self._arrived, (number, response)))


@dataclass(eq=False)
class _Server(_End):
    def __post_init__(self) -> None:
        super().__post_init__()
        self.arrived: list[tuple[tuple[_Client, int], RosMessage]] = []

    def requests(self) -> tuple[tuple[object, RosMessage], ...]:
        if not self.alive:
            return ()
        self.graph.arrive()
        taken = tuple(self.arrived)
        self.arrived.clear()
        return taken

    def reply(self, to: object, response: RosMessage) -> None:
        assert isinstance(to, tuple)
        client, number = to
        whole = self.graph.filled(f"{self.type}_Response", response)
        if self.alive:
            client.deliver(number, whole)


def _fit(writer: _End, reader: _End) -> bool:
    """Return True if name and type are the same, and the writer offers what the reader asks for."""
    asked, offered = reader.qos, writer.qos
    return (
        (writer.name, writer.type) == (reader.name, reader.type)
        and (offered.reliable or not asked.reliable)
        and (offered.transient or not asked.transient)
    )


def _putting(into: list[Any], what: object) -> Callable[[], None]:
    return lambda: into.append(what)


def _frozen(message: RosMessage) -> RosMessage:
    """A copy in the form in which messages arrive: arrays as tuples or bytes."""
    return {name: _frozen_value(value) for name, value in message.items()}


def _frozen_value(value: object) -> object:
    if isinstance(value, Mapping):
        return _frozen(value)
    if isinstance(value, bytearray):
        return bytes(value)
    if isinstance(value, (list, tuple)):
        return tuple(_frozen_value(v) for v in value)
    return copy.copy(value)
