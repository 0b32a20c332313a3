"""A node of a ROS 2 graph over DDS."""

from __future__ import annotations

import os
import secrets
from functools import cache
from typing import Any, TypeVar

from cyclonedds.core import DDSException
from cyclonedds.domain import Domain, DomainParticipant
from cyclonedds.pub import DataWriter, Publisher
from cyclonedds.sub import DataReader, Subscriber
from cyclonedds.topic import Topic

from fieldhand.errors import Ros2Error
from fieldhand.execution.drivers.ros2.dds import names
from fieldhand.execution.drivers.ros2.dds.discovery import DdsDiscovery
from fieldhand.execution.drivers.ros2.dds.message_codec import MessageCodec
from fieldhand.execution.drivers.ros2.dds.names import UserData
from fieldhand.execution.drivers.ros2.dds.qos import to_dds_qos
from fieldhand.execution.drivers.ros2.dds.services import SERVICE_QOS, DdsClient, DdsServer
from fieldhand.execution.drivers.ros2.dds.topics import DdsPublisher, DdsSubscription, close
from fieldhand.execution.drivers.ros2.domain import domain_of
from fieldhand.execution.drivers.ros2.interfaces import Interfaces
from fieldhand.execution.drivers.ros2.transport import SENSOR_QOS, Peer, QosProfile, Rmw

#: Size limit of samples that DDS accepts from the network: larger than a picture of a good camera.
_MOST_RECEIVED = "32 MiB"

_End = TypeVar("_End", DdsSubscription, DdsPublisher, DdsClient, DdsServer)


class DdsTransport:
    """A :class:`~fieldhand.execution.drivers.ros2.transport.Transport` over Cyclone DDS.

    It starts no threads and uses no callbacks: received samples stay with DDS until they are taken.

    Args:
        interfaces: Types that can be sent and received.
        domain: DDS domain id; None for ``ROS_DOMAIN_ID`` of the environment, else 0.

    Raises:
        InputError: The domain id is invalid.
        Ros2Error: The network cannot be used.
    """

    def __init__(self, interfaces: Interfaces, domain: int | None = None) -> None:
        self.domain = domain_of(domain)
        self.interfaces = interfaces
        self._codec = MessageCodec(interfaces)
        self._ends: list[Any] = []
        self._open = True
        try:
            _bounded(self.domain)
            self._participant = DomainParticipant(self.domain)
            self._publisher, self._subscriber = Publisher(self._participant), Subscriber(self._participant)
            self._discovery = DdsDiscovery(self._participant)
        except DDSException as error:
            raise Ros2Error(
                f"no node can be created on DDS domain {self.domain}",
                advice="check the network interfaces, and CYCLONEDDS_URI if it is set",
            ) from error

    @property
    def name(self) -> str:
        return "dds"

    @property
    def rmw(self) -> Rmw:
        return "cyclonedds"

    def subscribe(self, topic: str, type_name: str, qos: QosProfile = SENSOR_QOS) -> DdsSubscription:
        reader = self._reader(names.topic_name(topic), type_name, qos, {})
        return self._track(DdsSubscription(self._codec, type_name, reader, qos.depth))

    def publish(self, topic: str, type_name: str, qos: QosProfile = QosProfile()) -> DdsPublisher:  # noqa: B008 - frozen
        writer = self._writer(names.topic_name(topic), type_name, qos, {})
        return self._track(DdsPublisher(self._codec, type_name, writer))

    def client(self, service: str, type_name: str) -> DdsClient:
        me = {"clientid": _new_id()}
        reader = self._reader(names.reply_name(service), f"{type_name}_Response", SERVICE_QOS, me, with_header=True)
        writer = self._writer(names.request_name(service), f"{type_name}_Request", SERVICE_QOS, me, with_header=True)
        return self._track(DdsClient(self._codec, type_name, writer, reader))

    def serve(self, service: str, type_name: str) -> DdsServer:
        me = {"serviceid": _new_id()}
        writer = self._writer(names.reply_name(service), f"{type_name}_Response", SERVICE_QOS, me, with_header=True)
        reader = self._reader(names.request_name(service), f"{type_name}_Request", SERVICE_QOS, me, with_header=True)
        return self._track(DdsServer(self._codec, type_name, reader, writer))

    def writers_of(self, topic: str) -> tuple[Peer, ...]:
        return self._discovery.writers_of(topic)

    def servers_of(self, service: str) -> tuple[Peer, ...]:
        return self._discovery.servers_of(service)

    def close(self) -> None:
        for end in self._ends:
            end.close()
        self._ends.clear()
        if self._open:
            self._open = False
            close(self._participant)

    def _track(self, end: _End) -> _End:
        self._ends = [*(e for e in self._ends if e.open), end]
        return end

    def _reader(
        self, name: str, message: str, qos: QosProfile, user_data: dict[str, str], *, with_header: bool = False
    ) -> Any:
        topic, user = self._topic(name, message, with_header=with_header), self._user_data(message, user_data)
        return DataReader(self._subscriber, topic, qos=to_dds_qos(qos, user))

    def _writer(
        self, name: str, message: str, qos: QosProfile, user_data: dict[str, str], *, with_header: bool = False
    ) -> Any:
        topic, user = self._topic(name, message, with_header=with_header), self._user_data(message, user_data)
        return DataWriter(self._publisher, topic, qos=to_dds_qos(qos, user))

    def _topic(self, name: str, message: str, *, with_header: bool) -> Topic[Any]:
        try:
            return Topic(self._participant, name, self._codec.type_of(message, with_header=with_header))
        except DDSException as error:
            raise Ros2Error(f"{name[2:]} cannot be made as {message}: it is there with another type") from error

    def _user_data(self, message: str, user_data: dict[str, str]) -> UserData:
        announced = {"typehash": self.interfaces.type_hash(message)} if self.interfaces.announced else {}
        return UserData(values=user_data | announced)


@cache
def _bounded(domain: int) -> Domain | None:
    """Limit the size of samples that DDS accepts. Return None if the domain was already created in this process."""
    configured = os.environ.get("CYCLONEDDS_URI", "")
    if not configured.isascii():  # the library accepts ASCII only
        return None
    limit = f"<CycloneDDS><Domain><Internal><MaxSampleSize>{_MOST_RECEIVED}</MaxSampleSize></Internal></Domain>"
    try:
        return Domain(domain, f"{configured}{',' if configured else ''}{limit}</CycloneDDS>")
    except DDSException as error:
        if error.code == DDSException.DDS_RETCODE_PRECONDITION_NOT_MET:
            return None
        raise


def _new_id() -> str:
    """Return a random id of a client or server: sixteen bytes in ROS's notation."""
    return ".".join(f"{byte:x}" for byte in secrets.token_bytes(16))
