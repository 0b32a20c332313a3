"""Conversion of quality of service to DDS and back."""

from __future__ import annotations

from cyclonedds.core import Policy, Qos
from cyclonedds.util import duration

from fieldhand.execution.drivers.ros2.dds.names import UserData
from fieldhand.execution.drivers.ros2.transport import QosProfile

#: Milliseconds that a writer waits for buffer space before the message is dropped.
_BLOCKS_MS = 100


def to_dds_qos(qos: QosProfile, user_data: UserData) -> Qos:
    """Return the DDS quality of service of an own endpoint.

    Args:
        user_data: User data of the endpoint.
    """
    reliable = Policy.Reliability.Reliable(duration(milliseconds=_BLOCKS_MS))
    return Qos(
        reliable if qos.reliable else Policy.Reliability.BestEffort,
        Policy.Durability.TransientLocal if qos.transient else Policy.Durability.Volatile,
        Policy.History.KeepLast(qos.depth),
        # ROS uses the first version of the encoding; an endpoint that requests the second would not match.
        Policy.DataRepresentation(use_cdrv0_representation=True),
        Policy.WriterDataLifecycle(autodispose=False),
        Policy.Userdata(data=user_data.encoded()),
    )


def from_dds_qos(qos: Qos) -> QosProfile:
    """Return the quality of service of a remote endpoint; its depth is rarely announced."""
    keeps = Policy.History in qos and isinstance(qos[Policy.History], Policy.History.KeepLast)
    return QosProfile(
        reliable=Policy.Reliability in qos and isinstance(qos[Policy.Reliability], Policy.Reliability.Reliable),
        transient=Policy.Durability in qos and qos[Policy.Durability] != Policy.Durability.Volatile,
        depth=qos[Policy.History].depth if keeps else 1,
    )


def user_data_of(qos: Qos) -> UserData:
    """Return the user data of a remote endpoint."""
    return UserData.parse(bytes(qos[Policy.Userdata].data)) if Policy.Userdata in qos else UserData()
